#include "technique/static_decals/level_samples.h"

#include <algorithm>
#include <array>

namespace decalgl {
namespace {

constexpr uint32_t root = 0;

// A number from 0 to 1 that looks like chance.
float scattered(uint32_t seed) {
    seed = (seed ^ 61U ^ seed >> 16) * 9U;
    seed = (seed ^ seed >> 4) * 0x27d4eb2dU;
    return static_cast<float>((seed ^ seed >> 15) >> 8) * 0x1p-24F;
}

// Of each block of cells that have one sample together, the one that it lies in.
bool has_sample(int column, int row, int block) {
    const auto place = static_cast<uint32_t>((row / block) * 64 + column / block);
    const auto chosen = static_cast<int>(scattered(place) * static_cast<float>(block * block));
    return column % block == chosen % block && row % block == chosen / block;
}

// The number's bits behind the point, the lowest first (van der Corput 1935).
float reversed(int number) {
    float sum = 0.0F, bit = 0.5F;
    for (; number > 0; number >>= 1, bit /= 2.0F)
        sum += (number & 1) != 0 ? bit : 0.0F;
    return sum;
}

// The samples of one cell: `side` x `side`, each in its own square, at another place of it in each row and in each column, so
// that a line across many squares meets as many as its share.
CellPoints<float> samples_of(int level, int side) {
    CellPoints<float> cell;
    cell.level = level;
    cell.side = static_cast<size_t>(side);
    const float step = static_cast<float>(cell_quanta(level)) / static_cast<float>(side);
    const float middle = 0.5F / static_cast<float>(side);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            cell.x.push_back((static_cast<float>(column) + reversed(row) + middle) * step);
            cell.y.push_back((static_cast<float>(row) + reversed(column) + middle) * step);
        }
    }
    return cell;
}

// How many words the next stack has after its own.
size_t words_below(uint32_t stack) {
    return stack & stack_mask;
}

}  // namespace

// A bucket without points looks the same everywhere, but for hatches.
int BucketSampler::samples_across(int level) const {
    return level == 0 && (decals_.style_flags & STYLE_HATCH) == 0 ? 1 : std::max(bucket_side_ >> level, 1);
}

const BucketSamples& BucketSampler::sample(uint32_t bucket) {
    for (std::vector<uint32_t>& texel : texels_)
        texel.clear();
    samples_.words.clear();
    samples_.stacks.clear();
    const uint32_t entry = decals_.bucket_entries[bucket];
    const int level = static_cast<int>(entry & ((1U << LEVEL_BITS) - 1));
    const int side = samples_across(level), block = std::max((1 << level) / bucket_side_, 1);
    CellPoints<float> cell = samples_of(level, side);
    cell.bucket_column = bucket % static_cast<uint32_t>(decals_.grid.columns);
    cell.bucket_row = bucket / static_cast<uint32_t>(decals_.grid.columns);
    ListReader<float> reader(decals_, cell);
    branch_of_.resize(cell.x.size());
    for (int i = 0; i < 1 << (2 * level); ++i) {
        const uint32_t list = decals_.cells[(entry >> LEVEL_BITS) + static_cast<uint32_t>(i)];
        const int column = i & ((1 << level) - 1), row = i >> level;
        if (list == EMPTY_LIST || !has_sample(column, row, block))
            continue;
        cell.corner = {double(column) * cell_quanta(level), double(row) * cell_quanta(level)};
        read_cell(reader, list);
        if (side == 1 && level == 0)
            add_stack(branch_of_[0], texel_samples, samples_.words);
        else
            add_cell(column / block, row / block, side);
    }
    if (side > 1 || level > 0)
        gather_texels();
    return samples_;
}

void BucketSampler::read_cell(ListReader<float>& reader, uint32_t list) {
    branches_.assign(1, Branch{});
    std::fill(branch_of_.begin(), branch_of_.end(), root);
    reader.read(decals_.list(list),
                [&](uint32_t slot, const StyleReader& style, const auto& shares, PointRange points) {
                    const size_t first_of_slot = branches_.size();
                    for (size_t i = points.first; i < points.last; ++i)
                        if (shares[i] <= 1.0F)
                            lower(branch_of_[i], slot, style.band(double{shares[i]}), first_of_slot);
                });
}

// Onto the branch of one more decal, which other samples may have led to already.
void BucketSampler::lower(uint32_t& branch, uint32_t slot, uint32_t band, size_t first_of_slot) {
    const auto leads_there = [&](uint32_t below) {
        return branches_[below].above == branch && branches_[below].band == band;
    };
    const auto count = static_cast<uint32_t>(branches_.size());
    uint32_t below = branches_[branch].newest;
    if (below < first_of_slot || !leads_there(below)) {
        below = static_cast<uint32_t>(first_of_slot);
        while (below < count && !leads_there(below))
            ++below;
    }
    if (below == count) {
        branches_[branch].newest = below;
        branches_.push_back({branch, slot, band, root});
    }
    branch = below;
}

// The samples of a cell to those of its texels, or of the texel that it is a part of.
void BucketSampler::add_cell(int column, int row, int side) {
    const int block = std::min(side, texel_side);
    std::array<uint32_t, texel_samples> branches{}, samples{};
    for (int top = 0; top < side; top += block) {
        for (int left = 0; left < side; left += block) {
            size_t count = 0;
            for (int i = 0; i < block * block; ++i) {
                const uint32_t branch =
                    branch_of_[static_cast<size_t>((top + i / block) * side + left + i % block)];
                if (branch == root)
                    continue;
                const size_t place = static_cast<size_t>(
                    std::find(branches.begin(), branches.begin() + count, branch) - branches.begin());
                if (place == count) {
                    branches[count] = branch;
                    samples[count++] = 0;
                }
                ++samples[place];
            }
            const int x = (column * side + left) / texel_side, y = (row * side + top) / texel_side;
            for (size_t i = 0; i < count; ++i)
                add_stack(branches[i], samples[i],
                          texels_[static_cast<size_t>(y * bucket_side_ / texel_side + x)]);
        }
    }
}

// To what a texel has of the same decals already, or after it.
void BucketSampler::add_stack(uint32_t branch, uint32_t samples, std::vector<uint32_t>& stacks) {
    stack_.clear();
    const bool has_bands = (decals_.style_flags & STYLE_BANDS) != 0;
    for (; branch != root; branch = branches_[branch].above) {
        if (has_bands)
            stack_.push_back(branches_[branch].band);
        stack_.push_back(branches_[branch].slot);
    }
    if (stack_.empty())
        return;
    std::reverse(stack_.begin(), stack_.end());
    for (size_t i = 0; i < stacks.size(); i += 1 + words_below(stacks[i])) {
        const auto first = stacks.begin() + static_cast<std::ptrdiff_t>(i) + 1;
        if (words_below(stacks[i]) == stack_.size() && std::equal(stack_.begin(), stack_.end(), first)) {
            stacks[i] += samples << stack_shift;
            return;
        }
    }
    stacks.push_back(samples << stack_shift | static_cast<uint32_t>(stack_.size()));
    stacks.insert(stacks.end(), stack_.begin(), stack_.end());
}

void BucketSampler::gather_texels() {
    for (const std::vector<uint32_t>& texel : texels_)
        samples_.words.insert(samples_.words.end(), texel.begin(), texel.end());
    if (samples_.words.empty())
        return;
    for (const std::vector<uint32_t>& texel : texels_) {
        uint8_t count = 0;
        for (size_t i = 0; i < texel.size(); i += 1 + words_below(texel[i]))
            ++count;
        samples_.stacks.push_back(count);
    }
}

}  // namespace decalgl
