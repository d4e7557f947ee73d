#include "frame/view_setup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

constexpr double radians = 3.14159265358979323846 / 180.0;
constexpr double farthest_near = 1e-3;

// Metres before the eye where what is seen begins: a millimetre, unless the camera looks at something as near.
double near_distance_of(const Camera& camera) {
    return std::min(farthest_near, 0.1 * glm::distance(camera.eye, camera.target));
}

struct SplitNumber {
    int32_t whole;
    float fraction;
};

SplitNumber split(double value) {
    const double whole = std::floor(value);
    if (!(std::abs(whole) < 1e9))
        throw Error(ErrorKind::input,
                    "camera: the eye is too far from this terrain to draw it; move it closer");
    return {static_cast<int32_t>(whole), static_cast<float>(value - whole)};
}

double half_height_at_unit_distance(const Camera& camera) {
    return std::tan(0.5 * camera.fov * radians);
}

// The farthest of the terrain's box along the camera's axis, for the finite depth range of orthographic
// views.
double farthest_depth(const Camera& camera, const CameraBasis& basis, const Heightfield& terrain) {
    const Bounds bounds = terrain.bounds();
    double depth = 1.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point(corner & 1 ? bounds.max_x : bounds.min_x,
                               corner & 2 ? bounds.max_y : bounds.min_y,
                               static_cast<double>(corner & 4 ? terrain.highest() : terrain.lowest()));
        depth = std::max(depth, glm::dot(point - camera.eye, basis.forward));
    }
    return depth * 1.01;
}

void set_row(mat4& matrix, int row, glm::dvec3 values, double last) {
    for (int column = 0; column < 3; ++column)
        matrix[column][row] = static_cast<float>(values[column]);
    matrix[3][row] = static_cast<float>(last);
}

// Reversed depth: 1 at the nearest distance, 0 at the farthest or at infinity.
void set_projection(const Camera& camera, const CameraBasis& basis, double aspect, const Heightfield& terrain,
                    double base_depth, ViewBlock& block) {
    const double half =
        camera.orthographic() ? 0.5 * camera.view_height : half_height_at_unit_distance(camera);
    set_row(block.clip_from_base, 0, basis.right / (half * aspect), 0.0);
    set_row(block.clip_from_base, 1, basis.up / half, 0.0);
    if (camera.orthographic()) {
        const double range = std::max(farthest_depth(camera, basis, terrain) - base_depth, 1.0);
        set_row(block.clip_from_base, 2, -basis.forward / range, 1.0);
        set_row(block.clip_from_base, 3, {0.0, 0.0, 0.0}, 1.0);
        block.base_offset.w = static_cast<float>(-base_depth);
    } else {
        const double near_distance = near_distance_of(camera);
        set_row(block.clip_from_base, 2, {0.0, 0.0, 0.0}, near_distance);
        set_row(block.clip_from_base, 3, basis.forward, base_depth);
        block.base_offset.w = static_cast<float>(near_distance - base_depth);
    }
}

void set_rays(const Camera& camera, const CameraBasis& basis, int height, double base_depth,
              ViewBlock& block) {
    const auto pixel_step = [&](glm::dvec3 axis, double half) {
        return vec4(axis * (2.0 * half / height), 0.0);
    };
    block.forward = vec4(basis.forward, base_depth);
    block.ray_direction = vec4(basis.forward, 0.0);
    const vec4 zero(0.0F);
    if (camera.orthographic()) {
        block.ray_direction_dx = block.ray_direction_dy = zero;
        block.ray_origin_dx = pixel_step(basis.right, 0.5 * camera.view_height);
        block.ray_origin_dy = pixel_step(basis.up, 0.5 * camera.view_height);
    } else {
        const double half = half_height_at_unit_distance(camera);
        block.ray_direction_dx = pixel_step(basis.right, half);
        block.ray_direction_dy = pixel_step(basis.up, half);
        block.ray_origin_dx = pixel_step(basis.right, half * base_depth);
        block.ray_origin_dy = pixel_step(basis.up, half * base_depth);
    }
}

// A box in the scene relative to the eye.
struct Box {
    glm::dvec3 low;
    glm::dvec3 high;

    // The largest value of dot(normal, point) in the box.
    double reach(glm::dvec3 normal) const {
        return (normal.x > 0.0 ? high.x : low.x) * normal.x + (normal.y > 0.0 ? high.y : low.y) * normal.y +
               (normal.z > 0.0 ? high.z : low.z) * normal.z;
    }

    double distance() const {
        const glm::dvec3 nearest = glm::clamp(glm::dvec3(0.0), low, high);
        return glm::length(nearest);
    }

    double farthest_distance() const { return glm::length(glm::max(glm::abs(low), glm::abs(high))); }
};

// Planes through the picture's edges: a point is seen when dot(normal, point) + offset >= 0 for all of them.
struct Frustum {
    struct Plane {
        glm::dvec3 normal;
        double offset;
    };
    std::array<Plane, 5> planes;

