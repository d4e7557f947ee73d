// The fields of a picture: arrays of one layer for each category (Trapp et al. 2015, sections 5.1 and 5.4).
//
//     bytes = categories * width * height * targets * bytes of a texel
#pragma once

#include "decalgl/core/memory.h"
#include "gl/texture.h"

namespace decalgl::network {

struct FieldFormat {
    int width = 0;
    int height = 0;
    int layers = 0;
    int bits = 8;
    bool angles = false;  // a second channel of the cross field
    bool lengths = false;
    bool depths = false;
    bool nearest = false;  // a depth buffer, by which the nearest segment's fields are kept

    bool operator==(const FieldFormat& other) const;
};

class FieldTargets {
public:
    FieldTargets() = default;
    // Throws Error(memory).
    FieldTargets(const FieldFormat& format, const MemoryAccount& memory);

    // Binds and clears them for drawing, as far from everything as a field reaches.
    void begin() const;
    const FieldFormat& format() const { return format_; }
    size_t bytes() const { return cross.bytes() + length.bytes() + depth.bytes() + nearest.bytes(); }

    gl::Texture2D cross;
    gl::Texture2D length;
    gl::Texture2D depth;
    gl::Texture2D nearest;

private:
    FieldFormat format_;
    gl::Framebuffer framebuffer_;
};

}  // namespace decalgl::network
