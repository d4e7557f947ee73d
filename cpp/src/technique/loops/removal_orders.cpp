#include "technique/loops/removal_orders.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "decalgl/core/error.h"

namespace decalgl::loops {
namespace {

struct Range {
    uint32_t begin;
    uint32_t end;
    uint32_t depth;
};

// Appends the vertices between the ends of `chain`, numbers of `arc`'s vertices, the last to go first. Ranges
// that would be cut one vertex at a time are halved from a depth on, so that no input takes quadratic time: the
// error is the greatest distance all the same.
void refine(Span<const LatticePoint> arc, Span<const uint32_t> chain, std::vector<Removal>& order) {
    const auto last = static_cast<uint32_t>(chain.size() - 1);
    const auto deepest = static_cast<uint32_t>(16 + 8 * std::log2(double(chain.size())));
    std::vector<Range> ranges = {{0, last, 0}};
    while (!ranges.empty()) {
        const Range range = ranges.back();
        ranges.pop_back();
        if (range.end - range.begin < 2)
            continue;
        const LatticePoint a = arc[chain[range.begin]], b = arc[chain[range.end]];
        uint32_t split = (range.begin + range.end) / 2;
        double farthest = 0.0;
        for (uint32_t i = range.begin + 1; i < range.end; ++i) {
            const double distance = distance_to_segment(arc[chain[i]], a, b);
            if (distance > farthest) {
                farthest = distance;
                split = range.depth < deepest ? i : split;
            }
        }
        order.push_back({chain[split], farthest});
        ranges.push_back({range.begin, split, range.depth + 1});
        ranges.push_back({split, range.end, range.depth + 1});
    }
}

// The vertices that are left of an arc, as a chain of links.
struct Links {
    std::vector<uint32_t> before, after;

    explicit Links(size_t size) : before(size), after(size) {
        for (uint32_t i = 0; i < size; ++i) {
            before[i] = i == 0 ? 0 : i - 1;
            after[i] = i + 1;
        }
    }
    void join(uint32_t left, uint32_t right) {
        after[left] = right;
        before[right] = left;
    }
};

struct Candidate {
    double error;
    uint32_t vertex;
    uint32_t version;

    bool operator<(const Candidate& other) const {
        return error != other.error ? error > other.error : vertex > other.vertex;
    }
};

double cross_of(LatticePoint a, LatticePoint b, LatticePoint origin) {
    return (double(a.x) - origin.x) * (double(b.y) - origin.y) -
           (double(a.y) - origin.y) * (double(b.x) - origin.x);
}

// A run of vertices that turn the same way. `sum`: twice the area between their path, with the vertices before
// and after, and the arc's first point.
struct Bend {
    uint32_t first;
    uint32_t last;
    int turn;  // 0: straight on
    double sum;
    uint32_t version = 0;
    bool gone = false;
    int64_t before = -1, after = -1;  // neighbouring bends
};

// Section 4.3 and figure 6.
class Bends {
public:
    Bends(Span<const LatticePoint> arc, std::vector<Removal>& order)
        : arc_(arc), order_(order), links_(arc.size()) {
        int64_t previous = -1;
        for (uint32_t v = 1; v + 1 < arc.size(); ++v)
            previous = append(single(v), previous);
        for (size_t i = 0; i < bends_.size(); ++i)
            offer(static_cast<uint32_t>(i));
    }

    void run() {
        while (!queue_.empty()) {
            const Candidate next = queue_.top();
            queue_.pop();
            Bend& bend = bends_[next.vertex];
            if (bend.gone || bend.version != next.version)
                continue;
            remove(next.vertex, next.error);
        }
    }

private:
    int turn_at(uint32_t v) const {
        const int64_t turn = doubled_area(arc_[links_.before[v]], arc_[v], arc_[links_.after[v]]);
        return (turn > 0) - (turn < 0);
    }
    double step(uint32_t from) const { return cross_of(arc_[from], arc_[links_.after[from]], arc_[0]); }

