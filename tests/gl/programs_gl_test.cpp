// Every program of the manifest compiles and links, in every combination of its flags.

#include "gl_fixture.h"

#include "gl/program.h"
#include "gl/shader_source.h"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace decalgl;
using namespace decalgl::gl;

namespace {

/// All subsets of up to six flags; of more, none, all, each flag alone and each pair.
std::vector<Flags> combinations(Span<const std::string_view> flags) {
    std::vector<Flags> result;
    if (flags.size() <= 6) {
        for (std::size_t bits = 0; bits < (std::size_t{1} << flags.size()); ++bits) {
            Flags chosen;
            for (std::size_t index = 0; index < flags.size(); ++index) {
                if ((bits >> index & 1) != 0) {
                    chosen.emplace(flags[index]);
                }
            }
            result.push_back(chosen);
        }
        return result;
    }
    result.emplace_back();
    result.emplace_back(flags.begin(), flags.end());
    for (const std::string_view first : flags) {
        for (const std::string_view second : flags) {
            result.push_back({std::string(first), std::string(second)});
        }
    }
    return result;
}

}  // namespace

TEST_CASE("every program of the manifest compiles with every combination of its flags") {
    test::test_context();
    for (const ManifestProgram& program : shader_manifest()) {
        for (const Flags& flags : combinations(program.flags)) {
            INFO(variant_name(std::string(program.name), flags));
            CHECK_NOTHROW(Program::create(std::string(program.name), flags));
        }
    }
}

TEST_CASE("a library compiles each variant once, and refuses flags that are not in the manifest") {
    test::test_context();
    REQUIRE(!shader_manifest().empty());
    const std::string name(shader_manifest()[0].name);
    ProgramLibrary library;
    const Program& program = library.get(name);
    CHECK(&library.get(name) == &program);
    CHECK(library.variants() == std::vector<std::string>{name});
    CHECK_THROWS_AS(library.get(name, {"NO_SUCH_FLAG"}), Error);
    CHECK(library.variants().size() == 1);
}
