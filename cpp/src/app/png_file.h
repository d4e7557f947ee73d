#pragma once

// Pictures as PNG files.

#include <cstdint>
#include <filesystem>
#include <vector>

namespace decalgl {

/// Writes R, G, B, A bytes (sRGB, straight alpha), row by row from the top; folders that are missing are
/// made. Throws Error(file) where it cannot be written.
void write_png(const std::filesystem::path& path, int width, int height,
               const std::vector<std::uint8_t>& pixels);

}  // namespace decalgl
