#include "technique/loops/locations.h"

#include "decalgl/core/parallel.h"
#include "decalgl/core/radix_sort.h"

namespace decalgl::loops {
namespace {

constexpr size_t grain = 1 << 14;

uint64_t spread(uint32_t value) {
    uint64_t bits = value;
    bits = (bits | bits << 16) & 0x0000FFFF0000FFFFu;
    bits = (bits | bits << 8) & 0x00FF00FF00FF00FFu;
    bits = (bits | bits << 4) & 0x0F0F0F0F0F0F0F0Fu;
    bits = (bits | bits << 2) & 0x3333333333333333u;
    return (bits | bits << 1) & 0x5555555555555555u;
}

}  // namespace

Locations::Locations(Span<const LatticePoint> points, LargeArray<uint32_t>& numbers, unsigned threads) {
    const size_t count = points.size();
    LargeArray<uint64_t> keys(count);
    LargeArray<uint32_t> order(count);
    parallel_for(count, grain, threads, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            keys[i] = spread(static_cast<uint32_t>(points[i].x)) | spread(static_cast<uint32_t>(points[i].y)) << 1;
            order[i] = static_cast<uint32_t>(i);
        }
    });
    radix_sort(Span<uint64_t>(keys.data(), count), Span<uint32_t>(order.data(), count), threads, 2 * lattice_bits + 2);
    numbers.resize(count);
    places_.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        if (i == 0 || keys[i] != keys[i - 1])
            places_.push_back(points[order[i]]);
        numbers[order[i]] = static_cast<uint32_t>(places_.size() - 1);
    }
    size_t below = places_.size();
    do {
        std::vector<LatticeBox> boxes(block_count(below, fan));
        parallel_for(boxes.size(), grain, threads, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i)
                for (size_t k = i * fan; k < std::min(below, (i + 1) * fan); ++k)
                    levels_.empty() ? boxes[i].add(places_[k]) : boxes[i].add(levels_.back()[k]);
        });
        below = boxes.size();
        levels_.push_back(std::move(boxes));
    } while (below > fan);
}

}  // namespace decalgl::loops
