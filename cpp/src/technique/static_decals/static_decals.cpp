#include "technique/static_decals/static_decals.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gl/gl.h"
#include "gl/texture.h"
#include "technique/half_planes.h"
#include "technique/static_decals/area_classes.h"

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

// Arrays are written once, so those at one place hold the same.
template <typename Array>
bool is_same(const Array& a, const Array& b) {
    return a.data() == b.data() && a.size() == b.size();
}

void add_record_flags(uint32_t style_flags, gl::Flags& flags) {
    flags.insert("STYLES");
    const std::pair<uint32_t, const char*> each[] = {{STYLE_JOINED, "JOINED"},
                                                     {STYLE_PATTERN, "PATTERNS"},
                                                     {STYLE_HATCH, "HATCHES"},
                                                     {STYLE_TANGENT | STYLE_THOENY, "SLOPES"}};
    for (const auto& [bit, flag] : each) {
        if ((style_flags & bit) != 0)
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

void StaticDecals::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                          const TerrainView&, const MemoryAccount& memory) {
    memory_ = memory;
    auto next = std::static_pointer_cast<const PreparedDecals>(std::move(prepared));
    auto next_lens = std::static_pointer_cast<const PreparedDecals>(std::move(lens));
    const auto refresh = [&](const char* name, GLenum format, const auto& array, gl::TextureBuffer& buffer) {
        if (((*next).*array).empty())
            buffer = gl::TextureBuffer();
        else if (!prepared_ || !is_same((*prepared_).*array, (*next).*array))
            buffer = gl::TextureBuffer::from(memory_, name, format, ((*next).*array).span());
    };
    refresh("static: buckets", GL_R32UI, &PreparedDecals::bucket_entries, buckets_);
    cells_.upload(next->cells, GL_R32UI, "static: cells", memory_);
    texels_.upload(next->words, GL_RGBA32UI, "static: words", memory_);
    if (next_lens && !is_same(next->words, next_lens->words))
        lens_texels_.upload(next_lens->words, GL_RGBA32UI, "static: words", memory_);
    else
        lens_texels_ = {};
    upload_records(*next, next_lens.get());
    upload_styles(next.get(), next_lens.get());
    if (!prepared_ || prepared_->shape_token != next->shape_token)
        levels_ = std::make_unique<LevelTextures>(memory_);
    else
        levels_->refresh(*prepared_, *next, lens_.get(), next_lens.get());
    if (!no_vertices_)
        no_vertices_ = gl::VertexArray::create();
    prepared_ = std::move(next);
    lens_ = std::move(next_lens);
}

// With a lens, its kinds and records follow the others.
void StaticDecals::upload_records(const PreparedDecals& prepared, const PreparedDecals* lens) {
    if (!prepared.needs_kinds() && (lens == nullptr || !lens->needs_kinds())) {
        kinds_ = gl::TextureBuffer();
        style_records_ = gl::TextureBuffer();
        return;
    }
    const auto same_as = [](const PreparedDecals* a, const PreparedDecals* b) {
        return a != nullptr && b != nullptr && is_same(a->kinds, b->kinds);
    };
    const bool stays = same_as(prepared_.get(), &prepared) &&
                       (lens == nullptr ? lens_ == nullptr : same_as(lens_.get(), lens));
    if (stays)
        return;
    kinds_ = gl::TextureBuffer();
    style_records_ = gl::TextureBuffer();
    std::vector<uint32_t> kinds;
    std::vector<StyleTexel> records;
    for (const PreparedDecals* look : {&prepared, lens}) {
        if (look == nullptr || (look == lens && is_same(look->kinds, prepared.kinds)))
            continue;
        const auto first = static_cast<uint32_t>(records.size());
        for (uint32_t slot = 0; slot < look->slots.size(); ++slot)
            kinds.push_back(look->kinds.empty()
                                ? first << SCALE_BITS | static_cast<uint32_t>(look->scale_of(slot))
                                : look->kinds[slot] + (first << SCALE_BITS));
        records.insert(records.end(), look->style_records.begin(), look->style_records.end());
        if (look->style_records.empty())
            records.push_back({});
    }
    kinds_ = gl::TextureBuffer::from(memory_, "static: styles", GL_R32UI, kinds);
    style_records_ = gl::TextureBuffer::from(memory_, "static: styles", GL_RGBA32UI, records);
}

// Into the buffer that is there, where it is as large as needed: a restyle allocates nothing.
void StaticDecals::upload_styles(const PreparedDecals* prepared, const PreparedDecals* lens) {
    const size_t bytes = prepared->styles.size_bytes();
    const size_t wanted = lens != nullptr ? 2 * bytes : bytes;
    const bool is_new = !styles_ || styles_.buffer().bytes() != wanted;
    if (is_new) {
        styles_ = gl::TextureBuffer();
        styles_ = gl::TextureBuffer::create(memory_, "static: styles", GL_RG32UI, wanted, nullptr,
                                            GL_DYNAMIC_STORAGE_BIT);
    }
    if (is_new || !prepared_ || !is_same(prepared_->styles, prepared->styles))
        styles_.buffer().update(0, bytes, prepared->styles.data());
    if (lens != nullptr && (is_new || !lens_ || !is_same(lens_->styles, lens->styles)))
        styles_.buffer().update(bytes, bytes, lens->styles.data());
}

// Plain styles too as records, for the program that knows nothing else.
void StaticDecals::make_records() {
    std::vector<uint32_t> kinds;
    for (const DecalStyle& style : prepared_->styles.span())
        kinds.push_back(static_cast<uint32_t>(line_scale(style.half_width)));
    kinds_ = gl::TextureBuffer::from(memory_, "static: styles", GL_R32UI, kinds);
    style_records_ =
        gl::TextureBuffer::from(memory_, "static: styles", GL_RGBA32UI, std::vector<StyleTexel>(1));
}

UpdateReport StaticDecals::update(const View& view) {
    if (view.antialias == Antialias::coverage && !half_planes_)
        half_planes_ = gl::TextureBuffer::from(memory_, "static: half planes", GL_RG32UI, make_half_planes());
    if (view.antialias == Antialias::coverage && view.coverage == CoverageRule::thoeny && !kinds_)
        make_records();
    levels_->update(view, *prepared_, lens_.get());
    UpdateReport report;
    report.pieces = prepared_->pieces;
    report.bytes = buckets_.buffer().bytes() + cells_.bytes() + texels_.bytes() + lens_texels_.bytes() +
                   styles_.buffer().bytes() + kinds_.buffer().bytes() + style_records_.buffer().bytes() +
                   half_planes_.buffer().bytes() + levels_->bytes();
    report.longest_walk = prepared_->longest_list;
    return report;
}

void StaticDecals::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    gl::Flags flags;
    const bool has_bands =
        any_look([](const PreparedDecals& look) { return (look.style_flags & STYLE_BANDS) != 0; });
    const bool has_one_color = prepared_->has_one_color && !prepared_->has_hidden && !lens_ && !has_styles();
    if (has_bands)
        flags.insert("BANDS");
    if (has_bands || any_look([](const PreparedDecals& look) { return look.has_translucency; }))
        flags.insert("TRANSLUCENT");
    else if (has_one_color && view.antialias == Antialias::none)
        flags.insert("ONE_COLOR");
    if (view.has_below) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    if (view.antialias == Antialias::coverage)
        draw_areas(flags, view.coverage, gbuffer, programs);
    else
        draw_full_screen(std::move(flags), gbuffer, programs);
    glDisable(GL_BLEND);
}

