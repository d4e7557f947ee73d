// Where a tile's segments stand in the list. Each place has become the next one's first when the list was filled.
uniform usamplerBuffer tile_places;
uniform ivec2 tile_grid;
uniform int run_count;

ivec2 range_of_tile(int tile) {
    int at = tile * run_count;
    int begin = at == 0 ? 0 : int(texelFetch(tile_places, at - 1).r);
    return ivec2(begin, texelFetch(tile_places, at + run_count - 1).r);
}
