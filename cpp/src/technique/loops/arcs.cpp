#include "technique/loops/arcs.h"

#include <algorithm>
#include <atomic>
#include <memory>

#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"
#include "decalgl/core/radix_sort.h"

namespace decalgl::loops {
namespace {

constexpr size_t most_points = size_t{1} << 29;  // prepared_loops.h packs their numbers with flags

// A run of a chain's locations, which may go past its end and on from its beginning.
struct Run {
    uint32_t chain;
    uint32_t first;
    uint32_t size;  // with both ends
    bool reversed;  // as the arc that it becomes goes
    ArcKind kind;
};

struct Use {
    uint32_t feature;
    uint32_t run;
    bool fills;
};

class Walk {
public:
    Walk(const NodedChains& noded, const Run& run) : chain_(noded.of(run.chain)), run_(run) {}
    uint32_t operator[](uint32_t i) const {
        const size_t place = run_.first + (run_.reversed ? run_.size - 1 - i : i);
        return chain_[place < chain_.size() ? place : place % chain_.size()];
    }

private:
    Span<const uint32_t> chain_;
    Run run_;
};

// Both directions of a run lead to one.
Run directed(const NodedChains& noded, Run run) {
    const Walk forward(noded, run);
    const uint32_t last = run.size - 1;
    const auto from_front = std::make_pair(forward[0], forward[1]);
    const auto from_back = std::make_pair(forward[last], forward[last - 1]);
    run.reversed = from_back < from_front;
    return run;
}

class RunCutter {
public:
    RunCutter(const NodedChains& noded, const std::vector<uint8_t>& junctions)
        : noded_(noded), junctions_(junctions) {}

