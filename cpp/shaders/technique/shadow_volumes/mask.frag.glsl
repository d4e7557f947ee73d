// What lies inside of volumes, by the stencil: a group's colour.
//
// IDS    1 + id of a decal
#ifdef IDS
layout(location = 0) out uint out_id;
uniform uint id;
#else
layout(location = 0) out vec4 out_color;
uniform vec4 color;  // premultiplied
#endif

void main() {
#ifdef IDS
    out_id = id + 1u;
#else
    out_color = color;
#endif
}
