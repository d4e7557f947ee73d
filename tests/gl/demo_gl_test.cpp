// The demo program draws its picture, and ends with code 2 and a message where it cannot.

#include <png.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const std::string program = DECALGL_DEMO_PROGRAM;
const fs::path data = DECALGL_DEMO_DATA;

/// A folder that goes away with the object.
struct TemporaryFolder {
    fs::path path = fs::temp_directory_path() / ("decalgl_demo_" + std::to_string(::getpid()));
    TemporaryFolder() { fs::create_directories(path); }
    ~TemporaryFolder() { fs::remove_all(path); }
};

/// The exit code; standard error is kept in a file.
int run(const std::string& arguments, const fs::path& messages) {
    const std::string command =
        "'" + program + "' " + arguments + " >/dev/null 2>'" + messages.string() + "'";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string text_of(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

struct Picture {
    unsigned width = 0;
    unsigned height = 0;
    std::vector<png_byte> pixels;

    explicit Picture(const fs::path& path) {
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        REQUIRE(png_image_begin_read_from_file(&image, path.c_str()) != 0);
        image.format = PNG_FORMAT_RGBA;
        pixels.resize(PNG_IMAGE_SIZE(image));
        REQUIRE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) != 0);
        width = image.width;
        height = image.height;
    }

    std::size_t count_colors() const {
        std::set<std::vector<png_byte>> colors;
        for (std::size_t i = 0; i < pixels.size(); i += 4) {
            colors.emplace(pixels.begin() + static_cast<std::ptrdiff_t>(i),
                           pixels.begin() + static_cast<std::ptrdiff_t>(i) + 4);
        }
        return colors.size();
    }
};

}  // namespace

TEST_CASE("the demo draws a picture of the size asked for") {
    const TemporaryFolder folder;
    for (const std::string antialias : {"none", "coverage", "ssaa", "msaa", "fxaa"}) {
        const fs::path out = folder.path / "new" / (antialias + ".png");
        REQUIRE(run("--data '" + data.string() + "' --size 160x90 --antialias " + antialias + " --out '" +
                        out.string() + "'",
                    folder.path / "messages") == 0);
        const Picture picture(out);
        CHECK(picture.width == 160);
        CHECK(picture.height == 90);
        CHECK(picture.count_colors() > 500);
        CHECK(picture.pixels[3] == 255);
    }
    CHECK_THAT(text_of(folder.path / "messages"), Catch::Contains("warp terrain"));
}

TEST_CASE("the demo says what is wrong and ends with code 2") {
    const TemporaryFolder folder;
    const fs::path messages = folder.path / "messages";
    const std::string small = "--size 16x9 --out '" + (folder.path / "no.png").string() + "' ";
    CHECK(run(small + "--data '" + folder.path.string() + "'", messages) == 2);
    CHECK_THAT(text_of(messages), Catch::Contains("dem.tif") && Catch::Contains("Check the path"));

    CHECK(run(small + "--data '" + (folder.path / "nowhere").string() + "'", messages) == 2);
    CHECK_THAT(text_of(messages), Catch::Contains("--data"));

    fs::copy_file(data / "dem.tif", folder.path / "dem.tif");
    CHECK(run(small + "--data '" + folder.path.string() + "'", messages) == 2);
    CHECK_THAT(text_of(messages), Catch::Contains("landcover.topojson.gz"));
    std::ofstream(folder.path / "landcover.topojson.gz") << "no gzip";
    CHECK(run(small + "--data '" + folder.path.string() + "'", messages) == 2);
    CHECK_THAT(text_of(messages), Catch::Contains("not a whole gzip file"));

    for (const std::string wrong :
         {"--size 16", "--size 0x9", "--size 16x9x", "--antialias smooth", "--unknown"}) {
        CHECK(run(wrong, messages) == 2);
    }
    const fs::path blocked = folder.path / "dem.tif" / "map.png";
    CHECK(run("--size 16x9 --data '" + data.string() + "' --out '" + blocked.string() + "'", messages) == 2);
    CHECK_THAT(text_of(messages), Catch::Contains("cannot be written"));
    CHECK(run("--help", messages) == 0);
}
