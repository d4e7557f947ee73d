// Strokes of the BVH index against brute force, to a few quanta.
#include "bvh_maps.h"
#include "technique/static_bvh/stroke_outline.h"

using namespace decalgl;
using namespace decalgl::bvh;
using namespace decalgl::bvh::maps;

TEST_CASE("lines of a BVH index agree with brute force", "[bvh]") {
    const double width = GENERATE(0.01, 0.8, 7.0, 90.0, 5000.0);
    const double size = GENERATE(0.5, 60.0, 3000.0);
    BvhOptions options = with_cells(GENERATE(1, 100));
    options.segment_order = GENERATE(SegmentOrder::importance, SegmentOrder::hilbert);
    RandomMap random(static_cast<unsigned>(width * 100 + size));
    std::vector<Feature> all;
    for (int i = 0; i < 25; ++i)
        all.push_back({random.part(1 + i % 7, size)});
    const auto bvh = build({lines(all, {width})}, options);
    require_well_formed(*bvh);
    const double tolerance = 1.5 * bvh->counts().quantum;
    for (int sample = 0; sample < 800; ++sample) {
        const Position p = near(all[static_cast<size_t>(sample) % all.size()], random, width + size);
        const std::vector<bool> found = found_at(*bvh, all.size(), p);
        for (size_t i = 0; i < all.size(); ++i) {
            const double distance = distance_to(all[i], p);
            if (std::abs(distance - 0.5 * width) > tolerance)
                REQUIRE(found[i] == (distance < 0.5 * width));
        }
    }
}

TEST_CASE("widened segments reach the cells that they overlap", "[bvh]") {
    RandomMap random(41);
    const DecalGrid grid = DecalGrid::over({0, 0, 9999, 7999}, 20);
    int wrong = 0;
    for (int i = 0; i < 100; ++i) {
        const auto place = [&] { return static_cast<int32_t>(random.between(-2000, 12000)); };
        const LatticePoint a{place(), place()}, b{place(), place()};
        const double half_width = random.between(1, i % 2 ? 50 : 1500);
        std::vector<bool> reached(grid.cell_count(), false);
        const StrokeOutline outline = round_outline(a, b, half_width);
        grid.for_each_cell(outline.corners, outline.box, [&](uint32_t cell) { reached[cell] = true; });
        const Feature line{{double(a.x), double(a.y), double(b.x), double(b.y)}};
        for (uint32_t cell = 0; cell < grid.cell_count(); ++cell) {
            const LatticeBox box = grid.cell_box(cell);
            double nearest = 1e300;
            for (int k = 0; k < 40 * 40; ++k)
                nearest = std::min(
                    nearest, distance_to(line, {box.min_x + (box.max_x - box.min_x) * (k % 40) / 39.0,
                                                box.min_y + (box.max_y - box.min_y) * (k / 40) / 39.0}));
            // A stroke is round at its ends, its outline square.
            const double corner = half_width * std::sqrt(2.0) + 3.0;
            wrong += (nearest <= half_width && !reached[cell]) || (nearest > corner + 15.0 && reached[cell]);
        }
    }
    CHECK(wrong == 0);
}

namespace {

Position operator-(Position a, Position b) {
    return {a.x - b.x, a.y - b.y};
}
double dot(Position a, Position b) {
    return a.x * b.x + a.y * b.y;
}
double across(Position d, Position v) {
    return std::abs(d.x * v.y - d.y * v.x);
}
Position unit(Position v) {
    return {v.x / std::hypot(v.x, v.y), v.y / std::hypot(v.x, v.y)};
}

// A stroke by its definition, in metres.
struct DefinedStroke {
    std::vector<Position> way;
    bool closed = false;
    StrokeStyle style;
    double half_width = 0.0;

