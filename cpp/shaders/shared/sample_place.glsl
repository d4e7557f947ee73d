// Where in a pixel a sample lies whose places follow a straight border.
//
//     across the border   so that the share of the pixel beyond each sample, as far as a border in this direction cuts it
//                         off, is one of (i + 1/2) / n: such a border errs by 1 / 2n of the pixel at most
//     along it            anywhere from side to side, by bits in reversed order (Hammersley 1960)
//
// All features are asked at the same places, so neighbours that share a border leave nothing open.

// How far from the centre a line cuts off a share of the square; `narrow`, `wide`: its normal's parts, of sum 1.
float quantile(float share, float narrow, float wide) {
    float least = min(share, 1.0 - share);
    float from_corner = least * 2.0 * wide < narrow ? sqrt(2.0 * least * wide * narrow) : least * wide + 0.5 * narrow;
    return share < 0.5 ? from_corner - 0.5 : 0.5 - from_corner;
}

// Of one of `count` samples. `growth`: of the distance from the border for a pixel to the right and one up.
vec2 sample_place(vec2 growth, int index, int count) {
    float share = (float(index) + 0.5) / float(count);
    float place = (float(bitfieldReverse(uint(index)) >> 16) + 0.5) / 65536.0;
    float sum = abs(growth.x) + abs(growth.y);
    vec2 normal = sum > 0.0 ? growth / sum : vec2(1.0, 0.0);
    float wide = max(abs(normal.x), abs(normal.y));
    vec2 middle = normal * quantile(share, 1.0 - wide, wide) / dot(normal, normal);
    // The line through there, from side to side of the pixel.
    vec2 along = vec2(-normal.y, normal.x);
    vec2 steps = mix(along, vec2(1e-6), lessThan(abs(along), vec2(1e-6)));
    vec2 one = (-0.5 - middle) / steps, other = (0.5 - middle) / steps;
    vec2 begins = min(one, other), ends = max(one, other);
    return middle + along * mix(max(begins.x, begins.y), min(ends.x, ends.y), place);
}
