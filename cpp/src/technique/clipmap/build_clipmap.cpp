// From layers to what tiles are drawn from.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "technique/clipmap/prepared_clipmap.h"
#include "technique/plain_styles.h"
#include "vector/clip_polygon.h"

namespace decalgl::clipmap {
namespace {

// How far vertices may lie from the virtual texture's corner, in quanta: half its side beyond it on either side.
constexpr double lattice_reach = 1 << (lattice_bits - 1);
constexpr double farthest_place = lattice_reach + (1 << lattice_bits);

// Other techniques' options and none are the default.
ClipmapOptions options_of(const Layer& layer) {
    const auto* chosen = dynamic_cast<const ClipmapOptions*>(layer.technique.options.get());
    return chosen != nullptr ? *chosen : ClipmapOptions{};
}

bool within_reach(Vector2 p) {
    return p.x >= -lattice_reach && p.y >= -lattice_reach && p.x <= farthest_place && p.y <= farthest_place;
}

Vector2 rounded(Vector2 p) {
    return {std::nearbyint(p.x), std::nearbyint(p.y)};
}

class ClipmapBuilder {
public:
    ClipmapBuilder(const TechniqueInput& input, ClipmapGeometry& geometry)
        : input_(input), geometry_(geometry) {}

    void build(Progress& progress) {
        geometry_.decals = decals_of(input_.layers, input_.first_layer, Hidden::kept);
        for (const Decal& decal : geometry_.decals) {
            geometry_.first_chunk_of.push_back(static_cast<uint32_t>(geometry_.chunks.size()));
            const DecalView view{&input_.layers[decal.feature.layer - input_.first_layer], decal};
            if (decal.is_stroke())
                add_stroke(view);
            else
                add_fill(view);
            if (++done_ % 1024 == 0) {
                progress.report(static_cast<double>(done_) / static_cast<double>(geometry_.decals.size()));
                geometry_.charge.resize(geometry_.bytes());
            }
        }
        geometry_.first_chunk_of.push_back(static_cast<uint32_t>(geometry_.chunks.size()));
        geometry_.charge.resize(geometry_.bytes());
    }

private:
    Vector2 place(const double* xy) const {
        const double quantum = geometry_.texture.quantum();
        return {(xy[0] - geometry_.texture.left) / quantum, (xy[1] - geometry_.texture.bottom) / quantum};
    }

    PlacedVertex placed(Vector2 p) const {
        return {static_cast<int32_t>(std::lrint(p.x)), static_cast<int32_t>(std::lrint(p.y)), done_};
    }

    void add_fill(const DecalView& view) {
        const Triangles& triangles = view.layer->triangles;
        const auto first = triangles.first_of[view.feature()], end = triangles.first_of[view.feature() + 1];
        for (int64_t t = first; t < end; t += chunk_segments) {
            Chunk chunk{done_, false, {}, {static_cast<int32_t>(geometry_.fills.size()), 0}, {}};
            const int64_t last = std::min<int64_t>(end, t + chunk_segments);
            for (int64_t each = t; each < last; ++each)
                add_triangle(&triangles.coordinates[6 * static_cast<size_t>(each)], chunk);
            if (chunk.fill.count > 0)
                geometry_.chunks.push_back(chunk);
        }
    }

    // What leaves the lattice is cut off.
    void add_triangle(const double* corners, Chunk& chunk) {
        const std::array<Vector2, 3> triangle{place(corners), place(corners + 2), place(corners + 4)};
        std::vector<Vector2> inside(triangle.begin(), triangle.end());
        if (!std::all_of(inside.begin(), inside.end(), within_reach))
            inside = clip_to_square(triangle, -lattice_reach, farthest_place);
        for (size_t i = 2; i < inside.size(); ++i)
            for (const Vector2& corner : {inside[0], inside[i - 1], inside[i]}) {
                geometry_.fills.push_back(placed(corner));
                chunk.box.add(lattice::LatticePoint{geometry_.fills.back().x, geometry_.fills.back().y});
                ++chunk.fill.count;
            }
    }

    void add_stroke(const DecalView& view) {
        const Features& features = view.layer->features;
        for (int64_t part = features.feature_offsets[view.feature()];
             part < features.feature_offsets[view.feature() + 1]; ++part) {
            const Span<const double> xy = features.part(static_cast<size_t>(part));
            std::vector<Vector2> line;
            for (size_t i = 0; i < xy.size(); i += 2)
                line.push_back(place(&xy[i]));
            const bool ring = features.kind == FeatureKind::polygons;
            if (ring && line.size() > 2 &&
                (line.front().x != line.back().x || line.front().y != line.back().y))
                line.push_back(line.front());
            cut_to_reach(line);
        }
    }

    // What leaves the lattice is cut off, and splits a line.
    void cut_to_reach(const std::vector<Vector2>& line) {
        if (std::all_of(line.begin(), line.end(), within_reach)) {
            add_line(line);
            return;
        }
        std::vector<Vector2> run;
        for (size_t i = 0; i + 1 < line.size(); ++i) {
            Vector2 from = line[i], to = line[i + 1];
            if (cut(from, to)) {
                if (run.empty() || run.back().x != from.x || run.back().y != from.y) {
                    add_line(run);
                    run = {from};
                }
                run.push_back(to);
            }
        }
        add_line(run);
    }

