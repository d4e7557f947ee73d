#include "app/isolines.h"

#include <array>
#include <cmath>
#include <glm/vec2.hpp>
#include <unordered_map>
#include <unordered_set>

namespace decalgl {
namespace {

//     NW ◀── N ─── NE       A line crosses the sides whose ends lie on different sides of the level. Going
//      │            ▲       around counterclockwise, it comes in where the ground falls from one corner to
//      W            E       the next and leaves where it rises, so that one quad's way out is the way in of
//      ▼            │       its neighbour.
//     SW ─── S ──▶ SE
class Isolines {
public:
    Isolines(const Heightfield& heightfield, double level) : heightfield_(heightfield), level_(level) {
        for (std::int32_t row = 0; row + 1 < heightfield.rows(); ++row) {
            for (std::int32_t column = 0; column + 1 < heightfield.columns(); ++column) {
                cross_quad(row, column);
            }
        }
    }

    void append_to(Polylines& lines) {
        std::unordered_set<std::int64_t> entered;
        for (const std::int64_t way : ways_) {
            entered.insert(next_.at(way));
        }
        for (const std::int64_t start : ways_) {
            if (entered.find(start) == entered.end()) {
                follow(start, lines);
            }
        }
        // What is left runs in circles.
        for (const std::int64_t start : ways_) {
            follow(start, lines);
        }
    }

private:
    /// The sides of a quad, counterclockwise from the western one; two numbers are kept for each sample.
    std::array<std::int64_t, 4> sides_of(std::int32_t row, std::int32_t column) const {
        const std::int64_t sample = std::int64_t{row} * heightfield_.columns() + column;
        return {2 * sample + 1, 2 * (sample + heightfield_.columns()), 2 * (sample + 1) + 1, 2 * sample};
    }

    void cross_quad(std::int32_t row, std::int32_t column) {
        const std::array<double, 4> heights{
            heightfield_.height(row, column), heightfield_.height(row + 1, column),
            heightfield_.height(row + 1, column + 1), heightfield_.height(row, column + 1)};
        const double sum = heights[0] + heights[1] + heights[2] + heights[3];
        std::array<bool, 4> high;
        int count = 0;
        for (std::size_t corner = 0; corner < 4; ++corner) {
            high[corner] = heights[corner] > level_;
            count += high[corner] ? 1 : 0;
        }
        if (count == 0 || count == 4 || std::isnan(sum)) {
            return;
        }
        // Two opposite high corners are joined where the middle is high.
        const std::size_t direction = sum > 4.0 * level_ ? 1 : 3;
        const std::array<std::int64_t, 4> sides = sides_of(row, column);
        for (std::size_t side = 0; side < 4; ++side) {
            if (high[side] && !high[(side + 1) % 4]) {
                std::size_t out = side;
                do {
                    out = (out + direction) % 4;
                } while (high[out] || !high[(out + 1) % 4]);
                next_.emplace(sides[side], sides[out]);
                ways_.push_back(sides[side]);
            }
        }
    }

    glm::dvec2 crossing(std::int64_t side) const {
        const auto row = static_cast<std::int32_t>(side / 2 / heightfield_.columns());
        const auto column = static_cast<std::int32_t>(side / 2 % heightfield_.columns());
        const bool southwards = side % 2 == 1;
        const double start = heightfield_.height(row, column);
        const double end =
            southwards ? heightfield_.height(row + 1, column) : heightfield_.height(row, column + 1);
        const double share = (level_ - start) / (end - start);
        return {heightfield_.x0() + (column + (southwards ? 0.0 : share)) * heightfield_.dx(),
                heightfield_.y0() - (row + (southwards ? share : 0.0)) * heightfield_.dy()};
    }

    /// Walks from side to side, taking up each way, until there is none left.
    void follow(std::int64_t side, Polylines& lines) {
        auto way = next_.find(side);
        if (way == next_.end()) {
            return;
        }
        append(crossing(side), lines);
        while (way != next_.end()) {
            side = way->second;
            next_.erase(way);
            append(crossing(side), lines);
            way = next_.find(side);
        }
        lines.offsets.push_back(static_cast<std::int64_t>(lines.coordinates.size() / 2));
    }

    static void append(glm::dvec2 point, Polylines& lines) {
        lines.coordinates.push_back(point.x);
        lines.coordinates.push_back(point.y);
    }

    const Heightfield& heightfield_;
    double level_;
    std::vector<std::int64_t> ways_;  // sides by which lines come into a quad, in the order of the quads
    std::unordered_map<std::int64_t, std::int64_t> next_;  // the side by which they leave it
};

}  // namespace

void append_isolines(const Heightfield& heightfield, double level, Polylines& lines) {
    Isolines(heightfield, level).append_to(lines);
}

}  // namespace decalgl
