#include "technique/static_bvh/stroke_chains.h"

#include <cmath>
#include <cstring>

#include "technique/ground_lengths.h"
#include "technique/static_bvh/lattice_cut.h"

namespace decalgl::bvh {
namespace {

constexpr size_t parts_at_once = 64;
// Beyond, a length in float32 is neither good to an eighth of a quantum nor to a tenth of a millimetre.
constexpr double longest_piece = 1 << 20;  // quanta
constexpr double longest_piece_metres = 1024.0;

// A polyline or a ring of a stroke.
struct Part {
    uint32_t stroke;
    size_t index;  // among the parts of its layer
    uint32_t vertices;
    uint32_t segments;
    uint32_t first_vertex;
    uint32_t first_segment;
};

struct ChainVertex {
    LatticePoint point;
    double length;  // metres from the part's beginning
    float slant;    // of the edge that ends there, features.h
    bool plain;     // no corner and no cap
};

// What a part becomes; places are counted from its first vertex.
struct Chains {
    std::vector<LatticePoint> vertices;
    std::vector<double> lengths;
    std::vector<float> slants;
    std::vector<Segment> segments;

    void clear() {
        vertices.clear();
        lengths.clear();
        slants.clear();
        segments.clear();
    }
    void add(LatticePoint point, double length = 0.0, float slant = 1.0F) {
        vertices.push_back(point);
        lengths.push_back(length);
        slants.push_back(slant);
    }
};

// A part's vertices as they come, without those that repeat the one before.
struct Way {
    std::vector<Place> places;
    std::vector<float> slants;    // of the edges that end there
    std::vector<double> lengths;  // metres from the first vertex; one more for a closed way
    bool closed = false;

    size_t size() const { return places.size(); }
    size_t segments() const { return closed ? size() : size() - 1; }
    Place place(size_t i) const { return places[i % size()]; }
    bool leaves_lattice() const {
        return !std::all_of(places.begin(), places.end(), [](Place p) { return on_lattice(p); });
    }
};

Way way_of(Span<const double> coordinates, Span<const float> slants, bool follows_ground, bool is_ring,
           const Lattice& lattice) {
    Way way;
    const size_t count = coordinates.size() / 2;
    std::vector<size_t> kept;
    const auto same = [&](size_t i, size_t j) {
        return coordinates[2 * i] == coordinates[2 * j] && coordinates[2 * i + 1] == coordinates[2 * j + 1];
    };
    for (size_t i = 0; i < count; ++i) {
        const bool is_skipped = !follows_ground && !slants.empty() && slants[i] < 0.0F;
        if (!is_skipped && (kept.empty() || !same(i, kept.back())))
            kept.push_back(i);
    }
    const bool repeats = kept.size() > 1 && same(kept.front(), kept.back());
    way.closed = is_ring || (repeats && kept.size() >= 4);
    for (const size_t vertex : kept)
        way.slants.push_back(follows_ground && !slants.empty() ? slants[vertex] : 1.0F);
    if (way.closed && repeats) {
        kept.pop_back();
        way.slants.front() = way.slants.back();
        way.slants.pop_back();
    }
    if (is_ring && kept.size() < 3)
        return way;
    double length = 0.0;
    for (size_t i = 0; i < kept.size(); ++i) {
        const double* at = &coordinates[2 * kept[i]];
        way.places.push_back({lattice.x_of(at[0]), lattice.y_of(at[1])});
        way.lengths.push_back(length);
        const size_t after = (i + 1) % kept.size();
        const double* next = &coordinates[2 * kept[after]];
        length += std::abs(double{way.slants[after]}) * std::hypot(next[0] - at[0], next[1] - at[1]);
    }
    if (way.closed)
        way.lengths.push_back(length);
    return way;
}

class ChainWriter {
public:
    // `quantum`: metres, of strokes whose long segments are divided; 0: of others.
    ChainWriter(bool with_guards, double quantum, Chains& chains)
        : with_guards_(with_guards), quantum_(quantum), chains_(chains) {}

    void write(const Way& way) {
        if (way.size() == 0)
            return;
        if (way.leaves_lattice())
            write_cut(way);
        else
            write_whole(way);
    }

private:
    void write_whole(const Way& way) {
        std::vector<ChainVertex> vertices;
        for (size_t i = 0; i < way.size(); ++i) {
            const LatticePoint point = rounded(way.places[i]);
            const bool bends = way.slants[i] < 0.0F;
            if (vertices.empty() || !(vertices.back().point == point))
                vertices.push_back({point, way.lengths[i], std::abs(way.slants[i]), bends});
            else
                vertices.back().plain &= bends;
        }
        while (way.closed && vertices.size() > 1 && vertices.front().point == vertices.back().point)
            vertices.pop_back();
        const bool closed = way.closed && vertices.size() > 1;
        const LatticePoint before = closed ? vertices.back().point : vertices.front().point;
        const LatticePoint after = closed ? vertices[1].point : vertices.back().point;
        if (closed)
            vertices.push_back(vertices.front());  // whose length is that of the first one: its corner's
        write_chain(vertices, before, after);
    }

