// Arrays that grow at their end while others go on reading what was there before.
//
//     older     |-----------|
//     newer     |------------------|               room for more
//               one storage ------------------------------------|
//
// What was written never changes, so both may be read on any thread. Only one may be continued in place: another one is
// copied into a storage of its own.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <string>

#include "decalgl/core/large_array.h"
#include "decalgl/core/memory.h"
#include "decalgl/core/shared_array.h"

namespace decalgl {

template <typename T>
class GrowingArray {
public:
    GrowingArray() = default;

    SharedArray<T> values() const { return {Span<const T>(storage_->room.data(), size_), storage_}; }
    // Where the values lie that its first ones were copied from.
    const T* origin() const { return storage_ ? storage_->origin : nullptr; }

    // `before` with `more` at its end, charged to the account as `name` where it is copied. `before` is values() of this
    // one, or this one is empty.
    GrowingArray appended(const SharedArray<T>& before, Span<const T> more, const MemoryAccount& memory,
                          const std::string& name) const {
        GrowingArray result;
        result.size_ = before.size() + more.size();
        std::size_t used = before.size();
        const bool fits = storage_ && result.size_ <= storage_->room.size() &&
                          storage_->used.compare_exchange_strong(used, result.size_);
        if (fits) {
            result.storage_ = storage_;
        } else {
            result.storage_ = copied(before, result.size_, memory, name);
            result.storage_->origin = before.data();
        }
        std::copy(more.begin(), more.end(), result.storage_->room.data() + before.size());
        return result;
    }

    // As many values as there were before, of which `change` makes others where they lie.
    template <typename Change>
    static GrowingArray changed(Span<const T> before, const MemoryAccount& memory, const std::string& name,
                                Change change) {
        GrowingArray result;
        result.size_ = before.size();
        result.storage_ = copied(before, result.size_, memory, name);
        change(result.storage_->room.data());
        return result;
    }

private:
    struct Storage {
        MemoryCharge charge;
        LargeArray<T> room;
        std::atomic<std::size_t> used{0};
        const T* origin = nullptr;
    };

    // With room for more than `size` values.
    static std::shared_ptr<Storage> copied(Span<const T> before, std::size_t size,
                                           const MemoryAccount& memory, const std::string& name) {
        auto storage = std::make_shared<Storage>();
        const std::size_t room = size + size / 4 + 4096;
        storage->charge = MemoryCharge(memory, name, room * sizeof(T));
        storage->room.resize(room);
        storage->used = size;
        std::copy(before.begin(), before.end(), storage->room.begin());
        return storage;
    }

    std::shared_ptr<Storage> storage_;
    std::size_t size_ = 0;
};

// Shared values that may be continued: copies go on with what they had.
template <typename T>
class GrownArray {
public:
    using value_type = T;

    GrownArray() = default;
    GrownArray(SharedArray<T> values) : values_(std::move(values)) {}
    template <typename Allocator>
    GrownArray(std::vector<T, Allocator> values) : values_(std::move(values)) {}

    void append(Span<const T> more, const MemoryAccount& memory, const std::string& name) {
        if (more.empty())
            return;
        growing_ = growing_.appended(values_, more, memory, name);
        values_ = growing_.values();
    }

    // Makes other values of those that there are, and room for more. `change` is given a pointer to the first.
    template <typename Change>
    void change(const MemoryAccount& memory, const std::string& name, Change change) {
        growing_ = GrowingArray<T>::changed(values_, memory, name, change);
        values_ = growing_.values();
    }

    const SharedArray<T>& values() const { return values_; }
    // Where the values lie that its first ones were copied from.
    const T* origin() const { return growing_.origin(); }
    Span<const T> span() const noexcept { return values_.span(); }
    operator Span<const T>() const noexcept { return values_.span(); }
    const T* data() const noexcept { return values_.data(); }
    std::size_t size() const noexcept { return values_.size(); }
    std::size_t size_bytes() const noexcept { return values_.size_bytes(); }
    bool empty() const noexcept { return values_.empty(); }
    const T* begin() const noexcept { return values_.begin(); }
    const T* end() const noexcept { return values_.end(); }
    const T& operator[](std::size_t index) const { return values_[index]; }

    friend bool operator==(const GrownArray& a, const GrownArray& b) { return a.values_ == b.values_; }

private:
    SharedArray<T> values_;
    GrowingArray<T> growing_;
};

// An array whose bytes are counted for as long as anyone holds it.
template <typename T>
SharedArray<T> charged(SharedArray<T> values, const MemoryAccount& memory, const std::string& name) {
    struct Charged {
        SharedArray<T> values;
        MemoryCharge charge;
    };
    if (values.empty())
        return values;
    auto kept = std::make_shared<Charged>();
    kept->charge = MemoryCharge(memory, name, values.size_bytes());
    kept->values = std::move(values);
    const Span<const T> span = kept->values.span();
    return {span, std::move(kept)};
}

}  // namespace decalgl
