// Which decals cover a point, where all are plain strokes and even fills.
//
// A fetch brings four words, and each is worked on without a branch, as a header and as a point at once: neighbouring
// pixels walk in step.

// Whether a point is within a stroke's rectangle or the disc around the edge's end; `from` and `to` lead to the point
// from both ends of the edge. The disc around its beginning is that of the word before.
bool within_stroke(vec2 from, vec2 to, bool is_edge, float half_width2) {
    vec2 along = from - to;
    float length2 = dot(along, along);
    float t = dot(from, along);
    float across = from.x * along.y - from.y * along.x;
    bool beside = is_edge && across * across <= half_width2 * length2 && t > 0.0 && t <= length2;
    return beside || dot(to, to) <= half_width2;
}

struct Walk {
    vec2 local;         // the point, in quanta from the cell's corner
    float bias;
    vec2 at;            // the point, in the group's coordinates
    float half_width2;  // of the group's line
    vec2 from;          // from the last word's point to the point
    bool line;
    bool covered;  // by the group, as far as it is read
    uint slot;
#if defined(FINDS_COLORS)
    vec4 found;
#elif defined(FINDS_ANY)
    bool found;
#else
    uint found;
#endif
};

Walk begin_walk(Cell cell, vec2 local) {
    Walk walk;
    walk.local = local;
    walk.bias = bias_of(cell.bits);
#ifdef ONE_WIDTH
    walk.at = local * line_scale + walk.bias;
    walk.half_width2 = line_half_width * line_half_width;
#else
    walk.at = local + walk.bias;
    walk.half_width2 = 0.0;
#endif
    walk.from = vec2(0.0);
    walk.line = false;
    walk.covered = false;
    walk.slot = no_slot;
#if defined(FINDS_COLORS)
    walk.found = vec4(0.0);
#elif defined(FINDS_ANY)
    walk.found = false;
#else
    walk.found = no_slot;
#endif
    return walk;
}

bool is_settled(Walk walk) {
#if defined(FINDS_COLORS)
    return walk.found.a >= 0.999;
#elif defined(FINDS_ANY)
    // With one colour all is shown. What a stroke covers stays covered; a ring's next crossing may lead out again.
#if defined(LINES) && defined(RINGS)
    return walk.found || (walk.covered && walk.line);
#elif defined(LINES)
    return walk.found || walk.covered;
#else
    return walk.found;
#endif
#else
    return walk.found != no_slot;
#endif
}

void end_group(inout Walk walk, bool ends) {
#if defined(FINDS_COLORS)
    if (ends && walk.covered && !is_settled(walk)) {
        vec4 straight = color_of(walk.slot);
        walk.found += (1.0 - walk.found.a) * vec4(straight.rgb * straight.a, straight.a);
    }
#elif defined(FINDS_ANY)
    walk.found = walk.found || (ends && walk.covered);
#else
    walk.found = ends && walk.covered && walk.found == no_slot && is_shown(walk.slot) ? walk.slot : walk.found;
#endif
}

void open_group(inout Walk walk, uint header, bool begins) {
    walk.slot = begins ? header & SLOT_MASK : walk.slot;
    walk.covered = begins ? (header & COVERS) != 0u : walk.covered;
#if defined(LINES) && defined(RINGS)
    walk.line = begins ? is_line(header) : walk.line;
#endif
#if defined(LINES) && defined(RINGS) && defined(ONE_WIDTH)
    walk.at = begins ? walk.local * (walk.line ? line_scale : 1.0) + walk.bias : walk.at;
#elif defined(LINES) && !defined(ONE_WIDTH)
    if (begins) {
        vec2 stroke = is_line(header) ? stroke_of(header) : vec2(1.0, 0.0);
        walk.at = walk.local * stroke.x + walk.bias;
        walk.half_width2 = stroke.y * stroke.y;
    }
#endif
}

void end_group(inout Walk walk) {
    end_group(walk, true);
}

// Every word is taken for a point and for a header at once, without a branch: neighbouring pixels walk in step.
void read_word(inout Walk walk, uint word) {
    vec2 to = walk.at - point_of(word);
    bool is_edge = !starts_edge(word);
    bool header = is_header(word);
    bool covered = walk.covered;
#ifdef LINES
    bool hit = within_stroke(walk.from, to, is_edge, walk.half_width2);
#endif
#ifdef RINGS
    // Rounded as what leads from the border's points is: not to be simplified.
    precise vec2 corner = walk.at - walk.bias;
    bool crossed = is_edge && crosses_walk(walk.from, to, corner);
#endif
#if defined(LINES) && defined(RINGS)
    covered = walk.line ? covered || hit : covered != crossed;
#elif defined(LINES)
    covered = covered || hit;
#elif defined(RINGS)
    covered = covered != crossed;
#endif
    walk.from = to;
    walk.covered = header ? walk.covered : covered;
    end_group(walk, header);
    open_group(walk, word, header);
}
