#include "frame/prepared_file.h"

#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/archive.h"
#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

// Without padding, since their bytes go into the file.
struct SceneRecord {
    double x0, y0, dx, dy;
    double relief_lowest, relief_highest, azimuth, altitude, strength, on_layers;
    int32_t rows, columns;
    int32_t tile_rows, tile_columns;
    std::array<uint8_t, 3> color;
    uint8_t has_holes;
    uint32_t passes;
};
static_assert(sizeof(SceneRecord) == 104, "saved as it is");

struct PassRecord {
    uint32_t first_layer;
    uint32_t layer_count;
    MapReach reach;
};
static_assert(sizeof(PassRecord) == 56, "saved as it is");

struct LayerRecord {
    uint32_t kind;
    uint32_t name_bytes;
};
static_assert(sizeof(LayerRecord) == 8, "saved as it is");

constexpr size_t block_items = 1 << 18;

SceneRecord record_of(const PreparedScene& scene) {
    const Heightfield& terrain = scene.terrain;
    const Relief& relief = scene.relief;
    return {terrain.x0(),
            terrain.y0(),
            terrain.dx(),
            terrain.dy(),
            relief.lowest,
            relief.highest,
            relief.azimuth,
            relief.altitude,
            relief.strength,
            relief.on_layers,
            terrain.rows(),
            terrain.columns(),
            scene.tiles.rows,
            scene.tiles.columns,
            relief.color,
            scene.tiles.has_holes,
            static_cast<uint32_t>(scene.passes.size())};
}

std::string pass_prefix(size_t pass) {
    return "passes/" + std::to_string(pass) + "/";
}

std::string rows_of(size_t layer) {
    return "layers/" + std::to_string(layer) + "/rows";
}

void save_layers(const std::vector<PreparedLayer>& layers, ArchiveWriter& archive) {
    std::vector<LayerRecord> records;
    std::string names;
    for (size_t i = 0; i < layers.size(); ++i) {
        records.push_back(
            {static_cast<uint32_t>(layers[i].kind), static_cast<uint32_t>(layers[i].name.size())});
        names += layers[i].name;
        archive.add(rows_of(i), layers[i].rows.span());
    }
    archive.add_copy("layers", Span<const LayerRecord>(records));
    archive.add_text("names", names);
}

std::vector<PreparedLayer> read_layers(const ArchiveReader& archive) {
    const std::string names = archive.text("names");
    std::vector<PreparedLayer> layers;
    size_t letter = 0;
    for (const LayerRecord& record : archive.array<LayerRecord>("layers")) {
        if (record.kind > static_cast<uint32_t>(FeatureKind::lines) ||
            record.name_bytes > names.size() - letter)
            archive.refuse("its layers make no sense");
        layers.push_back({names.substr(letter, record.name_bytes), static_cast<FeatureKind>(record.kind),
                          archive.array<int64_t>(rows_of(layers.size()))});
        letter += record.name_bytes;
    }
    return layers;
}

Relief read_relief(const ArchiveReader& archive, const SceneRecord& record) {
    const SharedArray<uint8_t> ramp = archive.array<uint8_t>("relief ramp");
    Relief relief;
    relief.color = record.color;
    relief.ramp.assign(ramp.begin(), ramp.end());
    relief.lowest = record.relief_lowest;
    relief.highest = record.relief_highest;
    relief.azimuth = record.azimuth;
    relief.altitude = record.altitude;
    relief.strength = record.strength;
    relief.on_layers = record.on_layers;
    validate(relief);
    return relief;
}

// Levels of detail are chosen by comparing errors, and boxes by their heights.
bool is_measured(const TerrainTile& tile) {
    const bool is_empty = tile.lowest > tile.highest;
    const bool has_box = std::isfinite(tile.lowest) && std::isfinite(tile.highest);
    bool rises = tile.error[0] == 0.0F;
    for (size_t level = 1; level < tile.error.size(); ++level)
        rises &= tile.error[level] >= tile.error[level - 1];
    return (is_empty || has_box) && rises;
}

