// Local edits of a prepared index.
//
//     touched buckets      those of what goes and of what comes
//     their features       named by the lists of these buckets, and those that come
//     new lists            of these buckets alone, by the builder that made all of them; after the others
//     bucket entries       lead to the new lists
//
// Slots are never moved: those of added features follow all others, and ranks say where they stand in draw order. What old lists
// held stays, since other versions of the index may read it, until most of it is unused: then lists are copied together.
#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "decalgl/core/error.h"
#include "technique/draw_order.h"
#include "technique/layer_sources.h"
#include "technique/static_decals/draw_order.h"
#include "technique/static_decals/local_build.h"

namespace decalgl {
namespace {

constexpr uint32_t none = std::numeric_limits<uint32_t>::max();
constexpr size_t roles = 4;  // at least as many as DecalRole has
constexpr uint64_t most_texels = uint64_t{1} << (32 - COUNT_BITS);
constexpr uint64_t most_cells = uint64_t{1} << (32 - LEVEL_BITS);

const char* const account = "static: prepared";

using FeatureLists = std::vector<std::vector<uint32_t>>;  // of each layer

size_t cells_of(uint32_t bucket_entry) {
    return size_t{1} << (2 * (bucket_entry & ((1U << LEVEL_BITS) - 1)));
}

size_t words_of(const PreparedDecals& decals, uint32_t cell_entry) {
    const Span<const uint32_t> list = decals.list(cell_entry);
    if ((cell_entry & COUNT_ESCAPE) != COUNT_ESCAPE)
        return list.size();
    size_t texels = 1;
    while (4 * texels < list.size() && list[4 * texels - 1] != LIST_END)
        ++texels;
    return 4 * texels;
}

// One edit on its way into a new index.
class Edit {
public:
    Edit(const PreparedDecals& before, const LayerEdit& edit, const MemoryAccount& memory)
        : before_(before),
          edit_(edit),
          memory_(memory),
          sources_(before.sources->edited(edit)),
          result_(std::make_shared<PreparedDecals>(before)) {}

    std::shared_ptr<const PreparedDecals> run() {
        find_buckets();
        find_features();
        const std::vector<Layer> layers = sources_->subset(features_);
        const LocalBuild build = build_buckets(input_of(layers), before_.grid, buckets_);
        match_slots(build.decals);
        add_slots(build.decals);
        append_lists(build.chunk);
        result_->sources = sources_;
        result_->pieces += build.chunk.edges;
        result_->longest_list = std::max(result_->longest_list, build.chunk.longest_list);
        result_->summarise_styles();
        if (result_->unused_words > result_->words.size() / 2)
            compact();
        return result_;
    }

private:
    TechniqueInput input_of(Span<const Layer> layers) const {
        TechniqueInput input;
        input.layers = layers;
        input.positions = before_.grid.positions;
        input.memory = memory_;
        return input;
    }

    std::vector<uint32_t> buckets_of(const LayerSources& sources, std::vector<uint32_t> features) const {
        FeatureLists lists(sources.layer_count());
        lists[edit_.layer] = std::move(features);
        const std::vector<Layer> layers = sources.subset(lists);
        return touched_buckets(input_of(layers), before_.grid);
    }

    // Of what was there, and of what is there now.
    void find_buckets() {
        std::vector<uint32_t> old = edit_.removed;
        old.insert(old.end(), edit_.replaced.begin(), edit_.replaced.end());
        std::vector<uint32_t> now = edit_.replaced;
        for (size_t i = 0; i < edit_.added_count(); ++i)
            now.push_back(static_cast<uint32_t>(before_.sources->feature_count(edit_.layer) + i));
        const std::vector<uint32_t> left = buckets_of(*before_.sources, std::move(old));
        const std::vector<uint32_t> entered = buckets_of(*sources_, std::move(now));
        std::set_union(left.begin(), left.end(), entered.begin(), entered.end(),
                       std::back_inserter(buckets_));
    }

    void add_feature(uint32_t layer, uint32_t feature) {
        uint32_t& place = places_[layer][feature];
        if (place != none || sources_->is_removed(layer, feature))
            return;
        place = static_cast<uint32_t>(features_[layer].size());
        features_[layer].push_back(feature);
    }

