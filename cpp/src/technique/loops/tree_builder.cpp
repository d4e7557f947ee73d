#include "technique/loops/tree_builder.h"

#include <algorithm>
#include <cmath>

#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"

namespace decalgl::loops {
namespace {

// What drivers read from one texture buffer as a rule.
constexpr uint64_t most_words = uint64_t{1} << 27;

// Whether a triangle or segment a-b-c, widened by `reach`, may meet a box: not where the box lies beyond a side.
bool may_meet(LatticePoint a, LatticePoint b, LatticePoint c, int64_t reach, const LatticeBox& box) {
    const LatticeBox own = box_of(a, b, c);
    if (own.min_x - reach > box.max_x || own.max_x + reach < box.min_x || own.min_y - reach > box.max_y ||
        own.max_y + reach < box.min_y)
        return false;
    const auto is_beyond = [&](LatticePoint from, LatticePoint to) {
        const int64_t dx = int64_t{to.x} - from.x, dy = int64_t{to.y} - from.y;
        // The corner that lies farthest to the left.
        const int64_t x = dy > 0 ? box.min_x - reach : box.max_x + reach;
        const int64_t y = dx > 0 ? box.max_y + reach : box.min_y - reach;
        return dx * (y - from.y) - dy * (x - from.x) < 0;
    };
    if (doubled_area(a, b, c) < 0)
        std::swap(b, c);
    return !is_beyond(a, b) && !is_beyond(b, c) && !is_beyond(c, a);
}

// A node's children: as many along each side, of one size but for the last.
struct Division {
    LatticeBox box;
    uint32_t side;
    int64_t width, height;

    Division(const LatticeBox& whole, uint32_t children)
        : box(whole),
          side(static_cast<uint32_t>(std::lrint(std::sqrt(double(children))))),
          width((int64_t{box.max_x} - box.min_x + side) / side),
          height((int64_t{box.max_y} - box.min_y + side) / side) {}

    // The columns or rows that some quanta lie in, at most all.
    uint32_t place(int64_t offset, int64_t size) const {
        return static_cast<uint32_t>(std::clamp<int64_t>(offset / size, 0, side - 1));
    }

    // Empty for those that are left over where few quanta are to be divided.
    LatticeBox child(uint32_t index) const {
        const int64_t left = box.min_x + int64_t{index % side} * width;
        const int64_t bottom = box.min_y + int64_t{index / side} * height;
        LatticeBox made;
        made.min_x = static_cast<int32_t>(std::min<int64_t>(left, int64_t{box.max_x} + 1));
        made.min_y = static_cast<int32_t>(std::min<int64_t>(bottom, int64_t{box.max_y} + 1));
        made.max_x = static_cast<int32_t>(std::min<int64_t>(left + width - 1, box.max_x));
        made.max_y = static_cast<int32_t>(std::min<int64_t>(bottom + height - 1, box.max_y));
        return made;
    }
};

void write_list(Span<const Item> items, LargeArray<uint32_t>& words, TreeCounts& counts) {
    if (items.empty())
        return;
    const size_t begin = words.size();
    words.push_back(0);
    size_t group = 0;
    for (size_t i = 0; i < items.size(); ++i) {
        const bool begins = i == 0 || items[i].slot != items[i - 1].slot ||
                            (words[group] & GROUP_COUNT_MASK) == GROUP_COUNT_MASK;
        if (begins) {
            group = words.size();
            words.push_back(items[i].slot << GROUP_COUNT_BITS);
        }
        ++words[group];
        words.push_back(items[i].primitive);
    }
    words[begin] = static_cast<uint32_t>(words.size() - begin - 1);
    counts.references += items.size();
}

// Appends a node that is divided, whose children are not known yet, up to its list.
void write_node(bool has_list, const Division& division, LargeArray<uint32_t>& words, TreeCounts& counts) {
    const size_t node = words.size(), children = size_t{division.side} * division.side;
    ++counts.nodes;
    words.push_back(has_list ? static_cast<uint32_t>(NODE_WORDS + children) : 0);
    words.push_back(division.side);
    words.push_back(static_cast<uint32_t>(division.width));
    words.push_back(static_cast<uint32_t>(division.height));
    words.resize(node + NODE_WORDS + children, 0);
}

void write_leaf(bool has_list, LargeArray<uint32_t>& words, TreeCounts& counts) {
    ++counts.nodes;
    words.push_back(has_list ? LEAF_WORDS : 0);
    words.push_back(0);
}

class SubtreeBuilder {
public:
    SubtreeBuilder(const Shapes& shapes, const LoopsBvh& settings, Tree& tree)
        : shapes_(shapes), settings_(settings), words_(tree.words), counts_(tree.counts) {}

