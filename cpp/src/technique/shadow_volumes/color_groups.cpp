#include "technique/shadow_volumes/color_groups.h"

#include <map>
#include <numeric>
#include <tuple>

namespace decalgl::volume {
namespace {

using Color = std::array<uint8_t, 4>;

bool is_opaque(const Color& color) {
    return color[3] == 255;
}

// The triangles of the map that a volume covers.
template <typename TriangleFn>
void for_each_lid(const PreparedVolumes& prepared, const Volume& volume, TriangleFn use) {
    const auto point = [&](uint32_t corner) {
        const VolumeVertex& vertex = prepared.vertices[prepared.corners[corner] / 2];
        return LatticePoint{vertex.x, vertex.y};
    };
    const uint32_t end = volume.first_corner + volume.lid_corners;
    for (uint32_t i = volume.first_corner; i < end; i += 3)
        use(Triangle{point(i), point(i + 1), point(i + 2)}, i);
}

// Gives each decal its group, from the bottom to the top.
class ExactGrouping {
public:
    ExactGrouping(Span<const Color> colors, const OverlapCells& cells, PreparedVolumes& prepared)
        : colors_(colors), cells_(cells), prepared_(prepared), in_cell_(cells.count()) {}

    std::vector<uint32_t> run(Progress& progress) {
        group_of_.assign(colors_.size(), 0);
        for (uint32_t decal = 0; decal < colors_.size(); ++decal) {
            group_of_[decal] = group_at_or_above(colors_[decal], lowest_group(decal));
            enter(decal);
            if (decal % 1024 == 0)
                progress.report(0.5 + 0.3 * decal / static_cast<double>(colors_.size()));
        }
        return std::move(group_of_);
    }

private:
    struct Entry {
        uint32_t decal;
        uint32_t first_corner;
        uint32_t highest;  // group of this and those before it
    };
    using Cell = std::vector<Entry>;

    template <typename VolumeFn>
    void for_each_volume(uint32_t decal, VolumeFn use) const {
        for (uint32_t i = prepared_.first_volume_of[decal]; i < prepared_.first_volume_of[decal + 1]; ++i)
            use(prepared_.volumes[i]);
    }

    // The lowest that a decal may go into when it lies over one of this group.
    uint32_t above(uint32_t decal, uint32_t below) const {
        const bool same = colors_[decal] == colors_[below] && is_opaque(colors_[decal]);
        return group_of_[below] + (same ? 0 : 1);
    }

    uint32_t lowest_group(uint32_t decal) const {
        uint32_t lowest = 0;
        const auto raise = [&](const Triangle& triangle, const Cell& cell) {
            // The latest are the highest as a rule: then nothing below needs a look.
            for (size_t i = cell.size(); i-- > 0 && cell[i].highest >= lowest;) {
                const Entry& entry = cell[i];
                const uint32_t needed = above(decal, entry.decal);
                if (needed <= lowest)
                    continue;
                const auto corner = [&](uint32_t k) {
                    const VolumeVertex& at = prepared_.vertices[prepared_.corners[entry.first_corner + k] / 2];
                    return LatticePoint{at.x, at.y};
                };
                if (lie_over_each_other(triangle, {corner(0), corner(1), corner(2)}))
                    lowest = needed;
            }
        };
        for_each_volume(decal, [&](const Volume& volume) {
            for_each_lid(prepared_, volume, [&](const Triangle& triangle, uint32_t) {
                cells_.for_each(triangle, [&](size_t cell) { raise(triangle, in_cell_[cell]); });
            });
        });
        return lowest;
    }

    uint32_t group_at_or_above(const Color& color, uint32_t lowest) {
        std::vector<uint32_t>& known = groups_of_[color];
        const auto found = std::lower_bound(known.begin(), known.end(), lowest);
        if (found != known.end())
            return *found;
        known.push_back(static_cast<uint32_t>(prepared_.groups.size()));
        prepared_.groups.push_back({color});
        return known.back();
    }

    void enter(uint32_t decal) {
        for_each_volume(decal, [&](const Volume& volume) {
            for_each_lid(prepared_, volume, [&](const Triangle& triangle, uint32_t first_corner) {
                cells_.for_each(triangle, [&](size_t at) {
                    Cell& cell = in_cell_[at];
                    const uint32_t before = cell.empty() ? 0 : cell.back().highest;
                    cell.push_back({decal, first_corner, std::max(before, group_of_[decal])});
                });
            });
        });
    }

    Span<const Color> colors_;
    const OverlapCells& cells_;
    PreparedVolumes& prepared_;
    std::vector<Cell> in_cell_;
    std::vector<uint32_t> group_of_;
    std::map<Color, std::vector<uint32_t>> groups_of_;
};

bool has_one_opaque_color(Span<const Color> colors) {
    return std::all_of(colors.begin(), colors.end(),
                       [&](const Color& color) { return color == colors[0] && is_opaque(color); });
}

// One group for each colour of each layer and role.
std::vector<uint32_t> groups_by_color(Span<const Color> colors, PreparedVolumes& prepared) {
    std::map<std::tuple<uint32_t, DecalRole, Color>, uint32_t> known;
    std::vector<uint32_t> group_of;
    for (size_t i = 0; i < colors.size(); ++i) {
        const Decal& decal = prepared.decals[i];
        const auto [place, is_new] = known.try_emplace({decal.feature.layer, decal.role, colors[i]},
                                                       static_cast<uint32_t>(prepared.groups.size()));
        if (is_new)
            prepared.groups.push_back({colors[i]});
        group_of.push_back(place->second);
    }
    return group_of;
}

// Bits of x and y in turn.
uint64_t morton(const LatticeBox& box) {
    const auto spread = [](uint64_t v) {
        v = (v | v << 16) & 0x0000FFFF0000FFFF;
        v = (v | v << 8) & 0x00FF00FF00FF00FF;
        v = (v | v << 4) & 0x0F0F0F0F0F0F0F0F;
        v = (v | v << 2) & 0x3333333333333333;
        return (v | v << 1) & 0x5555555555555555;
    };
    const auto middle = [](int32_t a, int32_t b) { return static_cast<uint64_t>((int64_t{a} + b) / 2); };
    return spread(middle(box.min_x, box.max_x)) | spread(middle(box.min_y, box.max_y)) << 1;
}

// Puts volumes into the first batch with room for them in every cell.
class BatchFiller {
public:
    BatchFiller(const OverlapCells& cells, const PreparedVolumes& prepared)
        : cells_(cells), prepared_(prepared), own_(cells.count(), 0) {}

