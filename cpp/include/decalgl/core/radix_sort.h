#pragma once

// A parallel radix sort of keys that carry a payload.

#include "decalgl/core/span.h"

#include <cstdint>
#include <vector>

namespace decalgl {

/// Sorts `keys` upwards and moves `payload` along; equal keys keep their order (stable). Both spans have the
/// same size (else Error(input)). `key_bits`: only the low bits that may be set are looked at (0: all).
/// `threads` 0 takes hardware_threads(). Needs as much memory again as it sorts; the result does not depend
/// on the number of threads.
void radix_sort(Span<std::uint32_t> keys, Span<std::uint32_t> payload, unsigned threads = 0,
                unsigned key_bits = 0);
void radix_sort(Span<std::uint64_t> keys, Span<std::uint32_t> payload, unsigned threads = 0,
                unsigned key_bits = 0);

/// The places of `keys` from the least to the greatest; equal keys keep their order, NaN is as -infinity.
/// Throws Error(input) for 2^32 keys or more.
std::vector<std::int64_t> ascending(Span<const double> keys, unsigned threads = 0);

}  // namespace decalgl
