// The techniques there are: adding one is its folder and one line here.
#include <functional>
#include <map>

#include "decalgl/core/error.h"
#include "decalgl/technique/technique.h"
#include "technique/dynamic_lines/dynamic_lines.h"
#include "technique/loops/loops.h"
#include "technique/shadow_volumes/shadow_volumes.h"
#include "technique/distance_field/distance_field.h"
#include "technique/static_bvh/static_bvh.h"
#include "technique/static_decals/static_decals.h"

namespace decalgl {
namespace {

using MakeTechnique = std::function<std::unique_ptr<Technique>()>;

const std::map<std::string, MakeTechnique>& registry() {
    static const std::map<std::string, MakeTechnique> techniques = {
        {"loops", [] { return std::make_unique<Loops>(); }},
        {"dynamic", [] { return std::make_unique<DynamicLines>(); }},
        {"distance_field", [] { return std::make_unique<DistanceField>(); }},
        {"static", [] { return std::make_unique<StaticDecals>(); }},
        {"volume", [] { return std::make_unique<ShadowVolumes>(); }},
        {"static_bvh", [] { return std::make_unique<StaticBvh>(); }},
    };
    return techniques;
}

}  // namespace

std::vector<std::string> technique_names() {
    std::vector<std::string> names;
    for (const auto& entry : registry())
        names.push_back(entry.first);
    return names;
}

std::unique_ptr<Technique> make_technique(const std::string& name) {
    const auto found = registry().find(name);
    if (found != registry().end())
        return found->second();
    std::string known;
    for (const std::string& each : technique_names())
        known += (known.empty() ? "" : ", ") + each;
    throw Error(ErrorKind::input, "there is no technique '" + name + "'; choose one of: " + known);
}

}  // namespace decalgl
