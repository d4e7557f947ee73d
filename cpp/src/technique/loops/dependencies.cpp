#include "technique/loops/dependencies.h"

#include <algorithm>

#include "decalgl/core/parallel.h"

namespace decalgl::loops {
namespace {

using Needs = std::vector<std::pair<uint32_t, uint32_t>>;

// How many vertices may be looked at for an arc: hostile data has all triangles over all vertices. What is left
// then stays, which is always safe.
constexpr uint64_t looks_per_vertex = 256;
constexpr uint64_t looks_per_arc = 1 << 16;

// Whether the triangle may reach into a box: not where the box lies beyond one of its sides.
bool may_meet(LatticePoint a, LatticePoint b, LatticePoint c, const LatticeBox& box) {
    if (doubled_area(a, b, c) < 0)
        std::swap(b, c);
    const auto is_beyond = [&](LatticePoint from, LatticePoint to) {
        return doubled_area(from, to, {box.min_x, box.min_y}) < 0 &&
               doubled_area(from, to, {box.max_x, box.min_y}) < 0 &&
               doubled_area(from, to, {box.min_x, box.max_y}) < 0 &&
               doubled_area(from, to, {box.max_x, box.max_y}) < 0;
    };
    return !is_beyond(a, b) && !is_beyond(b, c) && !is_beyond(c, a);
}

class Finder {
public:
    Finder(const Arcs& arcs, const Locations& locations, const Refinement& refinement,
           Span<const uint32_t> splitters, Span<uint8_t> stays, Needs& needs)
        : arcs_(arcs),
          locations_(locations),
          refinement_(refinement),
          splitters_(splitters),
          stays_(stays),
          needs_(needs) {}

    void find(size_t arc) {
        if (arcs_.kinds[arc] == ArcKind::frame)
            return;
        looks_ = looks_per_arc + looks_per_vertex * arcs_.size_of(arc);
        for (uint32_t i = arcs_.begin(arc); i < arcs_.end(arc) && refinement_.order[i] != no_point; ++i) {
            const uint32_t splitter = refinement_.order[i];
            if (!stays_[splitter])
                find_in_triangle(splitter);
            const uint32_t parent = refinement_.parents[splitter];
            if (stays_[splitter] && parent != no_point)
                stays_[parent] = 1;
        }
    }

private:
    void find_in_triangle(uint32_t splitter) {
        const uint32_t left = refinement_.left[splitter], right = refinement_.right[splitter];
        const LatticePoint a = arcs_.points[left], s = arcs_.points[splitter], b = arcs_.points[right];
        locations_.search(
            box_of(a, s, b), [&](const LatticeBox& box) { return may_meet(a, s, b, box); },
            [&](uint32_t location) {
                const LatticePoint p = locations_.place(location);
                stays_[splitter] = looks_ == 0;
                looks_ -= looks_ > 0;
                if (p == a || p == b || !triangle_holds(a, s, b, p))
                    return !stays_[splitter];
                const uint32_t other = splitters_[location];
                if (other == no_point)
                    stays_[splitter] = 1;
                else if ((other < left || other > right) && !is_implied(refinement_.parents[other], a, s, b))
                    needs_.emplace_back(other, splitter);
                return !stays_[splitter];
            });
    }

    bool is_implied(uint32_t parent, LatticePoint a, LatticePoint s, LatticePoint b) const {
        if (parent == no_point)
            return false;
        const LatticePoint p = arcs_.points[parent];
        return p != a && p != b && p != s && triangle_holds(a, s, b, p);
    }

    const Arcs& arcs_;
    const Locations& locations_;
    const Refinement& refinement_;
    Span<const uint32_t> splitters_;
    Span<uint8_t> stays_;
    Needs& needs_;
    uint64_t looks_ = 0;
};

// The splitter that stands for each location: no_point for one that never goes. A ring's first vertex is there
// as long as the ring is more than a point. Where an arc turns back on itself, one vertex stands for all.
LargeArray<uint32_t> splitters_of(const Arcs& arcs, size_t locations, const Refinement& refinement,
                                  unsigned threads, Needs& twins) {
    LargeArray<uint32_t> splitters(locations, no_point);
    constexpr size_t grain = 64;
    std::vector<Needs> blocks(block_count(arcs.count(), grain));
    parallel_for(arcs.count(), grain, threads, [&](size_t begin, size_t end) {
        for (size_t arc = begin; arc < end; ++arc) {
            if (arcs.kinds[arc] == ArcKind::frame)
                continue;
            for (uint32_t p = arcs.begin(arc) + 1; p + 1 < arcs.end(arc); ++p) {
                uint32_t& splitter = splitters[arcs.locations[p]];
                if (splitter == no_point) {
                    splitter = p;
                } else {
                    blocks[begin / grain].emplace_back(splitter, p);
                    blocks[begin / grain].emplace_back(p, splitter);
                }
                if (arcs.kinds[arc] == ArcKind::ring && refinement.parents[p] == no_point)
                    splitters[arcs.locations[arcs.begin(arc)]] = p;
            }
        }
    });
    for (const Needs& block : blocks)
        twins.insert(twins.end(), block.begin(), block.end());
    return splitters;
}

}  // namespace

Dependencies find_dependencies(const Arcs& arcs, const Locations& locations, const Refinement& refinement,
                               unsigned threads) {
    Dependencies found;
    found.stays.assign(arcs.points.size(), 0);
    const LargeArray<uint32_t> splitters =
        splitters_of(arcs, locations.count(), refinement, threads, found.needs);
    constexpr size_t grain = 64;
    std::vector<Needs> blocks(block_count(arcs.count(), grain));
    parallel_for(arcs.count(), grain, threads, [&](size_t begin, size_t end) {
        Finder finder(arcs, locations, refinement, splitters, found.stays, blocks[begin / grain]);
        for (size_t arc = begin; arc < end; ++arc)
            finder.find(arc);
    });
    for (Needs& block : blocks) {
        found.needs.insert(found.needs.end(), block.begin(), block.end());
        block = {};
    }
    return found;
}

}  // namespace decalgl::loops