// The class of each pixel first, then those of each class (area_classes.h).
void StaticDecals::draw_areas(const gl::Flags& flags, CoverageRule rule, const GBufferView& gbuffer,
                              gl::ProgramLibrary& programs) {
    const std::string classes = "CLASSES", cells = "CELLS";
    const auto draw_class = [&](const std::string& flag) {
        gl::Flags all = flags;
        all.insert(flag);
        if (rule == CoverageRule::thoeny && prepared_->has_lines && (flag == classes || flag == cells))
            all.insert("THOENY");
        if (levels_->are_needed() && flag == classes)
            all.insert("LEVELS");
        draw_full_screen(std::move(all), gbuffer, programs);
    };
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    draw_class(classes);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_EQUAL);
    const auto draw_rest = [&](const std::string& flag, double kind) {
        glDepthRange(kind, kind);
        draw_class(flag);
    };
    draw_rest(cells, CLASS_CELLS);
    draw_rest("POINTS", CLASS_POINTS);
    glDepthRange(0.0, 1.0);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_GREATER);
    glDisable(GL_DEPTH_TEST);
}

void StaticDecals::draw_ids(const View&, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    draw_full_screen({"IDS"}, gbuffer, programs);
}

SlopeUse StaticDecals::slope_use() const {
    return any_look([](const PreparedDecals& look) { return look.has_slopes(); }) ? SlopeUse::widths
                                                                                  : SlopeUse::none;
}

