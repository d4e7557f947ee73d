// A data group: a run of decals with a grid of its own (Zechmeister 2020, section 4.2.1).
//
//     decals ──▶ slots, looks ─┬▶ strokes: chains ──▶ segments ─┐
//                              └▶ fills: quad-trees ────────────┴▶ one grid ──▶ objects in cells ──▶ trees
#pragma once

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

// Adds the run's group and slots to the index. Throws Error(unsupported), Error(memory), Error(cancelled).
void add_group(const TechniqueInput& input, const DecalRun& run, PreparedBvh& bvh, const Stage& stage);

}  // namespace decalgl::bvh
