// Restyles and edits of the static index against indexes built from scratch: the same features everywhere, in the same
// order, and what is shared stays as it was.
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "decalgl/core/error.h"
#include "error_kind.h"
#include "technique/static_decals/levels.h"
#include "technique/static_decals/prepared_decals.h"

using namespace decalgl;

namespace {

constexpr Bounds bounds{0.0, 0.0, 1000.0, 1000.0};

using Ring = std::vector<double>;
// What lies where: rows of features by the layer, from the topmost down.
using Picks = std::vector<std::vector<std::pair<uint32_t, int64_t>>>;

Features features_of(FeatureKind kind, const std::vector<Ring>& parts, const std::vector<int64_t>& rows) {
    std::vector<double> coordinates;
    std::vector<int64_t> part_offsets{0}, feature_offsets{0};
    for (const Ring& part : parts) {
        coordinates.insert(coordinates.end(), part.begin(), part.end());
        part_offsets.push_back(static_cast<int64_t>(coordinates.size() / 2));
        feature_offsets.push_back(static_cast<int64_t>(part_offsets.size()) - 1);
    }
    return Features::own(kind, coordinates, part_offsets, feature_offsets, rows);
}

// A map as data: what a user would edit by hand.
struct Map {
    std::map<int64_t, Ring> areas, ways;  // by row
    double widest = 0.0;

