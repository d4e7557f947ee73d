#pragma once

// The only way this library uses more than one core.
//
// Work is cut into blocks of `grain` items: block k is [k * grain, min((k + 1) * grain, count)). The cut
// depends on count and grain alone, never on the number of threads, so results that depend on the blocks
// (sums, per-block lists) are the same bytes on any machine. Threads live for one call: nothing outlives a
// fork, and a start costs far less than the work these loops do.

#include <cstddef>
#include <functional>

namespace decalgl {

/// Called with a block [begin, end); blocks run in any order and on any thread.
using RangeFn = std::function<void(std::size_t begin, std::size_t end)>;

/// Called on the calling thread between its blocks with the share of blocks begun, and with 1 once, when all
/// of them have ended; may throw to stop.
using ShareFn = std::function<void(double share)>;

/// The cores this process may run on (its affinity mask), or DECALGL_THREADS where that is set; at least 1.
unsigned hardware_threads();

/// Runs `body` over [0, count) in blocks of `grain` items on up to `threads` threads (0: hardware_threads()).
/// The calling thread takes part. One thread, or one block, runs serially. The first exception of any block
/// (or of `report`) stops the blocks not yet begun and is thrown again here, once all threads have ended.
void parallel_for(std::size_t count, std::size_t grain, unsigned threads, const RangeFn& body,
                  const ShareFn& report = nullptr);

/// The number of blocks that parallel_for cuts `count` items into.
constexpr std::size_t block_count(std::size_t count, std::size_t grain) {
    const std::size_t step = grain == 0 ? 1 : grain;
    return count / step + (count % step != 0 ? 1 : 0);
}

}  // namespace decalgl
