#include "app/topojson.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

using Json = nlohmann::json;

/// Beyond it, sums of steps would no longer be exact in float64.
constexpr std::int64_t largest_position = std::int64_t{1} << 52;
/// A small file can refer to one long arc a million times.
constexpr std::size_t most_vertices = 50'000'000;

struct LatticePoint {
    std::int64_t x = 0;
    std::int64_t y = 0;
    bool operator==(const LatticePoint& other) const { return x == other.x && y == other.y; }
};

using Arc = std::vector<LatticePoint>;

struct Transform {
    double scale_x = 1.0;
    double scale_y = 1.0;
    double shift_x = 0.0;
    double shift_y = 0.0;
};

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
    throw Error(ErrorKind::file,
                fmt::format("'{}' is not a topology of polygons that can be drawn: {}. Write it "
                            "anew from its source.",
                            name, what));
}

class TopologyReader {
public:
    TopologyReader(const Json& topology, std::string name) : topology_(topology), name_(std::move(name)) {
        read_transform();
        read_arcs();
    }

    PolygonTable polygons(const std::string& object, const std::string& property) {
        PolygonTable table;
        for (const Json& geometry : topology_.at("objects").at(object).at("geometries")) {
            const std::string& type = geometry.at("type").get_ref<const std::string&>();
            const Json& arcs = geometry.at("arcs");
            if (type == "Polygon") {
                add_rings(arcs, table);
            } else if (type == "MultiPolygon") {
                for (const Json& member : list(arcs)) {
                    add_rings(member, table);
                }
            } else {
                refuse(name_, fmt::format("feature {} is a {}", table.values.size(), type));
            }
            table.feature_offsets.push_back(static_cast<std::int64_t>(table.part_offsets.size()) - 1);
            table.values.push_back(geometry.at("properties").at(property).get<std::string>());
        }
        return table;
    }

private:
    /// An array; iterating over anything else would visit its values or itself.
    const Json& list(const Json& value) const {
        if (!value.is_array()) {
            refuse(name_, fmt::format("there is a {} in place of a list", value.type_name()));
        }
        return value;
    }

    std::int64_t whole(const Json& value) const {
        if (!value.is_number_integer()) {
            refuse(name_, fmt::format("there is a {} in place of a whole number", value.type_name()));
        }
        // Judged as float64, since what does not fit into 64 bits with a sign would turn into something else.
        if (std::abs(value.get<double>()) > static_cast<double>(largest_position)) {
            refuse(name_, fmt::format("the number {} is out of range", value.dump()));
        }
        return value.get<std::int64_t>();
    }

    void read_transform() {
        const Json& scale = topology_.at("transform").at("scale");
        const Json& shift = topology_.at("transform").at("translate");
        transform_ = {scale.at(0).get<double>(), scale.at(1).get<double>(), shift.at(0).get<double>(),
                      shift.at(1).get<double>()};
    }

    void read_arcs() {
        for (const Json& steps : list(topology_.at("arcs"))) {
            Arc arc;
            arc.reserve(list(steps).size());
            LatticePoint position;
            for (const Json& step : steps) {
                position.x += whole(list(step).at(0));
                position.y += whole(step.at(1));
                if (std::max(std::abs(position.x), std::abs(position.y)) > largest_position) {
                    refuse(name_, fmt::format("arc {} leaves the lattice", arcs_.size()));
                }
                arc.push_back(position);
            }
            if (arc.size() < 2) {
                refuse(name_, fmt::format("arc {} has less than two positions", arcs_.size()));
            }
            arcs_.push_back(std::move(arc));
        }
    }

    void add_rings(const Json& rings, PolygonTable& table) {
        for (const Json& references : list(rings)) {
            ring_.clear();
            for (const Json& reference : list(references)) {
                add_arc(whole(reference), table.values.size());
            }
            if (ring_.size() < 3 || !(ring_.front() == ring_.back())) {
                refuse(name_, fmt::format("a ring of feature {} is not closed", table.values.size()));
            }
            ring_.pop_back();
            vertices_ += ring_.size();
            if (vertices_ > most_vertices) {
                throw Error(ErrorKind::memory,
                            fmt::format("The rings of '{}' have more than {} vertices. Split it "
                                        "into smaller files.",
                                        name_, most_vertices));
            }
            for (const LatticePoint& point : ring_) {
                table.coordinates.push_back(static_cast<double>(point.x) * transform_.scale_x +
                                            transform_.shift_x);
                table.coordinates.push_back(static_cast<double>(point.y) * transform_.scale_y +
                                            transform_.shift_y);
            }
            table.part_offsets.push_back(static_cast<std::int64_t>(table.coordinates.size() / 2));
        }
    }

    /// Appends arc `reference`, or ~reference backwards, to the ring; its first position is there already.
    void add_arc(std::int64_t reference, std::size_t feature) {
        const bool backwards = reference < 0;
        const auto index = static_cast<std::uint64_t>(backwards ? ~reference : reference);
        if (index >= arcs_.size()) {
            refuse(name_, fmt::format("feature {} refers to arc {}, but there are {}", feature, index,
                                      arcs_.size()));
        }
        const Arc& arc = arcs_[index];
        const LatticePoint& start = backwards ? arc.back() : arc.front();
        if (ring_.empty()) {
            ring_.push_back(start);
        } else if (!(ring_.back() == start)) {
            refuse(name_, fmt::format("the arcs of feature {} do not meet", feature));
        }
        if (ring_.size() + arc.size() > most_vertices) {
            refuse(name_,
                   fmt::format("a ring of feature {} has more than {} vertices", feature, most_vertices));
        }
        if (backwards) {
            ring_.insert(ring_.end(), arc.rbegin() + 1, arc.rend());
        } else {
            ring_.insert(ring_.end(), arc.begin() + 1, arc.end());
        }
    }

    const Json& topology_;
    std::string name_;
    Transform transform_;
    std::vector<Arc> arcs_;
    Arc ring_;  // the one that is put together, with its first position repeated at the end
    std::size_t vertices_ = 0;
};

}  // namespace

PolygonTable parse_topojson(std::string_view text, const std::string& object, const std::string& property,
                            const std::string& name) {
    try {
        const Json topology = Json::parse(text.begin(), text.end());
        return TopologyReader(topology, name).polygons(object, property);
    } catch (const Json::exception& error) {
        refuse(name, error.what());
    }
}

}  // namespace decalgl
