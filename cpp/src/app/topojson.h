#pragma once

// Polygons from TopoJSON: borders are stored once as arcs, and rings refer to arcs.
//
//     arcs        each a list of steps (dx, dy) on an integer lattice, the first from its origin
//     transform   position = lattice * scale + translate
//     rings       lists of arc numbers; ~n is arc n backwards; the next arc begins where the last one ends
//
// See https://github.com/topojson/topojson-specification. Only what maps of areas need is read: Polygon and
// MultiPolygon, in one object, with one text property each.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace decalgl {

/// As in Features: rings of all members of a feature are its parts, closed implicitly.
struct PolygonTable {
    std::vector<double> coordinates;  ///< x, y
    std::vector<std::int64_t> part_offsets{0};
    std::vector<std::int64_t> feature_offsets{0};
    std::vector<std::string> values;  ///< the property, one a feature
};

/// The polygons of `object` with their `property`; `name` stands for the text in messages. Throws Error(file)
/// where the text is not such a topology, and Error(memory) where its rings add up to unreasonably many
/// vertices.
PolygonTable parse_topojson(std::string_view text, const std::string& object, const std::string& property,
                            const std::string& name);

}  // namespace decalgl
