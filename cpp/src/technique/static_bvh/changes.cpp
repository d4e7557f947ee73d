// Other looks and local edits of a prepared index.
//
//     restyle      new styles; for another draw order, new ranks and cells sorted by them
//     edit         slots of what goes lose their rank and are hidden
//                  what comes is built as a group by itself, in the grid of the one that it belongs to
//                  ──▶ its arrays are added to that one's, and its cells' lists joined with those there
//
// What replaces a feature gets new slots in the places of the old ones. Where that leaves too much unused, leads beyond the
// grid or needs other arrays, the group is built anew.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "decalgl/core/error.h"
#include "technique/draw_order.h"
#include "technique/static_bvh/cell_lists.h"
#include "technique/static_bvh/data_group.h"
#include "technique/static_bvh/looks.h"
#include "technique/static_bvh/walk_length.h"
#include "technique/style_changes.h"

namespace decalgl::bvh {
namespace {

constexpr size_t block_slots = 1 << 15;

const char* const account = "static_bvh: prepared";

LargeArray<uint32_t> ranks_of(const DecalGroup& group) {
    LargeArray<uint32_t> ranks;
    ranks.resize(group.styles.size());
    for (size_t slot = 0; slot < ranks.size(); ++slot)
        ranks[slot] = group.styles[slot].rank;
    return ranks;
}

Style restyled(const Style& style, const Decal& slot, const DecalLook& look, double half_widths_per_metre) {
    const size_t feature = slot.feature.feature;
    const float half_width = look.widths.empty()
                                 ? std::abs(style.half_width)
                                 : static_cast<float>(look.width(feature) * half_widths_per_metre);
    std::array<uint8_t, 4> color = style.color;
    if (!look.colors.empty())
        std::copy_n(look.color(feature), 4, color.begin());
    return style_of(color, half_width, slot.is_stroke(), style.look, style.rank);
}

bool holds_layer(const DecalGroup& group, uint32_t layer) {
    return std::any_of(group.classes.begin(), group.classes.end(),
                       [&](const DecalClass& each) { return each.layer == layer; });
}

// Other looks after those that there are, and which slots go by them.
void change_looks(DecalGroup& group, const LayerLook& look, const PreparedBvh& bvh, LargeArray<Style>& styles,
                  const MemoryAccount& memory) {
    const std::vector<Layer> layers = layers_of_styles(Span<const LayerLook>(&look, 1), bvh.rules.size());
    GroupBuild written;
    LookWriter writer(bvh.lattice, written);
    const auto first = static_cast<uint32_t>(group.looks.size());
    for (size_t slot = 0; slot < styles.size(); ++slot) {
        const Decal& decal = group.slots[slot];
        if (decal.feature.layer == look.layer && styles[slot].rank != no_rank &&
            look.of(decal.role)->has_styles())
            styles[slot].look = first + writer.place_of({&layers[look.layer], decal});
    }
    group.looks.append(written.looks, memory, account);
    group.needs.bands |= written.needs.bands;
    group.needs.hatches |= written.needs.hatches;
}

void restyle_group(DecalGroup& group, const LayerLook& look, const PreparedBvh& bvh,
                   const MemoryAccount& memory) {
    const double scale = bvh.rules[look.layer].half_width_per_width / bvh.lattice.quantum;
    LargeArray<Style> styles(group.styles.begin(), group.styles.end());
    if (!look.draw_order.empty()) {
        const LargeArray<uint32_t> ranks =
            reordered_ranks(look, bvh.rules[look.layer], group.slots, ranks_of(group));
        for (size_t slot = 0; slot < styles.size(); ++slot)
            styles[slot].rank = ranks[slot];
    }
    if (look.fill.has_styles() || look.stroke.has_styles() || look.casing.has_styles())
        change_looks(group, look, bvh, styles, memory);
    parallel_for(styles.size(), block_slots, bvh.threads, [&](size_t begin, size_t end) {
        for (size_t slot = begin; slot < end; ++slot) {
            const Decal& decal = group.slots[slot];
            if (decal.feature.layer == look.layer && styles[slot].rank != no_rank)
                styles[slot] = restyled(styles[slot], decal, *look.of(decal.role), scale);
        }
    });
    group.styles = charged(SharedArray<Style>(std::move(styles)), memory, account);
    summarise(group);
    if (!look.draw_order.empty())
        sort_cells(group, bvh.options, bvh.threads, memory);
}

// One edit on its way into a new index.
class Edit {
public:
    Edit(const PreparedBvh& before, const LayerEdit& edit, const MemoryAccount& memory)
        : edit_(edit),
          memory_(memory),
          sources_(before.sources->edited(edit)),
          result_(std::make_shared<PreparedBvh>(before)) {}

