// Cameras, renderers and frames.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "decalgl/core/error.h"
#include "decalgl/frame/antialias.h"
#include "decalgl/frame/renderer.h"
#include "frame/prepared_file.h"
#include "register.h"

namespace py = pybind11;

namespace decalgl::bindings {
namespace {

using Vector = std::array<double, 3>;

glm::dvec3 to_glm(const Vector& v) {
    return {v[0], v[1], v[2]};
}

CoverageRule coverage_named(const std::string& name) {
    if (name == "exact")
        return CoverageRule::exact;
    if (name == "thoeny")
        return CoverageRule::thoeny;
    throw Error(ErrorKind::input, "there is no coverage '" + name + "'; choose exact or thoeny");
}

BvhOptions bvh_options(const py::dict& given) {
    BvhOptions options;
    options.cells = given["cells"].cast<int>();
    options.leaf_capacity = given["leaf_capacity"].cast<int>();
    options.depth_limit = given["depth_limit"].cast<int>();
    if (given["segment_order"].cast<std::string>() == "hilbert")
        options.segment_order = SegmentOrder::hilbert;
    if (given["composition"].cast<std::string>() == "nearest")
        options.composition = Composition::nearest;
    if (given["passes"].cast<std::string>() == "kind")
        options.passes = PassGrouping::kind;
    return options;
}

// A read-only view of a frame's values, which keeps the frame.
template <typename T>
py::array_t<T> view_of(const std::vector<T>& values, std::vector<py::ssize_t> shape,
                       const py::object& owner) {
    py::array_t<T> array(std::move(shape), values.data(), owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

// Progress is told with the interpreter held; an exception of the callback stops the work and comes back as
// it was.
void preprocess(Renderer& renderer, const Scene& scene, const py::object& progress,
                const std::string& cache) {
    ProgressFn callback;
    if (!progress.is_none()) {
        callback = [&progress](std::string_view stage, double fraction) {
            const py::gil_scoped_acquire interpreter;
            const py::object answer = progress(std::string(stage), fraction);
            return answer.is_none() || py::cast<bool>(answer);
        };
    }
    const py::gil_scoped_release others_may_run;
    renderer.preprocess(scene, callback, cache);
}

// Names come from files, where they may be no text.
py::str text_of(const std::string& text) {
    return py::reinterpret_steal<py::str>(
        PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace"));
}

// (name, kind, rows) of each, rows without copying them.
py::list list_of(const std::vector<PreparedLayer>& layers) {
    py::list list;
    for (const PreparedLayer& layer : layers) {
        auto* kept = new std::shared_ptr<const void>(layer.rows.storage());
        const py::capsule owner(kept,
                                [](void* held) { delete static_cast<std::shared_ptr<const void>*>(held); });
        py::array_t<int64_t> rows(static_cast<py::ssize_t>(layer.rows.size()), layer.rows.data(), owner);
        rows.attr("flags").attr("writeable") = false;
        list.append(py::make_tuple(text_of(layer.name),
                                   layer.kind == FeatureKind::lines ? "lines" : "polygons", rows));
    }
    return list;
}

std::array<double, 4> corners_of(const Bounds& bounds) {
    return {bounds.min_x, bounds.min_y, bounds.max_x, bounds.max_y};
}

py::dict description_of(const SavedScene& saved) {
    py::dict sections;
    for (const auto& [name, bytes] : saved.sections)
        sections[text_of(name)] = bytes;
    py::dict result;
    result["format"] = saved.format;
    result["bytes"] = saved.bytes;
    result["shape"] = py::make_tuple(saved.rows, saved.columns);
    result["bounds"] = py::tuple(py::cast(corners_of(saved.bounds)));
    result["layers"] = list_of(saved.layers);
    result["sections"] = sections;
    return result;
}

py::dict stats_of(const Frame& frame) {
    const FrameStats& stats = frame.stats();
    py::list passes;
    for (const TimedPass& pass : stats.passes) {
        py::dict entry;
        entry["name"] = pass.name;
        entry["ms"] = pass.ms;
        passes.append(entry);
    }
    py::dict preprocess;
    for (const TimedPass& pass : stats.preprocess)
        preprocess[py::str(pass.name)] = pass.ms;
    py::dict stages;
    stages["preprocess"] = stats.preprocess_ms;
    stages["update"] = stats.update_ms;
    stages["render"] = stats.render_ms;
    stages["readback"] = stats.readback_ms;
    py::dict bytes;
    for (const auto& [name, count] : stats.bytes)
        bytes[py::str(name)] = count;
    py::dict counts;
    for (const auto& [name, count] : stats.counts)
        counts[py::str(name)] = count;
    py::dict result;
    result["passes"] = passes;
    result["stages"] = stages;
    result["preprocess"] = preprocess;
    result["bytes"] = bytes;
    result["counts"] = counts;
    result["variants"] = stats.variants;
    return result;
}

template <typename Values>
auto frame_array(Values values, int components) {
    return [values, components](const py::object& self) {
        const auto& frame = py::cast<const Frame&>(self);
        std::vector<py::ssize_t> shape{frame.height(), frame.width()};
        if (components > 1)
            shape.push_back(components);
        return view_of((frame.*values)(), std::move(shape), self);
    };
}

void register_frame(py::module_& module) {
    py::class_<Frame>(module, "Frame")
        .def_property_readonly("image", frame_array(&Frame::image, 4))
        .def_property_readonly("ids", frame_array(&Frame::ids, 1))
        .def_property_readonly("layers", frame_array(&Frame::layers, 1))
        .def_property_readonly("depth", frame_array(&Frame::depth, 1))
        .def_property_readonly("world", frame_array(&Frame::world, 3))
        .def_property_readonly("stats", &stats_of)
        .def(
            "pick",
            [](const Frame& frame, int x, int y) {
                std::vector<std::pair<int32_t, int64_t>> picked;
                for (const PickedFeature& feature : frame.pick(x, y))
                    picked.emplace_back(feature.layer, feature.row);
                return picked;
            },
            py::arg("x"), py::arg("y"));
}

}  // namespace

void register_renderer(py::module_& module) {
    py::class_<Camera>(module, "Camera")
        .def(py::init([](const Vector& eye, const Vector& target, const Vector& up, double fov,
                         double view_height) {
                 Camera camera = Camera::look_at(to_glm(eye), to_glm(target), fov);
                 camera.up = to_glm(up);
                 camera.view_height = view_height;
                 return camera;
             }),
             py::arg("eye"), py::arg("target"), py::arg("up"), py::arg("fov"), py::arg("view_height"));

    register_frame(module);

    py::class_<Lens>(module, "Lens")
        .def(py::init([](double x, double y, double radius, std::vector<double> coordinates,
                         std::vector<int64_t> ring_offsets) {
                 return Lens{x, y, radius, std::move(coordinates), std::move(ring_offsets)};
             }),
             py::arg("x"), py::arg("y"), py::arg("radius"), py::arg("coordinates"), py::arg("ring_offsets"));

    py::class_<Renderer>(module, "Renderer")
        .def(py::init([](int width, int height, const std::string& antialias, double terrain_error,
                         uint64_t memory_limit, const std::string& backend, unsigned threads, int rectangle,
                         const std::string& index, const py::dict& bvh, const std::string& coverage,
                         int samples) {
                 RendererOptions options;
                 options.width = width;
                 options.height = height;
                 options.antialias = antialias_named(antialias);
                 options.samples = samples;
                 options.terrain_error = terrain_error;
                 options.memory_limit = memory_limit;
                 options.backend = backend;
                 options.threads = threads;
                 options.rectangle = rectangle;
                 options.index = index;
                 options.bvh = bvh_options(bvh);
                 options.coverage = coverage_named(coverage);
                 return Renderer(options);
             }),
             py::arg("width"), py::arg("height"), py::arg("antialias"), py::arg("terrain_error"),
             py::arg("memory_limit"), py::arg("backend"), py::arg("threads"), py::arg("rectangle"),
             py::arg("index"), py::arg("bvh"), py::arg("coverage") = "exact",
             py::arg("samples") = RendererOptions{}.samples)
        .def(
            "set_picture",
            [](Renderer& renderer, int width, int height, const std::string& antialias) {
                renderer.set_picture(width, height, antialias_named(antialias));
            },
            py::arg("width"), py::arg("height"), py::arg("antialias"))
        .def("preprocess", &preprocess, py::arg("scene"), py::arg("progress"), py::arg("cache") = "")
        .def("save", &Renderer::save, py::arg("path"), py::call_guard<py::gil_scoped_release>())
        .def("open", &Renderer::open, py::arg("path"), py::call_guard<py::gil_scoped_release>())
        .def("look", &Renderer::look, py::arg("layer"))
        .def("restyle", &Renderer::restyle, py::arg("looks"), py::call_guard<py::gil_scoped_release>())
        .def("edit", &Renderer::edit, py::arg("edit"), py::call_guard<py::gil_scoped_release>())
        .def("set_lens", &Renderer::set_lens, py::arg("lens"), py::arg("looks"),
             py::call_guard<py::gil_scoped_release>())
        .def("move_lens", &Renderer::move_lens, py::arg("lens"))
        .def("remove_lens", &Renderer::remove_lens)
        .def("layers", [](const Renderer& renderer) { return list_of(renderer.layers()); })
        .def("bounds",
             [](const Renderer& renderer) { return py::tuple(py::cast(corners_of(renderer.bounds()))); })
        .def(
            "update",
            [](Renderer& renderer, const Camera& camera) {
                const UpdateReport report = renderer.update(camera);
                py::dict result;
                result["pieces"] = report.pieces;
                result["bytes"] = report.bytes;
                result["longest_walk"] = report.longest_walk;
                result["shader_steps"] = report.shader_steps;
                return result;
            },
            py::arg("camera"))
        .def(
            "render",
            [](Renderer& renderer, const std::array<float, 4>& low, const std::array<float, 4>& high) {
                return renderer.render(Background{low, high});
            },
            py::arg("sky_low"), py::arg("sky_high"))
        .def("forget", &Renderer::forget, py::arg("ground"))
        .def("time_floor", &Renderer::time_floor)
        .def("count_fragments", &Renderer::count_fragments);

    module.def(
        "describe_saved_scene",
        [](const std::string& path) { return description_of(describe_saved_scene(path)); }, py::arg("path"));
    module.def("is_saved_scene", &is_saved_scene, py::arg("path"));
}

}  // namespace decalgl::bindings
