#include "core/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <system_error>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

std::string reason(int error) {
    return std::generic_category().message(error);
}

[[noreturn]] void refuse_to_read(const std::string& path, const std::string& why) {
    throw Error(ErrorKind::file, "cannot read '" + path + "': " + why + ". Check the path and its rights.");
}

// The system takes a path to end at its first zero.
void require_path(const std::string& path) {
    if (path.empty() || path.find('\0') != std::string::npos)
        throw Error(ErrorKind::file, "the path is empty or holds a zero byte; name a file");
}

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0)
            ::close(number_);
    }
    int number() const { return number_; }

private:
    int number_;
};

}  // namespace

SharedArray<uint8_t> map_file(const std::string& path) {
    require_path(path);
    // Without O_NONBLOCK, opening a pipe would wait for whoever writes to it.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat status {};
    if (file.number() < 0 || ::fstat(file.number(), &status) != 0)
        refuse_to_read(path, reason(errno));
    if (!S_ISREG(status.st_mode))
        refuse_to_read(path, S_ISDIR(status.st_mode) ? reason(EISDIR) : "not a regular file");
    const auto size = static_cast<size_t>(status.st_size);
    if (size == 0)
        return {};
    void* memory = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.number(), 0);
    if (memory == MAP_FAILED)
        refuse_to_read(path, reason(errno));
    const std::shared_ptr<const void> mapping(memory, [size](void* mapped) { ::munmap(mapped, size); });
    return {Span<const uint8_t>(static_cast<const uint8_t*>(memory), size), mapping};
}

ReplacementFile::ReplacementFile(const std::string& path) : path_(path) {
    require_path(path);
    std::error_code error;
    const std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
    if (error)
        refuse(error.value());
    const std::filesystem::file_status status = std::filesystem::status(target, error);
    if (std::filesystem::is_directory(status))
        refuse(EISDIR);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        refuse(EEXIST);
    target_ = target.string();
    const std::string stem = (target.parent_path() / ".decalgl-").string() + std::to_string(::getpid());
    for (int attempt = 0; descriptor_ < 0; ++attempt) {
        temporary_ = stem + "-" + std::to_string(attempt) + ".part";
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ < 0 && errno != EEXIST)
            refuse(errno);
    }
}

ReplacementFile::~ReplacementFile() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
        ::unlink(temporary_.c_str());
    }
}

void ReplacementFile::append(Span<const uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            refuse(written == 0 ? ENOSPC : errno);
        bytes = bytes.subspan(static_cast<size_t>(written));
    }
}

void ReplacementFile::finish() {
    if (::fsync(descriptor_) != 0 || ::rename(temporary_.c_str(), target_.c_str()) != 0)
        refuse(errno);
    ::close(descriptor_);
    descriptor_ = -1;
}

void ReplacementFile::refuse(int error) const {
    throw Error(ErrorKind::file, "cannot write '" + path_ + "': " + reason(error) +
                                     ". Check the folder, its rights and the room on the disk.");
}

}  // namespace decalgl
