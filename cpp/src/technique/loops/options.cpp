// What may be chosen, checked.
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "decalgl/core/error.h"
#include "decalgl/technique/loops_options.h"
#include "technique/loops/loops_layout.h"

namespace decalgl {
namespace {

void require(bool is_right, const std::string& message) {
    if (!is_right)
        throw Error(ErrorKind::input, message);
}

// A whole number squared, from 4 on.
bool is_branching(uint32_t children) {
    const auto side = static_cast<uint32_t>(std::lrint(std::sqrt(double(children))));
    return side >= 2 && side * side == children && side <= 64;
}

auto tied(const DetailEye& eye) {
    return std::tie(eye.eye, eye.forward, eye.pixels, eye.corner, eye.metres_per_pixel);
}

bool operator==(const DetailStep& a, const DetailStep& b) {
    return a.distance == b.distance && a.tolerance == b.tolerance;
}

auto tied(const LoopsDetail& detail) {
    return std::make_tuple(detail.uniform, detail.screen, detail.lens, detail.lens_centre, detail.lens_radius,
                           detail.has_eye, tied(detail.eye), detail.shows, detail.heat_top);
}

auto tied(const LoopsBvh& bvh) {
    return std::tie(bvh.primary_branching, bvh.node_capacity, bvh.largest_share, bvh.secondary_depths,
                    bvh.secondary_branching, bvh.coverage_depth, bvh.minimum_coverage);
}

bool same(const std::optional<LoopsBvh>& a, const std::optional<LoopsBvh>& b) {
    return a && b ? tied(*a) == tied(*b) : !a && !b;
}

void validate(const LoopsBvh& bvh) {
    for (const auto* levels : {&bvh.primary_branching, &bvh.secondary_branching}) {
        require(levels->size() <= 16, "bvh: a tree of LOOPS has at most 16 levels");
        for (const uint32_t children : *levels)
            require(is_branching(children),
                    "bvh: a branching of LOOPS is a square number from 4 to 4096, but one is " +
                        std::to_string(children));
    }
    for (const uint32_t depth : bvh.secondary_depths)
        require(depth < LOOPS_MOST_LISTS && depth <= bvh.secondary_branching.size(),
                "bvh: a secondary tree's depth must be less than " + std::to_string(LOOPS_MOST_LISTS) +
                    " and have a branching for each of its levels, but one is " + std::to_string(depth));
    require(bvh.largest_share > 0.0 && bvh.largest_share <= 1.0,
            "bvh: largest_share must be above 0 and at most 1");
    require(bvh.coverage_depth >= 1 && bvh.coverage_depth <= 4, "bvh: coverage_depth must be from 1 to 4");
    require(bvh.minimum_coverage > 0.0 && bvh.minimum_coverage <= 1.0,
            "bvh: minimum_coverage must be above 0 and at most 1");
}

}  // namespace

bool operator==(const LoopsDetail& a, const LoopsDetail& b) {
    return tied(a) == tied(b) && a.steps.size() == b.steps.size() &&
           std::equal(a.steps.begin(), a.steps.end(), b.steps.begin(),
                      [](const DetailStep& x, const DetailStep& y) { return x == y; });
}

bool LoopsChoice::equals(const TechniqueOptions& other) const {
    const auto* choice = dynamic_cast<const LoopsChoice*>(&other);
    return choice != nullptr && !options.function && !choice->options.function &&
           options.order == choice->options.order && options.primitives == choice->options.primitives &&
           same(options.bvh, choice->options.bvh) && detail == choice->detail;
}

void validate(const LoopsOptions& options) {
    if (options.bvh)
        validate(*options.bvh);
    require((options.order == RemovalOrder::function) == static_cast<bool>(options.function),
            "order: a function goes with the order of a function alone");
}

void validate(const LoopsDetail& detail) {
    require(detail.uniform >= 0.0 || detail.screen >= 0.0 || !detail.steps.empty(),
            "detail: give a bound that holds everywhere: uniform, screen or by distance");
    require(std::isfinite(detail.uniform) && std::isfinite(detail.screen) && std::isfinite(detail.lens),
            "detail: tolerances must be finite");
    require(detail.steps.size() <= most_detail_steps,
            "detail: at most " + std::to_string(most_detail_steps) + " steps by distance");
    for (size_t i = 0; i < detail.steps.size(); ++i) {
        const DetailStep& step = detail.steps[i];
        require(std::isfinite(step.distance) && std::isfinite(step.tolerance) && step.tolerance >= 0.0,
                "detail: distances and tolerances must be finite, and tolerances zero or more");
        require(i == 0 || (step.distance > detail.steps[i - 1].distance &&
                           step.tolerance >= detail.steps[i - 1].tolerance),
                "detail: distances must rise from step to step, and tolerances must not fall");
    }
    require(
        detail.lens < 0.0 || (std::isfinite(detail.lens_radius) && detail.lens_radius >= 0.0 &&
                              std::isfinite(detail.lens_centre[0]) && std::isfinite(detail.lens_centre[1])),
        "detail: a lens needs a finite centre and a radius of zero or more");
    require(std::isfinite(detail.heat_top) && detail.heat_top > 0.0, "detail: heat_top must be above 0");
}

}  // namespace decalgl