    Frustum(const Camera& camera, const CameraBasis& basis, double aspect) {
        const bool flat = camera.orthographic();
        const double half_y = flat ? 0.5 * camera.view_height : half_height_at_unit_distance(camera);
        const double half_x = half_y * aspect;
        const glm::dvec3 ahead = flat ? glm::dvec3(0.0) : basis.forward;
        planes = {{{ahead * half_x + basis.right, flat ? half_x : 0.0},
                   {ahead * half_x - basis.right, flat ? half_x : 0.0},
                   {ahead * half_y + basis.up, flat ? half_y : 0.0},
                   {ahead * half_y - basis.up, flat ? half_y : 0.0},
                   {basis.forward, 0.0}}};
    }

    bool sees(const Box& box) const {
        return std::all_of(planes.begin(), planes.end(),
                           [&](const Plane& plane) { return box.reach(plane.normal) + plane.offset >= 0.0; });
    }
};

Box tile_box(const TerrainTile& tile, const Heightfield& terrain, const glm::dvec3& eye) {
    const Bounds bounds = bounds_of(tile, terrain);
    return {glm::dvec3(bounds.min_x, bounds.min_y, static_cast<double>(tile.lowest)) - eye,
            glm::dvec3(bounds.max_x, bounds.max_y, static_cast<double>(tile.highest)) - eye};
}

// The fewest metres that the picture's height shows of an offset in any direction, anywhere in the box. Away
// from the picture's middle an offset shows larger: distances there are longer than depths, and the rays come
// in at a slant.
double metres_per_picture(const Camera& camera, const CameraBasis& basis, double aspect, const Box& box) {
    if (camera.orthographic())
        return camera.view_height;
    const double half = half_height_at_unit_distance(camera);
    const double corner = std::sqrt(1.0 + half * half * (1.0 + aspect * aspect));  // distance over depth
    const double depth = std::max(-box.reach(-basis.forward), box.distance() / corner);
    return 2.0 * half * depth / std::min(corner, box.farthest_distance() / depth);
}

int choose_level(const TerrainTile& tile, double pixels_per_metre, double terrain_error) {
    int level = 0;
    while (terrain_error > 0.0 && level + 1 < tile_levels &&
           static_cast<double>(tile.error[static_cast<size_t>(level + 1)]) * pixels_per_metre <=
               terrain_error)
        ++level;
    return level;
}

// Lowers levels until neighbours differ by one at most. At a seam the finer tile's vertices move along it by
// as much as the levels differ; over a longer way the strip beside the seam would be off by far more than
// either tile.
void limit_steps(const TerrainTiles& tiles, std::vector<int>& levels) {
    const int32_t columns = tiles.columns;
    const auto lower = [&](int32_t tile, int32_t neighbour) {
        int& level = levels[static_cast<size_t>(tile)];
        level = std::min(level, levels[static_cast<size_t>(neighbour)] + 1);
    };
    const auto count = static_cast<int32_t>(levels.size());
    for (int32_t i = 0; i < count; ++i) {
        if (i % columns > 0)
            lower(i, i - 1);
        if (i >= columns)
            lower(i, i - columns);
    }
    for (int32_t i = count - 1; i >= 0; --i) {
        if (i % columns < columns - 1)
            lower(i, i + 1);
        if (i < count - columns)
            lower(i, i + columns);
    }
}

}  // namespace

ViewBlock make_view_block(const Camera& camera, int width, int height, const Heightfield& terrain,
                          const PositionGrid& positions, double base_depth) {
    const CameraBasis basis = basis_of(camera);
    const glm::dvec3 base = camera.eye + base_depth * basis.forward;
    ViewBlock block{};
    set_projection(camera, basis, static_cast<double>(width) / height, terrain, base_depth, block);
    set_rays(camera, basis, height, base_depth, block);

    const SplitNumber block_x = split((base.x - positions.origin_x) / positions.block_size);
    const SplitNumber block_y = split((base.y - positions.origin_y) / positions.block_size);
    block.base_block = {block_x.whole, block_y.whole, 0, 0};
    block.base_offset.x = static_cast<float>(
        base.x - (positions.origin_x + static_cast<double>(block_x.whole) * positions.block_size));
    block.base_offset.y = static_cast<float>(
        base.y - (positions.origin_y + static_cast<double>(block_y.whole) * positions.block_size));
    block.base_offset.z = static_cast<float>(positions.block_size);

    const SplitNumber column = split((base.x - terrain.x0()) / terrain.dx());
    const SplitNumber row = split((terrain.y0() - base.y) / terrain.dy());
    const auto high = static_cast<float>(base.z);
    block.base_sample = {column.whole, row.whole, 0, 0};
    block.base_sample_fraction = {column.fraction, row.fraction, high,
                                  static_cast<float>(base.z - static_cast<double>(high))};
    block.spacing = {static_cast<float>(terrain.dx()), static_cast<float>(terrain.dy()),
                     static_cast<float>(width), static_cast<float>(height)};
    block.samples = {terrain.columns(), terrain.rows(), 0, 0};
    block.picture = {0, 0, width, height};
    return block;
}

