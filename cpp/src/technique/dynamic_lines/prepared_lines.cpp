#include "technique/dynamic_lines/prepared_lines.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/growing_array.h"
#include "decalgl/core/error.h"
#include "decalgl/core/large_array.h"

namespace decalgl {
namespace {

constexpr uint64_t most_vertices = uint64_t{1} << 31;

uint32_t packed(const uint8_t* color) {
    uint32_t word = 0;
    std::memcpy(&word, color, 4);
    return word;
}

float limit_of(double width) {
    return static_cast<float>(0.5 * width);
}

LineStyle style_of(const DecalView& view) {
    const Stroke& stroke = view.stroke();
    const StrokeStyle& style = view.style();
    const bool is_limited = stroke.limits.any();
    LineStyle record{};
    record.color = packed(view.color());
    record.half_width = static_cast<float>(view.half_width());
    record.kind = static_cast<uint32_t>(style.corner) | static_cast<uint32_t>(style.cap) << CAP_SHIFT |
                  (stroke.units == WidthUnits::metres ? IN_METRES : 0U) | (is_limited ? HAS_LIMITS : 0U) |
                  static_cast<uint32_t>(std::lrint(256.0 * style.miter_limit)) << MITER_SHIFT;
    record.least_px = limit_of(stroke.limits.least_px);
    record.most_px = limit_of(stroke.limits.most_px);
    record.least_metres = limit_of(stroke.limits.least_metres);
    record.most_metres = limit_of(stroke.limits.most_metres);
    return record;
}

[[noreturn]] void refuse(const Layer& layer, const std::string& what) {
    throw Error(ErrorKind::unsupported, "layer '" + layer.name + "': technique 'dynamic' " + what);
}

void require_drawable(const Layer& layer) {
    if (!layer.fill.empty())
        refuse(layer, "draws lines and outlines, but no fills; give technique='static', or color='none'");
    for (const Stroke* stroke : {&layer.stroke, &layer.casing}) {
        for (const StrokeStyle& style : stroke->styles) {
            if (style.slope_correction != SlopeCorrection::none)
                refuse(layer,
                       "knows no slope_correction, as its widths are those on the screen; leave it out");
            if (style.pattern.period > 0.0 || !style.bands.empty())
                refuse(layer, "draws neither dashes nor bands; leave them out, or give width_units='m'");
        }
    }
    if (layer.features.kind == FeatureKind::polygons && layer.outline_mode != OutlineMode::normal)
        refuse(layer, "draws outlines on both sides of the border alone; give mode='normal'");
}

struct Point {
    double x;
    double y;
};

// The stretch of a segment inside a box; false where there is none (Liang and Barsky).
bool clip(const Bounds& box, Point& a, Point& b) {
    const Point d{b.x - a.x, b.y - a.y};
    double first = 0.0, last = 1.0;
    const auto cut = [&](double step, double room) {
        if (step == 0.0)
            return room >= 0.0;
        const double at = room / step;
        (step < 0.0 ? first : last) = step < 0.0 ? std::max(first, at) : std::min(last, at);
        return first <= last;
    };
    if (!(cut(-d.x, a.x - box.min_x) && cut(d.x, box.max_x - a.x) && cut(-d.y, a.y - box.min_y) &&
          cut(d.y, box.max_y - a.y)))
        return false;
    const Point from = a;
    if (last < 1.0)
        b = {from.x + last * d.x, from.y + last * d.y};
    if (first > 0.0)
        a = {from.x + first * d.x, from.y + first * d.y};
    return true;
}

// Puts parts into lines, one after the other.
class LineWriter {
public:
    LineWriter(const LineLattice& lattice, const MemoryAccount& memory)
        : lattice_(lattice), box_(lattice.box()), charge_(memory, "dynamic: working memory", 0) {}

    void add(const Features& features, size_t feature, uint32_t slot) {
        const bool rings = features.kind == FeatureKind::polygons;
        for (auto part = features.feature_offsets[feature]; part < features.feature_offsets[feature + 1];
             ++part)
            add_part(features.part(static_cast<size_t>(part)), rings, slot);
        const uint64_t bytes = vertices.size() * sizeof(SourceVertex) + lines.size() * sizeof(LineRecord);
        if (bytes > charge_.bytes() + step_bytes)
            charge_.resize(bytes);
        if (vertices.size() > most_vertices)
            throw Error(ErrorKind::memory, "dynamic lines hold at most 2^31 vertices; draw a part of them");
    }

    std::vector<SourceVertex> vertices;
    std::vector<LineRecord> lines;
    uint64_t segments = 0;

private:
    static constexpr uint64_t step_bytes = 1 << 20;

    void add_part(Span<const double> xy, bool ring, uint32_t slot) {
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
        write(chain, closed, slot);
    }

