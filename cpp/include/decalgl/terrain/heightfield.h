// A heightfield: samples on a regular grid and the exact surface over them.
//
//     NW ────── NE      Each quad of samples is two triangles, split from its north-western to its
//     │ ╲        │      south-eastern sample. The surface ends at the outer samples. A triangle with a
//     │    ╲     │      missing sample is a hole.
//     SW ────── SE
#pragma once

#include <cstdint>
#include <limits>

#include "decalgl/core/position_grid.h"
#include "decalgl/core/shared_array.h"

namespace decalgl {

class Heightfield {
public:
    Heightfield() = default;

    // heights[row * columns + column] in metres, row 0 the northernmost, NaN where there is none. Sample (0,
    // 0) lies at (x0, y0); columns go east by dx, rows south by dy, both positive. Throws Error(input).
    Heightfield(SharedArray<float> heights, int32_t rows, int32_t columns, double x0, double y0, double dx,
                double dy);

    // Level ground at one height.
    static Heightfield flat(const Bounds& bounds, float height);

    // The same samples with heights times `factor`, rounded to float32: that is the surface drawn.
    Heightfield exaggerated(double factor) const;

    int32_t rows() const { return rows_; }
    int32_t columns() const { return columns_; }
    double x0() const { return x0_; }
    double y0() const { return y0_; }
    double dx() const { return dx_; }
    double dy() const { return dy_; }
    const SharedArray<float>& heights() const { return heights_; }
    float height(int32_t row, int32_t column) const {
        return heights_[static_cast<size_t>(row) * static_cast<size_t>(columns_) +
                        static_cast<size_t>(column)];
    }
    // Of the surface at a place, which goes on level beyond the outer samples; NaN in holes and where the place is no number.
    double height_at(double x, double y) const;
    Bounds bounds() const;
    // Of the samples there are; above each other where there is none.
    float lowest() const { return lowest_; }
    float highest() const { return highest_; }

private:
    void measure();

    SharedArray<float> heights_;
    int32_t rows_ = 0;
    int32_t columns_ = 0;
    double x0_ = 0.0;
    double y0_ = 0.0;
    double dx_ = 1.0;
    double dy_ = 1.0;
    float lowest_ = std::numeric_limits<float>::infinity();
    float highest_ = -std::numeric_limits<float>::infinity();
};

}  // namespace decalgl
