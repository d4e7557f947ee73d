#include "technique/loops/noding.h"

#include <algorithm>
#include <utility>

#include "decalgl/core/parallel.h"

namespace decalgl::loops {
namespace {

constexpr int32_t nearness = 2;  // quanta, seen along the axis that the edge is steeper to

using Passed = std::vector<std::pair<int64_t, uint32_t>>;  // how far along the edge, and the location

// Whether the edge from a to b may come near a box: else both its sides lie beyond.
bool comes_near(LatticePoint a, LatticePoint b, const LatticeBox& box) {
    const int64_t slack = nearness * std::max(std::abs(int64_t{b.x} - a.x), std::abs(int64_t{b.y} - a.y));
    const auto beside = [&](int32_t x, int32_t y) { return doubled_area(a, b, {x, y}); };
    const int64_t values[] = {beside(box.min_x, box.min_y), beside(box.max_x, box.min_y),
                              beside(box.min_x, box.max_y), beside(box.max_x, box.max_y)};
    return *std::min_element(values, values + 4) <= slack && *std::max_element(values, values + 4) >= -slack;
}

// The locations that the edge from a to b passes, in its order.
void find_passed(const Locations& locations, uint32_t from, uint32_t to, Passed& passed) {
    passed.clear();
    const LatticePoint a = locations.place(from), b = locations.place(to);
    const int64_t dx = int64_t{b.x} - a.x, dy = int64_t{b.y} - a.y;
    const int64_t slack = nearness * std::max(std::abs(dx), std::abs(dy)), length2 = dx * dx + dy * dy;
    LatticeBox box;
    box.add(a);
    box.add(b);
    box = {box.min_x - nearness, box.min_y - nearness, box.max_x + nearness, box.max_y + nearness};
    locations.search(
        box, [&](const LatticeBox& below) { return comes_near(a, b, below); },
        [&](uint32_t location) {
            const LatticePoint p = locations.place(location);
            const int64_t along = (int64_t{p.x} - a.x) * dx + (int64_t{p.y} - a.y) * dy;
            if (location != from && location != to && along > 0 && along < length2 &&
                std::abs(doubled_area(a, b, p)) <= slack)
                passed.emplace_back(along, location);
            return true;
        });
    std::sort(passed.begin(), passed.end());
}

}  // namespace

NodedChains node_junctions(const Chains& chains, const Locations& locations, Span<const uint32_t> numbers,
                           unsigned threads) {
    constexpr size_t grain = 64;
    struct Block {
        std::vector<uint32_t> locations;
        std::vector<uint64_t> sizes;
    };
    std::vector<Block> blocks(block_count(chains.count(), grain));
    parallel_for(chains.count(), grain, threads, [&](size_t begin, size_t end) {
        Block& block = blocks[begin / grain];
        Passed passed;
        for (size_t chain = begin; chain < end; ++chain) {
            const size_t size = chains.size_of(chain), before = block.locations.size();
            const uint32_t* own = numbers.data() + chains.offsets[chain];
            const size_t edges = chains.closed[chain] ? size : size - 1;
            for (size_t i = 0; i < size; ++i) {
                block.locations.push_back(own[i]);
                if (i >= edges || size == 1)
                    continue;
                find_passed(locations, own[i], own[i + 1 == size ? 0 : i + 1], passed);
                for (const auto& each : passed)
                    block.locations.push_back(each.second);
            }
            block.sizes.push_back(block.locations.size() - before);
        }
    });
    NodedChains noded;
    noded.offsets.push_back(0);
    size_t total = 0;
    for (const Block& block : blocks)
        total += block.locations.size();
    noded.locations.reserve(total);
    for (Block& block : blocks) {
        noded.locations.insert(noded.locations.end(), block.locations.begin(), block.locations.end());
        for (const uint64_t size : block.sizes)
            noded.offsets.push_back(noded.offsets.back() + size);
        block = {};
    }
    return noded;
}

}  // namespace decalgl::loops
