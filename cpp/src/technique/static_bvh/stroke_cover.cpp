#include "technique/static_bvh/stroke_cover.h"

#include "vector/stroke_reach.h"

namespace decalgl::bvh {
namespace {

// Less than points are rounded by.
constexpr double slack = 0.25;

Vector2 way(LatticePoint from, LatticePoint to) {
    return {double(to.x) - from.x, double(to.y) - from.y};
}

Vector2 direction(LatticePoint from, LatticePoint to) {
    const Vector2 v = way(from, to);
    const double size = length(v);
    return size > 0.0 ? Vector2{v.x / size, v.y / size} : Vector2{};
}

bool round_covers(LatticePoint point, LatticePoint a, LatticePoint b, double half_width) {
    const Vector2 along = way(a, b), from = way(a, point);
    const double length2 = dot(along, along);
    const double t = length2 > 0.0 ? std::clamp(dot(from, along) / length2, 0.0, 1.0) : 0.0;
    return length({from.x - t * along.x, from.y - t * along.y}) <= half_width;
}

double pattern_width(const StrokeLook& look, double along) {
    double width = look.mark_count > 0 ? -1.0 : 1.0;
    for (uint32_t i = 0; i < look.mark_count; ++i) {
        const LookTexel& mark = look.marks[i];
        const PatternMark read{as_float(mark[0]), as_float(mark[1]), as_float(mark[2]), as_float(mark[3])};
        width = std::max(width, mark_width(read, pattern_phase(along, look.period)));
    }
    return width;
}

// A segment in the way of its line, and the vertices before and after it.
struct Run {
    uint32_t start;
    uint32_t end;
    bool plain_start;
    bool plain_end;
};

Run run_of(Segment segment) {
    const uint32_t a = segment.first(), b = segment.second();
    const bool plain_a = segment.a != a, plain_b = segment.b != b;
    return a < b ? Run{a, b, plain_a, plain_b} : Run{b, a, plain_b, plain_a};
}

double start_reach(const LargeArray<LatticePoint>& at, const Run& run, const StrokeLook& look, Vector2 from) {
    const Vector2 own = direction(at[run.start], at[run.end]);
    const LatticePoint before = at[run.start - 1];
    if (run.plain_start)
        return out_of_reach;
    return before == at[run.start]
               ? cap_reach(look.cap, from, {-own.x, -own.y})
               : corner_reach(look.corner, from, direction(before, at[run.start]), own, look.limit);
}

double end_reach(const LargeArray<LatticePoint>& at, const Run& run, const StrokeLook& look, Vector2 from) {
    const Vector2 own = direction(at[run.start], at[run.end]);
    const LatticePoint after = at[run.end + 1];
    if (run.plain_end)
        return out_of_reach;
    return after == at[run.end]
               ? cap_reach(look.cap, from, own)
               : corner_reach(look.corner, from, own, direction(at[run.end], after), look.limit);
}

bool styled_covers(const DecalGroup& group, Segment segment, const Style& style, LatticePoint point) {
    const StrokeLook look = stroke_look(group, style.look);
    const LargeArray<LatticePoint>& at = group.vertices;
    const Run run = run_of(segment);
    const Vector2 from_start = way(at[run.start], point), from_end = way(at[run.end], point);
    const auto within = [&](double reach, double along) {
        return reach <= double{style.half_width} * pattern_width(look, along);
    };
    const double begin = group.phase(run.start);
    if (at[run.start] == at[run.end])
        return within(dot_reach(look.cap, from_start), begin);
    const Vector2 own = direction(at[run.start], at[run.end]);
    return within(bar_reach(from_start, from_end, own, slack), begin + dot(from_start, own)) ||
           within(start_reach(at, run, look, from_start), begin) ||
           within(end_reach(at, run, look, from_end), group.phase(run.end));
}

}  // namespace

bool stroke_covers(const DecalGroup& group, uint32_t index, LatticePoint point) {
    const Segment segment = group.segments[index];
    const Style& style = group.styles[group.owner(segment.first())];
    if (!(style.half_width > 0.0F))
        return false;
    return group.needs.corners
               ? styled_covers(group, segment, style, point)
               : round_covers(point, group.vertices[segment.a], group.vertices[segment.b], style.half_width);
}

}  // namespace decalgl::bvh
