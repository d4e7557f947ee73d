// Prepared scenes on disk, without GL: what is opened answers as what was saved, and forged files cannot make
// it read anything but its own arrays.
#include <catch2/catch.hpp>
#include <cmath>

#include "decalgl/core/error.h"
#include "decalgl/technique/loops_options.h"
#include "error_kind.h"
#include "forged_archive.h"
#include "frame/prepared_file.h"
#include "frame/view_setup.h"
#include "technique/loops/view_cells.h"
#include "technique/loops/view_detail.h"

using namespace decalgl;
using namespace decalgl::test;

namespace {

RendererOptions on_threads(unsigned threads) {
    RendererOptions options;
    options.threads = threads;
    return options;
}

constexpr int32_t side = 70;  // samples: tiles of two sizes

Scene sample_scene() {
    std::vector<float> heights;
    for (int32_t i = 0; i < side * side; ++i)
        heights.push_back(static_cast<float>(10.0 * std::sin(i % side * 0.1) + i / side % 7));
    heights[2 * side + 3] = std::nanf("");
    Scene scene;
    scene.terrain = Heightfield(heights, side, side, 1000.0, 3000.0, 2.0, 2.0);
    scene.exaggeration = 1.5;
    scene.relief.ramp = {0, 0, 0, 255, 255, 255};
    Layer areas;
    areas.name = "areas";
    areas.features = Features::own(FeatureKind::polygons,
                                   {1010, 2900, 1120, 2900, 1060, 2980, 1000, 2870, 1130, 2870, 1130, 2990},
                                   {0, 3, 6}, {0, 1, 2}, {5, 9});
    areas.fill.colors = {200, 30, 30, 255, 10, 20, 30, 100};
    Layer ways;
    ways.name = "ways";
    ways.features = Features::own(FeatureKind::lines, {1000, 2862, 1138, 3000, 1100, 2870}, {0, 3}, {0, 1});
    ways.stroke.colors = {0, 0, 0, 255};
    ways.stroke.widths = {6.0};
    scene.layers = {areas, ways};
    return scene;
}

std::string save_sample(const ScratchFolder& folder) {
    const std::string path = folder.file("map.decal");
    save_scene(*prepare_scene(sample_scene(), on_threads(1), MemoryAccount(), {}), path, 1, {});
    return path;
}

// All features found on a grid of positions, as layers and rows.
std::vector<std::pair<uint32_t, int64_t>> picks(const PreparedScene& scene) {
    std::vector<std::pair<uint32_t, int64_t>> found;
    for (double x = 995.0; x < 1145.0; x += 3.7)
        for (double y = 2855.0; y < 3005.0; y += 3.7)
            for (const PreparedPass& pass : scene.passes)
                for (const FeatureReference& reference : pass.prepared->query({x, y}))
                    found.emplace_back(reference.layer, scene.row_of(reference));
    return found;
}

// What the pipeline does on the CPU with a scene.
void use(const PreparedScene& scene) {
    picks(scene);
    for (const Camera& camera : {Camera::top_down(scene.terrain.bounds(), 1000.0, 1.0),
                                 Camera::orbit({1070.0, 2930.0, 0.0}, 150.0, 200.0, 30.0)}) {
        const auto tiles = select_tiles(scene.tiles, scene.terrain, camera, 64, 64, 0.5);
        make_view_block(camera, 64, 64, scene.terrain, scene.positions,
                        nearest_depth(tiles, scene.terrain, camera));
    }
}

}  // namespace

TEST_CASE("a scene that is opened answers as the one that was saved") {
    const ScratchFolder folder;
    const std::string path = save_sample(folder);
    const auto saved = prepare_scene(sample_scene(), on_threads(1), MemoryAccount(), {});
    const MemoryAccount memory;
    const auto opened = open_scene(path, 1, memory);
    CHECK(memory.total() == 0);
    REQUIRE(opened->layers.size() == 2);
    CHECK(opened->layers[0].name == "areas");
    CHECK(opened->layers[1].kind == FeatureKind::lines);
    CHECK(opened->layers[0].rows == SharedArray<int64_t>{5, 9});
    CHECK(opened->terrain.highest() == saved->terrain.highest());
    CHECK(opened->tiles.has_holes);
    CHECK(opened->illumination == saved->illumination);
    CHECK(opened->relief.ramp == saved->relief.ramp);
    CHECK(opened->fingerprint.digest(1) == saved->fingerprint.digest(2));
    CHECK(picks(*opened) == picks(*saved));
    CHECK_FALSE(picks(*opened).empty());

    // What was opened saves to the same bytes, into the file that it is mapped from.
    const Bytes before = read_file(path);
    save_scene(*opened, path, 1, {});
    CHECK(read_file(path) == before);
    CHECK(picks(*opened) == picks(*saved));
}