    void cut(uint32_t chain, bool closed, std::vector<Run>& runs, LargeArray<uint32_t>& frame) {
        const Span<const uint32_t> own = noded_.of(chain);
        const auto size = static_cast<uint32_t>(own.size());
        frame.clear();
        stops_.clear();
        if (size == 1) {  // a dot: an edge from it to itself
            runs.push_back({chain, 0, 2, false, ArcKind::open});
            return;
        }
        for (uint32_t i = 0; i < size; ++i)
            if (junctions_[own[i]])
                stops_.push_back(i);
        if (closed && stops_.empty()) {
            const auto lowest = static_cast<uint32_t>(std::min_element(own.begin(), own.end()) - own.begin());
            runs.push_back(directed(noded_, {chain, lowest, size + 1, false, ArcKind::ring}));
            return;
        }
        for (size_t i = 0; i + (closed ? 0 : 1) < stops_.size(); ++i) {
            const uint32_t from = stops_[i], to = i + 1 < stops_.size() ? stops_[i + 1] : stops_[0] + size;
            runs.push_back(directed(noded_, {chain, from, to - from + 1, false, ArcKind::open}));
        }
        if (closed && stops_.size() >= 3)
            for (const uint32_t stop : stops_)
                frame.push_back(own[stop]);
    }

private:
    const NodedChains& noded_;
    const std::vector<uint8_t>& junctions_;
    std::vector<uint32_t> stops_;
};

struct Frame {
    uint32_t feature;
    LargeArray<uint32_t> junctions;
};

struct Cuts {
    std::vector<Run> runs;
    std::vector<uint32_t> features;  // of the runs
    std::vector<Frame> frames;
};

Cuts cut_chains(const Chains& chains, const NodedChains& noded, const std::vector<uint8_t>& junctions,
                unsigned threads) {
    constexpr size_t grain = 64;
    std::vector<Cuts> blocks(block_count(chains.count(), grain));
    parallel_for(chains.count(), grain, threads, [&](size_t begin, size_t end) {
        Cuts& block = blocks[begin / grain];
        RunCutter cutter(noded, junctions);
        LargeArray<uint32_t> frame;
        for (size_t chain = begin; chain < end; ++chain) {
            const bool closed = chains.closed[chain] && noded.of(chain).size() > 1;
            cutter.cut(static_cast<uint32_t>(chain), closed, block.runs, frame);
            block.features.resize(block.runs.size(), chains.features[chain]);
            if (!frame.empty())
                block.frames.push_back({chains.features[chain], frame});
        }
    });
    Cuts all;
    for (Cuts& block : blocks) {
        all.runs.insert(all.runs.end(), block.runs.begin(), block.runs.end());
        all.features.insert(all.features.end(), block.features.begin(), block.features.end());
        std::move(block.frames.begin(), block.frames.end(), std::back_inserter(all.frames));
        block = {};
    }
    return all;
}

// The arc of each run: its first two locations tell arcs apart. `firsts`: a run of each arc.
std::vector<uint32_t> number_arcs(const NodedChains& noded, const std::vector<Run>& runs,
                                  std::vector<uint32_t>& firsts, unsigned threads) {
    LargeArray<uint64_t> keys(runs.size());
    LargeArray<uint32_t> order(runs.size());
    for (size_t i = 0; i < runs.size(); ++i) {
        const Walk walk(noded, runs[i]);
        keys[i] = uint64_t{walk[0]} << 32 | walk[1];
        order[i] = static_cast<uint32_t>(i);
    }
    radix_sort(Span<uint64_t>(keys.data(), keys.size()), Span<uint32_t>(order.data(), order.size()), threads);
    // Numbered as they first come, which keeps what lies together in the input together here.
    std::vector<uint32_t> leaders(runs.size()), arcs(runs.size());
    for (size_t i = 0; i < order.size(); ++i)
        leaders[order[i]] = i > 0 && keys[i] == keys[i - 1] ? leaders[order[i - 1]] : order[i];
    for (uint32_t run = 0; run < runs.size(); ++run) {
        if (leaders[run] == run)
            firsts.push_back(run);
        arcs[run] = leaders[run] == run ? static_cast<uint32_t>(firsts.size() - 1) : arcs[leaders[run]];
    }
    return arcs;
}

void add_points(const NodedChains& noded, const Locations& locations, const Cuts& cuts,
                const std::vector<uint32_t>& firsts, Arcs& arcs, unsigned threads) {
    uint64_t total = 0;
    const auto add = [&](size_t size, ArcKind kind) {
        total += size;
        if (total > most_points)
            throw Error(ErrorKind::memory, "technique 'loops' holds at most " + std::to_string(most_points) +
                                               " vertices; draw fewer features, or use technique 'static'");
        arcs.offsets.push_back(static_cast<uint32_t>(total));
        arcs.kinds.push_back(kind);
    };
    for (const uint32_t run : firsts)
        add(cuts.runs[run].size, cuts.runs[run].kind);
    for (const Frame& frame : cuts.frames)
        add(frame.junctions.size() + 1, ArcKind::frame);
    arcs.points.resize(total);
    arcs.locations.resize(total);
    parallel_for(arcs.count(), 256, threads, [&](size_t begin, size_t end) {
        for (size_t arc = begin; arc < end; ++arc) {
            const auto write = [&](const auto& locations_of) {
                for (uint32_t i = 0; i < arcs.size_of(arc); ++i) {
                    arcs.locations[arcs.begin(arc) + i] = locations_of[i];
                    arcs.points[arcs.begin(arc) + i] = locations.place(locations_of[i]);
                }
            };
            if (arc < firsts.size()) {
                write(Walk(noded, cuts.runs[firsts[arc]]));
            } else {
                LargeArray<uint32_t> ring = cuts.frames[arc - firsts.size()].junctions;
                ring.push_back(ring[0]);
                write(ring);
            }
        }
    });
}

// Sorted lists of each feature: for strokes every arc once, for fills those that are there an odd number of times.
void add_uses(std::vector<uint64_t> uses, size_t features, bool is_odd, std::vector<uint64_t>& offsets,
              std::vector<uint32_t>& arcs) {
    std::sort(uses.begin(), uses.end());
    offsets.assign(features + 1, 0);
    for (size_t i = 0, next; i < uses.size(); i = next) {
        for (next = i; next < uses.size() && uses[next] == uses[i];)
            ++next;
        if (is_odd && (next - i) % 2 == 0)
            continue;
        ++offsets[static_cast<size_t>(uses[i] >> 32) + 1];
        arcs.push_back(static_cast<uint32_t>(uses[i]));
    }
    for (size_t i = 0; i < features; ++i)
        offsets[i + 1] += offsets[i];
}

}  // namespace

std::vector<uint8_t> find_junctions(const Chains& chains, const NodedChains& noded, size_t locations,
                                    unsigned threads) {
    // The two neighbours that a location was first seen between, the lower one first.
    constexpr uint64_t unseen = UINT64_MAX;
    const auto neighbours = std::make_unique<std::atomic<uint64_t>[]>(locations);
    parallel_for(locations, 1 << 16, threads, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            neighbours[i].store(unseen, std::memory_order_relaxed);
    });
    const auto found = std::make_unique<std::atomic<uint8_t>[]>(locations);
    const auto pass = [&](uint32_t location, uint32_t before, uint32_t after) {
        const uint64_t pair = uint64_t{std::min(before, after)} << 32 | std::max(before, after);
        uint64_t first = unseen;
        if (!neighbours[location].compare_exchange_strong(first, pair, std::memory_order_relaxed) &&
            first != pair)
            found[location].store(1, std::memory_order_relaxed);
    };
    parallel_for(chains.count(), 64, threads, [&](size_t begin, size_t end) {
        for (size_t chain = begin; chain < end; ++chain) {
            const Span<const uint32_t> own = noded.of(chain);
            const size_t size = own.size();
            if (!chains.closed[chain] || size == 1) {
                found[own[0]].store(1, std::memory_order_relaxed);
                found[own[size - 1]].store(1, std::memory_order_relaxed);
            } else {
                pass(own[0], own[size - 1], own[1]);
                pass(own[size - 1], own[size - 2], own[0]);
            }
            for (size_t i = 1; i + 1 < size; ++i)
                pass(own[i], own[i - 1], own[i + 1]);
        }
    });
    std::vector<uint8_t> junctions(locations);
    for (size_t i = 0; i < locations; ++i)
        junctions[i] = found[i].load(std::memory_order_relaxed);
    return junctions;
}