    void find_features() {
        features_.resize(sources_->layer_count());
        for (size_t layer = 0; layer < sources_->layer_count(); ++layer)
            places_.emplace_back(sources_->feature_count(layer), none);
        for (const uint32_t bucket : buckets_) {
            const uint32_t entry = before_.bucket_entries[bucket];
            for (size_t cell = 0; cell < cells_of(entry); ++cell) {
                const uint32_t list = before_.cells[(entry >> LEVEL_BITS) + cell];
                if (list == EMPTY_LIST)
                    continue;
                result_->unused_words += words_of(before_, list);
                for (const uint32_t word : before_.list(list)) {
                    if (word == LIST_END)
                        break;
                    if ((word & HEADER) == 0)
                        continue;
                    const FeatureReference feature = before_.slots[word & SLOT_MASK].feature;
                    add_feature(feature.layer, feature.feature);
                }
            }
        }
        for (const uint32_t feature : edit_.replaced)
            add_feature(edit_.layer, feature);
        for (size_t i = 0; i < edit_.added_count(); ++i)
            add_feature(edit_.layer, static_cast<uint32_t>(before_.sources->feature_count(edit_.layer) + i));
    }

    // For each slot of the local build, the one that it has in the index; new ones come after all others.
    void match_slots(const PreparedDecals& local) {
        std::vector<std::vector<uint32_t>> known;
        for (const std::vector<uint32_t>& layer : features_)
            known.emplace_back(roles * layer.size(), none);
        for (uint32_t slot = 0; slot < before_.slots.size(); ++slot) {
            const Decal& decal = before_.slots[slot];
            const uint32_t place = places_[decal.feature.layer][decal.feature.feature];
            if (place != none)
                known[decal.feature.layer][roles * place + static_cast<size_t>(decal.role)] = slot;
        }
        auto next = static_cast<uint32_t>(before_.slots.size());
        for (uint32_t slot = 0; slot < local.slots.size(); ++slot) {
            const Decal& decal = local.slots[slot];
            const uint32_t found =
                known[decal.feature.layer][roles * decal.feature.feature + static_cast<size_t>(decal.role)];
            slot_of_.push_back(found != none ? found : next);
            if (found == none) {
                added_.push_back(slot);
                ++next;
            }
        }
        if (next > SLOT_MASK)
            throw Error(ErrorKind::memory,
                        "static: more than " + std::to_string(SLOT_MASK) +
                            " features in one scene; prepare it anew, without those removed");
    }

    template <typename T>
    SharedArray<T> with_added(const SharedArray<T>& before, const SharedArray<T>& local) const {
        LargeArray<T> values(before.begin(), before.end());
        for (const uint32_t slot : added_)
            values.push_back(local[slot]);
        return charged(SharedArray<T>(std::move(values)), memory_, account);
    }

    static SharedArray<uint32_t> kinds_of(const PreparedDecals& local) {
        if (!local.kinds.empty())
            return local.kinds;
        LargeArray<uint32_t> kinds;
        for (uint32_t slot = 0; slot < local.slots.size(); ++slot)
            kinds.push_back(static_cast<uint32_t>(local.scale_of(slot)));
        return {std::move(kinds)};
    }

    void add_slots(const PreparedDecals& local) {
        if (added_.empty())
            return;
        if (before_.kinds.empty() && !local.kinds.empty())
            throw Error(
                ErrorKind::unsupported,
                "what is added would be the first of its kind in the scene; prepare the scene anew with it");
        LargeArray<Decal> slots(before_.slots.begin(), before_.slots.end());
        for (const uint32_t slot : added_) {
            Decal decal = local.slots[slot];
            decal.feature.feature = features_[decal.feature.layer][decal.feature.feature];
            slots.push_back(decal);
        }
        result_->slots = charged(SharedArray<Decal>(std::move(slots)), memory_, account);
        result_->styles = with_added(before_.styles, local.styles);
        if (!before_.kinds.empty())
            result_->kinds = with_added(before_.kinds, kinds_of(local));
        result_->has_lines |= local.has_lines;
        result_->has_polygons |= local.has_polygons;
        result_->largest_scale = std::max(result_->largest_scale, local.largest_scale);
        result_->segments += edit_.geometry.vertex_count();
        std::vector<Decal> added;
        for (const uint32_t slot : added_)
            added.push_back(local.slots[slot]);
        result_->ranks = charged(
            SharedArray<uint32_t>(ranks_with_added(before_.slots, before_.ranks, added, before_.rules)),
            memory_, account);
    }