TerrainTiles read_tiles(const ArchiveReader& archive, const SceneRecord& record) {
    const SharedArray<TerrainTile> saved = archive.array<TerrainTile>("tiles");
    TerrainTiles tiles;
    tiles.columns = record.tile_columns;
    tiles.rows = record.tile_rows;
    tiles.has_holes = record.has_holes != 0;
    const auto tiles_over = [](int64_t samples) { return (samples - 1 + tile_quads - 1) / tile_quads; };
    bool fits = tiles.columns == tiles_over(record.columns) && tiles.rows == tiles_over(record.rows) &&
                saved.size() == static_cast<size_t>(tiles.columns) * static_cast<size_t>(tiles.rows);
    for (size_t i = 0; fits && i < saved.size(); ++i) {
        const auto columns = static_cast<size_t>(tiles.columns);
        fits = saved[i].column == static_cast<int32_t>(i % columns) * tile_quads &&
               saved[i].row == static_cast<int32_t>(i / columns) * tile_quads && is_measured(saved[i]);
    }
    if (!fits)
        archive.refuse("its tiles do not fit its terrain");
    tiles.tiles = saved;
    return tiles;
}

void read_terrain(const ArchiveReader& archive, PreparedScene& scene) {
    const auto record = archive.value<SceneRecord>("scene");
    scene.terrain = Heightfield(archive.array<float>("heights"), record.rows, record.columns, record.x0,
                                record.y0, record.dx, record.dy);
    validate(scene.terrain);
    scene.positions = PositionGrid::around(scene.terrain.bounds());
    scene.relief = read_relief(archive, record);
    scene.tiles = read_tiles(archive, record);
    scene.illumination = archive.array<uint8_t>("illumination");
    if (scene.illumination.size() != scene.terrain.heights().size())
        archive.refuse("its illumination does not fit its terrain");
}

// Ids lead to features, and features to layers and rows.
void require_features(const ArchiveReader& archive, const PreparedScene& scene, const Prepared& prepared) {
    std::atomic<bool> all{true};
    parallel_for(prepared.counts().features, block_items, 0, [&](size_t begin, size_t end) {
        for (size_t id = begin; id < end; ++id) {
            const FeatureReference reference = prepared.feature(static_cast<uint32_t>(id));
            if (reference.layer >= scene.layers.size() ||
                reference.feature >= scene.layers[reference.layer].rows.size()) {
                all.store(false);
                return;
            }
        }
    });
    if (!all.load())
        archive.refuse("its index names features that no layer has");
}

void read_passes(const ArchiveReader& archive, const MemoryAccount& memory, PreparedScene& scene) {
    const uint32_t count = archive.value<SceneRecord>("scene").passes;
    for (uint32_t i = 0; i < count; ++i) {
        PreparedPass pass;
        pass.technique = archive.text(pass_prefix(i) + "technique");
        const auto record = archive.value<PassRecord>(pass_prefix(i) + "layers");
        pass.first_layer = record.first_layer;
        pass.layer_count = record.layer_count;
        pass.reach = record.reach;
        pass.prepared = make_technique(pass.technique)->open(archive, pass_prefix(i), memory);
        require_features(archive, scene, *pass.prepared);
        scene.passes.push_back(std::move(pass));
    }
}

std::shared_ptr<PreparedScene> read_scene(const ArchiveReader& archive, unsigned threads,
                                          const MemoryAccount& memory) {
    const Stopwatch watch;
    archive.verify(threads);
    auto scene = std::make_shared<PreparedScene>();
    try {
        read_terrain(archive, *scene);
        scene->layers = read_layers(archive);
        read_passes(archive, memory, *scene);
    } catch (const Error& error) {
        // What is wrong with the input of a scene is wrong with a file that says it held one.
        if (error.kind() == ErrorKind::input)
            archive.refuse(error.what());
        throw;
    }
    scene->fingerprint = SceneFingerprint(archive.value<Digest>("fingerprint"));
    scene->milliseconds = watch.milliseconds();
    scene->timings.add("open", scene->milliseconds);
    return scene;
}

