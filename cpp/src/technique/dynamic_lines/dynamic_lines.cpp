#include "technique/dynamic_lines/dynamic_lines.h"

#include <utility>

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
    if (!has_same_lines) {
        prepared_.reset();
        lines_ = MatchedLines();
        segments_ = SegmentList();
        if (next->shows_anything()) {
            lines_ = match_lines(*next, terrain, memory, programs_);
            segments_ = all_segments(lines_, memory, programs_);
        }
    }
    looks_.upload(*next, next_lens.get(), memory);
    if (!bins_)
        bins_ = std::make_unique<LineBins>(memory);
    prepared_ = std::move(next);
    lens_ = std::move(next_lens);
}

UpdateReport DynamicLines::update(const View& view) {
    UpdateReport report;
    report.pieces = lines_.segment_count;
    if (lines_.segment_count > 0)
        bins_->update(view, lines_, segments_, looks_, programs_);
    report.bytes = lines_.vertices.buffer().bytes() + lines_.lines.buffer().bytes() +
                   segments_.segments.buffer().bytes() + looks_.bytes() + bins_->bytes();
    report.counts = {{"dynamic_vertices", lines_.vertex_count},
                     {"dynamic_segments", lines_.segment_count},
                     {"dynamic_tile_entries", bins_->entries()}};
    return report;
}

void DynamicLines::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    bins_->draw(view, gbuffer, looks_, programs);
}

void DynamicLines::draw_ids(const View&, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    bins_->draw_ids(gbuffer, looks_, programs);
}

}  // namespace decalgl
