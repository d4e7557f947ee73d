// What lies at a place: all segments one after the other, in double precision.
#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "decalgl/core/parallel.h"
#include "technique/distance_field/mends.h"
#include "technique/distance_field/prepared_network.h"
#include "vector/stroke_reach.h"

namespace decalgl::network {
namespace {

constexpr size_t segments_at_once = 65536;

// By a texture on the map, the texel below the place.
double lod_at(const LevelOfDetail& lod, const SeenPoint& point) {
    if (lod.source != LodSource::texture)
        return lod.value;
    const auto texel = [](double place, double low, double high, int count) {
        return static_cast<size_t>(std::clamp((place - low) / (high - low) * count, 0.0, count - 1.0));
    };
    const size_t column = texel(point.x, lod.extent[0], lod.extent[2], lod.width);
    const size_t row = texel(point.y, lod.extent[1], lod.extent[3], lod.height);
    return lod.texels[row * static_cast<size_t>(lod.width) + column] / 255.0;
}

bool knows_lod(const LevelOfDetail& lod) {
    return lod.source == LodSource::value || (lod.source == LodSource::texture && lod.space == LodSpace::map);
}

class Reader {
public:
    Reader(const PreparedNetwork& prepared, const SeenPoint& point)
        : prepared_(&prepared), network_(prepared.network.get()), point_(point) {
        const LevelOfDetail& lod = prepared.options->lod;
        for (const NetworkCategory& category : prepared.table.categories)
            half_widths_.push_back(knows_lod(lod) ? 0.5 * style_at(category, lod_at(lod, point)).width
                                                  : widest_half_width(category));
        steep_ = point.gradient_x * point.gradient_x + point.gradient_y * point.gradient_y;
    }

    bool covers(const Segment& segment) const {
        const Slot slot = prepared_->table.slots[segment.slot];
        if (!slot.shows())
            return false;
        const NetworkCategory& category = prepared_->table.of(slot);
        const auto a = network_->place(segment.a), b = network_->place(segment.b);
        const Vector2 from = on_slope({point_.x - a[0], point_.y - a[1]}, category);
        const Vector2 way = on_slope({b[0] - a[0], b[1] - a[1]}, category);
        const double size = length(way);
        const Vector2 along = size > 0.0 ? Vector2{way.x / size, way.y / size} : Vector2{1.0, 0.0};
        const double place = dot(from, along), across = std::abs(cross(along, from));
        const double share = size > 0.0 ? std::clamp(place / size, 0.0, 1.0) : 0.0;
        const double half_width = half_width_at(segment, slot.category, share);
        const double map_length = std::hypot(b[0] - a[0], b[1] - a[1]);
        if (!marked(category, segment.start + share * map_length, across, half_width))
            return false;
        if (place >= 0.0 && place <= size)
            return across <= half_width;
        const bool before = place < 0.0;
        return cap_covers(segment, category, before, before ? -place : place - size, across, half_width);
    }

private:
    Vector2 on_slope(Vector2 v, const NetworkCategory& category) const {
        if (category.slope_correction != SlopeCorrection::tangent || !(steep_ > 0.0))
            return v;
        const double stretch = (std::sqrt(1.0 + steep_) - 1.0) / steep_;
        const double up = stretch * (point_.gradient_x * v.x + point_.gradient_y * v.y);
        return {v.x + up * point_.gradient_x, v.y + up * point_.gradient_y};
    }

    double half_width_at(const Segment& segment, uint32_t category, double share) const {
        const auto at = [&](uint32_t node) {
            const uint32_t steps = network_->nodes[node].marks >> NODE_CLEARANCE_SHIFT;
            const double clearance = prepared_->table.reach * steps / clearance_steps;
            return std::min(half_widths_[category], clearance);
        };
        double half_width = half_widths_[category];
        if (prepared_->options->mend_intrusion)
            half_width = at(segment.a) + share * (at(segment.b) - at(segment.a));
        if (prepared_->table.categories[category].slope_correction == SlopeCorrection::thoeny) {
            const double towards = std::clamp(-point_.forward_z, 0.0, 1.0);
            const double thin = 1.0 / std::sqrt(1.0 + steep_);
            half_width *= thin + towards * (1.0 - thin);
        }
        return half_width;
    }

    static bool marked(const NetworkCategory& category, double along, double across, double half_width) {
        const LinePattern& pattern = category.pattern;
        if (!(pattern.period > 0.0))
            return true;
        const double phase = pattern_phase(along + pattern.offset, pattern.period);
        return std::any_of(pattern.marks.begin(), pattern.marks.end(), [&](const PatternMark& mark) {
            const double width = mark_width(mark, phase);
            return width >= 0.0 && across <= width * half_width;
        });
    }

    bool cap_covers(const Segment& segment, const NetworkCategory& category, bool at_a, double beyond,
                    double across, double half_width) const {
        const uint32_t line_ends = at_a ? LINE_ENDS_AT_A : LINE_ENDS_AT_B;
        const bool is_end = (segment.ends & line_ends) != 0;
        if (!is_end && (!at_a || (segment.ends & PLAIN_A) != 0))
            return false;
        const uint32_t cut = segment.ends >> (at_a ? CUT_A_SHIFT : CUT_B_SHIFT) & CUT_MASK;
        if (cut != 0 && beyond > half_widths_[cut - 1])
            return false;
        const uint32_t grade = network_->nodes[at_a ? segment.a : segment.b].grade();
        const int cap =
            is_end ? category.caps[std::clamp(grade, 1U, 4U) - 1] : static_cast<int>(CapShape::round);
        if (cap == static_cast<int>(CapShape::butt))
            return false;
        const double size =
            cap == static_cast<int>(CapShape::square) ? std::max(beyond, across) : std::hypot(beyond, across);
        return size <= half_width;
    }

    const PreparedNetwork* prepared_;
    const Network* network_;
    SeenPoint point_;
    double steep_ = 0.0;
    std::vector<double> half_widths_;
};

}  // namespace

std::vector<FeatureReference> PreparedNetwork::query(const SeenPoint& point) const {
    const Reader reader(*this, point);
    std::mutex mutex;
    std::vector<uint32_t> found;
    parallel_for(network->segments.size(), segments_at_once, 0, [&](size_t begin, size_t end) {
        std::vector<uint32_t> own;
        for (size_t i = begin; i < end; ++i)
            if (reader.covers(network->segments[i]))
                own.push_back(network->segments[i].slot);
        const std::lock_guard<std::mutex> lock(mutex);
        found.insert(found.end(), own.begin(), own.end());
    });
    std::sort(found.begin(), found.end(),
              [&](uint32_t a, uint32_t b) { return table.slots[a].order > table.slots[b].order; });
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::vector<FeatureReference> result;
    for (const uint32_t slot : found)
        result.push_back(references[slot]);
    return result;
}

}  // namespace decalgl::network
