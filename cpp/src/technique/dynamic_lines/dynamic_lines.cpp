#include "technique/dynamic_lines/dynamic_lines.h"

#include <utility>

#include "decalgl/core/error.h"
#include "decalgl/terrain/heightfield.h"

namespace decalgl {
std::unique_ptr<const Prepared> DynamicLines::preprocess(const TechniqueInput& input,
                                                         Progress& progress) const {
    return prepare_lines(input, progress);
}

std::unique_ptr<const Prepared> DynamicLines::open(const ArchiveReader& archive, const std::string& prefix,
                                                   const MemoryAccount&) const {
    return open_lines(archive, prefix);
}

void DynamicLines::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                          const TerrainView& terrain, const MemoryAccount& memory) {
    memory_ = memory;
    auto next = std::static_pointer_cast<const PreparedLines>(std::move(prepared));
    auto next_lens = std::static_pointer_cast<const PreparedLines>(std::move(lens));
    const bool has_same_lines = prepared_ && prepared_->vertices.data() == next->vertices.data();
    keeps_update_ = has_same_lines && differ_in_color_alone(*prepared_, *next) && !lens_ == !next_lens &&
                    (!lens_ || differ_in_color_alone(*lens_, *next_lens));
    if (!has_same_lines) {
        prepared_.reset();
        segments_.reset();
        lines_ = MatchedLines();
        blocks_ = LineBlocks();
        if (next->shows_anything() || (next_lens && next_lens->shows_anything())) {
            blocks_ = LineBlocks(*next);
            lines_ = match_lines(*next, terrain, memory, programs_);
            ground_heights_ = {terrain.samples->lowest(), terrain.samples->highest()};
            segments_ = std::make_unique<SegmentUpdate>(lines_, next->cell, ground_heights_, memory);
        }
    }
    lines_.ground = terrain.heights;
    looks_.upload(*next, next_lens.get(), memory);
    if (!bins_) {
        bins_ = std::make_unique<LineBins>(memory);
        lists_ = std::make_unique<LineLists>(memory);
    }
    prepared_ = std::move(next);
    lens_ = std::move(next_lens);
}

// Lists have widths by the thesis's rule. Bins have coverage, and were faster at every count that was measured.
LineMethod DynamicLines::method_for(const View& view) const {
    const bool needs_bins = view.antialias == Antialias::coverage;
    const bool needs_lists = prepared_->width_rule == LineWidthRule::thesis;
    if (needs_bins && (needs_lists || prepared_->method == LineMethod::lists))
        throw Error(
            ErrorKind::unsupported,
            "dynamic lines by lists have no anti-aliasing by coverage; choose antialias 'fxaa', 'ssaa', "
            "'msaa' or 'none', or method 'bins' with width_rule 'screen'");
    if (needs_lists && prepared_->method == LineMethod::bins)
        throw Error(ErrorKind::unsupported,
                    "dynamic lines: method 'bins' has no width_rule 'thesis'; choose method 'lists'");
    if (prepared_->method != LineMethod::automatic)
        return prepared_->method;
    return needs_lists ? LineMethod::lists : LineMethod::bins;
}

ListedLines DynamicLines::listed() const {
    return {&lines_, &segments_->segments(), &looks_, prepared_->width_rule, ground_heights_};
}

UpdateReport DynamicLines::update(const View& view) {
    UpdateReport report;
    report.pieces = lines_.segment_count;
    if (segments_) {
        method_ = method_for(view);
        if (blocks_.may_show(view, ground_heights_, looks_.reach())) {
            const SegmentList& seen = segments_->run(view, looks_.reach(), programs_);
            if (method_ == LineMethod::bins)
                bins_->update(view, lines_, seen, looks_, programs_);
        } else {
            segments_->see_nothing();
            bins_->see_nothing();
        }
        segments_->report(report);
    }
    report.bytes += lines_.vertices.buffer().bytes() + lines_.lines.buffer().bytes() + looks_.bytes() +
                    bins_->bytes() + lists_->bytes();
    report.counts.emplace_back("dynamic_bins", method_ == LineMethod::bins ? 1 : 0);
    report.counts.emplace_back("dynamic_tile_entries", bins_->entries());
    return report;
}

void DynamicLines::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    if (method_ == LineMethod::lists)
        lists_->draw(view, gbuffer, listed(), programs);
    else
        bins_->draw(view, gbuffer, looks_, programs);
}

void DynamicLines::draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    if (method_ == LineMethod::lists)
        lists_->draw_ids(view, gbuffer, listed(), programs);
    else
        bins_->draw_ids(view, gbuffer, looks_, programs);
}

}  // namespace decalgl
