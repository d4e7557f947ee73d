// Where in a pixel of very many cells a border passes, of a group's decals as they show.
//
// Points are looked at, the nearest to the pixel's centre first, until one shows something else than the centre; then halves
// of the way between the two. A straight border parts one of the pixel's corners from the others, so it is found.
//
//     +-------------/   o centre, probes     * between the last of one kind
//     |   .    .  /|                           and the first of the other
//     |        * / |
//     |   . o . / .|
//     +--------/---+

const int place_count = 16;
const vec2 places[place_count] =
    vec2[](vec2(0.25, 0.0), vec2(-0.25, 0.0), vec2(0.0, 0.25), vec2(0.0, -0.25), vec2(0.25, 0.25), vec2(-0.25, -0.25),
           vec2(-0.25, 0.25), vec2(0.25, -0.25), vec2(0.5, 0.0), vec2(-0.5, 0.0), vec2(0.0, 0.5), vec2(0.0, -0.5),
           vec2(0.5, 0.5), vec2(-0.5, -0.5), vec2(-0.5, 0.5), vec2(0.5, -0.5));

// The pixel's centre where no place shows something else; and where none is wanted.
ivec2 place_at_border(ivec2 point, mat2 foot, bool wanted) {
    ivec2 alike = point, other = point;
    // Beyond the grid no walk takes any time.
    ivec2 at = wanted ? point : grid_box.xy - 1;
    vec4 seen = vec4(0.0);
    int next = -1;
    bool found = false, more;
    do {
        vec4 color = walk(at).sum;
        if (next < 0) seen = color;
        bool differs = color != seen;
        if (found && !differs) alike = at;
        if (differs) other = at;
        found = found || differs;
        ++next;
        more = wanted && (found ? any(greaterThan(abs(other - alike), ivec2(1))) : next < place_count);
        at = found ? alike + (other - alike) / 2 : point + ivec2(roundEven(foot * places[next & (place_count - 1)]));
    } while (more);
    return other;
}
