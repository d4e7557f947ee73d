#include "core/digest.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

constexpr size_t block_bytes = size_t{4} << 20;

Digest digest_block(Span<const uint8_t> bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    return {hash.low64, hash.high64};
}

}  // namespace

Digest digest_of(Span<const uint8_t> bytes, unsigned threads) {
    if (bytes.size() <= block_bytes)
        return digest_block(bytes);
    std::vector<Digest> blocks(block_count(bytes.size(), block_bytes));
    parallel_for(bytes.size(), block_bytes, threads, [&](size_t begin, size_t end) {
        blocks[begin / block_bytes] = digest_block(bytes.subspan(begin, end - begin));
    });
    return digest_block(bytes_of(Span<const Digest>(blocks)));
}

}  // namespace decalgl