    DefinedStroke(const Part& part, bool is_ring, StrokeStyle given, double r)
        : style(std::move(given)), half_width(r) {
        for (size_t i = 0; i < part.size(); i += 2)
            if (way.empty() || part[i] != way.back().x || part[i + 1] != way.back().y)
                way.push_back({part[i], part[i + 1]});
        const bool repeats = way.front().x == way.back().x && way.front().y == way.back().y;
        closed = is_ring || (way.size() >= 4 && repeats);
        if (closed && repeats && way.size() > 1)
            way.pop_back();
        if (is_ring && way.size() < 3)
            way.clear();
    }

    double share_at(double arc) const {
        if (style.pattern.period == 0.0)
            return 1.0;
        const double period = style.pattern.period;
        const double phase =
            arc + style.pattern.offset - period * std::floor((arc + style.pattern.offset) / period);
        double share = -1.0;
        for (const PatternMark& mark : style.pattern.marks)
            if (mark.begin <= phase && phase <= mark.end)
                share =
                    std::max(share, mark.begin_width + (mark.end_width - mark.begin_width) *
                                                           (phase - mark.begin) / (mark.end - mark.begin));
        return share;
    }

    bool corner_holds(Position v, Position coming, Position going, double r) const {
        const double turn = std::acos(std::clamp(dot(coming, going), -1.0, 1.0));
        const bool sharp = turn > M_PI - 1e-6 || M_PI - turn < style.miter_limit * M_PI / 180.0;
        if (style.corner == Corner::round || (style.corner == Corner::miter && sharp))
            return std::hypot(v.x, v.y) <= r;
        if (dot(v, coming) < 0.0 || dot(v, going) > 0.0 || across(coming, v) > r || across(going, v) > r)
            return false;
        const Position bend = coming - going;
        return style.corner == Corner::miter ||
               (turn > 1e-6 && turn < M_PI - 1e-6 && dot(v, unit(bend)) <= r * std::cos(0.5 * turn));
    }

    bool vertex_holds(size_t i, Position v, double r) const {
        const bool ends = !closed && (i == 0 || i + 1 == way.size());
        if (way.size() == 1 && style.cap == Cap::square)
            return std::max(std::abs(v.x), std::abs(v.y)) <= r;
        if (ends)
            return style.cap == Cap::round && std::hypot(v.x, v.y) <= r;
        const Position before = way[(i + way.size() - 1) % way.size()], after = way[(i + 1) % way.size()];
        return corner_holds(v, unit(way[i] - before), unit(after - way[i]), r);
    }

    bool bar_holds(size_t i, Position p, double arc) const {
        const Position a = way[i], b = way[(i + 1) % way.size()], d = unit(b - a);
        const double longer = style.cap == Cap::square ? half_width : 0.0;
        const double t = dot(p - a, d), length = std::hypot(b.x - a.x, b.y - a.y);
        return t >= (!closed && i == 0 ? -longer : 0.0) &&
               t <= length + (!closed && i + 2 == way.size() ? longer : 0.0) &&
               across(d, p - a) <= half_width * share_at(arc + t);
    }

