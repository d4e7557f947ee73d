// Scrambled (0, m, 2)-nets, found by tools/sample_pattern.py: of all that it tries, those with the smallest
// error on straight edges. As the rows of the samples, column by column:
//
//     . . # .
//     # . . .        rows 2, 0, 3, 1, counted from below
//     . . . #
//     . # . .
#include "frame/sample_pattern.h"

#include <array>
#include <cstddef>

namespace decalgl {
namespace {

constexpr std::array<int, 1> rows_of_1{0};
constexpr std::array<int, 2> rows_of_2{1, 0};
constexpr std::array<int, 4> rows_of_4{2, 0, 3, 1};
constexpr std::array<int, 8> rows_of_8{6, 3, 0, 5, 2, 7, 4, 1};
constexpr std::array<int, 16> rows_of_16{3, 12, 7, 10, 0, 15, 5, 9, 2, 13, 6, 11, 1, 14, 8, 4};
constexpr std::array<int, 32> rows_of_32{3,  20, 8, 28, 25, 13, 5,  16, 31, 10, 0, 22, 15, 26, 18, 6,
                                         29, 9,  2, 21, 12, 24, 17, 4,  30, 11, 1, 23, 14, 27, 7,  19};

template <size_t Count>
std::vector<glm::vec2> placed(const std::array<int, Count>& rows) {
    std::vector<glm::vec2> offsets;
    for (size_t column = 0; column < Count; ++column)
        offsets.push_back((glm::vec2(column, rows[column]) + 0.5F) / static_cast<float>(Count) - 0.5F);
    return offsets;
}

}  // namespace

bool has_sample_pattern(int count) {
    return count >= 1 && count <= most_samples && (count & (count - 1)) == 0;
}

std::vector<glm::vec2> sample_pattern(int count) {
    switch (count) {
        case 2:
            return placed(rows_of_2);
        case 4:
            return placed(rows_of_4);
        case 8:
            return placed(rows_of_8);
        case 16:
            return placed(rows_of_16);
        case 32:
            return placed(rows_of_32);
        default:
            return placed(rows_of_1);
    }
}

}  // namespace decalgl
