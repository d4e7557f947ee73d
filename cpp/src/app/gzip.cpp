#include "app/gzip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <fstream>
#include <memory>

#include "decalgl/core/error.h"
#include "decalgl/core/memory.h"

namespace decalgl {
namespace {

constexpr std::size_t chunk_bytes = 1 << 16;
constexpr int gzip_window = 15 + 16;  // zlib's way of asking for gzip and nothing else

[[noreturn]] void refuse_damaged(const std::string& path) {
    throw Error(ErrorKind::file, fmt::format("'{}' is not a whole gzip file. Fetch or pack it again.", path));
}

struct EndInflate {
    void operator()(z_stream* stream) const { inflateEnd(stream); }
};

}  // namespace

std::string read_gzip(const std::filesystem::path& path, std::size_t most_bytes) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw Error(ErrorKind::file,
                    fmt::format("There is no file '{}' that can be read. Check the path.", path.string()));
    }
    z_stream stream{};
    if (inflateInit2(&stream, gzip_window) != Z_OK) {
        throw Error(ErrorKind::memory, "zlib found no memory to unpack a file. Close other programs.");
    }
    const std::unique_ptr<z_stream, EndInflate> end(&stream);
    std::array<char, chunk_bytes> packed;
    std::array<char, chunk_bytes> unpacked;
    std::string text;
    int status = Z_OK;
    while (status != Z_STREAM_END) {
        file.read(packed.data(), static_cast<std::streamsize>(packed.size()));
        stream.next_in = reinterpret_cast<Bytef*>(packed.data());
        stream.avail_in = static_cast<uInt>(file.gcount());
        if (stream.avail_in == 0) {
            refuse_damaged(path.string());
        }
        do {
            stream.next_out = reinterpret_cast<Bytef*>(unpacked.data());
            stream.avail_out = static_cast<uInt>(unpacked.size());
            status = inflate(&stream, Z_NO_FLUSH);
            // Z_BUF_ERROR asks for more input, as an empty round after a full one does.
            if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
                refuse_damaged(path.string());
            }
            text.append(unpacked.data(), unpacked.size() - stream.avail_out);
            if (text.size() > most_bytes) {
                throw Error(ErrorKind::memory,
                            fmt::format("'{}' unpacks to more than {}. Split it into smaller files.",
                                        path.string(), format_bytes(most_bytes)));
            }
        } while (stream.avail_out == 0 && status != Z_STREAM_END);
    }
    return text;
}

}  // namespace decalgl
