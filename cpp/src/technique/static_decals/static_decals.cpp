#include "technique/static_decals/static_decals.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gl/gl.h"
#include "gl/texture.h"
#include "technique/static_decals/area_classes.h"
#include "technique/static_decals/half_planes.h"
#include "technique/static_decals/levels.h"

namespace decalgl {

namespace {

// Modulo 2^32: what the shader counts from it is small again.
glm::ivec2 wrapped(int64_t x, int64_t y) {
    return {static_cast<int32_t>(static_cast<uint32_t>(x)), static_cast<int32_t>(static_cast<uint32_t>(y))};
}

void set_grid(const BucketGrid& grid, gl::Program& program) {
    const double quanta_per_block = grid.positions.block_size / grid.quantum;
    const auto blocks_of = [&](int64_t buckets) {
        return static_cast<int64_t>(static_cast<double>(buckets) * (BUCKET_QUANTA / quanta_per_block));
    };
    program.set("grid_size", glm::ivec2(grid.columns, grid.rows));
    program.set("block_shift", static_cast<int>(std::lrint(std::log2(quanta_per_block))));
    program.set("first_quantum",
                wrapped(grid.first_bucket_x * BUCKET_QUANTA, grid.first_bucket_y * BUCKET_QUANTA));
    if (quanta_per_block < 1.0)
        program.set("first_block", wrapped(blocks_of(grid.first_bucket_x), blocks_of(grid.first_bucket_y)));
    program.set("quanta_per_metre", static_cast<float>(1.0 / grid.quantum));
}

bool has_styles(const PreparedDecals& decals) {
    return decals.kinds.size() > 0;
}

void add_style_flags(const PreparedDecals& decals, gl::Flags& flags) {
    if (!has_styles(decals))
        return;
    flags.insert("STYLES");
    const std::pair<uint32_t, const char*> each[] = {{STYLE_JOINED, "JOINED"},
                                                     {STYLE_PATTERN, "PATTERNS"},
                                                     {STYLE_HATCH, "HATCHES"},
                                                     {STYLE_TANGENT | STYLE_THOENY, "SLOPES"}};
    for (const auto& [bit, flag] : each) {
        if ((decals.style_flags & bit) != 0)
            flags.insert(flag);
    }
}

}  // namespace

std::unique_ptr<const Prepared> StaticDecals::preprocess(const TechniqueInput& input,
                                                         Progress& progress) const {
    return build_decals(input, progress);
}

std::unique_ptr<const Prepared> StaticDecals::open(const ArchiveReader& archive, const std::string& prefix,
                                                   const MemoryAccount&) const {
    return open_decals(archive, prefix);
}

void StaticDecals::upload(std::shared_ptr<const Prepared> prepared, const MemoryAccount& memory) {
    prepared_ = std::static_pointer_cast<const PreparedDecals>(std::move(prepared));
    memory_ = memory;
    const PreparedDecals& decals = *prepared_;
    buckets_ = gl::TextureBuffer::from(memory, "static: buckets", GL_R32UI, decals.bucket_entries.span());
    cells_ = gl::TextureBuffer::from(memory, "static: cells", GL_R32UI, decals.cells.span());
    texels_ = gl::TextureBuffer::from(memory, "static: words", GL_RGBA32UI, decals.words.span());
    styles_ = gl::TextureBuffer::from(memory, "static: styles", GL_RG32UI, decals.styles.span());
    if (has_styles(decals)) {
        kinds_ = gl::TextureBuffer::from(memory, "static: styles", GL_R32UI, decals.kinds.span());
        style_records_ =
            gl::TextureBuffer::from(memory, "static: styles", GL_RGBA32UI, decals.style_records.span());
    }
    half_planes_ = gl::TextureBuffer::from(memory, "static: half planes", GL_R32UI, make_half_planes());
    no_vertices_ = gl::VertexArray::create();
}

// Whether some pixel spans enough texels of the finest level (levels.glsl).
bool StaticDecals::needs_levels(const View& view) const {
    const double texel = prepared_->grid.bucket_size / LEVEL_TEXELS;
    if ((prepared_->style_flags & (STYLE_TANGENT | STYLE_THOENY)) != 0)
        return false;  // levels know no slopes
    return view.antialias == Antialias::coverage && view.widest_pixel >= FEWEST_TEXELS * texel;
}

void StaticDecals::make_levels() {
    const LevelRaster finest = draw_finest_level(*prepared_);
    const int count = 1 + static_cast<int>(std::log2(std::max(finest.width, finest.height)));
    levels_ = gl::Texture2D::create(memory_, "static: levels", GL_RGBA8, finest.width, finest.height, count);
    levels_.update(0, 0, 0, finest.width, finest.height, finest.texels.data());
    levels_.set_filter(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
    glGenerateTextureMipmap(levels_.id());
}

UpdateReport StaticDecals::update(const View& view) {
    draws_levels_ = needs_levels(view);
    if (draws_levels_ && !levels_)
        make_levels();
    UpdateReport report;
    report.pieces = prepared_->pieces;
    report.bytes = buckets_.buffer().bytes() + cells_.buffer().bytes() + texels_.buffer().bytes() +
                   styles_.buffer().bytes() + kinds_.buffer().bytes() + style_records_.buffer().bytes() +
                   half_planes_.buffer().bytes() + levels_.bytes();
    report.longest_walk = prepared_->longest_list;
    return report;
}

void StaticDecals::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    gl::Flags flags;
    const bool has_bands = (prepared_->style_flags & STYLE_BANDS) != 0;
    if (has_bands)
        flags.insert("BANDS");
    if (prepared_->has_translucency || has_bands)
        flags.insert("TRANSLUCENT");
    else if (prepared_->has_one_color && view.antialias == Antialias::none && !has_styles(*prepared_))
        flags.insert("ONE_COLOR");
    if (view.antialias == Antialias::coverage)
        draw_areas(flags, gbuffer, programs);
    else
        draw_full_screen(std::move(flags), gbuffer, programs);
}

// The class of each pixel first, then those of each class (area_classes.h).
void StaticDecals::draw_areas(const gl::Flags& flags, const GBufferView& gbuffer,
                              gl::ProgramLibrary& programs) {
    const auto draw_class = [&](const char* flag) {
        gl::Flags all = flags;
        all.insert(flag);
        if (draws_levels_)
            all.insert("LEVELS");
        draw_full_screen(std::move(all), gbuffer, programs);
    };
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    draw_class("CLASSES");
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_EQUAL);
    const auto draw_rest = [&](const char* flag, double kind) {
        glDepthRange(kind, kind);
        draw_class(flag);
    };
    draw_rest("CELLS", CLASS_CELLS);
    draw_rest("POINTS", CLASS_POINTS);
    if (draws_levels_)
        draw_rest("FROM_LEVELS", CLASS_LEVELS);
    glDepthRange(0.0, 1.0);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_GREATER);
    glDisable(GL_DEPTH_TEST);
}

