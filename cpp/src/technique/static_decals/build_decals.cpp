// From layers to a cell stream, on all cores and with the same bytes on any number of them:
//
//   slots     features in draw order, topmost first, cut into runs of about as many vertices
//   records   each run on its own: pieces with their cell and slot, sorted into buckets of
//             cells while they are in the cache
//   stream    each bucket on its own: its records of all runs, in order, in two passes that
//             count and then write
//
// A scatter straight into cells would miss the cache on every record.
#include <algorithm>
#include <cmath>
#include <limits>

#include "decalgl/core/error.h"
#include "decalgl/core/large_array.h"
#include "decalgl/core/parallel.h"
#include "technique/static_decals/cell_stream_writer.h"
#include "technique/static_decals/line_cells.h"
#include "technique/static_decals/prepared_decals.h"
#include "technique/static_decals/resolution.h"
#include "technique/static_decals/ring_cells.h"

namespace decalgl {
namespace {

// Few enough runs that a bucket gathers from few places, small enough that sorting one stays near the cache.
constexpr size_t wanted_runs = 48;
constexpr size_t smallest_run = 1 << 13;
constexpr size_t largest_run = 1 << 18;

struct Run {
    size_t first_slot;
    size_t last_slot;
    size_t vertices;
};

const Layer& layer_of(const TechniqueInput& input, FeatureReference slot) {
    return input.layers[slot.layer - input.first_layer];
}

// A ring of n vertices has n edges, a line of n vertices n - 1 segments.
uint64_t segments_of(const Features& features, size_t feature) {
    const uint64_t vertices = features.vertices(feature).size() / 2;
    const auto parts =
        static_cast<uint64_t>(features.feature_offsets[feature + 1] - features.feature_offsets[feature]);
    return features.kind == FeatureKind::polygons ? vertices : vertices - std::min(parts, vertices);
}

void collect_slots(const TechniqueInput& input, PreparedDecals& decals) {
    std::vector<FeatureReference> slots;
    std::vector<DecalStyle> styles;
    for (size_t l = input.layers.size(); l-- > 0;) {
        const Layer& layer = input.layers[l];
        const bool lines = layer.features.kind == FeatureKind::lines;
        for (size_t rank = layer.features.feature_count(); rank-- > 0;) {
            const size_t feature = layer.feature_at(rank);
            const uint8_t* color = layer.color(feature);
            if (color[3] == 0)
                continue;
            DecalStyle style{{color[0], color[1], color[2], color[3]}, 0.0F};
            if (lines) {
                style.half_width = static_cast<float>(0.5 * layer.width(feature) / decals.grid.quantum);
                decals.largest_scale =
                    std::max(decals.largest_scale, line_scale(static_cast<double>(style.half_width)));
                decals.widest = std::max(decals.widest, style.half_width);
                decals.narrowest =
                    decals.has_lines ? std::min(decals.narrowest, style.half_width) : style.half_width;
            }
            slots.push_back({input.first_layer + static_cast<uint32_t>(l), static_cast<uint32_t>(feature)});
            styles.push_back(style);
            decals.segments += segments_of(layer.features, feature);
            decals.has_translucency |= color[3] != 255;
            (lines ? decals.has_lines : decals.has_polygons) = true;
        }
    }
    decals.slots = std::move(slots);
    decals.styles = std::move(styles);
}

std::vector<Run> cut_into_runs(const TechniqueInput& input, const PreparedDecals& decals) {
    size_t vertices = 0;
    for (const Layer& layer : input.layers)
        vertices += layer.features.vertex_count();
    const size_t vertices_per_run = std::clamp(vertices / wanted_runs, smallest_run, largest_run);
    std::vector<Run> runs;
    Run run{0, 0, 0};
    for (size_t slot = 0; slot < decals.slots.size(); ++slot) {
        run.vertices +=
            layer_of(input, decals.slots[slot]).features.vertices(decals.slots[slot].feature).size() / 2;
        run.last_slot = slot + 1;
        if (run.vertices >= vertices_per_run || run.last_slot == decals.slots.size()) {
            runs.push_back(run);
            run = {slot + 1, slot + 1, 0};
        }
    }
    return runs;
}

template <typename OnPart>
void for_each_part(const Features& features, size_t feature, OnPart on_part) {
    const auto first = static_cast<size_t>(features.feature_offsets[feature]);
    const auto last = static_cast<size_t>(features.feature_offsets[feature + 1]);
    for (size_t part = first; part < last; ++part)
        on_part(features.part(part));
}

CellRecords make_records(const TechniqueInput& input, const PreparedDecals& decals, const Run& run) {
    CellRecords records(decals.grid);
    records.reserve(2 * run.vertices);
    RingCells rings(records);
    for (size_t slot = run.first_slot; slot < run.last_slot; ++slot) {
        const Features& features = layer_of(input, decals.slots[slot]).features;
        const size_t feature = decals.slots[slot].feature;
        records.set_slot(static_cast<uint32_t>(slot));
        if (features.kind == FeatureKind::polygons) {
            for_each_part(features, feature, [&](Span<const double> ring) { rings.add_ring(ring); });
            rings.finish_feature();
        } else {
            const auto half_width = static_cast<double>(decals.styles[slot].half_width);
            for_each_part(features, feature,
                          [&](Span<const double> line) { mark_covered_cells(line, half_width, records); });
            for_each_part(features, feature,
                          [&](Span<const double> line) { add_line_pieces(line, half_width, records); });
        }
    }
    records.sort_into_buckets();
    return records;
}

std::vector<CellRecords> make_all_records(const TechniqueInput& input, const PreparedDecals& decals,
                                          const std::vector<Run>& runs, std::vector<MemoryCharge>& charges,
                                          Progress& progress) {
    std::vector<CellRecords> all(runs.size(), CellRecords(decals.grid));
    charges.resize(runs.size());
    parallel_for(
        runs.size(), 1, input.threads,
        [&](size_t begin, size_t end) {
            for (size_t run = begin; run < end; ++run) {
                charges[run] = MemoryCharge(input.memory, "static: working memory",
                                            2 * runs[run].vertices * sizeof(CellRecord));
                all[run] = make_records(input, decals, runs[run]);
                charges[run].resize(all[run].size() * sizeof(CellRecord));
            }
        },
        [&](double share) { progress.report(0.7 * share); });
    return all;
}

void write_stream(const TechniqueInput& input, const std::vector<CellRecords>& runs, PreparedDecals& decals,
                  Progress& progress) {
    const uint32_t bucket_count = decals.grid.bucket_count();
    const uint64_t fixed_bytes = (uint64_t{bucket_count} * BUCKET_CELLS + 1) * sizeof(uint32_t) +
                                 decals.slots.size() * (sizeof(DecalStyle) + sizeof(FeatureReference));
    decals.charge.resize(fixed_bytes);
    LargeArray<uint32_t> cell_starts;
    cell_starts.resize(size_t{bucket_count} * BUCKET_CELLS + 1);
    std::vector<uint64_t> sizes(bucket_count);
    parallel_for(bucket_count, 16, input.threads, [&](size_t begin, size_t end) {
        for (size_t bucket = begin; bucket < end; ++bucket)
            sizes[bucket] = count_bucket_texels(runs, static_cast<uint32_t>(bucket), decals.styles,
                                                &cell_starts[bucket * BUCKET_CELLS]);
    });
    uint64_t total = 0;
    for (uint64_t& size : sizes) {
        const uint64_t start = total;
        total += size;
        size = start;
    }
    if (total > std::numeric_limits<uint32_t>::max())
        throw Error(ErrorKind::memory,
                    "the static index would need " + format_bytes(total * sizeof(CellTexel)) +
                        ", more than one index can address; draw a smaller part of the map at once");
    decals.charge.resize(total * sizeof(CellTexel) + fixed_bytes);
    decals.longest_cell = *std::max_element(cell_starts.begin(), cell_starts.end() - 1);
    LargeArray<CellTexel> texels;
    texels.resize(total);
    progress.report(0.8);
    parallel_for(bucket_count, 16, input.threads, [&](size_t begin, size_t end) {
        for (size_t bucket = begin; bucket < end; ++bucket)
            write_bucket_texels(runs, static_cast<uint32_t>(bucket), decals.styles,
                                static_cast<uint32_t>(sizes[bucket]), &cell_starts[bucket * BUCKET_CELLS],
                                texels.data());
    });
    cell_starts.back() = static_cast<uint32_t>(total);
    decals.cell_starts = std::move(cell_starts);
    decals.texels = std::move(texels);
}

}  // namespace

std::unique_ptr<PreparedDecals> build_decals(const TechniqueInput& input, Progress& progress) {
    auto decals = std::make_unique<PreparedDecals>();
    decals->charge = MemoryCharge(input.memory, "static: prepared", 0);
    decals->grid = CellGrid::over(input.bounds, input.positions, choose_resolution(input));
    collect_slots(input, *decals);
    const std::vector<Run> runs = cut_into_runs(input, *decals);
    std::vector<MemoryCharge> working_memory;
    const std::vector<CellRecords> records = make_all_records(input, *decals, runs, working_memory, progress);
    size_t record_count = 0;
    for (const CellRecords& run : records)
        record_count += run.size();
    write_stream(input, records, *decals, progress);
    decals->pieces = record_count;
    progress.report(1.0);
    return decals;
}

PreparedCounts PreparedDecals::counts() const {
    const size_t bytes =
        cell_starts.size_bytes() + texels.size_bytes() + styles.size_bytes() + slots.size_bytes();
    return {slots.size(), segments, pieces, bytes, std::ldexp(grid.quantum, largest_scale)};
}

}  // namespace decalgl
