#include "technique/loops/chains.h"

#include <array>

#include "decalgl/core/parallel.h"

namespace decalgl::loops {
namespace {

struct Point {
    double x;
    double y;
};

// One side of the box: the points where sign * coordinate <= sign * at.
struct Side {
    bool is_x;
    double sign;
    double at;

    double beyond(Point p) const { return sign * ((is_x ? p.x : p.y) - at); }

    // Where a-b meets it: the same from both directions, so that neighbours stay neighbours.
    Point cut(Point a, Point b) const {
        if (b.x < a.x || (b.x == a.x && b.y < a.y))
            std::swap(a, b);
        const double from = is_x ? a.x : a.y, to = is_x ? b.x : b.y;
        const double share = (at - from) / (to - from);
        return is_x ? Point{at, a.y + share * (b.y - a.y)} : Point{a.x + share * (b.x - a.x), at};
    }
};

std::array<Side, 4> sides_of(const Bounds& box) {
    return {{{true, -1.0, box.min_x}, {true, 1.0, box.max_x}, {false, -1.0, box.min_y}, {false, 1.0, box.max_y}}};
}

bool lies_inside(Span<const double> part, const Bounds& box) {
    for (size_t i = 0; i < part.size(); i += 2)
        if (part[i] < box.min_x || part[i] > box.max_x || part[i + 1] < box.min_y || part[i + 1] > box.max_y)
            return false;
    return true;
}

std::vector<Point> points_of(Span<const double> part) {
    std::vector<Point> points(part.size() / 2);
    for (size_t i = 0; i < points.size(); ++i)
        points[i] = {part[2 * i], part[2 * i + 1]};
    return points;
}

// Sutherland and Hodgman: inside the box, the parity of the cut ring is that of the whole.
std::vector<Point> cut_ring(std::vector<Point> ring, const Bounds& box) {
    for (const Side& side : sides_of(box)) {
        std::vector<Point> kept;
        for (size_t i = 0; i < ring.size(); ++i) {
            const Point a = ring[i], b = ring[i + 1 == ring.size() ? 0 : i + 1];
            const bool a_in = side.beyond(a) <= 0.0, b_in = side.beyond(b) <= 0.0;
            if (a_in)
                kept.push_back(a);
            if (a_in != b_in)
                kept.push_back(side.cut(a, b));
        }
        ring = std::move(kept);
    }
    return ring;
}

std::vector<std::vector<Point>> cut_line(const std::vector<Point>& line, const Bounds& box) {
    std::vector<std::vector<Point>> pieces;
    bool goes_on = false;
    for (size_t i = 0; i + 1 < line.size(); ++i) {
        Point a = line[i], b = line[i + 1];
        bool a_cut = false, b_cut = false, seen = true;
        for (const Side& side : sides_of(box)) {
            const bool a_in = side.beyond(a) <= 0.0, b_in = side.beyond(b) <= 0.0;
            seen = seen && (a_in || b_in);
            if (!seen || a_in == b_in)
                continue;
            (a_in ? b : a) = side.cut(a, b);
            (a_in ? b_cut : a_cut) = true;
        }
        if (seen && (!goes_on || a_cut))
            pieces.push_back({a});
        if (seen)
            pieces.back().push_back(b);
        goes_on = seen && !b_cut;
    }
    return pieces;
}

// What one block of features becomes.
struct Block {
    std::vector<LatticePoint> points;
    std::vector<uint64_t> sizes;
    std::vector<uint32_t> features;

    void add(const std::vector<Point>& chain, uint32_t feature, bool is_ring, const Lattice& lattice) {
        const size_t begin = points.size();
        for (const Point& p : chain) {
            const LatticePoint rounded = lattice.nearest(p.x, p.y);
            if (points.size() == begin || points.back() != rounded)
                points.push_back(rounded);
        }
        while (is_ring && points.size() > begin + 1 && points.back() == points[begin])
            points.pop_back();
        if (points.size() == begin)
            return;
        sizes.push_back(points.size() - begin);
        features.push_back(feature);
    }
};

void add_feature(const Layer& layer, size_t feature, uint32_t number, const Lattice& lattice, Block& block) {
    const Features& features = layer.features;
    const bool rings = features.kind == FeatureKind::polygons;
    const auto first = static_cast<size_t>(features.feature_offsets[feature]);
    const auto last = static_cast<size_t>(features.feature_offsets[feature + 1]);
    for (size_t part = first; part < last; ++part) {
        const Span<const double> vertices = features.part(part);
        if (vertices.empty())
            continue;
        if (lies_inside(vertices, lattice.clip))
            block.add(points_of(vertices), number, rings, lattice);
        else if (rings)
            block.add(cut_ring(points_of(vertices), lattice.clip), number, true, lattice);
        else
            for (const std::vector<Point>& piece : cut_line(points_of(vertices), lattice.clip))
                block.add(piece, number, false, lattice);
    }
}

}  // namespace

void add_chains(const Layer& layer, uint32_t first_feature, const Lattice& lattice, unsigned threads,
                Chains& chains) {
    constexpr size_t grain = 256;
    const size_t count = layer.features.feature_count();
    std::vector<Block> blocks(block_count(count, grain));
    parallel_for(count, grain, threads, [&](size_t begin, size_t end) {
        for (size_t feature = begin; feature < end; ++feature)
            add_feature(layer, feature, first_feature + static_cast<uint32_t>(feature), lattice,
                        blocks[begin / grain]);
    });
    size_t points = chains.points.size();
    for (const Block& block : blocks)
        points += block.points.size();
    size_t place = chains.points.size();
    chains.points.resize(points);
    for (const Block& block : blocks) {
        std::copy(block.points.begin(), block.points.end(), chains.points.begin() + static_cast<ptrdiff_t>(place));
        place += block.points.size();
        for (const uint64_t size : block.sizes)
            chains.offsets.push_back(chains.offsets.back() + size);
        chains.features.insert(chains.features.end(), block.features.begin(), block.features.end());
    }
    chains.closed.resize(chains.features.size(), layer.features.kind == FeatureKind::polygons);
}

}  // namespace decalgl::loops