    Bend single(uint32_t v) const { return {v, v, turn_at(v), step(links_.before[v]) + step(v)}; }

    // Joins a bend to the one at `place` where both turn the same way, else puts it after; gives its place.
    int64_t append(const Bend& bend, int64_t place) {
        if (place >= 0) {
            Bend& left = bends_[static_cast<size_t>(place)];
            if (left.turn == bend.turn || left.turn == 0 || bend.turn == 0) {
                // The step between the two belongs to both.
                left.sum += bend.sum - step(left.last);
                left.last = bend.last;
                left.turn = left.turn == 0 ? bend.turn : left.turn;
                return place;
            }
        }
        const auto made = static_cast<int64_t>(bends_.size());
        bends_.push_back(bend);
        bends_.back().before = place;
        bends_.back().after = -1;
        if (place >= 0)
            bends_[static_cast<size_t>(place)].after = made;
        return made;
    }

    double error_of(const Bend& bend) const {
        const double closing =
            cross_of(arc_[links_.after[bend.last]], arc_[links_.before[bend.first]], arc_[0]);
        return std::sqrt(std::abs(0.5 * (bend.sum + closing)));
    }

    void offer(uint32_t place) {
        Bend& bend = bends_[place];
        queue_.push({error_of(bend), place, ++bend.version});
    }

    void remove(uint32_t place, double error) {
        const Bend bend = bends_[place];
        const uint32_t left = links_.before[bend.first], right = links_.after[bend.last];
        emit(bend, error);
        bends_[place].gone = true;
        // The neighbours lose the vertices whose turn changes; these then join whatever turns their way.
        const bool left_inner = left != 0, right_inner = right + 1 != arc_.size();
        int64_t before = left_inner ? shorten_left(bend.before, left) : -1;
        const int64_t after = right_inner ? shorten_right(bend.after, right) : -1;
        links_.join(left, right);
        if (before >= 0)
            bends_[static_cast<size_t>(before)].after = -1;
        const int64_t outer = before;
        if (left_inner)
            before = append(single(left), before);
        if (right_inner)
            before = append(single(right), before);
        if (after >= 0)
            before = join(before, after);
        else if (before >= 0)
            bends_[static_cast<size_t>(before)].after = right_inner ? after_of_right_ : -1;
        if (before >= 0 && bends_[static_cast<size_t>(before)].after >= 0)
            bends_[static_cast<size_t>(bends_[static_cast<size_t>(before)].after)].before = before;
        offer_around(outer, before);
    }

    // The last vertex of the bend before goes out of it; gives the bend that now ends there.
    int64_t shorten_left(int64_t place, uint32_t vertex) {
        Bend& bend = bends_[static_cast<size_t>(place)];
        bend.sum -= step(vertex);
        if (bend.first == vertex) {
            bend.gone = true;
            return bend.before;
        }
        bend.last = links_.before[vertex];
        return place;
    }

    int64_t shorten_right(int64_t place, uint32_t vertex) {
        Bend& bend = bends_[static_cast<size_t>(place)];
        after_of_right_ = bend.after;
        if (bend.first == vertex && bend.last == vertex) {
            bend.gone = true;
            return -1;
        }
        bend.sum -= step(links_.before[vertex]);
        bend.first = links_.after[vertex];
        return place;
    }

    // Two bends side by side, as one where they turn the same way; gives the last of them.
    int64_t join(int64_t left, int64_t right) {
        Bend& next = bends_[static_cast<size_t>(right)];
        if (left < 0) {
            next.before = -1;
            return right;
        }
        const int64_t after = next.after;
        const Bend copy = next;
        Bend& own = bends_[static_cast<size_t>(left)];
        if (own.turn == copy.turn || own.turn == 0 || copy.turn == 0) {
            own.sum += copy.sum - step(own.last);
            own.last = copy.last;
            own.turn = own.turn == 0 ? copy.turn : own.turn;
            own.after = after;
            next.gone = true;
            return left;
        }
        own.after = right;
        next.before = left;
        return right;
    }

