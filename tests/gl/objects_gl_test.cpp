// Buffers, textures, framebuffers, vertex arrays, programs, timers: one small use of each, and its errors.

#include "gl_fixture.h"

#include "gl/buffer.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gl/readback.h"
#include "gl/shader_source.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"

#include <catch2/catch.hpp>

#include <cstdint>
#include <string>
#include <vector>

using namespace decalgl;
using namespace decalgl::gl;
using test::test_context;

namespace {

const char* const full_screen = R"(#version 450 core
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
})";

std::string message_of(const std::function<void()>& action, ErrorKind kind) {
    try {
        action();
    } catch (const Error& error) {
        CHECK(error.kind() == kind);
        return error.what();
    }
    FAIL("no Error was thrown");
    return {};
}

/// Draws a full-screen triangle into 4 x 2 pixels of four floats.
std::vector<float> draw(Program& program) {
    const MemoryAccount account;
    const Texture2D color = Texture2D::create(account, "color", GL_RGBA32F, 4, 2);
    const Framebuffer framebuffer = Framebuffer::create("target", {{GL_COLOR_ATTACHMENT0, &color}});
    const VertexArray empty = VertexArray::create();
    framebuffer.bind();
    program.use();
    empty.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return read_pixels<float>(framebuffer, GL_COLOR_ATTACHMENT0, 0, 0, 4, 2, transfer_format(GL_RGBA32F), 4);
}

}  // namespace

TEST_CASE("a buffer keeps its bytes and is charged for them") {
    test_context();
    const MemoryAccount account;
    {
        Buffer buffer =
            Buffer::from(account, "cells", std::vector<std::uint32_t>{1, 2, 3}, GL_DYNAMIC_STORAGE_BIT);
        CHECK(account.bytes("cells") == 12);
        const std::uint32_t seven = 7;
        buffer.update(4, 4, &seven);
        CHECK(buffer.read<std::uint32_t>() == std::vector<std::uint32_t>{1, 7, 3});
        buffer.clear();
        CHECK(buffer.read<std::uint32_t>() == std::vector<std::uint32_t>{0, 0, 0});
        CHECK_THROWS_AS(buffer.update(8, 8, &seven), Error);
        const Buffer moved = std::move(buffer);
        CHECK(!buffer);
        CHECK(moved.bytes() == 12);
    }
    CHECK(account.total() == 0);
    CHECK(Buffer::from(account, "nothing", std::vector<int>{}).read<int>().empty());
    check_errors("using buffers");
}

TEST_CASE("the budget and the driver's limits hold before anything is made") {
    Context& context = test_context();
    const MemoryAccount small(1000);
    CHECK_THAT(message_of([&] { Buffer::create(small, "references", 2000); }, ErrorKind::memory),
               Catch::Contains("references"));
    CHECK_THAT(message_of([&] { Texture2D::create(small, "image", GL_RGBA8, 100, 100); }, ErrorKind::memory),
               Catch::Contains("image"));
    const MemoryAccount account;
    const int side = context.info().max_texture_size + 1;
    CHECK_THAT(message_of([&] { Texture2D::create(account, "poster", GL_R8, side, 1); }, ErrorKind::memory),
               Catch::Contains(std::to_string(side)));
    message_of([&] { Texture2D::create(account, "nothing", GL_R8, 0, 1); }, ErrorKind::input);
    const auto texels = static_cast<std::size_t>(context.info().max_texture_buffer_size) + 1;
    CHECK_THAT(
        message_of([&] { TextureBuffer::create(account, "cells", GL_R8UI, texels); }, ErrorKind::memory),
        Catch::Contains("cells"));
    CHECK(account.total() == 0);
    CHECK(small.total() == 0);
}