    // Appends a primary node and whatever is below; gives its place.
    size_t primary(Items items, const LatticeBox& box, size_t level) {
        const size_t node = words_.size();
        std::vector<Items> parts;
        if (level < settings_.primary_branching.size() && items.size() > settings_.node_capacity)
            parts = distribute(items, Division(box, settings_.primary_branching[level]));
        if (!is_worth_it(items, parts)) {
            parts.clear();
            write_leaf(true, words_, counts_);
            const size_t depth =
                level < settings_.secondary_depths.size() ? settings_.secondary_depths[level] : 0;
            secondary(std::move(items), box, 0, depth, 0);
            return node;
        }
        const Division division(box, settings_.primary_branching[level]);
        const size_t children = parts.size();
        write_node(false, division, words_, counts_);
        items = Items();
        for (uint32_t i = 0; i < children; ++i)
            if (!parts[i].empty()) {
                const size_t child = primary(std::move(parts[i]), division.child(i), level + 1);
                words_[node + NODE_WORDS + i] = static_cast<uint32_t>(child - node);
            }
        return node;
    }

    std::vector<Items> distribute(Span<const Item> items, const Division& division) const {
        std::vector<Items> parts(division.side * division.side);
        for (const Item item : items)
            each_child(item, division, [&](uint32_t child) { parts[child].push_back(item); });
        return parts;
    }

private:
    bool is_worth_it(const Items& items, const std::vector<Items>& parts) const {
        size_t held = 0;
        for (const Items& part : parts)
            held += part.size();
        return !parts.empty() &&
               double(held) <= settings_.largest_share * double(parts.size()) * double(items.size());
    }

    template <typename Visit>
    void each_child(Item item, const Division& division, const Visit& visit) const {
        const LatticeBox own = shapes_.box_around(item);
        const uint32_t left = division.place(int64_t{own.min_x} - division.box.min_x, division.width);
        const uint32_t right = division.place(int64_t{own.max_x} - division.box.min_x, division.width);
        const uint32_t low = division.place(int64_t{own.min_y} - division.box.min_y, division.height);
        const uint32_t high = division.place(int64_t{own.max_y} - division.box.min_y, division.height);
        for (uint32_t row = low; row <= high; ++row)
            for (uint32_t column = left; column <= right; ++column)
                if (shapes_.meets(item, division.child(row * division.side + column)))
                    visit(row * division.side + column);
    }

    // `above`: primitives in the nodes that this one lies in.
    size_t secondary(Items items, const LatticeBox& box, size_t level, size_t depth, uint64_t above) {
        const size_t node = words_.size();
        Items kept;
        std::vector<Items> parts;
        if (level < depth) {
            const Division division(box, settings_.secondary_branching[level]);
            parts.resize(division.side * division.side);
            for (const Item item : items) {
                if (coverage(item, box, level, depth) >= settings_.minimum_coverage)
                    kept.push_back(item);
                else
                    each_child(item, division, [&](uint32_t child) { parts[child].push_back(item); });
            }
        } else {
            kept = std::move(items);
        }
        items = Items();
        const bool divided =
            std::any_of(parts.begin(), parts.end(), [](const Items& part) { return !part.empty(); });
        if (divided)
            write_node(!kept.empty(), Division(box, settings_.secondary_branching[level]), words_, counts_);
        else
            write_leaf(!kept.empty(), words_, counts_);
        write_list(kept, words_, counts_);
        const uint64_t walk = above + kept.size();
        counts_.longest_walk = std::max(counts_.longest_walk, walk);
        if (!divided)
            return node;
        const Division division(box, settings_.secondary_branching[level]);
        for (uint32_t i = 0; i < parts.size(); ++i)
            if (!parts[i].empty()) {
                const size_t child =
                    secondary(std::move(parts[i]), division.child(i), level + 1, depth, walk);
                words_[node + NODE_WORDS + i] = static_cast<uint32_t>(child - node);
            }
        return node;
    }

