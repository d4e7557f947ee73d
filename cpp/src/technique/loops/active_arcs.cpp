#include "technique/loops/active_arcs.h"

namespace decalgl::loops {

LargeArray<Step> steps_of(const Arcs& arcs, const Refinement& refinement, unsigned threads) {
    LargeArray<Step> steps(arcs.points.size(), Step{0, 0});
    LargeArray<uint32_t> places(arcs.points.size());
    parallel_for(arcs.count(), 64, threads, [&](size_t begin, size_t end) {
        for (size_t arc = begin; arc < end; ++arc) {
            const uint32_t first = arcs.begin(arc), size = arcs.size_of(arc);
            // From the last to go on, so that parents come first.
            for (uint32_t i = size < 3 ? 0 : size - 2; i-- > 0;) {
                const uint32_t p = refinement.order[first + i], parent = refinement.parents[p];
                const uint32_t left = refinement.left[p], right = refinement.right[p];
                places[p] = first;
                if (parent != no_point)
                    places[p] = places[parent] + (p < parent ? 1 : parent - refinement.left[parent]);
                steps[places[p]] = {p, right - left - 1};
            }
        }
    });
    return steps;
}

}  // namespace decalgl::loops
