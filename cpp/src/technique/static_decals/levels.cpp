#include "technique/static_decals/levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "decalgl/core/parallel.h"
#include "technique/static_decals/list_reader.h"

namespace decalgl {
namespace {

// Samples along a bucket's side; at the finest level a cell has one.
constexpr int bucket_samples = 1 << FINEST_LEVEL;
constexpr int texel_samples = bucket_samples / LEVEL_TEXELS;

// A number from 0 to 1 that looks like chance.
float scattered(uint32_t seed) {
    seed = (seed ^ 61U ^ seed >> 16) * 9U;
    seed = (seed ^ seed >> 4) * 0x27d4eb2dU;
    return static_cast<float>((seed ^ seed >> 15) >> 8) * 0x1p-24F;
}

// A bucket without points looks the same everywhere, but for hatches.
int samples_across(const PreparedDecals& decals, int level) {
    return level == 0 && (decals.style_flags & STYLE_HATCH) == 0 ? 1 : bucket_samples >> level;
}

// The samples of one cell: `side` x `side`, each somewhere in its own square.
CellPoints<float> samples_of(int level, int side) {
    CellPoints<float> cell;
    cell.level = level;
    const float step = static_cast<float>(cell_quanta(level)) / static_cast<float>(side);
    for (int i = 0; i < side * side; ++i) {
        const auto seed = static_cast<uint32_t>(i + 97 * level);
        cell.x.push_back((static_cast<float>(i % side) + scattered(2 * seed)) * step);
        cell.y.push_back((static_cast<float>(i / side) + scattered(2 * seed + 1)) * step);
    }
    return cell;
}

struct Color {
    float r = 0.0F, g = 0.0F, b = 0.0F, a = 0.0F;
};

// Composes the decals of one cell for its samples, front to back.
void compose(const PreparedDecals& decals, ListReader<float>& reader, uint32_t list,
             std::vector<Color>& colors) {
    std::fill(colors.begin(), colors.end(), Color());
    const auto add = [&](uint32_t slot, const StyleReader& style, const std::vector<float>& shares) {
        for (size_t i = 0; i < shares.size(); ++i) {
            if (shares[i] > 1.0F)
                continue;
            const std::array<uint8_t, 4> bytes = style.color(decals.styles[slot].color, double{shares[i]});
            const float weight = (1.0F - colors[i].a) * static_cast<float>(bytes[3]) / 255.0F;
            colors[i].r += weight * static_cast<float>(bytes[0]);
            colors[i].g += weight * static_cast<float>(bytes[1]);
            colors[i].b += weight * static_cast<float>(bytes[2]);
            colors[i].a += weight;
        }
    };
    reader.read(decals.list(list), add);
}

using BucketTexels = std::array<Color, LEVEL_TEXELS * LEVEL_TEXELS>;

void add_cell(int column, int row, int side, const std::vector<Color>& colors, BucketTexels& texels) {
    constexpr float share = 1.0F / (texel_samples * texel_samples);
    for (int i = 0; i < side * side; ++i) {
        const int x = (column * side + i % side) / texel_samples;
        const int y = (row * side + i / side) / texel_samples;
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
    const int side = samples_across(decals, level);
    CellPoints<float> cell = samples_of(level, side);
    cell.bucket_column = bucket % static_cast<uint32_t>(decals.grid.columns);
    cell.bucket_row = bucket / static_cast<uint32_t>(decals.grid.columns);
    ListReader<float> reader(decals, cell);
    std::vector<Color> colors(cell.x.size());
    for (int i = 0; i < 1 << (2 * level); ++i) {
        const uint32_t list = decals.cells[(entry >> LEVEL_BITS) + static_cast<uint32_t>(i)];
        if (list == EMPTY_LIST)
            continue;
        const int column = i & ((1 << level) - 1), row = i >> level;
        cell.corner = {double(column) * cell_quanta(level), double(row) * cell_quanta(level)};
        compose(decals, reader, list, colors);
        if (side == 1 && level == 0)
            texels.fill(colors[0]);
        else
            add_cell(column, row, side, colors, texels);
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