void StaticDecals::add_style_flags(gl::Flags& flags) const {
    if (prepared_->has_lines)
        flags.insert("LINES");
    if (prepared_->has_polygons)
        flags.insert("RINGS");
    if (has_styles())
        add_record_flags(prepared_->style_flags | (lens_ ? lens_->style_flags : 0), flags);
    const bool styled = has_styles() || flags.count("THOENY") != 0;
    if (prepared_->has_lines && !styled && prepared_->narrowest == prepared_->widest &&
        !any_look([&](const PreparedDecals& look) {
            return look.narrowest != prepared_->narrowest || look.widest != prepared_->widest;
        }))
        flags.insert("ONE_WIDTH");
    // A colour of alpha 0 adds nothing to others, but hides what is behind it where colours are opaque.
    if (flags.count("TRANSLUCENT") == 0 &&
        any_look([](const PreparedDecals& look) { return look.has_hidden; }))
        flags.insert("HIDDEN");
    if (lens_)
        flags.insert("LENS");
    if (lens_texels_)
        flags.insert("LENS_LISTS");
    if (lens_ && !is_same(lens_->kinds, prepared_->kinds))
        flags.insert("LENS_KINDS");
}

bool StaticDecals::has_styles() const {
    return any_look([](const PreparedDecals& look) { return look.needs_kinds(); });
}

void StaticDecals::draw_full_screen(gl::Flags flags, const GBufferView& gbuffer,
                                    gl::ProgramLibrary& programs) {
    add_style_flags(flags);
    gl::Program& program = programs.get("static_decals", flags);
    program.use();
    program.set("position_texture", 0);
    gbuffer.position->bind(0);
    const bool sees_area = flags.count("CLASSES") + flags.count("CELLS") + flags.count("POINTS") > 0;
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
    if (sees_area) {
        program.set("half_planes", 11);
        half_planes_.bind(11);
    }
    if (has_styles() || flags.count("THOENY") != 0) {
        program.set("decal_kinds", 7);
        kinds_.bind(7);
        program.set("style_records", 10);
        style_records_.bind(10);
    }
    if (flags.count("LENS") != 0) {
        program.set("lens_texture", 8);
        gbuffer.lens->bind(8);
        program.set("lens_styles", static_cast<int>(prepared_->styles.size()));
    }
    if (flags.count("LENS_LISTS") != 0) {
        program.set("lens_texels", 12);
        lens_texels_.bind(12);
    }
    set_grid(prepared_->grid, program);
    if (flags.count("LEVELS") != 0)
        levels_->bind(program, lens_ != nullptr);
    if (flags.count("ONE_COLOR") != 0) {
        const std::array<uint8_t, 4> color = prepared_->one_color;
        program.set("one_color", glm::vec4(color[0], color[1], color[2], color[3]) / 255.0F);
    }
    if (flags.count("ONE_WIDTH") != 0) {
        const float scale = std::ldexp(1.0F, -prepared_->largest_scale);
        program.set("line_scale", scale);
        program.set("line_half_width", prepared_->widest * scale);
    }
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace decalgl
