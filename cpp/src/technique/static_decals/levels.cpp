#include "technique/static_decals/levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

// Samples along a bucket's side; at the finest level a cell has one.
constexpr int bucket_samples = 1 << FINEST_LEVEL;
constexpr int texel_samples = bucket_samples / LEVEL_TEXELS;
constexpr int most_samples = 1 << (2 * (FINEST_LEVEL - COARSEST_LEVEL));

// A number from 0 to 1 that looks like chance.
float scattered(uint32_t seed) {
    seed = (seed ^ 61U ^ seed >> 16) * 9U;
    seed = (seed ^ seed >> 4) * 0x27d4eb2dU;
    return static_cast<float>((seed ^ seed >> 15) >> 8) * 0x1p-24F;
}

// The samples of one cell: `side` x `side`, each somewhere in its own square.
struct CellSamples {
    int side;
    float bias;
    std::array<float, most_samples> x;  // quanta from the cell's corner
    std::array<float, most_samples> y;

    explicit CellSamples(int level)
        : side(level == 0 ? 1 : bucket_samples >> level), bias(static_cast<float>(cell_bias(level))) {
        const float step = static_cast<float>(cell_quanta(level)) / static_cast<float>(side);
        for (int i = 0; i < side * side; ++i) {
            const auto seed = static_cast<uint32_t>(i + 97 * level);
            x[static_cast<size_t>(i)] = (static_cast<float>(i % side) + scattered(2 * seed)) * step;
            y[static_cast<size_t>(i)] = (static_cast<float>(i / side) + scattered(2 * seed + 1)) * step;
        }
    }
    size_t count() const { return static_cast<size_t>(side * side); }
};

struct Color {
    float r = 0.0F, g = 0.0F, b = 0.0F, a = 0.0F;
};

// Composes the features of one cell for its samples, front to back.
class CellComposer {
public:
    CellComposer(const PreparedDecals& decals, const CellSamples& samples)
        : decals_(decals), samples_(samples) {}

    void compose(Span<const uint32_t> words) {
        std::fill_n(colors.begin(), samples_.count(), Color());
        covered_.fill(0);
        line_ = false;
        slot_ = 0;
        for (const uint32_t word : words) {
            if ((word & HEADER) == 0) {
                read_point(word);
                continue;
            }
            end_group();
            if (word == LIST_END)
                return;
            begin_group(word);
        }
        end_group();
    }

    std::array<Color, most_samples> colors;

private:
    void begin_group(uint32_t header) {
        slot_ = header & SLOT_MASK;
        line_ = (header & LINE) != 0;
        std::fill_n(covered_.begin(), samples_.count(), (header & COVERS) != 0 ? 1 : 0);
        const int scale = line_ ? decals_.scale_of(slot_) : 0;
        const float unit = std::ldexp(1.0F, -scale);
        radius_ = decals_.styles[slot_].half_width * unit;
        for (size_t i = 0; i < samples_.count(); ++i) {
            at_x_[i] = samples_.x[i] * unit + samples_.bias;
            at_y_[i] = samples_.y[i] * unit + samples_.bias;
        }
    }

    void read_point(uint32_t word) {
        const auto x = static_cast<float>(word & COORDINATE_MASK);
        const auto y = static_cast<float>(word >> COORDINATE_BITS & COORDINATE_MASK);
        const bool moves = (word & MOVE) != 0;
        if (line_)
            add_stroke(moves ? x : from_x_, moves ? y : from_y_, x, y);
        else if (!moves)
            add_crossing(x, y);
        from_x_ = x;
        from_y_ = y;
    }

    void add_stroke(float x0, float y0, float x1, float y1) {
        const float dx = x1 - x0, dy = y1 - y0;
        const float per_length2 = 1.0F / std::max(dx * dx + dy * dy, 1e-6F);
        for (size_t i = 0; i < samples_.count(); ++i) {
            const float px = at_x_[i] - x0, py = at_y_[i] - y0;
            const float t = std::clamp((px * dx + py * dy) * per_length2, 0.0F, 1.0F);
            const float ex = px - t * dx, ey = py - t * dy;
            covered_[i] |= ex * ex + ey * ey <= radius_ * radius_ ? 1 : 0;
        }
    }

    // ring_cells.h
    void add_crossing(float x, float y) {
        const bool starts_left = from_x_ == samples_.bias, ends_left = x == samples_.bias;
        const float border = starts_left == ends_left ? 1e9F : starts_left ? from_y_ : y;
        const bool rises = from_y_ <= y;
        const float low_x = rises ? from_x_ : x, low_y = rises ? from_y_ : y;
        const float dx = rises ? x - from_x_ : from_x_ - x, dy = rises ? y - from_y_ : from_y_ - y;
        for (size_t i = 0; i < samples_.count(); ++i) {
            const float px = at_x_[i] - low_x, py = at_y_[i] - low_y;
            const int on_row = py >= 0.0F && py < dy && px * dy >= py * dx ? 1 : 0;
            covered_[i] ^= on_row ^ (at_y_[i] >= border ? 1 : 0);
        }
    }

