// The joining of shader files, and the way back from the driver's line numbers.

#include "gl/shader_source.h"
#include "decalgl/core/error.h"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace decalgl;
using namespace decalgl::gl;

TEST_CASE("defines follow the version, and lines keep their numbers") {
    const StageText stage =
        assemble_stage("a.frag", "// purpose\n#version 450 core\nvoid main() {}\n", {"ONE"});
    CHECK(stage.files == std::vector<std::string>{"a.frag"});
    CHECK(stage.text == "// purpose\n#version 450 core\n#define ONE 1\n#line 3 0\nvoid main() {}\n");
}

TEST_CASE("a text without a version gets one") {
    const StageText stage = assemble_stage("a.frag", "void main() {}", {"ONE"});
    CHECK(stage.text == "#version 450 core\n#define ONE 1\n#line 1 0\nvoid main() {}\n");
}

TEST_CASE("an include is replaced by its file, once") {
    REQUIRE(!shader_manifest().empty());
    const std::string path(shader_manifest()[0].fragment);
    const std::string line = "#include \"" + path + "\"\n";
    REQUIRE(shader_source(path) != nullptr);
    const StageText stage = assemble_stage("a.frag", "#version 450\n" + line + line + "last\n", {});
    REQUIRE(stage.files.size() >= 2);
    CHECK(stage.files[1] == path);
    CHECK_THAT(stage.text, Catch::Contains("#line 1 1\n") && Catch::EndsWith("#line 3 0\n#line 4 0\nlast\n"));
}

TEST_CASE("a missing include names the line that asks for it") {
    CHECK_THROWS_WITH(assemble_stage("a.frag", "#version 450\n#include \"shared/none.glsl\"\n", {}),
                      Catch::Contains("a.frag:2") && Catch::Contains("shared/none.glsl"));
}

TEST_CASE("messages of every compiler are told by file and line") {
    const std::vector<std::string> files{"a.frag", "shared/b.glsl"};
    CHECK(translate_log("0:12(3): error: x\n", files) == "a.frag:12: error: x\n");
    CHECK(translate_log("1(7) : error C0000: x", files) == "shared/b.glsl:7: error C0000: x\n");
    CHECK(translate_log("ERROR: 1:7: 'x' : y\n", files) == "ERROR: shared/b.glsl:7: 'x' : y\n");
    CHECK(translate_log("9:1: z\nplain\n", files) == "9:1: z\nplain\n");
}
