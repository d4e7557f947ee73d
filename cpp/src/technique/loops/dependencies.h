// Dependencies: what must go before a vertex may, so that nothing crosses anything that it did not cross before.
//
//               s                 When s goes, its sides a-s and s-b become a-b. That passes over no other vertex
//            / v  \               if whatever lies in the closed triangle has gone before: then what crosses a-b
//           a ----- b             crossed a side of it already. So v there needs s, as if s were its parent.
//
// Of the vertices in a triangle those count whose own parents lie outside: the others need theirs. Junctions
// never go, so s stays where one lies in its triangle. After sections 3 and 4.2 of LOOPS.
#pragma once

#include <utility>
#include <vector>

#include "technique/loops/refinement.h"

namespace decalgl::loops {

struct Dependencies {
    std::vector<std::pair<uint32_t, uint32_t>> needs;  // a splitter, and another one that it needs
    std::vector<uint8_t> stays;                        // of each point: a splitter that is never removed
};

Dependencies find_dependencies(const Arcs& arcs, const Locations& locations, const Refinement& refinement,
                               unsigned threads);

}  // namespace decalgl::loops
