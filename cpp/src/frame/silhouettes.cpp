#include "frame/silhouettes.h"

#include "frame/sample_pattern.h"
#include "gl/readback.h"

namespace decalgl {
namespace {

constexpr int samples = 16;  // shaders/shared/gathered.glsl
constexpr int side = 4;
constexpr int columns = 256;  // pixels in a row of a batch
constexpr int rows = static_cast<int>(Silhouettes::batch_size) / columns;
constexpr GLuint pixels_unit = 7;

}  // namespace

Silhouettes::Silhouettes(int width, int height, bool has_overlay, const MemoryAccount& memory)
    : memory_(memory),
      has_overlay_(has_overlay),
      no_vertices_(gl::VertexArray::create()),
      marks_(gl::Texture2D::create(memory, "silhouettes: marks", GL_R8, width, height)),
      marks_framebuffer_(gl::Framebuffer::create("marks", {{GL_COLOR_ATTACHMENT0, &marks_}})) {}

std::vector<uint32_t> Silhouettes::find(const GBuffer& centres, const Rectangle& drawn,
                                        const Rectangle& shown, gl::ProgramLibrary& programs) {
    gl::Program& program = programs.get("silhouettes");
    marks_framebuffer_.bind();
    program.use();
    program.set("surface_texture", 0);
    centres.surface.bind(0);
    program.set("drawn_size", glm::ivec2(drawn.width, drawn.height));
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const int left = shown.x - drawn.x;
    const int bottom = shown.y - drawn.y;
    const std::vector<uint8_t> marks =
        gl::read_pixels<uint8_t>(marks_framebuffer_, GL_COLOR_ATTACHMENT0, left, bottom, shown.width,
                                 shown.height, gl::transfer_format(GL_R8), 1);
    std::vector<uint32_t> pixels;
    for (size_t i = 0; i < marks.size(); ++i) {
        if (marks[i] == 0)
            continue;
        const auto x =
            static_cast<uint32_t>(left) + static_cast<uint32_t>(i % static_cast<size_t>(shown.width));
        const auto y =
            static_cast<uint32_t>(bottom) + static_cast<uint32_t>(i / static_cast<size_t>(shown.width));
        pixels.push_back(x | y << 16U);
    }
    return pixels;
}

void Silhouettes::make_batch_targets() {
    seen_ =
        std::make_unique<SeenTargets>(side * columns, side * rows, has_overlay_, OverlayDepth::none, memory_);
    composed_ =
        gl::Texture2D::create(memory_, "silhouettes: composed", GL_RGBA8, side * columns, side * rows);
    composed_framebuffer_ = gl::Framebuffer::create("silhouettes", {{GL_COLOR_ATTACHMENT0, &composed_}});
    means_ = gl::Texture2D::create(memory_, "silhouettes: means", GL_RGBA8, columns, rows);
    means_framebuffer_ = gl::Framebuffer::create("silhouettes' means", {{GL_COLOR_ATTACHMENT0, &means_}});
}

void Silhouettes::gather(Span<const uint32_t> pixels) {
    if (!seen_)
        make_batch_targets();
    count_ = pixels.size();
    pixels_ = gl::TextureBuffer::from(memory_, "silhouettes: pixels", GL_R32UI, pixels);
}

int Silhouettes::used_rows() const {
    return side * static_cast<int>((count_ + columns - 1) / columns);
}

void Silhouettes::set_gathered(gl::Program& program) const {
    static const std::vector<glm::vec2> offsets = sample_pattern(samples);
    program.set("gathered_pixels", static_cast<int>(pixels_unit));
    pixels_.bind(pixels_unit);
    program.set("gathered_columns", columns);
    program.set_array("gathered_offsets", Span<const glm::vec2>(offsets.data(), offsets.size()));
}

std::vector<uint8_t> Silhouettes::means(gl::ProgramLibrary& programs) {
    gl::Program& program = programs.get("mean_gathered");
    means_framebuffer_.bind();
    program.use();
    program.set("composed_texture", 0);
    composed_.bind(0);
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return gl::read_pixels<uint8_t>(means_framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0, columns,
                                    used_rows() / side, gl::transfer_format(GL_RGBA8), 4);
}

}  // namespace decalgl
