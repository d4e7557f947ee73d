// Other looks for prepared lines, and their place in a file.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/archive.h"
#include "core/growing_array.h"
#include "decalgl/core/error.h"
#include "technique/decal_looks.h"
#include "technique/dynamic_lines/line_edits.h"
#include "technique/dynamic_lines/prepared_lines.h"

namespace decalgl {
namespace {

// Without padding, since its bytes go into the file.
struct LineFileRecord {
    LineLattice lattice;
    double cell;
    uint64_t segments;
    LineMethod method;
    LineWidthRule width_rule;
};
static_assert(sizeof(LineFileRecord) == 48, "saved as it is");

void apply(const DecalLook& look, size_t feature, LineStyle& style) {
    if (!look.colors.empty())
        set_color(style, look.color(feature));
    if (!look.widths.empty())
        set_width(style, look.width(feature));
}

// Every line's vertices follow each other and name it, and its slot is there.
bool fit_together(const PreparedLines& lines) {
    uint64_t next = 0;
    for (size_t i = 0; i < lines.lines.size(); ++i) {
        const LineRecord& line = lines.lines[i];
        if (line.first != next || line.count < 2 || line.slot >= lines.slots.size())
            return false;
        next += line.count;
        if (next > lines.vertices.size())
            return false;
        for (uint64_t vertex = line.first; vertex < next; ++vertex) {
            const SourceVertex& source = lines.vertices[vertex];
            if (source.line != i || std::abs(source.place.x) > lattice_reach ||
                std::abs(source.place.y) > lattice_reach)
                return false;
        }
    }
    return next == lines.vertices.size() && lines.styles.size() == lines.slots.size();
}

// Every style's pattern is in the table with all its marks.
bool have_patterns(const PreparedLines& lines) {
    return std::all_of(lines.styles.begin(), lines.styles.end(), [&](const LineStyle& style) {
        if (style.pattern == NO_PATTERN)
            return true;
        if (style.pattern >= lines.patterns.size())
            return false;
        const PatternTexel& head = lines.patterns[style.pattern];
        return head[0] >= 1.0F && head[0] <= static_cast<float>(most_pattern_marks) && head[3] > 0.0F &&
               static_cast<size_t>(head[0]) < lines.patterns.size() - style.pattern;
    });
}

}  // namespace

LayerLook PreparedLines::look_of(uint32_t layer, size_t features) const {
    return layer_look(
        slots, layer, features,
        [&](size_t i) { return reinterpret_cast<const uint8_t*>(&styles[i].own_color); },
        [&](size_t i) { return width_of(styles[i]); });
}

std::shared_ptr<const Prepared> PreparedLines::restyled(Span<const LayerLook> looks,
                                                        const MemoryAccount& memory) const {
    auto result = std::make_shared<PreparedLines>(*this);
    for (const LayerLook& look : looks)
        if (!look.draw_order.empty())
            result = reordered(*result, look.layer, look.draw_order, memory);
    std::vector<LineStyle> changed(result->styles.begin(), result->styles.end());
    for (const LayerLook& look : looks)
        for (size_t slot = 0; slot < changed.size(); ++slot) {
            const Decal& decal = result->slots[slot];
            if (decal.feature.layer == look.layer && look.of(decal.role) != nullptr)
                apply(*look.of(decal.role), decal.feature.feature, changed[slot]);
        }
    result->styles = charged(SharedArray<LineStyle>(std::move(changed)), memory, "dynamic: prepared");
    result->summarise();
    return result;
}

void PreparedLines::save(ArchiveWriter& archive, const std::string& prefix) const {
    archive.add_value(prefix + "record", LineFileRecord{lattice, cell, segments, method, width_rule});
    archive.add(prefix + "vertices", vertices.span());
    archive.add(prefix + "lines", lines.span());
    archive.add(prefix + "styles", styles.span());
    archive.add(prefix + "slots", slots.span());
    archive.add(prefix + "patterns", patterns.span());
}

std::unique_ptr<PreparedLines> open_lines(const ArchiveReader& archive, const std::string& prefix) {
    auto lines = std::make_unique<PreparedLines>();
    const auto record = archive.value<LineFileRecord>(prefix + "record");
    lines->lattice = record.lattice;
    lines->cell = record.cell;
    lines->segments = record.segments;
    lines->method = record.method;
    lines->width_rule = record.width_rule;
    lines->vertices = archive.array<SourceVertex>(prefix + "vertices");
    lines->lines = archive.array<LineRecord>(prefix + "lines");
    lines->styles = archive.array<LineStyle>(prefix + "styles");
    lines->slots = archive.array<Decal>(prefix + "slots");
    lines->patterns = archive.array<PatternTexel>(prefix + "patterns");
    int exponent = 0;
    const bool is_lattice = std::isfinite(record.lattice.origin_x) &&
                            std::isfinite(record.lattice.origin_y) && std::isfinite(record.lattice.quantum) &&
                            std::frexp(record.lattice.quantum, &exponent) == 0.5;
    const bool is_known = record.method <= LineMethod::lists && record.width_rule <= LineWidthRule::thesis &&
                          record.cell >= 0.0 && std::isfinite(record.cell);
    if (!is_lattice || !is_known || !fit_together(*lines) || !have_patterns(*lines))
        archive.refuse("the dynamic lines do not fit together");
    lines->summarise();
    return lines;
}

}  // namespace decalgl
