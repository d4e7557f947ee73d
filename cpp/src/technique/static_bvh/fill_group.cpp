#include "technique/static_bvh/fill_group.h"

#include "technique/static_bvh/quad_trees.h"

namespace decalgl::bvh {
namespace {

constexpr size_t parts_at_once = 64;
constexpr size_t strips_at_once = 16;
constexpr int32_t cells_in_strip = 4096;

uint32_t edge_count(const LatticePart& part) {
    return part.is_pairs ? part.vertex_count / 2 : part.vertex_count;
}

Edge upward(uint32_t a, uint32_t b, const LargeArray<LatticePoint>& vertices) {
    const LatticePoint p = vertices[a], q = vertices[b];
    return q.y < p.y || (q.y == p.y && q.x < p.x) ? Edge{b, a} : Edge{a, b};
}

}  // namespace

// The box of the part's edges, which are written.
LatticeBox FillBuilder::list_edges(const LatticePart& part, LargeArray<Edge>& edges) const {
    LatticeBox box;
    const uint32_t first = part.first_vertex;
    for (uint32_t i = 0; i < part.vertex_count; ++i)
        box.add(group_.ring_vertices[first + i]);
    for (uint32_t i = 0; i < edge_count(part); ++i)
        edges[first + i] = part.is_pairs
                               ? upward(first + 2 * i, first + 2 * i + 1, group_.ring_vertices)
                               : upward(first + i, first + (i + 1) % part.vertex_count, group_.ring_vertices);
    return box;
}

void FillBuilder::plant_quad_trees(const Lattice& lattice, const Stage& stage) {
    MemoryCharge working(input_.memory, "static_bvh: working memory", 0);
    LatticeParts rings_of = to_lattice(input_, polygons_.features, lattice, charge_, working);
    group_.ring_vertices = std::move(rings_of.vertices);
    const std::vector<LatticePart>& parts = rings_of.parts;
    WorkingArray<Edge> edges(input_.memory, group_.ring_vertices.size(), "edges");
    working.resize(working.bytes() + parts.size() * (sizeof(LatticeBox) + sizeof(Ring)));
    std::vector<LatticeBox> boxes(parts.size());
    parallel_for(parts.size(), parts_at_once, input_.threads, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            boxes[i] = common(list_edges(parts[i], edges.values), lattice.terrain);
    });
    std::vector<Ring> rings;
    for (size_t i = 0; i < parts.size(); ++i) {
        if (boxes[i].empty())
            continue;
        rings.push_back({boxes[i], parts[i].first_vertex, edge_count(parts[i])});
        owners_.push_back({parts[i].polygon, parts[i].is_first});
    }
    group_.quads = grow_quad_trees(input_, group_.ring_vertices, edges.values, rings, charge_, stage);
}

LatticeBox FillBuilder::common_box() const {
    LatticeBox box;
    for (size_t tree = 0; tree < owners_.size(); ++tree)
        box.add(group_.quads.boxes[tree]);
    return box;
}

CellRecords FillBuilder::records(const Stage& stage) const {
    const std::vector<Strip> strips = list_strips();
    return collect_records(strips.size(), strips_at_once, group_.grid.cell_count(), input_, stage,
                           [&](size_t begin, size_t end, auto emit) {
                               for (size_t i = begin; i < end; ++i)
                                   emit_cells(strips[i], emit);
                           });
}

WorkingArray<uint32_t> FillBuilder::write_exteriors(const Stage& stage) {
    CellRecords records = this->records(stage.part(0.0, 0.7));
    const uint64_t starts = uint64_t{group_.grid.cell_count()} + 1;
    WorkingArray<uint32_t> exterior_starts(input_.memory, starts, "cells");
    WorkingArray<uint32_t> interior_starts(input_.memory, starts, "cells");
    count_exteriors(records, exterior_starts.values, interior_starts.values);
    parallel_for(
        group_.grid.cell_count(), cells_at_once, input_.threads,
        [&](size_t begin, size_t end) {
            for (size_t cell = begin; cell < end; ++cell)
                write_cell(records, static_cast<uint32_t>(cell), exterior_starts.values[cell],
                           interior_starts.values[cell]);
        },
        stage.part(0.7, 1.0).report());
    return exterior_starts;
}

