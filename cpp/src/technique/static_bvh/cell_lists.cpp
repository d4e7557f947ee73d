#include "technique/static_bvh/cell_lists.h"

#include <algorithm>
#include <utility>

#include "technique/draw_order.h"
#include "technique/static_bvh/cell_objects.h"
#include "technique/static_bvh/stroke_group.h"

namespace decalgl::bvh {
namespace {

const char* const account = "static_bvh: prepared";

// An object of a cell: where it stands, its box in the cell's tree, and its place among the group's objects or among
// those that are added.
struct Entry {
    uint32_t order;
    uint32_t index;
    bool is_added;
    LatticeBox box;
};

bool lies_along_curve(const DecalGroup& group, const BvhOptions& options) {
    return group.kind == GroupKind::strokes && options.segment_order == SegmentOrder::hilbert;
}

// The objects of one cell, but those of slots without a rank. `slot_of(slot)` is the slot in `styled`.
template <typename SlotOf>
void list_cell(const DecalGroup& group, uint32_t cell, const DecalGroup& styled, bool along_curve,
               bool is_added, SlotOf slot_of, std::vector<Entry>& entries) {
    const CellStart start = group.cells[cell];
    const LatticeBox* leaves = group.nodes.data() + start.node + first_leaf(start.count) - 1;
    for (uint32_t i = 0; i < start.count; ++i) {
        const Object object = group.object(start.object + i);
        const uint32_t rank = styled.styles[slot_of(group.slot_of(object))].rank;
        if (rank == no_rank)
            continue;
        const uint32_t order =
            along_curve ? place_on_curve(group.segments[object.segment()], group.vertices, group.grid.box)
                        : rank;
        entries.push_back({order, start.object + i, is_added, leaves[i]});
    }
}

uint32_t itself(uint32_t slot) {
    return slot;
}

void sort_entries(std::vector<Entry>& entries) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.order < b.order; });
}

std::vector<LatticeBox> boxes_of(const std::vector<Entry>& entries) {
    std::vector<LatticeBox> boxes;
    for (const Entry& entry : entries)
        boxes.push_back(entry.box);
    return boxes;
}

using Parts = GroupOf<GrownArray>;

// Calls with the array that the objects of cells lie in.
template <typename OnArray>
void with_objects(GroupKind kind, OnArray on_array) {
    switch (kind) {
        case GroupKind::strokes:
            on_array(&Parts::segments);
            break;
        case GroupKind::fills:
            on_array(&Parts::exteriors);
            break;
        case GroupKind::both:
            on_array(&Parts::objects);
            break;
    }
}

// What is added, with places in the group that it is added to.
class Renumbering {
public:
    Renumbering(const DecalGroup& group, const std::vector<uint32_t>& slot_of)
        : slot_of_(slot_of),
          vertex_(size(group.vertices)),
          ring_vertex_(size(group.ring_vertices)),
          interior_(size(group.interiors)),
          quad_(size(group.quads.boxes)),
          leaf_edge_(size(group.quads.edges)),
          segment_(size(group.segments)),
          exterior_(size(group.exteriors)) {}

    uint32_t slot(uint32_t of) const { return of == NO_SLOT ? NO_SLOT : slot_of_[of]; }
    uint32_t subtree(uint32_t of) const { return of == NO_SUBTREE ? NO_SUBTREE : of + quad_; }
    Segment operator()(Segment of) const { return {of.a + vertex_, of.b + vertex_}; }
    Exterior operator()(const Exterior& of) const {
        return {subtree(of.subtree), slot(of.slot), of.first_interior + interior_, of.interior_count};
    }
    Object operator()(Object of) const {
        return {of.place + (of.is_stroke() ? segment_ : exterior_),
                of.exterior == NO_EXTERIOR ? NO_EXTERIOR : of.exterior + exterior_};
    }
    QuadLink operator()(QuadLink of) const {
        const uint32_t first = of.kind() == QUAD_INTERNAL  ? quad_
                               : of.kind() == QUAD_PARTIAL ? leaf_edge_
                                                           : 0;
        return {of.kind_and_count, of.first + first};
    }
    LeafEdge operator()(const LeafEdge& of) const {
        if (of.a == CLOSING_EDGE)
            return of;
        return {of.a + ring_vertex_, of.b + ring_vertex_, of.first_row, of.end_row};
    }

private:
    template <typename Array>
    static uint32_t size(const Array& array) {
        return static_cast<uint32_t>(array.size());
    }

    const std::vector<uint32_t>& slot_of_;
    uint32_t vertex_, ring_vertex_, interior_, quad_, leaf_edge_, segment_, exterior_;
};

template <typename T, typename Change>
LargeArray<T> changed(const GrownArray<T>& values, Change change) {
    LargeArray<T> result;
    result.reserve(values.size());
    for (const T& value : values)
        result.push_back(change(value));
    return result;
}

template <typename T>
void append(GrownArray<T>& array, Span<const T> more, const char* what, const MemoryAccount& memory) {
    require_size(array.size() + more.size(), what);
    array.append(more, memory, account);
}