SeenPoint seen_point(const Camera& camera, int height, glm::dvec3 place, glm::dvec2 gradient) {
    const CameraBasis basis = basis_of(camera);
    const glm::dvec3 from_eye = place - camera.eye;
    const double half =
        camera.orthographic() ? 0.5 * camera.view_height : half_height_at_unit_distance(camera);
    const double depth = camera.orthographic() ? 1.0 : glm::dot(from_eye, basis.forward);
    const double pixels = height / (2.0 * half * depth);
    const glm::dvec3 lean = camera.orthographic() ? glm::dvec3(0.0) : basis.forward / depth;
    // Pixels for a metre of each axis: what the view's own axes say, less what a growing depth takes back.
    const glm::dvec3 x = pixels * (basis.right - glm::dot(from_eye, basis.right) * lean);
    const glm::dvec3 y = pixels * (basis.up - glm::dot(from_eye, basis.up) * lean);
    SeenPoint point;
    point.x = place.x;
    point.y = place.y;
    point.gradient_x = gradient.x;
    point.gradient_y = gradient.y;
    point.forward_z = basis.forward.z;
    point.east = {x.x + x.z * gradient.x, y.x + y.z * gradient.x};
    point.north = {x.y + x.z * gradient.y, y.y + y.z * gradient.y};
    point.lean_x = lean.x + lean.z * gradient.x;
    point.lean_y = lean.y + lean.z * gradient.y;
    point.up = {x.z, y.z};
    point.lean_up = lean.z;
    point.pixels_per_metre = pixels;
    point.height = place.z;
    return point;
}

std::vector<VisibleTile> select_tiles(const TerrainTiles& tiles, const Heightfield& terrain,
                                      const Camera& camera, int width, int height, double terrain_error) {
    const CameraBasis basis = basis_of(camera);
    const double aspect = static_cast<double>(width) / height;
    const Frustum frustum(camera, basis, aspect);
    std::vector<int> levels(tiles.tiles.size());
    std::vector<bool> seen(tiles.tiles.size());
    for (size_t i = 0; i < levels.size(); ++i) {
        const TerrainTile& tile = tiles.tiles[i];
        if (tile.lowest > tile.highest)
            continue;
        const Box box = tile_box(tile, terrain, camera.eye);
        const double metres = std::max(metres_per_picture(camera, basis, aspect, box), 1e-9);
        levels[i] = choose_level(tile, height / metres, terrain_error);
        seen[i] = frustum.sees(box);
    }
    limit_steps(tiles, levels);
    const auto level_at = [&](int32_t column, int32_t row) {
        const bool inside = column >= 0 && column < tiles.columns && row >= 0 && row < tiles.rows;
        return inside ? levels[static_cast<size_t>(row * tiles.columns + column)] : 0;
    };
    std::vector<VisibleTile> visible;
    for (size_t i = 0; i < levels.size(); ++i) {
        if (!seen[i])
            continue;
        const auto column = static_cast<int32_t>(i) % tiles.columns;
        const auto row = static_cast<int32_t>(i) / tiles.columns;
        visible.push_back({&tiles.tiles[i],
                           levels[i],
                           {level_at(column - 1, row), level_at(column + 1, row), level_at(column, row - 1),
                            level_at(column, row + 1)}});
    }
    return visible;
}

Bounds bounds_of(const TerrainTile& tile, const Heightfield& terrain) {
    const int32_t last_column = std::min(tile.column + tile_quads, terrain.columns() - 1);
    const int32_t last_row = std::min(tile.row + tile_quads, terrain.rows() - 1);
    return {terrain.x0() + tile.column * terrain.dx(), terrain.y0() - last_row * terrain.dy(),
            terrain.x0() + last_column * terrain.dx(), terrain.y0() - tile.row * terrain.dy()};
}

double nearest_depth(const std::vector<VisibleTile>& tiles, const Heightfield& terrain,
                     const Camera& camera) {
    const CameraBasis basis = basis_of(camera);
    double nearest = tiles.empty() ? 0.0 : std::numeric_limits<double>::max();
    for (const VisibleTile& visible : tiles)
        nearest = std::min(nearest, -tile_box(*visible.tile, terrain, camera.eye).reach(-basis.forward));
    return std::max(0.0, static_cast<double>(static_cast<float>(0.999 * nearest)));
}

double pixel_at(const Camera& camera, int height, double depth) {
    return (camera.orthographic() ? camera.view_height : 2.0 * half_height_at_unit_distance(camera) * depth) /
           height;
}

double widest_pixel(const std::vector<VisibleTile>& tiles, const Heightfield& terrain, const Camera& camera,
                    int height) {
    const CameraBasis basis = basis_of(camera);
    double farthest = 0.0;
    for (const VisibleTile& visible : tiles)
        farthest = std::max(farthest, tile_box(*visible.tile, terrain, camera.eye).reach(basis.forward));
    return pixel_at(camera, height, farthest);
}

}  // namespace decalgl