    bool holds(Position p) const {
        double arc = 0.0;
        for (size_t i = 0; i < way.size(); ++i) {
            if (vertex_holds(i, p - way[i], half_width * share_at(arc)))
                return true;
            if (i + 1 == way.size() && !closed)
                break;
            if (bar_holds(i, p, arc))
                return true;
            const Position b = way[(i + 1) % way.size()];
            arc += std::hypot(b.x - way[i].x, b.y - way[i].y);
        }
        return false;
    }
};

// Whether all of a few points around agree, so that no border is near.
template <typename Holds>
bool is_sure(Position p, double apart, bool value, Holds holds) {
    for (int i = 0; i < 8; ++i)
        if (holds(Position{p.x + apart * std::cos(i * M_PI / 4), p.y + apart * std::sin(i * M_PI / 4)}) !=
            value)
            return false;
    return true;
}

// Lines of all sorts: closed, level and upright, there and back, with vertices that repeat, and single ones.
std::vector<Feature> odd_lines(double size, unsigned seed) {
    RandomMap random(seed);
    std::vector<Feature> all;
    for (int i = 0; i < 40; ++i) {
        Part part = random.part(i % 9 == 8 ? 1 : 2 + i % 6, size, i % 4 == 1 ? size / 4 : 0.0);
        if (i % 5 == 2)
            part.insert(part.end(), {part[0], part[1]});
        if (i % 5 == 3)
            part.insert(part.begin(), {part[0], part[1]});
        if (i % 7 == 4 && part.size() > 4)
            part[4] = part[0], part[5] = part[1];
        all.push_back({part});
    }
    return all;
}

LinePattern dashes_and_arrows() {
    LinePattern pattern;
    pattern.period = 11.0;
    pattern.offset = -2.5;
    pattern.marks = {{0.0, 3.0, 1.0, 1.0}, {4.0, 9.0, 1.0, 0.0}};
    return pattern;
}

StrokeStyle style_of(Corner corner, Cap cap, double miter_limit = 40.0) {
    StrokeStyle style;
    style.corner = corner;
    style.cap = cap;
    style.miter_limit = miter_limit;
    return style;
}

void require_strokes_found(const Layer& layer, const std::vector<Feature>& all, const BvhOptions& options,
                           double size) {
    const auto bvh = build({layer}, options);
    require_well_formed(*bvh);
    const double apart = 24.0 * bvh->counts().quantum;
    RandomMap random(9);
    int decided = 0;
    for (int sample = 0; sample < 2500; ++sample) {
        const size_t feature = static_cast<size_t>(sample) % all.size();
        const Position p = near(all[feature], random, size);
        const std::vector<bool> found = found_at(*bvh, all.size(), p);
        const auto holds = [&](Position at) {
            return DefinedStroke(all[feature][0], false, layer.stroke.styles[layer.stroke.style(feature)],
                                 0.5 * layer.stroke.width(feature))
                .holds(at);
        };
        const bool expected = holds(p);
        if (!is_sure(p, apart, expected, holds))
            continue;
        ++decided;
        INFO(p.x << ", " << p.y << " of feature " << feature);
        REQUIRE(found[feature] == expected);
    }
    CHECK(decided > 2000);
}

}  // namespace

TEST_CASE("corners and caps of a BVH index agree with their definitions", "[bvh]") {
    const double width = GENERATE(0.5, 12.0, 150.0);
    const double size = GENERATE(4.0, 90.0);
    const std::vector<Feature> all = odd_lines(size, static_cast<unsigned>(width + size));
    Layer layer = lines(all, {width});
    layer.stroke.styles.clear();
    for (const Corner corner : {Corner::round, Corner::miter, Corner::bevel})
        for (const Cap cap : {Cap::round, Cap::butt, Cap::square})
            layer.stroke.styles.push_back(style_of(corner, cap));
    for (const double limit : {5.0, 90.0, 120.0, 180.0})
        layer.stroke.styles.push_back(style_of(Corner::miter, Cap::butt, limit));
    for (uint32_t i = 0; i < all.size(); ++i)
        layer.stroke.style_of.push_back(i % static_cast<uint32_t>(layer.stroke.styles.size()));
    BvhOptions options = with_cells(GENERATE(3, 200));
    options.segment_order = GENERATE(SegmentOrder::importance, SegmentOrder::hilbert);
    require_strokes_found(layer, all, options, 0.7 * width + 0.5 * size);
}

TEST_CASE("patterns of a BVH index follow the length of their lines", "[bvh]") {
    const double width = GENERATE(2.0, 25.0);
    const std::vector<Feature> all = odd_lines(60.0, 3);
    Layer layer = lines(all, {width});
    layer.stroke.styles.clear();
    for (const Corner corner : {Corner::round, Corner::miter, Corner::bevel})
        for (const Cap cap : {Cap::round, Cap::butt, Cap::square}) {
            layer.stroke.styles.push_back(style_of(corner, cap));
            layer.stroke.styles.back().pattern = dashes_and_arrows();
        }
    for (uint32_t i = 0; i < all.size(); ++i)
        layer.stroke.style_of.push_back(i % 9);
    require_strokes_found(layer, all, with_cells(100), 0.7 * width + 5.0);
}

