// The parametric BVH of section 4.5: a primary tree that divides space, and in each of its leaves a secondary tree
// whose nodes keep the primitives that cover enough of them (loops_layout.h).
#pragma once

#include <cmath>
#include <vector>

#include "decalgl/core/memory.h"
#include "decalgl/core/progress.h"
#include "technique/loops/hierarchy.h"
#include "technique/loops/loops_layout.h"

namespace decalgl::loops {

// A primitive of a slot. Items are sorted by slot, topmost first, and so are lists.
struct Item {
    uint32_t slot;
    uint32_t primitive;
};

// What the index is made of.
struct Shapes {
    const Hierarchy* hierarchy;
    Span<const float> half_widths;  // of slots, in quanta; of fills 0, of strokes above
    LinePrimitives primitives;

    // Whether an item may show in a box: for fills exactly where its triangle does.
    bool meets(Item item, const LatticeBox& box) const;
    // How far an item reaches beyond its points, in quanta; of fills 0.
    int64_t reach_of(Item item) const {
        const float half_width = half_widths[item.slot];
        return half_width == 0.0F ? 0 : static_cast<int64_t>(std::ceil(half_width)) + 1;
    }
    // The vertex without which nothing of an item is drawn.
    uint32_t generator_of(Item item) const;
    // What it lies in.
    LatticeBox box_around(Item item) const;
};

using Items = std::vector<Item>;

struct TreeCounts {
    uint64_t nodes = 0;
    uint64_t references = 0;
    uint64_t longest_walk = 0;  // the most primitives that one position has to look at
};

struct Tree {
    LargeArray<uint32_t> words;
    TreeCounts counts;
    uint32_t most_lists = 1;  // that a position has
};

// The settings with a branching chosen from the data where none is given.
LoopsBvh fitted(const LoopsBvh& settings, size_t items);

// Throws Error(memory) where the words pass what a shader can read, or the budget.
Tree build_tree(const Shapes& shapes, Items items, const LatticeBox& box, const LoopsBvh& settings,
                unsigned threads, MemoryCharge& charge, Progress& progress);

}  // namespace decalgl::loops
