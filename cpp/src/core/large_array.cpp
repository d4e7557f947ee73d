#include "decalgl/core/large_array.h"

#include <cstdlib>

#include <sys/mman.h>

namespace decalgl {
namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;

std::size_t whole_pages(std::size_t bytes) {
    return (bytes + huge_page - 1) / huge_page * huge_page;
}

}  // namespace

void* allocate_large(std::size_t bytes) {
    if (bytes < 2 * huge_page) {
        return ::operator new(bytes);
    }
    void* memory = std::aligned_alloc(huge_page, whole_pages(bytes));
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    // A hint: where it is refused, ordinary pages serve as well.
    (void)madvise(memory, whole_pages(bytes), MADV_HUGEPAGE);
    return memory;
}

void free_large(void* memory, std::size_t bytes) noexcept {
    if (bytes < 2 * huge_page) {
        ::operator delete(memory);
    } else {
        std::free(memory);
    }
}

}  // namespace decalgl
