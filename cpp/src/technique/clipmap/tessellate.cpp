// Lines of the widths in hand: corners of meshes, and offsets (Taibo et al. 2014, sections 4.2 and 5.1).
//
// How many corners a joint has depends on its angle alone. So another width has other values in the same places.
#include <cmath>
#include <utility>

#include "core/growing_array.h"
#include "decalgl/core/parallel.h"
#include "technique/clipmap/line_strips.h"
#include "technique/clipmap/prepared_clipmap.h"

namespace decalgl::clipmap {
namespace {

std::array<float, 4> packed(const CornerPair& pair, bool is_polar) {
    if (!is_polar)
        return {static_cast<float>(pair.left.x), static_cast<float>(pair.left.y),
                static_cast<float>(pair.right.x), static_cast<float>(pair.right.y)};
    return {static_cast<float>(length(pair.left)), static_cast<float>(std::atan2(pair.left.y, pair.left.x)),
            static_cast<float>(length(pair.right)),
            static_cast<float>(std::atan2(pair.right.y, pair.right.x))};
}

int32_t rounded(double place) {
    return static_cast<int32_t>(std::lrint(place));
}

}  // namespace

Tessellation tessellate(const ClipmapGeometry& geometry, Span<const PlainLook> looks, double wider,
                        const MemoryAccount& memory) {
    const bool has_mesh = geometry.has_mesh(), has_offsets = geometry.has_offsets();
    const bool is_polar = geometry.options.solution == LineSolution::polar_offsets;
    LargeArray<PlacedVertex> mesh;
    LargeArray<OffsetVertex> offsets;
    mesh.resize(has_mesh ? 2 * geometry.pair_count : 0);
    offsets.resize(has_offsets ? geometry.pair_count : 0);
    const auto write = [&](const Path& path) {
        std::vector<Vector2> line;
        for (int32_t i = path.line.first; i < path.line.first + path.line.count; ++i) {
            const PlacedVertex& vertex = geometry.lines[static_cast<size_t>(i)];
            line.push_back({double(vertex.x), double(vertex.y)});
        }
        const double half_width =
            wider * static_cast<double>(looks[path.decal].half_width) / geometry.texture.quantum();
        size_t at = static_cast<size_t>(path.first_pair);
        for (const CornerPair& pair :
             corner_pairs(line, path.closed, half_width,
                          {geometry.options.bevel_below, geometry.options.inner_meets})) {
            const Vector2 v = line[pair.vertex];
            if (has_offsets)
                offsets[at] = {rounded(v.x), rounded(v.y), path.decal, packed(pair, is_polar)};
            for (size_t side = 0; has_mesh && side < 2; ++side) {
                const Vector2& offset = side == 0 ? pair.left : pair.right;
                mesh[2 * at + side] = {rounded(v.x + half_width * offset.x),
                                       rounded(v.y + half_width * offset.y), path.decal};
            }
            ++at;
        }
    };
    parallel_for(geometry.paths.size(), 64, 0, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            write(geometry.paths[i]);
    });
    return {charged(SharedArray<PlacedVertex>(std::move(mesh)), memory, prepared_name),
            charged(SharedArray<OffsetVertex>(std::move(offsets)), memory, prepared_name)};
}

}  // namespace decalgl::clipmap
