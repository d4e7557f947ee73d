// The terrain on the GPU: sample heights, illumination, and the index buffers that all tiles share.
#pragma once

#include <array>
#include <vector>

#include "frame/prepared_scene.h"
#include "frame/view_setup.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"

namespace decalgl {

class TerrainMesh {
public:
    // Throws Error(memory) where the terrain is larger than the driver's textures or the budget.
    TerrainMesh(const PreparedScene& scene, const MemoryAccount& memory);

    // Draws into the bound G-buffer, with the program's flags that the G-buffer asks for; returns the number of
    // triangles.
    uint64_t draw(const std::vector<VisibleTile>& tiles, gl::Flags flags, gl::ProgramLibrary& programs) const;

    // For rays that are followed over the terrain (terrain/march.glsl): the levels of detail of visible tiles, the
    // flags of the program, and its uniforms.
    void set_levels(const std::vector<VisibleTile>& tiles);
    bool has_holes() const { return has_holes_; }
    const gl::Texture2D& heights() const { return heights_; }
    const gl::Texture2D& levels() const { return levels_; }
    gl::Flags ray_flags() const;
    void set_for_rays(gl::Program& program) const;

private:
    void set_look(gl::Program& program) const;
    Relief relief_;
    bool has_holes_ = false;
    float lowest_ = 0.0F;
    gl::Texture2D heights_;
    gl::Texture2D illumination_;
    gl::Texture2D ramp_;
    gl::Texture2D levels_;  // a texel a tile
    gl::VertexArray vertices_;
    std::array<gl::Buffer, tile_levels> elements_;
};

}  // namespace decalgl
