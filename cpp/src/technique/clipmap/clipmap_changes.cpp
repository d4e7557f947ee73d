// Other looks for prepared tiles: what they are drawn from stays, but for corners that go by the width.
#include <algorithm>

#include "decalgl/core/error.h"
#include "technique/clipmap/prepared_clipmap.h"
#include "technique/draw_order.h"

namespace decalgl::clipmap {
namespace {

[[noreturn]] void refuse(const char* what) {
    throw Error(ErrorKind::unsupported, std::string("technique 'clipmap' ") + what +
                                            "; draw the layer with technique 'static' instead");
}

}  // namespace

bool ClipmapGeometry::draws_lines() const {
    return options.solution == LineSolution::primitives || options.solution == LineSolution::both ||
           options.solution == LineSolution::geometry;
}

bool ClipmapGeometry::has_mesh() const {
    return options.solution == LineSolution::polygons || options.solution == LineSolution::both ||
           options.solution == LineSolution::wireframe;
}

bool ClipmapGeometry::has_offsets() const {
    return options.solution == LineSolution::offsets || options.solution == LineSolution::polar_offsets;
}

uint64_t ClipmapGeometry::bytes() const {
    return fills.size() * sizeof(PlacedVertex) + lines.size() * sizeof(PlacedVertex) +
           chunks.size() * sizeof(Chunk) + paths.size() * sizeof(Path) + decals.size() * sizeof(Decal) +
           first_chunk_of.size() * sizeof(uint32_t);
}

PreparedCounts PreparedClipmap::counts() const {
    const ClipmapGeometry& g = *geometry;
    const Tessellation& t = tessellation;
    return {g.features, g.segments, g.fills.size() + g.lines.size() + t.mesh.size() + t.offsets.size(),
            g.bytes() + t.pairs.size_bytes() + t.mesh.size_bytes() + t.offsets.size_bytes() +
                looks.size() * sizeof(PlainLook),
            g.texture.texel(finest_level)};
}

void PreparedClipmap::order_chunks() {
    drawn.clear();
    for (const uint32_t decal : upwards) {
        if (!looks[decal].shows(geometry->decals[decal].is_stroke()))
            continue;
        for (uint32_t i = geometry->first_chunk_of[decal]; i < geometry->first_chunk_of[decal + 1]; ++i)
            drawn.push_back(i);
    }
}

LayerLook PreparedClipmap::look_of(uint32_t layer, size_t features) const {
    return layer_look(geometry->decals, looks, layer, features);
}

std::shared_ptr<const Prepared> PreparedClipmap::restyled(Span<const LayerLook> changes,
                                                          const MemoryAccount& memory) const {
    auto result = std::make_shared<PreparedClipmap>(*this);
    result->looks = changed_looks(geometry->decals, looks, changes);
    for (const LayerLook& change : changes)
        if (!change.draw_order.empty())
            result->upwards = reordered(geometry->decals, result->upwards, change.layer, change.draw_order,
                                        geometry->outlines[change.layer - geometry->first_layer]);
    result->order_chunks();
    if (geometry->is_tessellated_anew() && std::any_of(changes.begin(), changes.end(), has_widths))
        result->tessellation = tessellate(*geometry, result->looks, 1.0, memory);
    return result;
}

std::shared_ptr<const Prepared> PreparedClipmap::edited(const LayerEdit&, const MemoryAccount&) const {
    refuse("cannot edit what it prepared");
}

std::vector<FeatureReference> PreparedClipmap::query(const SeenPoint&) const {
    refuse("keeps colours alone, so nothing can be picked");
}

void PreparedClipmap::save(ArchiveWriter&, const std::string&) const {
    refuse("is not kept on disk");
}

}  // namespace decalgl::clipmap
