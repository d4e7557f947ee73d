// Files as the system gives them: mapped to be read, and replaced as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "decalgl/core/shared_array.h"

namespace decalgl {

// The bytes of a regular file, mapped for as long as anybody holds them. Throws Error(file) with the system's
// reason.
SharedArray<uint8_t> map_file(const std::string& path);

// A new file beside `path` that takes its place when finished, and vanishes where that is not reached.
class ReplacementFile {
public:
    // Follows `path` where it is a link. Throws Error(file): what is there can only be a regular file.
    explicit ReplacementFile(const std::string& path);
    ReplacementFile(const ReplacementFile&) = delete;
    ReplacementFile& operator=(const ReplacementFile&) = delete;
    ~ReplacementFile();

    void append(Span<const uint8_t> bytes);
    // Waits until all is on the disk, then renames.
    void finish();

private:
    [[noreturn]] void refuse(int error) const;

    std::string path_;
    std::string target_;  // behind links
    std::string temporary_;
    int descriptor_ = -1;
};

}  // namespace decalgl
