#pragma once

// Small shader functions, tested by drawing one pixel a case.

#include <catch2/catch.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/readback.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "gl_fixture.h"
#include "shared/view_block.h"

namespace decalgl::test {

/// Runs GLSL for many cases, a pixel each.
class OnePixel {
public:
    /// `includes`: shader files; `body`: sets `vec4 result` from `input0` ... of the case, vec4 each.
    OnePixel(const std::vector<std::string>& includes, int inputs, const std::string& body,
             const gl::Flags& flags = {})
        : inputs_(inputs), program_(make(includes, inputs, body, flags)) {}

    gl::Program& program() { return program_; }

    std::vector<glm::vec4> run(const std::vector<glm::vec4>& values, const ViewBlock& view = {}) {
        constexpr int row = 1024;
        const auto cases = static_cast<int>(values.size()) / inputs_;
        const int height = (cases + row - 1) / row;
        const MemoryAccount account;
        const gl::Texture2D target = gl::Texture2D::create(account, "results", GL_RGBA32F, row, height);
        const gl::Framebuffer framebuffer =
            gl::Framebuffer::create("results", {{GL_COLOR_ATTACHMENT0, &target}});
        const gl::TextureBuffer texels = gl::TextureBuffer::from(account, "values", GL_RGBA32F, values);
        const gl::Buffer block = gl::Buffer::create(account, "view", sizeof(ViewBlock), &view);
        const gl::VertexArray empty = gl::VertexArray::create();
        block.bind_base(GL_UNIFORM_BUFFER, 0);
        framebuffer.bind();
        program_.use();
        program_.set("case_values", 7);
        program_.set("case_count", cases);
        texels.bind(7);
        empty.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
        const std::vector<float> read = gl::read_pixels<float>(framebuffer, GL_COLOR_ATTACHMENT0, 0, 0, row,
                                                               height, gl::transfer_format(GL_RGBA32F), 4);
        gl::check_errors("drawing cases");
        std::vector<glm::vec4> results;
        for (size_t i = 0; i < static_cast<size_t>(cases); ++i) {
            results.emplace_back(read[4 * i], read[4 * i + 1], read[4 * i + 2], read[4 * i + 3]);
        }
        return results;
    }

private:
    static gl::Program make(const std::vector<std::string>& includes, int inputs, const std::string& body,
                            const gl::Flags& flags) {
        test_context();
        std::string text = "#version 450 core\n";
        for (const std::string& path : includes) {
            text += "#include \"" + path + "\"\n";
        }
        text +=
            "uniform samplerBuffer case_values;\nuniform int case_count;\nlayout(location = 0) out vec4 "
            "result;\n";
        text += "void main() {\n    int at = int(gl_FragCoord.y) * 1024 + int(gl_FragCoord.x);\n";
        text += "    result = vec4(0.0);\n    if (at >= case_count) return;\n";
        for (int i = 0; i < inputs; ++i) {
            text += "    vec4 input" + std::to_string(i) + " = texelFetch(case_values, at * " +
                    std::to_string(inputs) + " + " + std::to_string(i) + ");\n";
        }
        text += body + "}\n";
        const std::string vertex = "#include \"shared/full_screen.vert.glsl\"\n";
        return gl::Program::from_source("cases", vertex, text, flags);
    }

    int inputs_;
    gl::Program program_;
};

}  // namespace decalgl::test
