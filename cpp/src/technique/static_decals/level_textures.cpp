#include "technique/static_decals/level_textures.h"

#include <algorithm>
#include <cmath>

namespace decalgl {

LevelTextures::LevelTextures(const MemoryAccount& memory)
    : memory_(memory),
      finenesses_{{of_texels(LEVEL_TEXELS), of_texels(LEVEL_TEXELS / 2), of_texels(LEVEL_TEXELS / 4)}} {}

LevelTextures::Fineness LevelTextures::of_texels(int texels) const {
    return {texels, {{}, LevelPainter(texels, memory_)}, {{}, LevelPainter(texels, memory_)}};
}

void LevelTextures::refresh(const PreparedDecals& before, const PreparedDecals& next,
                            const PreparedDecals* lens_before, const PreparedDecals* lens) {
    for (Fineness& each : finenesses_) {
        if (lens == nullptr)
            each.inside = of_texels(each.texels).inside;
        else if (lens != lens_before)
            each.inside.is_drawn = false;
        if (before.look_token != next.look_token)
            each.outside.is_drawn = false;
        else if (each.outside.is_drawn && &before != &next)
            redraw_edited(each, before, next);
    }
}

void LevelTextures::redraw_edited(Fineness& fineness, const PreparedDecals& before,
                                  const PreparedDecals& next) const {
    const auto columns = static_cast<uint32_t>(next.grid.columns);
    const int texels = fineness.texels;
    Raster& raster = fineness.outside;
    for (uint32_t bucket = 0; bucket < next.bucket_entries.size(); ++bucket) {
        if (before.bucket_entries[bucket] == next.bucket_entries[bucket])
            continue;
        raster.texture.update(0, static_cast<int>(bucket % columns) * texels,
                              static_cast<int>(bucket / columns) * texels, texels, texels,
                              raster.painter.draw_bucket(next, bucket).data());
    }
    glGenerateTextureMipmap(raster.texture.id());
}

// The coarsest one that the nearest pixel spans enough texels of.
LevelTextures::Fineness* LevelTextures::fineness_for(const View& view, const PreparedDecals& look) {
    if (view.antialias != Antialias::coverage || look.has_slopes())
        return nullptr;  // levels know no slopes
    const double bucket = look.grid.bucket_size;
    if (view.widest_pixel < FEWEST_TEXELS * bucket / LEVEL_TEXELS)
        return nullptr;
    Fineness* coarsest = &finenesses_.front();
    for (Fineness& each : finenesses_)
        if (view.narrowest_pixel >= FEWEST_TEXELS * bucket / each.texels)
            coarsest = &each;
    return coarsest;
}

void LevelTextures::update(const View& view, const PreparedDecals& look, const PreparedDecals* lens) {
    needed_ = fineness_for(view, look);
    if (needed_ == nullptr)
        return;
    draw(needed_->outside, look, needed_->outside.painter);
    if (lens != nullptr)
        draw(needed_->inside, *lens,
             lens->shape_token == look.shape_token ? needed_->outside.painter : needed_->inside.painter);
}

void LevelTextures::draw(Raster& raster, const PreparedDecals& look, LevelPainter& painter) const {
    if (raster.is_drawn)
        return;
    const LevelRaster finest = painter.draw(look);
    gl::Texture2D& texture = raster.texture;
    if (texture.width() != finest.width || texture.height() != finest.height) {
        const int count = 1 + static_cast<int>(std::log2(std::max(finest.width, finest.height)));
        texture = gl::Texture2D();
        texture =
            gl::Texture2D::create(memory_, "static: levels", GL_RGBA8, finest.width, finest.height, count);
        texture.set_filter(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
    }
    texture.update(0, 0, 0, finest.width, finest.height, finest.texels.data());
    glGenerateTextureMipmap(texture.id());
    raster.is_drawn = true;
}

void LevelTextures::bind(gl::Program& program, bool has_lens) const {
    program.set("texels_per_bucket", static_cast<float>(needed_->texels));
    program.set("levels", 6);
    needed_->outside.texture.bind(6);
    if (!has_lens)
        return;
    program.set("lens_levels", 9);
    needed_->inside.texture.bind(9);
}

uint64_t LevelTextures::bytes() const {
    uint64_t sum = 0;
    for (const Fineness& each : finenesses_)
        sum += each.outside.texture.bytes() + each.inside.texture.bytes();
    return sum;
}

}  // namespace decalgl
