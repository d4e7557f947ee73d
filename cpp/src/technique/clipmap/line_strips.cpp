#include "technique/clipmap/line_strips.h"

#include <cmath>

namespace decalgl::clipmap {
namespace {

constexpr double pi = 3.14159265358979323846;
// Of the sine of the turn: what bends less has no meeting point worth the digits.
constexpr double collinear = 1e-6;

Vector2 direction(Vector2 from, Vector2 to) {
    const Vector2 along{to.x - from.x, to.y - from.y};
    return {along.x / length(along), along.y / length(along)};
}

Vector2 to_the_left(Vector2 d) {
    return {-d.y, d.x};
}

Vector2 scaled(double s, Vector2 a) {
    return {s * a.x, s * a.y};
}

// A joint between segments of these directions and lengths, in half widths.
struct Joint {
    uint32_t vertex;
    Vector2 coming;
    Vector2 going;
    double shorter;

    void add(JointRule rule, std::vector<CornerPair>& pairs) const {
        const double turn = cross(coming, going), cosine = dot(coming, going);
        const Vector2 before = to_the_left(coming), after = to_the_left(going);
        if (std::abs(turn) < collinear && cosine > 0.0) {
            pairs.push_back({vertex, after, scaled(-1.0, after)});
            return;
        }
        if (rule.joints == JointMethod::none) {
            pairs.push_back({vertex, before, scaled(-1.0, before)});
            pairs.push_back({vertex, scaled(-1.0, before), after});
            pairs.push_back({vertex, after, scaled(-1.0, after)});
            return;
        }
        // The angle between the segments, seen from the vertex: 180 degrees where they go straight on.
        const bool bevel = cosine < 0.0 - std::cos(rule.bevel_below * pi / 180.0);
        const Vector2 meeting = scaled(1.0 / (1.0 + cosine), {before.x + after.x, before.y + after.y});
        const bool is_left = turn > 0.0;
        const double reach = std::abs(turn) / std::max(1.0 + cosine, 1e-12);
        const bool meets = rule.joints == JointMethod::inner_meets && reach <= shorter;
        if (bevel) {
            for (const Vector2& own : {before, after}) {
                const Vector2& inner = meets ? meeting : own;
                pairs.push_back({vertex, is_left ? inner : own, scaled(-1.0, is_left ? own : inner)});
            }
            return;
        }
        if (meets || rule.joints == JointMethod::own_corners) {
            pairs.push_back({vertex, meeting, scaled(-1.0, meeting)});
            return;
        }
        const Vector2 middle{0.0, 0.0};
        pairs.push_back({vertex, before, scaled(-1.0, before)});
        if (is_left) {
            pairs.push_back({vertex, middle, scaled(-1.0, meeting)});
            pairs.push_back({vertex, scaled(-1.0, after), scaled(-1.0, after)});
        } else {
            pairs.push_back({vertex, before, middle});
            pairs.push_back({vertex, meeting, after});
        }
        pairs.push_back({vertex, after, scaled(-1.0, after)});
    }
};

}  // namespace

std::vector<CornerPair> corner_pairs(Span<const Vector2> line, bool closed, double half_width,
                                     JointRule rule) {
    std::vector<CornerPair> pairs;
    const size_t last = line.size() - 1;
    const auto joint_at = [&](size_t before, size_t at, size_t after) {
        const auto span = [&](size_t a, size_t b) {
            return std::hypot(line[b].x - line[a].x, line[b].y - line[a].y) / half_width;
        };
        return Joint{static_cast<uint32_t>(at), direction(line[before], line[at]),
                     direction(line[at], line[after]), std::min(span(before, at), span(at, after))};
    };
    const auto add_end = [&](size_t at, Vector2 along) {
        const Vector2 across = to_the_left(along);
        pairs.push_back({static_cast<uint32_t>(at), across, scaled(-1.0, across)});
    };
    std::vector<CornerPair> seam;  // of a ring: the joint that it begins and ends with
    if (closed) {
        joint_at(last - 1, 0, 1).add(rule, seam);
        pairs.push_back(seam.back());
    } else {
        add_end(0, direction(line[0], line[1]));
    }
    for (size_t i = 1; i < last; ++i)
        joint_at(i - 1, i, i + 1).add(rule, pairs);
    if (!closed) {
        add_end(last, direction(line[last - 1], line[last]));
        return pairs;
    }
    for (CornerPair pair : seam) {
        pair.vertex = static_cast<uint32_t>(last);
        pairs.push_back(pair);
    }
    return pairs;
}

}  // namespace decalgl::clipmap