    // Share of the nodes some levels below that an item meets.
    double coverage(Item item, const LatticeBox& box, size_t level, size_t depth) const {
        uint64_t met = 0, all = 1;
        const size_t end = std::min<size_t>(depth, level + settings_.coverage_depth);
        for (size_t i = level; i < end; ++i)
            all *= settings_.secondary_branching[i];
        count_met(item, box, level, end, met);
        return double(met) / double(all);
    }

    void count_met(Item item, const LatticeBox& box, size_t level, size_t end, uint64_t& met) const {
        if (level == end) {
            ++met;
            return;
        }
        const Division division(box, settings_.secondary_branching[level]);
        each_child(item, division,
                   [&](uint32_t child) { count_met(item, division.child(child), level + 1, end, met); });
    }

    const Shapes& shapes_;
    const LoopsBvh& settings_;
    LargeArray<uint32_t>& words_;
    TreeCounts& counts_;
};

// A node that is divided before the threads set out, or whose subtree one of them builds.
struct TopNode {
    Items items;
    LatticeBox box;
    size_t level;
    uint32_t side = 0;               // 0: built by one of them
    std::vector<uint32_t> children;  // places in the list; 0: nothing there
    Tree subtree;                    // or the node itself, which is divided
};

class TreeBuilder {
public:
    TreeBuilder(const Shapes& shapes, const LoopsBvh& settings, unsigned threads)
        : shapes_(shapes), settings_(settings), threads_(threads) {}

    Tree build(Items items, const LatticeBox& box, MemoryCharge& charge, Progress& progress) {
        const size_t portion = std::max<size_t>(items.size() / 64, 4096);
        nodes_.push_back({std::move(items), box, 0, 0, {}, {}});
        for (size_t i = 0; i < nodes_.size(); ++i)
            if (nodes_[i].items.size() > portion && nodes_[i].level < settings_.primary_branching.size() &&
                nodes_[i].items.size() > settings_.node_capacity)
                divide(i);
        parallel_for(
            nodes_.size(), 1, threads_,
            [&](size_t begin, size_t end) {
                for (size_t i = begin; i < end; ++i)
                    if (nodes_[i].side == 0)
                        SubtreeBuilder(shapes_, settings_, nodes_[i].subtree)
                            .primary(std::move(nodes_[i].items), nodes_[i].box, nodes_[i].level);
            },
            [&](double share) { progress.report(0.75 + 0.25 * share); });
        return assemble(charge);
    }

private:
    void divide(size_t place) {
        const Division division(nodes_[place].box, settings_.primary_branching[nodes_[place].level]);
        const size_t children = division.side * division.side, level = nodes_[place].level + 1;
        const Items items = std::move(nodes_[place].items);
        const size_t grain = std::max<size_t>(items.size() / 32, 1 << 14);
        std::vector<std::vector<Items>> blocks(block_count(items.size(), grain));
        Tree unused;
        const SubtreeBuilder builder(shapes_, settings_, unused);
        parallel_for(items.size(), grain, threads_, [&](size_t begin, size_t end) {
            blocks[begin / grain] =
                builder.distribute(Span<const Item>(items).subspan(begin, end - begin), division);
        });
        write_node(false, division, nodes_[place].subtree.words, nodes_[place].subtree.counts);
        nodes_[place].side = division.side;
        nodes_[place].children.assign(children, 0);
        for (uint32_t child = 0; child < children; ++child) {
            Items all;
            for (const std::vector<Items>& block : blocks)
                all.insert(all.end(), block[child].begin(), block[child].end());
            if (all.empty())
                continue;
            nodes_[place].children[child] = static_cast<uint32_t>(nodes_.size());
            nodes_.push_back({std::move(all), division.child(child), level, 0, {}, {}});
        }
    }

