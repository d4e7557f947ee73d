// Clipping of a line segment.
#pragma once

#include <algorithm>

namespace decalgl {

// The part of a segment inside a box, as parameters along it; empty when first > last.
struct SegmentInterval {
    double first = 0.0;
    double last = 1.0;

    void clip(double start, double step, double low, double high) {
        if (step == 0.0) {
            if (start < low || start > high)
                last = -1.0;
            return;
        }
        const double t0 = (low - start) / step;
        const double t1 = (high - start) / step;
        first = std::max(first, std::min(t0, t1));
        last = std::min(last, std::max(t0, t1));
    }
};

}  // namespace decalgl
