#include "technique/static_bvh/stroke_outline.h"

#include <cmath>

namespace decalgl::bvh {
namespace {

constexpr double degrees = M_PI / 180.0;
// Farther than anything on the lattice, and near enough to be rounded.
constexpr double farthest = 1e12;
// Of the cosine: so near the miter limit, a corner may be round or not.
constexpr double unsure = 1e-4;

struct Direction {
    double x;
    double y;
};

bool has_length(LatticePoint from, LatticePoint to) {
    return !(from == to);
}

Direction direction(LatticePoint from, LatticePoint to) {
    const double dx = double(to.x) - from.x, dy = double(to.y) - from.y;
    const double length = std::hypot(dx, dy);
    return length > 0.0 ? Direction{dx / length, dy / length} : Direction{1.0, 0.0};
}

// How far an outline goes on beyond its end, in half widths: along its left and its right side, looking
// outwards, and from the end's vertex in any direction; and whether there is a disc, which may reach back beyond
// the other end.
struct Extension {
    double left;
    double right;
    double radius;
    bool disc = false;
};

constexpr Extension round_extension{1.0, 1.0, 1.0, true};

Extension beyond_cap(Cap cap) {
    if (cap == Cap::round)
        return round_extension;
    return cap == Cap::butt ? Extension{0.0, 0.0, 1.0} : Extension{1.0, 1.0, std::sqrt(2.0)};
}

// On the outer side of the turn; within the segment's own half of the corner.
double beyond_bevel(double cosine, double sine) {
    return 2.0 * sine / (3.0 + cosine);
}

Extension beyond_corner(const StrokeStyle& style, Direction own, Direction next) {
    if (style.corner == Corner::round)
        return round_extension;
    const double cosine = own.x * next.x + own.y * next.y, cross = own.x * next.y - own.y * next.x;
    const double limit = -std::cos(style.miter_limit * degrees);
    Extension extension{0.0, 0.0, 1.0};
    double outer = beyond_bevel(cosine, std::abs(cross));
    if (style.corner == Corner::miter && cosine < limit + unsure)
        extension = round_extension;
    if (style.corner == Corner::miter && cosine > limit - unsure) {
        const double half = std::sqrt(std::max(0.5 * (1.0 + cosine), 0.0));  // the cosine of half the turn
        outer = std::min(std::sqrt(std::max(0.5 * (1.0 - cosine), 0.0)) / std::max(half, 1e-12), farthest);
        extension.radius = std::min(1.0 / std::max(half, 1e-12), farthest);
    }
    (cross > 0.0 ? extension.right : extension.left) =
        std::max(outer, cross > 0.0 ? extension.right : extension.left);
    // An exact reversal has no outer side.
    if (cosine < -1.0 + unsure)
        extension.left = extension.right = std::max(extension.left, extension.right);
    return extension;
}

// Lengths in the tangent plane are never less than those on the map, but turns are others.
Extension beyond_tangent(const StrokeStyle& style) {
    const double sharpest = std::sin(0.5 * style.miter_limit * degrees);
    const double reach =
        style.corner == Corner::miter ? std::min(1.0 / std::max(sharpest, 1e-12), farthest) : std::sqrt(2.0);
    return {reach, reach, std::max(reach, std::sqrt(2.0))};
}

Extension beyond(const SegmentEnd& end, LatticePoint other, const StrokeStyle& style) {
    if (style.slope_correction == SlopeCorrection::tangent)
        return beyond_tangent(style);
    if (end.plain)
        return {0.0, 0.0, 1.0};
    if (!has_length(end.vertex, end.next))
        return beyond_cap(style.cap);
    return beyond_corner(style, direction(other, end.vertex), direction(end.vertex, end.next));
}

void take_in(double reach, Extension& extension) {
    extension.left = std::max(extension.left, reach);
    extension.right = std::max(extension.right, reach);
}

LatticeBox box_of(const Quadrilateral& outline) {
    double low[2] = {farthest, farthest}, high[2] = {-farthest, -farthest};
    for (size_t i = 0; i < 4; ++i) {
        low[0] = std::min(low[0], outline.x[i]);
        low[1] = std::min(low[1], outline.y[i]);
        high[0] = std::max(high[0], outline.x[i]);
        high[1] = std::max(high[1], outline.y[i]);
    }
    const auto limited = [](double value) {
        return static_cast<int32_t>(std::clamp<double>(value, INT32_MIN, INT32_MAX));
    };
    return {limited(std::floor(low[0] - rounding)), limited(std::floor(low[1] - rounding)),
            limited(std::ceil(high[0] + rounding)), limited(std::ceil(high[1] + rounding))};
}

LatticeBox round_box(LatticePoint a, LatticePoint b, double reach) {
    const auto far = static_cast<int64_t>(std::ceil(std::min(reach, farthest) + rounding));
    const auto low = [&](int64_t p, int64_t q) {
        return static_cast<int32_t>(std::max<int64_t>(std::min(p, q) - far, INT32_MIN));
    };
    const auto high = [&](int64_t p, int64_t q) {
        return static_cast<int32_t>(std::min<int64_t>(std::max(p, q) + far, INT32_MAX));
    };
    return {low(a.x, b.x), low(a.y, b.y), high(a.x, b.x), high(a.y, b.y)};
}

Quadrilateral extended(LatticePoint a, LatticePoint b, const Extension& at_a, const Extension& at_b,
                       double half_width) {
    const Direction d = direction(a, b);
    const double ux = half_width * d.x, uy = half_width * d.y;
    // Seen along a-b; what is left looking outwards at a is right here.
    return {{a.x - at_a.right * ux - uy, a.x - at_a.left * ux + uy, b.x + at_b.right * ux + uy,
             b.x + at_b.left * ux - uy},
            {a.y - at_a.right * uy + ux, a.y - at_a.left * uy - ux, b.y + at_b.right * uy - ux,
             b.y + at_b.left * uy + ux}};
}

}  // namespace

StrokeOutline round_outline(LatticePoint a, LatticePoint b, double half_width) {
    return {extended(a, b, round_extension, round_extension, half_width), round_box(a, b, half_width)};
}

StrokeOutline styled_outline(const SegmentEnd& a, const SegmentEnd& b, const StrokeStyle& style,
                             double half_width) {
    // A dot is a disc or a square.
    const bool is_dot = !has_length(a.vertex, b.vertex);
    Extension at_a = is_dot ? Extension{1.0, 1.0, std::sqrt(2.0)} : beyond(a, b.vertex, style);
    Extension at_b = is_dot ? at_a : beyond(b, a.vertex, style);
    const double length = std::hypot(double(b.vertex.x) - a.vertex.x, double(b.vertex.y) - a.vertex.y);
    const double back = 1.0 - length / std::max(half_width, 1e-12);
    take_in(at_b.disc ? back : 0.0, at_a);
    take_in(at_a.disc ? back : 0.0, at_b);
    const Quadrilateral corners = extended(a.vertex, b.vertex, at_a, at_b, half_width);
    const double reach = std::max(at_a.radius, at_b.radius) * half_width;
    return {corners, common(box_of(corners), round_box(a.vertex, b.vertex, reach))};
}

}  // namespace decalgl::bvh
