// Prefix sums on the GPU.
#pragma once

#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"

namespace decalgl {

class PrefixSum {
public:
    PrefixSum() = default;
    // For up to so many values.
    PrefixSum(uint32_t most_values, const MemoryAccount& memory);

    // Makes each of the first `count` words of a buffer the sum of those before it. With a last word of 0 it becomes the
    // sum of all.
    void run(const gl::Buffer& values, uint32_t count, gl::ProgramLibrary& programs);
    uint64_t bytes() const;

private:
    void run(size_t level, const gl::Buffer& values, uint32_t count, gl::ProgramLibrary& programs);

    std::vector<gl::Buffer> sums_;  // of runs of values, of runs of those, and so on
};

}  // namespace decalgl
