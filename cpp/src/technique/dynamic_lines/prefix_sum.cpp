#include "technique/dynamic_lines/prefix_sum.h"

#include "technique/dynamic_lines/dispatch.h"

namespace decalgl {
namespace {

constexpr uint32_t run_length = 128;

uint32_t runs_of(uint32_t count) {
    return (count + run_length - 1) / run_length;
}

}  // namespace

PrefixSum::PrefixSum(uint32_t most_values, const MemoryAccount& memory) {
    uint32_t count = most_values;
    do {
        count = runs_of(count);
        sums_.push_back(gl::Buffer::create(memory, "dynamic: sums", sizeof(uint32_t) * count));
    } while (count > 1);
}

void PrefixSum::run(const gl::Buffer& values, uint32_t count, gl::ProgramLibrary& programs) {
    if (count > 0)
        run(0, values, count, programs);
}

void PrefixSum::run(size_t level, const gl::Buffer& values, uint32_t count, gl::ProgramLibrary& programs) {
    const uint32_t runs = runs_of(count);
    const auto add_up = [&](const gl::Flags& flags) {
        gl::Program& program = programs.get("dynamic_prefix_sum", flags);
        program.set("value_count", count);
        program.set("run_length", run_length);
        values.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        sums_[level].bind_base(GL_SHADER_STORAGE_BUFFER, 1);
        dispatch(program, runs);
    };
    if (runs == 1) {
        sums_[level].clear();
    } else {
        add_up({"TOTALS"});
        run(level + 1, sums_[level], runs, programs);
    }
    add_up({});
}

uint64_t PrefixSum::bytes() const {
    uint64_t bytes = 0;
    for (const gl::Buffer& sums : sums_)
        bytes += sums.bytes();
    return bytes;
}

}  // namespace decalgl
