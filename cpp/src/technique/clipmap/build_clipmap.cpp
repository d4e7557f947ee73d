// From layers to what tiles are drawn from.
#include <algorithm>
#include <cmath>

#include "decalgl/core/error.h"
#include "technique/clipmap/line_strips.h"
#include "technique/clipmap/prepared_clipmap.h"

namespace decalgl::clipmap {
namespace {

constexpr size_t chunk_segments = 64;
// How far vertices may lie from the virtual texture's corner, in quanta: twice its side beyond it on either side.
constexpr double lattice_reach = 1 << (lattice_bits - 1);

[[noreturn]] void refuse(const Layer& layer, const std::string& what) {
    throw Error(ErrorKind::unsupported, "layer '" + layer.name + "': technique 'clipmap' cannot draw " +
                                            what +
                                            "; leave that out, or draw the layer with technique 'static'");
}

void check_layer(const Layer& layer) {
    for (const Stroke* stroke : {&layer.stroke, &layer.casing}) {
        if (stroke->empty())
            continue;
        for (const StrokeStyle& style : stroke->styles) {
            if (style.pattern.period > 0.0)
                refuse(layer, "patterns along lines");
            if (!style.bands.empty())
                refuse(layer, "bands of colour across lines");
            if (style.slope_correction != SlopeCorrection::none)
                refuse(layer, "widths that are corrected on slopes");
        }
    }
    if (layer.features.kind != FeatureKind::polygons)
        return;
    if (!layer.stroke.empty() && layer.outline_mode != OutlineMode::normal)
        refuse(layer, "outlines on one side of a border");
    if (layer.fill.empty())
        return;
    for (const Hatch& hatch : layer.fill.hatches)
        if (hatch.spacing > 0.0)
            refuse(layer, "hatches");
    if (layer.triangles.first_of.size() != layer.features.feature_count() + 1)
        throw Error(
            ErrorKind::unsupported,
            "layer '" + layer.name +
                "': technique 'clipmap' needs polygons cut into triangles (Layer::triangles), which the "
                "Python package does; set them, or draw the layer with technique 'static'");
}

bool within_reach(Vector2 p) {
    constexpr double farthest = lattice_reach + (1 << lattice_bits);
    return p.x >= -lattice_reach && p.y >= -lattice_reach && p.x <= farthest && p.y <= farthest;
}

class ClipmapBuilder {
public:
    ClipmapBuilder(const TechniqueInput& input, PreparedClipmap& prepared)
        : input_(input), prepared_(prepared) {}

    void build(Progress& progress) {
        const std::vector<Decal> decals = decals_of(input_.layers, input_.first_layer);
        for (size_t i = 0; i < decals.size(); ++i) {
            const DecalView view{&input_.layers[decals[i].feature.layer - input_.first_layer], decals[i]};
            const uint8_t* color = view.color();
            prepared_.decals.push_back(
                {{color[0], color[1], color[2], color[3]}, static_cast<float>(view.half_width())});
            if (view.decal.is_stroke())
                add_stroke(view);
            else
                add_fill(view);
            if (i % 1024 == 0) {
                progress.report(static_cast<double>(i) / static_cast<double>(decals.size()));
                prepared_.charge.resize(bytes());
            }
        }
        prepared_.charge.resize(bytes());
    }

private:
    uint64_t bytes() const {
        return prepared_.fills.size() * sizeof(PlacedVertex) + prepared_.lines.size() * sizeof(PlacedVertex) +
               prepared_.mesh.size() * sizeof(PlacedVertex) +
               prepared_.offsets.size() * sizeof(OffsetVertex) + prepared_.chunks.size() * sizeof(Chunk) +
               prepared_.decals.size() * sizeof(ClipmapDecal);
    }

    Vector2 place(const double* xy) const {
        const double quantum = prepared_.texture.quantum();
        return {(xy[0] - prepared_.texture.left) / quantum, (xy[1] - prepared_.texture.bottom) / quantum};
    }

    uint32_t decal() const { return static_cast<uint32_t>(prepared_.decals.size() - 1); }

    PlacedVertex placed(Vector2 p) const {
        return {static_cast<int32_t>(std::lrint(p.x)), static_cast<int32_t>(std::lrint(p.y)), decal()};
    }

    static void widen(LatticeBox& box, Vector2 p, double reach) {
        const auto limited = [](double value) {
            return static_cast<int32_t>(std::clamp(value, -2147483000.0, 2147483000.0));
        };
        box.min_x = std::min(box.min_x, limited(std::floor(p.x - reach)));
        box.min_y = std::min(box.min_y, limited(std::floor(p.y - reach)));
        box.max_x = std::max(box.max_x, limited(std::ceil(p.x + reach)));
        box.max_y = std::max(box.max_y, limited(std::ceil(p.y + reach)));
    }