TEST_CASE("scenes without layers or without ground are saved too") {
    const ScratchFolder folder;
    Scene scene;
    for (const Heightfield& terrain :
         {Heightfield({1.0F}, 1, 1, 0, 0, 1, 1), Heightfield({std::nanf(""), 1.0F}, 1, 2, 0, 0, 1, 1),
          Heightfield::flat({0.0, 0.0, 10.0, 10.0}, 2.0F)}) {
        scene.terrain = terrain;
        save_scene(*prepare_scene(scene, on_threads(1), MemoryAccount(), {}), folder.file("bare"), 1, {});
        const auto opened = open_scene(folder.file("bare"), 1, MemoryAccount());
        CHECK(opened->passes.empty());
        CHECK(opened->terrain.heights().size() == terrain.heights().size());
    }
}

TEST_CASE("a cache is opened for the scene that it was made from alone") {
    const ScratchFolder folder;
    const std::string path = folder.file("map.decal");
    const auto opens = [&](const Scene& scene) {
        const auto prepared = prepare_cached(scene, path, on_threads(1), MemoryAccount(), {});
        REQUIRE_FALSE(picks(*prepared).empty());
        return prepared->timings.passes().front().name == "open";
    };
    const Scene scene = sample_scene();
    CHECK_FALSE(opens(scene));
    CHECK(opens(scene));
    const std::vector<std::function<void(Scene&)>> changes{
        [](Scene& s) { s.exaggeration = 1.25; },
        [](Scene& s) { s.relief.azimuth = 200.0; },
        [](Scene& s) { s.relief.ramp[1] = 1; },
        [](Scene& s) { s.relief.color[2] = 1; },
        [](Scene& s) { s.layers[0].name = "fields"; },
        [](Scene& s) { s.layers[0].fill.colors[6] = 31; },
        [](Scene& s) { s.layers[1].stroke.widths[0] = 6.5; },
        [](Scene& s) {
            s.layers[0].draw_order = {1, 0};
        },
        [](Scene& s) { s.layers.pop_back(); },
        [](Scene& s) { std::swap(s.layers[0], s.layers[1]); },
        [](Scene& s) {
            s.layers[1].features =
                Features::own(FeatureKind::lines, {1000, 2862, 1138, 3000, 1100, 2871}, {0, 3}, {0, 1});
        },
        [](Scene& s) {
            s.layers[1].features =
                Features::own(FeatureKind::lines, {1000, 2862, 1138, 3000, 1100, 2870}, {0, 3}, {0, 1}, {1});
        },
        [](Scene& s) {
            s.layers[1].features =
                Features::own(FeatureKind::lines, {1000, 2862, 1138, 3000, 1100, 2870}, {0, 2, 3}, {0, 2});
        },
        [](Scene& s) {
            std::vector<float> heights(s.terrain.heights().begin(), s.terrain.heights().end());
            heights.back() += 0.01F;
            s.terrain = Heightfield(heights, side, side, 1000.0, 3000.0, 2.0, 2.0);
        },
        [](Scene& s) { s.terrain = Heightfield(s.terrain.heights(), side, side, 1000.0, 3000.0, 2.0, 2.1); },
    };
    for (const auto& change : changes) {
        INFO("change " << &change - changes.data());
        Scene changed = scene;
        change(changed);
        CHECK_FALSE(opens(changed));
        CHECK(opens(changed));
    }
    CHECK_FALSE(opens(scene));
    Bytes damaged = read_file(path);
    damaged[damaged.size() / 2] ^= 1;
    write_file(path, damaged);
    CHECK_FALSE(opens(scene));
    CHECK(opens(scene));
    CHECK(folder.count() == 1);

    write_file(path, {1, 2, 3});
    CHECK(kind_of([&] { opens(scene); }) == ErrorKind::file);
    CHECK(read_file(path) == Bytes{1, 2, 3});
}

