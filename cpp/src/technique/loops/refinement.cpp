#include "technique/loops/refinement.h"

#include <cmath>

#include "decalgl/core/parallel.h"

namespace decalgl::loops {
namespace {

// Room for the work on one arc after another.
class ArcRefiner {
public:
    ArcRefiner(const Arcs& arcs, const Lattice& lattice, const LoopsOptions& options, Refinement& refinement)
        : arcs_(arcs), lattice_(lattice), options_(options), refinement_(refinement) {}

    void refine(size_t arc) {
        const uint32_t begin = arcs_.begin(arc), end = arcs_.end(arc);
        for (uint32_t p = begin; p < end; ++p) {
            refinement_.left[p] = refinement_.right[p] = refinement_.parents[p] = no_point;
            refinement_.order[p] = no_point;
            refinement_.errors[p] = 0.0F;
        }
        if (end - begin < 3)
            return;
        put_in_order(arc);
        times_.assign(end - begin, UINT32_MAX);
        for (uint32_t i = 0; i < order_.size(); ++i) {
            times_[order_[i].vertex] = i;
            refinement_.order[begin + i] = begin + order_[i].vertex;
            refinement_.errors[begin + order_[i].vertex] = rounded_up(order_[i].error);
        }
        build_tree(begin);
    }

private:
    void put_in_order(size_t arc) {
        const Span<const LatticePoint> points = arcs_.points_of(arc);
        switch (arcs_.kinds[arc] == ArcKind::frame ? RemovalOrder::douglas_peucker : options_.order) {
            case RemovalOrder::douglas_peucker:
                return order_douglas_peucker(points, order_);
            case RemovalOrder::wang_mueller:
                return order_wang_mueller(points, order_);
            case RemovalOrder::visvalingam_whyatt:
                return order_visvalingam_whyatt(points, order_);
            case RemovalOrder::function:
                return order_by_function(points, lattice_, options_.function, order_);
        }
    }

    // Vertices that go later and later wait on the stack for their right neighbour.
    void build_tree(uint32_t begin) {
        const auto size = static_cast<uint32_t>(times_.size());
        stack_.assign(1, 0);
        for (uint32_t v = 1; v < size; ++v) {
            while (times_[stack_.back()] < times_[v]) {
                const uint32_t splitter = stack_.back();
                stack_.pop_back();
                const uint32_t left = stack_.back();
                refinement_.left[begin + splitter] = begin + left;
                refinement_.right[begin + splitter] = begin + v;
                const uint32_t parent = times_[left] < times_[v] ? left : v;
                if (times_[parent] != UINT32_MAX)
                    refinement_.parents[begin + splitter] = begin + parent;
            }
            stack_.push_back(v);
        }
    }

    const Arcs& arcs_;
    const Lattice& lattice_;
    const LoopsOptions& options_;
    Refinement& refinement_;
    std::vector<Removal> order_;
    std::vector<uint32_t> times_;
    std::vector<uint32_t> stack_;
};

}  // namespace

float rounded_up(double value) {
    const auto rounded = static_cast<float>(value);
    return double{rounded} < value ? std::nextafter(rounded, INFINITY) : rounded;
}

Refinement refine_arcs(const Arcs& arcs, const Lattice& lattice, const LoopsOptions& options, unsigned threads) {
    Refinement refinement;
    refinement.left.resize(arcs.points.size());
    refinement.right.resize(arcs.points.size());
    refinement.parents.resize(arcs.points.size());
    refinement.order.resize(arcs.points.size());
    refinement.errors.resize(arcs.points.size());
    // A user's function is called by one thread at a time: the one that calls, which may hold an interpreter.
    const unsigned used = options.order == RemovalOrder::function ? 1 : threads;
    parallel_for(arcs.count(), 64, used, [&](size_t begin, size_t end) {
        ArcRefiner refiner(arcs, lattice, options, refinement);
        for (size_t arc = begin; arc < end; ++arc)
            refiner.refine(arc);
    });
    return refinement;
}

}  // namespace decalgl::loops