// Null where the file holds another scene, or none that can be opened.
std::shared_ptr<PreparedScene> open_if_made_from(const Digest& fingerprint, const std::string& path,
                                                 unsigned threads, const MemoryAccount& memory) {
    std::error_code nothing_there;
    if (!std::filesystem::exists(path, nothing_there))
        return nullptr;
    if (!ArchiveReader::is_archive(path))
        throw Error(ErrorKind::file, "'" + path +
                                         "' is not a prepared scene, so it is not replaced by one; "
                                         "name another file as the cache");
    try {
        const ArchiveReader archive(path);
        if (archive.value<Digest>("fingerprint") != fingerprint)
            return nullptr;
        return read_scene(archive, threads, memory);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::file)
            throw;
        return nullptr;
    }
}

}  // namespace

void save_scene(const PreparedScene& scene, const std::string& path, unsigned threads, Progress progress) {
    ArchiveWriter archive;
    archive.add_value("fingerprint", scene.fingerprint.digest(threads));
    archive.add_value("scene", record_of(scene));
    archive.add("relief ramp", Span<const uint8_t>(scene.relief.ramp));
    save_layers(scene.layers, archive);
    archive.add("tiles", scene.tiles.tiles.span());
    archive.add("heights", scene.terrain.heights().span());
    archive.add("illumination", scene.illumination.span());
    for (size_t i = 0; i < scene.passes.size(); ++i) {
        const PreparedPass& pass = scene.passes[i];
        archive.add_text(pass_prefix(i) + "technique", pass.technique);
        archive.add_value(pass_prefix(i) + "layers",
                          PassRecord{pass.first_layer, pass.layer_count, pass.reach});
        pass.prepared->save(archive, pass_prefix(i));
    }
    archive.write(path, threads, progress);
}

std::shared_ptr<PreparedScene> open_scene(const std::string& path, unsigned threads,
                                          const MemoryAccount& memory) {
    return read_scene(ArchiveReader(path), threads, memory);
}

std::shared_ptr<PreparedScene> prepare_cached(const Scene& scene, const std::string& cache,
                                              const RendererOptions& options, const MemoryAccount& memory,
                                              const ProgressFn& progress) {
    const Stopwatch watch;
    const unsigned threads = options.threads;
    const Digest fingerprint =
        SceneFingerprint(drawn_terrain(scene), scene.relief, scene.layers, threads).digest(threads);
    const double fingerprint_ms = watch.milliseconds();
    std::shared_ptr<PreparedScene> prepared = open_if_made_from(fingerprint, cache, threads, memory);
    if (!prepared) {
        ArchiveWriter::require_writable(cache);
        prepared = prepare_scene(scene, options, memory, progress);
        prepared->fingerprint = SceneFingerprint(fingerprint);
        const Stopwatch saving;
        save_scene(*prepared, cache, threads, Progress(progress, "saving"));
        prepared->timings.add("save", saving.milliseconds());
    } else {
        take_sources(scene, options, memory, *prepared);
    }
    prepared->timings.add("fingerprint", fingerprint_ms);
    prepared->milliseconds = watch.milliseconds();
    return prepared;
}

SavedScene describe_saved_scene(const std::string& path) {
    const ArchiveReader archive(path);
    const auto record = archive.value<SceneRecord>("scene");
    SavedScene saved;
    saved.format = archive_format;
    saved.bytes = archive.file_bytes();
    saved.rows = record.rows;
    saved.columns = record.columns;
    saved.bounds = {record.x0, record.y0 - (record.rows - 1.0) * record.dy,
                    record.x0 + (record.columns - 1.0) * record.dx, record.y0};
    saved.layers = read_layers(archive);
    for (const ArchiveSection& section : archive.sections())
        saved.sections.emplace_back(section.name.data(), section.bytes);
    return saved;
}

bool is_saved_scene(const std::string& path) {
    return ArchiveReader::is_archive(path);
}

}  // namespace decalgl
