// Colours of heat maps.
uniform float heat_top;

// From dark blue over green and yellow to red.
vec4 heat(int count) {
    float t = clamp(float(count) / heat_top, 0.0, 1.0);
    vec3 color = clamp(vec3(2.0 * t - 0.6, 1.6 - abs(3.2 * t - 1.6), 0.9 - 2.2 * t), 0.0, 1.0);
    return count == 0 ? vec4(0.0, 0.0, 0.15, 1.0) : vec4(color, 1.0);
}
