#include "technique/loops/bucket_cells.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace decalgl::loops {
namespace {

constexpr uint32_t no_header = UINT32_MAX;
constexpr double exact = 1 << 23;  // whole numbers up to there are floats

uint32_t bits_of(double value) {
    const auto rounded = static_cast<float>(value);
    uint32_t bits = 0;
    std::memcpy(&bits, &rounded, sizeof(bits));
    return bits;
}

// Bits from a column on.
uint64_t from_column(int64_t column) {
    return column >= 64 ? 0 : ~uint64_t{0} << std::max<int64_t>(column, 0);
}

// The part of a segment in a box, which it may miss: x, y of both ends.
std::array<double, 4> part_in(const std::array<double, 4>& ends, double low, double high) {
    double from = 0.0, to = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
        const double a = ends[size_t(axis)], along = ends[size_t(axis) + 2] - a;
        if (along == 0.0)
            continue;
        const double first = (low - a) / along, second = (high - a) / along;
        from = std::max(from, std::min(first, second));
        to = std::min(to, std::max(first, second));
    }
    if (from > to)
        return ends;
    const double dx = ends[2] - ends[0], dy = ends[3] - ends[1];
    return {ends[0] + from * dx, ends[1] + from * dy, ends[0] + to * dx, ends[1] + to * dy};
}

}  // namespace

int32_t height_at(const Edge& edge, int32_t x) {
    const double slope = (double(edge.b.y) - edge.a.y) / (double(edge.b.x) - edge.a.x);
    return static_cast<int32_t>(std::lrint(edge.a.y + slope * (double(x) - edge.a.x)));
}

int32_t place_at(const Edge& edge, int32_t y) {
    const double slope = (double(edge.b.x) - edge.a.x) / (double(edge.b.y) - edge.a.y);
    return static_cast<int32_t>(std::lrint(edge.a.x + slope * (double(y) - edge.a.y)));
}

void BucketBuilder::add(LatticePoint corner, Span<const BucketSlot> slots, Span<const Edge> edges) {
    corner_ = corner;
    level_ = level_of(slots);
    cell_bits_ = bits_ - level_;
    side_ = 1 << level_;
    std::fill_n(done_.begin(), side_, 0);
    std::fill_n(noted_.begin(), side_, 0);
    hiders_.resize(size_t(side_) * size_t(side_));
    items_.clear();
    last_.assign(size_t(side_) * size_t(side_), no_header);
    for (const BucketSlot& slot : slots) {
        const Span<const Edge> own = edges.subspan(slot.first_edge, slot.edges);
        std::fill_n(met_.begin(), side_, 0);
        slot_ = &slot;
        if (styles_[slot.slot].is_fill())
            add_fill(slot, own);
        else
            add_stroke(own, double{styles_[slot.slot].half_width});
    }
    write();
}

// Half as many cells as edges, but none that strokes are much wider than.
int BucketBuilder::level_of(Span<const BucketSlot> slots) const {
    double reach = 0.0, count = 0.0;
    for (const BucketSlot& slot : slots) {
        reach += double{styles_[slot.slot].half_width} * slot.edges;
        count += slot.edges;
    }
    const double widest_side = std::ldexp(1.0, bits_) * count / std::max(reach, 1e-9);
    const double cells = std::clamp(0.5 * count, 1.0, std::max(widest_side * widest_side, 1.0));
    return std::min(static_cast<int>(std::lrint(0.5 * std::log2(cells))), CELL_FINEST_LEVEL);
}

void BucketBuilder::add_fill(const BucketSlot& slot, Span<const Edge> edges) {
    Rows corners;
    std::fill_n(corners.begin(), side_, 0);
    for (const Edge& edge : edges)
        cut_fill(edge, corners);
    uint64_t inside = slot.inside ? ~uint64_t{0} : 0;
    for (int row = 0; row < side_; ++row) {
        inside ^= corners[size_t(row)];
        corners[size_t(row)] = inside;
    }
    close(corners);
}

