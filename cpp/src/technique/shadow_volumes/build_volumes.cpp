// From layers to volumes: decals are cut into triangles and stretched on all cores, then grouped by colour.
#include <cmath>

#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"
#include "technique/shadow_volumes/color_groups.h"
#include "technique/shadow_volumes/stroke_pieces.h"
#include "technique/shadow_volumes/volume_mesh.h"

namespace decalgl::volume {
namespace {

constexpr double pi = 3.14159265358979323846;

[[noreturn]] void refuse(const Layer& layer, const std::string& what) {
    throw Error(ErrorKind::unsupported, "layer '" + layer.name + "': technique 'volume' cannot draw " + what +
                                            "; leave that out, or draw the layer with technique 'static'");
}

void check_stroke(const Layer& layer, const Stroke& stroke) {
    if (stroke.empty())
        return;
    for (const StrokeStyle& style : stroke.styles) {
        if (style.pattern.period > 0.0)
            refuse(layer, "patterns along lines");
        if (!style.bands.empty())
            refuse(layer, "bands of colour across lines");
        if (style.slope_correction != SlopeCorrection::none)
            refuse(layer, "widths that are corrected on slopes");
    }
}

void check_layer(const Layer& layer) {
    check_stroke(layer, layer.stroke);
    check_stroke(layer, layer.casing);
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
        throw Error(ErrorKind::unsupported,
                    "layer '" + layer.name +
                        "': technique 'volume' needs polygons cut into triangles (Layer::triangles), which the "
                        "Python package does; set them, or draw the layer with technique 'static'");
}

class VolumeBuilder {
public:
    VolumeBuilder(const TechniqueInput& input, PreparedVolumes& prepared)
        : input_(input),
          prepared_(prepared),
          heights_(*input.terrain, prepared.lattice, input.memory),
          cells_(estimated_triangles()) {}

    void build(Progress& progress) {
        constexpr size_t grain = 256;
        std::vector<MeshedVolumes> blocks(block_count(prepared_.decals.size(), grain));
        const auto mesh = [&](size_t begin, size_t end) {
            DecalMesher mesher(*this, blocks[begin / grain]);
            for (size_t i = begin; i < end; ++i)
                mesher.mesh(static_cast<uint32_t>(i));
        };
        parallel_for(prepared_.decals.size(), grain, input_.threads, mesh,
                     [&](double share) { progress.report(0.5 * share); });
        join(blocks);
        std::vector<std::array<uint8_t, 4>> colors;
        for (const Decal& decal : prepared_.decals) {
            const uint8_t* color = view_of(decal).color();
            colors.push_back({color[0], color[1], color[2], color[3]});
        }
        group_by_color(colors, options_.grouping, cells_, prepared_, progress);
        count_bytes();
    }

private:
    // Meshes decals one after the other into one block.
    class DecalMesher {
    public:
        DecalMesher(const VolumeBuilder& builder, MeshedVolumes& block)
            : builder_(builder),
              mesher_(builder.heights_, block) {}

        void mesh(uint32_t decal) {
            const DecalView view = builder_.view_of(builder_.prepared_.decals[decal]);
            if (view.decal.is_stroke())
                mesh_stroke(decal, view);
            else
                mesh_fill(view);
            mesher_.finish(decal);
            forget_cells();
        }

    private:
        void mesh_fill(const DecalView& view) {
            const Triangles& triangles = view.layer->triangles;
            const auto first = triangles.first_of[view.feature()], end = triangles.first_of[view.feature() + 1];
            for (int64_t t = first; t < end; ++t) {
                std::array<Vector2, 3> corners;
                for (size_t i = 0; i < 3; ++i) {
                    const double* xy = &triangles.coordinates[6 * static_cast<size_t>(t) + 2 * i];
                    corners[i] = builder_.prepared_.lattice.place(xy[0], xy[1]);
                }
                mesher_.add(corners);
            }
        }