    std::shared_ptr<const PreparedBvh> run() {
        result_->sources = sources_;
        FeatureLists changed(sources_->layer_count());
        changed[edit_.layer] = edit_.replaced;
        for (size_t i = 0; i < edit_.added_count(); ++i)
            changed[edit_.layer].push_back(
                static_cast<uint32_t>(sources_->feature_count(edit_.layer) - edit_.added_count() + i));
        const Part part(*this, std::move(changed));
        std::vector<std::vector<Decal>> decals(result_->groups.size());
        for (const Decal& decal : part.decals)
            decals[group_of(decal, part)].push_back(decal);
        for (size_t group = 0; group < decals.size(); ++group)
            if (holds_layer(result_->groups[group], edit_.layer))
                change(result_->groups[group], part, decals[group]);
        result_->features += edit_.added_count();
        result_->segments += edit_.geometry.vertex_count();
        result_->count_slots();
        return result_;
    }

private:
    using FeatureLists = std::vector<std::vector<uint32_t>>;  // of each layer
    using Key = std::tuple<uint32_t, uint32_t, DecalRole>;

    // Some features of all layers as the input of a builder, which counts them from 0.
    struct Part {
        Part(const Edit& edit, FeatureLists lists)
            : features(std::move(lists)), layers(edit.sources_->subset(features)) {
            const PreparedBvh& bvh = *edit.result_;
            input.layers = layers;
            input.bounds = bvh.bounds;
            input.positions = bvh.positions;
            input.threads = bvh.threads;
            input.memory = edit.memory_;
            input.bvh = bvh.options;
            decals = decals_of(layers, 0, Hidden::kept);
        }
        Part(const Part&) = delete;
        Part& operator=(const Part&) = delete;

        Decal in_scene(Decal decal) const {
            decal.feature.feature = features[decal.feature.layer][decal.feature.feature];
            return decal;
        }

        FeatureLists features;
        std::vector<Layer> layers;
        TechniqueInput input;
        std::vector<Decal> decals;
    };

    static Key key_of(const Decal& decal) { return {decal.feature.layer, decal.feature.feature, decal.role}; }

    size_t group_of(const Decal& decal, const Part& part) const {
        for (size_t group = 0; group < result_->groups.size(); ++group)
            for (const DecalClass& each : result_->groups[group].classes)
                if (each.layer == decal.feature.layer && each.role == decal.role)
                    return group;
        throw Error(ErrorKind::unsupported, "layer '" + part.layers[decal.feature.layer].name +
                                                "': what is added would be the first of its kind in the "
                                                "layer; prepare the scene anew with it");
    }

    void change(DecalGroup& group, const Part& part, const std::vector<Decal>& decals) {
        std::vector<Decal> slots;
        for (size_t i = decals.size(); i-- > 0;)
            slots.push_back(part.in_scene(decals[i]));
        const LargeArray<uint32_t> added_ranks = make_room(group, slots);
        const std::map<Key, Style> old = take_out(group);
        if (slots.empty())
            return;
        const DecalRun run{group.kind, decals};
        const std::optional<DecalGroup> local = build_in_grid(part.input, run, result_->lattice, group);
        const auto first = static_cast<uint32_t>(group.slots.size());
        group.slots.append(slots, memory_, account);
        LargeArray<Style> styles(group.styles.begin(), group.styles.end());
        size_t added = 0;
        for (size_t i = 0; i < slots.size(); ++i) {
            const auto found = old.find(key_of(slots[i]));
            const Style like =
                found != old.end()
                    ? found->second
                    : first_style({&part.layers[slots[i].feature.layer], decals[decals.size() - 1 - i]},
                                  added_ranks[added++]);
            styles.push_back(like);
        }
        if (local)
            join_looks(group, *local, Span<Style>(styles.data() + first, slots.size()));
        group.styles = charged(SharedArray<Style>(std::move(styles)), memory_, account);
        std::vector<uint32_t> slot_of(slots.size());
        std::iota(slot_of.begin(), slot_of.end(), first);
        uint64_t longest = 0;
        if (local)
            longest = longest_walk(group, add_objects(group, *local, slot_of, result_->options, memory_));
        if (!local || group.spent > group.object_count() / 2) {
            build_anew(group);
            longest = longest_walk(group, result_->threads);
        }
        summarise(group);
        require_drawable(group.kind, group.needs.translucency, result_->options,
                         part.layers[edit_.layer].name);
        result_->longest_walk = std::max(result_->longest_walk, longest);
    }

