// What lies at the samples of levels of detail, whatever it looks like: found once by a walk through a bucket's lists,
// and coloured anew for each look.
//
//     texel    its stacks, one after the other: decals that lie over each other at some of its samples
//     stack    samples << stack_shift | words      slot, slot, ... topmost first; where a scene has bands slot, band
#pragma once

#include <cstdint>
#include <vector>

#include "technique/static_decals/list_reader.h"

namespace decalgl {

constexpr int texel_side = 4;
constexpr uint32_t texel_samples = texel_side * texel_side;
constexpr int stack_shift = 27;
constexpr uint32_t stack_mask = (1U << stack_shift) - 1;

struct BucketSamples {
    std::vector<uint32_t> words;  // of all texels, row by row from the lowest
    std::vector<uint8_t>
        stacks;  // how many each texel has; empty where all are as the first, which alone is there
};

// Walks lists bucket by bucket, with room that is used again.
class BucketSampler {
public:
    // `texels`: along a bucket's side, a power of two.
    BucketSampler(const PreparedDecals& decals, int texels)
        : decals_(decals), bucket_side_(texels * texel_side), texels_(static_cast<size_t>(texels * texels)) {}

    // Valid until the next call.
    const BucketSamples& sample(uint32_t bucket);

private:
    // Samples below the same decals: a tree from the topmost decal down.
    struct Branch {
        uint32_t above;
        uint32_t slot;
        uint32_t band;
        uint32_t newest;  // of the branches below
    };

    int samples_across(int level) const;
    void read_cell(ListReader<float>& reader, uint32_t list);
    void lower(uint32_t& branch, uint32_t slot, uint32_t band, size_t first_of_slot);
    void add_cell(int column, int row, int side);
    void add_stack(uint32_t branch, uint32_t samples, std::vector<uint32_t>& stacks);
    void gather_texels();

    const PreparedDecals& decals_;
    int bucket_side_;  // in samples
    std::vector<Branch> branches_;
    std::vector<uint32_t> branch_of_;  // of each sample of a cell
    std::vector<uint32_t> stack_;
    std::vector<std::vector<uint32_t>> texels_;
    BucketSamples samples_;
};

}  // namespace decalgl
