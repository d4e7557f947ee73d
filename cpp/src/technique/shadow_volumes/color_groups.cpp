#include "technique/shadow_volumes/color_groups.h"

#include <map>
#include <tuple>
#include <utility>

#include "core/growing_array.h"
#include "technique/shadow_volumes/overlap_cells.h"

namespace decalgl::volume {
namespace {

constexpr uint32_t no_group = UINT32_MAX;

bool is_opaque(const Color& color) {
    return color[3] == 255;
}

uint32_t most_counted(const Color& color) {
    return is_opaque(color) ? 255 : most_over_each_other;
}

Triangle lid_at(const PreparedVolumes& prepared, const Volume& volume, uint32_t corner) {
    return {prepared.point(volume, corner), prepared.point(volume, corner + 1),
            prepared.point(volume, corner + 2)};
}

// The triangles of the map that a volume covers, and the first corner of each.
template <typename TriangleFn>
void for_each_lid(const PreparedVolumes& prepared, const Volume& volume, TriangleFn use) {
    const uint32_t end = volume.first_corner + volume.lid_corners;
    for (uint32_t i = volume.first_corner; i < end; i += 3)
        use(lid_at(prepared, volume, i), i);
}

uint64_t lid_count(const PreparedVolumes& prepared) {
    uint64_t corners = 0;
    for (const Volume& volume : prepared.volumes)
        corners += volume.lid_corners;
    return corners / 3;
}

struct Grouped {
    std::vector<uint32_t> group_of;  // each decal's; of those that show nothing, none
    std::vector<Color> groups;
};

// Gives each decal its group, from the bottom to the top.
class ExactGrouping {
public:
    ExactGrouping(const PreparedVolumes& prepared, const OverlapCells& cells)
        : prepared_(prepared), cells_(cells), in_cell_(cells.count()) {}

    Grouped run(Progress& progress) {
        const size_t count = prepared_.decals.size();
        grouped_.group_of.assign(count, no_group);
        for (size_t i = 0; i < count; ++i) {
            const uint32_t decal = prepared_.upwards[i];
            if (!prepared_.shows(decal))
                continue;
            grouped_.group_of[decal] = group_at_or_above(color_of(decal), lowest_group(decal));
            enter(decal);
            if (i % 1024 == 0)
                progress.report(0.5 + 0.3 * static_cast<double>(i) / static_cast<double>(count));
        }
        return std::move(grouped_);
    }

private:
    struct Entry {
        uint32_t decal;
        uint32_t volume;
        uint32_t corner;   // the triangle's first
        uint32_t highest;  // group of this and those before it
    };
    using Cell = std::vector<Entry>;
    struct Place {
        uint32_t volume;
        uint32_t corner;
    };

    const Color& color_of(uint32_t decal) const { return prepared_.looks[decal].color; }

    // Calls back with each triangle of a decal, where it stands, and each cell that it touches.
    template <typename CellFn>
    void for_each_cell(uint32_t decal, CellFn use) const {
        for (uint32_t i = prepared_.first_volume_of[decal]; i < prepared_.first_volume_of[decal + 1]; ++i)
            for_each_lid(prepared_, prepared_.volumes[i], [&](const Triangle& triangle, uint32_t corner) {
                cells_.for_each(triangle, [&](size_t cell) { use(triangle, Place{i, corner}, cell); });
            });
    }

    // The lowest that a decal may go into when it lies over one of this group.
    uint32_t above(uint32_t decal, uint32_t below) const {
        const bool same = color_of(decal) == color_of(below) && is_opaque(color_of(decal));
        return grouped_.group_of[below] + (same ? 0 : 1);
    }

    uint32_t lowest_group(uint32_t decal) const {
        uint32_t lowest = 0;
        for_each_cell(decal, [&](const Triangle& triangle, Place, size_t at) {
            const Cell& cell = in_cell_[at];
            // The latest are the highest as a rule: then nothing below needs a look.
            for (size_t i = cell.size(); i-- > 0 && cell[i].highest >= lowest;) {
                const uint32_t needed = above(decal, cell[i].decal);
                if (needed > lowest &&
                    lie_over_each_other(triangle,
                                        lid_at(prepared_, prepared_.volumes[cell[i].volume], cell[i].corner)))
                    lowest = needed;
            }
        });
        return lowest;
    }

