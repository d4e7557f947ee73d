// From layers to cell lists, on all cores and with the same bytes on any number of them:
//
//   slots         features in draw order, topmost first, cut into runs of about as many vertices
//   references    each run on its own: which stretches of edges lie in which bucket
//   lists         some buckets at a time: their edges, cut into cells, as one chunk
//   index         all chunks one after the other
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/growing_array.h"
#include "decalgl/core/error.h"
#include "decalgl/core/large_array.h"
#include "decalgl/core/parallel.h"
#include "technique/ground_lengths.h"
#include "technique/layer_sources.h"
#include "technique/static_decals/bucket_builder.h"
#include "technique/static_decals/local_build.h"
#include "technique/static_decals/prepared_decals.h"
#include "technique/static_decals/resolution.h"

namespace decalgl {
namespace {

constexpr const char* account = "static: prepared";
constexpr size_t buckets_per_chunk = 64;
constexpr uint64_t most_texels = uint64_t{1} << (32 - COUNT_BITS);
constexpr uint64_t most_cells = uint64_t{1} << (32 - LEVEL_BITS);

// A ring of n vertices has n edges, a line of n vertices n - 1 segments.
uint64_t segments_of(const Features& features, size_t feature) {
    const uint64_t vertices = features.vertices(feature).size() / 2;
    const auto parts =
        static_cast<uint64_t>(features.feature_offsets[feature + 1] - features.feature_offsets[feature]);
    return features.kind == FeatureKind::polygons ? vertices : vertices - std::min(parts, vertices);
}

void require_addressable(const TechniqueInput& input, size_t slots) {
    for (const Layer& layer : input.layers) {
        if (layer.features.vertex_count() >= closing_edge)
            throw Error(ErrorKind::memory,
                        "static: layer '" + layer.name +
                            "' has more vertices than one layer can; split it into several");
    }
    if (slots > SLOT_MASK)
        throw Error(ErrorKind::memory, "static: more than " + std::to_string(SLOT_MASK) +
                                           " features in one scene; draw a smaller part of the map at once");
}

// By layers alone, so that a part of a scene has what the whole has.
bool cuts_outlines(const TechniqueInput& input) {
    return std::any_of(input.layers.begin(), input.layers.end(), [](const Layer& layer) {
        return layer.features.kind == FeatureKind::polygons && !layer.stroke.empty() &&
               layer.outline_mode != OutlineMode::normal;
    });
}

DecalStyle style_of(const DecalView& view, const BucketGrid& grid) {
    const uint8_t* color = view.color();
    DecalStyle style{{color[0], color[1], color[2], color[3]},
                     static_cast<float>(view.half_width() / grid.quantum)};
    if (view.decal.is_stroke() && style.half_width <= 0.0F)
        style.color[3] = 0;
    return style;
}

void collect_slots(const TechniqueInput& input, PreparedDecals& decals, std::vector<DecalShape>& shapes) {
    std::vector<Decal> slots = slots_of(input);
    require_addressable(input, slots.size());
    const StyleTable table(input, decals.grid);
    std::vector<DecalStyle> styles;
    std::vector<uint32_t> kinds;
    for (const Decal& slot : slots) {
        const DecalView view = table.view(slot);
        shapes.push_back(table.shape_of(slot));
        styles.push_back(shapes.back().is_clip ? DecalStyle{} : style_of(view, decals.grid));
        kinds.push_back(table.kind_of(slot, shapes.back()));
        (slot.is_stroke() ? decals.has_lines : decals.has_polygons) = true;
        decals.largest_scale = std::max(decals.largest_scale, int{shapes.back().scale});
        if (!shapes.back().is_clip)
            decals.segments += segments_of(view.layer->features, view.feature());
    }
    decals.style_flags = table.flags();
    decals.has_clips = cuts_outlines(input);
    if (decals.style_flags != 0 || decals.has_clips) {
        decals.kinds = std::move(kinds);
        decals.style_records = table.texels();
    }
    decals.slots = std::move(slots);
    decals.styles = std::move(styles);
    decals.rules = rules_of(input);
    decals.summarise_styles();
}

bool has_pattern(const Stroke& stroke) {
    return std::any_of(stroke.styles.begin(), stroke.styles.end(),
                       [](const StrokeStyle& style) { return style.pattern.period > 0.0; });
}

std::vector<double> measure_parts(const Features& features, Span<const float> slants, unsigned threads) {
    std::vector<double> lengths(features.vertex_count(), 0.0);
    const double* xy = features.coordinates.data();
    parallel_for(features.part_count(), 256, threads, [&](size_t begin, size_t end) {
        for (size_t part = begin; part < end; ++part)
            for (auto i = static_cast<size_t>(features.part_offsets[part]) + 1;
                 i < static_cast<size_t>(features.part_offsets[part + 1]); ++i) {
                const double slant = slants.empty() ? 1.0 : std::abs(double{slants[i]});
                lengths[i] = lengths[i - 1] +
                             slant * std::hypot(xy[2 * i] - xy[2 * i - 2], xy[2 * i + 1] - xy[2 * i - 1]);
            }
    });
    return lengths;
}

// Of the layers that have patterns along lines.
std::vector<PartLengths> measure_lengths(const TechniqueInput& input) {
    std::vector<PartLengths> lengths(input.layers.size());
    for (size_t l = 0; l < input.layers.size(); ++l) {
        const Layer& layer = input.layers[l];
        if (!has_pattern(layer.stroke) && !has_pattern(layer.casing))
            continue;
        const Features& features = layer.features;
        lengths[l].on_map = measure_parts(features, {}, input.threads);
        if (follows_ground(layer.stroke) || follows_ground(layer.casing))
            lengths[l].over_ground = measure_parts(features, features.slants, input.threads);
    }
    return lengths;
}

std::vector<BucketReferences> make_all_references(const OrderedFeatures& features,
                                                  std::vector<MemoryCharge>& charges, Progress& progress) {
    const std::vector<Run> runs = cut_into_runs(features);
    std::vector<BucketReferences> references(runs.size(), BucketReferences(*features.grid));
    std::vector<CornerCrossings> crossings(runs.size());  // of the parts of large features
    const unsigned threads = features.input->threads;
    parallel_for(
        runs.size(), 1, threads,
        [&](size_t begin, size_t end) {
            for (size_t run = begin; run < end; ++run)
                references[run] = make_references(features, runs[run], crossings[run]);
        },
        [&](double share) { progress.report(0.3 * share); });
    for (size_t i = 0; i < runs.size(); ++i) {
        if (!runs[i].part_of_feature)
            continue;
        const bool last_part = i + 1 == runs.size() || runs[i + 1].first_slot != runs[i].first_slot;
        if (last_part)
            crossings[i].resolve(*features.grid, static_cast<uint32_t>(runs[i].first_slot), references[i]);
        else
            crossings[i + 1].append(crossings[i]);
    }
    charges.resize(runs.size());
    parallel_for(runs.size(), 1, threads, [&](size_t begin, size_t end) {
        for (size_t run = begin; run < end; ++run) {
            references[run].sort_into_buckets();
            charges[run] =
                MemoryCharge(features.input->memory, "static: working memory", references[run].bytes());
        }
    });
    return references;
}

[[noreturn]] void refuse_size(uint64_t bytes) {
    throw Error(ErrorKind::memory,
                "the static index would need " + format_bytes(bytes) +
                    ", more than one index can address; draw a smaller part of the map at once");
}

std::vector<CellChunk> make_chunks(const OrderedFeatures& features, const std::vector<BucketReferences>& runs,
                                   std::vector<MemoryCharge>& charges, Progress& progress) {
    const size_t buckets = features.grid->bucket_count();
    std::vector<CellChunk> chunks(block_count(buckets, buckets_per_chunk));
    charges.resize(chunks.size());
    parallel_for(
        buckets, buckets_per_chunk, features.input->threads,
        [&](size_t begin, size_t end) {
            const size_t index = begin / buckets_per_chunk;
            CellChunk& chunk = chunks[index];
            BucketBuilder builder(features);
            for (size_t bucket = begin; bucket < end; ++bucket) {
                builder.build(static_cast<uint32_t>(bucket), runs, chunk);
                if (chunk.words.size() / 4 > most_texels)
                    refuse_size(chunk.words.size() * sizeof(uint32_t));
            }
            charges[index] = MemoryCharge(features.input->memory, "static: working memory",
                                          (chunk.cells.size() + chunk.words.size()) * sizeof(uint32_t));
        },
        [&](double share) { progress.report(0.3 + 0.6 * share); });
    return chunks;
}

struct ChunkPlace {
    uint64_t first_cell;
    uint64_t first_texel;
};

// The arrays of the index while they are filled.
struct IndexArrays {
    LargeArray<uint32_t> bucket_entries;
    LargeArray<uint32_t> cells;
    LargeArray<uint32_t> words;
};

// Copies a chunk to its place, where entries count from the index's beginning.
void place_chunk(const CellChunk& chunk, const ChunkPlace& place, size_t first_bucket, IndexArrays& index) {
    const auto cell_base = static_cast<uint32_t>(place.first_cell << LEVEL_BITS);
    const auto texel_base = static_cast<uint32_t>(place.first_texel << COUNT_BITS);
    for (size_t i = 0; i < chunk.bucket_entries.size(); ++i)
        index.bucket_entries[first_bucket + i] = chunk.bucket_entries[i] + cell_base;
    for (size_t i = 0; i < chunk.cells.size(); ++i)
        index.cells[place.first_cell + i] =
            chunk.cells[i] == EMPTY_LIST ? EMPTY_LIST : chunk.cells[i] + texel_base;
    std::copy(chunk.words.begin(), chunk.words.end(),
              index.words.begin() + static_cast<std::ptrdiff_t>(4 * place.first_texel));
}

// Arrays are counted for as long as some index holds them.
void charge_arrays(const MemoryAccount& memory, PreparedDecals& decals) {
    decals.bucket_entries = charged(decals.bucket_entries, memory, account);
    decals.styles = charged(decals.styles, memory, account);
    decals.kinds = charged(decals.kinds, memory, account);
    decals.style_records = charged(decals.style_records, memory, account);
    decals.slots = charged(decals.slots, memory, account);
}

void join_chunks(std::vector<CellChunk>& chunks, std::vector<MemoryCharge>& charges,
                 const TechniqueInput& input, PreparedDecals& decals) {
    std::vector<ChunkPlace> places;
    ChunkPlace end{0, 1};  // after the empty list
    for (const CellChunk& chunk : chunks) {
        places.push_back(end);
        end.first_cell += chunk.cells.size();
        end.first_texel += chunk.words.size() / 4;
        decals.pieces += chunk.edges;
        decals.longest_list = std::max(decals.longest_list, chunk.longest_list);
    }
    const uint64_t bytes = 16 * end.first_texel + 4 * end.first_cell +
                           4 * uint64_t{decals.grid.bucket_count()} + decals.styles.size_bytes() +
                           decals.slots.size_bytes() + decals.kinds.size_bytes() +
                           decals.style_records.size_bytes();
    if (end.first_texel > most_texels || end.first_cell > most_cells)
        refuse_size(bytes);
    MemoryCharge charge(input.memory, account, bytes);
    IndexArrays index;
    index.bucket_entries.resize(decals.grid.bucket_count());
    // Where edits append, so that the first of them copies nothing.
    index.cells.reserve(with_room(end.first_cell));
    index.words.reserve(with_room(4 * end.first_texel));
    index.cells.resize(end.first_cell);
    index.words.resize(4 * end.first_texel);
    std::fill_n(index.words.begin(), 4, LIST_END);
    parallel_for(chunks.size(), 1, input.threads, [&](size_t begin, size_t last) {
        for (size_t i = begin; i < last; ++i) {
            place_chunk(chunks[i], places[i], i * buckets_per_chunk, index);
            chunks[i] = CellChunk();
            charges[i] = MemoryCharge();
        }
    });
    charge = MemoryCharge();
    decals.bucket_entries = std::move(index.bucket_entries);
    decals.cells = GrownArray<uint32_t>(std::move(index.cells), input.memory, account);
    decals.words = GrownArray<uint32_t>(std::move(index.words), input.memory, account);
    charge_arrays(input.memory, decals);
}

}  // namespace

std::unique_ptr<PreparedDecals> build_decals(const TechniqueInput& input, Progress& progress) {
    auto decals = std::make_unique<PreparedDecals>();
    decals->grid = BucketGrid::over(input.bounds, input.positions, choose_resolution(input));
    std::vector<DecalShape> shapes;
    collect_slots(input, *decals, shapes);
    const std::vector<PartLengths> lengths = measure_lengths(input);
    const OrderedFeatures features{&input, &decals->grid, decals->slots, shapes, lengths};
    std::vector<MemoryCharge> reference_charges, chunk_charges;
    std::vector<BucketReferences> references = make_all_references(features, reference_charges, progress);
    std::vector<CellChunk> chunks = make_chunks(features, references, chunk_charges, progress);
    references.clear();
    reference_charges.clear();
    join_chunks(chunks, chunk_charges, input, *decals);
    decals->sources = std::make_shared<const LayerSources>(input);
    progress.report(1.0);
    return decals;
}

std::vector<uint32_t> touched_buckets(const TechniqueInput& input, const BucketGrid& grid) {
    PreparedDecals decals;
    decals.grid = grid;
    std::vector<DecalShape> shapes;
    collect_slots(input, decals, shapes);
    const std::vector<PartLengths> lengths(input.layers.size());
    const OrderedFeatures features{&input, &decals.grid, decals.slots, shapes, lengths};
    std::vector<MemoryCharge> charges;
    Progress progress;
    std::vector<uint32_t> buckets;
    for (BucketReferences& run : make_all_references(features, charges, progress))
        for (const BucketReference& reference : run.references())
            buckets.push_back(reference.bucket);
    std::sort(buckets.begin(), buckets.end());
    buckets.erase(std::unique(buckets.begin(), buckets.end()), buckets.end());
    return buckets;
}

LocalBuild build_buckets(const TechniqueInput& input, const BucketGrid& grid, Span<const uint32_t> buckets) {
    LocalBuild build;
    build.decals.grid = grid;
    std::vector<DecalShape> shapes;
    collect_slots(input, build.decals, shapes);
    const std::vector<PartLengths> lengths = measure_lengths(input);
    const OrderedFeatures features{&input, &build.decals.grid, build.decals.slots, shapes, lengths};
    std::vector<MemoryCharge> charges;
    Progress progress;
    const std::vector<BucketReferences> references = make_all_references(features, charges, progress);
    BucketBuilder builder(features);
    for (const uint32_t bucket : buckets)
        builder.build(bucket, references, build.chunk);
    return build;
}

PreparedCounts PreparedDecals::counts() const {
    const size_t bytes = bucket_entries.size_bytes() + cells.size_bytes() + words.size_bytes() +
                         styles.size_bytes() + slots.size_bytes() + kinds.size_bytes() +
                         style_records.size_bytes() + ranks.size_bytes();
    return {slots.size(), segments, pieces, bytes, std::ldexp(grid.quantum, largest_scale)};
}

}  // namespace decalgl
