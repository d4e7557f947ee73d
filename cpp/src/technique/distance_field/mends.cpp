#include "technique/distance_field/mends.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "decalgl/core/parallel.h"
#include "vector/stroke_reach.h"

namespace decalgl::network {
namespace {

constexpr double gap = 0.9;  // of the half way between two lines, so that both keep a border

// ---- protrusion

struct NodeCategories {
    uint64_t once = 0;  // categories with a segment at the node
    uint64_t twice = 0;
};

std::vector<NodeCategories> categories_of_nodes(const Network& network, const CategoryTable& table) {
    std::vector<NodeCategories> nodes(network.nodes.size());
    for (const Segment& segment : network.segments) {
        const Slot slot = table.slots[segment.slot];
        if (!slot.shows())
            continue;
        const uint64_t bit = uint64_t{1} << slot.category;
        for (const uint32_t end : {segment.a, segment.b}) {
            nodes[end].twice |= nodes[end].once & bit;
            nodes[end].once |= bit;
        }
    }
    return nodes;
}

// The widest other category at a node where a category ends, plus one; 0 where there is none.
uint32_t cut_at(const NodeCategories& node, uint32_t own, const std::vector<double>& half_widths) {
    const uint64_t bit = uint64_t{1} << own;
    if ((node.twice & bit) != 0)
        return 0;
    uint32_t widest = 0;
    for (uint32_t other = 0; other < half_widths.size(); ++other)
        if (other != own && (node.once >> other & 1U) != 0 &&
            (widest == 0 || half_widths[other] > half_widths[widest - 1]))
            widest = other + 1;
    return widest;
}

// ---- intrusion

Vector2 at(const Network& network, uint32_t node) {
    const auto place = network.place(node);
    return {place[0], place[1]};
}

double distance(Vector2 point, Vector2 a, Vector2 b) {
    const Vector2 way{b.x - a.x, b.y - a.y}, from{point.x - a.x, point.y - a.y};
    const double length2 = dot(way, way);
    const double share = length2 > 0.0 ? std::clamp(dot(from, way) / length2, 0.0, 1.0) : 0.0;
    return std::hypot(from.x - share * way.x, from.y - share * way.y);
}

// Segments in square cells, to be found near a point.
class SegmentCells {
public:
    SegmentCells(const Network& network, double side) : network_(&network), side_(side) {
        for (uint32_t i = 0; i < network.segments.size(); ++i) {
            const Vector2 a = at(network, network.segments[i].a), b = at(network, network.segments[i].b);
            for (int64_t x = cell(std::min(a.x, b.x)); x <= cell(std::max(a.x, b.x)); ++x)
                for (int64_t y = cell(std::min(a.y, b.y)); y <= cell(std::max(a.y, b.y)); ++y)
                    cells_[key(x, y)].push_back(i);
        }
    }

    // Every segment within a cell's side of the point, and others.
    template <typename Each>
    void near(Vector2 point, Each each) const {
        for (int64_t x = cell(point.x) - 1; x <= cell(point.x) + 1; ++x)
            for (int64_t y = cell(point.y) - 1; y <= cell(point.y) + 1; ++y) {
                const auto found = cells_.find(key(x, y));
                if (found == cells_.end())
                    continue;
                for (const uint32_t segment : found->second)
                    each(segment);
            }
    }

private:
    int64_t cell(double place) const { return static_cast<int64_t>(std::floor(place / side_)); }
    static uint64_t key(int64_t x, int64_t y) { return uint64_t(x) << 32U ^ (uint64_t(y) & 0xFFFFFFFFU); }

    const Network* network_;
    double side_;
    std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
};

struct Links {
    std::vector<uint32_t> first;  // of each node
    std::vector<uint32_t> segments;

