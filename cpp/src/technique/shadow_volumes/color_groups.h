// Decals in groups of one colour, so that laying the groups over each other gives what laying the decals would.
//
//     exact     a decal goes over whatever it covers of other colours, or, where it is translucent, of any colour.
//               So groups are as many as the deepest stack of such decals, not as many as there are decals
//     colors    one group for each colour of a layer, in the order in which they first appear
//
// A group is cut into batches, of which no more than 255 volumes may touch any cell of a coarse grid: so many
// the stencil can count. Translucent groups leave a bit of it for what earlier batches have covered: 127.
#pragma once

#include "decalgl/technique/volume_options.h"
#include "technique/shadow_volumes/overlap_cells.h"
#include "technique/shadow_volumes/prepared_volumes.h"

namespace decalgl::volume {

// As many as one volume, or one batch, may have over each other.
uint32_t most_over_each_other(const std::array<uint8_t, 4>& color);

// Sorts the volumes, makes groups and batches. Throws Error(cancelled).
void group_by_color(Span<const std::array<uint8_t, 4>> colors, Grouping grouping, const OverlapCells& cells,
                    PreparedVolumes& prepared, Progress& progress);

}  // namespace decalgl::volume
