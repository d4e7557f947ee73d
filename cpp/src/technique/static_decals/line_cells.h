// Lines into cells: every cell that the stroke of a segment touches gets that segment.
//
// After Zechmeister 2020, section 3.2.1: segments are widened before they are assigned. Here by the Minkowski
// sum of the segment and a square of half the width, a superset of the round stroke that is cheap to test.
#pragma once

#include "decalgl/core/span.h"
#include "technique/static_decals/cell_records.h"

namespace decalgl {

// How coarse coordinates must be so that the stroke's surroundings fit into 16 bits: quanta per unit =
// 2^scale.
int line_scale(double half_width_in_quanta);

// Marks the cells that the stroke of one segment covers whole. A feature's marks come before its pieces, so
// that the pieces in those cells can be left out.
void mark_covered_cells(Span<const double> coordinates, double half_width, CellRecords& records);

// Adds the pieces of one polyline. `coordinates`: x, y of its vertices; `half_width`: in quanta.
void add_line_pieces(Span<const double> coordinates, double half_width, CellRecords& records);

}  // namespace decalgl