        void mesh_stroke(uint32_t decal, const DecalView& view) {
            in_cell_.resize(builder_.cells_.count(), 0);
            const StrokeStyle& style = view.style();
            const StrokeShape shape{view.half_width() / builder_.prepared_.lattice.quantum, style.corner, style.cap,
                                    style.miter_limit, builder_.options_.arc_step * pi / 180.0};
            most_ = most_over_each_other(
                {view.color()[0], view.color()[1], view.color()[2], view.color()[3]});
            const Features& features = view.layer->features;
            const PieceFn add = [&](Span<const Vector2> corners, uint32_t) { add_piece(corners, decal); };
            for (int64_t part = features.feature_offsets[view.feature()];
                 part < features.feature_offsets[view.feature() + 1]; ++part) {
                const Span<const double> xy = features.part(static_cast<size_t>(part));
                std::vector<Vector2> vertices;
                for (size_t i = 0; i < xy.size(); i += 2)
                    vertices.push_back(builder_.prepared_.lattice.place(xy[i], xy[i + 1]));
                cut_stroke(vertices, features.kind == FeatureKind::polygons, shape, add);
            }
        }

        // Begins another volume where this one would lie too often over itself.
        void add_piece(Span<const Vector2> corners, uint32_t decal) {
            touched_.clear();
            bool fits = true;
            for (size_t i = 2; i < corners.size(); ++i) {
                if (!on_lattice(corners[0]) || !on_lattice(corners[i - 1]) || !on_lattice(corners[i]))
                    continue;  // all of it is cut anew, and lies in the outermost cells
                const Triangle triangle{rounded(corners[0]), rounded(corners[i - 1]), rounded(corners[i])};
                builder_.cells_.for_each(triangle, [&](size_t cell) {
                    fits = fits && in_cell_[cell] + corners.size() <= most_;
                    touched_.push_back(cell);
                });
            }
            if (!fits) {
                mesher_.finish(decal);
                forget_cells();
            }
            mesher_.add(corners);
            for (const size_t cell : touched_) {
                ++in_cell_[cell];
                used_.push_back(cell);
            }
        }

        void forget_cells() {
            for (const size_t cell : used_)
                in_cell_[cell] = 0;
            used_.clear();
        }

        const VolumeBuilder& builder_;
        VolumeMesher mesher_;
        uint32_t most_ = 0;
        std::vector<uint16_t> in_cell_;  // triangles of the volume in hand
        std::vector<size_t> touched_;
        std::vector<size_t> used_;
    };

    DecalView view_of(const Decal& decal) const {
        return {&input_.layers[decal.feature.layer - input_.first_layer], decal};
    }

    uint64_t estimated_triangles() const {
        uint64_t count = 0;
        for (const Layer& layer : input_.layers)
            count += 4 * layer.features.vertex_count() + layer.triangles.coordinates.size() / 6;
        return count;
    }

    void join(std::vector<MeshedVolumes>& blocks) {
        uint64_t vertices = 0, corners = 0;
        for (const MeshedVolumes& block : blocks) {
            vertices += block.vertices.size();
            corners += block.corners.size();
        }
        constexpr uint64_t most = uint64_t{1} << 31;
        if (2 * vertices >= most || corners >= most)
            throw Error(ErrorKind::memory,
                        "technique 'volume': the meshes would have more than 2^31 corners; draw fewer features, or use "
                        "technique 'static'");
        prepared_.charge.resize(vertices * sizeof(VolumeVertex) + corners * sizeof(uint32_t));
        prepared_.vertices.reserve(vertices);
        prepared_.corners.reserve(corners);
        for (MeshedVolumes& block : blocks) {
            const auto first_vertex = static_cast<uint32_t>(prepared_.vertices.size());
            const auto first_corner = static_cast<uint32_t>(prepared_.corners.size());
            for (Volume volume : block.volumes) {
                volume.first_corner += first_corner;
                prepared_.volumes.push_back(volume);
            }
            prepared_.vertices.insert(prepared_.vertices.end(), block.vertices.begin(), block.vertices.end());
            for (const uint32_t corner : block.corners)
                prepared_.corners.push_back(corner + 2 * first_vertex);
            block = {};
        }
        prepared_.first_volume_of.assign(prepared_.decals.size() + 1, 0);
        for (const Volume& volume : prepared_.volumes)
            ++prepared_.first_volume_of[volume.decal + 1];
        for (size_t i = 1; i < prepared_.first_volume_of.size(); ++i)
            prepared_.first_volume_of[i] += prepared_.first_volume_of[i - 1];
    }

