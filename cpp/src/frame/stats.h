// What a picture cost, gathered from its parts.
#pragma once

#include "decalgl/frame/frame.h"
#include "frame/pipeline.h"

namespace decalgl {

FrameStats collect_stats(Pipeline& pipeline, const PreparedScene& scene, const MemoryAccount& memory);

}  // namespace decalgl
