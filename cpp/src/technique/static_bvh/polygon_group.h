// Polygons as quad-trees in cells (Zechmeister 2020, section 4.2.1).
//
// A feature's first ring is its exterior, all its others interiors: a point that an odd number of them hold
// is inside, which is even-odd whatever rings there are. The box of an exterior in a cell takes in its
// interiors there, so rings need not lie within the first one, and members of a multi-polygon are interiors
// too.
//
//     cell ──▶ tree over exteriors ──▶ exterior: subtree of ring 0, interiors: subtrees of rings 3, 4 and 9
//
// Of each tree a cell refers to the smallest subtree that holds the tree's part of the cell (the culling
// offset), and to none where all leaves there are outside.
#pragma once

#include "technique/static_bvh/cell_objects.h"
#include "technique/static_bvh/lattice_parts.h"

namespace decalgl::bvh {

// Fills a group whose styles are set already.
void build_polygons(const TechniqueInput& input, LatticeParts parts, const Lattice& lattice,
                    DecalGroup& group, MemoryCharge& charge, const Stage& stage);

}  // namespace decalgl::bvh