    uint32_t group_at_or_above(const Color& color, uint32_t lowest) {
        std::vector<uint32_t>& known = groups_of_[color];
        const auto found = std::lower_bound(known.begin(), known.end(), lowest);
        if (found != known.end())
            return *found;
        known.push_back(static_cast<uint32_t>(grouped_.groups.size()));
        grouped_.groups.push_back(color);
        return known.back();
    }

    void enter(uint32_t decal) {
        for_each_cell(decal, [&](const Triangle&, Place place, size_t at) {
            Cell& cell = in_cell_[at];
            const uint32_t before = cell.empty() ? 0 : cell.back().highest;
            cell.push_back({decal, place.volume, place.corner, std::max(before, grouped_.group_of[decal])});
        });
    }

    const PreparedVolumes& prepared_;
    const OverlapCells& cells_;
    std::vector<Cell> in_cell_;
    Grouped grouped_;
    std::map<Color, std::vector<uint32_t>> groups_of_;
};

bool has_one_opaque_color(const PreparedVolumes& prepared) {
    const Color* first = nullptr;
    for (uint32_t i = 0; i < prepared.decals.size(); ++i) {
        if (!prepared.shows(i))
            continue;
        const Color& color = prepared.looks[i].color;
        if (!is_opaque(color) || (first != nullptr && *first != color))
            return false;
        first = &color;
    }
    return true;
}

// One group for each colour of each layer and role.
Grouped groups_by_color(const PreparedVolumes& prepared) {
    Grouped grouped;
    grouped.group_of.assign(prepared.decals.size(), no_group);
    std::map<std::tuple<uint32_t, DecalRole, Color>, uint32_t> known;
    for (const uint32_t i : prepared.upwards) {
        if (!prepared.shows(i))
            continue;
        const Decal& decal = prepared.decals[i];
        const Color& color = prepared.looks[i].color;
        const auto [place, is_new] = known.try_emplace({decal.feature.layer, decal.role, color},
                                                       static_cast<uint32_t>(grouped.groups.size()));
        if (is_new)
            grouped.groups.push_back(color);
        grouped.group_of[i] = place->second;
    }
    return grouped;
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

void set_drawn(std::vector<VolumeOrder> order, PreparedVolumes& prepared, const MemoryAccount& memory) {
    std::sort(order.begin(), order.end());
    std::vector<uint32_t> drawn;
    std::vector<Batch> batches;
    drawn.reserve(order.size());
    for (size_t i = 0; i < order.size(); ++i) {
        const bool goes_on =
            i > 0 && order[i - 1].group == order[i].group && order[i - 1].batch == order[i].batch;
        if (!goes_on)
            batches.push_back({order[i].group, static_cast<uint32_t>(i), 0});
        ++batches.back().volume_count;
        drawn.push_back(order[i].volume);
    }
    prepared.batches = charged(SharedArray<Batch>(std::move(batches)), memory, prepared_name);
    prepared.drawn = charged(SharedArray<uint32_t>(std::move(drawn)), memory, prepared_name);
}

}  // namespace

void group_by_color(PreparedVolumes& prepared, const MemoryAccount& memory, Progress& progress) {
    const OverlapCells cells(lid_count(prepared));
    const bool is_simple = prepared.grouping == Grouping::colors || has_one_opaque_color(prepared);
    Grouped grouped = is_simple ? groups_by_color(prepared) : ExactGrouping(prepared, cells).run(progress);
    std::vector<VolumeOrder> order;
    for (uint32_t i = 0; i < prepared.volumes.size(); ++i) {
        const uint32_t group = grouped.group_of[prepared.volumes[i].decal];
        if (group != no_group)
            order.push_back({group, 0, morton(prepared.volumes[i].box), i});
    }
    std::sort(order.begin(), order.end());
    BatchFiller filler(cells, prepared);
    for (size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || order[i].group != order[i - 1].group)
            filler.begin_group(most_counted(grouped.groups[order[i].group]));
        order[i].batch = filler.batch_of(prepared.volumes[order[i].volume]);
        if (i % 1024 == 0)
            progress.report(0.8 + 0.2 * static_cast<double>(i) / static_cast<double>(order.size()));
    }
    prepared.groups = charged(SharedArray<Color>(std::move(grouped.groups)), memory, prepared_name);
    set_drawn(std::move(order), prepared, memory);
}

}  // namespace decalgl::volume
