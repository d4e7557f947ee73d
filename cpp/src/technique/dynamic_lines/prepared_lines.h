// Prepared dynamic lines: vertices, lines and styles as flat arrays, in draw order from bottom to top.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "decalgl/core/shared_array.h"
#include "decalgl/technique/dynamic_options.h"
#include "decalgl/technique/technique.h"
#include "technique/dynamic_lines/line_buffers.h"
#include "technique/dynamic_lines/line_lattice.h"
#include "technique/dynamic_lines/line_styles.h"
#include "technique/dynamic_lines/line_writer.h"
#include "technique/dynamic_lines/style_records.h"

namespace decalgl {

// What styles have in common.
struct LineSummary {
    bool has_shown = false;
    bool has_hidden = false;
    bool has_translucency = false;
    bool has_one_look = true;  // of all that is shown
    bool is_joined = false;    // some corner or cap is not round, or has a place in a pattern
    bool is_styled = false;    // patterns, or colours across
    bool has_arcs = false;     // some style is such, and be it hidden: vertices know their way along the line
    bool has_sides = false;    // inset or offset outlines
    bool has_limits = false;   // or metres
};

// What edits need to know of a layer: how many features it has had, and the records of a feature but for colours and widths.
struct LineTemplate {
    uint32_t features = 0;
    std::vector<LineStyle> casing;
    std::vector<LineStyle> stroke;
};
using LineTemplates = std::map<uint32_t, LineTemplate>;  // by layer

class PreparedLines : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return slots[id].feature; }
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    bool shows_anything() const override { return summary.has_shown; }
    LayerLook look_of(uint32_t layer, size_t features) const override;
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;

    void summarise();

    LineLattice lattice;
    SharedArray<SourceVertex> vertices;
    SharedArray<LineRecord> lines;
    SharedArray<LineStyle> styles;  // one a slot
    SharedArray<Decal> slots;
    SharedArray<PatternTexel> patterns;
    std::shared_ptr<const LineTemplates> templates;  // null where it was opened from a file
    LineMethod method = LineMethod::automatic;
    LineWidthRule width_rule = LineWidthRule::screen;
    double cell = 0.125;
    uint64_t segments = 0;
    LineSummary summary;
};

LinePurpose purpose_of(const LineStyle& style, uint32_t slot, Span<const PatternTexel> patterns);

// Of lines with the same vertices: whether all else that shows is as it was, and in the same places.
bool differ_in_color_alone(const PreparedLines& a, const PreparedLines& b);

// Throws Error(memory), Error(unsupported), Error(cancelled).
std::unique_ptr<PreparedLines> prepare_lines(const TechniqueInput& input, Progress& progress);

// What PreparedLines::save wrote. Throws Error(file) where it does not fit together.
std::unique_ptr<PreparedLines> open_lines(const ArchiveReader& archive, const std::string& prefix);

}  // namespace decalgl
