// The order in which decals are drawn: the groups of each list from the topmost down.
#pragma once

#include <vector>

#include "technique/static_decals/prepared_decals.h"

namespace decalgl {

// Sorts the groups of every list by rank, into words of their own.
void sort_lists(PreparedDecals& decals, const MemoryAccount& memory);

// A list's groups on their way into the order of their ranks.
class ListSorter {
public:
    explicit ListSorter(const PreparedDecals& decals) : decals_(decals) {}

    // `words` is a whole list; what follows its end stays.
    void sort(uint32_t* words, size_t count);

private:
    struct Group {
        uint32_t rank;
        size_t begin;
        size_t end;
    };

    const PreparedDecals& decals_;
    std::vector<Group> groups_;
    std::vector<uint32_t> sorted_;
};

}  // namespace decalgl
