#include "frame/stats.h"

#include <algorithm>

namespace decalgl {

FrameStats collect_stats(Pipeline& pipeline, const PreparedScene& scene, const MemoryAccount& memory) {
    FrameStats stats;
    stats.passes = pipeline.timings().passes();
    stats.preprocess = scene.timings.passes();
    stats.preprocess_ms = scene.milliseconds;
    stats.readback_ms = pipeline.timings().total("readback");
    stats.bytes = memory.entries();
    stats.variants = pipeline.variants();
    PreparedCounts sum;
    for (const PreparedPass& pass : scene.passes) {
        const PreparedCounts counts = pass.prepared->counts();
        sum.features += counts.features;
        sum.segments += counts.segments;
        sum.pieces += counts.pieces;
        sum.bytes += counts.bytes;
        sum.quantum = std::max(sum.quantum, counts.quantum);
    }
    stats.counts = {{"triangles", static_cast<double>(pipeline.triangles())},
                    {"silhouette_pixels", static_cast<double>(pipeline.silhouette_pixels())},
                    {"uploads", static_cast<double>(pipeline.uploads().count)},
                    {"uploaded_bytes", static_cast<double>(pipeline.uploads().bytes)},
                    {"features", static_cast<double>(sum.features)},
                    {"segments", static_cast<double>(sum.segments)},
                    {"pieces", static_cast<double>(sum.pieces)},
                    {"prepared_bytes", static_cast<double>(sum.bytes)},
                    {"quantum_m", sum.quantum},
                    {"quantum_px", pipeline.quantum_pixels()}};
    stats.counts.insert(stats.counts.end(), pipeline.counts().begin(), pipeline.counts().end());
    return stats;
}

}  // namespace decalgl
