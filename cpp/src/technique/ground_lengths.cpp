#include "technique/ground_lengths.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/segment_interval.h"

namespace decalgl {
namespace {

// By how much the slants on both sides of a place differ where the ground bends there.
constexpr double least_bend = 1e-6;
// Of the distance between samples: closer crossings are one.
constexpr double least_step = 1e-6;

// A stretch of an edge: where it ends, and its lengths.
struct Piece {
    double x, y;
    double on_map;
    double over_ground;

    double slant() const { return on_map > 0.0 ? over_ground / on_map : 1.0; }
};

// Cuts edges where they pass from one triangle of the terrain to the next at another slope.
class EdgeCutter {
public:
    explicit EdgeCutter(const Heightfield& terrain) : terrain_(terrain) {}

    // The pieces from a to b, at least one.
    const std::vector<Piece>& cut(const double* a, const double* b) {
        // The same places from both sides, as neighbours share edges.
        const bool turned = std::make_pair(b[0], b[1]) < std::make_pair(a[0], a[1]);
        cut_forwards(turned ? b : a, turned ? a : b);
        if (turned)
            turn_around(b);
        return pieces_;
    }

private:
    void cut_forwards(const double* a, const double* b) {
        find_crossings(a, b);
        pieces_.clear();
        const double dx = b[0] - a[0], dy = b[1] - a[1], length = std::hypot(dx, dy);
        double share = 0.0, height = terrain_.height_at(a[0], a[1]);
        for (const double next : crossings_) {
            const bool is_last = next >= 1.0;
            const double x = is_last ? b[0] : a[0] + next * dx, y = is_last ? b[1] : a[1] + next * dy;
            const double there = terrain_.height_at(x, y), on_map = (next - share) * length;
            // Over a hole it goes on level.
            const double rise = std::isnan(there - height) ? 0.0 : there - height;
            add({x, y, on_map, std::hypot(on_map, rise)});
            share = next;
            height = there;
        }
    }

    void add(const Piece& piece) {
        if (pieces_.empty() || std::abs(pieces_.back().slant() - piece.slant()) > least_bend) {
            pieces_.push_back(piece);
            return;
        }
        Piece& last = pieces_.back();
        last = {piece.x, piece.y, last.on_map + piece.on_map, last.over_ground + piece.over_ground};
    }

    // Shares of the way from a to b, the last of them 1: lines of samples, and the diagonals between them.
    void find_crossings(const double* a, const double* b) {
        const double column = (a[0] - terrain_.x0()) / terrain_.dx(),
                     row = (terrain_.y0() - a[1]) / terrain_.dy();
        const double columns = (b[0] - a[0]) / terrain_.dx(), rows = (a[1] - b[1]) / terrain_.dy();
        crossings_.clear();
        SegmentInterval inside;
        inside.clip(column, columns, 0.0, terrain_.columns() - 1.0);
        inside.clip(row, rows, 0.0, terrain_.rows() - 1.0);
        if (inside.first < inside.last) {
            crossings_ = {inside.first, inside.last};
            add_crossings(column, columns, inside);
            add_crossings(row, rows, inside);
            add_crossings(column - row, columns - rows, inside);
        }
        std::sort(crossings_.begin(), crossings_.end());
        const double step = least_step / std::max({std::abs(columns), std::abs(rows), least_step});
        double last = 0.0;
        const auto is_beside = [&](double share) {
            const bool drops = share < last + step || share > 1.0 - step;
            last = drops ? last : share;
            return drops;
        };
        crossings_.erase(std::remove_if(crossings_.begin(), crossings_.end(), is_beside), crossings_.end());
        crossings_.push_back(1.0);
    }

    // Where a count of samples that grows from `start` by `step` is a whole one.
    void add_crossings(double start, double step, const SegmentInterval& inside) {
        if (step == 0.0)
            return;
        const double p = start + inside.first * step, q = start + inside.last * step;
        for (double line = std::ceil(std::min(p, q)); line <= std::max(p, q); ++line)
            crossings_.push_back((line - start) / step);
    }

    void turn_around(const double* end) {
        std::reverse(pieces_.begin(), pieces_.end());
        for (size_t i = 0; i + 1 < pieces_.size(); ++i) {
            pieces_[i].x = pieces_[i + 1].x;
            pieces_[i].y = pieces_[i + 1].y;
        }
        pieces_.back().x = end[0];
        pieces_.back().y = end[1];
    }

