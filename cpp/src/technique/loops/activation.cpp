#include "technique/loops/activation.h"

#include <cmath>

#include "decalgl/core/parallel.h"
#include "technique/loops/half_float.h"

namespace decalgl::loops {
namespace {

// Slack beyond what nests exactly: more than the shaders' rounding, as long as errors are no smaller than a
// ten-thousandth of the distance.
constexpr double slack = 1.0 + 1.0 / 1024.0;

// Before saturation a region of its own, afterwards that of all that it holds.
struct Region {
    LatticePoint proxy;
    float error;  // quanta, on the ground
    float radius;
    float lowest;
    float highest;
};

void add(Region& region, const Region& below) {
    region.error = std::max(region.error, below.error);
    region.radius = std::max(
        region.radius, rounded_up(slack * (double{below.radius} + distance_between(region.proxy, below.proxy))));
    region.lowest = std::min(region.lowest, below.lowest);
    region.highest = std::max(region.highest, below.highest);
}

// Each splitter's own: its triangle, and its error on the steepest ground between its arc and the base.
LargeArray<Region> own_regions(const Arcs& arcs, const Refinement& refinement, const Dependencies& dependencies,
                               const Ground& ground, unsigned threads) {
    LargeArray<Region> regions(arcs.points.size());
    LargeArray<float> steepest(arcs.points.size());
    parallel_for(arcs.count(), 64, threads, [&](size_t begin, size_t end) {
        for (size_t arc = begin; arc < end; ++arc) {
            std::fill(steepest.begin() + arcs.begin(arc), steepest.begin() + arcs.end(arc), 0.0F);
            for (uint32_t i = arcs.begin(arc); i < arcs.end(arc) && refinement.order[i] != no_point; ++i) {
                const uint32_t p = refinement.order[i];
                const LatticePoint a = arcs.points[refinement.left[p]], s = arcs.points[p],
                                   b = arcs.points[refinement.right[p]];
                const GroundRange range = ground.below(box_of(a, s, b));
                steepest[p] = std::max(steepest[p], range.steepest);
                if (refinement.parents[p] != no_point) {
                    float& above = steepest[refinement.parents[p]];
                    above = std::max(above, steepest[p]);
                }
                const bool stays = dependencies.stays[p] || arcs.kinds[arc] == ArcKind::frame;
                const double error = double{refinement.errors[p]} * std::sqrt(1.0 + double{steepest[p]});
                regions[p] = {s, stays ? INFINITY : rounded_up(error),
                              rounded_up(std::max(distance_between(s, a), distance_between(s, b))), range.lowest,
                              range.highest};
            }
        }
    });
    return regions;
}

// What each splitter needs beside its parent, as lists one after the other.
struct NeedLists {
    std::vector<uint64_t> offsets;
    std::vector<uint32_t> needed;

    NeedLists(size_t points, const std::vector<std::pair<uint32_t, uint32_t>>& needs)
        : offsets(points + 1), needed(needs.size()) {
        for (const auto& need : needs)
            ++offsets[need.first + 1];
        for (size_t i = 0; i < points; ++i)
            offsets[i + 1] += offsets[i];
        std::vector<uint64_t> places(offsets.begin(), offsets.end() - 1);
        for (const auto& need : needs)
            needed[places[need.first]++] = need.second;
    }
};

// Tarjan's strongly connected components, without recursion: vertices that need each other, all ways round.
// Components are numbered so that whatever one needs has a lower number.
class Components {
public:
    Components(const Refinement& refinement, const NeedLists& needs)
        : refinement_(refinement), needs_(needs), numbers_(needs.offsets.size() - 1, none), lowest_(numbers_.size()) {
        for (uint32_t p = 0; p < numbers_.size(); ++p)
            if (refinement.is_splitter(p) && numbers_[p] == none)
                explore(p);
    }

    // In the order of components.
    const std::vector<uint32_t>& members() const { return members_; }
    const std::vector<uint32_t>& begins() const { return begins_; }

    template <typename Visit>
    void each_needed(uint32_t p, const Visit& visit) const {
        if (refinement_.parents[p] != no_point)
            visit(refinement_.parents[p]);
        for (uint64_t i = needs_.offsets[p]; i < needs_.offsets[p + 1]; ++i)
            visit(needs_.needed[i]);
    }

private:
    static constexpr uint32_t none = UINT32_MAX;
    static constexpr uint32_t done = UINT32_MAX - 1;

    struct Step {
        uint32_t point;
        uint64_t next;  // 0: the parent, then the list
    };

