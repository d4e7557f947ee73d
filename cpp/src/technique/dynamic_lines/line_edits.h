// Lines in another order, and with other features among them.
#pragma once

#include <memory>

#include "technique/dynamic_lines/prepared_lines.h"

namespace decalgl {

// With the features of a layer in another draw order, from bottom to top.
std::shared_ptr<PreparedLines> reordered(const PreparedLines& before, uint32_t layer,
                                         Span<const int64_t> draw_order, const MemoryAccount& memory);

}  // namespace decalgl
