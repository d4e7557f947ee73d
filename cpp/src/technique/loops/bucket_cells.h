// The cells of one bucket: what its pixels have to look at (cells_layout.h).
//
//     +------+------+        A cell knows which fills its lower left corner is inside of. From there, a pixel counts
//     |      |   /  |        the edges between: up the left border, where they are cut, and along its row.
//     |    __|__/ p |
//     +---/--+------+        The corner is a little to the right of the border and above it, so what runs along
//     |  /   |      |        the border decides nothing, and each point belongs to one of two neighbours.
//     +------+------+
#pragma once

#include <array>
#include <vector>

#include "technique/loops/cells_layout.h"
#include "technique/loops/prepared_loops.h"

namespace decalgl::loops {

// From left to right. Of fills a piece that lies in the bucket, of strokes all of it.
struct Edge {
    LatticePoint a;
    LatticePoint b;
};

// What one slot has in a bucket.
struct BucketSlot {
    uint32_t slot;
    bool inside;  // of a fill, whether the bucket's corner is
    uint32_t first_edge;
    uint32_t edges;
};

struct Texel {
    std::array<uint32_t, 4> words;
};

// Lists of a run of cells; places count from the first of them.
struct CellLists {
    std::vector<uint32_t> buckets;  // as bucket_entries, but the first cell counts from these
    std::vector<uint32_t> cells;
    std::vector<Texel> texels;
    std::vector<uint32_t> hiders;  // slots below which something was left out, as nothing shows there
    uint64_t edges = 0;
    uint32_t longest = 0;

    void drop() {
        buckets = {};
        cells = {};
        texels = {};
        hiders = {};
    }
};

// The y where an edge meets a vertical line between its ends, the same whoever asks.
int32_t height_at(const Edge& edge, int32_t x);
int32_t place_at(const Edge& edge, int32_t y);

class BucketBuilder {
public:
    // `bits`: a bucket is 2^bits quanta wide. `styles` of all slots.
    BucketBuilder(int bits, Span<const Style> styles, CellLists& lists)
        : bits_(bits), styles_(styles), lists_(lists) {}

    // Appends a bucket with its lower left corner there. `slots` are the topmost first.
    void add(LatticePoint corner, Span<const BucketSlot> slots, Span<const Edge> edges);

private:
    using Rows = std::array<uint64_t, size_t{1} << CELL_FINEST_LEVEL>;  // a bit for each column

    struct Item {
        uint32_t cell;
        Texel texel;
    };

    int level_of(Span<const BucketSlot> slots) const;
    void add_fill(const BucketSlot& slot, Span<const Edge> edges);
    void cut_fill(const Edge& edge, Rows& corners);
    void add_stroke(Span<const Edge> edges, double half_width);
    void put_stroke(const Edge& edge, double half_width, Rows& covered);
    void put_edge(int column, int row, const std::array<double, 4>& ends, double reach);
    void put_header(int column, int row);
    void close(const Rows& inside);
    void note_hider(int column, int row);
    void write();

    int bits_;
    Span<const Style> styles_;
    CellLists& lists_;
    LatticePoint corner_{};
    int level_ = 0, cell_bits_ = 0, side_ = 1;
    Rows done_{}, met_{},
        noted_{};  // cells in which nothing more shows; with an edge of the slot; with a known hider
    std::vector<uint32_t> hiders_;  // of cells that are done
    std::vector<Item> items_;       // headers and edges, of each cell in their order
    std::vector<uint32_t> last_;    // header of each cell, as a place in the items
    std::vector<uint32_t> begins_;
    const BucketSlot* slot_ = nullptr;
};

}  // namespace decalgl::loops
