// What a rectangle of the picture is drawn into. Which textures there are depends on the anti-aliasing.
//
//     none, coverage    seen ─▶ picture
//     ssaa              seen ─▶ sum ─▶ picture                    once a sample
//     msaa              multisampled ─▶ seen ─▶ sum ─▶ picture    once a sample
//     fxaa              seen ─▶ composed ─▶ picture
#pragma once

#include "decalgl/technique/technique.h"
#include "frame/gbuffer.h"
#include "gl/texture.h"

namespace decalgl {

// What techniques need beside the overlay's colour.
enum class OverlayDepth { none, depth, depth_and_stencil };

// The terrain at each texel, and the layers over it.
struct SeenTargets {
    SeenTargets() = default;
    SeenTargets(int width, int height, bool has_overlay, OverlayDepth depth, const MemoryAccount& memory);

    GBuffer gbuffer;
    gl::Texture2D overlay;
    gl::Texture2D overlay_depth;
    gl::Framebuffer overlay_framebuffer;
};

struct TargetNeeds {
    int width = 0;
    int height = 0;
    Antialias antialias = Antialias::none;
    int multisamples = 0;  // samples a pixel that the driver draws at once, for msaa; 0: none
    bool has_overlay = false;
    OverlayDepth overlay_depth = OverlayDepth::none;

    // Whether targets made for these needs serve others as well: with an overlay that is not asked for, perhaps.
    bool serve(const TargetNeeds& others) const;
};

struct Targets {
    Targets(const TargetNeeds& needed, const MemoryAccount& memory);

    TargetNeeds needs;
    SeenTargets seen;
    GBuffer multisampled;
    gl::Texture2D sum;       // of the samples' composed pictures, premultiplied
    gl::Texture2D composed;  // before edges are smoothed
    gl::Texture2D picture;
    gl::Framebuffer sum_framebuffer;
    gl::Framebuffer composed_framebuffer;
    gl::Framebuffer picture_framebuffer;
};

}  // namespace decalgl