// All that objects refer to.
void append_geometry(DecalGroup& group, const DecalGroup& local, const Renumbering& renumbered,
                     const MemoryAccount& memory) {
    LargeArray<uint32_t> owners(local.owners.begin(), local.owners.end());
    for (size_t i = 0; i < owners.size(); i += group.owner_size())
        owners[i] = renumbered.slot(owners[i]);
    append<LatticePoint>(group.vertices, local.vertices, "vertices", memory);
    append<uint32_t>(group.owners, owners, "vertices", memory);
    append<LatticePoint>(group.ring_vertices, local.ring_vertices, "vertices", memory);
    append<uint32_t>(group.interiors,
                     changed(local.interiors, [&](uint32_t subtree) { return renumbered.subtree(subtree); }),
                     "interiors in cells", memory);
    append<LatticeBox>(group.quads.boxes, local.quads.boxes, "quad-tree nodes", memory);
    append<QuadLink>(group.quads.links, changed(local.quads.links, renumbered), "quad-tree nodes", memory);
    append<LeafEdge>(group.quads.edges, changed(local.quads.edges, renumbered), "edges in leaves", memory);
    if (group.kind != GroupKind::both)
        return;
    append<Segment>(group.segments, changed(local.segments, renumbered), "segments in cells", memory);
    append<Exterior>(group.exteriors, changed(local.exteriors, renumbered), "exteriors in cells", memory);
}

template <typename T>
void sort_objects(DecalGroup& group, GrownArray<T> Parts::*array, unsigned threads,
                  const MemoryAccount& memory) {
    const DecalGroup before = group;
    LargeArray<CellStart> cells(group.cells.begin(), group.cells.end());
    const auto sort = [&](T* objects, LatticeBox* nodes) {
        parallel_for(cells.size(), cells_at_once, threads, [&](size_t begin, size_t end) {
            std::vector<Entry> entries;
            for (size_t cell = begin; cell < end; ++cell) {
                entries.clear();
                list_cell(before, static_cast<uint32_t>(cell), before, false, false, itself, entries);
                sort_entries(entries);
                for (uint32_t i = 0; i < entries.size(); ++i)
                    objects[cells[cell].object + i] = (before.*array)[entries[i].index];
                fill_tree(boxes_of(entries), nodes + cells[cell].node);
                cells[cell].count = static_cast<uint32_t>(entries.size());
            }
        });
    };
    // Edits go on in the same arrays.
    (group.*array).change(memory, account, [&](T* objects) {
        group.nodes.change(memory, account, [&](LatticeBox* nodes) { sort(objects, nodes); });
    });
    group.cells = charged(SharedArray<CellStart>(std::move(cells)), memory, account);
}

template <typename T>
std::vector<uint32_t> merge_objects(DecalGroup& group, const DecalGroup& local, GrownArray<T> Parts::*array,
                                    const std::vector<uint32_t>& slot_of, const Renumbering& renumbered,
                                    bool along_curve, const MemoryAccount& memory) {
    const GrownArray<T>&before = group.*array, &added = local.*array;
    LargeArray<CellStart> cells(group.cells.begin(), group.cells.end());
    LargeArray<LatticeBox> nodes;
    LargeArray<T> objects;
    std::vector<Entry> entries;
    std::vector<uint32_t> touched;
    for (uint32_t cell = 0; cell < cells.size(); ++cell) {
        if (local.cells[cell].count == 0)
            continue;
        touched.push_back(cell);
        entries.clear();
        list_cell(group, cell, group, along_curve, false, itself, entries);
        list_cell(
            local, cell, group, along_curve, true, [&](uint32_t slot) { return slot_of[slot]; }, entries);
        sort_entries(entries);
        group.spent += cells[cell].count;
        const auto count = static_cast<uint32_t>(entries.size());
        cells[cell] = {static_cast<uint32_t>(group.nodes.size() + nodes.size()),
                       static_cast<uint32_t>(before.size() + objects.size()), count, 0};
        for (const Entry& entry : entries)
            objects.push_back(entry.is_added ? renumbered(added[entry.index]) : before[entry.index]);
        nodes.resize(nodes.size() + stored_nodes(count));
        fill_tree(boxes_of(entries), nodes.data() + nodes.size() - stored_nodes(count));
    }
    append<T>(group.*array, objects, "objects in cells", memory);
    append<LatticeBox>(group.nodes, nodes, "tree nodes", memory);
    group.cells = charged(SharedArray<CellStart>(std::move(cells)), memory, account);
    return touched;
}

}  // namespace

void sort_cells(DecalGroup& group, const BvhOptions& options, unsigned threads, const MemoryAccount& memory) {
    if (!lies_along_curve(group, options))
        with_objects(group.kind, [&](auto array) { sort_objects(group, array, threads, memory); });
}

std::vector<uint32_t> add_objects(DecalGroup& group, const DecalGroup& local,
                                  const std::vector<uint32_t>& slot_of, const BvhOptions& options,
                                  const MemoryAccount& memory) {
    const Renumbering renumbered(group, slot_of);
    std::vector<uint32_t> touched;
    with_objects(group.kind, [&](auto array) {
        touched =
            merge_objects(group, local, array, slot_of, renumbered, lies_along_curve(group, options), memory);
    });
    append_geometry(group, local, renumbered, memory);
    return touched;
}

}  // namespace decalgl::bvh