// `corners`: of each row, which columns' corners the edge turns over from there on.
void BucketBuilder::cut_fill(const Edge& edge, Rows& corners) {
    if (edge.a.x == corner_.x && edge.b.x == corner_.x)
        return;
    const int32_t size = 1 << cell_bits_;
    const auto first_row_from = [&](int32_t y) { return (int64_t{y} - corner_.y + size - 1) >> cell_bits_; };
    const auto first_column_from = [&](int32_t x) {
        return std::max<int64_t>((int64_t{x} - corner_.x + size - 1) >> cell_bits_, 1);
    };
    const int32_t last_x = std::max(edge.a.x, edge.b.x - 1);
    const int first = (edge.a.x - corner_.x) >> cell_bits_;
    const int last = std::min((last_x - corner_.x) >> cell_bits_, side_ - 1);
    LatticePoint from = edge.a;
    for (int column = first; column <= last; ++column) {
        const int32_t left = corner_.x + (column << cell_bits_), right = left + size;
        LatticePoint to = edge.b;
        if (edge.b.x > right)
            to = {right, height_at(edge, right)};
        const bool starts_at_left = from.x == left && from.x < to.x;
        // From the bucket's corner along its lower border, then up each column's left border.
        const LatticePoint low = from.y <= to.y ? from : to;
        if (low.y == corner_.y && from.y != to.y)
            corners[0] ^= from_column(starts_at_left && low == from ? column + 1 : first_column_from(low.x));
        if (starts_at_left && from.y > corner_.y && first_row_from(from.y) < side_)
            corners[size_t(first_row_from(from.y))] ^= uint64_t{1} << column;
        const bool is_on_border = from.x == left && to.x == left;
        if (from != to && !is_on_border) {
            const int low_row = std::max((std::min(from.y, to.y) - corner_.y) >> cell_bits_, 0);
            const int high_row = std::min((std::max(from.y, to.y) - corner_.y) >> cell_bits_, side_ - 1);
            for (int row = low_row; row <= high_row; ++row)
                put_edge(column, row, {double(from.x), double(from.y), double(to.x), double(to.y)}, 0.0);
        }
        from = to;
    }
}

void BucketBuilder::add_stroke(Span<const Edge> edges, double half_width) {
    Rows covered;
    std::fill_n(covered.begin(), side_, 0);
    for (const Edge& edge : edges)
        put_stroke(edge, half_width, covered);
    close(covered);
}

void BucketBuilder::put_stroke(const Edge& edge, double half_width, Rows& covered) {
    const double size = std::ldexp(1.0, cell_bits_), reach = half_width + 1.0;
    const std::array<double, 4> ends = {double(edge.a.x) - corner_.x, double(edge.a.y) - corner_.y,
                                        double(edge.b.x) - corner_.x, double(edge.b.y) - corner_.y};
    const auto place = [&](double offset) {
        return static_cast<int>(std::clamp(std::floor(offset / size), 0.0, double(side_ - 1)));
    };
    const double slope = ends[2] > ends[0] ? (ends[3] - ends[1]) / (ends[2] - ends[0]) : 0.0;
    if (ends[2] + reach < 0.0 || ends[0] - reach > size * side_)
        return;
    for (int column = place(ends[0] - reach); column <= place(ends[2] + reach); ++column) {
        // Of the segment what may reach the column.
        const double from = std::clamp(column * size - reach, ends[0], ends[2]);
        const double to = std::clamp((column + 1) * size + reach, ends[0], ends[2]);
        const bool is_upright = ends[2] == ends[0];
        const double y0 = is_upright ? ends[1] : ends[1] + slope * (from - ends[0]);
        const double y1 = is_upright ? ends[3] : ends[1] + slope * (to - ends[0]);
        if (std::max(y0, y1) + reach < 0.0 || std::min(y0, y1) - reach > size * side_)
            continue;
        for (int row = place(std::min(y0, y1) - reach); row <= place(std::max(y0, y1) + reach); ++row) {
            if ((covered[size_t(row)] >> column & 1) != 0)
                continue;
            const LatticePoint at = {corner_.x + (column << cell_bits_), corner_.y + (row << cell_bits_)};
            const int32_t side = 1 << cell_bits_;
            bool covers = half_width > 1.4 * size;
            for (int i = 0; covers && i < 4; ++i)
                covers = distance_to_segment({at.x + (i % 2) * side, at.y + (i / 2) * side}, edge.a, edge.b) <
                         half_width - 1.0;
            if (covers)
                covered[size_t(row)] |= uint64_t{1} << column;
            else
                put_edge(column, row,
                         {double(edge.a.x), double(edge.a.y), double(edge.b.x), double(edge.b.y)}, reach);
        }
    }
}