    void count_bytes() {
        prepared_.charge.resize(prepared_.vertices.size() * sizeof(VolumeVertex) +
                                prepared_.corners.size() * sizeof(uint32_t) +
                                prepared_.volumes.size() * (sizeof(Volume) + sizeof(uint32_t)) +
                                prepared_.decals.size() * (sizeof(Decal) + sizeof(uint32_t)));
    }

    const TechniqueInput& input_;
    PreparedVolumes& prepared_;
    const VolumeOptions default_options_;
    const VolumeOptions& options_ = chosen_options();
    HeightRanges heights_;
    OverlapCells cells_;

    const VolumeOptions& chosen_options() const {
        const auto* chosen = dynamic_cast<const VolumeOptions*>(input_.layers[0].technique.options.get());
        return chosen != nullptr ? *chosen : default_options_;
    }
};

// A ring of n vertices has n edges, a line of n vertices n - 1 segments.
void count_segments(const TechniqueInput& input, PreparedVolumes& prepared) {
    for (const Layer& layer : input.layers) {
        const Features& features = layer.features;
        prepared.features += features.feature_count();
        const uint64_t fewer = features.kind == FeatureKind::polygons ? 0 : features.part_count();
        prepared.segments += features.vertex_count() - std::min<uint64_t>(fewer, features.vertex_count());
    }
}

}  // namespace

std::unique_ptr<const PreparedVolumes> build_volumes(const TechniqueInput& input, Progress& progress) {
    for (const Layer& layer : input.layers)
        check_layer(layer);
    auto prepared = std::make_unique<PreparedVolumes>();
    prepared->charge = MemoryCharge(input.memory, "volume: prepared", 0);
    prepared->lattice = Lattice::over(input.bounds);
    prepared->decals = decals_of(input.layers, input.first_layer);
    for (const Decal& decal : prepared->decals)
        prepared->widest = std::max(
            prepared->widest,
            DecalView{&input.layers[decal.feature.layer - input.first_layer], decal}.half_width());
    count_segments(input, *prepared);
    VolumeBuilder(input, *prepared).build(progress);
    progress.report(1.0);
    return prepared;
}

PreparedCounts PreparedVolumes::counts() const {
    return {features, segments, corners.size() / 3, charge.bytes(), lattice.quantum};
}

std::vector<FeatureReference> PreparedVolumes::query(const SeenPoint& point) const {
    std::vector<FeatureReference> found;
    const Vector2 place = lattice.place(point.x, point.y);
    if (!on_lattice(place))
        return found;
    const LatticePoint p = rounded(place);
    const auto corner = [&](uint32_t i) {
        return LatticePoint{vertices[corners[i] / 2].x, vertices[corners[i] / 2].y};
    };
    const auto covers = [&](const Volume& volume) {
        for (uint32_t i = volume.first_corner; i < volume.first_corner + volume.lid_corners; i += 3) {
            const LatticePoint a = corner(i), b = corner(i + 1), c = corner(i + 2);
            if (doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0)
                return true;
        }
        return false;
    };
    for (size_t decal = decals.size(); decal-- > 0;) {
        for (uint32_t i = first_volume_of[decal]; i < first_volume_of[decal + 1]; ++i) {
            const Volume& volume = volumes[volumes_of[i]];
            if (!volume.box.holds(p) || !covers(volume))
                continue;
            // A feature may show more than one of its decals.
            const FeatureReference feature = decals[decal].feature;
            if (std::find(found.begin(), found.end(), feature) == found.end())
                found.push_back(feature);
            break;
        }
    }
    return found;
}

}  // namespace decalgl::volume
