#include "technique/dynamic_lines/line_writer.h"

#include <algorithm>
#include <cmath>

#include "decalgl/core/error.h"
#include "technique/dynamic_lines/ring_sides.h"

namespace decalgl {
namespace {

constexpr uint64_t most_vertices = uint64_t{1} << 31;
constexpr uint64_t step_bytes = 1 << 20;

// A length in 2^-32 of another one, of which whole ones do not count.
uint32_t turns(double length, double one) {
    const double share = length / one;
    return static_cast<uint32_t>(std::llround((share - std::floor(share)) * 4294967296.0));
}

}  // namespace

LineWriter::LineWriter(const LineLattice& lattice, const MemoryAccount& memory)
    : lattice_(lattice), box_(lattice.box()), charge_(memory, "dynamic: working memory", 0) {}

void LineWriter::add(const Features& features, size_t feature, const LinePurpose& purpose) {
    purpose_ = purpose;
    const bool rings = features.kind == FeatureKind::polygons;
    const auto first = static_cast<size_t>(features.feature_offsets[feature]);
    const auto end = static_cast<size_t>(features.feature_offsets[feature + 1]);
    std::vector<bool> is_left;
    if (rings && purpose.has_sides)
        is_left = insides_to_the_left(features, feature);
    for (size_t part = first; part < end; ++part) {
        const bool to_the_right = !is_left.empty() && !is_left[part - first];
        add_part(features.part(part), rings, to_the_right ? LINE_INSIDE_RIGHT : 0U);
    }
    require_room();
}

void LineWriter::copy(Span<const LineRecord> old_lines, Span<const SourceVertex> old_vertices,
                      uint32_t slot) {
    for (LineRecord line : old_lines) {
        const auto index = static_cast<uint32_t>(lines.size());
        const auto first = static_cast<uint32_t>(vertices.size());
        for (SourceVertex vertex : old_vertices.subspan(line.first, line.count)) {
            vertex.line = index;
            vertices.push_back(vertex);
        }
        segments += line.count - 1;
        line.first = first;
        line.slot = slot;
        lines.push_back(line);
    }
    require_room();
}

void LineWriter::require_room() {
    const uint64_t bytes = vertices.size() * sizeof(SourceVertex) + lines.size() * sizeof(LineRecord);
    if (bytes > charge_.bytes() + step_bytes)
        charge_.resize(bytes);
    if (vertices.size() > most_vertices)
        throw Error(ErrorKind::memory, "dynamic lines hold at most 2^31 vertices; draw a part of them");
}

// The stretch of a segment inside the box; false where there is none (Liang and Barsky).
bool LineWriter::clip(Point& a, Point& b) const {
    const Point d{b.x - a.x, b.y - a.y};
    double first = 0.0, last = 1.0;
    const auto cut = [&](double step, double room) {
        if (step == 0.0)
            return room >= 0.0;
        const double at = room / step;
        (step < 0.0 ? first : last) = step < 0.0 ? std::max(first, at) : std::min(last, at);
        return first <= last;
    };
    if (!(cut(-d.x, a.x - box_.min_x) && cut(d.x, box_.max_x - a.x) && cut(-d.y, a.y - box_.min_y) &&
          cut(d.y, box_.max_y - a.y)))
        return false;
    const Point from = a;
    if (last < 1.0)
        b = {from.x + last * d.x, from.y + last * d.y};
    if (first > 0.0)
        a = {from.x + first * d.x, from.y + first * d.y};
    return true;
}

void LineWriter::add_part(Span<const double> xy, bool ring, uint32_t flags) {
    std::vector<Point> chain;
    for (size_t i = 0; i + 1 < xy.size(); i += 2)
        if (chain.empty() || chain.back().x != xy[i] || chain.back().y != xy[i + 1])
            chain.push_back({xy[i], xy[i + 1]});
    if (chain.empty())
        return;
    const bool returns =
        chain.size() > 1 && chain.front().x == chain.back().x && chain.front().y == chain.back().y;
    const bool closed = ring || (returns && chain.size() >= 4);
    if (closed && !returns)
        chain.push_back(chain.front());
    if (ring && chain.size() < 4)
        return;
    segments += std::max<size_t>(chain.size() - 1, 1);
    write(chain, closed, flags);
}

// A line for each stretch inside the lattice's box.
void LineWriter::write(const std::vector<Point>& chain, bool closed, uint32_t flags) {
    first_ = vertices.size();
    bool is_whole = true;
    double arc = 0.0;
    if (chain.size() == 1) {
        Point a = chain[0], b = a;
        if (!clip(a, b))
            return;
        push(a, 0.0);
        push(a, 0.0);
    }
    for (size_t i = 0; i + 1 < chain.size(); ++i) {
        Point a = chain[i], b = chain[i + 1];
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        const bool inside = clip(a, b);
        const bool is_cut = !inside || a.x != chain[i].x || a.y != chain[i].y;
        if (is_cut) {
            is_whole = false;
            finish(flags);
        }
        if (inside) {
            if (vertices.size() == first_)
                push(a, arc + std::hypot(a.x - chain[i].x, a.y - chain[i].y));
            push(b, arc + std::hypot(b.x - chain[i].x, b.y - chain[i].y));
            if (b.x != chain[i + 1].x || b.y != chain[i + 1].y) {
                is_whole = false;
                finish(flags);
            }
        }
        arc += length;
    }
    finish(closed && is_whole ? flags | LINE_CLOSED : flags);
}

// Vertices that fall on one place of the lattice are one, but a line keeps two.
void LineWriter::push(Point point, double arc) {
    const ivec2 place = lattice_.place(point.x, point.y);
    if (vertices.size() > first_ + 1 && vertices.back().place == place)
        return;
    const uint32_t turned = purpose_.arc_length > 0.0 ? turns(arc, purpose_.arc_length) : 0U;
    vertices.push_back({place, turned, static_cast<uint32_t>(lines.size())});
}

void LineWriter::finish(uint32_t flags) {
    const size_t count = vertices.size() - first_;
    if (count >= 2)
        lines.push_back({static_cast<uint32_t>(first_), static_cast<uint32_t>(count), purpose_.slot, flags});
    else
        vertices.resize(first_);
    first_ = vertices.size();
}

}  // namespace decalgl
