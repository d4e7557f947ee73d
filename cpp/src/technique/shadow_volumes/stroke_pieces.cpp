#include "technique/shadow_volumes/stroke_pieces.h"

#include <array>
#include <vector>

namespace decalgl::volume {
namespace {

constexpr double pi = 3.14159265358979323846;

Vector2 operator+(Vector2 a, Vector2 b) {
    return {a.x + b.x, a.y + b.y};
}
Vector2 operator-(Vector2 a, Vector2 b) {
    return {a.x - b.x, a.y - b.y};
}
Vector2 operator*(double s, Vector2 a) {
    return {s * a.x, s * a.y};
}
bool operator==(Vector2 a, Vector2 b) {
    return a.x == b.x && a.y == b.y;
}
Vector2 to_the_left(Vector2 d) {
    return {-d.y, d.x};
}

// What a bar ends with: its right and left corner, and whether the vertex lies on the edge between them.
struct BarEnd {
    Vector2 right;
    Vector2 left;
    bool has_middle;
};

struct Joint {
    double cosine = 1.0;
    double turn = 0.0;      // cross product of the directions: positive to the left
    bool is_plain = false;  // both borders meet
    bool meets = false;     // the inner borders meet
};

class StrokeCutter {
public:
    StrokeCutter(std::vector<Vector2> vertices, bool closed, const StrokeShape& shape, const PieceFn& add)
        : vertices_(std::move(vertices)), closed_(closed), shape_(shape), add_(add) {}

    void cut() {
        if (vertices_.size() == 1) {
            add_dot();
            return;
        }
        measure_segments();
        find_joints();
        for (size_t i = 0; i < segments_; ++i)
            add_bar(i);
        for (size_t i = 0; i < vertices_.size(); ++i)
            if (is_inner(i))
                add_wedge(i);
        if (!closed_ && shape_.cap == Cap::round) {
            const Vector2 begin = to_the_left(direction_.front()), end = to_the_left(direction_.back());
            add_fan(vertices_.front(), begin, -1.0 * begin, pi);
            add_fan(vertices_.back(), -1.0 * end, end, pi);
        }
    }

private:
    size_t before(size_t i) const { return i == 0 ? segments_ - 1 : i - 1; }
    size_t after(size_t i) const { return i + 1 == vertices_.size() ? 0 : i + 1; }
    bool is_inner(size_t i) const { return closed_ || (i > 0 && i + 1 < vertices_.size()); }

    void measure_segments() {
        segments_ = closed_ ? vertices_.size() : vertices_.size() - 1;
        for (size_t i = 0; i < segments_; ++i) {
            const Vector2 along = vertices_[after(i)] - vertices_[i];
            length_.push_back(std::hypot(along.x, along.y));
            direction_.push_back(1.0 / length_.back() * along);
        }
    }

    bool is_sharp(const Joint& joint) const {
        return joint.cosine < -std::cos(shape_.miter_limit * pi / 180.0) - 1e-6;
    }

    // How far from the vertex the inner borders meet, along either segment.
    double inner_length(const Joint& joint) const {
        return shape_.half_width * std::abs(joint.turn) / std::max(1.0 + joint.cosine, 1e-12);
    }

    void find_joints() {
        joints_.resize(vertices_.size());
        for (size_t i = 0; i < vertices_.size(); ++i) {
            if (!is_inner(i))
                continue;
            Joint& joint = joints_[i];
            const Vector2 coming = direction_[before(i)], going = direction_[i];
            joint = {dot(coming, going), cross(coming, going), false, false};
            const double shorter = std::min(length_[before(i)], length_[i]);
            const double needed = std::max(inner_length(joint), shape_.half_width * std::abs(joint.turn));
            joint.meets = joint.cosine > -0.99 && needed <= shorter && !crosses_the_one_before(i);
            const bool bends_little = joint.cosine > std::cos(0.5 * shape_.arc_step);
            joint.is_plain =
                joint.meets && (shape_.corner == Corner::miter ? !is_sharp(joint) : bends_little);
        }
        // The last joint of a closed line was not there yet when the first one was looked at.
        if (closed_ && crosses_the_one_before(0))
            joints_[0].meets = joints_[0].is_plain = false;
    }

    bool crosses_the_one_before(size_t i) const {
        if (!closed_ && i == 0)
            return false;
        const Joint& earlier = joints_[before(i)];
        return earlier.meets && inner_length(earlier) + inner_length(joints_[i]) > length_[before(i)];
    }

    Vector2 meeting_point(size_t i, double side) const {
        const Vector2 normals = to_the_left(direction_[before(i)]) + to_the_left(direction_[i]);
        return vertices_[i] + (side * shape_.half_width / (1.0 + joints_[i].cosine)) * normals;
    }

