// One bucket's records, run after run, as the stream of its cells (cell_stream.h), in two passes over them.
#pragma once

#include <vector>

#include "technique/static_decals/cell_records.h"
#include "technique/static_decals/prepared_decals.h"

namespace decalgl {

// Writes how many texels each of the bucket's cells takes to `cell_texels`; returns their sum.
uint64_t count_bucket_texels(const std::vector<CellRecords>& runs, uint32_t bucket,
                             Span<const DecalStyle> styles, uint32_t* cell_texels);

// Turns the counts into starts, the bucket's first being `start`, and writes the texels.
void write_bucket_texels(const std::vector<CellRecords>& runs, uint32_t bucket, Span<const DecalStyle> styles,
                         uint32_t start, uint32_t* cell_starts, CellTexel* texels);

}  // namespace decalgl
