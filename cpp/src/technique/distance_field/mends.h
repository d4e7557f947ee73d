// What mends the two artefacts that Trapp et al. 2015 name in section 6.2.
//
//     intrusion    lines of one category, wider than the ground between them, run into each other: each node
//                  learns how wide its lines may be
//     protrusion   the cap of a line that ends at a narrower one of another category stands out behind it: the
//                  cap is cut at the narrower one's border
#pragma once

#include "technique/distance_field/categories.h"
#include "technique/distance_field/network.h"

namespace decalgl::network {

// Clearances are kept in so many steps of the widest half width.
constexpr uint32_t clearance_steps = (1U << 24U) - 1U;

void cut_caps(Network& network, const CategoryTable& table);
void keep_apart(Network& network, const CategoryTable& table);
// Without either.
void forget_mends(Network& network);

}  // namespace decalgl::network
