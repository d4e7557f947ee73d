#pragma once

// Arrays of hundreds of megabytes that are written once from end to end.

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace decalgl {

/// Memory on huge pages where the system has them: touching it first then costs a fraction.
void* allocate_large(std::size_t bytes);
void free_large(void* memory, std::size_t bytes) noexcept;

/// Leaves new elements as they are: zeroing memory that is about to be written is half the work of writing
/// it.
template <typename T>
class LargeAllocator {
public:
    using value_type = T;

    LargeAllocator() = default;
    template <typename U>
    LargeAllocator(const LargeAllocator<U>&) noexcept {}

    T* allocate(std::size_t count) { return static_cast<T*>(allocate_large(count * sizeof(T))); }
    void deallocate(T* memory, std::size_t count) noexcept { free_large(memory, count * sizeof(T)); }

    template <typename U>
    void construct(U* place) noexcept {
        ::new (static_cast<void*>(place)) U;
    }
    template <typename U, typename... Arguments>
    void construct(U* place, Arguments&&... arguments) {
        ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }

    friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
    friend bool operator!=(const LargeAllocator&, const LargeAllocator&) { return false; }
};

/// A vector whose resize() does not set the new elements, for types without constructors.
template <typename T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

}  // namespace decalgl
