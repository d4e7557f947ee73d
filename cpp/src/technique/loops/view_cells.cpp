#include "technique/loops/view_cells.h"

#include <algorithm>
#include <cmath>

#include "decalgl/core/error.h"

namespace decalgl::loops {
namespace {

constexpr int most_side = 256;        // buckets
constexpr int most_bucket_bits = 22;  // so that places in a bucket are exact as floats
constexpr int least_bucket_bits = CELL_FINEST_LEVEL + 1;
constexpr uint64_t edges_a_bucket = 64;
constexpr size_t slot_blocks = 64;
constexpr uint64_t most_texels = uint64_t{1} << 27;  // what drivers read from one texture buffer as a rule

// An edge in a column of buckets.
struct Reference {
    uint32_t slot;
    Edge edge;
};

using RowSet = std::array<uint64_t, most_side / 64>;

void put(RowSet& rows, int row) {
    rows[size_t(row) / 64] |= uint64_t{1} << (row % 64);
}
bool holds(const RowSet& rows, int row) {
    return (rows[size_t(row) / 64] >> (row % 64) & 1) != 0;
}

void sort_unique(std::vector<uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

class Grid {
public:
    Grid(const LatticeBox& box, uint64_t edges) {
        const auto side = [&](int64_t size) { return static_cast<int>((size >> bits) + 2); };
        const int64_t width = int64_t{box.max_x} - box.min_x, height = int64_t{box.max_y} - box.min_y;
        const auto wanted =
            std::clamp<int64_t>(static_cast<int64_t>(edges / edges_a_bucket), 64, most_side * most_side);
        bits = least_bucket_bits;
        while (bits < most_bucket_bits && (side(width) > most_side || side(height) > most_side ||
                                           int64_t{side(width)} * side(height) > wanted))
            ++bits;
        corner = {box.min_x >> bits << bits, box.min_y >> bits << bits};
        columns = ((box.max_x - corner.x) >> bits) + 1;
        rows = ((box.max_y - corner.y) >> bits) + 1;
    }

    int64_t column_of(int64_t x) const { return (x - corner.x) >> bits; }
    int64_t row_of(int64_t y) const { return (y - corner.y) >> bits; }
    int32_t left_of(int64_t column) const { return static_cast<int32_t>(corner.x + (column << bits)); }
    int32_t bottom_of(int64_t row) const { return static_cast<int32_t>(corner.y + (row << bits)); }

    int bits = 0;
    LatticePoint corner{};
    int columns = 0, rows = 0;
};

int64_t reach_of(const Style& style) {
    // Twice the lattice's extent is everywhere.
    return style.is_fill() ? 0 : static_cast<int64_t>(std::ceil(std::min(style.half_width, 2e9F))) + 1;
}

// Goes over all edges of a slot, the topmost being the first, with the columns that each of them is put into.
class EdgeVisitor {
public:
    EdgeVisitor(const KeptArcs& arcs, const ActiveArcs& active, const Slots& slots, const Grid& grid)
        : arcs_(arcs), active_(active), slots_(slots), grid_(grid) {}

    // `visit(slot, column, edge)`.
    template <typename Visit>
    void each(size_t rank, const Visit& visit) const {
        const uint32_t slot = slots_.upwards[slots_.upwards.size() - 1 - rank];
        const Style& style = slots_.styles[slot];
        if (!style.is_shown())
            return;
        const bool is_fill = style.is_fill();
        const int64_t reach = reach_of(style);
        const int64_t bottom = grid_.corner.y,
                      top = grid_.bottom_of(grid_.rows - 1) + (int64_t{1} << grid_.bits);
        for (const uint32_t arc :
             is_fill ? arcs_.fill_of(slots_.features[slot]) : arcs_.stroke_of(slots_.features[slot])) {
            if (arcs_.kinds[arc] == ArcKind::frame)
                continue;
            const Span<const LatticePoint> points = active_.of(arc);
            for (size_t i = 0; i + 1 < points.size(); ++i) {
                Edge edge{points[i], points[i + 1]};
                if (edge.b.x < edge.a.x || (edge.b.x == edge.a.x && edge.b.y < edge.a.y))
                    std::swap(edge.a, edge.b);
                const int64_t low = std::min(edge.a.y, edge.b.y) - reach,
                              high = std::max(edge.a.y, edge.b.y) + reach;
                // Below, a fill's edge still turns over the corners above it.
                if (low >= top || (high < bottom && !is_fill) || (is_fill && edge.a == edge.b))
                    continue;
                const int64_t last_x = is_fill ? std::max(edge.a.x, edge.b.x - 1) : edge.b.x + reach;
                const int64_t first = std::max<int64_t>(grid_.column_of(edge.a.x - reach), 0);
                const int64_t last = std::min<int64_t>(grid_.column_of(last_x), grid_.columns - 1);
                for (int64_t column = first; column <= last; ++column)
                    visit(slot, static_cast<size_t>(column), edge);
            }
        }
    }

private:
    const KeptArcs& arcs_;
    const ActiveArcs& active_;
    const Slots& slots_;
    const Grid& grid_;
};

// The references of all columns, one after the other, each with its slots in order.
struct ColumnReferences {
    LargeArray<Reference> all;
    std::vector<uint64_t> begins;
};

ColumnReferences sort_by_columns(const EdgeVisitor& edges, const Grid& grid, size_t slots, unsigned threads) {
    const size_t grain = std::max<size_t>(1, (slots + slot_blocks - 1) / slot_blocks);
    const size_t blocks = block_count(slots, grain), columns = size_t(grid.columns);
    std::vector<uint64_t> places(columns * blocks + 1);
    parallel_for(slots, grain, threads, [&](size_t begin, size_t end) {
        for (size_t rank = begin; rank < end; ++rank)
            edges.each(rank, [&](uint32_t, size_t column, const Edge&) {
                ++places[column * blocks + begin / grain + 1];
            });
    });
    for (size_t i = 1; i < places.size(); ++i)
        places[i] += places[i - 1];
    ColumnReferences sorted;
    for (size_t column = 0; column <= columns; ++column)
        sorted.begins.push_back(places[column * blocks]);
    sorted.all.resize(places.back());
    parallel_for(slots, grain, threads, [&](size_t begin, size_t end) {
        for (size_t rank = begin; rank < end; ++rank)
            edges.each(rank, [&](uint32_t slot, size_t column, const Edge& edge) {
                sorted.all[places[column * blocks + begin / grain]++] = {slot, edge};
            });
    });
    return sorted;
}

// The buckets of one column.
class ColumnBuilder {
public:
    ColumnBuilder(const Grid& grid, const Slots& slots, int column)
        : grid_(grid), slots_(slots), left_(grid.left_of(column)) {}

    void build(Span<const Reference> references, CellLists& lists) {
        for (size_t i = 0, next; i < references.size(); i = next) {
            for (next = i; next < references.size() && references[next].slot == references[i].slot;)
                ++next;
            add_slot(references.subspan(i, next - i));
        }
        write(lists);
        lists.hiders.insert(lists.hiders.end(), hiders_.begin(), hiders_.end());
        sort_unique(lists.hiders);
    }

private:
    struct Piece {
        int row;
        Edge edge;
    };
    struct Entry {
        int row;
        BucketSlot slot;
    };

    void add_slot(Span<const Reference> references) {
        const Style& style = slots_.styles[references[0].slot];
        const bool is_fill = style.is_fill();
        turned_ = {};
        own_.clear();
        first_row_ = grid_.rows;
        last_row_ = -1;
        for (const Reference& reference : references)
            if (is_fill)
                cut_fill(reference.edge);
            else
                place_stroke(reference.edge, reach_of(style));
        // Edges of a bucket next to each other, and the corners that are inside.
        std::stable_sort(own_.begin(), own_.end(),
                         [](const Piece& a, const Piece& b) { return a.row < b.row; });
        if (!own_.empty()) {
            first_row_ = std::min(first_row_, own_.front().row);
            last_row_ = std::max(last_row_, own_.back().row);
        }
        bool inside = false;
        size_t next = 0;
        for (int row = first_row_; row < grid_.rows && (row <= last_row_ || inside); ++row) {
            inside = inside != holds(turned_, row);
            const size_t begin = next;
            while (next < own_.size() && own_[next].row == row)
                ++next;
            if (inside || next > begin)
                add_entry(row, references[0].slot, inside,
                          Span<const Piece>(own_).subspan(begin, next - begin));
        }
    }

    void add_entry(int row, uint32_t slot, bool inside, Span<const Piece> own) {
        if (holds(done_, row)) {
            hiders_.push_back(closers_[size_t(row)]);
            return;
        }
        entries_.push_back(
            {row, {slot, inside, static_cast<uint32_t>(pieces_.size()), static_cast<uint32_t>(own.size())}});
        for (const Piece& piece : own)
            pieces_.push_back(piece.edge);
        if (inside && own.empty() && slots_.styles[slot].is_opaque()) {
            put(done_, row);
            closers_[size_t(row)] = slot;
        }
    }

    void cut_fill(const Edge& edge) {
        const int64_t right = int64_t{left_} + (int64_t{1} << grid_.bits);
        Edge piece = edge;
        if (edge.a.x < left_)
            piece.a = {left_, height_at(edge, left_)};
        if (edge.b.x > right)
            piece.b = {static_cast<int32_t>(right), height_at(edge, static_cast<int32_t>(right))};
        if (piece.a.x == left_ && piece.b.x > left_) {
            const int64_t row =
                (int64_t{piece.a.y} - grid_.corner.y + (int64_t{1} << grid_.bits) - 1) >> grid_.bits;
            if (row < grid_.rows)
                turn(static_cast<int>(std::max<int64_t>(row, 0)));
        }
        const LatticePoint low = piece.a.y <= piece.b.y ? piece.a : piece.b;
        const LatticePoint high = piece.a.y <= piece.b.y ? piece.b : piece.a;
        const int64_t first = std::max<int64_t>(grid_.row_of(low.y), 0);
        const int64_t last = std::min<int64_t>(grid_.row_of(high.y), grid_.rows - 1);
        for (int64_t row = first; row <= last; ++row) {
            const int64_t bottom = grid_.bottom_of(row), top = bottom + (int64_t{1} << grid_.bits);
            LatticePoint from = low, to = high;
            if (low.y < bottom)
                from = {place_at(piece, static_cast<int32_t>(bottom)), static_cast<int32_t>(bottom)};
            if (high.y > top)
                to = {place_at(piece, static_cast<int32_t>(top)), static_cast<int32_t>(top)};
            if (from == to)
                continue;
            const bool rises = from.x <= to.x;
            own_.push_back({static_cast<int>(row), {rises ? from : to, rises ? to : from}});
        }
    }

    // The corners from a row on are on the other side of an edge.
    void turn(int row) {
        turned_[size_t(row) / 64] ^= uint64_t{1} << (row % 64);
        first_row_ = std::min(first_row_, row);
        last_row_ = std::max(last_row_, row);
    }

    void place_stroke(const Edge& edge, int64_t reach) {
        // What of it may reach the column.
        const double from = std::clamp(double(left_ - reach), double(edge.a.x), double(edge.b.x));
        const double to = std::clamp(double(left_ + (int64_t{1} << grid_.bits) + reach), double(edge.a.x),
                                     double(edge.b.x));
        double y0 = edge.a.y, y1 = edge.b.y;
        if (edge.a.x < edge.b.x) {
            const double slope = (y1 - y0) / (double(edge.b.x) - edge.a.x);
            y1 = y0 + slope * (to - edge.a.x);
            y0 += slope * (from - edge.a.x);
        }
        const auto low = static_cast<int64_t>(std::floor(std::min(y0, y1))) - reach - 1;
        const auto high = static_cast<int64_t>(std::ceil(std::max(y0, y1))) + reach + 1;
        for (int64_t row = std::max<int64_t>(grid_.row_of(low), 0);
             row <= std::min<int64_t>(grid_.row_of(high), grid_.rows - 1); ++row)
            own_.push_back({static_cast<int>(row), edge});
    }

    void write(CellLists& lists) {
        std::stable_sort(entries_.begin(), entries_.end(),
                         [](const Entry& a, const Entry& b) { return a.row < b.row; });
        BucketBuilder builder(grid_.bits, slots_.styles, lists);
        std::vector<BucketSlot> slots;
        size_t next = 0;
        for (int row = 0; row < grid_.rows; ++row) {
            slots.clear();
            for (; next < entries_.size() && entries_[next].row == row; ++next)
                slots.push_back(entries_[next].slot);
            builder.add({left_, grid_.bottom_of(row)}, slots, pieces_);
        }
    }

    const Grid& grid_;
    const Slots& slots_;
    int32_t left_;
    RowSet turned_{}, done_{};                   // of the slot in hand, and where nothing more shows
    std::array<uint32_t, most_side> closers_{};  // what covers rows that are done
    std::vector<uint32_t> hiders_;
    int first_row_ = 0, last_row_ = -1;  // of the slot in hand
    std::vector<Piece> own_;
    std::vector<Edge> pieces_;
    std::vector<Entry> entries_;
};

// The lists of all columns as one, row after row of buckets.
CellLists joined(std::vector<CellLists>& columns, const Grid& grid, unsigned threads) {
    CellLists all;
    std::vector<size_t> cells(columns.size() + 1), texels(columns.size() + 1, 1);
    for (size_t i = 0; i < columns.size(); ++i) {
        cells[i + 1] = cells[i] + columns[i].cells.size();
        texels[i + 1] = texels[i] + columns[i].texels.size();
        all.edges += columns[i].edges;
        all.longest = std::max(all.longest, columns[i].longest);
        all.hiders.insert(all.hiders.end(), columns[i].hiders.begin(), columns[i].hiders.end());
    }
    sort_unique(all.hiders);
    if (texels.back() > most_texels)
        throw Error(ErrorKind::memory, "what is active in this view takes " + std::to_string(texels.back()) +
                                           " texels in technique 'loops', more than a shader can read; give "
                                           "a larger tolerance, or a bvh");
    all.buckets.resize(columns.size() * size_t(grid.rows));
    all.cells.resize(cells.back());
    all.texels.resize(texels.back());
    all.texels[0] = {{CELL_LAST, 0, 0, 0}};
    parallel_for(columns.size(), 1, threads, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            CellLists& own = columns[i];
            for (size_t row = 0; row < own.buckets.size(); ++row)
                all.buckets[row * columns.size() + i] =
                    own.buckets[row] + static_cast<uint32_t>(cells[i] << CELL_LEVEL_BITS);
            for (size_t cell = 0; cell < own.cells.size(); ++cell)
                all.cells[cells[i] + cell] =
                    own.cells[cell] == 0 ? 0 : own.cells[cell] - 1 + static_cast<uint32_t>(texels[i]);
            std::copy(own.texels.begin(), own.texels.end(),
                      all.texels.begin() + static_cast<ptrdiff_t>(texels[i]));
            own = {};
        }
    });
    return all;
}

}  // namespace