    uint32_t needed(uint32_t p, uint64_t index) const {
        return index == 0 ? refinement_.parents[p] : needs_.needed[needs_.offsets[p] + index - 1];
    }
    uint64_t need_count(uint32_t p) const { return 1 + needs_.offsets[p + 1] - needs_.offsets[p]; }

    void enter(uint32_t p) {
        numbers_[p] = lowest_[p] = count_++;
        stack_.push_back(p);
        steps_.push_back({p, 0});
    }

    void explore(uint32_t root) {
        enter(root);
        while (!steps_.empty()) {
            Step& step = steps_.back();
            const uint32_t p = step.point;
            if (step.next < need_count(p)) {
                const uint32_t other = needed(p, step.next++);
                if (other == no_point || numbers_[other] == done)
                    continue;
                if (numbers_[other] == none)
                    enter(other);
                else
                    lowest_[p] = std::min(lowest_[p], numbers_[other]);
                continue;
            }
            steps_.pop_back();
            if (!steps_.empty()) {
                uint32_t& below = lowest_[steps_.back().point];
                below = std::min(below, lowest_[p]);
            }
            if (lowest_[p] == numbers_[p])
                close(p);
        }
    }

    void close(uint32_t p) {
        begins_.push_back(static_cast<uint32_t>(members_.size()));
        uint32_t member = none;
        do {
            member = stack_.back();
            stack_.pop_back();
            numbers_[member] = done;
            members_.push_back(member);
        } while (member != p);
    }

    const Refinement& refinement_;
    const NeedLists& needs_;
    std::vector<uint32_t> numbers_, lowest_;
    std::vector<uint32_t> members_, begins_;
    std::vector<uint32_t> stack_;
    std::vector<Step> steps_;
    uint32_t count_ = 0;
};

uint32_t packed_lengths(const Region& region) {
    return half_not_below(length_scale * double{region.error}) |
           uint32_t{half_not_below(length_scale * double{region.radius})} << 16;
}

uint32_t packed_heights(const Region& region, const GroundRange& all) {
    const double range = std::max(double{all.highest} - double{all.lowest}, 1e-6);
    const auto share = [&](float height) { return 65535.0 * (double{height} - double{all.lowest}) / range; };
    const auto clamped = [](double value) { return static_cast<uint32_t>(std::clamp(value, 0.0, 65535.0)); };
    return clamped(std::floor(share(region.lowest))) | clamped(std::ceil(share(region.highest))) << 16;
}

}  // namespace

LargeArray<Activation> saturate(const Arcs& arcs, const Refinement& refinement, const Dependencies& dependencies,
                                const Ground& ground, unsigned threads) {
    LargeArray<Region> regions = own_regions(arcs, refinement, dependencies, ground, threads);
    const NeedLists needs(arcs.points.size(), dependencies.needs);
    const Components components(refinement, needs);
    const std::vector<uint32_t>&members = components.members(), &begins = components.begins();
    // Whatever needs a component comes after it, so from the last on: each is whole when its turn comes.
    for (size_t i = begins.size(); i-- > 0;) {
        const size_t begin = begins[i], end = i + 1 < begins.size() ? begins[i + 1] : members.size();
        Region all = regions[members[begin]];
        for (size_t m = begin + 1; m < end; ++m)
            add(all, regions[members[m]]);
        // As it will be read.
        all.error = rounded_up(half_to_double(half_not_below(length_scale * double{all.error})) / length_scale);
        all.radius = rounded_up(half_to_double(half_not_below(length_scale * double{all.radius})) / length_scale);
        for (size_t m = begin; m < end; ++m) {
            regions[members[m]] = all;
            components.each_needed(members[m], [&](uint32_t parent) {
                if (regions[parent].proxy != all.proxy || regions[parent].radius < all.radius ||
                    regions[parent].error < all.error || regions[parent].lowest > all.lowest ||
                    regions[parent].highest < all.highest)
                    add(regions[parent], all);
            });
        }
    }
    LargeArray<Activation> activations(arcs.points.size());
    parallel_for(arcs.points.size(), 1 << 14, threads, [&](size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) {
            const bool splits = refinement.is_splitter(static_cast<uint32_t>(p));
            const Region region =
                splits ? regions[p] : Region{arcs.points[p], INFINITY, 0.0F, ground.everywhere().lowest, ground.everywhere().highest};
            activations[p] = {region.proxy.x, region.proxy.y, packed_lengths(region),
                              packed_heights(region, ground.everywhere())};
        }
    });
    return activations;
}

}  // namespace decalgl::loops
