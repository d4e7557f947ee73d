// Vertices of tiles: places on the lattice, seen from straight above, and the colours of their decals.
layout(location = 0) in ivec2 place;
layout(location = 1) in uint decal;

uniform usamplerBuffer clipmap_decals;  // R, G, B, A of straight alpha; bits of half the width
uniform ivec2 tile_place;               // the tile's corner
uniform float clip_per_quantum;
uniform float opacity;

vec2 clip_place() {
    // The integer difference comes first: it is exact.
    return vec2(place - tile_place) * clip_per_quantum - 1.0;
}

// Premultiplied.
vec4 decal_color() {
    vec4 straight = unpackUnorm4x8(texelFetch(clipmap_decals, int(decal)).x);
    float alpha = straight.a * opacity;
    return vec4(straight.rgb * alpha, alpha);
}
