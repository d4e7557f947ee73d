#include "technique/static_decals/levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

// Of deeper buckets nothing is kept: walking them again is cheaper than the room.
constexpr size_t most_words_per_texel = 8;

struct Color {
    float r = 0.0F, g = 0.0F, b = 0.0F, a = 0.0F;

    void add(const Color& other, float weight) {
        r += weight * other.r;
        g += weight * other.g;
        b += weight * other.b;
        a += weight * other.a;
    }
};

// Row by row from the lowest.
struct BucketTexels {
    explicit BucketTexels(int count) : side(static_cast<size_t>(count)), texels(side * side) {}

    size_t side;
    std::vector<Color> texels;
};

// Stacks in the colours and the draw order of one look.
class StackColors {
public:
    explicit StackColors(const PreparedDecals& look)
        : look_(look), has_bands_((look.style_flags & STYLE_BANDS) != 0) {}

    Color mean(const uint32_t*& word, size_t stacks) {
        Color sum;
        for (size_t i = 0; i < stacks; ++i) {
            const uint32_t samples = *word >> stack_shift, words = *word & stack_mask;
            sum.add(composite(word + 1, words), static_cast<float>(samples) / texel_samples);
            word += 1 + words;
        }
        return sum;
    }

private:
    struct Level {
        uint32_t rank, slot, band;
    };

    // Front to back.
    Color composite(const uint32_t* words, uint32_t count) {
        const uint32_t step = has_bands_ ? 2 : 1;
        Color color;
        if (look_.ranks.empty() || count == step) {
            for (uint32_t i = 0; i < count; i += step)
                lay_below(words[i], has_bands_ ? words[i + 1] : 0, color);
            return color;
        }
        ordered_.clear();
        for (uint32_t i = 0; i < count; i += step)
            ordered_.push_back({look_.ranks[words[i]], words[i], has_bands_ ? words[i + 1] : 0});
        std::sort(ordered_.begin(), ordered_.end(),
                  [](const Level& a, const Level& b) { return a.rank < b.rank; });
        for (const Level& level : ordered_)
            lay_below(level.slot, level.band, color);
        return color;
    }

    void lay_below(uint32_t slot, uint32_t band, Color& color) const {
        const std::array<uint8_t, 4> own = look_.styles[slot].color;
        const std::array<uint8_t, 4> bytes = has_bands_ ? StyleReader(look_, slot).color(own, band) : own;
        const float alpha = static_cast<float>(bytes[3]) / 255.0F;
        color.add(
            {static_cast<float>(bytes[0]), static_cast<float>(bytes[1]), static_cast<float>(bytes[2]), 1.0F},
            (1.0F - color.a) * alpha);
    }

    const PreparedDecals& look_;
    bool has_bands_;
    std::vector<Level> ordered_;
};

void paint(const BucketSamples& samples, StackColors& colors, BucketTexels& bucket) {
    std::vector<Color>& texels = bucket.texels;
    const uint32_t* word = samples.words.data();
    if (samples.words.empty()) {
        std::fill(texels.begin(), texels.end(), Color());
    } else if (samples.stacks.empty()) {
        std::fill(texels.begin(), texels.end(), colors.mean(word, 1));
    } else {
        for (size_t i = 0; i < texels.size(); ++i)
            texels[i] = colors.mean(word, samples.stacks[i]);
    }
}

// One row of texels as bytes.
void write_row(const BucketTexels& bucket, size_t y, uint8_t* target) {
    const auto byte = [](float value) {
        return static_cast<uint8_t>(std::lrint(std::clamp(value, 0.0F, 255.0F)));
    };
    for (size_t x = 0; x < bucket.side; ++x, target += 4) {
        const Color& texel = bucket.texels[y * bucket.side + x];
        target[0] = byte(texel.r);
        target[1] = byte(texel.g);
        target[2] = byte(texel.b);
        target[3] = byte(255.0F * texel.a);
    }
}

void place_bucket(const BucketTexels& texels, const BucketGrid& grid, uint32_t bucket, LevelRaster& raster) {
    const auto columns = static_cast<uint32_t>(grid.columns);
    for (size_t y = 0; y < texels.side; ++y) {
        const size_t row = size_t{bucket / columns} * texels.side + y;
        write_row(texels, y,
                  &raster.texels[4 * (row * static_cast<size_t>(raster.width) +
                                      size_t{bucket % columns} * texels.side)]);
    }
}

}  // namespace

// Where strokes have other widths, nothing that was kept is right.
void LevelPainter::take_shapes_of(const PreparedDecals& look) {
    if (shapes_ == look.shape_token)
        return;
    shapes_ = look.shape_token;
    kept_.clear();
    kept_.resize(look.bucket_entries.size(), {0, false, {}});
}

const BucketSamples& LevelPainter::samples_of(const PreparedDecals& look, uint32_t bucket,
                                              BucketSampler& sampler) {
    Kept& kept = kept_[bucket];
    const uint32_t entry = look.bucket_entries[bucket];
    if (kept.is_kept && kept.entry == entry)
        return kept.samples;
    const BucketSamples& samples = sampler.sample(bucket);
    kept.entry = entry;
    kept.is_kept = samples.words.size() <= most_words_per_texel * static_cast<size_t>(texels_ * texels_);
    kept.samples = kept.is_kept ? samples : BucketSamples();
    return samples;
}

LevelRaster LevelPainter::draw(const PreparedDecals& look) {
    take_shapes_of(look);
    LevelRaster raster;
    raster.width = look.grid.columns * texels_;
    raster.height = look.grid.rows * texels_;
    raster.texels.resize(size_t{4} * static_cast<size_t>(raster.width) * static_cast<size_t>(raster.height));
    parallel_for(look.grid.bucket_count(), 64, 0, [&](size_t begin, size_t end) {
        BucketSampler sampler(look, texels_);
        StackColors colors(look);
        BucketTexels texels(texels_);
        for (size_t i = begin; i < end; ++i) {
            const auto bucket = static_cast<uint32_t>(i);
            paint(samples_of(look, bucket, sampler), colors, texels);
            place_bucket(texels, look.grid, bucket, raster);
        }
    });
    charge_kept();
    return raster;
}

std::vector<uint8_t> LevelPainter::draw_bucket(const PreparedDecals& look, uint32_t bucket) {
    take_shapes_of(look);
    BucketSampler sampler(look, texels_);
    StackColors colors(look);
    BucketTexels texels(texels_);
    paint(samples_of(look, bucket, sampler), colors, texels);
    std::vector<uint8_t> bytes(4 * texels.texels.size());
    for (size_t y = 0; y < texels.side; ++y)
        write_row(texels, y, &bytes[4 * y * texels.side]);
    return bytes;
}

// What does not fit into the budget is found again when it is needed.
void LevelPainter::charge_kept() {
    uint64_t bytes = kept_.size() * sizeof(Kept);
    for (const Kept& each : kept_)
        bytes += each.samples.words.capacity() * sizeof(uint32_t) + each.samples.stacks.capacity();
    try {
        charge_ = MemoryCharge();
        charge_ = MemoryCharge(memory_, "static: levels", bytes);
    } catch (const Error&) {
        shapes_ = nullptr;
        kept_ = {};
    }
}

}  // namespace decalgl