    // A line for each stretch inside the lattice's box.
    void write(const std::vector<Point>& chain, bool closed, uint32_t slot) {
        first_ = vertices.size();
        bool is_whole = true;
        double arc = 0.0;
        if (chain.size() == 1) {
            Point a = chain[0], b = a;
            if (!clip(box_, a, b))
                return;
            push(a, 0.0);
            push(a, 0.0);
        }
        for (size_t i = 0; i + 1 < chain.size(); ++i) {
            Point a = chain[i], b = chain[i + 1];
            const double length = std::hypot(b.x - a.x, b.y - a.y);
            const bool inside = clip(box_, a, b);
            const bool is_cut = !inside || a.x != chain[i].x || a.y != chain[i].y;
            if (is_cut) {
                is_whole = false;
                finish(slot, false);
            }
            if (inside) {
                if (vertices.size() == first_)
                    push(a, arc + std::hypot(a.x - chain[i].x, a.y - chain[i].y));
                push(b, arc + std::hypot(b.x - chain[i].x, b.y - chain[i].y));
                if (b.x != chain[i + 1].x || b.y != chain[i + 1].y) {
                    is_whole = false;
                    finish(slot, false);
                }
            }
            arc += length;
        }
        finish(slot, closed && is_whole);
    }

    // Vertices that fall on one place of the lattice are one, but a line keeps two.
    void push(Point point, double arc) {
        const ivec2 place = lattice_.place(point.x, point.y);
        if (vertices.size() > first_ + 1 && vertices.back().place == place)
            return;
        vertices.push_back({place, static_cast<float>(arc), static_cast<uint32_t>(lines.size())});
    }

    void finish(uint32_t slot, bool closed) {
        const size_t count = vertices.size() - first_;
        if (count >= 2)
            lines.push_back({static_cast<uint32_t>(first_), static_cast<uint32_t>(count), slot,
                             closed ? LINE_CLOSED : 0U});
        else
            vertices.resize(first_);
        first_ = vertices.size();
    }

    LineLattice lattice_;
    Bounds box_;
    MemoryCharge charge_;
    size_t first_ = 0;  // vertex of the line in hand
};

bool looks_alike(const LineStyle& a, const LineStyle& b) {
    return std::memcmp(&a, &b, sizeof(LineStyle)) == 0;
}

}  // namespace

std::unique_ptr<PreparedLines> prepare_lines(const TechniqueInput& input, Progress& progress) {
    auto prepared = std::make_unique<PreparedLines>();
    for (const Layer& layer : input.layers)
        require_drawable(layer);
    if (const auto* options = dynamic_cast<const DynamicOptions*>(input.layers[0].technique.options.get())) {
        prepared->method = options->method;
        prepared->width_rule = options->width_rule;
        prepared->cell = options->cell;
    }
    prepared->lattice = LineLattice::over(input.bounds);
    std::vector<Decal> slots = decals_of(input.layers, input.first_layer, Hidden::kept);
    std::vector<LineStyle> styles;
    LineWriter writer(prepared->lattice, input.memory);
    for (size_t slot = 0; slot < slots.size(); ++slot) {
        const DecalView view{&input.layers[slots[slot].feature.layer - input.first_layer], slots[slot]};
        styles.push_back(style_of(view));
        writer.add(view.layer->features, view.feature(), static_cast<uint32_t>(slot));
        if (slot % 4096 == 0)
            progress.report(static_cast<double>(slot) / static_cast<double>(slots.size()));
    }
    prepared->segments = writer.segments;
    const auto keep = [&](auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        return charged(SharedArray<Value>(std::move(values)), input.memory, "dynamic: prepared");
    };
    prepared->vertices = keep(writer.vertices);
    prepared->lines = keep(writer.lines);
    prepared->styles = keep(styles);
    prepared->slots = keep(slots);
    prepared->summarise();
    progress.report(1.0);
    return prepared;
}

void PreparedLines::summarise() {
    summary = {};
    const LineStyle* first = nullptr;
    for (const LineStyle& style : styles) {
        const uint32_t alpha = style.color >> 24;
        if (alpha == 0) {
            summary.has_hidden = true;
            continue;
        }
        summary.has_shown = true;
        summary.has_translucency |= alpha != 255;
        summary.is_joined |= (style.kind & (CORNER_MASK | 3U << CAP_SHIFT)) != 0;
        summary.has_limits |= (style.kind & (IN_METRES | HAS_LIMITS)) != 0;
        if (first == nullptr)
            first = &style;
        summary.has_one_look &= looks_alike(*first, style);
    }
    summary.has_one_look &= !summary.has_hidden;
    summary.has_shown &= !lines.empty();
}

PreparedCounts PreparedLines::counts() const {
    return {slots.size(), segments, vertices.size(),
            vertices.size_bytes() + lines.size_bytes() + styles.size_bytes() + slots.size_bytes(),
            0.5 * std::sqrt(2.0) * lattice.quantum};
}

}  // namespace decalgl