    std::vector<Layer> layers() const {
        const auto split = [](const std::map<int64_t, Ring>& by_row, FeatureKind kind) {
            std::vector<Ring> parts;
            std::vector<int64_t> rows;
            for (const auto& [row, part] : by_row) {
                rows.push_back(row);
                parts.push_back(part);
            }
            return features_of(kind, parts, rows);
        };
        Layer polygons, lines;
        polygons.name = "areas";
        polygons.features = split(areas, FeatureKind::polygons);
        polygons.fill.colors = {200, 100, 50, 255};
        lines.name = "ways";
        lines.features = split(ways, FeatureKind::lines);
        lines.stroke.colors = {20, 30, 40, 255};
        lines.stroke.widths = {6.0};
        lines.stroke.widest = widest;
        return {polygons, lines};
    }
};

class Chance {
public:
    double number(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
    size_t index(size_t count) { return std::uniform_int_distribution<size_t>(0, count - 1)(engine_); }
    Ring part(size_t vertices, double size) {
        const double x = number(-50.0, 1050.0), y = number(-50.0, 1050.0);
        Ring ring;
        for (size_t i = 0; i < vertices; ++i) {
            ring.push_back(x + number(-size, size));
            ring.push_back(y + number(-size, size));
        }
        return ring;
    }

private:
    std::mt19937 engine_{7};
};

Map random_map(Chance& chance) {
    Map map;
    for (int64_t row = 0; row < 60; ++row) {
        map.areas[row] = chance.part(5, row % 9 == 0 ? 400.0 : 40.0);
        map.ways[row] = chance.part(4, row % 7 == 0 ? 500.0 : 60.0);
    }
    return map;
}

std::shared_ptr<const PreparedDecals> build(const std::vector<Layer>& layers,
                                            const MemoryAccount& memory = MemoryAccount()) {
    TechniqueInput input;
    input.layers = layers;
    input.bounds = bounds;
    input.positions = PositionGrid::around(bounds);
    input.memory = memory;
    Progress progress;
    return build_decals(input, progress);
}

std::shared_ptr<const PreparedDecals> as_decals(const std::shared_ptr<const Prepared>& prepared) {
    return std::static_pointer_cast<const PreparedDecals>(prepared);
}

// `rows`: of each layer's features.
Picks picks(const Prepared& decals, const std::vector<std::vector<int64_t>>& rows) {
    Picks found;
    for (double x = 0.5; x < 1000.0; x += 13.7)
        for (double y = 0.5; y < 1000.0; y += 13.3) {
            found.emplace_back();
            for (const FeatureReference& one : decals.query({x, y}))
                found.back().emplace_back(one.layer, rows[one.layer][one.feature]);
        }
    return found;
}

std::vector<std::vector<int64_t>> rows_of(const Map& map) {
    std::vector<std::vector<int64_t>> rows;
    for (const Layer& layer : map.layers())
        rows.emplace_back(layer.features.rows.begin(), layer.features.rows.end());
    return rows;
}

LayerEdit edit_of(uint32_t layer, const std::vector<Ring>& geometry, std::vector<uint32_t> replaced,
                  std::vector<uint32_t> removed) {
    LayerEdit edit;
    edit.layer = layer;
    edit.geometry = features_of(layer == 0 ? FeatureKind::polygons : FeatureKind::lines, geometry, {});
    edit.replaced = std::move(replaced);
    edit.removed = std::move(removed);
    edit.fill.colors = {200, 100, 50, 255};
    edit.stroke.colors = {20, 30, 40, 255};
    edit.stroke.widths = {6.0};
    return edit;
}

}  // namespace

TEST_CASE("edits find what an index of the edited data finds", "[static]") {
    Chance chance;
    Map map = random_map(chance);
    map.widest = GENERATE(0.0, 20.0);
    std::shared_ptr<const PreparedDecals> decals = build(map.layers());
    const std::shared_ptr<const PreparedDecals> first = decals;
    // Rows are features here, until an index is built anew.
    std::vector<std::vector<int64_t>> rows = rows_of(map);
    const std::vector<std::vector<int64_t>> first_rows = rows;
    const Picks at_first = picks(*first, first_rows);
    for (int step = 0; step < 120; ++step) {
        const auto layer = static_cast<uint32_t>(chance.index(2));
        std::map<int64_t, Ring>& parts = layer == 0 ? map.areas : map.ways;
        std::vector<Ring> geometry;
        std::vector<uint32_t> replaced, removed;
        const auto row_at = [&](size_t place) {
            return std::next(parts.begin(), static_cast<long>(place))->first;
        };
        if (step % 3 != 0) {
            const int64_t row = row_at(chance.index(parts.size()));
            replaced.push_back(static_cast<uint32_t>(row));
            geometry.push_back(parts[row] = chance.part(5, 50.0));
        }
        if (step % 3 != 1) {
            const auto row = static_cast<int64_t>(rows[layer].size());
            rows[layer].push_back(row);
            geometry.push_back(parts[row] = chance.part(4, 120.0));
        }
        if (step % 3 == 2) {
            const int64_t row = row_at(chance.index(parts.size() - 1));
            if (replaced.empty() || row != static_cast<int64_t>(replaced[0])) {
                removed.push_back(static_cast<uint32_t>(row));
                parts.erase(row);
            }
        }
        decals = as_decals(decals->edited(edit_of(layer, geometry, replaced, removed), MemoryAccount()));
        if (step % 24 == 23)
            CHECK(picks(*decals, rows) == picks(*build(map.layers()), rows_of(map)));
    }
    CHECK(picks(*first, first_rows) == at_first);
    CHECK(decals->unused_words <= decals->words.size() / 2);
}

TEST_CASE("an edit leaves other buckets as they are and shares their lists", "[static]") {
    Chance chance;
    const Map map = random_map(chance);
    const auto before = build(map.layers());
    const auto after = as_decals(before->edited(edit_of(1, {{500, 500, 520, 520}}, {}, {}), MemoryAccount()));
    size_t changed = 0;
    for (size_t bucket = 0; bucket < before->bucket_entries.size(); ++bucket)
        changed += before->bucket_entries[bucket] != after->bucket_entries[bucket] ? 1 : 0;
    CHECK(changed > 0);
    CHECK(changed < 40);
    // The first edit copies no lists either.
    CHECK(after->words.data() == before->words.data());
    CHECK(after->cells.data() == before->cells.data());
    const auto again = as_decals(after->edited(edit_of(1, {{300, 500, 320, 520}}, {}, {}), MemoryAccount()));
    CHECK(again->words.data() == after->words.data());
    CHECK(again->words.size() > after->words.size());
    // A second edit of the same index cannot continue its lists in place.
    const auto branch = as_decals(after->edited(edit_of(1, {{700, 500, 720, 520}}, {}, {}), MemoryAccount()));
    CHECK(branch->words.data() != after->words.data());
    CHECK(again->query({310.0, 510.0}).front() == FeatureReference{1, 61});
    CHECK(branch->query({710.0, 510.0}).front() == FeatureReference{1, 61});
}

TEST_CASE("edits are counted, and one beyond the budget changes nothing", "[static]") {
    Chance chance;
    const Map map = random_map(chance);
    const MemoryAccount memory;
    auto decals = build(map.layers(), memory);
    const uint64_t used = memory.total();
    MemoryAccount tight = memory;
    tight.set_budget(used + 1000);
    CHECK(test::kind_of([&] {
              decals->edited(edit_of(1, {{0, 0, 900, 900}}, {}, {}), memory);
          }) == ErrorKind::memory);
    CHECK(memory.total() == used);
    tight.set_budget(0);
    auto edited = decals->edited(edit_of(1, {{0, 0, 900, 900}}, {}, {}), memory);
    CHECK(memory.total() > used);
    edited.reset();
    CHECK(memory.total() == used);
    // Nor is the place of one that is gone taken twice.
    edited = decals->edited(edit_of(1, {{0, 0, 900, 900}}, {}, {}), memory);
    CHECK(as_decals(edited)->words.data() != decals->words.data());
    // Versions that continue one storage count once, whichever goes first.
    auto again = edited->edited(edit_of(1, {{0, 0, 900, 900}}, {}, {}), memory);
    CHECK(as_decals(again)->words.data() == as_decals(edited)->words.data());
    const uint64_t both = memory.total();
    edited.reset();
    CHECK(memory.total() < both);
    CHECK(again->query({450.0, 450.0}).front() == FeatureReference{1, 61});
    again.reset();
    CHECK(memory.total() == used);
    decals.reset();
    CHECK(memory.total() == 0);
}

TEST_CASE("an order of drawing is that of an index built with it", "[static]") {
    Chance chance;
    const Map map = random_map(chance);
    std::vector<Layer> layers = map.layers();
    LayerLook look;
    look.layer = 1;
    for (int64_t feature = 59; feature >= 0; --feature)
        look.draw_order.push_back((7 * feature + 3) % 60);
    const auto reordered = build(layers)->restyled(Span<const LayerLook>(&look, 1), MemoryAccount());
    layers[1].draw_order = look.draw_order;
    const auto expected = build(layers);
    CHECK(picks(*reordered, rows_of(map)) == picks(*expected, rows_of(map)));
    const bool levels_are_same = LevelPainter(LEVEL_TEXELS).draw(*as_decals(reordered)).texels ==
                                 LevelPainter(LEVEL_TEXELS).draw(*expected).texels;
    CHECK(levels_are_same);
    // And edits keep it.
    const auto edited = reordered->edited(edit_of(1, {{0, 0, 900, 900}}, {}, {5}), MemoryAccount());
    CHECK(edited->query({450.0, 450.0}).front() == FeatureReference{1, 60});
}

TEST_CASE("levels are coloured from what was kept as they are from scratch", "[static]") {
    Chance chance;
    Map map = random_map(chance);
    map.widest = 30.0;
    std::vector<Layer> layers = map.layers();
    if (GENERATE(false, true)) {
        layers[1].stroke.styles[0].corner = Corner::miter;
        layers[1].stroke.styles[0].bands = {{0.3, {250, 0, 0, 255}}, {1.0, {0, 250, 0, 100}}};
    }
    std::shared_ptr<const PreparedDecals> decals = build(layers);
    const int fineness = GENERATE(LEVEL_TEXELS, LEVEL_TEXELS / 4);
    LevelPainter painter(fineness);
    auto last = painter.draw(*decals).texels;
    const auto check = [&] {
        const auto texels = painter.draw(*decals).texels;
        // Not to be printed.
        const bool is_right = texels == LevelPainter(fineness).draw(*decals).texels, is_new = texels != last;
        CHECK(is_right);
        CHECK(is_new);
        last = texels;
    };
    const auto restyle = [&](const LayerLook& look) {
        decals = as_decals(decals->restyled(Span<const LayerLook>(&look, 1), MemoryAccount()));
    };
    LayerLook look;
    for (size_t i = 0; i < 60; ++i)
        for (const size_t channel : {4 * i, size_t{255}, 7 * i % 256, i % 3 * 120})
            look.fill.colors.push_back(static_cast<uint8_t>(channel));
    restyle(look);
    check();
    look = {};
    for (int64_t feature = 0; feature < 60; ++feature)
        look.draw_order.push_back((7 * feature + 3) % 60);
    restyle(look);
    check();
    look = {};
    look.layer = 1;
    look.stroke.widths = {25.0};
    restyle(look);
    check();
    decals = as_decals(decals->edited(edit_of(0, {chance.part(5, 300.0)}, {}, {3, 4}), MemoryAccount()));
    check();
}

TEST_CASE("what levels keep is counted, or given up where there is no room", "[static]") {
    Chance chance;
    const auto decals = build(random_map(chance).layers());
    MemoryAccount memory;
    LevelPainter painter(LEVEL_TEXELS, memory);
    const auto texels = painter.draw(*decals).texels;
    const uint64_t kept = memory.bytes("static: levels");
    CHECK(kept > 0);
    painter = LevelPainter(LEVEL_TEXELS, memory);
    CHECK(memory.total() == 0);
    memory.set_budget(kept - 1);
    for (int i = 0; i < 2; ++i) {
        const bool is_same = painter.draw(*decals).texels == texels;
        CHECK(is_same);
        CHECK(memory.total() == 0);
    }
}

TEST_CASE("looks that hide, widen and come back", "[static]") {
    Chance chance;
    Map map = random_map(chance);
    map.widest = 30.0;
    const auto before = build(map.layers());
    LayerLook look;
    look.layer = 1;
    look.stroke.widths = {30.0};
    const auto wide = before->restyled(Span<const LayerLook>(&look, 1), MemoryAccount());
    std::vector<Layer> layers = map.layers();
    layers[1].stroke.widths = {30.0};
    CHECK(picks(*wide, rows_of(map)) == picks(*build(layers), rows_of(map)));
    look.stroke.widths = {30.5};
    CHECK(test::kind_of([&] { before->restyled(Span<const LayerLook>(&look, 1), MemoryAccount()); }) ==
          ErrorKind::style);
    look.stroke.widths = {0.0};
    const auto hidden = before->restyled(Span<const LayerLook>(&look, 1), MemoryAccount());
    CHECK(as_decals(hidden)->words.data() == before->words.data());
    for (const auto& found : picks(*hidden, rows_of(map)))
        for (const auto& one : found)
            REQUIRE(one.first == 0);
    look.stroke.widths = {6.0};
    look.stroke.colors = {1, 2, 3, 255};
    const auto back = as_decals(hidden->restyled(Span<const LayerLook>(&look, 1), MemoryAccount()));
    CHECK(picks(*back, rows_of(map)) == picks(*before, rows_of(map)));
    CHECK_FALSE(back->has_hidden);
    CHECK(back->look_of(1, 60).stroke.colors[4] == 1);
}
