// Puts parts of features into lines, one after the other: vertices on the lattice, cut off at its box.
#pragma once

#include <vector>

#include "decalgl/core/memory.h"
#include "decalgl/vector/features.h"
#include "technique/dynamic_lines/line_buffers.h"
#include "technique/dynamic_lines/line_lattice.h"

namespace decalgl {

// Where the lines of a feature belong, and what they need to know.
struct LinePurpose {
    uint32_t slot = 0;
    double arc_length = 0.0;  // metres that 2^32 in `arc` stand for; 0: no pattern asks for it
    bool has_sides = false;   // whether it matters on which side a ring's inside lies
};

class LineWriter {
public:
    LineWriter(const LineLattice& lattice, const MemoryAccount& memory);

    void add(const Features& features, size_t feature, const LinePurpose& purpose);
    // Lines that were written before, for another slot.
    void copy(Span<const LineRecord> lines, Span<const SourceVertex> vertices, uint32_t slot);

    std::vector<SourceVertex> vertices;
    std::vector<LineRecord> lines;
    uint64_t segments = 0;

private:
    struct Point {
        double x;
        double y;
    };

    bool clip(Point& a, Point& b) const;
    void add_part(Span<const double> xy, bool ring, uint32_t flags);
    void write(const std::vector<Point>& chain, bool closed, uint32_t flags);
    void push(Point point, double arc);
    void finish(uint32_t flags);
    void require_room();

    LineLattice lattice_;
    Bounds box_;
    MemoryCharge charge_;
    LinePurpose purpose_;
    size_t first_ = 0;  // vertex of the line in hand
};

}  // namespace decalgl
