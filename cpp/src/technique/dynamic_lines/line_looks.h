// How the lines look, on the GPU; with a lens, what is seen inside it follows.
#pragma once

#include "gl/buffer.h"
#include "gl/program.h"
#include "technique/dynamic_lines/prepared_lines.h"

namespace decalgl {

// How far the widest line reaches from its middle, at any depth: so many pixels and so many metres seen head-on.
struct LineReach {
    float px = 0.0F;
    float metres = 0.0F;
};

class LineLooks {
public:
    void upload(const PreparedLines& prepared, const PreparedLines* lens, const MemoryAccount& memory);

    // Styles at a unit of the program's choice, patterns at one that nothing else takes.
    void bind(gl::Program& program, GLuint unit) const;
    // What all programs that read looks have to know of them.
    gl::Flags flags() const;
    const LineSummary& summary() const { return summary_; }  // of both sides of the lens
    LineReach reach() const { return reach_; }
    bool has_lens() const { return lens_texels_ > 0; }
    uint64_t bytes() const { return styles_.buffer().bytes() + patterns_.buffer().bytes(); }

private:
    gl::TextureBuffer styles_;
    gl::TextureBuffer patterns_;
    int first_octave_ = 0;
    LineSummary summary_;
    LineReach reach_;
    int lens_texels_ = 0;  // where the styles inside the lens begin; 0: none
};

}  // namespace decalgl
