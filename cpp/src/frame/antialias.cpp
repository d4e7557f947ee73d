#include "decalgl/frame/antialias.h"

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

struct NamedMode {
    const char* name;
    Antialias mode;
};

constexpr NamedMode modes[] = {{"none", Antialias::none},
                               {"coverage", Antialias::coverage},
                               {"ssaa", Antialias::ssaa},
                               {"msaa", Antialias::msaa},
                               {"fxaa", Antialias::fxaa}};

}  // namespace

Antialias antialias_named(const std::string& name) {
    std::string known;
    for (const NamedMode& each : modes) {
        if (name == each.name)
            return each.mode;
        known += known.empty() ? each.name : std::string(", ") + each.name;
    }
    throw Error(ErrorKind::input, "there is no antialias '" + name + "'; choose one of " + known);
}

}  // namespace decalgl
