#include "technique/static_bvh/polygon_group.h"

#include "technique/static_bvh/quad_trees.h"

namespace decalgl::bvh {
namespace {

constexpr size_t parts_at_once = 64;
constexpr size_t strips_at_once = 16;
constexpr int32_t cells_in_strip = 4096;

// A ring's tree has the ring's number.
struct Owner {
    uint32_t slot;
    bool is_exterior;
};

// Rows of cells that a tree's box meets.
struct Strip {
    uint32_t tree;
    CellRange rows;
};

uint32_t edge_count(const LatticePart& part) {
    return part.is_pairs ? part.vertex_count / 2 : part.vertex_count;
}

Edge upward(uint32_t a, uint32_t b, const LargeArray<LatticePoint>& vertices) {
    const LatticePoint p = vertices[a], q = vertices[b];
    return q.y < p.y || (q.y == p.y && q.x < p.x) ? Edge{b, a} : Edge{a, b};
}

class PolygonBuilder {
public:
    PolygonBuilder(const TechniqueInput& input, DecalGroup& group, MemoryCharge& charge)
        : input_(input), group_(group), charge_(charge) {}

    void plant_quad_trees(const std::vector<LatticePart>& parts, const LatticeBox& terrain,
                          const Stage& stage) {
        WorkingArray<Edge> edges(input_.memory, group_.vertices.size(), "edges");
        const MemoryCharge working(input_.memory, "static_bvh: working memory",
                                   parts.size() * (sizeof(LatticeBox) + sizeof(Ring)));
        std::vector<LatticeBox> boxes(parts.size(), empty_box);
        parallel_for(parts.size(), parts_at_once, input_.threads, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i)
                boxes[i] = common(list_edges(parts[i], edges.values), terrain);
        });
        std::vector<Ring> rings;
        for (size_t i = 0; i < parts.size(); ++i) {
            if (boxes[i].empty())
                continue;
            rings.push_back({boxes[i], parts[i].first_vertex, edge_count(parts[i])});
            owners_.push_back({parts[i].slot, parts[i].is_first});
        }
        group_.quads = grow_quad_trees(input_, group_.vertices, edges.values, rings, charge_, stage);
    }

    void lay_grid() {
        LatticeBox box = empty_box;
        for (size_t tree = 0; tree < owners_.size(); ++tree)
            box = merged(box, group_.quads.boxes[tree]);
        group_.grid = DecalGrid::over(box, input_.bvh.cells);
    }

    CellRecords records(const Stage& stage) const {
        const std::vector<Strip> strips = list_strips();
        return collect_records(strips.size(), strips_at_once, group_.grid.cell_count(), input_, stage,
                               [&](size_t begin, size_t end, auto emit) {
                                   for (size_t i = begin; i < end; ++i)
                                       emit_cells(strips[i], emit);
                               });
    }

    void write_objects(CellRecords records, const Stage& stage) {
        grow(group_.cells, uint64_t{group_.grid.cell_count()} + 1, "cells", charge_);
        WorkingArray<uint32_t> interior_starts(input_.memory, group_.cells.size(), "cells");
        count_objects(records, interior_starts.values);
        parallel_for(group_.grid.cell_count(), cells_at_once, input_.threads, [&](size_t begin, size_t end) {
            for (size_t cell = begin; cell < end; ++cell)
                write_cell(records, static_cast<uint32_t>(cell), interior_starts.values[cell]);
        });
        plant_trees(group_, charge_, input_.threads, stage,
                    [&](uint32_t cell, uint32_t object) { return box_of(cell, group_.exteriors[object]); });
    }

private:
    // The box of the part's edges, which are written.
    LatticeBox list_edges(const LatticePart& part, LargeArray<Edge>& edges) const {
        LatticeBox box = empty_box;
        const uint32_t first = part.first_vertex;
        for (uint32_t i = 0; i < part.vertex_count; ++i) {
            const LatticePoint p = group_.vertices[first + i];
            box = merged(box, {p.x, p.y, p.x, p.y});
        }
        for (uint32_t i = 0; i < edge_count(part); ++i)
            edges[first + i] = part.is_pairs
                                   ? upward(first + 2 * i, first + 2 * i + 1, group_.vertices)
                                   : upward(first + i, first + (i + 1) % part.vertex_count, group_.vertices);
        return box;
    }

    std::vector<Strip> list_strips() const {
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
    void emit_cells(const Strip& strip, const Emit& emit) const {
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
    bool holds_part(uint32_t node, const LatticeBox& cell) const {
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
    uint32_t culled(uint32_t node, const LatticeBox& cell) const {
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

    // Trees of one feature follow each other, its exterior first.
    void count_objects(CellRecords& records, LargeArray<uint32_t>& interior_starts) {
        uint64_t exteriors = 0, interiors = 0;
        for (uint32_t cell = 0; cell < group_.grid.cell_count(); ++cell) {
            group_.cells[cell].object = static_cast<uint32_t>(exteriors);
            interior_starts[cell] = static_cast<uint32_t>(interiors);
            int64_t slot = -1;
            for (const uint32_t tree : records.of(cell)) {
                exteriors += owners_[tree].slot != slot ? 1 : 0;
                interiors += owners_[tree].is_exterior ? 0 : 1;
                slot = owners_[tree].slot;
            }
        }
        group_.cells[group_.grid.cell_count()].object = static_cast<uint32_t>(exteriors);
        grow(group_.exteriors, exteriors, "exteriors in cells", charge_);
        grow(group_.interiors, interiors, "interiors in cells", charge_);
    }

    void write_cell(CellRecords& records, uint32_t cell, uint32_t interior) {
        const LatticeBox box = group_.grid.cell_box(cell);
        uint32_t next = group_.cells[cell].object;
        Exterior* exterior = nullptr;
        for (const uint32_t tree : records.of(cell)) {
            const Owner owner = owners_[tree];
            if (exterior == nullptr || exterior->slot != owner.slot) {
                exterior = &group_.exteriors[next++];
                *exterior = {NO_SUBTREE, owner.slot, interior, 0};
            }
            if (owner.is_exterior) {
                exterior->subtree = culled(tree, box);
            } else {
                group_.interiors[interior++] = culled(tree, box);
                ++exterior->interior_count;
            }
        }
    }

    LatticeBox box_of(uint32_t cell, const Exterior& exterior) const {
        LatticeBox box = exterior.subtree == NO_SUBTREE ? empty_box : group_.quads.boxes[exterior.subtree];
        for (uint32_t i = 0; i < exterior.interior_count; ++i)
            box = merged(box, group_.quads.boxes[group_.interiors[exterior.first_interior + i]]);
        return common(box, group_.grid.cell_box(cell));
    }

    const TechniqueInput& input_;
    DecalGroup& group_;
    MemoryCharge& charge_;
    std::vector<Owner> owners_;
};

}  // namespace

void build_polygons(const TechniqueInput& input, LatticeParts parts, const Lattice& lattice,
                    DecalGroup& group, MemoryCharge& charge, const Stage& stage) {
    group.vertices = std::move(parts.vertices);
    PolygonBuilder builder(input, group, charge);
    builder.plant_quad_trees(parts.parts, lattice.terrain, stage.part(0.0, 0.5));
    builder.lay_grid();
    builder.write_objects(builder.records(stage.part(0.5, 0.8)), stage.part(0.8, 1.0));
}

}  // namespace decalgl::bvh
