// The view's uniform block lies in GLSL where C++ writes it.
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <map>
#include <string>

#include "gl/program.h"
#include "gl_fixture.h"
#include "shared/view_block.h"

using namespace decalgl;

namespace {

const std::map<std::string, size_t> offsets{
    {"clip_from_base", offsetof(ViewBlock, clip_from_base)},
    {"forward", offsetof(ViewBlock, forward)},
    {"ray_direction", offsetof(ViewBlock, ray_direction)},
    {"ray_direction_dx", offsetof(ViewBlock, ray_direction_dx)},
    {"ray_direction_dy", offsetof(ViewBlock, ray_direction_dy)},
    {"ray_origin_dx", offsetof(ViewBlock, ray_origin_dx)},
    {"ray_origin_dy", offsetof(ViewBlock, ray_origin_dy)},
    {"base_offset", offsetof(ViewBlock, base_offset)},
    {"base_sample_fraction", offsetof(ViewBlock, base_sample_fraction)},
    {"spacing", offsetof(ViewBlock, spacing)},
    {"base_block", offsetof(ViewBlock, base_block)},
    {"base_sample", offsetof(ViewBlock, base_sample)},
    {"samples", offsetof(ViewBlock, samples)},
    {"picture", offsetof(ViewBlock, picture)},
    {"jitter", offsetof(ViewBlock, jitter)},
};

}  // namespace

TEST_CASE("the view block has the same layout in C++ and GLSL") {
    test::test_context();
    const gl::Program program = gl::Program::create("terrain");
    const GLuint block = glGetUniformBlockIndex(program.id(), "ViewBlock");
    REQUIRE(block != GL_INVALID_INDEX);
    GLint size = 0;
    glGetActiveUniformBlockiv(program.id(), block, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
    CHECK(static_cast<size_t>(size) == sizeof(ViewBlock));
    GLint binding = -1;
    glGetActiveUniformBlockiv(program.id(), block, GL_UNIFORM_BLOCK_BINDING, &binding);
    CHECK(binding == 0);

    size_t found = 0;
    GLint uniforms = 0;
    glGetProgramiv(program.id(), GL_ACTIVE_UNIFORMS, &uniforms);
    for (GLuint index = 0; index < static_cast<GLuint>(uniforms); ++index) {
        GLint owner = -1;
        glGetActiveUniformsiv(program.id(), 1, &index, GL_UNIFORM_BLOCK_INDEX, &owner);
        if (owner != static_cast<GLint>(block)) {
            continue;
        }
        std::array<char, 64> name{};
        GLint type_size = 0;
        GLenum type = 0;
        glGetActiveUniform(program.id(), index, name.size(), nullptr, &type_size, &type, name.data());
        GLint offset = -1;
        glGetActiveUniformsiv(program.id(), 1, &index, GL_UNIFORM_OFFSET, &offset);
        INFO(name.data());
        REQUIRE(offsets.count(name.data()) == 1);
        CHECK(static_cast<size_t>(offset) == offsets.at(name.data()));
        ++found;
    }
    // std140 keeps members that no shader reads; a driver may still not list them.
    CHECK(found >= 12);
    CHECK(found <= offsets.size());
}
