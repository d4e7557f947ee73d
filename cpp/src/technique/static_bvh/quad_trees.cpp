#include "technique/static_bvh/quad_trees.h"

#include <array>

namespace decalgl::bvh {
namespace {

constexpr size_t edges_at_once = 1 << 14;
constexpr size_t nodes_at_once = 256;

// A node of the level at work. Its edges are `count` places in the level's list.
struct OpenNode {
    LatticeBox box;
    uint32_t first;
    uint32_t count;
    bool inside;  // the state of its lower left point
};

// Some edges of one node, and what a look at them found for its four children.
struct Task {
    uint32_t node;
    uint32_t begin;
    uint32_t end;
    std::array<uint32_t, 4> counts;  // edges; later their places
    std::array<bool, 4> turned;      // whether the lower left points differ in state from the node's
};

class Level {
public:
    Level(const MemoryAccount& account, uint64_t edge_count)
        : edges(account, edge_count, "edges in one level of quad-trees") {}

    std::vector<OpenNode> nodes;
    WorkingArray<uint32_t> edges;
};

class QuadTreeBuilder {
public:
    QuadTreeBuilder(const TechniqueInput& input, const LargeArray<LatticePoint>& vertices,
                    const LargeArray<Edge>& edges, MemoryCharge& charge)
        : input_(input), vertices_(vertices), edges_(edges), charge_(charge) {}

    QuadTrees build(const std::vector<Ring>& rings, const Stage& stage) {
        Level level = first_level(rings);
        for (int depth = 0; !level.nodes.empty(); ++depth) {
            const double begin = static_cast<double>(depth) / (input_.bvh.depth_limit + 1);
            stage.report()(begin);
            level = next_level(level, depth);
        }
        return std::move(trees_);
    }

private:
    RingEdge edge(uint32_t index) const {
        return RingEdge(vertices_[edges_[index].a], vertices_[edges_[index].b]);
    }

    bool is_split(const OpenNode& node, int depth) const {
        return depth < input_.bvh.depth_limit &&
               node.count > static_cast<uint32_t>(input_.bvh.leaf_capacity) &&
               node.box.max_x > node.box.min_x && node.box.max_y > node.box.min_y;
    }

    // Cuts the edges of nodes into pieces that one thread takes at a time.
    template <typename Wanted>
    std::vector<Task> tasks_of(const std::vector<OpenNode>& nodes, Wanted wanted) const {
        std::vector<Task> tasks;
        for (uint32_t i = 0; i < nodes.size(); ++i) {
            const uint32_t end = wanted(nodes[i]) ? nodes[i].first + nodes[i].count : nodes[i].first;
            for (uint32_t at = nodes[i].first; at < end; at += edges_at_once)
                tasks.push_back({i, at, std::min<uint32_t>(end, at + edges_at_once), {}, {}});
        }
        return tasks;
    }

    // As many tasks at once as make about edges_at_once edges.
    static size_t grain_of(const std::vector<Task>& tasks, size_t edge_count) {
        return std::max<size_t>(1, tasks.size() * edges_at_once / std::max<size_t>(edge_count, 1) / 2);
    }

    Level first_level(const std::vector<Ring>& rings) const {
        uint64_t total = 0;
        for (const Ring& ring : rings)
            total += ring.edge_count;
        Level level(input_.memory, total);
        uint32_t first = 0;
        for (const Ring& ring : rings) {
            level.nodes.push_back({ring.box, first, ring.edge_count, false});
            first += ring.edge_count;
        }
        std::vector<Task> tasks = tasks_of(level.nodes, [](const OpenNode&) { return true; });
        parallel_for(tasks.size(), grain_of(tasks, total), input_.threads, [&](size_t begin, size_t end) {
            for (size_t task = begin; task < end; ++task)
                begin_tree(rings[tasks[task].node], tasks[task], level);
        });
        for (const Task& task : tasks)
            level.nodes[task.node].inside ^= task.turned[0];
        return level;
    }

    // Takes all edges, and finds the state of the root's lower left point.
    void begin_tree(const Ring& ring, Task& task, Level& level) const {
        for (uint32_t at = task.begin; at < task.end; ++at) {
            const uint32_t index = ring.first_edge + (at - level.nodes[task.node].first);
            const RingEdge e = edge(index);
            level.edges.values[at] = index;
            task.turned[0] ^= e.owns_row(ring.box.min_y) && e.crossing(ring.box.min_y) <= ring.box.min_x;
        }
    }