    void end_group() {
        const std::array<uint8_t, 4>& bytes = decals_.styles[slot_].color;
        const float alpha = static_cast<float>(bytes[3]) / 255.0F;
        for (size_t i = 0; i < samples_.count(); ++i) {
            const float weight = static_cast<float>(covered_[i]) * (1.0F - colors[i].a) * alpha;
            colors[i].r += weight * static_cast<float>(bytes[0]);
            colors[i].g += weight * static_cast<float>(bytes[1]);
            colors[i].b += weight * static_cast<float>(bytes[2]);
            colors[i].a += weight;
        }
    }

    const PreparedDecals& decals_;
    const CellSamples& samples_;
    std::array<int, most_samples> covered_{};
    std::array<float, most_samples> at_x_{}, at_y_{};  // in the group's coordinates
    uint32_t slot_ = 0;
    bool line_ = false;
    float radius_ = 0.0F;
    float from_x_ = 0.0F, from_y_ = 0.0F;
};

using BucketTexels = std::array<Color, LEVEL_TEXELS * LEVEL_TEXELS>;

void add_cell(int column, int row, const CellSamples& samples, const std::array<Color, most_samples>& colors,
              BucketTexels& texels) {
    constexpr float share = 1.0F / (texel_samples * texel_samples);
    for (int i = 0; i < samples.side * samples.side; ++i) {
        const int x = (column * samples.side + i % samples.side) / texel_samples;
        const int y = (row * samples.side + i / samples.side) / texel_samples;
        Color& texel = texels[static_cast<size_t>(y * LEVEL_TEXELS + x)];
        const Color& color = colors[static_cast<size_t>(i)];
        texel.r += share * color.r;
        texel.g += share * color.g;
        texel.b += share * color.b;
        texel.a += share * color.a;
    }
}

void draw_bucket(const PreparedDecals& decals, uint32_t bucket, BucketTexels& texels) {
    texels.fill(Color());
    const uint32_t entry = decals.bucket_entries[bucket];
    const int level = static_cast<int>(entry & ((1U << LEVEL_BITS) - 1));
    const CellSamples samples(level);
    CellComposer composer(decals, samples);
    const int side = 1 << level;
    for (int cell = 0; cell < side * side; ++cell) {
        const uint32_t list = decals.cells[(entry >> LEVEL_BITS) + static_cast<uint32_t>(cell)];
        if (list == EMPTY_LIST)
            continue;
        composer.compose(decals.list(list));
        if (level == 0)
            texels.fill(composer.colors[0]);
        else
            add_cell(cell % side, cell / side, samples, composer.colors, texels);
    }
}

// One row of texels as bytes.
void write_row(const BucketTexels& texels, size_t y, uint8_t* target) {
    const auto byte = [](float value) {
        return static_cast<uint8_t>(std::lrint(std::clamp(value, 0.0F, 255.0F)));
    };
    for (size_t x = 0; x < LEVEL_TEXELS; ++x, target += 4) {
        const Color& texel = texels[y * LEVEL_TEXELS + x];
        target[0] = byte(texel.r);
        target[1] = byte(texel.g);
        target[2] = byte(texel.b);
        target[3] = byte(255.0F * texel.a);
    }
}

void place_bucket(const BucketTexels& texels, const BucketGrid& grid, uint32_t bucket, LevelRaster& raster) {
    const auto columns = static_cast<uint32_t>(grid.columns);
    for (size_t y = 0; y < LEVEL_TEXELS; ++y) {
        const size_t row = size_t{bucket / columns} * LEVEL_TEXELS + y;
        write_row(texels, y,
                  &raster.texels[4 * (row * static_cast<size_t>(raster.width) +
                                      size_t{bucket % columns} * LEVEL_TEXELS)]);
    }
}

}  // namespace

std::vector<uint8_t> draw_level_of_bucket(const PreparedDecals& decals, uint32_t bucket) {
    BucketTexels texels;
    draw_bucket(decals, bucket, texels);
    std::vector<uint8_t> bytes(size_t{4} * LEVEL_TEXELS * LEVEL_TEXELS);
    for (size_t y = 0; y < LEVEL_TEXELS; ++y)
        write_row(texels, y, &bytes[4 * y * LEVEL_TEXELS]);
    return bytes;
}

LevelRaster draw_finest_level(const PreparedDecals& decals) {
    LevelRaster raster;
    raster.width = decals.grid.columns * LEVEL_TEXELS;
    raster.height = decals.grid.rows * LEVEL_TEXELS;
    raster.texels.resize(size_t{4} * static_cast<size_t>(raster.width) * static_cast<size_t>(raster.height));
    parallel_for(decals.grid.bucket_count(), 64, 0, [&](size_t begin, size_t end) {
        BucketTexels texels;
        for (size_t bucket = begin; bucket < end; ++bucket) {
            draw_bucket(decals, static_cast<uint32_t>(bucket), texels);
            place_bucket(texels, decals.grid, static_cast<uint32_t>(bucket), raster);
        }
    });
    return raster;
}

}  // namespace decalgl