TEST_CASE("forged contents end in an error or in a scene that can be used") {
    const ScratchFolder folder;
    const Bytes whole = read_file(save_sample(folder));
    const std::string path = folder.file("forged");
    std::mt19937 random(5);
    int opened = 0, refused = 0;
    for (int trial = 0; trial < 400; ++trial) {
        write_file(path, forge_contents(whole, random));
        std::shared_ptr<const PreparedScene> scene;
        try {
            scene = open_scene(path, 1, MemoryAccount());
        } catch (const Error& error) {
            REQUIRE(error.kind() == ErrorKind::file);
            ++refused;
            continue;
        }
        ++opened;
        try {
            use(*scene);
        } catch (const Error& error) {
            REQUIRE(error.kind() == ErrorKind::input);  // a terrain of any size, too far from the camera
        }
    }
    CHECK(opened > 50);
    CHECK(refused > 50);
}

// What a view makes of LOOPS without GL.
void make_cells(const PreparedScene& scene, const loops::PreparedLoops& prepared) {
    const Camera camera = Camera::orbit({1070.0, 2930.0, 0.0}, 150.0, 200.0, 30.0);
    const ViewBlock block = make_view_block(camera, 64, 64, scene.terrain, scene.positions, 100.0);
    View view;
    view.width = view.height = 64;
    view.positions = scene.positions;
    view.block = &block;
    const loops::LoopsIndex& index = *prepared.index();
    const loops::Sight sight(view, index.lattice, index.heights);
    const loops::ViewDetail detail(prepared.detail(), loops::detail_eye_of(view), sight, index.lattice,
                                   index.heights);
    const auto judge = [&](const loops::Activation& activation, size_t arc, bool is_inside) {
        return detail.judge(activation, double{prepared.slots()->reaches[arc]}, is_inside);
    };
    const auto active = loops::active_arcs(index.arcs, index.steps, index.activations, 1, judge);
    loops::make_cells(index.arcs, active, *prepared.slots(), sight.box(), 1);
}

TEST_CASE("forged LOOPS end in an error or in an index that can be used") {
    const ScratchFolder folder;
    const std::string path = folder.file("forged");
    std::mt19937 random(6);
    for (const bool has_bvh : {false, true}) {
        auto choice = std::make_shared<LoopsChoice>();
        if (has_bvh) {
            choice->options.bvh = LoopsBvh();
            choice->options.bvh->secondary_depths = {2, 2, 2};
            choice->options.bvh->secondary_branching = {4, 4};
            choice->options.bvh->node_capacity = 1;
        }
        Scene scene = sample_scene();
        for (Layer& layer : scene.layers)
            layer.technique = TechniqueChoice{"loops", choice};
        save_scene(*prepare_scene(scene, on_threads(1), MemoryAccount(), {}), path, 1, {});
        const Bytes whole = read_file(path);
        int opened = 0, refused = 0;
        for (int trial = 0; trial < 300; ++trial) {
            write_file(path, forge_contents(whole, random));
            std::shared_ptr<const PreparedScene> forged;
            try {
                forged = open_scene(path, 1, MemoryAccount());
            } catch (const Error& error) {
                REQUIRE(error.kind() == ErrorKind::file);
                ++refused;
                continue;
            }
            ++opened;
            picks(*forged);
            for (const PreparedPass& pass : forged->passes)
                if (const auto* prepared = dynamic_cast<const loops::PreparedLoops*>(pass.prepared.get()))
                    make_cells(*forged, *prepared);
        }
        CHECK(opened > 30);
        CHECK(refused > 30);
    }
}

TEST_CASE("what does not fit together is named") {
    const ScratchFolder folder;
    const Bytes whole = read_file(save_sample(folder));
    const auto refused = [&](const std::string& section, size_t at, uint8_t value) {
        OpenArchive archive(whole);
        for (size_t i = 0; i < archive.table.size(); ++i) {
            if (section == archive.table[i].name.data())
                archive.contents(i)[at] = value;
        }
        archive.sign_sections();
        write_file(folder.file("forged"), archive.bytes());
        try {
            open_scene(folder.file("forged"), 1, MemoryAccount());
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto says = [&](const std::string& section, size_t at, uint8_t value, const std::string& part) {
        return refused(section, at, value).find(part) != std::string::npos;
    };
    CHECK(says("scene", 80, 71, "do not make"));  // rows of samples
    CHECK(says("scene", 88, 9, "tiles"));         // rows of tiles
    CHECK(says("scene", 100, 9, "missing"));      // passes
    CHECK(says("layers", 4, 200, "layers"));      // length of a name
    CHECK(says("layers", 0, 2, "layers"));        // kind
    CHECK(says("tiles", 3, 127, "tiles"));        // column
    CHECK(says("passes/0/technique", 0, 'S', "technique"));
    CHECK(says("passes/0/slots", 3, 255, "features"));
    CHECK(says("passes/0/cells", 3, 255, "cells"));
}
