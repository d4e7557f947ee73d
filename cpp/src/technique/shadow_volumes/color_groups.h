// Decals in groups of one colour, so that laying the groups over each other gives what laying the decals would.
//
//     exact     a decal goes over whatever it covers of other colours, or, where it is translucent, of any colour.
//               So groups are as many as the deepest stack of such decals, not as many as there are decals
//     colors    one group for each colour of a layer, in the order in which they first appear
//
// A group is cut into batches, of which no more than 255 volumes may touch any cell of a coarse grid: so many
// the stencil can count. Translucent groups leave a bit of it for what earlier batches have covered: 127.
#pragma once

#include "decalgl/core/progress.h"
#include "technique/shadow_volumes/prepared_volumes.h"

namespace decalgl::volume {

// As many triangles as one volume may have over any place: what a batch of a translucent group counts.
constexpr uint32_t most_over_each_other = 127;

// From looks and order to groups, batches and the volumes that are drawn. Throws Error(memory), Error(cancelled).
void group_by_color(PreparedVolumes& prepared, const MemoryAccount& memory, Progress& progress);

}  // namespace decalgl::volume
