#include "technique/static_bvh/stroke_cover.h"

namespace decalgl::bvh {
namespace {

// Less than points are rounded by.
constexpr double slack = 0.25;

Vector2 way(LatticePoint from, LatticePoint to) {
    return {double(to.x) - from.x, double(to.y) - from.y};
}

Vector2 normalized(Vector2 v) {
    const double size = length(v);
    return size > 0.0 ? Vector2{v.x / size, v.y / size} : Vector2{};
}

double round_reach(LatticePoint point, LatticePoint a, LatticePoint b) {
    const Vector2 along = way(a, b), from = way(a, point);
    const double length2 = dot(along, along);
    const double t = length2 > 0.0 ? std::clamp(dot(from, along) / length2, 0.0, 1.0) : 0.0;
    return length({from.x - t * along.x, from.y - t * along.y});
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

// At an end of a segment; `incoming` or `outgoing` is of length 0 where the stroke begins or ends.
double end_reach(const StrokeLook& look, Vector2 from, Vector2 incoming, Vector2 outgoing) {
    if (length(incoming) == 0.0 || length(outgoing) == 0.0)
        return cap_reach(look.cap, from);
    return corner_reach(look.corner, from, incoming, outgoing, look.limit);
}

double styled_reach(const DecalGroup& group, Segment segment, double half_width, const StrokeLook& look,
                    LatticePoint point, const Slope& slope) {
    const GrownArray<LatticePoint>& at = group.vertices;
    const Run run = run_of(segment);
    const auto measured = [&](LatticePoint from, LatticePoint to) {
        return look.slope == SlopeCorrection::tangent ? slope.tangent(way(from, to)) : way(from, to);
    };
    const auto direction = [&](LatticePoint from, LatticePoint to) { return normalized(measured(from, to)); };
    const Vector2 from_start = measured(at[run.start], point), from_end = measured(at[run.end], point);
    const auto within = [&](double reach, double along) {
        return reach <= half_width * pattern_width(look, along) ? reach : out_of_reach;
    };
    const double begin = group.phase(run.start);
    if (at[run.start] == at[run.end])
        return within(dot_reach(look.cap, from_start), begin);
    const LatticePoint before = at[run.start - 1], start = at[run.start], end = at[run.end],
                       after = at[run.end + 1];
    const auto longer = [&](bool ends) { return ends && look.cap == Cap::square ? half_width : slack; };
    const Vector2 own = direction(start, end);
    const Vector2 beyond{longer(before == start && !run.plain_start), longer(end == after && !run.plain_end)};
    const double stretch =
        length(measured(start, end)) / (length(way(start, end)) * double{group.slant(run.end)});
    double reach =
        within(bar_reach(from_start, from_end, own, beyond), begin + dot(from_start, own) / stretch);
    if (!run.plain_start)
        reach = std::min(reach, within(end_reach(look, from_start, direction(before, start), own), begin));
    if (!run.plain_end)
        reach = std::min(reach,
                         within(end_reach(look, from_end, own, direction(end, after)), group.phase(run.end)));
    return reach;
}

}  // namespace

double stroke_share(const DecalGroup& group, uint32_t index, LatticePoint point, const Slope& slope) {
    const Segment segment = group.segments[index];
    const Style& style = group.styles[group.owner(segment.first())];
    const double half_width = style.half_width;
    if (!(half_width > 0.0))
        return out_of_reach;
    if (!group.needs.corners)
        return round_reach(point, group.vertices[segment.a], group.vertices[segment.b]) / half_width;
    const StrokeLook look = stroke_look(group, style.look);
    const double width =
        look.slope == SlopeCorrection::thoeny ? half_width * slope.thoeny_width() : half_width;
    return styled_reach(group, segment, width, look, point, slope) / width;
}

bool band_shows(const DecalGroup& group, uint32_t slot, double share) {
    if (!group.needs.bands)
        return true;
    const StrokeLook look = stroke_look(group, group.styles[slot].look);
    for (uint32_t i = 0; i < look.band_count; ++i)
        if (share <= double{as_float(look.bands[i][0])} || i + 1 == look.band_count)
            return look.bands[i][1] >> 24 != 0;
    return true;
}

}  // namespace decalgl::bvh
