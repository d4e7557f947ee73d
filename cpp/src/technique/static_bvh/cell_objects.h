// Objects by cell: lists of what reaches into each, and a tree over each list.
//
//     visit all objects, to count and to write (cell, object) ──▶ stable sort by cell ──▶ lists in order
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "decalgl/core/parallel.h"
#include "decalgl/core/progress.h"
#include "decalgl/core/radix_sort.h"
#include "technique/static_bvh/complete_tree.h"
#include "technique/static_bvh/prepared_bvh.h"
#include "technique/static_bvh/storage.h"

namespace decalgl::bvh {

constexpr size_t cells_at_once = 1024;

// A share of the whole work.
struct Stage {
    Progress* progress;
    double begin;
    double end;

    ShareFn report() const {
        return [stage = *this](double share) {
            stage.progress->report(stage.begin + share * (stage.end - stage.begin));
        };
    }
    Stage part(double from, double to) const {
        return {progress, begin + from * (end - begin), begin + to * (end - begin)};
    }
};

// An entry for each object in each cell that it reaches into, sorted by cell, otherwise in the objects'
// order.
struct CellRecords {
    WorkingArray<uint32_t> objects;
    WorkingArray<uint32_t> starts;  // of each cell, and the end

    // The objects of a cell.
    Span<uint32_t> of(uint32_t cell) {
        return {objects.values.data() + starts.values[cell], starts.values[cell + 1] - starts.values[cell]};
    }
};

unsigned bits_for(uint32_t values);

// Sorts by cell and finds where each cell begins.
CellRecords sort_records(WorkingArray<uint32_t> cells, WorkingArray<uint32_t> objects, uint32_t cell_count,
                         const TechniqueInput& input);

// `visit(begin, end, emit)` calls emit(cell, object) for what a range of `count` items, cut into blocks of
// `grain`, has to say; it is called twice for each block and says the same.
template <typename Visit>
CellRecords collect_records(size_t count, size_t grain, uint32_t cell_count, const TechniqueInput& input,
                            const Stage& stage, Visit visit) {
    std::vector<uint64_t> first(block_count(count, grain) + 1, 0);
    std::atomic<uint64_t> total{0};
    parallel_for(
        count, grain, input.threads,
        [&](size_t begin, size_t end) {
            uint64_t found = 0;
            visit(begin, end, [&found](uint32_t, uint32_t) { ++found; });
            first[begin / grain + 1] = found;
            // Here, since to count what can never be held might take minutes.
            require_size(total += found, "objects in cells");
        },
        stage.part(0.0, 0.4).report());
    for (size_t block = 1; block < first.size(); ++block)
        first[block] += first[block - 1];
    WorkingArray<uint32_t> cells(input.memory, first.back(), "objects in cells");
    WorkingArray<uint32_t> objects(input.memory, first.back(), "objects in cells");
    parallel_for(
        count, grain, input.threads,
        [&](size_t begin, size_t end) {
            uint64_t at = first[begin / grain];
            visit(begin, end, [&](uint32_t cell, uint32_t object) {
                cells.values[at] = cell;
                objects.values[at++] = object;
            });
        },
        stage.part(0.4, 0.8).report());
    return sort_records(std::move(cells), std::move(objects), cell_count, input);
}

// The trees of all cells, whose objects are counted already; box_of(cell, object) with places in the whole
// list.
template <typename BoxOf>
void plant_trees(GroupBuild& group, MemoryCharge& charge, unsigned threads, const Stage& stage,
                 BoxOf box_of) {
    const uint32_t cell_count = group.grid.cell_count();
    uint64_t total = 0;
    for (uint32_t cell = 0; cell < cell_count; ++cell) {
        group.cells[cell].node = static_cast<uint32_t>(total);
        total += stored_nodes(group.cells[cell].count);
        require_size(total, "tree nodes");
    }
    grow(group.nodes, total, "tree nodes", charge);
    parallel_for(
        cell_count, cells_at_once, threads,
        [&](size_t begin, size_t end) {
            std::vector<LatticeBox> boxes;
            for (size_t at = begin; at < end; ++at) {
                const auto cell = static_cast<uint32_t>(at);
                boxes.resize(group.cells[cell].count);
                for (uint32_t i = 0; i < boxes.size(); ++i)
                    boxes[i] = box_of(cell, group.cells[cell].object + i);
                fill_tree(boxes, group.nodes.data() + group.cells[cell].node);
            }
        },
        stage.report());
}

}  // namespace decalgl::bvh
