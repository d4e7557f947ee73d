#include "technique/static_bvh/walk_length.h"

#include "decalgl/core/parallel.h"
#include "technique/static_bvh/complete_tree.h"
#include "technique/static_bvh/looks.h"
#include "technique/static_bvh/quad_walk.h"

namespace decalgl::bvh {
namespace {

constexpr size_t cells_at_once = 1024;
// A longer walk than this is looked at more closely, in so many parts of the cell along each side.
constexpr uint64_t long_walk = 512;
constexpr int32_t parts = 8;

uint64_t walk_through(const DecalGroup& group, const Exterior& exterior, const LatticeBox& box) {
    uint64_t turns = exterior.subtree == NO_SUBTREE ? 0 : longest_way(group.quads, exterior.subtree, box);
    for (uint32_t i = 0; i < exterior.interior_count; ++i)
        turns += 1 + longest_way(group.quads, group.interiors[exterior.first_interior + i], box);
    return turns;
}

// The marks and bands of a stroke, and the rings that it is cut at.
uint64_t walk_through(const DecalGroup& group, Object object, const LatticeBox& box) {
    if (!object.is_stroke())
        return walk_through(group, group.exteriors[object.place], box);
    uint64_t turns = 0;
    if (group.needs.patterns || group.needs.bands) {
        const StrokeLook look = stroke_look(group, group.styles[group.slot_of(object)].look);
        turns += look.mark_count + look.band_count;
    }
    if (group.cut != OutlineMode::normal && object.exterior != NO_EXTERIOR)
        turns += walk_through(group, group.exteriors[object.exterior], box);
    return turns;
}

// What a point would look at that is everywhere in a box at once.
uint64_t walk_in(const DecalGroup& group, uint32_t cell, const LatticeBox& box) {
    const CellStart start = group.cells[cell];
    uint64_t below = 0;
    const bool has_more = group.kind != GroupKind::strokes || group.needs.patterns || group.needs.bands;
    const auto reached = [&](const LatticeBox& node) { return node.meets(box); };
    const auto on_object = [&](uint32_t object) {
        if (has_more)
            below += walk_through(group, group.object(start.object + object), box);
        return true;
    };
    const uint32_t nodes =
        traverse(group.nodes.data() + start.node, group.cells[cell].count, reached, on_object);
    return nodes + below;
}

uint64_t longest_walk_in(const DecalGroup& group, uint32_t cell) {
    const LatticeBox box = group.grid.cell_box(cell);
    const uint64_t whole = walk_in(group, cell, box);
    if (whole <= long_walk)
        return whole;
    const int32_t width = (box.max_x - box.min_x) / parts + 1, height = (box.max_y - box.min_y) / parts + 1;
    uint64_t longest = 0;
    for (int32_t i = 0; i < parts * parts; ++i) {
        const int32_t x = box.min_x + i % parts * width, y = box.min_y + i / parts * height;
        longest = std::max(longest, walk_in(group, cell, {x, y, x + width - 1, y + height - 1}));
    }
    return longest;
}

}  // namespace

uint64_t longest_walk(const DecalGroup& group, Span<const uint32_t> cells) {
    uint64_t longest = 0;
    for (const uint32_t cell : cells)
        longest = std::max(longest, group.cells[cell].count > 0 ? longest_walk_in(group, cell) : 0);
    return longest;
}

uint64_t longest_walk(const DecalGroup& group, unsigned threads) {
    std::vector<uint64_t> longest(block_count(group.grid.cell_count(), cells_at_once), 0);
    parallel_for(group.grid.cell_count(), cells_at_once, threads, [&](size_t begin, size_t end) {
        for (size_t cell = begin; cell < end; ++cell) {
            uint64_t& most = longest[begin / cells_at_once];
            if (group.cells[cell].count > 0)
                most = std::max(most, longest_walk_in(group, static_cast<uint32_t>(cell)));
        }
    });
    return longest.empty() ? 0 : *std::max_element(longest.begin(), longest.end());
}

}  // namespace decalgl::bvh
