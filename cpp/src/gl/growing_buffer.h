// A texture buffer of an array that grows at its end: only what was added is uploaded.
#pragma once

#include <memory>
#include <string>

#include "core/growing_array.h"
#include "gl/buffer.h"
#include "gl/gl.h"

namespace decalgl::gl {

class GrowingBuffer {
public:
    // Makes the buffer hold the array, with room for what edits may add.
    template <typename T>
    void upload(const GrownArray<T>& array, GLenum format, const std::string& name,
                const MemoryAccount& memory) {
        const SharedArray<T>& values = array.values();
        const bool starts_alike = buffer_ && (data_ == values.data() || data_ == array.origin());
        if (!starts_alike || values.size_bytes() > buffer_.buffer().bytes()) {
            buffer_ = TextureBuffer();
            const size_t room = values.size() + values.size() / 16 + 1024;
            const size_t most = std::max(values.size(), most_texels);
            buffer_ =
                TextureBuffer::create(memory, name, format, sizeof(T) * (std::min(room, most) / 4 * 4 + 4),
                                      nullptr, GL_DYNAMIC_STORAGE_BIT);
            uploaded_ = 0;
        }
        held_ = values.storage();
        data_ = values.data();
        if (values.size() <= uploaded_)
            return;
        buffer_.buffer().update(sizeof(T) * uploaded_, sizeof(T) * (values.size() - uploaded_),
                                values.data() + uploaded_);
        uploaded_ = values.size();
    }

    // Whether it begins with the array's values.
    template <typename T>
    bool holds(const GrownArray<T>& array) const {
        return buffer_ && data_ == array.data() && array.size() <= uploaded_;
    }

    void bind(GLuint unit) const { buffer_.bind(unit); }
    size_t bytes() const { return buffer_.buffer().bytes(); }
    explicit operator bool() const { return static_cast<bool>(buffer_); }

private:
    // Drivers address this many as a rule: no room is added beyond.
    static constexpr size_t most_texels = (size_t{1} << 27) - 4;

    TextureBuffer buffer_;
    std::shared_ptr<const void>
        held_;  // whose first values are there, so that no other array lies at its place
    const void* data_ = nullptr;
    size_t uploaded_ = 0;
};

}  // namespace decalgl::gl
