// A part of an index: some buckets, built from the features that lie in them.
#pragma once

#include <vector>

#include "technique/static_decals/cell_list_builder.h"
#include "technique/static_decals/prepared_decals.h"

namespace decalgl {

// Buckets in order, with slots of their own: those of `input` alone.
struct LocalBuild {
    PreparedDecals decals;  // slots and styles; no lists
    CellChunk chunk;        // an entry for each bucket
};

// The buckets that any of the features goes into, in order.
std::vector<uint32_t> touched_buckets(const TechniqueInput& input, const BucketGrid& grid);

LocalBuild build_buckets(const TechniqueInput& input, const BucketGrid& grid, Span<const uint32_t> buckets);

}  // namespace decalgl
