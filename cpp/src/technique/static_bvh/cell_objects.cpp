#include "technique/static_bvh/cell_objects.h"

namespace decalgl::bvh {

unsigned bits_for(uint32_t values) {
    unsigned bits = 1;
    while (bits < 32 && (values - 1) >> bits != 0)
        ++bits;
    return bits;
}

CellRecords sort_records(WorkingArray<uint32_t> cells, WorkingArray<uint32_t> objects, uint32_t cell_count,
                         const TechniqueInput& input) {
    const size_t size = cells.values.size();
    {
        const MemoryCharge spare(input.memory, "static_bvh: working memory", 2 * size * sizeof(uint32_t));
        radix_sort(Span<uint32_t>(cells.values.data(), size), Span<uint32_t>(objects.values.data(), size),
                   input.threads, bits_for(cell_count));
    }
    WorkingArray<uint32_t> starts(input.memory, uint64_t{cell_count} + 1, "cells");
    parallel_for(size_t{cell_count} + 1, cells_at_once, input.threads, [&](size_t begin, size_t end) {
        auto at = std::lower_bound(cells.values.begin(), cells.values.end(), begin);
        for (size_t cell = begin; cell < end; ++cell) {
            while (at != cells.values.end() && *at < cell)
                ++at;
            starts.values[cell] = static_cast<uint32_t>(at - cells.values.begin());
        }
    });
    return {std::move(objects), std::move(starts)};
}

}  // namespace decalgl::bvh