    // The part of a segment within reach; false where there is none.
    static bool cut(Vector2& from, Vector2& to) {
        double begin = 0.0, end = 1.0;
        const Vector2 along{to.x - from.x, to.y - from.y};
        const auto limit = [&](double start, double step) {
            if (step == 0.0)
                return start >= -lattice_reach && start <= farthest_place;
            const double a = (-lattice_reach - start) / step, b = (farthest_place - start) / step;
            begin = std::max(begin, std::min(a, b));
            end = std::min(end, std::max(a, b));
            return begin < end;
        };
        if (!limit(from.x, along.x) || !limit(from.y, along.y))
            return false;
        const Vector2 start = from;
        if (begin > 0.0)
            from = {start.x + begin * along.x, start.y + begin * along.y};
        if (end < 1.0)
            to = {start.x + end * along.x, start.y + end * along.y};
        return true;
    }

    // Vertices are rounded first: whatever is tessellated from them later is what is tessellated now.
    void add_line(const std::vector<Vector2>& places) {
        std::vector<Vector2> line;
        for (const Vector2& each : places) {
            const Vector2 p = rounded(each);
            if (line.empty() || line.back().x != p.x || line.back().y != p.y)
                line.push_back(p);
        }
        if (line.size() < 2)
            return;
        const bool closed =
            line.size() >= 4 && line.front().x == line.back().x && line.front().y == line.back().y;
        const size_t first_chunk = geometry_.chunks.size();
        for (size_t first = 0; first + 1 < line.size(); first += chunk_segments) {
            Chunk chunk{done_, true, {}, {}, {}};
            const size_t last = std::min(line.size() - 1, first + chunk_segments);
            for (size_t i = first; i <= last; ++i)
                chunk.box.add(lattice::LatticePoint{placed(line[i]).x, placed(line[i]).y});
            geometry_.chunks.push_back(chunk);
        }
        const Path path{done_, add_vertices(line, closed), static_cast<uint32_t>(first_chunk), closed};
        set_lines(path);
        if (geometry_.has_mesh() || geometry_.has_offsets())
            geometry_.paths.push_back(path);
    }

    // The line with the vertex before its first one and after its last: those of the other end of a ring, or the same.
    VertexRange add_vertices(const std::vector<Vector2>& line, bool closed) {
        geometry_.lines.push_back(placed(closed ? line[line.size() - 2] : line.front()));
        const auto first = static_cast<int32_t>(geometry_.lines.size());
        for (const Vector2& p : line)
            geometry_.lines.push_back(placed(p));
        geometry_.lines.push_back(placed(closed ? line[1] : line.back()));
        return {first, static_cast<int32_t>(line.size())};
    }

    void set_lines(const Path& path) {
        size_t chunk = path.first_chunk;
        for (int32_t first = 0; first + 1 < path.line.count; first += chunk_segments, ++chunk)
            geometry_.chunks[chunk].line = {
                path.line.first + first,
                std::min(path.line.count - first, static_cast<int32_t>(chunk_segments) + 1)};
    }

    const TechniqueInput& input_;
    ClipmapGeometry& geometry_;
    uint32_t done_ = 0;  // decals
};

}  // namespace

std::unique_ptr<const PreparedClipmap> build_clipmap(const TechniqueInput& input, Progress& progress) {
    for (const Layer& layer : input.layers)
        require_plain_styles(layer, "clipmap");
    auto geometry = std::make_shared<ClipmapGeometry>();
    geometry->charge = MemoryCharge(input.memory, prepared_name, 0);
    geometry->texture = VirtualTexture::over(input.bounds, input.positions);
    geometry->options = options_of(input.layers[0]);
    geometry->first_layer = input.first_layer;
    geometry->segments = segments_of(input.layers);
    for (const Layer& layer : input.layers) {
        geometry->features += layer.features.feature_count();
        geometry->outlines.push_back(layer.outline_order);
    }
    ClipmapBuilder(input, *geometry).build(progress);
    auto prepared = std::make_unique<PreparedClipmap>();
    for (const Decal& decal : geometry->decals)
        prepared->looks.push_back(look_of({&input.layers[decal.feature.layer - input.first_layer], decal}));
    prepared->upwards.resize(geometry->decals.size());
    std::iota(prepared->upwards.begin(), prepared->upwards.end(), 0U);
    prepared->tessellation = tessellate(*geometry, prepared->looks, 1.0, input.memory);
    if (!geometry->draws_lines() && !geometry->is_tessellated_anew()) {
        geometry->lines = {};
        geometry->paths = {};
        geometry->charge.resize(geometry->bytes());
    }
    prepared->geometry = std::move(geometry);
    prepared->order_chunks();
    progress.report(1.0);
    return prepared;
}

}  // namespace decalgl::clipmap
