// Locations: the places where vertices lie, each once, in Morton order; and a tree of boxes over them.
#pragma once

#include <vector>

#include "decalgl/core/large_array.h"
#include "decalgl/core/span.h"
#include "technique/loops/lattice.h"

namespace decalgl::loops {

class Locations {
public:
    // Numbers the places of some points: `numbers` gets the location of each.
    Locations(Span<const LatticePoint> points, LargeArray<uint32_t>& numbers, unsigned threads);

    size_t count() const { return places_.size(); }
    LatticePoint place(uint32_t location) const { return places_[location]; }

    // Calls visit(location) for the locations in a box, until it returns false. `reaches(box)` may leave boxes out.
    template <typename Reaches, typename Visit>
    void search(const LatticeBox& box, const Reaches& reaches, const Visit& visit) const {
        if (!places_.empty())
            descend(levels_.size(), 0, box, reaches, visit);
    }

private:
    static constexpr size_t fan = 8;  // locations below a box of the lowest level, boxes below any other

    template <typename Reaches, typename Visit>
    bool descend(size_t level, size_t index, const LatticeBox& box, const Reaches& reaches,
                 const Visit& visit) const {
        if (level == 0) {
            const size_t end = std::min(places_.size(), (index + 1) * fan);
            for (size_t i = index * fan; i < end; ++i)
                if (box.holds(places_[i]) && !visit(static_cast<uint32_t>(i)))
                    return false;
            return true;
        }
        const std::vector<LatticeBox>& boxes = levels_[level - 1];
        const size_t end = std::min(boxes.size(), (index + 1) * fan);
        for (size_t i = index * fan; i < end; ++i)
            if (boxes[i].meets(box) && reaches(boxes[i]) && !descend(level - 1, i, box, reaches, visit))
                return false;
        return true;
    }

    LargeArray<LatticePoint> places_;
    std::vector<std::vector<LatticeBox>> levels_;  // the lowest first; the highest has at most `fan`
};

}  // namespace decalgl::loops
