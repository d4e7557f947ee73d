// Arrays that are charged before they grow, and no larger than the shaders could read.
#pragma once

#include "decalgl/core/error.h"
#include "decalgl/core/large_array.h"
#include "decalgl/core/memory.h"

namespace decalgl::bvh {

// Texels in one array: what drivers read from one texture buffer as a rule. Hostile data asks for more, by
// way of features that repeat in every cell.
constexpr uint64_t largest_array = uint64_t{1} << 27;

inline void require_size(uint64_t count, const char* what) {
    if (count > largest_array)
        throw Error(ErrorKind::memory,
                    "the BVH index would need more than " + std::to_string(largest_array) + " " + what +
                        ", which no shader could read; use fewer cells, index=\"grid\", or "
                        "fewer features");
}

// New elements are not set.
template <typename T>
void grow(LargeArray<T>& array, uint64_t count, const char* what, MemoryCharge& charge) {
    require_size(count, what);
    charge.resize(charge.bytes() + (count - array.size()) * sizeof(T));
    array.resize(count);
}

// An array for the time of the work alone.
template <typename T>
struct WorkingArray {
    MemoryCharge charge;
    LargeArray<T> values;

    WorkingArray(const MemoryAccount& account, uint64_t count, const char* what)
        : charge(account, "static_bvh: working memory", 0) {
        grow(values, count, what, charge);
    }
};

}  // namespace decalgl::bvh
