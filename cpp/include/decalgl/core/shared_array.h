#pragma once

// Arrays that are written once and then only read, by many.

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "decalgl/core/span.h"

namespace decalgl {

/// Constant values together with whatever keeps them alive: a vector moved in, or a mapped file. Copies are
/// cheap and share the values.
template <typename T>
class SharedArray {
public:
    using value_type = T;

    SharedArray() = default;

    /// Values that `storage` keeps alive.
    SharedArray(Span<const T> values, std::shared_ptr<const void> storage)
        : values_(values), storage_(std::move(storage)) {}

    template <typename Allocator>
    SharedArray(std::vector<T, Allocator> values) {
        auto kept = std::make_shared<const std::vector<T, Allocator>>(std::move(values));
        values_ = Span<const T>(*kept);
        storage_ = std::move(kept);
    }

    SharedArray(std::initializer_list<T> values) : SharedArray(std::vector<T>(values)) {}

    Span<const T> span() const noexcept { return values_; }
    operator Span<const T>() const noexcept { return values_; }
    const std::shared_ptr<const void>& storage() const noexcept { return storage_; }

    const T* data() const noexcept { return values_.data(); }
    std::size_t size() const noexcept { return values_.size(); }
    std::size_t size_bytes() const noexcept { return values_.size_bytes(); }
    bool empty() const noexcept { return values_.empty(); }
    const T* begin() const noexcept { return values_.begin(); }
    const T* end() const noexcept { return values_.end(); }
    const T& operator[](std::size_t index) const { return values_[index]; }

    friend bool operator==(const SharedArray& a, const SharedArray& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end());
    }

private:
    Span<const T> values_;
    std::shared_ptr<const void> storage_;
};

}  // namespace decalgl