TEST_CASE("textures of every transfer format read back what was written") {
    test_context();
    const MemoryAccount account;
    for (const GLenum format :
         {GL_R8, GL_RGBA8, GL_RG16UI, GL_RGBA16UI, GL_R32I, GL_RG32I, GL_R32F, GL_RGBA32F}) {
        Texture2D texture = Texture2D::create(account, "texture", format, 3, 2);
        std::vector<std::uint8_t> texels(6 * texel_bytes(format));
        for (std::size_t index = 0; index < texels.size(); ++index) {
            texels[index] = static_cast<std::uint8_t>(index & 63);  // never a NaN
        }
        CHECK(texture.bytes() == texels.size());
        texture.update(0, 0, 0, 3, 2, texels.data());
        CHECK(read_texture<std::uint8_t>(texture) == texels);
    }
    const Texture2D levels = Texture2D::create(account, "levels", GL_R32F, 5, 3, 3);
    CHECK(levels.bytes() == (15 + 2 + 1) * 4);
    check_errors("using textures");
}

TEST_CASE("a framebuffer clears, copies and reads each attachment") {
    test_context();
    const MemoryAccount account;
    const Texture2D color = Texture2D::create(account, "color", GL_RGBA8, 4, 4);
    const Texture2D ids = Texture2D::create(account, "ids", GL_R32I, 4, 4);
    const Texture2D depth = Texture2D::create(account, "depth", GL_DEPTH32F_STENCIL8, 4, 4);
    const Framebuffer source = Framebuffer::create("source", {{GL_COLOR_ATTACHMENT0, &color},
                                                              {GL_COLOR_ATTACHMENT0 + 1, &ids},
                                                              {GL_DEPTH_STENCIL_ATTACHMENT, &depth}});
    source.clear_color(0, 1.0F, 0.0F, 0.2F, 1.0F);
    source.clear_color_int(1, -1);
    source.clear_depth_stencil(0.25F, 3);
    const auto pixels =
        read_pixels<std::uint8_t>(source, GL_COLOR_ATTACHMENT0, 1, 1, 1, 1, transfer_format(GL_RGBA8), 4);
    CHECK(pixels == std::vector<std::uint8_t>{255, 0, 51, 255});
    CHECK(read_pixels<std::int32_t>(source, GL_COLOR_ATTACHMENT0 + 1, 0, 0, 4, 4, transfer_format(GL_R32I),
                                    1) == std::vector<std::int32_t>(16, -1));

    const Texture2D copy = Texture2D::create(account, "copy", GL_DEPTH32F_STENCIL8, 4, 4);
    const Framebuffer target = Framebuffer::create("target", {{GL_DEPTH_STENCIL_ATTACHMENT, &copy}});
    source.blit_to(target, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    CHECK(read_pixels<float>(target, GL_DEPTH_ATTACHMENT, 2, 2, 1, 1, {GL_DEPTH_COMPONENT, GL_FLOAT}, 1) ==
          std::vector<float>{0.25F});
    check_errors("using framebuffers");

    const Texture2D samples = Texture2D::create(account, "samples", GL_RGBA8, 4, 4, 1, 4);
    CHECK_THAT(message_of(
                   [&] {
                       Framebuffer::create(
                           "mixed", {{GL_COLOR_ATTACHMENT0, &samples}, {GL_COLOR_ATTACHMENT0 + 1, &ids}});
                   },
                   ErrorKind::graphics),
               Catch::Contains("mixed") && Catch::Contains("samples"));
}

TEST_CASE("vertex arrays feed attributes of both kinds") {
    test_context();
    const MemoryAccount account;
    Program program = Program::from_source("attributes", R"(#version 450 core
layout(location = 0) in vec2 corner;
layout(location = 1) in uint tag;
flat out uint tag_out;
void main() {
    tag_out = tag;
    gl_Position = vec4(corner, 0.0, 1.0);
})",
                                           R"(#version 450 core
flat in uint tag_out;
out vec4 color;
void main() { color = vec4(float(tag_out), 0.0, 0.0, 1.0); })");
    struct Vertex {
        float x;
        float y;
        std::uint32_t tag;
    };
    const Buffer vertices =
        Buffer::from(account, "vertices", std::vector<Vertex>{{-1, -1, 5}, {3, -1, 5}, {-1, 3, 5}});
    const Buffer elements = Buffer::from(account, "elements", std::vector<std::uint16_t>{0, 1, 2});
    VertexArray array = VertexArray::create();
    array.set_vertices(0, vertices, sizeof(Vertex), {{0, 2, GL_FLOAT, 0}, {1, 1, GL_UNSIGNED_INT, 8, true}});
    array.set_elements(elements);
    const Texture2D color = Texture2D::create(account, "color", GL_R32F, 2, 2);
    const Framebuffer framebuffer = Framebuffer::create("target", {{GL_COLOR_ATTACHMENT0, &color}});
    framebuffer.bind();
    program.use();
    array.bind();
    glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, nullptr);
    CHECK(read_texture<float>(color) == std::vector<float>(4, 5.0F));
    check_errors("drawing elements");
}

