// What lies at the samples of levels of detail, whatever it looks like: found once by a walk through a bucket's lists,
// and coloured anew for each look.
//
//     texel    its stacks, one after the other: decals that lie over each other at some of its samples
//     stack    samples << stack_shift | words      slot, slot, ... topmost first; where a scene has bands slot, band
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "technique/static_decals/list_reader.h"

namespace decalgl {

constexpr size_t bucket_texels = LEVEL_TEXELS * LEVEL_TEXELS;
constexpr uint32_t texel_samples = 16;
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
    explicit BucketSampler(const PreparedDecals& decals) : decals_(decals) {}

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

    void read_cell(ListReader<float>& reader, uint32_t list);
    void lower(uint32_t& branch, uint32_t slot, uint32_t band, size_t first_of_slot);
    void add_cell(int column, int row, int side);
    void add_stack(uint32_t branch, uint32_t samples, std::vector<uint32_t>& stacks);
    void gather_texels();

    const PreparedDecals& decals_;
    std::vector<Branch> branches_;
    std::vector<uint32_t> branch_of_;  // of each sample of a cell
    std::vector<uint32_t> stack_;
    std::array<std::vector<uint32_t>, bucket_texels> texels_;
    BucketSamples samples_;
};

}  // namespace decalgl