    // Each segment by itself. Ends made by cutting have no corner and no cap.
    void write_cut(const Way& way) {
        for (size_t i = 0; way.size() > 1 && i < way.segments(); ++i) {
            const Place a = way.place(i), b = way.place(i + 1);
            const Share kept = share_on_lattice(a, b);
            if (kept.empty())
                continue;
            const LatticePoint from = cut_end(a, b, kept.first), to = cut_end(a, b, kept.last);
            if (from == to)
                continue;
            const double begin = way.lengths[i], step = way.lengths[i + 1] - begin;
            const float last = way.slants[(i + 1) % way.size()], slant = std::abs(last);
            const bool starts_plain = kept.first > 0.0 || way.slants[i] < 0.0F;
            const bool ends_plain = kept.last < 1.0 || last < 0.0F;
            write_chain({{from, begin + std::max(kept.first, 0.0) * step, slant, starts_plain},
                         {to, begin + std::min(kept.last, 1.0) * step, slant, ends_plain}},
                        neighbour(way, i, way.size() - 1, from), neighbour(way, i + 1, 1, to));
        }
    }

    // The next vertex on the lattice that is another one, `step` by `step`, or where it is left; `end` itself
    // where the way ends.
    static LatticePoint neighbour(const Way& way, size_t at, size_t step, LatticePoint end) {
        for (size_t tried = 1; tried < way.size(); ++tried) {
            const bool forward = step == 1;
            if (!way.closed && (forward ? at + 1 >= way.size() : at == 0))
                return end;
            const size_t next = (at + step) % way.size();
            const Place a = way.place(at), b = way.place(next);
            const Share kept = forward ? share_on_lattice(a, b) : share_on_lattice(b, a);
            const LatticePoint point = forward ? cut_end(a, b, kept.last) : cut_end(b, a, kept.first);
            if (!(point == end))
                return point;
            at = next;
        }
        return end;
    }

    void write_chain(const std::vector<ChainVertex>& vertices, LatticePoint before, LatticePoint after) {
        if (with_guards_)
            chains_.add(before);
        const auto first = static_cast<uint32_t>(chains_.vertices.size());
        for (size_t i = 0; i < vertices.size(); ++i) {
            if (i > 0)
                write_segment(vertices[i - 1], vertices[i]);
            chains_.add(vertices[i].point, vertices[i].length, vertices[i].slant);
        }
        if (vertices.size() == 1)
            chains_.segments.push_back({first, first});
        if (with_guards_)
            chains_.add(after);
    }

    // A segment from the last vertex, in pieces where it is long, to one that is not added yet.
    void write_segment(const ChainVertex& a, const ChainVertex& b) {
        const double dx = double(b.point.x) - a.point.x, dy = double(b.point.y) - a.point.y;
        const double length = std::hypot(dx, dy);
        const double longest = std::max(longest_piece, longest_piece_metres / std::max(quantum_, 1e-9));
        const int pieces = quantum_ > 0.0 ? static_cast<int>(std::ceil(length / longest)) : 1;
        for (int piece = 1; piece <= pieces; ++piece) {
            const auto from = static_cast<uint32_t>(chains_.vertices.size() - 1);
            const bool plain_a = piece > 1 || a.plain, plain_b = piece < pieces || b.plain;
            chains_.segments.push_back({from | (with_guards_ && plain_a ? PLAIN_END : 0),
                                        (from + 1) | (with_guards_ && plain_b ? PLAIN_END : 0)});
            if (piece == pieces)
                break;
            const double share = double(piece) / pieces;
            chains_.add({a.point.x + static_cast<int32_t>(std::lrint(share * dx)),
                         a.point.y + static_cast<int32_t>(std::lrint(share * dy))},
                        a.length + share * length * quantum_ * double{b.slant}, b.slant);
        }
    }

    bool with_guards_;
    double quantum_;
    Chains& chains_;
};

class ChainLayer {
public:
    ChainLayer(const TechniqueInput& input, Span<const StrokeSlot> strokes, const Lattice& lattice,
               GroupBuild& group, MemoryCharge& charge, WorkingArray<Segment>& segments)
        : input_(input),
          strokes_(strokes),
          lattice_(lattice),
          group_(group),
          charge_(charge),
          segments_(segments) {}

