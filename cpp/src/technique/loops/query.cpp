// What lies at a map position: the shaders' walk with everything active.
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "technique/loops/prepared_loops.h"

namespace decalgl::loops {
namespace {

class Query {
public:
    Query(const LoopsIndex& index, LatticePoint point)
        : index_(index), words_(index.tree.words), point_(point) {}

    // The slots there, topmost first.
    std::vector<uint32_t> run() {
        size_t node = 0;
        LatticeBox box = index_.lattice.terrain;
        if (words_.empty() || !box.holds(point_))
            return {};
        while (words_[node + 1] != 0) {
            const size_t next = child(node, box);
            if (next == 0)
                return {};
            node = next;
        }
        node += words_[node];
        for (;;) {
            if (words_[node] != 0)
                visit_list(node + words_[node]);
            const size_t next = words_[node + 1] != 0 ? child(node, box) : 0;
            if (next == 0)
                break;
            node = next;
        }
        std::vector<uint32_t> found = std::move(strokes_);
        std::sort(fills_.begin(), fills_.end());
        for (size_t i = 0, next = 0; i < fills_.size(); i = next) {
            while (next < fills_.size() && fills_[next] == fills_[i])
                ++next;
            if ((next - i) % 2 == 1)
                found.push_back(fills_[i]);
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

private:
    size_t child(size_t node, LatticeBox& box) const {
        const int64_t side = words_[node + 1];
        const int64_t width = words_[node + 2], height = words_[node + 3];
        const int64_t column = (int64_t{point_.x} - box.min_x) / width,
                      row = (int64_t{point_.y} - box.min_y) / height;
        const LatticeBox own = box;
        box.min_x = static_cast<int32_t>(own.min_x + column * width);
        box.min_y = static_cast<int32_t>(own.min_y + row * height);
        box.max_x = static_cast<int32_t>(std::min<int64_t>(box.min_x + width - 1, own.max_x));
        box.max_y = static_cast<int32_t>(std::min<int64_t>(box.min_y + height - 1, own.max_y));
        const uint32_t step = words_[node + NODE_WORDS + static_cast<size_t>(row * side + column)];
        return step == 0 ? 0 : node + step;
    }

    void visit_list(size_t list) {
        const size_t end = list + 1 + words_[list];
        for (size_t i = list + 1; i < end;) {
            const uint32_t slot = words_[i] >> GROUP_COUNT_BITS, count = words_[i] & GROUP_COUNT_MASK;
            for (uint32_t k = 1; k <= count; ++k)
                visit(slot, words_[i + k]);
            i += 1 + count;
        }
    }

    void visit(uint32_t slot, uint32_t primitive) {
        const uint32_t p = primitive & LOOPS_POINT_MASK;
        const float half_width = index_.styles[slot].half_width;
        const Base base = index_.bases[p];
        const uint32_t left = base.left & LOOPS_POINT_MASK;
        if (half_width == 0.0F) {
            if (crosses(left, p) != (crosses(p, base.right) != crosses(left, base.right)))
                fills_.push_back(slot);
            return;
        }
        const auto covers = [&](uint32_t a, uint32_t b) {
            return distance_to_segment(point_, index_.points[a], index_.points[b]) <= double{half_width};
        };
        const bool is_edge = (primitive & EDGE_FLAG) != 0;
        if (is_edge ? covers(p, p + 1)
                    : ((base.left & BASE_LEFT_EDGE) != 0 && covers(left, p)) ||
                          ((base.left & BASE_RIGHT_EDGE) != 0 && covers(p, base.right)))
            strokes_.push_back(slot);
    }

    // Whether a side crosses the point's row at or left of it.
    bool crosses(uint32_t from, uint32_t to) const {
        LatticePoint a = index_.points[from], b = index_.points[to];
        if ((a.y <= point_.y) == (b.y <= point_.y))
            return false;
        if (a.y > b.y)
            std::swap(a, b);
        return doubled_area(a, b, point_) <= 0;
    }

    const LoopsIndex& index_;
    const LargeArray<uint32_t>& words_;
    LatticePoint point_;
    std::vector<uint32_t> fills_;  // a slot for each triangle
    std::vector<uint32_t> strokes_;
};

}  // namespace

std::vector<FeatureReference> PreparedLoops::query(const SeenPoint& point) const {
    std::vector<FeatureReference> found;
    const Lattice& lattice = index_->lattice;
    if (!(std::abs((point.x - lattice.left) / lattice.quantum) <= 2.0 * lattice_extent &&
          std::abs((point.y - lattice.bottom) / lattice.quantum) <= 2.0 * lattice_extent))
        return found;
    std::unordered_set<uint64_t> seen;
    for (const uint32_t slot : Query(*index_, lattice.nearest(point.x, point.y)).run()) {
        const FeatureReference feature = index_->slots[slot];
        if (seen.insert(uint64_t{feature.layer} << 32 | feature.feature).second)
            found.push_back(feature);
    }
    return found;
}

}  // namespace decalgl::loops