    // New prices for all bends from `first` (or the one after, where it is -1) to `last`, going back.
    void offer_around(int64_t first, int64_t last) {
        for (int64_t place = last; place >= 0; place = bends_[static_cast<size_t>(place)].before) {
            offer(static_cast<uint32_t>(place));
            if (place == first)
                break;
        }
        const int64_t beyond = last >= 0 ? bends_[static_cast<size_t>(last)].after : -1;
        if (beyond >= 0)
            offer(static_cast<uint32_t>(beyond));
    }

    void emit(const Bend& bend, double error) {
        chain_.clear();
        for (uint32_t v = links_.before[bend.first]; v != links_.after[bend.last]; v = links_.after[v])
            chain_.push_back(v);
        chain_.push_back(links_.after[bend.last]);
        const size_t begin = order_.size();
        refine(arc_, chain_, order_);
        order_[begin].error = std::max(order_[begin].error, error);
        std::reverse(order_.begin() + static_cast<ptrdiff_t>(begin), order_.end());
    }

    Span<const LatticePoint> arc_;
    std::vector<Removal>& order_;
    Links links_;
    std::vector<Bend> bends_;
    std::priority_queue<Candidate> queue_;
    std::vector<uint32_t> chain_;
    int64_t after_of_right_ = -1;
};

}  // namespace

void order_douglas_peucker(Span<const LatticePoint> arc, std::vector<Removal>& order) {
    order.clear();
    std::vector<uint32_t> chain(arc.size());
    for (uint32_t i = 0; i < chain.size(); ++i)
        chain[i] = i;
    refine(arc, chain, order);
    std::reverse(order.begin(), order.end());
}

void order_wang_mueller(Span<const LatticePoint> arc, std::vector<Removal>& order) {
    order.clear();
    Bends(arc, order).run();
}

void order_visvalingam_whyatt(Span<const LatticePoint> arc, std::vector<Removal>& order) {
    order.clear();
    Links links(arc.size());
    std::vector<uint32_t> versions(arc.size());
    std::priority_queue<Candidate> queue;
    const auto offer = [&](uint32_t v) {
        if (v == 0 || v + 1 == arc.size())
            return;
        const double area =
            0.5 * std::abs(double(doubled_area(arc[links.before[v]], arc[v], arc[links.after[v]])));
        queue.push({std::sqrt(area), v, ++versions[v]});
    };
    for (uint32_t v = 1; v + 1 < arc.size(); ++v)
        offer(v);
    while (!queue.empty()) {
        const Candidate next = queue.top();
        queue.pop();
        if (versions[next.vertex] != next.version)
            continue;
        order.push_back({next.vertex, next.error});
        const uint32_t left = links.before[next.vertex], right = links.after[next.vertex];
        links.join(left, right);
        offer(left);
        offer(right);
    }
}

void order_by_function(Span<const LatticePoint> arc, const Lattice& lattice, const RemovalFunction& function,
                       std::vector<Removal>& order) {
    std::vector<double> coordinates;
    for (const LatticePoint p : arc) {
        coordinates.push_back(lattice.x_of(p));
        coordinates.push_back(lattice.y_of(p));
    }
    order = function(coordinates);
    std::vector<bool> named(arc.size());
    bool is_right = order.size() + 2 == arc.size();
    for (Removal& removal : order) {
        is_right = is_right && removal.vertex > 0 && removal.vertex + 1 < arc.size() &&
                   !named[removal.vertex] && std::isfinite(removal.error) && removal.error >= 0.0;
        if (!is_right)
            break;
        named[removal.vertex] = true;
        removal.error /= lattice.quantum;
    }
    if (!is_right)
        throw Error(ErrorKind::input,
                    "the order of removal must name each vertex between the two ends of an arc once, "
                    "with a finite error of zero or more; for an arc of " +
                        std::to_string(arc.size()) + " vertices it gave something else");
}

}  // namespace decalgl::loops
