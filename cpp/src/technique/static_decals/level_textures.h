// Levels of detail on the GPU: as fine as views need them, of the look outside the lens and of the one inside.
#pragma once

#include <array>

#include "decalgl/technique/technique.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "technique/static_decals/levels.h"

namespace decalgl {

class LevelTextures {
public:
    explicit LevelTextures(const MemoryAccount& memory);

    // For the same shapes. Of another look nothing stays but what its colours are found from, and after an edit all but the
    // buckets that it touched. The lenses may be null.
    void refresh(const PreparedDecals& before, const PreparedDecals& next, const PreparedDecals* lens_before,
                 const PreparedDecals* lens);
    // Draws those that the view needs: none where no pixel spans enough texels.
    void update(const View& view, const PreparedDecals& look, const PreparedDecals* lens);
    bool are_needed() const { return needed_ != nullptr; }
    void bind(gl::Program& program, bool has_lens) const;
    uint64_t bytes() const;

private:
    struct Raster {
        gl::Texture2D texture;
        LevelPainter painter;
        bool is_drawn = false;
    };
    // Those of one fineness; what is seen depends on the view alone, not on what was drawn before.
    struct Fineness {
        int texels;  // along a bucket's side
        Raster outside, inside;
    };

    Fineness of_texels(int texels) const;
    Fineness* fineness_for(const View& view, const PreparedDecals& look);
    void redraw_edited(Fineness& fineness, const PreparedDecals& before, const PreparedDecals& next) const;
    void draw(Raster& raster, const PreparedDecals& look, LevelPainter& painter) const;

    MemoryAccount memory_;
    std::array<Fineness, 3> finenesses_;  // the finest first
    Fineness* needed_ = nullptr;
};

}  // namespace decalgl