    // The end of a segment at vertex i.
    BarEnd end_at(size_t i, size_t segment) const {
        const Vector2 across = shape_.half_width * to_the_left(direction_[segment]);
        BarEnd end{vertices_[i] - across, vertices_[i] + across, true};
        if (!is_inner(i)) {
            const double beyond = shape_.cap == Cap::square ? shape_.half_width : 0.0;
            const Vector2 longer = (i == 0 ? -beyond : beyond) * direction_[segment];
            return {end.right + longer, end.left + longer, shape_.cap == Cap::round};
        }
        const Joint& joint = joints_[i];
        if (joint.is_plain)
            return {meeting_point(i, -1.0), meeting_point(i, 1.0), false};
        if (joint.meets)
            (joint.turn > 0.0 ? end.left : end.right) = meeting_point(i, joint.turn > 0.0 ? 1.0 : -1.0);
        return end;
    }

    void add_bar(size_t segment) {
        const BarEnd begin = end_at(segment, segment), end = end_at(after(segment), segment);
        std::array<Vector2, 6> corners;
        size_t count = 0;
        corners[count++] = begin.right;
        corners[count++] = end.right;
        if (end.has_middle)
            corners[count++] = vertices_[after(segment)];
        corners[count++] = end.left;
        corners[count++] = begin.left;
        if (begin.has_middle)
            corners[count++] = vertices_[segment];
        add_({corners.data(), count});
    }

    void add_wedge(size_t i) {
        const Joint& joint = joints_[i];
        if (joint.is_plain)
            return;
        const bool to_left = joint.turn >= 0.0;
        const Vector2 coming = to_the_left(direction_[before(i)]), going = to_the_left(direction_[i]);
        const Vector2 first = to_left ? -1.0 * coming : going, last = to_left ? -1.0 * going : coming;
        const Vector2 v = vertices_[i];
        const double r = shape_.half_width;
        if (shape_.corner == Corner::round || (shape_.corner == Corner::miter && is_sharp(joint))) {
            add_fan(v, first, last, std::atan2(std::abs(joint.turn), joint.cosine));
        } else if (shape_.corner == Corner::miter) {
            const std::array<Vector2, 4> corners{v, v + r * first, meeting_point(i, to_left ? -1.0 : 1.0),
                                                 v + r * last};
            add_(corners);
        } else if (joint.cosine > -1.0 + 1e-12) {
            const std::array<Vector2, 3> corners{v, v + r * first, v + r * last};
            add_(corners);
        }
    }

    // Triangles from a point over an arc between two unit vectors, counter-clockwise.
    void add_fan(Vector2 centre, Vector2 from, Vector2 to, double angle) {
        const int steps = std::max(1, static_cast<int>(std::ceil(angle / shape_.arc_step)));
        const auto at = [&](int step) {
            const double a = angle * step / steps;
            const Vector2 unit = step == steps ? to : std::cos(a) * from + std::sin(a) * to_the_left(from);
            return centre + shape_.half_width * unit;
        };
        for (int step = 0; step < steps; ++step) {
            const std::array<Vector2, 3> corners{centre, at(step), at(step + 1)};
            add_(corners);
        }
    }

    void add_dot() {
        const double r = shape_.half_width;
        const Vector2 v = vertices_.front();
        if (shape_.cap == Cap::round)
            add_fan(v, {1.0, 0.0}, {1.0, 0.0}, 2.0 * pi);
        if (shape_.cap == Cap::square) {
            const std::array<Vector2, 4> corners{v + Vector2{-r, -r}, v + Vector2{r, -r}, v + Vector2{r, r},
                                                 v + Vector2{-r, r}};
            add_(corners);
        }
    }

    std::vector<Vector2> vertices_;
    bool closed_;
    const StrokeShape& shape_;
    const PieceFn& add_;
    size_t segments_ = 0;
    std::vector<double> length_;
    std::vector<Vector2> direction_;
    std::vector<Joint> joints_;
};

}  // namespace

void cut_stroke(Span<const Vector2> part, bool ring, const StrokeShape& shape, const PieceFn& add) {
    std::vector<Vector2> vertices;
    for (const Vector2& vertex : part)
        if (vertices.empty() || !(vertices.back() == vertex))
            vertices.push_back(vertex);
    const bool returns = vertices.size() > 1 && vertices.front() == vertices.back();
    const bool closed = ring || (returns && vertices.size() >= 4);
    if (returns && closed)
        vertices.pop_back();
    if (vertices.empty() || (ring && vertices.size() < 3))
        return;
    StrokeCutter(std::move(vertices), closed, shape, add).cut();
}

}  // namespace decalgl::volume
