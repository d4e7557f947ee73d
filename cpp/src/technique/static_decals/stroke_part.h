// One part of a feature as a stroke sees it: which vertices follow each other, where there is a corner and where
// an end.
//
//     open line      0--1--2--3          edges end at 1, 2, 3
//     closed line    0--1--2--0'         the same, and a corner where 0' meets 0
//     ring           0--1--2--(0)        edges end at 0, 1, 2
//
// A corner belongs to the two edges beside it, one after the other: where a part is closed, its first edge comes once more
// after the last.
#pragma once

#include <cstddef>

namespace decalgl {

struct StrokePart {
    const double* vertices;  // of the layer
    size_t begin;            // counted in the layer
    size_t end;
    bool is_ring;

    bool is_closed() const {
        const double* last = vertices + 2 * (end - 1);
        return is_ring ||
               (end - begin >= 4 && vertices[2 * begin] == last[0] && vertices[2 * begin + 1] == last[1]);
    }
    // A ring of fewer vertices has no border.
    bool is_drawn() const { return end > begin && (!is_ring || end - begin >= 3); }
    // The vertex before or after one; `end` where there is none.
    size_t before(size_t vertex) const {
        return vertex > begin ? vertex - 1 : is_ring ? end - 1 : is_closed() ? end - 2 : end;
    }
    size_t after(size_t vertex) const {
        return vertex + 1 < end ? vertex + 1 : is_ring ? begin : is_closed() ? begin + 1 : end;
    }
};

}  // namespace decalgl