    // Ranks of the slots that come on top of the layer; others move down.
    LargeArray<uint32_t> make_room(DecalGroup& group, const std::vector<Decal>& slots) const {
        std::vector<Decal> added;
        for (const Decal& slot : slots)
            if (slot.feature.feature >= sources_->feature_count(edit_.layer) - edit_.added_count())
                added.push_back(slot);
        if (added.empty())
            return {};
        const LargeArray<uint32_t> ranks =
            ranks_with_added(group.slots, ranks_of(group), added, result_->rules);
        LargeArray<Style> styles(group.styles.begin(), group.styles.end());
        for (size_t slot = 0; slot < styles.size(); ++slot)
            styles[slot].rank = ranks[slot];
        group.styles = charged(SharedArray<Style>(std::move(styles)), memory_, account);
        return LargeArray<uint32_t>(ranks.end() - static_cast<std::ptrdiff_t>(added.size()), ranks.end());
    }

    Style first_style(const DecalView& decal, uint32_t rank) const {
        const uint8_t* color = decal.color();
        return style_of({color[0], color[1], color[2], color[3]},
                        static_cast<float>(decal.half_width() / result_->lattice.quantum),
                        decal.decal.is_stroke(), 0, rank);
    }

    // The looks of what was built, where the group has them already or else after its own.
    void join_looks(DecalGroup& group, const DecalGroup& local, Span<Style> styles) const {
        const auto found =
            std::search(group.looks.begin(), group.looks.end(), local.looks.begin(), local.looks.end());
        const auto first = static_cast<uint32_t>(found - group.looks.begin());
        if (found == group.looks.end())
            group.looks.append(local.looks, memory_, account);
        for (size_t i = 0; i < styles.size(); ++i)
            styles[i].look = first + local.styles[i].look;
        group.widest = std::max(group.widest, local.widest);
        group.needs.bands |= local.needs.bands;
        group.needs.slopes |= local.needs.slopes;
        group.needs.hatches |= local.needs.hatches;
    }

    // From the layers' sources, in the order in which its slots stand and with their looks.
    void build_anew(DecalGroup& group) const {
        std::vector<uint32_t> upwards;
        for (uint32_t slot = 0; slot < group.slots.size(); ++slot)
            if (group.styles[slot].rank != no_rank)
                upwards.push_back(slot);
        std::sort(upwards.begin(), upwards.end(),
                  [&](uint32_t a, uint32_t b) { return group.styles[a].rank > group.styles[b].rank; });
        FeatureLists lists(sources_->layer_count());
        std::vector<std::vector<bool>> listed;
        for (size_t layer = 0; layer < lists.size(); ++layer)
            listed.emplace_back(sources_->feature_count(layer), false);
        std::map<Key, Style> known;
        for (const uint32_t slot : upwards) {
            const Decal& decal = group.slots[slot];
            known.emplace(key_of(decal), group.styles[slot]);
            if (!listed[decal.feature.layer][decal.feature.feature])
                lists[decal.feature.layer].push_back(decal.feature.feature);
            listed[decal.feature.layer][decal.feature.feature] = true;
        }
        const Part part(*this, std::move(lists));
        std::vector<std::pair<Style, Decal>> decals;
        for (const Decal& decal : part.decals)
            if (const auto found = known.find(key_of(part.in_scene(decal))); found != known.end())
                decals.emplace_back(found->second, decal);
        std::stable_sort(decals.begin(), decals.end(),
                         [](const auto& a, const auto& b) { return a.first.rank > b.first.rank; });
        group = built(part, decals);
    }

