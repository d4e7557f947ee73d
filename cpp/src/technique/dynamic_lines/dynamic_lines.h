// Dynamic lines: lines of constant size on the screen (Zechmeister 2020, sections 3.2.2 and 3.3).
#pragma once

#include <memory>

#include "gl/program.h"
#include "technique/dynamic_lines/bins.h"
#include "technique/dynamic_lines/line_blocks.h"
#include "technique/dynamic_lines/line_looks.h"
#include "technique/dynamic_lines/line_set.h"
#include "technique/dynamic_lines/lists.h"
#include "technique/dynamic_lines/prepared_lines.h"
#include "technique/dynamic_lines/update_segments.h"

namespace decalgl {

class DynamicLines : public Technique {
public:
    std::string name() const override { return "dynamic"; }
    std::unique_ptr<const Prepared> preprocess(const TechniqueInput& input,
                                               Progress& progress) const override;
    std::unique_ptr<const Prepared> open(const ArchiveReader& archive, const std::string& prefix,
                                         const MemoryAccount& memory) const override;
    void upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                const TerrainView& terrain, const MemoryAccount& memory) override;
    UpdateReport update(const View& view) override;
    bool keeps_update() const override { return keeps_update_; }
    SlopeUse slope_use() const override { return SlopeUse::strokes; }
    void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;
    void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;

private:
    LineMethod method_for(const View& view) const;
    ListedLines listed() const;

    gl::ProgramLibrary programs_;  // of upload and update
    MemoryAccount memory_;
    std::shared_ptr<const PreparedLines> prepared_;
    std::shared_ptr<const PreparedLines> lens_;  // null without one
    LineBlocks blocks_;
    MatchedLines lines_;
    std::unique_ptr<SegmentUpdate> segments_;  // null without lines
    LineLooks looks_;
    glm::vec2 ground_heights_{0.0F};        // the lowest and the highest of the terrain
    LineMethod method_ = LineMethod::bins;  // of the latest view
    bool keeps_update_ = false;             // the latest upload changed colours alone
    std::unique_ptr<LineBins> bins_;
    std::unique_ptr<LineLists> lists_;
};

}  // namespace decalgl