    const Heightfield& terrain_;
    std::vector<double> crossings_;
    std::vector<Piece> pieces_;
};

// Arrays that are counted for as long as they are kept.
struct Counted {
    std::shared_ptr<const void> storage;
    MemoryCharge charge;
};

// Features with the places in between as vertices.
class GroundFeatures {
public:
    GroundFeatures(const Features& features, const Heightfield& terrain, const MemoryAccount& memory)
        : features_(features), cutter_(terrain), charge_(memory, "static: lengths on the ground", 0) {}

    Features make() {
        for (size_t part = 0; part < features_.part_count(); ++part) {
            add_part(features_.part(part));
            part_offsets_.push_back(static_cast<int64_t>(slants_.size()));
        }
        Features made = Features::own(features_.kind, std::move(coordinates_), std::move(part_offsets_),
                                      {features_.feature_offsets.begin(), features_.feature_offsets.end()},
                                      {features_.rows.begin(), features_.rows.end()}, std::move(slants_));
        made.storage = std::make_shared<Counted>(Counted{std::move(made.storage), std::move(charge_)});
        return made;
    }

private:
    void add_part(Span<const double> vertices) {
        const size_t count = vertices.size() / 2, first = slants_.size();
        if (count == 0)
            return;
        // Whether a line is closed, and a ring drawn, is told by how many vertices it has: there and back stays that.
        const bool is_ring = features_.kind == FeatureKind::polygons;
        const bool returns = vertices[0] == vertices[2 * count - 2] && vertices[1] == vertices[2 * count - 1];
        const bool bends = !(is_ring && count < 3) && !(count == 3 && returns);
        add_vertex(vertices[0], vertices[1], 1.0);
        for (size_t i = 1; i < count; ++i) {
            const double slant = add_bends(&vertices[2 * i - 2], &vertices[2 * i], bends);
            add_vertex(vertices[2 * i], vertices[2 * i + 1], slant);
        }
        if (is_ring)
            slants_[first] = static_cast<float>(add_bends(&vertices[2 * count - 2], &vertices[0], bends));
    }

    // Of an edge, or none; the slant of what is left to its end.
    double add_bends(const double* a, const double* b, bool bends) {
        const std::vector<Piece>& pieces = cutter_.cut(a, b);
        Piece left{b[0], b[1], 0.0, 0.0};
        for (size_t i = 0; i < pieces.size(); ++i) {
            left.on_map += pieces[i].on_map;
            left.over_ground += pieces[i].over_ground;
            if (!bends || i + 1 == pieces.size())
                continue;
            add_vertex(pieces[i].x, pieces[i].y, -left.slant());
            left.on_map = left.over_ground = 0.0;
        }
        return left.slant();
    }

    void add_vertex(double x, double y, double slant) {
        if (slants_.size() == slants_.capacity()) {
            const size_t room = std::max<size_t>(2 * slants_.size(), 1024);
            charge_.resize(room * (2 * sizeof(double) + sizeof(float)));
            coordinates_.reserve(2 * room);
            slants_.reserve(room);
        }
        coordinates_.push_back(x);
        coordinates_.push_back(y);
        slants_.push_back(static_cast<float>(slant));
    }

    const Features& features_;
    EdgeCutter cutter_;
    MemoryCharge charge_;
    std::vector<double> coordinates_;
    std::vector<float> slants_;
    std::vector<int64_t> part_offsets_{0};
};

}  // namespace

bool follows_ground(const StrokeStyle& style) {
    return style.pattern.period > 0.0 && style.slope_correction == SlopeCorrection::tangent;
}

bool follows_ground(const Stroke& stroke) {
    return std::any_of(stroke.styles.begin(), stroke.styles.end(),
                       [](const StrokeStyle& style) { return follows_ground(style); });
}

Features on_ground(const Features& features, const Layer& layer, const Heightfield& terrain,
                   const MemoryAccount& memory) {
    if (!follows_ground(layer.stroke) && !follows_ground(layer.casing))
        return features;
    return GroundFeatures(features, terrain, memory).make();
}

}  // namespace decalgl
