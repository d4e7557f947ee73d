#include "gl/texture.h"

#include "decalgl/core/error.h"
#include "gl/context.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

namespace decalgl::gl {
namespace {

struct FormatRecord {
    GLenum format;
    std::size_t bytes;
    TransferFormat transfer;
};

constexpr FormatRecord format_records[] = {
    {GL_R8, 1, {GL_RED, GL_UNSIGNED_BYTE}},
    {GL_RG8, 2, {GL_RG, GL_UNSIGNED_BYTE}},
    {GL_RGBA8, 4, {GL_RGBA, GL_UNSIGNED_BYTE}},
    {GL_SRGB8_ALPHA8, 4, {GL_RGBA, GL_UNSIGNED_BYTE}},
    {GL_RGBA8_SNORM, 4, {GL_RGBA, GL_BYTE}},
    {GL_RGB10_A2, 4, {GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV}},
    {GL_R16, 2, {GL_RED, GL_UNSIGNED_SHORT}},
    {GL_RG16, 4, {GL_RG, GL_UNSIGNED_SHORT}},
    {GL_RG16_SNORM, 4, {GL_RG, GL_SHORT}},
    {GL_RGBA16, 8, {GL_RGBA, GL_UNSIGNED_SHORT}},
    {GL_R16F, 2, {GL_RED, GL_HALF_FLOAT}},
    {GL_RG16F, 4, {GL_RG, GL_HALF_FLOAT}},
    {GL_RGBA16F, 8, {GL_RGBA, GL_HALF_FLOAT}},
    {GL_R32F, 4, {GL_RED, GL_FLOAT}},
    {GL_RG32F, 8, {GL_RG, GL_FLOAT}},
    {GL_RGB32F, 12, {GL_RGB, GL_FLOAT}},
    {GL_RGBA32F, 16, {GL_RGBA, GL_FLOAT}},
    {GL_R8I, 1, {GL_RED_INTEGER, GL_BYTE}},
    {GL_R8UI, 1, {GL_RED_INTEGER, GL_UNSIGNED_BYTE}},
    {GL_RG8UI, 2, {GL_RG_INTEGER, GL_UNSIGNED_BYTE}},
    {GL_RGBA8UI, 4, {GL_RGBA_INTEGER, GL_UNSIGNED_BYTE}},
    {GL_R16I, 2, {GL_RED_INTEGER, GL_SHORT}},
    {GL_R16UI, 2, {GL_RED_INTEGER, GL_UNSIGNED_SHORT}},
    {GL_RG16I, 4, {GL_RG_INTEGER, GL_SHORT}},
    {GL_RG16UI, 4, {GL_RG_INTEGER, GL_UNSIGNED_SHORT}},
    {GL_RGBA16I, 8, {GL_RGBA_INTEGER, GL_SHORT}},
    {GL_RGBA16UI, 8, {GL_RGBA_INTEGER, GL_UNSIGNED_SHORT}},
    {GL_R32I, 4, {GL_RED_INTEGER, GL_INT}},
    {GL_R32UI, 4, {GL_RED_INTEGER, GL_UNSIGNED_INT}},
    {GL_RG32I, 8, {GL_RG_INTEGER, GL_INT}},
    {GL_RG32UI, 8, {GL_RG_INTEGER, GL_UNSIGNED_INT}},
    {GL_RGB32I, 12, {GL_RGB_INTEGER, GL_INT}},
    {GL_RGB32UI, 12, {GL_RGB_INTEGER, GL_UNSIGNED_INT}},
    {GL_RGBA32I, 16, {GL_RGBA_INTEGER, GL_INT}},
    {GL_RGBA32UI, 16, {GL_RGBA_INTEGER, GL_UNSIGNED_INT}},
    {GL_DEPTH_COMPONENT32F, 4, {GL_DEPTH_COMPONENT, GL_FLOAT}},
    {GL_DEPTH32F_STENCIL8, 8, {GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV}},
};

const FormatRecord& record_of(GLenum format) {
    for (const FormatRecord& record : format_records) {
        if (record.format == format) {
            return record;
        }
    }
    throw Error(ErrorKind::graphics,
                fmt::format("The texture format 0x{:04x} is not one this library uses.", format));
}

void check_size(const std::string& name, int width, int height, int levels) {
    if (width < 1 || height < 1 || levels < 1) {
        throw Error(ErrorKind::input,
                    fmt::format("The texture {} cannot be {} x {} texels with {} levels; each "
                                "must be at least 1.",
                                name, width, height, levels));
    }
    const int limit = Context::require_current().info().max_texture_size;
    if (width > limit || height > limit) {
        throw Error(ErrorKind::memory,
                    fmt::format("The texture {} of {} x {} texels is larger than this driver's "
                                "limit of {} on a side. Make a smaller picture.",
                                name, width, height, limit));
    }
}

std::uint64_t storage_bytes(std::size_t texel, int width, int height, int levels, int samples) {
    std::uint64_t texels = 0;
    for (int level = 0; level < levels; ++level) {
        const auto level_width = static_cast<std::uint64_t>(std::max(1, width >> level));
        const auto level_height = static_cast<std::uint64_t>(std::max(1, height >> level));
        texels += level_width * level_height;
    }
    return texels * texel * static_cast<std::uint64_t>(std::max(1, samples));
}

}  // namespace

std::size_t texel_bytes(GLenum format) {
    return record_of(format).bytes;
}

TransferFormat transfer_format(GLenum format) {
    return record_of(format).transfer;
}

Texture2D Texture2D::create(const MemoryAccount& account, const std::string& name, GLenum format, int width,
                            int height, int levels, int samples) {
    check_size(name, width, height, levels);
    Texture2D texture;
    texture.charge_ =
        MemoryCharge(account, name, storage_bytes(texel_bytes(format), width, height, levels, samples));
    texture.format_ = format;
    texture.width_ = width;
    texture.height_ = height;
    texture.levels_ = levels;
    texture.samples_ = samples;
    GLuint id = 0;
    glCreateTextures(texture.target(), 1, &id);
    texture.handle_ = ObjectHandle(ObjectType::texture, id);
    if (samples > 0) {
        glTextureStorage2DMultisample(id, samples, format, width, height, GL_TRUE);
    } else {
        glTextureStorage2D(id, levels, format, width, height);
        texture.set_filter(GL_NEAREST, GL_NEAREST);
        texture.set_wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    }
    check_errors(fmt::format("creating the texture {} of {} x {}", name, width, height).c_str());
    return texture;
}

Texture2D Texture2D::create_array(const MemoryAccount& account, const std::string& name, GLenum format,
                                  int width, int height, int layers) {
    check_size(name, width, height, 1);
    GLint limit = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limit);
    if (layers < 1 || layers > limit) {
        throw Error(ErrorKind::memory,
                    fmt::format("The texture {} cannot have {} layers; this driver has 1 to {}.", name,
                                layers, limit));
    }
    Texture2D texture;
    texture.charge_ = MemoryCharge(
        account, name,
        storage_bytes(texel_bytes(format), width, height, 1, 0) * static_cast<std::uint64_t>(layers));
    texture.format_ = format;
    texture.width_ = width;
    texture.height_ = height;
    texture.levels_ = 1;
    texture.layers_ = layers;
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
    texture.handle_ = ObjectHandle(ObjectType::texture, id);
    glTextureStorage3D(id, 1, format, width, height, layers);
    texture.set_filter(GL_NEAREST, GL_NEAREST);
    texture.set_wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    check_errors(fmt::format("creating the texture {} of {} x {} x {}", name, width, height, layers).c_str());
    return texture;
}

void Texture2D::update_layer(int layer, const void* texels) {
    const TransferFormat transfer = transfer_format(format_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(id(), 0, 0, 0, layer, width_, height_, 1, transfer.format, transfer.type, texels);
    Context::require_current().uploads().add(storage_bytes(texel_bytes(format_), width_, height_, 1, 0));
}

void Texture2D::update(int level, int x, int y, int width, int height, const void* texels) {
    const TransferFormat transfer = transfer_format(format_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(id(), level, x, y, width, height, transfer.format, transfer.type, texels);
    Context::require_current().uploads().add(storage_bytes(texel_bytes(format_), width, height, 1, 0));
}

void Texture2D::set_filter(GLenum minify, GLenum magnify) {
    glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
    glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
}

void Texture2D::set_wrap(GLenum wrap_s, GLenum wrap_t) {
    glTextureParameteri(id(), GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap_s));
    glTextureParameteri(id(), GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap_t));
}

void Texture2D::bind(GLuint unit) const {
    glBindTextureUnit(unit, id());
}

void Texture2D::bind_image(GLuint unit, GLenum access, int level) const {
    glBindImageTexture(unit, id(), level, GL_FALSE, 0, access, format_);
}

}  // namespace decalgl::gl
