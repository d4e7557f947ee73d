#include "technique/static_decals/ring_cells.h"

#include "technique/static_decals/ring_cuts.h"

namespace decalgl {
namespace {

// Bit i of the result is the parity of bits 0 .. i.
uint64_t running_parity(uint64_t bits) {
    for (int step = 1; step < 64; step *= 2)
        bits ^= bits << step;
    return bits;
}

uint64_t lowest_bits(int64_t count) {
    return count >= 64 ? ~uint64_t{0} : (uint64_t{1} << count) - 1;
}

}  // namespace

void RingCells::begin(uint32_t slot) {
    const int64_t last = (int64_t{1} << lists_->level()) - 1;
    cells_ = {cell_bits(lists_->level()), 0, 0, last, last};
    slot_ = slot;
    flags_ = 0;
    touched_ = nullptr;
    for (; crossed_columns_ != 0; crossed_columns_ &= crossed_columns_ - 1)
        crossed_rows_[static_cast<size_t>(__builtin_ctzll(crossed_columns_))] = 0;
    changed_columns_ = 0;
}

void RingCells::add_edge(LatticePoint from, LatticePoint to) {
    if (from == to)
        return;
    const int64_t column = to.x >> cells_.bits, row = to.y >> cells_.bits;
    const bool one_cell = from.x >> cells_.bits == column && from.y >> cells_.bits == row;
    if (one_cell) {
        if (column >= 0 && column <= cells_.last_column && row >= 0 && row <= cells_.last_row)
            add_piece({column, row, from, to});
        return;
    }
    pieces_.clear();
    const RingEdge edge(from, to);
    edge.cut(cells_, false, [&](int64_t c, int64_t r, LatticePoint a, LatticePoint b) {
        pieces_.push_back({c, r, a, b});
    });
    // In the ring's direction, so that a piece goes on where the last one ended.
    if (edge.reversed())
        for (size_t i = pieces_.size(); i-- > 0;)
            add_piece({pieces_[i].column, pieces_[i].row, pieces_[i].to, pieces_[i].from});
    else
        for (const Piece& piece : pieces_)
            add_piece(piece);
}

// What lies between the corners of the lowest row, walking along just above the border: pieces that rise from it. The
// corners themselves are just below it, so a level piece on the border lies between a corner and the walk.
void RingCells::follow_lowest_row(const Piece& piece) {
    const LatticePoint low = piece.from.y < piece.to.y ? piece.from : piece.to;
    if (low.y != 0)
        return;
    const int64_t left = cells_.border(piece.column);
    if (piece.from.y != piece.to.y) {
        // The first column whose corner is at the piece or to the right of it. The walk starts right of the first.
        if (low.x > 0)
            changed_columns_ ^= ~lowest_bits(((low.x - 1) >> cells_.bits) + 1);
    } else if ((piece.from.x == left) != (piece.to.x == left)) {
        changed_columns_ ^= piece.column == 0 ? ~uint64_t{1} : uint64_t{1} << piece.column;
    }
}

void RingCells::add_piece(const Piece& piece) {
    if (piece.row == 0)
        follow_lowest_row(piece);
    const LatticePoint from = piece.from, to = piece.to;
    const int64_t left = cells_.border(piece.column), bottom = cells_.border(piece.row);
    // Along a border nothing is crossed, on the way up the left one or on a row.
    if (from.x == to.x && (from.x == left || from.x == cells_.border(piece.column + 1)))
        return;
    const bool leaves_border = (from.x == left) != (to.x == left);
    if (leaves_border) {
        const auto column = static_cast<size_t>(piece.column);
        crossed_rows_[column] ^= uint64_t{1} << piece.row;
        crossed_columns_ |= uint64_t{1} << piece.column;
    } else if (from.y == to.y) {
        return;
    }
    const int64_t bias = cell_bias(lists_->level());
    const auto word = [&](LatticePoint point) {
        return static_cast<uint32_t>(point.x - left + bias) | static_cast<uint32_t>(point.y - bottom + bias)
                                                                  << COORDINATE_BITS;
    };
    const uint32_t cell = lists_->cell_at(piece.column, piece.row);
    if (touched_ == nullptr || (*touched_)[cell] != 0)
        lists_->add_edge(cell, slot_, flags_, word(from), word(to));
}

template <typename OnInside>
void RingCells::for_each_inside(bool bucket_corner_inside, OnInside on_inside) const {
    const int64_t side = cells_.last_column + 1;
    const uint64_t lowest_row = (bucket_corner_inside ? ~uint64_t{0} : 0) ^ changed_columns_;
    if (crossed_columns_ == 0 && (lowest_row & lowest_bits(side)) == 0)
        return;
    for (int64_t column = 0; column < side; ++column) {
        const uint64_t first = (lowest_row >> column & 1) != 0 ? ~uint64_t{0} : 0;
        uint64_t inside =
            (running_parity(crossed_rows_[static_cast<size_t>(column)]) << 1 ^ first) & lowest_bits(side);
        for (; inside != 0; inside &= inside - 1)
            on_inside(lists_->cell_at(column, __builtin_ctzll(inside)));
    }
}

void RingCells::finish(bool bucket_corner_inside) {
    for_each_inside(bucket_corner_inside, [&](uint32_t cell) { lists_->add_covers(cell, slot_, 0); });
}

void RingCells::begin_clip(uint32_t slot, const CellMask& touched) {
    begin(slot);
    flags_ = CLIP;
    touched_ = &touched;
}

CellMask RingCells::finish_clip(bool bucket_corner_inside, bool is_offset) {
    CellMask open(lists_->cell_count(), is_offset ? 1 : 0);
    for_each_inside(bucket_corner_inside, [&](uint32_t cell) { open[cell] = is_offset ? 0 : 1; });
    for (uint32_t cell = 0; cell < open.size(); ++cell) {
        if (!lists_->has_group(cell, slot_))
            continue;
        if (open[cell] != 0)
            lists_->add_covers(cell, slot_, CLIP);
        open[cell] = 1;
    }
    return open;
}

}  // namespace decalgl
