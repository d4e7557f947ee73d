// Drop-off textures: how distances grow from 0 to 1 (Trapp et al. 2015, section 4.2, figure 6).
//
//     layer 0   segments: across the line alone        u  along, away from the line's end
//     layer 1   round caps                             v  across
//     layer 2   square caps
//     layer 3   butt caps: 1 everywhere
//     then      the users' own
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/technique/distance_field_options.h"
#include "gl/texture.h"

namespace decalgl::network {

std::vector<uint8_t> drop_off_texels(int layer);
gl::Texture2D make_drop_offs(const DistanceFieldOptions& options, const MemoryAccount& memory);

}  // namespace decalgl::network
