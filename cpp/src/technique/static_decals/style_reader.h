// Style records on the CPU: the same tests as styles.glsl, for picking and for levels of detail.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "technique/static_decals/prepared_decals.h"
#include "vector/stroke_reach.h"

namespace decalgl {

constexpr double not_covered = 2.0;  // a share of a half width that no point is covered at

inline float float_of(uint32_t bits) {
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

inline Vector2 operator-(Vector2 a, Vector2 b) {
    return {a.x - b.x, a.y - b.y};
}

// One slot's style, as it is written in the tables.
class StyleReader {
public:
    StyleReader() = default;
    StyleReader(const PreparedDecals& decals, uint32_t slot) : half_width_(decals.styles[slot].half_width) {
        if (decals.kinds.size() == 0) {
            scale_ = line_scale(decals.styles[slot].half_width);
            return;
        }
        scale_ = static_cast<int>(decals.kinds[slot] & SCALE_MASK);
        record_ = &decals.style_records[decals.kinds[slot] >> SCALE_BITS];
    }

    bool is(uint32_t flag) const { return (record_[0][0] & flag) != 0; }
    int scale() const { return scale_; }
    void multiply_width(double factor) { half_width_ *= factor; }
    double half_width() const { return std::ldexp(half_width_, -scale_); }  // in units of the group's words
    double periods_per_unit() const {
        return is(STYLE_PATTERN) ? std::ldexp(double{float_of(record_[0][2])}, scale_) : 0.0;
    }

    // How wide the pattern lets the line be here, as a share; below 0 where there is no mark.
    double width_at(double periods) const {
        if (!is(STYLE_PATTERN))
            return 1.0;
        const double at = periods - std::floor(periods);
        double widest = -1.0;
        for (uint32_t i = 1; i <= mark_count(); ++i) {
            const StyleTexel& mark = record_[i];
            widest = std::max(
                widest,
                mark_width({float_of(mark[0]), float_of(mark[1]), float_of(mark[2]), float_of(mark[3])}, at));
        }
        return widest;
    }

    // The share of the half width at which a joined stroke's corner covers a point, to which `at` leads from there;
    // `incoming` and `outgoing` are the directions of the edges before and after it.
    double corner_share(Vector2 at, Vector2 incoming, Vector2 outgoing) const {
        return corner_reach(corner(), at, incoming, outgoing, -double{float_of(record_[0][1])}) /
               half_width();
    }

    // The same of a line without length, from whose place `at` leads.
    double dot_share(Vector2 at) const {
        const double reach =
            is(STYLE_SQUARE) ? std::max(std::abs(at.x), std::abs(at.y)) : std::hypot(at.x, at.y);
        return reach / half_width();
    }

    // Of those that there are, the one at a share of the half width.
    uint32_t band(double share) const {
        if (!is(STYLE_BANDS))
            return 0;
        const uint32_t first = 1 + mark_count(), last = (record_[0][3] >> BANDS_SHIFT) - 1;
        uint32_t i = 0;
        while (i < last && share > double{float_of(record_[first + i][0])})
            ++i;
        return i;
    }

    std::array<uint8_t, 4> color(std::array<uint8_t, 4> own, uint32_t band) const {
        if (!is(STYLE_BANDS))
            return own;
        std::array<uint8_t, 4> color{};
        std::memcpy(color.data(), &record_[1 + mark_count() + band][1], sizeof color);
        color[3] = static_cast<uint8_t>(std::lrint(color[3] * own[3] / 255.0));
        return color;
    }

    // Whether a hatch covers a place, in quanta from the corner of a bucket.
    bool hatch_covers(int64_t bucket_column, int64_t bucket_row, Vector2 inside) const {
        for (uint32_t set = 0; set < record_[0][2]; ++set) {
            const StyleTexel &step = record_[1 + 2 * set], &leap = record_[2 + 2 * set];
            const double spacings = inside.x * float_of(step[0]) + inside.y * float_of(step[1]) +
                                    float_of(step[2]) +
                                    static_cast<double>(bucket_column) * float_of(leap[0]) +
                                    static_cast<double>(bucket_row) * float_of(leap[1]);
            if (std::abs(spacings - std::round(spacings)) <= double{float_of(record_[0][1])})
                return true;
        }
        return false;
    }

private:
    Corner corner() const {
        return is(STYLE_BEVEL) ? Corner::bevel : is(STYLE_MITER) ? Corner::miter : Corner::round;
    }
    uint32_t mark_count() const { return record_[0][3] & COUNT_BITS_OF_MARKS; }

    static constexpr StyleTexel plain_{};
    const StyleTexel* record_ = &plain_;
    double half_width_ = 0.0;
    int scale_ = 0;
};

}  // namespace decalgl