TEST_CASE("a pattern stays in step on a line of a thousand kilometres", "[bvh]") {
    // Far beyond the map on both sides, so it is cut.
    const Feature line{{-500000.0, 2500.0, 1500.0, 2500.25, 500000.0, 2499.0}};
    Layer layer = lines({line}, {8.0});
    layer.stroke.styles[0] = style_of(Corner::miter, Cap::butt);
    layer.stroke.styles[0].pattern = dashes_and_arrows();
    const auto bvh = build({layer});
    const DefinedStroke defined(line[0], false, layer.stroke.styles[0], 4.0);
    RandomMap random(4);
    int on = 0;
    for (int sample = 0; sample < 3000; ++sample) {
        const Position p{random.between(1000, 1997), random.between(2494, 2506)};
        const auto holds = [&](Position at) { return defined.holds(at); };
        const bool expected = holds(p);
        on += expected;
        if (is_sure(p, 1e-3, expected, holds))
            REQUIRE(bvh->query({p.x, p.y}).size() == (expected ? 1 : 0));
    }
    CHECK(on > 500);
}

TEST_CASE("outlines on one side end at the rings, however wide they are", "[bvh]") {
    const double width = GENERATE(3.0, 40.0, 400.0);
    const OutlineMode mode = GENERATE(OutlineMode::normal, OutlineMode::inset, OutlineMode::offset);
    const OutlineOrder order = GENERATE(OutlineOrder::layer, OutlineOrder::feature);
    RandomMap random(41);
    std::vector<Feature> all;
    for (int i = 0; i < 12; ++i) {
        const double x = random.between(1100, 1900), y = random.between(2100, 2900);
        all.push_back({random.part_at(x, y, 4 + i % 4, 120.0), random.part_at(x, y, 4, 30.0)});
    }
    Layer layer = polygons(all);
    layer.fill.colors.clear();  // which leaves the outlines alone
    layer.stroke.colors = {9, 9, 9, 255};
    layer.stroke.widths = {width};
    layer.stroke.styles[0] = style_of(Corner::miter, Cap::round);
    layer.outline_mode = mode;
    layer.outline_order = order;
    const auto bvh = build({layer}, with_cells(60));
    require_well_formed(*bvh);
    const double half_width = mode == OutlineMode::normal ? 0.5 * width : width;
    int decided = 0;
    for (int sample = 0; sample < 2500; ++sample) {
        const Feature& feature = all[static_cast<size_t>(sample) % all.size()];
        const Position p = near(feature, random, 30.0 + width);
        const auto holds = [&](Position at) {
            bool on = false;
            for (const Part& ring : feature)
                on |= DefinedStroke(ring, true, layer.stroke.styles[0], half_width).holds(at);
            return on && (mode == OutlineMode::normal ||
                          inside(bvh->lattice, feature, at) == (mode == OutlineMode::inset));
        };
        const bool expected = holds(p);
        if (!is_sure(p, 24.0 * bvh->counts().quantum, expected, holds))
            continue;
        ++decided;
        REQUIRE(found_at(*bvh, all.size(), p)[static_cast<size_t>(sample) % all.size()] == expected);
    }
    CHECK(decided > 2000);
}

TEST_CASE("a band without a colour is a gap, and a stroke without a width nothing", "[bvh]") {
    Layer layer = lines({{{1100, 2500, 1900, 2500}}, {{1100, 2600, 1900, 2600}}}, {20.0, 0.0});
    layer.stroke.styles[0].bands = {{0.5, {1, 2, 3, 0}}, {1.0, {4, 5, 6, 255}}};
    layer.stroke.widest = 60.0;
    const auto bvh = build({layer});
    CHECK(bvh->query({1500, 2502}).empty());
    CHECK(bvh->query({1500, 2507}).size() == 1);
    CHECK(bvh->query({1500, 2511}).empty());
    CHECK(bvh->query({1500, 2600}).empty());
}
