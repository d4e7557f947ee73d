#include "frame/terrain_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "decalgl/core/error.h"
#include "gl/context.h"

namespace decalgl {
namespace {

constexpr float missing_height = -2e30F;  // below the shader's limit of -1e30
constexpr double radians = 3.14159265358979323846 / 180.0;

// North-west, south-west, south-east and north-west, south-east, north-east of each quad: the order that
// terrain.frag.glsl counts on.
std::vector<uint16_t> quad_elements(int quads) {
    std::vector<uint16_t> elements;
    elements.reserve(static_cast<size_t>(quads) * static_cast<size_t>(quads) * 6);
    const int side = quads + 1;
    for (int row = 0; row < quads; ++row) {
        for (int column = 0; column < quads; ++column) {
            const int north_west = row * side + column;
            for (const int vertex : {north_west, north_west + side, north_west + side + 1, north_west,
                                     north_west + side + 1, north_west + 1})
                elements.push_back(static_cast<uint16_t>(vertex));
        }
    }
    return elements;
}

int mip_levels(int width, int height) {
    int levels = 1;
    for (int side = std::max(width, height); side > 1; side /= 2)
        ++levels;
    return levels;
}

}  // namespace

TerrainMesh::TerrainMesh(const PreparedScene& scene, const MemoryAccount& memory)
    : relief_(scene.relief), has_holes_(scene.tiles.has_holes) {
    const int columns = scene.terrain.columns();
    const int rows = scene.terrain.rows();
    const int limit = gl::Context::require_current().info().max_texture_size;
    if (columns > limit || rows > limit)
        throw Error(ErrorKind::memory,
                    "the terrain has " + std::to_string(rows) + " x " + std::to_string(columns) +
                        " samples, but this driver holds at most " + std::to_string(limit) +
                        " a side; open a part of it, or resample it");
    std::vector<float> heights(scene.terrain.heights().begin(), scene.terrain.heights().end());
    lowest_ = 0.0F;
    for (float& height : heights) {
        if (std::isnan(height))
            height = missing_height;
        else
            lowest_ = std::min(lowest_, height);
    }
    heights_ = gl::Texture2D::create(memory, "terrain: heights", GL_R32F, columns, rows);
    heights_.update(0, 0, 0, columns, rows, heights.data());

    illumination_ = gl::Texture2D::create(memory, "terrain: illumination", GL_R8, columns, rows,
                                          mip_levels(columns, rows));
    illumination_.update(0, 0, 0, columns, rows, scene.illumination.data());
    glGenerateTextureMipmap(illumination_.id());
    illumination_.set_filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);

    if (!relief_.ramp.empty()) {
        const auto count = static_cast<int>(relief_.ramp.size() / 3);
        std::vector<uint8_t> texels;
        for (size_t i = 0; i < relief_.ramp.size(); i += 3)
            texels.insert(texels.end(),
                          {relief_.ramp[i], relief_.ramp[i + 1], relief_.ramp[i + 2], uint8_t{255}});
        ramp_ = gl::Texture2D::create(memory, "terrain: ramp", GL_RGBA8, count, 1);
        ramp_.update(0, 0, 0, count, 1, texels.data());
        ramp_.set_filter(GL_LINEAR, GL_LINEAR);
    }

    levels_ = gl::Texture2D::create(memory, "terrain: levels", GL_R8UI, std::max(1, scene.tiles.columns),
                                    std::max(1, scene.tiles.rows));
    vertices_ = gl::VertexArray::create();
    for (int level = 0; level < tile_levels; ++level)
        elements_[static_cast<size_t>(level)] =
            gl::Buffer::from(memory, "terrain: elements", quad_elements(tile_quads >> level));
}

void TerrainMesh::set_look(gl::Program& program) const {
    program.set("heights", 0);
    heights_.bind(0);
    program.set("illumination", 1);
    illumination_.bind(1);
    program.set("hillshade", glm::vec3(std::sin(relief_.altitude * radians), relief_.strength, 0.0));
    program.set("base_color", glm::vec3(relief_.color[0], relief_.color[1], relief_.color[2]) / 255.0F);
    if (ramp_) {
        program.set("ramp", 2);
        ramp_.bind(2);
        program.set("ramp_range", glm::vec2(relief_.lowest, relief_.highest));
    }
}

void TerrainMesh::set_for_rays(gl::Program& program) const {
    set_look(program);
    program.set("tile_levels", 3);
    levels_.bind(3);
}

gl::Flags TerrainMesh::ray_flags() const {
    return ramp_ ? gl::Flags{"RAMP"} : gl::Flags{};
}

void TerrainMesh::set_levels(const std::vector<VisibleTile>& tiles) {
    std::vector<uint8_t> texels(static_cast<size_t>(levels_.width()) * static_cast<size_t>(levels_.height()));
    for (const VisibleTile& visible : tiles) {
        const auto row = static_cast<size_t>(visible.tile->row / tile_quads);
        const auto column = static_cast<size_t>(visible.tile->column / tile_quads);
        texels[row * static_cast<size_t>(levels_.width()) + column] = static_cast<uint8_t>(visible.level);
    }
    levels_.update(0, 0, 0, levels_.width(), levels_.height(), texels.data());
}

uint64_t TerrainMesh::draw(const std::vector<VisibleTile>& tiles, gl::Flags flags,
                           gl::ProgramLibrary& programs) const {
    if (has_holes_)
        flags.insert("HOLES");
    if (ramp_)
        flags.insert("RAMP");
    gl::Program& program = programs.get("terrain", flags);
    program.use();
    set_look(program);
    program.set("stand_in_height", lowest_);
    vertices_.bind();
    uint64_t triangles = 0;
    int bound_level = -1;
    for (const VisibleTile& visible : tiles) {
        if (visible.level != bound_level)
            glVertexArrayElementBuffer(vertices_.id(), elements_[static_cast<size_t>(visible.level)].id());
        bound_level = visible.level;
        const int quads = tile_quads >> visible.level;
        program.set("tile_sample", glm::ivec2(visible.tile->column, visible.tile->row));
        program.set("tile_level", visible.level);
        program.set("neighbour_levels", visible.neighbour_levels);
        glDrawElements(GL_TRIANGLES, quads * quads * 6, GL_UNSIGNED_SHORT, nullptr);
        triangles += static_cast<uint64_t>(quads) * static_cast<uint64_t>(quads) * 2;
    }
    return triangles;
}

}  // namespace decalgl
