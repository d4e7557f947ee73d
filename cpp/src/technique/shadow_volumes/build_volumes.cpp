// From layers to volumes: decals are cut into triangles and stretched on all cores, then grouped by colour.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/growing_array.h"
#include "decalgl/core/error.h"
#include "decalgl/core/large_array.h"
#include "decalgl/core/parallel.h"
#include "technique/plain_styles.h"
#include "technique/shadow_volumes/color_groups.h"
#include "technique/shadow_volumes/stroke_pieces.h"
#include "technique/shadow_volumes/volume_mesh.h"

namespace decalgl::volume {
namespace {

constexpr double pi = 3.14159265358979323846;

// Other techniques' options and none are the default.
VolumeOptions options_of(const Layer& layer) {
    const auto* chosen = dynamic_cast<const VolumeOptions*>(layer.technique.options.get());
    return chosen != nullptr ? *chosen : VolumeOptions{};
}

class VolumeBuilder {
public:
    VolumeBuilder(const TechniqueInput& input, PreparedVolumes& prepared)
        : input_(input),
          prepared_(prepared),
          arc_step_(options_of(input.layers[0]).arc_step * pi / 180.0),
          heights_(*input.terrain, input.threads, input.memory, "volume: working memory"),
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
        prepared_.height_steps = {heights_.lowest(), static_cast<float>(heights_.step())};
        join(blocks);
    }

private:
    // Meshes decals one after the other into one block.
    class DecalMesher {
    public:
        DecalMesher(const VolumeBuilder& builder, MeshedVolumes& block)
            : builder_(builder), mesher_(builder.prepared_.lattice, builder.heights_, block) {}

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
            const auto first = triangles.first_of[view.feature()],
                       end = triangles.first_of[view.feature() + 1];
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
            const StrokeShape shape{view.half_width() / builder_.prepared_.lattice.quantum, style.corner,
                                    style.cap, style.miter_limit, builder_.arc_step_};
            const Features& features = view.layer->features;
            const PieceFn add = [&](Span<const Vector2> corners) { add_piece(corners, decal); };
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
                    fits = fits && in_cell_[cell] + corners.size() <= most_over_each_other;
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
        uint64_t vertex_count = 0, corner_count = 0;
        for (const MeshedVolumes& block : blocks) {
            vertex_count += block.vertices.size();
            corner_count += block.corners.size();
        }
        constexpr uint64_t most = uint64_t{1} << 31;
        if (2 * vertex_count >= most || corner_count >= most)
            throw Error(ErrorKind::memory,
                        "technique 'volume': the meshes would have more than 2^31 corners; draw fewer "
                        "features, or use technique 'static'");
        MemoryCharge charge(input_.memory, "volume: working memory",
                            vertex_count * sizeof(VolumeVertex) + corner_count * sizeof(uint16_t));
        LargeArray<VolumeVertex> vertices;
        LargeArray<uint16_t> corners;
        std::vector<Volume> volumes;
        vertices.reserve(vertex_count);
        corners.reserve(corner_count);
        uint32_t base = 0;
        for (MeshedVolumes& block : blocks) {
            const auto first_vertex = static_cast<uint32_t>(vertices.size());
            const auto first_corner = static_cast<uint32_t>(corners.size());
            for (size_t i = 0; i < block.volumes.size(); ++i) {
                Volume volume = block.volumes[i];
                const uint32_t own = first_vertex + volume.first_vertex;
                const uint32_t end = i + 1 < block.volumes.size()
                                         ? first_vertex + block.volumes[i + 1].first_vertex
                                         : first_vertex + static_cast<uint32_t>(block.vertices.size());
                // Volumes that count from one vertex are drawn at once.
                if (end - base > most_vertices)
                    base = own;
                volume.first_vertex = base;
                for (uint32_t k = 0; k < volume.corner_count; ++k)
                    corners.push_back(
                        static_cast<uint16_t>(block.corners[volume.first_corner + k] + 2 * (own - base)));
                volume.first_corner += first_corner;
                volumes.push_back(volume);
            }
            vertices.insert(vertices.end(), block.vertices.begin(), block.vertices.end());
            block = {};
        }
        std::vector<uint32_t> first_volume_of(prepared_.decals.size() + 1, 0);
        for (const Volume& volume : volumes)
            ++first_volume_of[volume.decal + 1];
        std::partial_sum(first_volume_of.begin(), first_volume_of.end(), first_volume_of.begin());
        charge = {};
        keep(std::move(vertices), prepared_.vertices);
        keep(std::move(corners), prepared_.corners);
        keep(std::move(volumes), prepared_.volumes);
        keep(std::move(first_volume_of), prepared_.first_volume_of);
    }