    void add_fill(const DecalView& view) {
        const Triangles& triangles = view.layer->triangles;
        const auto first = triangles.first_of[view.feature()], end = triangles.first_of[view.feature() + 1];
        for (int64_t t = first; t < end; t += chunk_segments) {
            Chunk chunk{decal(), false, {}, {static_cast<int32_t>(prepared_.fills.size()), 0}, {}, {}, {}};
            const int64_t last = std::min<int64_t>(end, t + chunk_segments);
            for (int64_t corner = 3 * t; corner < 3 * last; ++corner) {
                Vector2 p = place(&triangles.coordinates[2 * static_cast<size_t>(corner)]);
                const double farthest = lattice_reach + std::ldexp(1.0, lattice_bits);
                p = {std::clamp(p.x, -lattice_reach, farthest), std::clamp(p.y, -lattice_reach, farthest)};
                widen(chunk.box, p, 0.0);
                prepared_.fills.push_back(placed(p));
                ++chunk.fill.count;
            }
            prepared_.chunks.push_back(chunk);
        }
    }

    void add_stroke(const DecalView& view) {
        const Features& features = view.layer->features;
        for (int64_t part = features.feature_offsets[view.feature()];
             part < features.feature_offsets[view.feature() + 1]; ++part) {
            const Span<const double> xy = features.part(static_cast<size_t>(part));
            std::vector<Vector2> line;
            for (size_t i = 0; i < xy.size(); i += 2) {
                const Vector2 p = place(&xy[i]);
                if (line.empty() || line.back().x != p.x || line.back().y != p.y)
                    line.push_back(p);
            }
            const bool ring = features.kind == FeatureKind::polygons;
            if (ring && line.size() > 2 &&
                (line.front().x != line.back().x || line.front().y != line.back().y))
                line.push_back(line.front());
            cut_to_reach(line, 2.0 * view.half_width() / prepared_.texture.quantum());
        }
    }

    // What leaves the lattice is cut off, and splits a line.
    void cut_to_reach(const std::vector<Vector2>& line, double width) {
        if (std::all_of(line.begin(), line.end(), within_reach)) {
            add_line(line, 0.5 * width);
            return;
        }
        std::vector<Vector2> run;
        for (size_t i = 0; i + 1 < line.size(); ++i) {
            Vector2 from = line[i], to = line[i + 1];
            if (cut(from, to)) {
                if (run.empty() || run.back().x != from.x || run.back().y != from.y) {
                    add_line(run, 0.5 * width);
                    run = {from};
                }
                run.push_back(to);
            }
        }
        add_line(run, 0.5 * width);
    }

