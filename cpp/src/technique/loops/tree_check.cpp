#include "technique/loops/tree_check.h"

#include <algorithm>
#include <vector>

#include "technique/loops/loops_layout.h"

namespace decalgl::loops {
namespace {

class TreeCheck {
public:
    TreeCheck(Span<const uint32_t> words, size_t points, size_t slots)
        : words_(words), points_(points), slots_(slots), seen_(words.size(), false) {}

    bool holds(const LatticeBox& box) {
        if (!add(0, 0, box, true))
            return false;
        while (!open_.empty()) {
            const Node node = open_.back();
            open_.pop_back();
            if (!visit(node))
                return false;
        }
        return true;
    }

private:
    struct Node {
        uint64_t place;
        LatticeBox box;
        bool is_primary;
    };

    // A node that some words lead to, which no others do.
    bool add(uint64_t from, uint32_t step, const LatticeBox& box, bool is_primary) {
        const uint64_t place = from + step;
        if (place + LEAF_WORDS > words_.size() || seen_[place])
            return false;
        seen_[place] = true;
        open_.push_back({place, box, is_primary});
        return true;
    }

    bool visit(const Node& node) {
        const uint32_t step = words_[node.place], side = words_[node.place + 1];
        if (side > 0 && !visit_children(node, side))
            return false;
        if (!node.is_primary)
            return step == 0 || is_list(node.place + step);
        return side > 0 ? step == 0 : add(node.place, step, node.box, false);
    }

    bool visit_children(const Node& node, uint64_t side) {
        if (side > 64 || node.place + NODE_WORDS + side * side > words_.size())
            return false;
        const int64_t width = words_[node.place + 2], height = words_[node.place + 3];
        if (width < 1 || height < 1 || (int64_t{node.box.max_x} - node.box.min_x) / width >= int64_t(side) ||
            (int64_t{node.box.max_y} - node.box.min_y) / height >= int64_t(side))
            return false;
        for (uint64_t child = 0; child < side * side; ++child) {
            const uint32_t step = words_[node.place + NODE_WORDS + child];
            const int64_t x = node.box.min_x + int64_t(child % side) * width;
            const int64_t y = node.box.min_y + int64_t(child / side) * height;
            // What lies beyond the box is never asked for.
            if (step == 0 || x > node.box.max_x || y > node.box.max_y)
                continue;
            const auto end = [](int64_t begin, int64_t size, int32_t most) {
                return static_cast<int32_t>(std::min<int64_t>(begin + size - 1, most));
            };
            if (!add(node.place, step,
                     {static_cast<int32_t>(x), static_cast<int32_t>(y), end(x, width, node.box.max_x),
                      end(y, height, node.box.max_y)},
                     node.is_primary))
                return false;
        }
        return true;
    }

    bool is_list(uint64_t place) const {
        if (place >= words_.size() || words_[place] >= words_.size() - place)
            return false;
        const uint64_t end = place + 1 + words_[place];
        for (uint64_t group = place + 1; group < end;) {
            const uint64_t count = words_[group] & GROUP_COUNT_MASK;
            if ((words_[group] >> GROUP_COUNT_BITS) >= slots_ || count == 0 || count >= end - group)
                return false;
            for (uint64_t i = 1; i <= count; ++i)
                // An edge ends at the next point.
                if ((words_[group + i] & LOOPS_POINT_MASK) + 1 >= points_)
                    return false;
            group += 1 + count;
        }
        return true;
    }

    Span<const uint32_t> words_;
    size_t points_;
    size_t slots_;
    std::vector<bool> seen_;
    std::vector<Node> open_;
};

}  // namespace

bool fits_together(const Bvh& bvh, size_t points, size_t slots, const LatticeBox& box) {
    const auto leads_to_points = [&](const Base& base) {
        return (base.left & LOOPS_POINT_MASK) < points && base.right < points;
    };
    return bvh.bases.size() == points && std::all_of(bvh.bases.begin(), bvh.bases.end(), leads_to_points) &&
           TreeCheck(bvh.words, points, slots).holds(box);
}

}  // namespace decalgl::loops
