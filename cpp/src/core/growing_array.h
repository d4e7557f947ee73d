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
#include <cstddef>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "decalgl/core/large_array.h"
#include "decalgl/core/memory.h"
#include "decalgl/core/shared_array.h"

namespace decalgl {

// For how many values there is room beside so many. What is not used of it is address space alone.
constexpr std::size_t with_room(std::size_t size) {
    return size + size / 4 + 4096;
}

template <typename T>
class GrowingArray {
public:
    GrowingArray() = default;

    // Takes values over, charged to the account as `name`; what they may grow to without moving is the room.
    static GrowingArray adopted(LargeArray<T> values, const MemoryAccount& memory, const std::string& name) {
        const std::size_t size = values.size();
        auto storage = std::make_shared<Storage>();
        storage->charge = MemoryCharge(memory, name, 0);
        storage->room = std::move(values);
        storage->room.resize(storage->room.capacity());
        return GrowingArray(std::make_shared<Version>(std::move(storage), size));
    }

    SharedArray<T> values() const {
        return {Span<const T>(version_->storage->room.data(), version_->size), version_};
    }
    // Where the values lie that its first ones were copied from.
    const T* origin() const { return version_ ? version_->storage->origin : nullptr; }

    // `before` with `more` at its end, charged to the account as `name` where it is copied. `before` is values() of this
    // one, or this one is empty.
    GrowingArray appended(const SharedArray<T>& before, Span<const T> more, const MemoryAccount& memory,
                          const std::string& name) const {
        const std::size_t size = before.size() + more.size();
        GrowingArray result;
        if (version_ && version_->storage->claim(before.size(), size)) {
            result.version_ = std::make_shared<Version>(version_->storage, size);
        } else {
            result = copied(before, size, memory, name);
            result.version_->storage->origin = before.data();
        }
        std::copy(more.begin(), more.end(), result.version_->storage->room.data() + before.size());
        return result;
    }

    // As many values as there were before, of which `change` makes others where they lie.
    template <typename Change>
    static GrowingArray changed(Span<const T> before, const MemoryAccount& memory, const std::string& name,
                                Change change) {
        GrowingArray result = copied(before, before.size(), memory, name);
        change(result.version_->storage->room.data());
        return result;
    }

private:
    struct Storage {
        std::mutex mutex;
        MemoryCharge charge;               // of the longest version that lives
        std::multiset<std::size_t> sizes;  // of those that live
        std::size_t used = 0;              // by all that ever lived
        LargeArray<T> room;
        const T* origin = nullptr;

        // Whether what ends at `from` may go on to `size` in place: only the first to ask.
        bool claim(std::size_t from, std::size_t size) {
            const std::lock_guard<std::mutex> lock(mutex);
            if (used != from || size > room.size())
                return false;
            used = size;
            return true;
        }
    };

    // Counted for as long as it lives.
    struct Version {
        Version(std::shared_ptr<Storage> held, std::size_t values) : storage(std::move(held)), size(values) {
            const std::lock_guard<std::mutex> lock(storage->mutex);
            storage->charge.resize(std::max<std::uint64_t>(storage->charge.bytes(), size * sizeof(T)));
            storage->sizes.insert(size);
            storage->used = std::max(storage->used, size);
        }
        Version(const Version&) = delete;
        Version& operator=(const Version&) = delete;
        ~Version() {
            const std::lock_guard<std::mutex> lock(storage->mutex);
            storage->sizes.erase(storage->sizes.find(size));
            if (!storage->sizes.empty())
                storage->charge.resize(*storage->sizes.rbegin() * sizeof(T));
        }

        const std::shared_ptr<Storage> storage;
        const std::size_t size;
    };

    explicit GrowingArray(std::shared_ptr<const Version> version) : version_(std::move(version)) {}

    // With room for more than `size` values.
    static GrowingArray copied(Span<const T> before, std::size_t size, const MemoryAccount& memory,
                               const std::string& name) {
        LargeArray<T> values;
        values.reserve(with_room(size));
        values.resize(size);
        GrowingArray result = adopted(std::move(values), memory, name);
        std::copy(before.begin(), before.end(), result.version_->storage->room.begin());
        return result;
    }

    std::shared_ptr<const Version> version_;
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
    // With the room that the values have.
    GrownArray(LargeArray<T> values, const MemoryAccount& memory, const std::string& name) {
        growing_ = GrowingArray<T>::adopted(std::move(values), memory, name);
        values_ = growing_.values();
    }

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