    // Closes the leaves of a level and splits the other nodes.
    Level next_level(const Level& level, int depth) {
        const auto first_node = static_cast<uint32_t>(trees_.boxes.size());
        const uint64_t node_count = first_node + uint64_t{level.nodes.size()};
        grow(trees_.boxes, node_count, "quad-tree nodes", charge_);
        grow(trees_.links, node_count, "quad-tree nodes", charge_);
        std::vector<OpenNode> children;
        for (size_t i = 0; i < level.nodes.size(); ++i) {
            const OpenNode& node = level.nodes[i];
            trees_.boxes[first_node + i] = node.box;
            if (!is_split(node, depth))
                continue;
            require_size(node_count + children.size() + 4, "quad-tree nodes");
            trees_.links[first_node + i] = {QUAD_INTERNAL,
                                            static_cast<uint32_t>(node_count + children.size())};
            for (const LatticeBox& quarter : quarters(node.box))
                children.push_back({quarter, 0, 0, node.inside});
        }
        close_leaves(level, depth, first_node);
        return split(level, depth, std::move(children));
    }

    Level split(const Level& level, int depth, std::vector<OpenNode> children) {
        std::vector<Task> tasks =
            tasks_of(level.nodes, [&](const OpenNode& n) { return is_split(n, depth); });
        const size_t grain = grain_of(tasks, level.edges.values.size());
        parallel_for(tasks.size(), grain, input_.threads, [&](size_t begin, size_t end) {
            for (size_t task = begin; task < end; ++task)
                count_children(level, tasks[task]);
        });
        const uint64_t total = place_children(tasks, children);
        Level next(input_.memory, total);
        parallel_for(tasks.size(), grain, input_.threads, [&](size_t begin, size_t end) {
            for (size_t task = begin; task < end; ++task)
                write_children(level, tasks[task], next);
        });
        next.nodes = std::move(children);
        return next;
    }

    void count_children(const Level& level, Task& task) const {
        const LatticeBox& box = level.nodes[task.node].box;
        const std::array<LatticeBox, 4> parts = quarters(box);
        for (uint32_t at = task.begin; at < task.end; ++at) {
            const RingEdge e = edge(level.edges.values[at]);
            for (size_t i = 0; i < 4; ++i) {
                task.counts[i] += e.concerns(parts[i]) ? 1 : 0;
                const bool left = e.turns(box.min_x, box.min_y, parts[i].min_y);
                const bool between = e.owns_row(parts[i].min_y) && e.crossing(parts[i].min_y) > box.min_x &&
                                     e.crossing(parts[i].min_y) <= parts[i].min_x;
                task.turned[i] ^= left != between;
            }
        }
    }

    // Turns counts into places, child after child. The children of the k-th node that is split are 4 k to 4 k
    // + 3.
    static uint64_t place_children(std::vector<Task>& tasks, std::vector<OpenNode>& children) {
        uint64_t total = 0;
        size_t family = 0;
        for (size_t begin = 0, end = 0; begin < tasks.size(); begin = end, family += 4) {
            while (end < tasks.size() && tasks[end].node == tasks[begin].node)
                ++end;
            for (size_t i = 0; i < 4; ++i) {
                OpenNode& child = children[family + i];
                child.first = static_cast<uint32_t>(total);
                for (size_t task = begin; task < end; ++task) {
                    const uint32_t count = tasks[task].counts[i];
                    tasks[task].counts[i] = static_cast<uint32_t>(total);
                    total += count;
                    require_size(total, "edges in one level of quad-trees");
                    child.inside ^= tasks[task].turned[i];
                }
                child.count = static_cast<uint32_t>(total) - child.first;
            }
        }
        return total;
    }

    void write_children(const Level& level, Task& task, Level& next) const {
        const std::array<LatticeBox, 4> parts = quarters(level.nodes[task.node].box);
        for (uint32_t at = task.begin; at < task.end; ++at) {
            const uint32_t index = level.edges.values[at];
            const RingEdge e = edge(index);
            for (size_t i = 0; i < 4; ++i)
                if (e.concerns(parts[i]))
                    next.edges.values[task.counts[i]++] = index;
        }
    }