    void append_lists(const CellChunk& chunk) {
        LargeArray<uint32_t> words(chunk.words.begin(), chunk.words.end());
        for (uint32_t& word : words)
            if ((word & HEADER) != 0 && word != LIST_END)
                word = (word & ~SLOT_MASK) | slot_of_[word & SLOT_MASK];
        const uint64_t first_texel = before_.words.size() / 4, first_cell = before_.cells.size();
        if (first_texel + words.size() / 4 > most_texels || first_cell + chunk.cells.size() > most_cells)
            throw Error(ErrorKind::memory,
                        "the static index has grown to more than it can address; prepare the scene anew");
        LargeArray<uint32_t> cells(chunk.cells.begin(), chunk.cells.end());
        ListSorter sorter(*result_);
        for (uint32_t& cell : cells) {
            if (cell == EMPTY_LIST)
                continue;
            const size_t first = size_t{4} * (cell >> COUNT_BITS);
            const size_t texels = cell & COUNT_ESCAPE;
            sorter.sort(words.data() + first, texels < COUNT_ESCAPE ? 4 * texels : words.size() - first);
            cell += static_cast<uint32_t>(first_texel << COUNT_BITS);
        }
        LargeArray<uint32_t> entries(before_.bucket_entries.begin(), before_.bucket_entries.end());
        for (size_t i = 0; i < buckets_.size(); ++i)
            entries[buckets_[i]] = chunk.bucket_entries[i] + static_cast<uint32_t>(first_cell << LEVEL_BITS);
        result_->words.append(Span<const uint32_t>(words), memory_, account);
        result_->cells.append(Span<const uint32_t>(cells), memory_, account);
        result_->bucket_entries = charged(SharedArray<uint32_t>(std::move(entries)), memory_, account);
    }

    // Lists that are still in use, bucket by bucket.
    void compact() {
        LargeArray<uint32_t> entries, cells, words(4, LIST_END);
        for (const uint32_t entry : result_->bucket_entries) {
            entries.push_back(static_cast<uint32_t>(cells.size()) << LEVEL_BITS |
                              (entry & ((1U << LEVEL_BITS) - 1)));
            for (size_t i = 0; i < cells_of(entry); ++i) {
                const uint32_t cell = result_->cells[(entry >> LEVEL_BITS) + i];
                if (cell == EMPTY_LIST) {
                    cells.push_back(EMPTY_LIST);
                    continue;
                }
                cells.push_back(static_cast<uint32_t>(words.size() / 4) << COUNT_BITS |
                                (cell & COUNT_ESCAPE));
                const uint32_t* first = result_->list(cell).data();
                words.insert(words.end(), first, first + words_of(*result_, cell));
            }
        }
        result_->unused_words = 0;
        result_->bucket_entries = charged(SharedArray<uint32_t>(std::move(entries)), memory_, account);
        result_->cells = charged(SharedArray<uint32_t>(std::move(cells)), memory_, account);
        result_->words = charged(SharedArray<uint32_t>(std::move(words)), memory_, account);
    }

    const PreparedDecals& before_;
    const LayerEdit& edit_;
    const MemoryAccount& memory_;
    std::shared_ptr<const LayerSources> sources_;
    std::shared_ptr<PreparedDecals> result_;
    std::vector<uint32_t> buckets_;              // to be built anew
    FeatureLists features_;                      // in them
    std::vector<std::vector<uint32_t>> places_;  // of each layer's features in `features_`, or none
    std::vector<uint32_t> slot_of_;              // each local slot in the index
    std::vector<uint32_t> added_;                // local slots that the index did not have
};

}  // namespace

std::shared_ptr<const Prepared> PreparedDecals::with_sources(const TechniqueInput& input) const {
    auto result = std::make_shared<PreparedDecals>(*this);
    result->sources = std::make_shared<const LayerSources>(input);
    return result;
}

std::shared_ptr<const Prepared> PreparedDecals::edited(const LayerEdit& edit,
                                                       const MemoryAccount& memory) const {
    if (!sources)
        throw Error(ErrorKind::unsupported,
                    "a scene that was opened from a file has no vertices to edit; prepare it from its data, "
                    "with the file as cache");
    return Edit(*this, edit, memory).run();
}

}  // namespace decalgl
