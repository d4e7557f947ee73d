// decalgl_demo: draws Honolulu over its mountains and says what the picture cost.
//
//     decalgl_demo [--data FOLDER] [--out honolulu.png] [--size 1920x1080] [--antialias coverage]
//
// Times go to standard output, progress and errors to standard error. Exit codes: 0 done, 2 an error.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <string_view>

#include "app/honolulu.h"
#include "app/png_file.h"
#include "decalgl/core/error.h"
#include "decalgl/frame/antialias.h"
#include "decalgl/frame/renderer.h"

namespace decalgl {
namespace {

constexpr int failed = 2;

struct Options {
    std::string data = "examples/data/honolulu";
    std::string out = "honolulu.png";
    std::string size = "1920x1080";
    std::string antialias = "coverage";
    std::string backend = "auto";
};

/// Sets the width and height of a text such as 1920x1080.
void parse_size(const std::string& text, RendererOptions& options) {
    int read = 0;
    const int found = std::sscanf(text.c_str(), "%6dx%6d%n", &options.width, &options.height, &read);
    if (found != 2 || static_cast<std::size_t>(read) != text.size() || options.width < 1 ||
        options.height < 1) {
        throw Error(
            ErrorKind::input,
            fmt::format("--size {} is not a size in pixels. Write it as WIDTHxHEIGHT, such as 1920x1080.",
                        text));
    }
}

/// One line that is written over on a terminal; one line a stage elsewhere.
class ProgressLine {
public:
    ~ProgressLine() { close(); }

    bool operator()(std::string_view stage, double fraction) {
        if (on_terminal_) {
            fmt::print(stderr, "\r{:<30}{:3.0f} %", stage, 100.0 * fraction);
            std::fflush(stderr);
            open_ = true;
        } else if (stage != stage_) {
            fmt::print(stderr, "{} ...\n", stage);
        }
        stage_ = stage;
        return true;
    }

    void close() {
        if (open_) {
            fmt::print(stderr, "\r{:<36}\r", "");
            open_ = false;
        }
    }

private:
    bool on_terminal_ = isatty(STDERR_FILENO) != 0;
    bool open_ = false;
    std::string stage_;
};

void print_layers(const Scene& scene) {
    fmt::print("{:<24}{:>10}{:>10}\n", "layer", "features", "vertices");
    for (const Layer& layer : scene.layers) {
        fmt::print("{:<24}{:>10}{:>10}\n", layer.name, layer.features.feature_count(),
                   layer.features.vertex_count());
    }
}

void print_cost(const TimingLog& timings, const FrameStats& stats, double write_ms) {
    fmt::print("\n{:<24}{:>10}\n", "stage", "ms");
    for (const TimedPass& stage : timings.passes()) {
        fmt::print("{:<24}{:>10.1f}\n", stage.name, stage.ms);
    }
    fmt::print("{:<24}{:>10.1f}\n", "preprocess", stats.preprocess_ms);
    fmt::print("{:<24}{:>10.1f}\n", "update", stats.update_ms);
    fmt::print("{:<24}{:>10.1f}\n", "render", stats.render_ms);
    fmt::print("{:<24}{:>10.1f}\n", "readback", stats.readback_ms);
    fmt::print("{:<24}{:>10.1f}\n", "write picture", write_ms);
    fmt::print("\n{:<24}{:>10}\n", "pass", "ms");
    for (const TimedPass& pass : stats.passes) {
        fmt::print("{:<24}{:>10.1f}\n", pass.name, pass.ms);
    }
}

void draw(const Options& options) {
    RendererOptions renderer_options;
    parse_size(options.size, renderer_options);
    renderer_options.antialias = antialias_named(options.antialias);
    renderer_options.backend = options.backend;
    Renderer renderer(renderer_options);
    if (!std::filesystem::is_directory(options.data)) {
        throw Error(ErrorKind::file,
                    fmt::format("There is no folder '{}' to read the scene from. Run this from the "
                                "project's own folder, or name examples/data/honolulu with --data.",
                                options.data));
    }

    ProgressLine line;
    const ProgressFn progress = std::ref(line);
    TimingLog timings;
    const Scene scene = build_honolulu(options.data, progress, timings);
    renderer.preprocess(scene, progress);
    renderer.update(honolulu_camera());
    const Frame frame = renderer.render();
    const Stopwatch watch;
    write_png(options.out, frame.width(), frame.height(), frame.image());
    const double write_ms = watch.milliseconds();
    line.close();

    print_layers(scene);
    print_cost(timings, frame.stats(), write_ms);
    fmt::print("\nThe picture is at {}\n", options.out);
}

int run(int count, char** arguments) {
    Options options;
    CLI::App app("Draws the land cover of Honolulu over its mountains, with isolines.", "decalgl_demo");
    app.add_option("--data", options.data, "Folder with dem.tif and landcover.topojson.gz")
        ->capture_default_str();
    app.add_option("--out", options.out, "The PNG file to write")->capture_default_str();
    app.add_option("--size", options.size, "Pixels")->capture_default_str();
    app.add_option("--antialias", options.antialias, "How edges are smoothed")
        ->check(CLI::IsMember({"none", "coverage", "ssaa", "msaa", "fxaa"}))
        ->capture_default_str();
    app.add_option("--backend", options.backend, "Where OpenGL comes from")
        ->check(CLI::IsMember({"auto", "egl", "osmesa"}))
        ->capture_default_str();
    try {
        app.parse(count, arguments);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : failed;
    }
    draw(options);
    return 0;
}

}  // namespace
}  // namespace decalgl

int main(int count, char** arguments) {
    try {
        return decalgl::run(count, arguments);
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "decalgl_demo: There is not enough memory. Try a smaller --size.\n");
    } catch (const std::exception& error) {
        fmt::print(stderr, "decalgl_demo: {}\n", error.what());
    }
    return decalgl::failed;
}
