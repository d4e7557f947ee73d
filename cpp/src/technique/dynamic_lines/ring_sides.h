// On which side of a ring its polygon lies, by the even-odd rule over all rings of a feature.
#pragma once

#include <vector>

#include "decalgl/vector/features.h"

namespace decalgl {

// Of each ring of a feature, whether what is inside the polygon lies to the left of it. Rings that cross themselves or each
// other have sides that change on the way: theirs are those at the ring's lowest vertex.
std::vector<bool> insides_to_the_left(const Features& features, size_t feature);

}  // namespace decalgl