    void close_leaves(const Level& level, int depth, uint32_t first_node) {
        const MemoryCharge working(input_.memory, "static_bvh: working memory",
                                   2 * level.edges.values.size() * sizeof(LeafEdge));
        std::vector<std::vector<LeafEdge>> found(block_count(level.nodes.size(), nodes_at_once));
        parallel_for(level.nodes.size(), nodes_at_once, input_.threads, [&](size_t begin, size_t end) {
            std::vector<LeafEdge>& edges = found[begin / nodes_at_once];
            for (size_t i = begin; i < end; ++i)
                if (!is_split(level.nodes[i], depth))
                    trees_.links[first_node + i] = close_leaf(level, level.nodes[i], edges);
        });
        std::vector<uint64_t> first(found.size() + 1, trees_.edges.size());
        for (size_t block = 0; block < found.size(); ++block)
            first[block + 1] = first[block] + found[block].size();
        grow(trees_.edges, first.back(), "edges in leaves", charge_);
        parallel_for(level.nodes.size(), nodes_at_once, input_.threads, [&](size_t begin, size_t end) {
            const size_t block = begin / nodes_at_once;
            std::copy(found[block].begin(), found[block].end(), trees_.edges.begin() + int64_t(first[block]));
            for (size_t i = begin; i < end; ++i)
                if (trees_.links[first_node + i].kind() == QUAD_PARTIAL)
                    trees_.links[first_node + i].first += static_cast<uint32_t>(first[block]);
        });
    }

    // Appends the leaf's edges, and the closing ones where its left border is inside.
    QuadLink close_leaf(const Level& level, const OpenNode& leaf, std::vector<LeafEdge>& edges) const {
        const size_t first = edges.size();
        std::vector<int64_t> turns;
        for (uint32_t at = leaf.first; at < leaf.first + leaf.count; ++at) {
            const uint32_t index = level.edges.values[at];
            const RingEdge e = edge(index);
            const RingEdge::Rows rows = e.rows_in(leaf.box);
            if (rows.first < rows.end)
                edges.push_back({edges_[index].a, edges_[index].b, static_cast<int32_t>(rows.first),
                                 static_cast<int32_t>(rows.end)});
            if (e.turns(leaf.box.min_x, leaf.box.min_y, leaf.box.max_y))
                turns.push_back(e.passing_row(leaf.box.min_x));
        }
        std::sort(turns.begin(), turns.end());
        remove_pairs(turns);
        if (turns.empty() && edges.size() == first)
            return {leaf.inside ? QUAD_INSIDE : QUAD_OUTSIDE, 0};
        add_closing_edges(leaf, turns, edges);
        return {QUAD_PARTIAL | static_cast<uint32_t>(edges.size() - first) << QUAD_COUNT_SHIFT,
                static_cast<uint32_t>(first)};
    }

    static void remove_pairs(std::vector<int64_t>& sorted) {
        size_t kept = 0;
        for (const int64_t value : sorted) {
            if (kept > 0 && sorted[kept - 1] == value)
                --kept;
            else
                sorted[kept++] = value;
        }
        sorted.resize(kept);
    }

    static void add_closing_edges(const OpenNode& leaf, const std::vector<int64_t>& turns,
                                  std::vector<LeafEdge>& edges) {
        int64_t row = leaf.box.min_y;
        bool inside = leaf.inside;
        const auto close = [&](int64_t end) {
            if (inside)
                edges.push_back({CLOSING_EDGE, 0, static_cast<int32_t>(row), static_cast<int32_t>(end)});
            row = end;
            inside = !inside;
        };
        for (const int64_t turn : turns)
            close(turn);
        close(int64_t{leaf.box.max_y} + 1);
    }

    const TechniqueInput& input_;
    const LargeArray<LatticePoint>& vertices_;
    const LargeArray<Edge>& edges_;
    MemoryCharge& charge_;
    QuadTrees trees_;
};

}  // namespace

std::array<LatticeBox, 4> quarters(const LatticeBox& box) {
    const int32_t x = box.min_x + (box.max_x - box.min_x) / 2;
    const int32_t y = box.min_y + (box.max_y - box.min_y) / 2;
    return {{{box.min_x, box.min_y, x, y},
             {x + 1, box.min_y, box.max_x, y},
             {box.min_x, y + 1, x, box.max_y},
             {x + 1, y + 1, box.max_x, box.max_y}}};
}

QuadTrees grow_quad_trees(const TechniqueInput& input, const LargeArray<LatticePoint>& vertices,
                          const LargeArray<Edge>& edges, const std::vector<Ring>& rings, MemoryCharge& charge,
                          const Stage& stage) {
    return QuadTreeBuilder(input, vertices, edges, charge).build(rings, stage);
}

}  // namespace decalgl::bvh
