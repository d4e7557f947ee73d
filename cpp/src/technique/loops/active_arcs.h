// What of each arc is active: its ends, and the splitters that some test lets through.
//
//     steps     of each arc, its splitters from the last to go on, each with all below it: preorder
//
//         s         size: how many there are below s, with s      Where s is not active, all of them are passed
//        / \                                                      over; else the next step is the first below s.
//
// The test must let a splitter's parents through with it. What it has to know lies in the same order as steps, so that it
// is read from front to back.
#pragma once

#include "decalgl/core/parallel.h"
#include "technique/loops/activation.h"
#include "technique/loops/refinement.h"

namespace decalgl::loops {

struct Step {
    uint32_t point;
    uint32_t size;
};

// Of arc a from begin(a) on; the last two of each arc, and those of frames, are unused and 0.
LargeArray<Step> steps_of(const Arcs& arcs, const Refinement& refinement, unsigned threads);
// What belongs to points, in the order of steps.
LargeArray<Activation> by_steps(const LargeArray<Activation>& activations, const LargeArray<Step>& steps,
                                unsigned threads);

// What a test says of a splitter. Inside: all below it is where the test would only ask for its error.
struct Verdict {
    bool is_active;
    bool is_inside;
};

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

// `judge(activation, arc, is_inside)` gives a verdict; frames have nothing but their ends.
template <typename Judge>
ActiveArcs active_arcs(const KeptArcs& arcs, Span<const Step> steps, Span<const Activation> activations,
                       unsigned threads, const Judge& judge) {
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
            uint32_t inside_end = first;
            for (uint32_t i = first; i < last;) {
                const Verdict verdict = judge(activations[i], arc, i < inside_end);
                const Step step = steps[i];
                if (verdict.is_active)
                    active.add(step.point - first);
                if (verdict.is_inside && i >= inside_end)
                    inside_end = i + step.size;
                i += verdict.is_active ? 1 : step.size;
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
