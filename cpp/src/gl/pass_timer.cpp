#include "gl/pass_timer.h"

#include "gl/gl.h"

#include <utility>

namespace decalgl::gl {

PassTimer::PassTimer(TimingLog* log, std::string name)
    : log_(log != nullptr && log->profiling() ? log : nullptr), name_(std::move(name)) {
    if (log_ != nullptr) {
        glFinish();
        watch_.restart();
    }
}

PassTimer::~PassTimer() {
    if (log_ == nullptr) {
        return;
    }
    glFinish();
    try {
        log_->add(std::move(name_), watch_.milliseconds());
    } catch (...) {
        // Without memory for it, the pass is missing from the log; the picture is whole.
    }
}

}  // namespace decalgl::gl