bool ViewCells::serve(const Slots& slots) const {
    if (slots.styles.data() == made_for.styles.data() && slots.lie_as(made_for))
        return true;
    const auto is_there = [](const Style& wanted, const Style& own) {
        return own.is_shown() || !wanted.is_shown();
    };
    return slots.lie_as(made_for) &&
           std::equal(slots.styles.begin(), slots.styles.end(), made_for.styles.begin(), is_there) &&
           std::all_of(hiders.begin(), hiders.end(),
                       [&](uint32_t slot) { return slots.styles[slot].is_opaque(); });
}

ViewCells make_cells(const KeptArcs& arcs, const ActiveArcs& active, const Slots& slots,
                     const LatticeBox& box, unsigned threads) {
    ViewCells cells;
    cells.made_for = slots;
    if (box.empty())
        return cells;
    cells.active = active.points.size() - arcs.count();
    const Grid grid(box, cells.active);
    const EdgeVisitor edges(arcs, active, slots, grid);
    const ColumnReferences sorted = sort_by_columns(edges, grid, slots.features.size(), threads);
    std::vector<CellLists> columns(size_t(grid.columns));
    parallel_for(columns.size(), 1, threads, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            ColumnBuilder(grid, slots, static_cast<int>(i))
                .build(Span<const Reference>(sorted.all)
                           .subspan(sorted.begins[i], sorted.begins[i + 1] - sorted.begins[i]),
                       columns[i]);
    });
    cells.corner = grid.corner;
    cells.bucket_bits = grid.bits;
    cells.columns = grid.columns;
    cells.rows = grid.rows;
    cells.lists = joined(columns, grid, threads);
    cells.cells = cells.lists.cells.size();
    cells.hiders = std::move(cells.lists.hiders);
    return cells;
}

}  // namespace decalgl::loops