void StaticDecals::draw_ids(const View&, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    draw_full_screen({"IDS"}, gbuffer, programs);
}

void StaticDecals::draw_full_screen(gl::Flags flags, const GBufferView& gbuffer,
                                    gl::ProgramLibrary& programs) {
    const bool one_width =
        prepared_->has_lines && prepared_->narrowest == prepared_->widest && !has_styles(*prepared_);
    add_style_flags(*prepared_, flags);
    if (prepared_->has_lines)
        flags.insert("LINES");
    if (one_width)
        flags.insert("ONE_WIDTH");
    if (prepared_->has_polygons)
        flags.insert("RINGS");
    gl::Program& program = programs.get("static_decals", flags);
    program.use();
    program.set("position_texture", 0);
    gbuffer.position->bind(0);
    const bool sees_area =
        flags.count("CLASSES") + flags.count("CELLS") + flags.count("POINTS") + flags.count("FROM_LEVELS") >
        0;
    if (sees_area || flags.count("SLOPES") != 0) {
        program.set("surface_texture", 1);
        gbuffer.surface->bind(1);
    }
    program.set("bucket_entries", 2);
    buckets_.bind(2);
    program.set("cell_entries", 3);
    cells_.bind(3);
    program.set("cell_texels", 4);
    texels_.bind(4);
    program.set("decal_styles", 5);
    styles_.bind(5);
    if (sees_area && !has_styles(*prepared_)) {
        program.set("half_planes", 9);
        half_planes_.bind(9);
    }
    if (has_styles(*prepared_)) {
        program.set("decal_kinds", 7);
        kinds_.bind(7);
        program.set("style_records", 8);
        style_records_.bind(8);
    }
    set_grid(prepared_->grid, program);
    if (flags.count("LEVELS") != 0) {
        program.set("levels", 6);
        levels_.bind(6);
    }
    if (flags.count("ONE_COLOR") != 0) {
        const std::array<uint8_t, 4> color = prepared_->styles[0].color;
        program.set("one_color", glm::vec4(color[0], color[1], color[2], color[3]) / 255.0F);
    }
    if (one_width) {
        const float scale = std::ldexp(1.0F, -prepared_->largest_scale);
        program.set("line_scale", scale);
        program.set("line_half_width", prepared_->widest * scale);
    }
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace decalgl