Arcs make_arcs(const Chains& chains, const NodedChains& noded, const Locations& locations, size_t features,
               unsigned threads) {
    const std::vector<uint8_t> junctions = find_junctions(chains, noded, locations.count(), threads);
    const Cuts cuts = cut_chains(chains, noded, junctions, threads);
    std::vector<uint32_t> firsts;
    const std::vector<uint32_t> numbers = number_arcs(noded, cuts.runs, firsts, threads);
    Arcs arcs;
    add_points(noded, locations, cuts, firsts, arcs, threads);
    arcs.chain_offsets.assign(chains.count() + 1, 0);
    for (size_t run = 0; run < cuts.runs.size(); ++run) {
        ++arcs.chain_offsets[cuts.runs[run].chain + 1];
        arcs.chain_arcs.push_back(2 * numbers[run] + (cuts.runs[run].reversed ? 1 : 0));
    }
    for (size_t chain = 0; chain < chains.count(); ++chain)
        arcs.chain_offsets[chain + 1] += arcs.chain_offsets[chain];
    std::vector<uint64_t> strokes, fills;
    for (size_t run = 0; run < cuts.runs.size(); ++run) {
        const uint64_t use = uint64_t{cuts.features[run]} << 32 | numbers[run];
        strokes.push_back(use);
        if (chains.closed[cuts.runs[run].chain])
            fills.push_back(use);
    }
    for (size_t i = 0; i < cuts.frames.size(); ++i)
        fills.push_back(uint64_t{cuts.frames[i].feature} << 32 | (firsts.size() + i));
    add_uses(std::move(strokes), features, false, arcs.stroke_offsets, arcs.stroke_arcs);
    add_uses(std::move(fills), features, true, arcs.fill_offsets, arcs.fill_arcs);
    return arcs;
}

KeptArcs kept(Arcs&& arcs) {
    KeptArcs result;
    result.points = std::move(arcs.points);
    result.offsets = std::move(arcs.offsets);
    result.kinds = std::move(arcs.kinds);
    result.fill_offsets = std::move(arcs.fill_offsets);
    result.stroke_offsets = std::move(arcs.stroke_offsets);
    result.fill_arcs = std::move(arcs.fill_arcs);
    result.stroke_arcs = std::move(arcs.stroke_arcs);
    return result;
}

}  // namespace decalgl::loops
