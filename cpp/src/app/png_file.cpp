#include "app/png_file.h"

#include <fmt/format.h>
#include <png.h>

#include "decalgl/core/error.h"

namespace decalgl {

void write_png(const std::filesystem::path& path, int width, int height,
               const std::vector<std::uint8_t>& pixels) {
    if (width < 1 || height < 1 ||
        pixels.size() != 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
        throw Error(ErrorKind::input,
                    fmt::format("{} bytes do not make a picture of {} x {} pixels. Give four a pixel.",
                                pixels.size(), width, height));
    }
    std::error_code failure;  // where a folder cannot be made, writing fails and says why
    if (path.has_parent_path()) {
        std::filesystem::create_directories(path.parent_path(), failure);
    }
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = PNG_FORMAT_RGBA;
    if (png_image_write_to_file(&image, path.string().c_str(), 0, pixels.data(), 0, nullptr) == 0) {
        throw Error(ErrorKind::file,
                    fmt::format("The picture cannot be written to '{}': {}. Name a file in a folder that "
                                "can be written to.",
                                path.string(), image.message));
    }
}

}  // namespace decalgl