std::vector<FillBuilder::Strip> FillBuilder::list_strips() const {
    std::vector<Strip> strips;
    for (uint32_t tree = 0; tree < owners_.size(); ++tree) {
        const CellRange columns = group_.grid.columns_of(group_.quads.boxes[tree]);
        const CellRange rows = group_.grid.rows_of(group_.quads.boxes[tree]);
        const int32_t step = std::max(1, cells_in_strip / (columns.last - columns.first + 1));
        for (int32_t row = rows.first; row <= rows.last; row += step)
            strips.push_back({tree, {row, std::min(row + step - 1, rows.last)}});
    }
    return strips;
}

template <typename Emit>
void FillBuilder::emit_cells(const Strip& strip, const Emit& emit) const {
    const CellRange columns = group_.grid.columns_of(group_.quads.boxes[strip.tree]);
    for (int32_t row = strip.rows.first; row <= strip.rows.last; ++row) {
        for (int32_t column = columns.first; column <= columns.last; ++column) {
            const uint32_t cell = group_.grid.cell(column, row);
            if (holds_part(strip.tree, group_.grid.cell_box(cell)))
                emit(cell, strip.tree);
        }
    }
}

// Whether a leaf below the node that meets the cell is more than outside.
bool FillBuilder::holds_part(uint32_t node, const LatticeBox& cell) const {
    if (!group_.quads.boxes[node].meets(cell))
        return false;
    const QuadLink link = group_.quads.links[node];
    if (link.kind() != QUAD_INTERNAL)
        return link.kind() != QUAD_OUTSIDE;
    for (uint32_t child = link.first; child < link.first + 4; ++child)
        if (holds_part(child, cell))
            return true;
    return false;
}

// The smallest subtree with all that the cell and the tree have in common.
uint32_t FillBuilder::culled(uint32_t node, const LatticeBox& cell) const {
    while (group_.quads.links[node].kind() == QUAD_INTERNAL) {
        uint32_t met = 0, last = 0;
        for (uint32_t child = 0; child < 4; ++child) {
            const uint32_t at = group_.quads.links[node].first + child;
            if (group_.quads.boxes[at].meets(cell)) {
                last = at;
                ++met;
            }
        }
        if (met != 1)
            break;
        node = last;
    }
    return node;
}

// Trees of one polygon follow each other, its exterior first.
void FillBuilder::count_exteriors(CellRecords& records, LargeArray<uint32_t>& exterior_starts,
                                  LargeArray<uint32_t>& interior_starts) {
    uint64_t exteriors = 0, interiors = 0;
    for (uint32_t cell = 0; cell < group_.grid.cell_count(); ++cell) {
        exterior_starts[cell] = static_cast<uint32_t>(exteriors);
        interior_starts[cell] = static_cast<uint32_t>(interiors);
        int64_t polygon = -1;
        for (const uint32_t tree : records.of(cell)) {
            exteriors += owners_[tree].polygon != polygon ? 1 : 0;
            interiors += owners_[tree].is_exterior ? 0 : 1;
            polygon = owners_[tree].polygon;
        }
    }
    exterior_starts[group_.grid.cell_count()] = static_cast<uint32_t>(exteriors);
    grow(group_.exteriors, exteriors, "exteriors in cells", charge_);
    grow(group_.interiors, interiors, "interiors in cells", charge_);
    polygon_of_.resize(exteriors);
}

void FillBuilder::write_cell(CellRecords& records, uint32_t cell, uint32_t next, uint32_t interior) {
    const LatticeBox box = group_.grid.cell_box(cell);
    Exterior* exterior = nullptr;
    uint32_t polygon = 0;
    for (const uint32_t tree : records.of(cell)) {
        const Owner owner = owners_[tree];
        if (exterior == nullptr || polygon != owner.polygon) {
            polygon = owner.polygon;
            polygon_of_[next] = polygon;
            exterior = &group_.exteriors[next++];
            *exterior = {NO_SUBTREE, polygons_.slots[polygon], interior, 0};
        }
        if (owner.is_exterior) {
            exterior->subtree = culled(tree, box);
        } else {
            group_.interiors[interior++] = culled(tree, box);
            ++exterior->interior_count;
        }
    }
}

LatticeBox FillBuilder::box_of(uint32_t cell, uint32_t index) const {
    const Exterior& exterior = group_.exteriors[index];
    LatticeBox box = exterior.subtree == NO_SUBTREE ? LatticeBox{} : group_.quads.boxes[exterior.subtree];
    for (uint32_t i = 0; i < exterior.interior_count; ++i)
        box.add(group_.quads.boxes[group_.interiors[exterior.first_interior + i]]);
    return common(box, group_.grid.cell_box(cell));
}

}  // namespace decalgl::bvh
