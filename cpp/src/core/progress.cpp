#include "decalgl/core/progress.h"

#include "decalgl/core/error.h"

#include <algorithm>
#include <utility>

namespace decalgl {

Progress::Progress(ProgressFn callback, std::string stage)
    : callback_(std::move(callback)), stage_(std::move(stage)) {}

void Progress::report(double fraction) {
    if (!callback_) {
        return;
    }
    last_ = std::max(last_, std::clamp(fraction, 0.0, 1.0));
    if (!callback_(stage_, last_)) {
        throw Error(ErrorKind::cancelled, "The work was cancelled during \"" + stage_ + "\".");
    }
}

Progress Progress::stage(std::string name) const {
    return {callback_, std::move(name)};
}

}  // namespace decalgl
