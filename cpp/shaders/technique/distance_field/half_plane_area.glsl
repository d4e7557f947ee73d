// How much of a pixel's square a half plane covers, exactly.
//
// `distance`: pixels from the pixel's centre to the border, above 0 where the centre is inside. `normal`: the border's
// unit normal; only the size of its parts matters.
float half_plane_area(float distance, vec2 normal) {
    vec2 n = abs(normal);
    float a = max(n.x, n.y), b = min(n.x, n.y);
    float most = 0.5 * (a + b), least = 0.5 * (a - b);
    float size = abs(distance);
    float corner = max(most - size, 0.0);
    float outside = size <= least ? 0.5 - size / a : corner * corner / max(2.0 * a * b, 1e-12);
    return distance >= 0.0 ? 1.0 - outside : outside;
}

// Of a strip: `half_width` and the distance of the pixel's centre from the strip's middle.
float strip_area(float distance, float half_width, vec2 normal) {
    return max(half_plane_area(half_width - distance, normal) + half_plane_area(half_width + distance, normal) - 1.0, 0.0);
}
