#pragma once

// Times of GL passes.

#include "decalgl/core/timing.h"

#include <string>

namespace decalgl::gl {

/// Times a scope as one pass of the log, while the log is profiling; otherwise free of charge. It waits for
/// the driver before and after, so the pass is charged its own work and nothing else's: wall time of the
/// processor, which on a software rasteriser is the honest measure.
class PassTimer {
public:
    PassTimer(TimingLog* log, std::string name);
    ~PassTimer();
    PassTimer(const PassTimer&) = delete;
    PassTimer& operator=(const PassTimer&) = delete;

private:
    TimingLog* log_;
    std::string name_;
    Stopwatch watch_;
};

}  // namespace decalgl::gl
