#pragma once

// A view of contiguous values that somebody else owns: C++20's std::span, as far as needed here.

#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace decalgl {

template <typename T>
class Span {
public:
    using value_type = std::remove_cv_t<T>;
    using iterator = T*;

    constexpr Span() noexcept = default;
    constexpr Span(T* data, std::size_t size) noexcept : data_(data), size_(size) {}

    template <std::size_t N>
    constexpr Span(T (&values)[N]) noexcept : data_(values), size_(N) {}

    template <std::size_t N>
    constexpr Span(std::array<value_type, N>& values) noexcept : data_(values.data()), size_(N) {}

    template <std::size_t N, typename U = T, typename = std::enable_if_t<std::is_const_v<U>>>
    constexpr Span(const std::array<value_type, N>& values) noexcept : data_(values.data()), size_(N) {}

    Span(std::vector<value_type>& values) noexcept : data_(values.data()), size_(values.size()) {}

    template <typename Allocator, typename U = T, typename = std::enable_if_t<std::is_const_v<U>>>
    Span(const std::vector<value_type, Allocator>& values) noexcept
        : data_(values.data()), size_(values.size()) {}

    /// A span of values that may be written reads as one of values that may not.
    template <typename U = T, typename = std::enable_if_t<std::is_const_v<U>>>
    constexpr Span(Span<value_type> other) noexcept : data_(other.data()), size_(other.size()) {}

    constexpr T* data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr std::size_t size_bytes() const noexcept { return size_ * sizeof(T); }
    constexpr bool empty() const noexcept { return size_ == 0; }
    constexpr T* begin() const noexcept { return data_; }
    constexpr T* end() const noexcept { return data_ + size_; }
    constexpr T& front() const { return data_[0]; }
    constexpr T& back() const { return data_[size_ - 1]; }
    constexpr T& operator[](std::size_t index) const { return data_[index]; }

    /// The `count` values from `offset` on; the caller keeps both inside the span.
    constexpr Span subspan(std::size_t offset, std::size_t count) const { return {data_ + offset, count}; }
    constexpr Span subspan(std::size_t offset) const { return {data_ + offset, size_ - offset}; }

private:
    T* data_ = nullptr;
    std::size_t size_ = 0;
};

template <typename T>
Span(T*, std::size_t) -> Span<T>;
template <typename T>
Span(std::vector<T>&) -> Span<T>;
template <typename T>
Span(const std::vector<T>&) -> Span<const T>;

}  // namespace decalgl