TEST_CASE("programs take uniforms and texture buffers, and refuse names they do not have") {
    test_context();
    const MemoryAccount account;
    Program program = Program::from_source("uniforms", full_screen, R"(#version 450 core
uniform float scale;
uniform ivec2 shift;
uniform vec4 weights[2];
uniform mat4 never_used;
layout(binding = 3) uniform usamplerBuffer cells;
out vec4 color;
void main() {
    uint cell = texelFetch(cells, int(gl_FragCoord.x) + shift.x).r;
    color = scale * float(cell) * weights[1] + weights[0];
})");
    const TextureBuffer cells =
        TextureBuffer::from(account, "cells", GL_R16UI, std::vector<std::uint16_t>{0, 10, 20, 30, 40});
    CHECK(cells.texels() == 5);
    cells.bind(3);
    program.set("scale", 2.0F);
    program.set("shift", glm::ivec2(1, 0));
    program.set("never_used", glm::mat4(1.0F));
    const std::vector<glm::vec4> weights{{0, 0, 0, 1}, {1, 0, 0.5F, 0}};
    program.set_array("weights", weights);
    const std::vector<float> pixels = draw(program);
    CHECK(std::vector<float>(pixels.begin() + 8, pixels.begin() + 12) == std::vector<float>{60, 0, 30, 1});
    CHECK_THAT(message_of([&] { program.set("scal", 1.0F); }, ErrorKind::graphics), Catch::Contains("scal"));
    check_errors("drawing");
}

TEST_CASE("compute programs write buffers") {
    test_context();
    const MemoryAccount account;
    Program program = Program::compute_from_source("squares", R"(#version 450 core
layout(local_size_x = 4) in;
layout(std430, binding = 0) buffer Squares { uint squares[]; };
void main() {
    uint index = gl_GlobalInvocationID.x;
    squares[index] = index * index * FACTOR;
})",
                                                   {"FACTOR"});
    const Buffer squares = Buffer::create(account, "squares", 16);
    squares.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    program.use();
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    CHECK(squares.read<std::uint32_t>() == std::vector<std::uint32_t>{0, 1, 4, 9});
    CHECK(program.name() == "squares[FACTOR]");
}

TEST_CASE("the compiler's messages name the file and line of the mistake") {
    test_context();
    const std::string mistake =
        "#version 450 core\n\nout vec4 color;\nvoid main() { color = vec4(nowhere); }\n";
    CHECK_THAT(message_of(
                   [&] {
                       Program::from_source("mistake", full_screen, mistake, {"ONE", "TWO"});
                   },
                   ErrorKind::graphics),
               Catch::Contains("mistake[ONE,TWO]") && Catch::Contains("mistake.frag:4") &&
                   Catch::Contains("nowhere"));
    const std::string unlinked =
        "#version 450 core\nin vec3 missing;\nout vec4 color;\n"
        "void main() { color = vec4(missing, 1.0); }\n";
    CHECK_THAT(
        message_of([&] { Program::from_source("unlinked", full_screen, unlinked); }, ErrorKind::graphics),
        Catch::Contains("does not link"));
    CHECK_THAT(message_of([] { Program::create("no such program"); }, ErrorKind::graphics),
               Catch::Contains("no such program"));
    CHECK_NOTHROW(check_errors("after the mistakes were told"));
}

TEST_CASE("a profiling log holds each pass, another log none") {
    test_context();
    TimingLog profiled(true);
    TimingLog silent(false);
    {
        const PassTimer timer(&profiled, "terrain");
        const PassTimer quiet(&silent, "terrain");
        const PassTimer none(nullptr, "terrain");
    }
    REQUIRE(profiled.passes().size() == 1);
    CHECK(profiled.passes()[0].name == "terrain");
    CHECK(profiled.passes()[0].ms >= 0.0);
    CHECK(silent.passes().empty());
}
