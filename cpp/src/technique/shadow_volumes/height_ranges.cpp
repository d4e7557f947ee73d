#include "technique/shadow_volumes/height_ranges.h"

namespace decalgl::volume {

HeightRanges::HeightRanges(const Heightfield& terrain, const Lattice& lattice, const MemoryAccount& memory)
    : terrain_(terrain), lattice_(lattice) {
    const size_t quads = static_cast<size_t>(terrain.rows()) * static_cast<size_t>(terrain.columns());
    charge_ = MemoryCharge(memory, "volume: working memory", quads * sizeof(HeightRange) * 4 / 3);
    add_finest();
    while (levels_.back().columns > 1 || levels_.back().rows > 1)
        add_coarser();
}

// A quad with a missing sample may still show a triangle of the others.
void HeightRanges::add_finest() {
    Level level{terrain_.columns() - 1, terrain_.rows() - 1, {}};
    level.quads.resize(static_cast<size_t>(level.columns) * static_cast<size_t>(level.rows));
    for (int row = 0; row < level.rows; ++row) {
        for (int column = 0; column < level.columns; ++column) {
            HeightRange range;
            for (const float height : {terrain_.height(row, column), terrain_.height(row, column + 1),
                                       terrain_.height(row + 1, column), terrain_.height(row + 1, column + 1)}) {
                if (!std::isnan(height))
                    range.add({height, height});
            }
            level.quads[static_cast<size_t>(row) * static_cast<size_t>(level.columns) +
                        static_cast<size_t>(column)] = range;
        }
    }
    levels_.push_back(std::move(level));
}

void HeightRanges::add_coarser() {
    const Level& finer = levels_.back();
    Level level{(finer.columns + 1) / 2, (finer.rows + 1) / 2, {}};
    level.quads.resize(static_cast<size_t>(level.columns) * static_cast<size_t>(level.rows));
    for (int row = 0; row < finer.rows; ++row)
        for (int column = 0; column < finer.columns; ++column)
            level
                .quads[static_cast<size_t>(row / 2) * static_cast<size_t>(level.columns) +
                       static_cast<size_t>(column / 2)]
                .add(finer.quads[static_cast<size_t>(row) * static_cast<size_t>(finer.columns) +
                                 static_cast<size_t>(column)]);
    levels_.push_back(std::move(level));
}

// From the finest level at which the box touches a few quads only.
HeightRange HeightRanges::under(const LatticeBox& box) const {
    constexpr int most_quads_across = 4;
    const auto column_of = [&](double x) {
        return std::floor((lattice_.left + x * lattice_.quantum - terrain_.x0()) / terrain_.dx());
    };
    const auto row_of = [&](double y) {
        return std::floor((terrain_.y0() - (lattice_.bottom + y * lattice_.quantum)) / terrain_.dy());
    };
    const Level& finest = levels_.front();
    if (column_of(box.max_x) < 0.0 || column_of(box.min_x) > finest.columns || row_of(box.min_y) < 0.0 ||
        row_of(box.max_y) > finest.rows)
        return {};
    const auto quad = [](double at, int count) {
        return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(count - 1)));
    };
    int left = quad(column_of(box.min_x), finest.columns), right = quad(column_of(box.max_x), finest.columns);
    int top = quad(row_of(box.max_y), finest.rows), bottom = quad(row_of(box.min_y), finest.rows);
    size_t at = 0;
    while (right - left >= most_quads_across || bottom - top >= most_quads_across) {
        left /= 2;
        right /= 2;
        top /= 2;
        bottom /= 2;
        ++at;
    }
    const Level& level = levels_[at];
    HeightRange range;
    for (int row = top; row <= bottom; ++row)
        for (int column = left; column <= right; ++column)
            range.add(level.quads[static_cast<size_t>(row) * static_cast<size_t>(level.columns) +
                                  static_cast<size_t>(column)]);
    return range;
}

}  // namespace decalgl::volume