    DecalGroup built(const Part& part, const std::vector<std::pair<Style, Decal>>& decals) const {
        std::vector<Decal> run;
        for (const auto& [style, decal] : decals)
            run.push_back(decal);
        Progress progress;
        const Layer& layer = part.layers[run[0].feature.layer];
        DecalGroup group =
            build_group(part.input, {kind_of(layer, run[0]), run}, result_->lattice, {&progress, 0.0, 1.0});
        LargeArray<Decal> slots(group.slots.begin(), group.slots.end());
        LargeArray<Style> styles(group.styles.begin(), group.styles.end());
        for (uint32_t slot = 0; slot < slots.size(); ++slot) {
            const Style& style = decals[decals.size() - 1 - slot].first;
            slots[slot] = part.in_scene(slots[slot]);
            styles[slot] = style_of(style.color, std::abs(style.half_width), slots[slot].is_stroke(),
                                    styles[slot].look, slot);
        }
        group.slots = std::move(slots);
        group.styles = std::move(styles);
        return group;
    }

    // Hides what goes for good, and returns its styles.
    std::map<Key, Style> take_out(DecalGroup& group) const {
        std::vector<bool> goes(sources_->feature_count(edit_.layer), false);
        for (const std::vector<uint32_t>* features : {&edit_.removed, &edit_.replaced})
            for (const uint32_t feature : *features)
                goes[feature] = true;
        std::map<Key, Style> old;
        LargeArray<Style> styles(group.styles.begin(), group.styles.end());
        for (size_t slot = 0; slot < styles.size(); ++slot) {
            const Decal& decal = group.slots[slot];
            if (decal.feature.layer != edit_.layer || !goes[decal.feature.feature] ||
                styles[slot].rank == no_rank)
                continue;
            old.emplace(key_of(decal), styles[slot]);
            styles[slot] = style_of({}, std::abs(styles[slot].half_width), decal.is_stroke(),
                                    styles[slot].look, no_rank);
        }
        group.styles = charged(SharedArray<Style>(std::move(styles)), memory_, account);
        return old;
    }

    const LayerEdit& edit_;
    const MemoryAccount& memory_;
    std::shared_ptr<const LayerSources> sources_;
    std::shared_ptr<PreparedBvh> result_;
};

}  // namespace

LayerLook PreparedBvh::look_of(uint32_t layer, size_t count) const {
    LayerLook result;
    result.layer = layer;
    for (const DecalGroup& group : groups) {
        for (size_t slot = 0; slot < group.slots.size(); ++slot) {
            const Decal& decal = group.slots[slot];
            const Style& style = group.styles[slot];
            if (decal.feature.layer != layer || decal.feature.feature >= count || style.rank == no_rank)
                continue;
            DecalLook& look = *result.of(decal.role);
            look.colors.resize(4 * count, 0);
            std::copy_n(style.color.begin(), 4, &look.colors[size_t{4} * decal.feature.feature]);
            if (!decal.is_stroke())
                continue;
            look.widths.resize(count, 0.0);
            look.widths[decal.feature.feature] =
                std::abs(double{style.half_width}) * lattice.quantum / rules[layer].half_width_per_width;
        }
    }
    return result;
}

std::shared_ptr<const Prepared> PreparedBvh::restyled(Span<const LayerLook> looks,
                                                      const MemoryAccount& memory) const {
    auto result = std::make_shared<PreparedBvh>(*this);
    for (const LayerLook& look : looks) {
        if (look.layer >= rules.size())
            continue;
        require_widths(look, rules[look.layer]);
        for (const DecalGroup& group : groups)
            require_styles(look, sources.get(), group.slots, CornerRoom::outline);
        for (DecalGroup& group : result->groups) {
            if (!holds_layer(group, look.layer))
                continue;
            restyle_group(group, look, *this, memory);
            require_drawable(group.kind, group.needs.translucency, options, sources->name_of(look.layer));
        }
    }
    return result;
}

std::shared_ptr<const Prepared> PreparedBvh::edited(const LayerEdit& edit,
                                                    const MemoryAccount& memory) const {
    return Edit(*this, edit, memory).run();
}

}  // namespace decalgl::bvh
