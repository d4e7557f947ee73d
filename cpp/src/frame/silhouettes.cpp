#include "frame/silhouettes.h"

#include "frame/sample_pattern.h"
#include "gl/readback.h"
#include "shared/area_samples.h"

namespace decalgl {
namespace {

// Texels of a pixel from side to side: shaders/shared/gathered.glsl.
constexpr int rays_side = 4;
constexpr int sample_side = 8;
constexpr int columns = 256;  // pixels in a row of a batch
constexpr int rows = static_cast<int>(Silhouettes::batch_size) / columns;
constexpr GLuint pixels_unit = 7;

// Footprints that a neighbour may be seen off a pixel's plane at a border. Strokes found on the plane go on over it, and are
// off by more.
constexpr float farthest_at_borders = 0.15F;
constexpr float farthest_on_slopes = 0.005F;

using Offsets = std::vector<glm::vec2>;

const Offsets& ray_offsets() {
    static const Offsets offsets = sample_pattern(rays_side * rays_side);
    return offsets;
}

int sixteenth_of(glm::vec2 offset) {
    const glm::ivec2 place(glm::floor((offset + 0.5F) * static_cast<float>(rays_side)));
    return place.y * rays_side + place.x;
}

// In the order of the texels: four samples of a pixel's area are in each sixteenth of it and one ray, as both
// patterns are nets, and share a block of 2 x 2.
Offsets offsets_of_samples() {
    constexpr glm::vec2 samples[] = {AREA_SAMPLE_OFFSETS(glm::vec2)};
    Offsets offsets(sample_side * sample_side);
    for (int ray = 0; ray < rays_side * rays_side; ++ray) {
        int inside = 0;
        for (const glm::vec2 sample : samples) {
            if (sixteenth_of(sample) != sixteenth_of(ray_offsets()[static_cast<size_t>(ray)]))
                continue;
            const int x = 2 * (ray % rays_side) + inside % 2, y = 2 * (ray / rays_side) + inside / 2;
            offsets[static_cast<size_t>(y * sample_side + x)] = sample;
            ++inside;
        }
    }
    return offsets;
}

void set_offsets(gl::Program& program, const char* name, const Offsets& offsets) {
    program.set_array(name, Span<const glm::vec2>(offsets.data(), offsets.size()));
}

}  // namespace

Silhouettes::Silhouettes(int width, int height, bool has_overlay, const MemoryAccount& memory)
    : memory_(memory),
      has_overlay_(has_overlay),
      no_vertices_(gl::VertexArray::create()),
      marks_(gl::Texture2D::create(memory, "silhouettes: marks", GL_R8, width, height)),
      marks_framebuffer_(gl::Framebuffer::create("marks", {{GL_COLOR_ATTACHMENT0, &marks_}})) {}

std::vector<uint32_t> Silhouettes::find(const GBuffer& centres, const gl::Texture2D* overlay,
                                        SlopeUse slope_use, const Rectangle& drawn, const Rectangle& shown,
                                        const TerrainMesh& terrain, gl::ProgramLibrary& programs) {
    gl::Flags flags;
    if (overlay != nullptr)
        flags.insert("OVERLAY");
    if (overlay != nullptr && slope_use == SlopeUse::widths)
        flags.insert("SLOPES");
    if (terrain.has_holes())
        flags.insert("HOLES");
    gl::Program& program = programs.get("silhouettes", flags);
    marks_framebuffer_.bind();
    program.use();
    program.set("surface_texture", 0);
    centres.surface.bind(0);
    if (overlay != nullptr) {
        program.set("overlay_texture", 1);
        overlay->bind(1);
        program.set("tile_levels", 2);
        terrain.levels().bind(2);
        program.set("farthest_at_borders",
                    slope_use == SlopeUse::strokes ? farthest_on_slopes : farthest_at_borders);
    }
    if (terrain.has_holes()) {
        program.set("heights", 3);
        terrain.heights().bind(3);
    }
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
    rays_ = GBuffer(rays_side * columns, rays_side * rows, memory_);
    too_few_ = gl::Texture2D::create(memory_, "silhouettes: facets", GL_R8, columns, rows);
    too_few_framebuffer_ = gl::Framebuffer::create("facets", {{GL_COLOR_ATTACHMENT0, &too_few_}});
    const int width = sample_side * columns, height = sample_side * rows;
    seen_ = std::make_unique<SeenTargets>(width, height, has_overlay_, OverlayDepth::none, memory_);
    composed_ = gl::Texture2D::create(memory_, "silhouettes: composed", GL_RGBA8, width, height);
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
    return static_cast<int>((count_ + columns - 1) / columns);
}

int Silhouettes::ray_columns() const {
    return rays_side * columns;
}

int Silhouettes::ray_rows() const {
    return rays_side * used_rows();
}

int Silhouettes::sample_columns() const {
    return sample_side * columns;
}

int Silhouettes::sample_rows() const {
    return sample_side * used_rows();
}

void Silhouettes::set_pixels(gl::Program& program) const {
    program.set("gathered_pixels", static_cast<int>(pixels_unit));
    pixels_.bind(pixels_unit);
    program.set("gathered_columns", columns);
}

void Silhouettes::set_gathered(gl::Program& program) const {
    static const Offsets offsets = offsets_of_samples();
    set_pixels(program);
    set_offsets(program, "gathered_offsets", offsets);
}

void Silhouettes::set_rays(gl::Program& program) const {
    set_pixels(program);
    set_offsets(program, "gathered_offsets", ray_offsets());
}

void Silhouettes::count_facets(gl::ProgramLibrary& programs) const {
    gl::Program& program = programs.get("facets");
    too_few_framebuffer_.bind();
    program.use();
    set_pixels(program);
    program.set("ray_surface_texture", 0);
    rays_.surface.bind(0);
    program.set("marks_texture", 1);
    marks_.bind(1);
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Silhouettes::spread(gl::ProgramLibrary& programs) {
    gl::Program& program = programs.get("spread");
    seen_->gbuffer.framebuffer.bind();
    program.use();
    set_gathered(program);
    set_offsets(program, "ray_offsets", ray_offsets());
    program.set("ray_position_texture", 0);
    rays_.position.bind(0);
    program.set("ray_surface_texture", 1);
    rays_.surface.bind(1);
    program.set("ray_base_texture", 2);
    rays_.base.bind(2);
    program.set("facets_texture", 3);
    too_few_.bind(3);
    no_vertices_.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_GREATER);
    glDisable(GL_DEPTH_TEST);
}

std::vector<uint8_t> Silhouettes::means(gl::ProgramLibrary& programs) {
    gl::Program& program = programs.get("mean_gathered");
    means_framebuffer_.bind();
    program.use();
    program.set("composed_texture", 0);
    composed_.bind(0);
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return gl::read_pixels<uint8_t>(means_framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0, columns, used_rows(),
                                    gl::transfer_format(GL_RGBA8), 4);
}

}  // namespace decalgl
