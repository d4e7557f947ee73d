// A stroke that is narrower than the squares that a cell's points lie in, for levels of detail.
//
// Whether it covers a point says little about the square. So the share that it covers of each square is found, and points
// stand for as many squares as that is in all: what a square has too little of or too much goes to the next one, as
// in error diffusion (Floyd and Steinberg 1976) along one line.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vector/stroke_reach.h"

namespace decalgl {

template <typename Real>
class ThinStroke {
public:
    // `side` x `side` squares of a cell, one for each of its points; in units of a group's words from now on, where
    // the cell's corner is at `corner` in both directions.
    void begin(size_t side, Real square, Real corner) {
        carried_ = none_;
        if (square == square_ && corner == corner_)
            return;
        square_ = square;
        corner_ = corner;
        covered_.resize(side * side);
        middles_.resize(side);
        for (size_t i = 0; i < side; ++i)
            middles_[i] = (static_cast<Real>(i) + Real(0.5)) * square + corner;
    }

    // Squares from `first` to before `last` may meet it. From a point to itself it is a disc, which stands for the caps
    // at both ends of what begins there.
    void add_edge(Vector2 from, Vector2 to, Real radius, size_t first, size_t last) {
        // What is carried on begins the same wherever the stroke is drawn again, and differs between strokes.
        if (carried_ == none_)
            carried_ = fraction(golden_ratio_ * (from.x + 181.0 * from.y));
        const auto dx = static_cast<Real>(to.x - from.x), dy = static_cast<Real>(to.y - from.y);
        const Real apart = std::sqrt(dx * dx + dy * dy);
        const Real ux = apart > 0 ? dx / apart : Real(1), uy = apart > 0 ? dy / apart : Real(0);
        const Real cap = apart > 0 ? Real(0) : radius * quarter_turn_ / 2;
        const Real x0 = static_cast<Real>(from.x) - cap, y0 = static_cast<Real>(from.y);
        const Real length = apart + 2 * cap;
        // Squares as wide as this across the edge, the shares of a row, or of a column, add up to the stroke's width.
        const Real half = square_ / 2 * std::max(std::abs(ux), std::abs(uy)),
                   per_area = 1 / (4 * half * half);
        const auto shared = [half](Real low, Real high) {
            return std::max(std::min(high, half) - std::max(low, -half), Real(0));
        };
        const size_t side = middles_.size();
        for (size_t row = first / side; row < last / side; ++row) {
            const Real py = middles_[row] - y0;
            Real* covered = &covered_[row * side];
            for (size_t i = 0; i < side; ++i) {
                const Real px = middles_[i] - x0;
                const Real along = px * ux + py * uy, beside = px * uy - py * ux;
                covered[i] +=
                    shared(beside - radius, beside + radius) * shared(along - length, along) * per_area;
            }
        }
    }

    // Gives the points that stand for it their share of the half width, and forgets it.
    void spread(size_t first, size_t last, std::vector<Real>& shares) {
        for (size_t i = first; i < last; ++i) {
            carried_ += std::min(covered_[i], Real(1));
            covered_[i] = 0;
            if (carried_ < 1)
                continue;
            shares[i] = 0;
            carried_ -= 1;
        }
    }

private:
    static Real fraction(double turns) { return static_cast<Real>(turns - std::floor(turns)); }

    static constexpr double golden_ratio_ = 0.6180339887498949;
    static constexpr Real quarter_turn_ = static_cast<Real>(1.5707963267948966);
    static constexpr Real none_ = -1;
    Real square_ = 0, corner_ = 0;
    Real carried_ = none_;
    std::vector<Real> middles_;  // of squares, along a side
    std::vector<Real> covered_;  // of each square
};

}  // namespace decalgl
