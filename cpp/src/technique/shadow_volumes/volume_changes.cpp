// Other looks for prepared volumes, and their place in a file.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/archive.h"
#include "core/growing_array.h"
#include "decalgl/core/error.h"
#include "technique/draw_order.h"
#include "technique/shadow_volumes/color_groups.h"

namespace decalgl::volume {
namespace {

// Without padding, since its bytes go into the file.
struct VolumeFileRecord {
    Lattice lattice;
    HeightSteps height_steps;
    uint64_t features;
    uint64_t segments;
    uint32_t first_layer;
    uint32_t grouping;
};
static_assert(sizeof(VolumeFileRecord) == 56, "saved as it is");

// Volumes follow each other by decal, and their corners lead to vertices.
bool meshes_fit_together(const PreparedVolumes& volumes) {
    uint64_t next_corner = 0;
    for (const Volume& volume : volumes.volumes) {
        if (volume.first_corner != next_corner || volume.corner_count % 3 != 0 ||
            volume.lid_corners % 3 != 0 || volume.lid_corners > volume.corner_count ||
            volume.decal >= volumes.decals.size())
            return false;
        next_corner += volume.corner_count;
        if (next_corner > volumes.corners.size())
            return false;
        for (uint32_t i = volume.first_corner; i < next_corner; ++i)
            if (uint64_t{volume.first_vertex} + volumes.corners[i] / 2U >= volumes.vertices.size())
                return false;
    }
    if (volumes.first_volume_of.size() != volumes.decals.size() + 1 || volumes.first_volume_of[0] != 0 ||
        volumes.first_volume_of[volumes.decals.size()] != volumes.volumes.size())
        return false;
    for (size_t i = 0; i < volumes.decals.size(); ++i) {
        const uint32_t first = volumes.first_volume_of[i], end = volumes.first_volume_of[i + 1];
        if (first > end || end > volumes.volumes.size())
            return false;
        for (uint32_t k = first; k < end; ++k)
            if (volumes.volumes[k].decal != i)
                return false;
    }
    return next_corner == volumes.corners.size();
}

bool order_fits_together(const PreparedVolumes& volumes) {
    uint64_t next = 0;
    for (const Batch& batch : volumes.batches) {
        if (batch.first_drawn != next || batch.group >= volumes.groups.size())
            return false;
        next += batch.volume_count;
    }
    const bool are_volumes = std::all_of(volumes.drawn.begin(), volumes.drawn.end(),
                                         [&](uint32_t i) { return i < volumes.volumes.size(); });
    return next == volumes.drawn.size() && are_volumes && volumes.looks.size() == volumes.decals.size() &&
           permutes(volumes.upwards, volumes.decals.size());
}

bool is_known(const VolumeFileRecord& record) {
    int exponent = 0;
    return std::isfinite(record.lattice.left) && std::isfinite(record.lattice.bottom) &&
           std::isfinite(record.lattice.quantum) && std::frexp(record.lattice.quantum, &exponent) == 0.5 &&
           record.grouping <= static_cast<uint32_t>(Grouping::colors);
}

}  // namespace

LayerLook PreparedVolumes::look_of(uint32_t layer, size_t count) const {
    return layer_look(decals, looks, layer, count);
}

std::shared_ptr<const Prepared> PreparedVolumes::restyled(Span<const LayerLook> changes,
                                                          const MemoryAccount& memory) const {
    for (const LayerLook& change : changes)
        if (has_widths(change))
            throw Error(ErrorKind::style,
                        "technique 'volume' has widths in its meshes; prepare the scene anew for other ones");
    auto result = std::make_shared<PreparedVolumes>(*this);
    result->looks =
        charged(SharedArray<PlainLook>(changed_looks(decals, looks, changes)), memory, prepared_name);
    for (const LayerLook& change : changes)
        if (!change.draw_order.empty())
            result->upwards = charged(
                SharedArray<uint32_t>(reordered(decals, result->upwards, change.layer, change.draw_order,
                                                outlines[change.layer - first_layer])),
                memory, prepared_name);
    Progress progress;
    group_by_color(*result, memory, progress);
    return result;
}

std::shared_ptr<const Prepared> PreparedVolumes::edited(const LayerEdit&, const MemoryAccount&) const {
    throw Error(ErrorKind::unsupported,
                "technique 'volume' cannot edit its meshes; prepare the scene anew, or draw the layer with "
                "technique 'static'");
}

void PreparedVolumes::save(ArchiveWriter& archive, const std::string& prefix) const {
    archive.add_value(prefix + "record", VolumeFileRecord{lattice, height_steps, features, segments,
                                                          first_layer, static_cast<uint32_t>(grouping)});
    archive.add(prefix + "outlines", outlines.span());
    archive.add(prefix + "decals", decals.span());
    archive.add(prefix + "first_volume_of", first_volume_of.span());
    archive.add(prefix + "volumes", volumes.span());
    archive.add(prefix + "vertices", vertices.span());
    archive.add(prefix + "corners", corners.span());
    archive.add(prefix + "looks", looks.span());
    archive.add(prefix + "upwards", upwards.span());
    archive.add(prefix + "groups", groups.span());
    archive.add(prefix + "batches", batches.span());
    archive.add(prefix + "drawn", drawn.span());
}

std::unique_ptr<const PreparedVolumes> open_volumes(const ArchiveReader& archive, const std::string& prefix) {
    auto volumes = std::make_unique<PreparedVolumes>();
    const auto record = archive.value<VolumeFileRecord>(prefix + "record");
    volumes->lattice = record.lattice;
    volumes->height_steps = record.height_steps;
    volumes->features = record.features;
    volumes->segments = record.segments;
    volumes->first_layer = record.first_layer;
    volumes->grouping = static_cast<Grouping>(record.grouping);
    volumes->outlines = archive.array<OutlineOrder>(prefix + "outlines");
    volumes->decals = archive.array<Decal>(prefix + "decals");
    volumes->first_volume_of = archive.array<uint32_t>(prefix + "first_volume_of");
    volumes->volumes = archive.array<Volume>(prefix + "volumes");
    volumes->vertices = archive.array<VolumeVertex>(prefix + "vertices");
    volumes->corners = archive.array<uint16_t>(prefix + "corners");
    volumes->looks = archive.array<PlainLook>(prefix + "looks");
    volumes->upwards = archive.array<uint32_t>(prefix + "upwards");
    volumes->groups = archive.array<Color>(prefix + "groups");
    volumes->batches = archive.array<Batch>(prefix + "batches");
    volumes->drawn = archive.array<uint32_t>(prefix + "drawn");
    const bool has_layers =
        std::all_of(volumes->decals.begin(), volumes->decals.end(), [&](const Decal& decal) {
            return decal.feature.layer >= record.first_layer &&
                   decal.feature.layer - record.first_layer < volumes->outlines.size() &&
                   decal.role <= DecalRole::casing;
        });
    if (!is_known(record) || !has_layers || !meshes_fit_together(*volumes) || !order_fits_together(*volumes))
        archive.refuse("the shadow volumes do not fit together");
    return volumes;
}

}  // namespace decalgl::volume
