// Lines of the widths in hand: corners of meshes, and offsets (Taibo et al. 2014, sections 4.2 and 5.1).
//
// How many corners a joint has goes by its angle, and by the width where inner borders do not meet. So paths are worked out in
// blocks, which are put one after the other when all are there.
#include <algorithm>
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

// The paths of a block, side by side; places among its pairs are counted from its own first one.
struct Block {
    std::vector<PlacedVertex> mesh;
    std::vector<OffsetVertex> offsets;
    size_t pair_count = 0;
    size_t first_pair = 0;
};

class BlockWriter {
public:
    BlockWriter(const ClipmapGeometry& geometry, Block& block, Span<VertexRange> ranges)
        : geometry_(geometry),
          block_(block),
          ranges_(ranges),
          has_mesh_(geometry.has_mesh()),
          has_offsets_(geometry.has_offsets()),
          is_polar_(geometry.options.solution == LineSolution::polar_offsets) {}

    // half_width: in quanta.
    void write(const Path& path, double half_width) {
        line_.clear();
        for (int32_t i = path.line.first; i < path.line.first + path.line.count; ++i) {
            const PlacedVertex& vertex = geometry_.lines[static_cast<size_t>(i)];
            line_.push_back({double(vertex.x), double(vertex.y)});
        }
        const std::vector<CornerPair> pairs = corner_pairs(
            line_, path.closed, half_width, {geometry_.options.bevel_below, geometry_.options.joints});
        set_ranges(path, pairs);
        for (const CornerPair& pair : pairs)
            add(pair, path.decal, half_width);
        block_.pair_count += pairs.size();
    }

private:
    void add(const CornerPair& pair, uint32_t decal, double half_width) {
        const Vector2 v = line_[pair.vertex];
        if (has_offsets_)
            block_.offsets.push_back({rounded(v.x), rounded(v.y), decal, packed(pair, is_polar_)});
        if (has_mesh_)
            for (const Vector2& offset : {pair.left, pair.right})
                block_.mesh.push_back(
                    {rounded(v.x + half_width * offset.x), rounded(v.y + half_width * offset.y), decal});
    }

    // A joint between two chunks belongs to the first with all its pairs.
    void set_ranges(const Path& path, const std::vector<CornerPair>& pairs) {
        const auto start = static_cast<int32_t>(block_.pair_count);
        size_t chunk = path.first_chunk, begin = 0, next = 0;
        for (int32_t first = 0; first + 1 < path.line.count; first += chunk_segments, ++chunk) {
            const auto last =
                static_cast<uint32_t>(std::min(path.line.count - 1, first + int32_t{chunk_segments}));
            while (next < pairs.size() && pairs[next].vertex <= last)
                ++next;
            ranges_[chunk] = {start + static_cast<int32_t>(begin), static_cast<int32_t>(next - begin)};
            begin = next - 1;
        }
    }

    const ClipmapGeometry& geometry_;
    Block& block_;
    Span<VertexRange> ranges_;
    const bool has_mesh_;
    const bool has_offsets_;
    const bool is_polar_;
    std::vector<Vector2> line_;
};

constexpr size_t block_paths = 64;

template <typename Action>
void for_each_path(const ClipmapGeometry& geometry, size_t block, Action action) {
    const size_t first = block * block_paths;
    for (size_t i = first; i < std::min(first + block_paths, geometry.paths.size()); ++i)
        action(geometry.paths[i]);
}

}  // namespace

Tessellation tessellate(const ClipmapGeometry& geometry, Span<const PlainLook> looks, double wider,
                        const MemoryAccount& memory) {
    std::vector<Block> blocks((geometry.paths.size() + block_paths - 1) / block_paths);
    LargeArray<VertexRange> ranges;
    ranges.resize(blocks.empty() ? 0 : geometry.chunks.size());
    const auto for_blocks = [&](auto action) {
        parallel_for(blocks.size(), 1, 0, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i)
                action(i);
        });
    };
    for_blocks([&](size_t i) {
        BlockWriter writer(geometry, blocks[i], Span<VertexRange>(ranges.data(), ranges.size()));
        for_each_path(geometry, i, [&](const Path& path) {
            const double half_width = wider * static_cast<double>(looks[path.decal].half_width);
            writer.write(path, half_width / geometry.texture.quantum());
        });
    });
    size_t pair_count = 0;
    for (Block& block : blocks) {
        block.first_pair = pair_count;
        pair_count += block.pair_count;
    }
    LargeArray<PlacedVertex> mesh;
    LargeArray<OffsetVertex> offsets;
    mesh.resize(geometry.has_mesh() ? 2 * pair_count : 0);
    offsets.resize(geometry.has_offsets() ? pair_count : 0);
    for_blocks([&](size_t i) {
        Block& block = blocks[i];
        std::copy(block.mesh.begin(), block.mesh.end(), mesh.begin() + 2 * block.first_pair);
        std::copy(block.offsets.begin(), block.offsets.end(), offsets.begin() + block.first_pair);
        for_each_path(geometry, i, [&](const Path& path) {
            const int32_t chunks = (path.line.count - 2) / chunk_segments + 1;
            for (uint32_t k = path.first_chunk; k < path.first_chunk + static_cast<uint32_t>(chunks); ++k)
                ranges[k].first += static_cast<int32_t>(block.first_pair);
        });
        block = {};
    });
    return {charged(SharedArray<VertexRange>(std::move(ranges)), memory, prepared_name),
            charged(SharedArray<PlacedVertex>(std::move(mesh)), memory, prepared_name),
            charged(SharedArray<OffsetVertex>(std::move(offsets)), memory, prepared_name)};
}

}  // namespace decalgl::clipmap
