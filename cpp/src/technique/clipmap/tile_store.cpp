#include "technique/clipmap/tile_store.h"

#include <algorithm>
#include <iterator>

namespace decalgl::clipmap {
namespace {

// Where a window begins along one axis, so that the most of these numbers, rising, are inside.
int best_window(std::vector<int> numbers, int window) {
    std::sort(numbers.begin(), numbers.end());
    size_t begin = 0, most = 0;
    int best = 0;
    for (size_t end = 0; end < numbers.size(); ++end) {
        while (numbers[end] - numbers[begin] >= window)
            ++begin;
        if (end + 1 - begin > most) {
            most = end + 1 - begin;
            best = numbers[begin];
        }
    }
    return best;
}

// Keeps those in the window that the most of them are in; tiles stand there as often as they are wanted.
void cut_to_window(std::vector<Tile>& tiles, int window) {
    std::vector<int> columns, rows;
    for (const Tile& tile : tiles)
        columns.push_back(tile.x);
    const int left = best_window(columns, window);
    for (const Tile& tile : tiles)
        if (tile.x >= left && tile.x < left + window)
            rows.push_back(tile.y);
    const int bottom = best_window(rows, window);
    const auto outside = [&](const Tile& tile) {
        return tile.x < left || tile.y < bottom || tile.x >= left + window || tile.y >= bottom + window;
    };
    tiles.erase(std::remove_if(tiles.begin(), tiles.end(), outside), tiles.end());
    tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
}

}  // namespace

TileStore::TileStore(int window, const MemoryAccount& memory)
    : window_(window),
      slots_(static_cast<size_t>(window) * static_cast<size_t>(window) * level_count),
      readable_(2 * slots_.size(), 0) {
    texels_ = gl::Texture2D::create_array(memory, "clipmap: tiles", GL_RGBA8, window * tile_texels,
                                          window * tile_texels, level_count);
    table_ = gl::Texture2D::create(memory, "clipmap: table", GL_RGBA16UI, window, window * level_count);
}

void TileStore::forget() {
    std::fill(slots_.begin(), slots_.end(), Slot{});
}

size_t TileStore::slot_of(const Tile& tile) const {
    const int mask = window_ - 1;
    return static_cast<size_t>((tile.level * window_ + (tile.y & mask)) * window_ + (tile.x & mask));
}

std::vector<Tile> TileStore::choose(std::vector<Tile> wanted) {
    std::sort(wanted.begin(), wanted.end());
    std::fill(readable_.begin(), readable_.end(), uint16_t{0});
    std::vector<Tile> missing;
    for (int level = 0; level < level_count; ++level) {
        std::vector<Tile> tiles;
        std::copy_if(wanted.begin(), wanted.end(), std::back_inserter(tiles),
                     [&](const Tile& tile) { return tile.level == level; });
        if (tiles.empty())
            continue;
        cut_to_window(tiles, window_);
        for (const Tile& tile : tiles) {
            const Slot& slot = slots_[slot_of(tile)];
            if (slot.x == tile.x && slot.y == tile.y)
                set_drawn(tile);
            else
                missing.push_back(tile);
        }
    }
    return missing;
}

void TileStore::set_drawn(const Tile& tile) {
    const size_t slot = slot_of(tile);
    slots_[slot] = {tile.x, tile.y};
    readable_[2 * slot] = static_cast<uint16_t>(tile.x + 1);
    readable_[2 * slot + 1] = static_cast<uint16_t>(tile.y + 1);
}

void TileStore::upload_table() {
    std::vector<uint16_t> texels(4 * slots_.size(), 0);
    for (size_t i = 0; i < slots_.size(); ++i) {
        texels[4 * i] = readable_[2 * i];
        texels[4 * i + 1] = readable_[2 * i + 1];
    }
    table_.update(0, 0, 0, table_.width(), table_.height(), texels.data());
}

}  // namespace decalgl::clipmap