    // The part of a segment within reach; false where there is none.
    static bool cut(Vector2& from, Vector2& to) {
        const double farthest = lattice_reach + std::ldexp(1.0, lattice_bits);
        double begin = 0.0, end = 1.0;
        const Vector2 along{to.x - from.x, to.y - from.y};
        const auto limit = [&](double start, double step) {
            if (step == 0.0)
                return start >= -lattice_reach && start <= farthest;
            const double a = (-lattice_reach - start) / step, b = (farthest - start) / step;
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

    void add_line(const std::vector<Vector2>& line, double half_width) {
        if (line.size() < 2)
            return;
        const bool closed =
            line.size() >= 4 && line.front().x == line.back().x && line.front().y == line.back().y;
        const LineSolution solution = prepared_.options.solution;
        const bool with_lines = solution == LineSolution::primitives || solution == LineSolution::both ||
                                solution == LineSolution::geometry;
        const bool with_mesh = solution == LineSolution::polygons || solution == LineSolution::both ||
                               solution == LineSolution::wireframe;
        const bool with_offsets =
            solution == LineSolution::offsets || solution == LineSolution::polar_offsets;
        const size_t first_chunk = prepared_.chunks.size();
        add_chunks(line, half_width);
        if (with_lines)
            add_path(line, closed, first_chunk);
        if (with_mesh || with_offsets)
            add_pairs(line,
                      corner_pairs(line, closed, half_width,
                                   {prepared_.options.bevel_below, prepared_.options.inner_meets}),
                      half_width, with_mesh, first_chunk);
    }

    void add_chunks(const std::vector<Vector2>& line, double half_width) {
        // A joint by method 2 reaches farther than the line is wide.
        const double half_angle = 0.5 * prepared_.options.bevel_below * 3.14159265358979323846 / 180.0;
        const double reach = half_width / std::max(0.02, std::sin(half_angle)) + 1.0;
        for (size_t first = 0; first + 1 < line.size(); first += chunk_segments) {
            Chunk chunk{decal(), true, {}, {}, {}, {}, {}};
            const size_t last = std::min(line.size() - 1, first + chunk_segments);
            for (size_t i = first; i <= last; ++i)
                widen(chunk.box, line[i], reach);
            prepared_.chunks.push_back(chunk);
        }
    }

    // The line with the vertex before its first one and after its last: those of the other end of a ring, or the same.
    void add_path(const std::vector<Vector2>& line, bool closed, size_t first_chunk) {
        const auto start = static_cast<int32_t>(prepared_.lines.size());
        prepared_.lines.push_back(placed(closed ? line[line.size() - 2] : line.front()));
        for (const Vector2& p : line)
            prepared_.lines.push_back(placed(p));
        prepared_.lines.push_back(placed(closed ? line[1] : line.back()));
        for (size_t first = 0, chunk = first_chunk; first + 1 < line.size();
             first += chunk_segments, ++chunk) {
            const size_t last = std::min(line.size() - 1, first + chunk_segments);
            prepared_.chunks[chunk].line = {start + 1 + static_cast<int32_t>(first),
                                            static_cast<int32_t>(last - first + 1)};
        }
    }

    void add_pairs(const std::vector<Vector2>& line, const std::vector<CornerPair>& pairs, double half_width,
                   bool with_mesh, size_t first_chunk) {
        const auto start_mesh = static_cast<int32_t>(prepared_.mesh.size());
        const auto start_offsets = static_cast<int32_t>(prepared_.offsets.size());
        std::vector<int32_t> first_pair(line.size(), 0), last_pair(line.size(), 0);
        for (size_t i = 0; i < pairs.size(); ++i) {
            const CornerPair& pair = pairs[i];
            if (i == 0 || pairs[i - 1].vertex != pair.vertex)
                first_pair[pair.vertex] = static_cast<int32_t>(i);
            last_pair[pair.vertex] = static_cast<int32_t>(i);
            const Vector2 at = line[pair.vertex];
            if (with_mesh) {
                for (const Vector2& offset : {pair.left, pair.right})
                    prepared_.mesh.push_back(
                        placed({at.x + half_width * offset.x, at.y + half_width * offset.y}));
                continue;
            }
            const PlacedVertex vertex = placed(at);
            prepared_.offsets.push_back({vertex.x, vertex.y, vertex.decal, packed(pair)});
        }
        for (size_t first = 0, chunk = first_chunk; first + 1 < line.size();
             first += chunk_segments, ++chunk) {
            const size_t last = std::min(line.size() - 1, first + chunk_segments);
            // A joint between two chunks belongs to the first with all its pairs.
            const int32_t begin = first == 0 ? 0 : last_pair[first], end = last_pair[last] + 1;
            if (with_mesh)
                prepared_.chunks[chunk].mesh = {start_mesh + 2 * begin, 2 * (end - begin)};
            else
                prepared_.chunks[chunk].offsets = {start_offsets + begin, end - begin};
        }
    }

    std::array<float, 4> packed(const CornerPair& pair) const {
        const auto number = [](double value) { return static_cast<float>(value); };
        if (prepared_.options.solution == LineSolution::offsets)
            return {number(pair.left.x), number(pair.left.y), number(pair.right.x), number(pair.right.y)};
        return {number(length(pair.left)), number(std::atan2(pair.left.y, pair.left.x)),
                number(length(pair.right)), number(std::atan2(pair.right.y, pair.right.x))};
    }

    const TechniqueInput& input_;
    PreparedClipmap& prepared_;
};

}  // namespace

std::unique_ptr<const PreparedClipmap> build_clipmap(const TechniqueInput& input, Progress& progress) {
    for (const Layer& layer : input.layers)
        check_layer(layer);
    auto prepared = std::make_unique<PreparedClipmap>();
    prepared->charge = MemoryCharge(input.memory, "clipmap: prepared", 0);
    prepared->texture = VirtualTexture::over(input.bounds, input.positions);
    if (const auto* options = dynamic_cast<const ClipmapOptions*>(input.layers[0].technique.options.get()))
        prepared->options = *options;
    ClipmapBuilder(input, *prepared).build(progress);
    for (const Layer& layer : input.layers) {
        const Features& features = layer.features;
        prepared->features += features.feature_count();
        const uint64_t fewer = features.kind == FeatureKind::polygons ? 0 : features.part_count();
        prepared->segments += features.vertex_count() - std::min<uint64_t>(fewer, features.vertex_count());
    }
    progress.report(1.0);
    return prepared;
}

PreparedCounts PreparedClipmap::counts() const {
    return {features, segments, fills.size() + lines.size() + mesh.size() + offsets.size(), charge.bytes(),
            texture.texel(finest_level)};
}

}  // namespace decalgl::clipmap