    void lay() {
        MemoryCharge working(input_.memory, "static_bvh: working memory", 0);
        list_parts(working);
        for_parts([](Part& part, const Chains& chains) {
            part.vertices = static_cast<uint32_t>(chains.vertices.size());
            part.segments = static_cast<uint32_t>(chains.segments.size());
        });
        uint64_t vertices = 0, segments = 0;
        for (Part& part : parts_) {
            part.first_vertex = static_cast<uint32_t>(vertices);
            part.first_segment = static_cast<uint32_t>(segments);
            vertices += part.vertices;
            segments += part.segments;
            require_size(vertices, "vertices");
            require_size(segments, "segments");
        }
        grow(group_.vertices, vertices, "vertices", charge_);
        grow(group_.owners, vertices * group_.owner_size(), "vertices", charge_);
        grow(segments_.values, segments, "segments", segments_.charge);
        for_parts([this](const Part& part, const Chains& chains) { copy(part, chains); });
    }

private:
    void list_parts(MemoryCharge& working) {
        for (size_t i = 0; i < strokes_.size(); ++i) {
            const Features& features = strokes_[i].decal.layer->features;
            const size_t feature = strokes_[i].decal.feature();
            for (int64_t part = features.feature_offsets[feature];
                 part < features.feature_offsets[feature + 1]; ++part)
                parts_.push_back({static_cast<uint32_t>(i), static_cast<size_t>(part), 0, 0, 0, 0});
        }
        require_size(parts_.size(), "parts");
        working.resize(parts_.size() * sizeof(Part));
    }

    template <typename OnPart>
    void for_parts(OnPart on_part) {
        parallel_for(parts_.size(), parts_at_once, input_.threads, [&](size_t begin, size_t end) {
            Chains chains;
            for (size_t i = begin; i < end; ++i) {
                chains.clear();
                const DecalView& decal = strokes_[parts_[i].stroke].decal;
                const double quantum = decal.style().pattern.period > 0.0 ? lattice_.quantum : 0.0;
                const Features& features = decal.layer->features;
                ChainWriter(group_.needs.corners, quantum, chains)
                    .write(way_of(features.part(parts_[i].index), features.slants_of(parts_[i].index),
                                  follows_ground(decal.style()), features.kind == FeatureKind::polygons,
                                  lattice_));
                require_size(chains.vertices.size(), "vertices");
                on_part(parts_[i], chains);
            }
        });
    }

    void copy(const Part& part, const Chains& chains) {
        const StrokeSlot& stroke = strokes_[part.stroke];
        std::copy(chains.vertices.begin(), chains.vertices.end(),
                  group_.vertices.begin() + part.first_vertex);
        const size_t size = group_.owner_size();
        for (size_t i = 0; i < chains.vertices.size(); ++i) {
            uint32_t* owner = &group_.owners[size * (part.first_vertex + i)];
            const float phase = phase_at(chains.lengths[i], stroke.decal.style().pattern);
            owner[0] = stroke.slot;
            if (group_.needs.patterns)
                std::memcpy(owner + 1, &phase, sizeof(phase));
            if (group_.needs.ground)
                std::memcpy(owner + 2, &chains.slants[i], sizeof(float));
        }
        for (size_t i = 0; i < chains.segments.size(); ++i) {
            const Segment& each = chains.segments[i];
            segments_.values[part.first_segment + i] =
                from_lower_left({each.a + part.first_vertex, each.b + part.first_vertex});
        }
    }

    // So that lines over each other are at the same distance to the last digit.
    Segment from_lower_left(Segment segment) const {
        const LatticePoint p = group_.vertices[segment.first()], q = group_.vertices[segment.second()];
        return q.x < p.x || (q.x == p.x && q.y < p.y) ? Segment{segment.b, segment.a} : segment;
    }

    // In double, since a line may be long.
    float phase_at(double length, const LinePattern& pattern) const {
        if (!(pattern.period > 0.0))
            return 0.0F;
        const double phase = std::fmod(length + pattern.offset, pattern.period);
        return static_cast<float>((phase < 0.0 ? phase + pattern.period : phase) / lattice_.quantum);
    }

    const TechniqueInput& input_;
    Span<const StrokeSlot> strokes_;
    const Lattice& lattice_;
    GroupBuild& group_;
    MemoryCharge& charge_;
    WorkingArray<Segment>& segments_;
    std::vector<Part> parts_;
};

}  // namespace

void lay_chains(const TechniqueInput& input, Span<const StrokeSlot> strokes, const Lattice& lattice,
                GroupBuild& group, MemoryCharge& charge, WorkingArray<Segment>& segments) {
    ChainLayer(input, strokes, lattice, group, charge, segments).lay();
}

}  // namespace decalgl::bvh