    template <typename Values, typename T>
    void keep(Values values, SharedArray<T>& into) const {
        into = charged(SharedArray<T>(std::move(values)), input_.memory, prepared_name);
    }

    const TechniqueInput& input_;
    PreparedVolumes& prepared_;
    double arc_step_;  // radians
    HeightRanges heights_;
    OverlapCells cells_;
};

}  // namespace

std::unique_ptr<const PreparedVolumes> build_volumes(const TechniqueInput& input, Progress& progress) {
    for (const Layer& layer : input.layers)
        require_plain_styles(layer, "volume");
    auto prepared = std::make_unique<PreparedVolumes>();
    prepared->lattice = Lattice::over(input.bounds);
    prepared->grouping = options_of(input.layers[0]).grouping;
    prepared->first_layer = input.first_layer;
    prepared->segments = segments_of(input.layers);
    std::vector<OutlineOrder> outlines;
    for (const Layer& layer : input.layers) {
        prepared->features += layer.features.feature_count();
        outlines.push_back(layer.outline_order);
    }
    std::vector<Decal> decals = decals_of(input.layers, input.first_layer, Hidden::kept);
    std::vector<PlainLook> looks;
    for (const Decal& decal : decals)
        looks.push_back(look_of({&input.layers[decal.feature.layer - input.first_layer], decal}));
    std::vector<uint32_t> upwards(decals.size());
    std::iota(upwards.begin(), upwards.end(), 0U);
    const auto keep = [&](auto values) {
        using Value = typename decltype(values)::value_type;
        return charged(SharedArray<Value>(std::move(values)), input.memory, prepared_name);
    };
    prepared->outlines = keep(std::move(outlines));
    prepared->decals = keep(std::move(decals));
    prepared->looks = keep(std::move(looks));
    prepared->upwards = keep(std::move(upwards));
    VolumeBuilder(input, *prepared).build(progress);
    group_by_color(*prepared, input.memory, progress);
    progress.report(1.0);
    return prepared;
}

PreparedCounts PreparedVolumes::counts() const {
    const uint64_t bytes = decals.size_bytes() + first_volume_of.size_bytes() + volumes.size_bytes() +
                           vertices.size_bytes() + corners.size_bytes() + looks.size_bytes() +
                           upwards.size_bytes() + groups.size_bytes() + batches.size_bytes() +
                           drawn.size_bytes();
    return {features, segments, corners.size() / 3, bytes, lattice.quantum};
}

std::vector<FeatureReference> PreparedVolumes::query(const SeenPoint& seen) const {
    std::vector<FeatureReference> found;
    const Vector2 place = lattice.place(seen.x, seen.y);
    if (!on_lattice(place))
        return found;
    const LatticePoint p = rounded(place);
    const auto covers = [&](const Volume& volume) {
        for (uint32_t i = volume.first_corner; i < volume.first_corner + volume.lid_corners; i += 3) {
            const LatticePoint a = point(volume, i), b = point(volume, i + 1), c = point(volume, i + 2);
            if (doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0)
                return true;
        }
        return false;
    };
    for (size_t rank = upwards.size(); rank-- > 0;) {
        const uint32_t decal = upwards[rank];
        for (uint32_t i = first_volume_of[decal]; shows(decal) && i < first_volume_of[decal + 1]; ++i) {
            if (!volumes[i].box.holds(p) || !covers(volumes[i]))
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
