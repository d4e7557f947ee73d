#include "technique/static_bvh/looks.h"
#include "technique/ground_lengths.h"

#include <cmath>
#include <cstring>

namespace decalgl::bvh {
namespace {

constexpr double degrees = M_PI / 180.0;

uint32_t bits_of(double value) {
    const auto narrowed = static_cast<float>(value);
    uint32_t bits = 0;
    std::memcpy(&bits, &narrowed, sizeof(bits));
    return bits;
}

uint32_t bytes_of(const std::array<uint8_t, 4>& color) {
    uint32_t bytes = 0;
    std::memcpy(&bytes, color.data(), sizeof(bytes));
    return bytes;
}

// A part of a turn as 64 bits; whole turns are left out.
uint64_t turn_bits(double turns) {
    const double part = turns - std::floor(turns);
    // Half of them at a time: a double has 53.
    const double high = std::floor(std::ldexp(part, 32));
    const double low = std::floor(std::ldexp(std::ldexp(part, 32) - high, 32));
    return (static_cast<uint64_t>(high) << 32) + static_cast<uint64_t>(low);
}

}  // namespace

uint32_t LookWriter::place_of(const DecalView& decal) {
    const bool stroke = decal.decal.is_stroke();
    const size_t style =
        stroke ? decal.stroke().style(decal.feature()) : decal.layer->fill.hatch(decal.feature());
    const auto [found, is_new] = places_.try_emplace({decal.layer, decal.decal.role, style}, 0);
    if (is_new)
        found->second = stroke ? write(decal.style()) : write(decal.hatch());
    return found->second;
}

uint32_t LookWriter::write(const StrokeStyle& style) {
    const auto place = static_cast<uint32_t>(group_.looks.size());
    const LinePattern& pattern = style.pattern;
    GroupNeeds& needs = group_.needs;
    needs.patterns |= pattern.period > 0.0;
    needs.ground |= follows_ground(style);
    needs.bands |= !style.bands.empty();
    needs.slopes |= style.slope_correction != SlopeCorrection::none;
    needs.corners |= needs.patterns || needs.bands || needs.slopes || style.corner != Corner::round ||
                     style.cap != Cap::round;
    for (const ColorBand& band : style.bands)
        needs.translucency |= band.color[3] != 255;
    const uint32_t kinds = static_cast<uint32_t>(style.corner) << LOOK_CORNER_SHIFT |
                           static_cast<uint32_t>(style.cap) << LOOK_CAP_SHIFT |
                           static_cast<uint32_t>(style.slope_correction) << LOOK_SLOPE_SHIFT |
                           static_cast<uint32_t>(pattern.marks.size()) << LOOK_MARKS_SHIFT |
                           static_cast<uint32_t>(style.bands.size()) << LOOK_BANDS_SHIFT;
    const double quanta = 1.0 / lattice_.quantum;
    group_.looks.push_back(
        {kinds, bits_of(std::cos(style.miter_limit * degrees)), bits_of(pattern.period * quanta), 0});
    for (const PatternMark& mark : pattern.marks)
        group_.looks.push_back({bits_of(mark.begin * quanta), bits_of(mark.end * quanta),
                                bits_of(mark.begin_width), bits_of(mark.end_width)});
    for (const ColorBand& band : style.bands)
        group_.looks.push_back({bits_of(band.reach), bytes_of(band.color), 0, 0});
    return place;
}

uint32_t LookWriter::write(const Hatch& hatch) {
    const auto place = static_cast<uint32_t>(group_.looks.size());
    const bool on = hatch.spacing > 0.0;
    group_.needs.hatches |= on;
    group_.looks.push_back({on ? hatch.crossed ? 2U : 1U : 0U, 0, 0, 0});
    if (on)
        write_set(hatch, hatch.angle + 90.0);
    if (on && hatch.crossed)
        write_set(hatch, hatch.angle);
    return place;
}

// Lines across a direction: turns are counted along it.
void LookWriter::write_set(const Hatch& hatch, double angle) {
    const double turns = 1.0 / hatch.spacing;
    const double x = std::cos(angle * degrees) * turns, y = std::sin(angle * degrees) * turns;
    const uint64_t right = turn_bits(x * lattice_.quantum), up = turn_bits(y * lattice_.quantum);
    const uint64_t origin = turn_bits(std::fmod(x * lattice_.left + y * lattice_.bottom, 1.0));
    const double half = std::min(0.5 * hatch.width * turns, 0.5);
    const auto word = [](uint64_t bits) { return static_cast<uint32_t>(bits >> 32); };
    group_.looks.push_back({word(right), static_cast<uint32_t>(right), word(up), static_cast<uint32_t>(up)});
    group_.looks.push_back({word(origin), static_cast<uint32_t>(std::ldexp(half, 32)), 0, 0});
}

StrokeLook stroke_look(const DecalGroup& group, uint32_t place) {
    const LookTexel* look = &group.looks[place];
    const uint32_t kinds = (*look)[0];
    const uint32_t marks = kinds >> LOOK_MARKS_SHIFT & LOOK_COUNT_MASK;
    return {static_cast<Corner>(kinds >> LOOK_CORNER_SHIFT & LOOK_KIND_MASK),
            static_cast<Cap>(kinds >> LOOK_CAP_SHIFT & LOOK_KIND_MASK),
            static_cast<SlopeCorrection>(kinds >> LOOK_SLOPE_SHIFT & LOOK_KIND_MASK),
            as_float((*look)[1]),
            as_float((*look)[2]),
            look + 1,
            marks,
            look + 1 + marks,
            kinds >> LOOK_BANDS_SHIFT & LOOK_COUNT_MASK};
}

bool hatch_holds(const DecalGroup& group, uint32_t place, LatticePoint point) {
    const LookTexel* look = &group.looks[place];
    const uint32_t sets = (*look)[0];
    bool holds = sets == 0;
    for (uint32_t set = 0; set < sets; ++set) {
        const LookTexel &steps = look[1 + 2 * set], &phases = look[2 + 2 * set];
        const uint64_t right = uint64_t{steps[0]} << 32 | steps[1], up = uint64_t{steps[2]} << 32 | steps[3];
        const uint64_t moved = right * static_cast<uint32_t>(point.x) + up * static_cast<uint32_t>(point.y);
        const uint32_t phase = phases[0] + static_cast<uint32_t>(moved >> 32);
        holds |= std::min(phase, ~phase + 1) <= phases[1];
    }
    return holds;
}

}  // namespace decalgl::bvh
