// Digests of large arrays: whether bytes are those that were written, and whether a scene is the one that a
// file was made from.
//
// XXH3 with 128 bits (Y. Collet, https://xxhash.com), taken over blocks on all cores and then over the blocks'
// digests, so that the result does not depend on the number of threads. It finds damage and change; it is no
// defence against a forger.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "decalgl/core/span.h"

namespace decalgl {

struct Digest {
    uint64_t low = 0;
    uint64_t high = 0;
};

inline bool operator==(const Digest& a, const Digest& b) {
    return a.low == b.low && a.high == b.high;
}
inline bool operator!=(const Digest& a, const Digest& b) {
    return !(a == b);
}

// `threads` 0 takes hardware_threads().
Digest digest_of(Span<const uint8_t> bytes, unsigned threads = 0);

template <typename T>
Span<const uint8_t> bytes_of(Span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>, "only plain data has a meaning as bytes");
    return {reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes()};
}

// A digest of several arrays, which knows where one ends and the next begins.
class DigestBuilder {
public:
    explicit DigestBuilder(unsigned threads) : threads_(threads) {}

    template <typename T>
    void add(Span<const T> values) {
        parts_.push_back({values.size(), sizeof(T)});
        parts_.push_back(digest_of(bytes_of(values), threads_));
    }

    template <typename T>
    void add_value(const T& value) {
        add(Span<const T>(&value, 1));
    }

    Digest finish() const { return digest_of(bytes_of(Span<const Digest>(parts_)), 1); }

private:
    unsigned threads_;
    std::vector<Digest> parts_;
};

}  // namespace decalgl