// Ends are places on the lattice. Where they are far out of the cell, floats would be too coarse for them.
void BucketBuilder::put_edge(int column, int row, const std::array<double, 4>& ends, double reach) {
    if ((done_[size_t(row)] >> column & 1) != 0) {
        note_hider(column, row);
        return;
    }
    if ((met_[size_t(row)] >> column & 1) == 0)
        put_header(column, row);
    met_[size_t(row)] |= uint64_t{1} << column;
    const double x = double(corner_.x) + std::ldexp(column, cell_bits_),
                 y = double(corner_.y) + std::ldexp(row, cell_bits_);
    std::array<double, 4> own = {ends[0] - x, ends[1] - y, ends[2] - x, ends[3] - y};
    const auto is_far = [](double value) { return std::abs(value) > exact; };
    if (std::any_of(own.begin(), own.end(), is_far))
        own = part_in(own, -reach - 1.0, std::ldexp(1.0, cell_bits_) + reach + 1.0);
    const auto cell = static_cast<uint32_t>(row * side_ + column);
    items_.push_back({cell, {{bits_of(own[0]), bits_of(own[1]), bits_of(own[2]), bits_of(own[3])}}});
    ++items_[last_[cell]].texel.words[0];
    ++lists_.edges;
}

void BucketBuilder::put_header(int column, int row) {
    const Style& style = styles_[slot_->slot];
    const auto cell = static_cast<uint32_t>(row * side_ + column);
    last_[cell] = static_cast<uint32_t>(items_.size());
    items_.push_back(
        {cell, {{style.is_fill() ? 0 : CELL_STROKE, slot_->slot, bits_of(double{style.half_width}), 0}}});
}

// The cells whose corners are inside of a fill, or that a stroke covers.
void BucketBuilder::close(const Rows& inside) {
    const Style& style = styles_[slot_->slot];
    const uint64_t columns = side_ == 64 ? ~uint64_t{0} : (uint64_t{1} << side_) - 1;
    const auto each = [](uint64_t cells, const auto& visit) {
        for (; cells != 0; cells &= cells - 1)
            visit(__builtin_ctzll(cells));
    };
    for (int row = 0; row < side_; ++row) {
        const uint64_t all = inside[size_t(row)] & columns, own = all & ~done_[size_t(row)];
        const uint64_t met = met_[size_t(row)];
        each(all & ~own & ~noted_[size_t(row)], [&](int column) { note_hider(column, row); });
        each(own, [&](int column) {
            if ((met >> column & 1) == 0)
                put_header(column, row);
            items_[last_[size_t(row * side_ + column)]].texel.words[0] |= CELL_INSIDE;
        });
        if (!style.is_opaque())
            continue;
        const uint64_t closed = style.is_fill() ? own & ~met : own;
        each(closed, [&](int column) { hiders_[size_t(row * side_ + column)] = slot_->slot; });
        done_[size_t(row)] |= closed;
    }
}

void BucketBuilder::note_hider(int column, int row) {
    if ((noted_[size_t(row)] >> column & 1) != 0)
        return;
    noted_[size_t(row)] |= uint64_t{1} << column;
    lists_.hiders.push_back(hiders_[size_t(row * side_ + column)]);
}

// Sorts the items by cells.
void BucketBuilder::write() {
    const size_t cells = last_.size(), first = lists_.cells.size(), texels = lists_.texels.size();
    lists_.buckets.push_back(static_cast<uint32_t>(first << CELL_LEVEL_BITS) | static_cast<uint32_t>(level_));
    begins_.assign(cells + 1, 0);
    for (const Item& item : items_)
        ++begins_[item.cell + 1];
    lists_.cells.resize(first + cells);
    for (size_t i = 0; i < cells; ++i) {
        lists_.longest = std::max(lists_.longest, begins_[i + 1]);
        begins_[i + 1] += begins_[i];
        // One more, as 0 is the empty list.
        lists_.cells[first + i] =
            begins_[i] == begins_[i + 1] ? 0 : static_cast<uint32_t>(texels + begins_[i] + 1);
        if (last_[i] != no_header)
            items_[last_[i]].texel.words[0] |= CELL_LAST;
    }
    lists_.texels.resize(texels + items_.size());
    for (const Item& item : items_)
        lists_.texels[texels + begins_[item.cell]++] = item.texel;
}

}  // namespace decalgl::loops
