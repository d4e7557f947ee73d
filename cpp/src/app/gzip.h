#pragma once

// Small files, read whole and unpacked, with their sizes checked first.

#include <cstddef>
#include <filesystem>
#include <string>

namespace decalgl {

/// The text inside a gzip file. Throws Error(file) where it is missing, damaged or cut short, and
/// Error(memory) where it would unpack to more than `most_bytes`.
std::string read_gzip(const std::filesystem::path& path, std::size_t most_bytes);

}  // namespace decalgl