    void begin_group(uint32_t most) {
        for (const auto& [batch, cell] : filled_)
            batches_[batch][cell] = 0;
        filled_.clear();
        most_ = most;
    }

    uint32_t batch_of(const Volume& volume) {
        count(volume);
        uint32_t batch = 0;
        while (!fits(batch))
            ++batch;
        for (const size_t cell : touched_) {
            batches_[batch][cell] = static_cast<uint8_t>(batches_[batch][cell] + own_[cell]);
            filled_.emplace_back(batch, cell);
            own_[cell] = 0;
        }
        return batch;
    }

private:
    void count(const Volume& volume) {
        const bool is_fill = prepared_.decals[volume.decal].role == DecalRole::fill;
        touched_.clear();
        for_each_lid(prepared_, volume, [&](const Triangle& triangle, uint32_t) {
            cells_.for_each(triangle, [&](size_t cell) {
                if (own_[cell] == 0)
                    touched_.push_back(cell);
                own_[cell] = static_cast<uint8_t>(is_fill ? 1 : std::min(own_[cell] + 1U, most_));
            });
        });
    }

    bool fits(uint32_t batch) {
        if (batch == batches_.size())
            batches_.emplace_back(cells_.count(), uint8_t{0});
        return std::all_of(touched_.begin(), touched_.end(),
                           [&](size_t cell) { return batches_[batch][cell] + own_[cell] <= most_; });
    }

    const OverlapCells& cells_;
    const PreparedVolumes& prepared_;
    uint32_t most_ = 0;
    std::vector<uint8_t> own_;
    std::vector<size_t> touched_;
    std::vector<std::vector<uint8_t>> batches_;
    std::vector<std::pair<uint32_t, size_t>> filled_;  // batches' cells that are not 0
};

// A volume's place: group, batch in it, and place on the map.
struct VolumeOrder {
    uint32_t group;
    uint32_t batch;
    uint64_t place;
    uint32_t volume;

    bool operator<(const VolumeOrder& other) const {
        return std::tie(group, batch, place, volume) <
               std::tie(other.group, other.batch, other.place, other.volume);
    }
};

void sort_volumes(std::vector<VolumeOrder> order, PreparedVolumes& prepared) {
    std::sort(order.begin(), order.end());
    std::vector<Volume> sorted;
    sorted.reserve(order.size());
    for (const VolumeOrder& each : order) {
        const auto place = static_cast<uint32_t>(sorted.size());
        const bool goes_on = place > 0 && order[place - 1].group == each.group &&
                             order[place - 1].batch == each.batch;
        if (!goes_on)
            prepared.batches.push_back({each.group, place, 0});
        ++prepared.batches.back().volume_count;
        sorted.push_back(prepared.volumes[each.volume]);
    }
    // Volumes were sorted by decal; now decals list theirs.
    prepared.volumes_of.resize(sorted.size());
    std::vector<uint32_t> next = prepared.first_volume_of;
    for (uint32_t i = 0; i < sorted.size(); ++i)
        prepared.volumes_of[next[sorted[i].decal]++] = i;
    prepared.volumes = std::move(sorted);
}

}  // namespace

uint32_t most_over_each_other(const Color& color) {
    return is_opaque(color) ? 255 : 127;
}

void group_by_color(Span<const Color> colors, Grouping grouping, const OverlapCells& cells,
                    PreparedVolumes& prepared, Progress& progress) {
    if (colors.empty())
        return;
    const bool is_simple = grouping == Grouping::colors || has_one_opaque_color(colors);
    const std::vector<uint32_t> group_of = is_simple
                                               ? groups_by_color(colors, prepared)
                                               : ExactGrouping(colors, cells, prepared).run(progress);
    std::vector<VolumeOrder> order;
    for (uint32_t i = 0; i < prepared.volumes.size(); ++i) {
        const Volume& volume = prepared.volumes[i];
        order.push_back({group_of[volume.decal], 0, morton(volume.box), i});
    }
    std::sort(order.begin(), order.end());
    BatchFiller filler(cells, prepared);
    for (size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || order[i].group != order[i - 1].group)
            filler.begin_group(most_over_each_other(prepared.groups[order[i].group].color));
        order[i].batch = filler.batch_of(prepared.volumes[order[i].volume]);
        if (i % 1024 == 0)
            progress.report(0.8 + 0.2 * static_cast<double>(i) / static_cast<double>(order.size()));
    }
    sort_volumes(std::move(order), prepared);
}

}  // namespace decalgl::volume
