// Ways of anti-aliasing by name.
#pragma once

#include <string>

#include "decalgl/technique/technique.h"

namespace decalgl {

// Throws Error(input), which lists the names there are, for another one.
Antialias antialias_named(const std::string& name);

}  // namespace decalgl
