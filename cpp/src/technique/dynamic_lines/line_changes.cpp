// Other looks for prepared lines, and their place in a file.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/archive.h"
#include "core/growing_array.h"
#include "decalgl/core/error.h"
#include "technique/decal_looks.h"
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
        std::memcpy(&style.color, look.color(feature), 4);
    if (!look.widths.empty())
        style.half_width = static_cast<float>(0.5 * look.width(feature));
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

}  // namespace

LayerLook PreparedLines::look_of(uint32_t layer, size_t features) const {
    return layer_look(
        slots, layer, features, [&](size_t i) { return reinterpret_cast<const uint8_t*>(&styles[i].color); },
        [&](size_t i) { return 2.0 * static_cast<double>(styles[i].half_width); });
}

std::shared_ptr<const Prepared> PreparedLines::restyled(Span<const LayerLook> looks,
                                                        const MemoryAccount& memory) const {
    auto result = std::make_shared<PreparedLines>(*this);
    std::vector<LineStyle> changed(styles.begin(), styles.end());
    for (const LayerLook& look : looks) {
        if (!look.draw_order.empty())
            throw Error(ErrorKind::unsupported,
                        "technique 'dynamic' keeps its draw order; prepare the scene anew for another one");
        for (size_t slot = 0; slot < slots.size(); ++slot)
            if (slots[slot].feature.layer == look.layer && look.of(slots[slot].role) != nullptr)
                apply(*look.of(slots[slot].role), slots[slot].feature.feature, changed[slot]);
    }
    result->styles = charged(SharedArray<LineStyle>(std::move(changed)), memory, "dynamic: prepared");
    result->summarise();
    return result;
}

std::shared_ptr<const Prepared> PreparedLines::edited(const LayerEdit&, const MemoryAccount&) const {
    throw Error(ErrorKind::unsupported,
                "technique 'dynamic' cannot edit its lines; prepare the scene anew with the new ones");
}

void PreparedLines::save(ArchiveWriter& archive, const std::string& prefix) const {
    archive.add_value(prefix + "record", LineFileRecord{lattice, cell, segments, method, width_rule});
    archive.add(prefix + "vertices", vertices.span());
    archive.add(prefix + "lines", lines.span());
    archive.add(prefix + "styles", styles.span());
    archive.add(prefix + "slots", slots.span());
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
    int exponent = 0;
    const bool is_lattice = std::isfinite(record.lattice.origin_x) &&
                            std::isfinite(record.lattice.origin_y) && std::isfinite(record.lattice.quantum) &&
                            std::frexp(record.lattice.quantum, &exponent) == 0.5;
    const bool is_known = record.method <= LineMethod::lists && record.width_rule <= LineWidthRule::thesis &&
                          record.cell >= 0.0 && std::isfinite(record.cell);
    if (!is_lattice || !is_known || !fit_together(*lines))
        archive.refuse("the dynamic lines do not fit together");
    lines->summarise();
    return lines;
}

}  // namespace decalgl
