#include "decalgl/core/timing.h"

namespace decalgl {

double TimingLog::total() const {
    double sum = 0.0;
    for (const TimedPass& pass : passes_) {
        sum += pass.ms;
    }
    return sum;
}

double TimingLog::total(const std::string& name) const {
    double sum = 0.0;
    for (const TimedPass& pass : passes_) {
        sum += pass.name == name ? pass.ms : 0.0;
    }
    return sum;
}

}  // namespace decalgl
