// A texture buffer of an array that grows at its end: only what was added is uploaded.
#pragma once

#include <string>

#include "core/growing_array.h"
#include "gl/buffer.h"
#include "gl/gl.h"

namespace decalgl {

class GrowingBuffer {
public:
    // Makes the buffer hold `values`, with room for what edits may add.
    void upload(const SharedArray<uint32_t>& values, const GrowingArray<uint32_t>& growing, GLenum format,
                const std::string& name, const MemoryAccount& memory) {
        const bool starts_alike = held_.data() == values.data() || held_.data() == growing.origin();
        if (!buffer_ || !starts_alike || sizeof(uint32_t) * values.size() > buffer_.buffer().bytes()) {
            buffer_ = gl::TextureBuffer();
            const size_t room = values.size() + values.size() / 16 + 4096;
            buffer_ = gl::TextureBuffer::create(memory, name, format, sizeof(uint32_t) * (room / 4 * 4),
                                                nullptr, GL_DYNAMIC_STORAGE_BIT);
            uploaded_ = 0;
        }
        held_ = values;
        if (values.size() <= uploaded_)
            return;
        buffer_.buffer().update(sizeof(uint32_t) * uploaded_, sizeof(uint32_t) * (values.size() - uploaded_),
                                values.data() + uploaded_);
        uploaded_ = values.size();
    }

    void bind(GLuint unit) const { buffer_.bind(unit); }
    size_t bytes() const { return buffer_.buffer().bytes(); }

private:
    gl::TextureBuffer buffer_;
    SharedArray<uint32_t> held_;  // whose first values are there, so that no other array lies at its place
    size_t uploaded_ = 0;
};

}  // namespace decalgl
