#include "technique/distance_field/network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

#include "core/lattice_points.h"
#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"

namespace decalgl::network {
namespace {

using lattice::LatticePoint;

// Pieces of long segments have lower boxes: so many samples of terrain at most.
constexpr double longest_piece = 64.0;
constexpr uint64_t most_nodes = uint64_t{1} << 27;  // what drivers read from one texture buffer as a rule

struct Point {
    double x, y;
};

struct LatticeHash {
    size_t operator()(const LatticePoint& point) const {
        uint64_t key = uint64_t(uint32_t(point.x)) << 32U | uint32_t(point.y);
        key *= 0x9E3779B97F4A7C15ULL;
        return key ^ key >> 29U;
    }
};

Bounds widened(const Bounds& bounds, double by) {
    return {bounds.min_x - by, bounds.min_y - by, bounds.max_x + by, bounds.max_y + by};
}

// The part of a segment inside a box, as shares of its length; begin > end where there is none.
std::pair<double, double> inside(Point a, Point b, const Bounds& box) {
    double begin = 0.0, end = 1.0;
    const auto cut = [&](double from, double to, double low, double high) {
        const double way = to - from;
        if (way == 0.0) {
            if (from < low || from > high)
                end = -1.0;
            return;
        }
        const double first = (low - from) / way, second = (high - from) / way;
        begin = std::max(begin, std::min(first, second));
        end = std::min(end, std::max(first, second));
    };
    cut(a.x, b.x, box.min_x, box.max_x);
    cut(a.y, b.y, box.min_y, box.max_y);
    return {begin, end};
}

class Builder {
public:
    Builder(const TechniqueInput& input, double reach)
        : bounds_(widened(input.bounds, reach)),
          piece_(longest_piece * std::max(input.terrain->dx(), input.terrain->dy())) {
        network_.lattice = Lattice::of(input.positions, input.bounds, reach);
    }

    void add_part(Span<const double> coordinates, uint32_t slot) {
        first_ = network_.segments.size();
        double length = 0.0;
        size_t last = 0;  // vertex that the next segment begins at
        const auto at = [&](size_t i) { return Point{coordinates[2 * i], coordinates[2 * i + 1]}; };
        const size_t count = coordinates.size() / 2;
        for (size_t i = 1; i < count; ++i) {
            if (lattice(at(i)) == lattice(at(last)))
                continue;
            length += add_segment(at(last), at(i), length, slot, last == 0);
            last = i;
        }
        if (last == 0 && count > 0)
            add_dot(at(0), slot);
        else if (network_.segments.size() > first_ && ends_at_last_)
            network_.segments.back().ends |= LINE_ENDS_AT_B;
    }

    Network finish() {
        std::vector<uint32_t> grades(network_.nodes.size(), 0);
        for (const Segment& segment : network_.segments) {
            ++grades[segment.a];
            if (segment.b != segment.a)
                ++grades[segment.b];
        }
        for (size_t i = 0; i < grades.size(); ++i)
            network_.nodes[i].marks = std::min(grades[i], uint32_t{NODE_GRADE_MASK});
        return std::move(network_);
    }

private:
    // Far away points are never asked for: what is added is cut to the bounds first.
    LatticePoint lattice(Point p) const {
        const Lattice& to = network_.lattice;
        const auto count = [&](double place, double origin) {
            const double quanta = std::nearbyint((place - origin) / to.quantum);
            return static_cast<int32_t>(std::clamp(quanta, -2147483648.0, 2147483647.0));
        };
        return {count(p.x, to.origin_x), count(p.y, to.origin_y)};
    }

    uint32_t node(Point place) {
        const LatticePoint point = lattice(place);
        const auto [entry, is_new] = places_.try_emplace(point, uint32_t(network_.nodes.size()));
        if (is_new)
            network_.nodes.push_back({point.x, point.y, 0});
        return entry->second;
    }

    void add_dot(Point at, uint32_t slot) {
        const auto [begin, end] = inside(at, at, bounds_);
        if (begin > end)
            return;
        const uint32_t place = node(at);
        network_.segments.push_back({place, place, slot, 0, 0.0F, LINE_ENDS_AT_A | LINE_ENDS_AT_B});
    }

    // Returns its whole length.
    double add_segment(Point a, Point b, double start, uint32_t slot, bool is_first) {
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        const auto [begin, end] = inside(a, b, bounds_);
        ends_at_last_ = begin <= end && end == 1.0;
        if (begin > end)
            return length;
        const auto along = [&](double share) {
            return share == 1.0 ? b : Point{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
        };
        const double seen = (end - begin) * length;
        const auto pieces = static_cast<size_t>(std::max(1.0, std::ceil(seen / piece_)));
        for (size_t i = 0; i < pieces; ++i) {
            const auto share = [&](size_t k) {
                return k == pieces ? end : begin + (end - begin) * double(k) / double(pieces);
            };
            uint32_t ends = 0;
            if (i == 0 && is_first && begin == 0.0)
                ends |= LINE_ENDS_AT_A;
            else if (i > 0 || begin > 0.0)
                ends |= PLAIN_A;
            const uint32_t from = node(along(share(i))), to = node(along(share(i + 1)));
            if (from != to)
                network_.segments.push_back(
                    {from, to, slot, 0, static_cast<float>(start + share(i) * length), ends});
        }
        if (network_.nodes.size() > most_nodes || network_.segments.size() > most_nodes)
            throw Error(ErrorKind::memory,
                        "the network has more nodes than a shader could read; draw fewer features, or use "
                        "technique 'static'");
        return length;
    }

    Network network_;
    Bounds bounds_;
    double piece_;
    std::unordered_map<LatticePoint, uint32_t, LatticeHash> places_;
    size_t first_ = 0;
    bool ends_at_last_ = false;
};

}  // namespace

Lattice Lattice::of(const PositionGrid& positions, const Bounds& bounds, double reach) {
    Lattice lattice{positions.origin_x, positions.origin_y, positions.block_size, 0};
    const double extent = std::max(bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y);
    const double finest = std::max(positions.span, extent + 2.0 * reach) / double{1 << 30};
    while (lattice.quantum > finest && lattice.block_shift < 20) {
        lattice.quantum *= 0.5;
        ++lattice.block_shift;
    }
    return lattice;
}

Network build_network(const TechniqueInput& input, double reach, Progress& progress) {
    Builder builder(input, reach);
    uint32_t slot = 0;
    size_t total = 0;
    for (const Layer& layer : input.layers)
        total += layer.features.feature_count();
    for (const Layer& layer : input.layers) {
        const Features& features = layer.features;
        for (size_t f = 0; f < features.feature_count(); ++f, ++slot) {
            const auto begin = static_cast<size_t>(features.feature_offsets[f]),
                       end = static_cast<size_t>(features.feature_offsets[f + 1]);
            for (size_t part = begin; part < end; ++part)
                builder.add_part(features.part(part), slot);
            if (slot % 4096 == 0)
                progress.report(double(slot) / double(total));
        }
    }
    return builder.finish();
}

void set_heights(Network& network, const HeightRanges& ranges, double reach) {
    parallel_for(network.segments.size(), 4096, 0, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            Segment& segment = network.segments[i];
            const auto a = network.place(segment.a), b = network.place(segment.b);
            const Bounds box{std::min(a[0], b[0]), std::min(a[1], b[1]), std::max(a[0], b[0]),
                             std::max(a[1], b[1])};
            segment.heights = ranges.packed(ranges.over(widened(box, reach)));
        }
    });
}

}  // namespace decalgl::network