    explicit Links(const Network& network) : first(network.nodes.size() + 1, 0) {
        for (const Segment& segment : network.segments)
            ++first[segment.a + 1], ++first[segment.b + 1];
        for (size_t i = 1; i < first.size(); ++i)
            first[i] += first[i - 1];
        segments.resize(first.back());
        std::vector<uint32_t> next(first.begin(), first.end() - 1);
        for (uint32_t i = 0; i < network.segments.size(); ++i)
            for (const uint32_t end : {network.segments[i].a, network.segments[i].b})
                segments[next[end]++] = i;
    }
};

// The segments of a category that can be walked to from a node in at most so many metres.
std::vector<uint32_t> connected(const Network& network, const CategoryTable& table, const Links& links,
                                uint32_t start, uint32_t category, double reach) {
    std::vector<uint32_t> found;
    std::unordered_map<uint32_t, double> walked{{start, 0.0}};
    std::vector<uint32_t> queue{start};
    for (size_t head = 0; head < queue.size(); ++head) {
        const uint32_t node = queue[head];
        for (uint32_t i = links.first[node]; i < links.first[node + 1]; ++i) {
            const Segment& segment = network.segments[links.segments[i]];
            if (table.slots[segment.slot].category != category)
                continue;
            found.push_back(links.segments[i]);
            const uint32_t other = segment.a == node ? segment.b : segment.a;
            const Vector2 a = at(network, segment.a), b = at(network, segment.b);
            const double length = walked[node] + std::hypot(b.x - a.x, b.y - a.y);
            const auto [entry, is_new] = walked.try_emplace(other, length);
            if (length <= reach && (is_new || length < entry->second)) {
                entry->second = length;
                queue.push_back(other);
            }
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace

void cut_caps(Network& network, const CategoryTable& table) {
    std::vector<double> half_widths;
    for (const NetworkCategory& category : table.categories)
        half_widths.push_back(widest_half_width(category));
    const std::vector<NodeCategories> nodes = categories_of_nodes(network, table);
    for (Segment& segment : network.segments) {
        const uint32_t own = table.slots[segment.slot].category;
        if (own == no_network_category)
            continue;
        if ((segment.ends & LINE_ENDS_AT_A) != 0)
            segment.ends |= cut_at(nodes[segment.a], own, half_widths) << CUT_A_SHIFT;
        if ((segment.ends & LINE_ENDS_AT_B) != 0)
            segment.ends |= cut_at(nodes[segment.b], own, half_widths) << CUT_B_SHIFT;
    }
}

// A node's lines are at most as wide as half the way to the next line of their category that cannot be walked to
// within a few widths.
void keep_apart(Network& network, const CategoryTable& table) {
    if (!(table.reach > 0.0))
        return;
    const SegmentCells cells(network, 2.0 * table.reach);
    const Links links(network);
    const double walk = 4.0 * table.reach;
    std::vector<double> clearances(network.nodes.size(), table.reach);
    parallel_for(network.nodes.size(), 256, 0, [&](size_t begin, size_t end) {
        for (size_t node = begin; node < end; ++node) {
            uint64_t done = 0;
            for (uint32_t i = links.first[node]; i < links.first[node + 1]; ++i) {
                const uint32_t own = table.slots[network.segments[links.segments[i]].slot].category;
                if (own == no_network_category || (done >> own & 1U) != 0)
                    continue;
                done |= uint64_t{1} << own;
                const auto friends = connected(network, table, links, static_cast<uint32_t>(node), own, walk);
                const Vector2 place = at(network, static_cast<uint32_t>(node));
                cells.near(place, [&](uint32_t other) {
                    const Segment& segment = network.segments[other];
                    if (table.slots[segment.slot].category != own ||
                        std::binary_search(friends.begin(), friends.end(), other))
                        return;
                    const double way = distance(place, at(network, segment.a), at(network, segment.b));
                    clearances[node] = std::min(clearances[node], gap * 0.5 * way);
                });
            }
        }
    });
    for (size_t i = 0; i < clearances.size(); ++i) {
        const auto steps = static_cast<uint32_t>(clearances[i] / table.reach * clearance_steps);
        network.nodes[i].marks = network.nodes[i].grade() | steps << NODE_CLEARANCE_SHIFT;
    }
}

void forget_mends(Network& network) {
    for (Segment& segment : network.segments)
        segment.ends &= LINE_ENDS_AT_A | LINE_ENDS_AT_B | PLAIN_A | PLAIN_B;
    for (Node& node : network.nodes)
        node.marks = node.grade() | clearance_steps << NODE_CLEARANCE_SHIFT;
}

}  // namespace decalgl::network