    // Divided nodes come before what is below them, so all ways lead on.
    Tree assemble(MemoryCharge& charge) {
        std::vector<uint64_t> places(nodes_.size());
        Tree tree;
        uint64_t total = 0;
        for (size_t i = 0; i < nodes_.size(); ++i) {
            places[i] = total;
            total += nodes_[i].subtree.words.size();
            const TreeCounts& counts = nodes_[i].subtree.counts;
            tree.counts.nodes += counts.nodes;
            tree.counts.references += counts.references;
            tree.counts.longest_walk = std::max(tree.counts.longest_walk, counts.longest_walk);
        }
        if (total > most_words)
            throw Error(ErrorKind::memory, "the index of technique 'loops' would take " +
                                               format_bytes(4 * total) +
                                               ", more than a shader can read; choose a bvh with less depth "
                                               "or branching, or fewer features");
        charge.resize(charge.bytes() + 4 * total);
        tree.words.resize(total);
        for (size_t i = 0; i < nodes_.size(); ++i) {
            uint32_t* words = tree.words.data() + places[i];
            std::copy(nodes_[i].subtree.words.begin(), nodes_[i].subtree.words.end(), words);
            nodes_[i].subtree = {};
            for (size_t c = 0; c < nodes_[i].children.size(); ++c) {
                const uint32_t child = nodes_[i].children[c];
                words[NODE_WORDS + c] = child == 0 ? 0 : static_cast<uint32_t>(places[child] - places[i]);
            }
        }
        return tree;
    }

    const Shapes& shapes_;
    const LoopsBvh& settings_;
    unsigned threads_;
    std::vector<TopNode> nodes_;
};

}  // namespace

LatticeBox Shapes::box_around(Item item) const {
    const LargeArray<LatticePoint>& points = hierarchy->arcs.points;
    const uint32_t p = item.primitive & LOOPS_POINT_MASK;
    const bool is_edge = (item.primitive & EDGE_FLAG) != 0;
    LatticeBox box = is_edge ? box_of(points[p], points[p], points[p + 1])
                             : box_of(points[hierarchy->refinement.left[p]], points[p],
                                      points[hierarchy->refinement.right[p]]);
    const auto widened = [&](int32_t value, int64_t by) {
        return static_cast<int32_t>(std::clamp<int64_t>(value + by, INT32_MIN, INT32_MAX));
    };
    const int64_t reach = reach_of(item);
    return {widened(box.min_x, -reach), widened(box.min_y, -reach), widened(box.max_x, reach),
            widened(box.max_y, reach)};
}

bool Shapes::meets(Item item, const LatticeBox& box) const {
    const LargeArray<LatticePoint>& points = hierarchy->arcs.points;
    const Refinement& refinement = hierarchy->refinement;
    if (box.min_x > box.max_x || box.min_y > box.max_y)
        return false;
    const uint32_t p = item.primitive & LOOPS_POINT_MASK;
    const int64_t reach = reach_of(item);
    if ((item.primitive & EDGE_FLAG) != 0)
        return may_meet(points[p], points[p + 1], points[p + 1], reach, box);
    const uint32_t left = refinement.left[p], right = refinement.right[p];
    if (reach == 0)
        return may_meet(points[left], points[p], points[right], 0, box);
    const auto side_meets = [&](uint32_t a, uint32_t b) {
        return may_meet(points[a], points[b], points[b], reach, box);
    };
    if (side_meets(left, right))
        return true;
    // Of the triangle's sides those that are drawn with it.
    return primitives == LinePrimitives::triangles &&
           ((left + 1 == p && side_meets(left, p)) || (p + 1 == right && side_meets(p, right)));
}

LoopsBvh fitted(const LoopsBvh& settings, size_t items) {
    LoopsBvh own = settings;
    if (!own.primary_branching.empty())
        return own;
    // One level of cells with few primitives each, and finer ones where it is crowded.
    const auto side = static_cast<uint32_t>(std::clamp(std::sqrt(double(items) / 64.0), 2.0, 32.0));
    own.primary_branching = {side * side, 16, 16, 16, 16, 16};
    return own;
}

Tree build_tree(const Shapes& shapes, Items items, const LatticeBox& box, const LoopsBvh& settings,
                unsigned threads, MemoryCharge& charge, Progress& progress) {
    Tree tree = TreeBuilder(shapes, settings, threads).build(std::move(items), box, charge, progress);
    uint32_t deepest = 0;
    for (const uint32_t depth : settings.secondary_depths)
        deepest = std::max(deepest, depth);
    tree.most_lists = deepest + 1;
    return tree;
}

}  // namespace decalgl::loops
