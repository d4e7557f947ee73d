// A data group: a run of decals with a grid of its own (Zechmeister 2020, section 4.2.1).
//
//     decals ──▶ slots, looks ─┬▶ strokes: chains ──▶ segments ─┐
//                              └▶ fills: quad-trees ────────────┴▶ one grid ──▶ objects in cells ──▶ trees
#pragma once

#include <optional>
#include <string>

#include "technique/static_bvh/cell_objects.h"

namespace decalgl::bvh {

// Neighbouring decals, bottom to top, that one pass draws.
struct DecalRun {
    GroupKind kind;
    Span<const Decal> decals;
};

// The runs that decals are drawn in: those of one layer and role, or of any that are fills or strokes alike
// (PassGrouping). Fills and outlines of one layer go together where outlines lie between fills, or are cut at
// the polygons' borders and so need their quad-trees.
std::vector<DecalRun> cut_into_runs(const TechniqueInput& input, Span<const Decal> decals);

// What kind of group a decal is drawn in.
GroupKind kind_of(const Layer& layer, const Decal& decal);

// Throws Error(unsupported), Error(memory), Error(cancelled).
DecalGroup build_group(const TechniqueInput& input, const DecalRun& run, const Lattice& lattice,
                       const Stage& stage);

// A group with the grid of another one and what that one needs, which may then be made a part of it; nothing where it
// reaches beyond the grid or needs other arrays.
std::optional<DecalGroup> build_in_grid(const TechniqueInput& input, const DecalRun& run,
                                        const Lattice& lattice, const DecalGroup& like);

// Throws Error(unsupported): along a curve, segments come in no order in which translucent lines could be laid over each
// other.
void require_drawable(GroupKind kind, bool translucency, const BvhOptions& options, const std::string& layer);

// Of a decal that is `half_width` quanta wide; strokes without a width are hidden.
Style style_of(const std::array<uint8_t, 4>& color, float half_width, bool is_stroke, uint32_t look,
               uint32_t rank);

// Works out what the styles have in common.
void summarise(DecalGroup& group);

}  // namespace decalgl::bvh
