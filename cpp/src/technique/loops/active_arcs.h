// What of each arc is active: its ends, and the splitters that some test lets through.
//
//     steps     of each arc, its splitters from the last to go on, each with all below it: preorder
//
//         s         size: how many there are below s, with s      Where s is not active, all of them are passed
//        / \                                                      over; else the next step is the first below s.
//
// The test must let a splitter's parents through with it.
#pragma once

#include "decalgl/core/parallel.h"
#include "technique/loops/refinement.h"

namespace decalgl::loops {

struct Step {
    uint32_t point;
    uint32_t size;
};

// Of arc a from begin(a) on; the last two of each arc, and those of frames, are unused and 0.
LargeArray<Step> steps_of(const Arcs& arcs, const Refinement& refinement, unsigned threads);

struct ActiveArcs {
    std::vector<LatticePoint> points;  // arc after arc
    std::vector<uint64_t> offsets = {0};

    Span<const LatticePoint> of(size_t arc) const {
        const auto begin = static_cast<size_t>(offsets[arc]);
        return Span<const LatticePoint>(points).subspan(begin, static_cast<size_t>(offsets[arc + 1]) - begin);
    }
};

// A set of an arc's vertices.
class VertexSet {
public:
    void clear(size_t size) { words_.assign((size + 63) / 64, 0); }
    void add(size_t i) { words_[i / 64] |= uint64_t{1} << (i % 64); }

    template <typename Visit>
    void each(const Visit& visit) const {
        for (size_t w = 0; w < words_.size(); ++w)
            for (uint64_t left = words_[w]; left != 0; left &= left - 1)
                visit(64 * w + static_cast<size_t>(__builtin_ctzll(left)));
    }

private:
    std::vector<uint64_t> words_;
};

// `is_active(point, arc)`; frames have nothing but their ends.
template <typename IsActive>
ActiveArcs active_arcs(const KeptArcs& arcs, Span<const Step> steps, unsigned threads,
                       const IsActive& is_active) {
    constexpr size_t grain = 256;
    struct Block {
        std::vector<LatticePoint> points;
        std::vector<uint32_t> sizes;
    };
    std::vector<Block> blocks(block_count(arcs.count(), grain));
    parallel_for(arcs.count(), grain, threads, [&](size_t begin, size_t end) {
        Block& block = blocks[begin / grain];
        VertexSet active;
        for (size_t arc = begin; arc < end; ++arc) {
            const uint32_t first = arcs.begin(arc), size = arcs.size_of(arc);
            const size_t before = block.points.size();
            active.clear(size);
            active.add(0);
            active.add(size - 1);
            const uint32_t last = arcs.kinds[arc] == ArcKind::frame ? first : first + size - 2;
            for (uint32_t i = first; i < last;) {
                const Step step = steps[i];
                const bool goes_on = is_active(step.point, arc);
                if (goes_on)
                    active.add(step.point - first);
                i += goes_on ? 1 : step.size;
            }
            active.each([&](size_t i) { block.points.push_back(arcs.points[first + i]); });
            block.sizes.push_back(static_cast<uint32_t>(block.points.size() - before));
        }
    });
    ActiveArcs found;
    size_t total = 0;
    for (const Block& block : blocks)
        total += block.points.size();
    found.points.reserve(total);
    for (const Block& block : blocks) {
        found.points.insert(found.points.end(), block.points.begin(), block.points.end());
        for (const uint32_t size : block.sizes)
            found.offsets.push_back(found.offsets.back() + size);
    }
    return found;
}

}  // namespace decalgl::loops
