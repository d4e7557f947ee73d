// The tiles that are kept: of each level a window that follows the view, in a layer of one texture.
//
// A tile lies where its number is, modulo the window's size: so when the window moves, what stays inside of it stays where
// it is, and only what comes in is drawn. A small table says which tiles of the window may be read for the picture in
// hand; all others are blurred to the next coarser level.
#pragma once

#include <vector>

#include "gl/texture.h"
#include "technique/clipmap/virtual_texture.h"

namespace decalgl::clipmap {

class TileStore {
public:
    TileStore() = default;
    // `window`: tiles along the side of a level's window, a power of two.
    TileStore(int window, const MemoryAccount& memory);

    int window() const { return window_; }
    // No tile is there any more: what they are drawn from has changed.
    void forget();
    // Sets which tiles the picture in hand may read; returns those that are not there yet, coarse ones first. Those
    // beyond a level's window, which is where the most are wanted, are left out. `wanted`: as often as pixels ask.
    std::vector<Tile> choose(std::vector<Tile> wanted);
    // A tile of the last choice is there, and may be read.
    void set_drawn(const Tile& tile);
    // Uploads the table, after all that was chosen is settled.
    void upload_table();

    // Texels of a tile in its layer.
    int texel_x(const Tile& tile) const { return (tile.x & (window_ - 1)) * tile_texels; }
    int texel_y(const Tile& tile) const { return (tile.y & (window_ - 1)) * tile_texels; }

    const gl::Texture2D& texels() const { return texels_; }
    const gl::Texture2D& table() const { return table_; }
    size_t bytes() const { return texels_.bytes() + table_.bytes(); }

private:
    struct Slot {
        int x = -1;  // of the tile that is there
        int y = -1;
    };

    size_t slot_of(const Tile& tile) const;

    int window_ = 0;
    std::vector<Slot> slots_;
    std::vector<uint16_t> readable_;  // x + 1, y + 1 of the tile that may be read in each slot; 0: none
    gl::Texture2D texels_;            // RGBA8, premultiplied; a layer a level
    gl::Texture2D table_;             // x + 1, y + 1: columns of a window, rows of all windows
};

}  // namespace decalgl::clipmap
