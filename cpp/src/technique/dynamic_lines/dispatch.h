// Compute passes of one invocation an item.
#pragma once

#include <algorithm>
#include <cstdint>

#include "gl/buffer.h"
#include "gl/gl.h"
#include "gl/program.h"

namespace decalgl {

// local_size_x of every pass, and as many groups as every driver takes at once: 64 MiB of 16-byte results, which is
// within what a storage block may hold.
constexpr uint32_t group_size = 64;
constexpr uint32_t most_items_at_once = 65535 * group_size;

// Passes that follow see what those before wrote.
inline void finish_writes() {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

// Runs a program for items 0 .. count - 1, which it counts from its uniform `first_item`; `bind(first, count)` before
// each call.
template <typename Bind>
void dispatch(gl::Program& program, uint32_t count, Bind bind) {
    program.use();
    program.set("item_count", count);
    for (uint32_t first = 0; first < count; first += most_items_at_once) {
        const uint32_t items = std::min(count - first, most_items_at_once);
        program.set("first_item", first);
        bind(first, items);
        glDispatchCompute((items + group_size - 1) / group_size, 1, 1);
    }
    finish_writes();
}

inline void dispatch(gl::Program& program, uint32_t count) {
    dispatch(program, count, [](uint32_t, uint32_t) {});
}

// The part of a buffer that a call of dispatch writes, of records of so many bytes; the program counts from its beginning.
inline void bind_records(GLuint index, const gl::Buffer& buffer, size_t record_bytes, uint32_t first,
                         uint32_t count) {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, index, buffer.id(),
                      static_cast<GLintptr>(first * record_bytes),
                      static_cast<GLsizeiptr>(count * record_bytes));
}

}  // namespace decalgl
