#pragma once

// The scene of examples/demo.py, made without Python: Honolulu and the Koʻolau range.
//
//     land cover, by material      polygons that share their borders
//     isolines every 20 m          derived from the terrain, 3 m wide on the ground
//     isolines every 100 m         7 m wide
//     streams, roads, freeways     the narrow polygons once more, above the isolines

#include <filesystem>

#include "decalgl/core/progress.h"
#include "decalgl/core/timing.h"
#include "decalgl/frame/camera.h"
#include "decalgl/frame/scene.h"

namespace decalgl {

/// Reads dem.tif and landcover.topojson.gz of a folder such as examples/data/honolulu. Adds the time of each
/// step to `timings`. Throws Error where a file is missing, damaged or holds a material without a colour.
Scene build_honolulu(const std::filesystem::path& folder, const ProgressFn& progress, TimingLog& timings);

/// Above Honolulu, looking north-east over the city, the ridges of Tantalus and the crest behind.
Camera honolulu_camera();

}  // namespace decalgl
