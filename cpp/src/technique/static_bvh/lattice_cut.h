// What is left on the lattice of a segment that leaves it. Segments are always cut from the lower end, or the
// left one of a level segment, so that neighbours get the same cuts.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "technique/static_bvh/lattice.h"

namespace decalgl::bvh {

constexpr double low_end = -lattice_margin;
constexpr double high_end = double{lattice_extent} + lattice_margin;

// In quanta, not rounded yet.
struct Place {
    double x;
    double y;
};

inline bool on_lattice(Place p) {
    return p.x >= low_end && p.x <= high_end && p.y >= low_end && p.y <= high_end;
}

inline LatticePoint rounded(Place p) {
    return {static_cast<int32_t>(std::lrint(std::clamp(p.x, low_end, high_end))),
            static_cast<int32_t>(std::lrint(std::clamp(p.y, low_end, high_end)))};
}

inline Place between(Place a, Place b, double t) {
    return t <= 0.0 ? a : t >= 1.0 ? b : Place{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

// Part of the way along a segment; empty where it ends before it begins.
struct Share {
    double first = 0.0;
    double last = 1.0;

    bool empty() const { return first > last; }
};

// Narrows a part of a way from `start` by `step` to where it is from low_end to high_end.
inline Share narrowed(Share share, double start, double step) {
    if (step == 0.0)
        return start < low_end || start > high_end ? Share{0.0, -1.0} : share;
    const double t0 = (low_end - start) / step;
    const double t1 = (high_end - start) / step;
    return {std::max(share.first, std::min(t0, t1)), std::min(share.last, std::max(t0, t1))};
}

// Whether a segment is to be looked at from b.
inline bool begins_at_b(Place a, Place b) {
    return b.y < a.y || (b.y == a.y && b.x < a.x);
}

// The part of a-b on the lattice.
inline Share share_on_lattice(Place a, Place b) {
    const bool turned = begins_at_b(a, b);
    if (turned)
        std::swap(a, b);
    const Share kept = narrowed(narrowed({}, a.y, b.y - a.y), a.x, b.x - a.x);
    return turned ? Share{1.0 - kept.last, 1.0 - kept.first} : kept;
}

// The place at one end of a part of a-b, the same from whichever end it is looked at.
inline LatticePoint cut_end(Place a, Place b, double t) {
    return begins_at_b(a, b) ? rounded(between(b, a, 1.0 - t)) : rounded(between(a, b, t));
}

}  // namespace decalgl::bvh
