#include "technique/dynamic_lines/line_set.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "decalgl/core/error.h"
#include "decalgl/terrain/heightfield.h"
#include "gl/texture.h"
#include "shared/view_block.h"
#include "technique/dynamic_lines/dispatch.h"
#include "technique/dynamic_lines/prefix_sum.h"

namespace decalgl {
namespace {

constexpr uint64_t most_matched = uint64_t{1} << 27;  // texels of a buffer that the drivers known address

constexpr GLuint ground_unit = 10;  // that no program takes for something else

struct MatchGrid {
    glm::dvec4 grid;
    glm::dvec4 steps;
};

MatchGrid match_grid(const LineLattice& lattice, const Heightfield& terrain) {
    const double longest = 0.5 * std::min(terrain.dx(), terrain.dy());
    return {{lattice.quantum / terrain.dx(), (lattice.origin_x - terrain.x0()) / terrain.dx(),
             -lattice.quantum / terrain.dy(), (terrain.y0() - lattice.origin_y) / terrain.dy()},
            {lattice.quantum, longest / lattice.quantum, 0.0, 0.0}};
}

// What the sums of the pieces come to, before any of it is allocated.
uint64_t matched_vertices(const PreparedLines& prepared, double longest) {
    uint64_t total = 0;
    const Span<const SourceVertex> vertices = prepared.vertices.span();
    for (size_t i = 0; i < vertices.size(); ++i) {
        const bool ends = i + 1 == vertices.size() || vertices[i + 1].line != vertices[i].line;
        const double length =
            ends ? 0.0 : glm::distance(glm::dvec2(vertices[i + 1].place), glm::dvec2(vertices[i].place));
        total += length > longest ? static_cast<uint64_t>(length / longest) + 1 : 1;
    }
    return total;
}

gl::TextureBuffer make_records(const MemoryAccount& memory, const std::string& name, uint64_t count,
                               const void* data = nullptr) {
    return gl::TextureBuffer::create(memory, "dynamic: " + name, GL_RGBA32UI,
                                     16 * std::max<uint64_t>(count, 1), data);
}

// Of each line the metres that 2^32 in `arc` stand for; empty where none has a pattern.
std::vector<float> arc_lengths(const PreparedLines& prepared) {
    std::vector<float> lengths;
    if (!prepared.summary.has_arcs)
        return lengths;
    for (const LineRecord& line : prepared.lines)
        lengths.push_back(static_cast<float>(arc_length(prepared.styles[line.slot], prepared.patterns)));
    return lengths;
}

void bind_source(gl::Program& program, const gl::TextureBuffer& vertices, const gl::TextureBuffer& lines) {
    program.set("source_vertices", 0);
    vertices.bind(0);
    program.set("source_lines", 1);
    lines.bind(1);
}

}  // namespace

void set_ground_slack(gl::Program& program, const View& view) {
    program.set("ground_slack", static_cast<float>(ground_slack + view.terrain_error));
}

void bind_ground(gl::Program& program, const gl::Texture2D& heights, const View& view) {
    program.set("ground_samples", static_cast<int>(ground_unit));
    heights.bind(ground_unit);
    set_ground_slack(program, view);
}

LatticeBase::LatticeBase(const LineLattice& lattice, const View& view)
    : quantum(static_cast<float>(lattice.quantum)) {
    const ViewBlock& block = *view.block;
    const auto split = [&](double metres, int32_t& whole, float& remainder) {
        const double limit = lattice_reach;
        whole = static_cast<int32_t>(std::lrint(std::clamp(metres / lattice.quantum, -limit, limit)));
        remainder = static_cast<float>(metres - whole * lattice.quantum);
    };
    const auto from_origin = [&](double grid_origin, int32_t blocks, float offset, double origin) {
        return (grid_origin - origin) + blocks * view.positions.block_size + static_cast<double>(offset);
    };
    split(from_origin(view.positions.origin_x, block.base_block.x, block.base_offset.x, lattice.origin_x),
          place.x, rest.x);
    split(from_origin(view.positions.origin_y, block.base_block.y, block.base_offset.y, lattice.origin_y),
          place.y, rest.y);
}

void LatticeBase::set(gl::Program& program) const {
    program.set("base_place", place);
    program.set("base_rest", rest);
    program.set("quantum", quantum);
}

MatchedLines match_lines(const PreparedLines& prepared, const TerrainView& terrain,
                         const MemoryAccount& memory, gl::ProgramLibrary& programs) {
    const MatchGrid grid = match_grid(prepared.lattice, *terrain.samples);
    const uint64_t total = matched_vertices(prepared, grid.steps.y);
    if (total > most_matched)
        throw Error(ErrorKind::memory,
                    "dynamic lines: cut to half the terrain's sample distance, they have " +
                        std::to_string(total) + " vertices, more than the " + std::to_string(most_matched) +
                        " that a buffer holds; draw a part of them, or resample the terrain");
    const auto source_count = static_cast<uint32_t>(prepared.vertices.size());
    MatchedLines matched;
    matched.lattice = prepared.lattice;
    matched.ground = terrain.heights;
    matched.line_count = static_cast<uint32_t>(prepared.lines.size());
    const gl::TextureBuffer vertices = make_records(memory, "source", source_count, prepared.vertices.data());
    const gl::TextureBuffer lines = make_records(memory, "source", matched.line_count, prepared.lines.data());
    // A word more, which becomes the sum of all.
    gl::TextureBuffer offsets = gl::TextureBuffer::create(memory, "dynamic: source", GL_R32UI,
                                                          sizeof(uint32_t) * (source_count + size_t{1}));
    offsets.buffer().clear();
    const gl::Buffer block = gl::Buffer::create(memory, "dynamic: source", sizeof(MatchGrid), &grid);
    block.bind_base(GL_UNIFORM_BUFFER, 1);

    gl::Program& count = programs.get("dynamic_count_pieces");
    bind_source(count, vertices, lines);
    dispatch(count, source_count, [&](uint32_t first, uint32_t items) {
        bind_records(0, offsets.buffer(), sizeof(uint32_t), first, items);
    });
    PrefixSum(source_count + 1, memory).run(offsets.buffer(), source_count + 1, programs);
    offsets.buffer().read(sizeof(uint32_t) * source_count, sizeof(uint32_t), &matched.vertex_count);
    matched.segment_count = matched.vertex_count - matched.line_count;

    matched.vertices = make_records(memory, "vertices", matched.vertex_count);
    const std::vector<float> lengths = arc_lengths(prepared);
    gl::TextureBuffer length_of_lines;
    if (!lengths.empty()) {
        matched.arcs =
            gl::TextureBuffer::create(memory, "dynamic: vertices", GL_R32UI,
                                      sizeof(uint32_t) * std::max<size_t>(matched.vertex_count, 1));
        length_of_lines = gl::TextureBuffer::from(memory, "dynamic: source", GL_R32F, lengths);
    }
    gl::Program& match = programs.get("dynamic_match", lengths.empty() ? gl::Flags{} : gl::Flags{"ARCS"});
    bind_source(match, vertices, lines);
    match.set("piece_offsets", 2);
    offsets.bind(2);
    match.set("heights", 3);
    terrain.heights->bind(3);
    match.set("stand_in_height", terrain.samples->lowest());
    if (matched.arcs) {
        match.set("arc_lengths", 4);
        length_of_lines.bind(4);
    }
    dispatch(match, matched.vertex_count, [&](uint32_t first, uint32_t items) {
        bind_records(0, matched.vertices.buffer(), sizeof(MatchedVertex), first, items);
        if (matched.arcs)
            bind_records(1, matched.arcs.buffer(), sizeof(uint32_t), first, items);
    });

    matched.lines = make_records(memory, "lines", matched.line_count);
    gl::Program& match_records = programs.get("dynamic_match_lines");
    match_records.set("source_lines", 1);
    match_records.set("piece_offsets", 2);
    dispatch(match_records, matched.line_count, [&](uint32_t first, uint32_t items) {
        bind_records(0, matched.lines.buffer(), sizeof(LineRecord), first, items);
    });
    return matched;
}

}  // namespace decalgl
