// Scenes: terrain and layers as NumPy arrays.
#include <pybind11/stl.h>

#include <algorithm>

#include "arrays.h"
#include "decalgl/core/error.h"
#include "decalgl/core/radix_sort.h"
#include "decalgl/frame/scene.h"
#include "decalgl/technique/clipmap_options.h"
#include "decalgl/technique/dynamic_options.h"
#include "decalgl/technique/volume_options.h"
#include "decalgl/vector/layer_edit.h"
#include "register.h"

namespace py = pybind11;

namespace decalgl::bindings {
namespace {

struct FeatureArrays {
    Array<double> coordinates;
    Array<int64_t> part_offsets;
    Array<int64_t> feature_offsets;
    Array<int64_t> rows;
};

// The arrays may be let go by a thread that does not hold the interpreter.
std::shared_ptr<const FeatureArrays> keep(FeatureArrays arrays) {
    return {new FeatureArrays(std::move(arrays)), [](const FeatureArrays* held) {
                const py::gil_scoped_acquire interpreter;
                delete held;
            }};
}

Heightfield make_terrain(const Array<float>& heights, double x0, double y0, double dx, double dy) {
    if (heights.ndim() != 2)
        throw Error(ErrorKind::input, "terrain: heights must have two dimensions");
    return Heightfield(vector_of(heights), static_cast<int32_t>(heights.shape(0)),
                       static_cast<int32_t>(heights.shape(1)), x0, y0, dx, dy);
}

void add_layer(Scene& scene, const std::string& name, const std::string& technique,
               const std::shared_ptr<const TechniqueOptions>& options, bool polygons,
               const Array<double>& coordinates, const Array<int64_t>& part_offsets,
               const Array<int64_t>& feature_offsets, const Array<int64_t>& rows, const Fill& fill,
               const Stroke& stroke, const Stroke& casing, OutlineMode outline_mode,
               OutlineOrder outline_order, const Array<int64_t>& draw_order) {
    if (coordinates.ndim() != 2 || coordinates.shape(1) != 2)
        throw Error(ErrorKind::input, "layer '" + name + "': coordinates must have the shape (vertices, 2)");
    if (std::any_of(rows.data(), rows.data() + rows.size(), [](int64_t row) { return row < 0; }))
        throw Error(ErrorKind::input, "layer '" + name + "': row numbers must be 0 or more");
    const auto arrays = keep({coordinates, part_offsets, feature_offsets, rows});
    Layer layer;
    layer.name = name;
    layer.technique = {technique, options};
    layer.features.kind = polygons ? FeatureKind::polygons : FeatureKind::lines;
    layer.features.coordinates = span_of(arrays->coordinates);
    layer.features.part_offsets = span_of(arrays->part_offsets);
    layer.features.feature_offsets = span_of(arrays->feature_offsets);
    layer.features.rows = span_of(arrays->rows);
    layer.features.storage = arrays;
    layer.fill = fill;
    layer.stroke = stroke;
    layer.casing = casing;
    layer.outline_mode = outline_mode;
    layer.outline_order = outline_order;
    layer.draw_order = vector_of(draw_order);
    validate(layer);
    scene.layers.push_back(std::move(layer));
}

void set_triangles(Scene& scene, size_t layer, const Array<double>& coordinates,
                   const Array<int64_t>& first_of) {
    if (layer >= scene.layers.size())
        throw Error(ErrorKind::input, "triangles: there is no such layer");
    const auto triangles = static_cast<int64_t>(coordinates.size()) / 6;
    const Span<const int64_t> offsets = span_of(first_of);
    if (offsets.size() != scene.layers[layer].features.feature_count() + 1 || offsets.front() != 0 ||
        offsets.back() != triangles || !std::is_sorted(offsets.begin(), offsets.end()))
        throw Error(ErrorKind::input, "triangles: their offsets must rise from 0 to their number");
    scene.layers[layer].triangles = {vector_of(coordinates), vector_of(first_of)};
}

LayerEdit make_edit(uint32_t layer, bool polygons, const Array<uint32_t>& removed,
                    const Array<uint32_t>& replaced, const Array<double>& coordinates,
                    const Array<int64_t>& part_offsets, const Array<int64_t>& feature_offsets,
                    const Array<int64_t>& rows) {
    LayerEdit edit;
    edit.layer = layer;
    edit.removed = vector_of(removed);
    edit.replaced = vector_of(replaced);
    edit.geometry =
        Features::own(polygons ? FeatureKind::polygons : FeatureKind::lines, vector_of(coordinates),
                      vector_of(part_offsets), vector_of(feature_offsets), vector_of(rows));
    return edit;
}

std::shared_ptr<DynamicOptions> make_dynamic_options(const std::string& method, const std::string& width_rule,
                                                     double cell) {
    auto options = std::make_shared<DynamicOptions>();
    if (method != "auto")
        options->method = method == "lists" ? LineMethod::lists : LineMethod::bins;
    options->width_rule = width_rule == "thesis" ? LineWidthRule::thesis : LineWidthRule::screen;
    options->cell = cell;
    return options;
}

}  // namespace

void register_scene(py::module_& module) {
    py::class_<Relief>(module, "Relief")
        .def(py::init<>())
        .def_readwrite("color", &Relief::color)
        .def_readwrite("ramp", &Relief::ramp)
        .def_readwrite("lowest", &Relief::lowest)
        .def_readwrite("highest", &Relief::highest)
        .def_readwrite("azimuth", &Relief::azimuth)
        .def_readwrite("altitude", &Relief::altitude)
        .def_readwrite("strength", &Relief::strength)
        .def_readwrite("on_layers", &Relief::on_layers);

    py::class_<LayerEdit>(module, "LayerEdit")
        .def(py::init(&make_edit), py::arg("layer"), py::arg("polygons"), py::arg("removed"),
             py::arg("replaced"), py::arg("coordinates"), py::arg("part_offsets"), py::arg("feature_offsets"),
             py::arg("rows"))
        .def_readwrite("fill", &LayerEdit::fill)
        .def_readwrite("stroke", &LayerEdit::stroke)
        .def_readwrite("casing", &LayerEdit::casing);

    py::class_<TechniqueOptions, std::shared_ptr<TechniqueOptions>>(module, "TechniqueOptions");
    py::class_<clipmap::ClipmapOptions, TechniqueOptions, std::shared_ptr<clipmap::ClipmapOptions>>(
        module, "ClipmapOptions")
        .def(py::init([](int solution, int joints, double bevel_below, double thin_below, double widest_line,
                         double widen_from, double widen_to, int window, int samples, int anisotropy,
                         int tiles_a_frame) {
                 clipmap::ClipmapOptions options;
                 options.solution = static_cast<clipmap::LineSolution>(solution);
                 options.joints = static_cast<clipmap::JointMethod>(joints);
                 options.bevel_below = bevel_below;
                 options.thin_below = thin_below;
                 options.widest_line = widest_line;
                 options.widen_from = widen_from;
                 options.widen_to = widen_to;
                 options.window = window;
                 options.samples = samples;
                 options.anisotropy = anisotropy;
                 options.tiles_a_frame = tiles_a_frame;
                 return options;
             }),
             py::arg("solution"), py::arg("joints"), py::arg("bevel_below"), py::arg("thin_below"),
             py::arg("widest_line"), py::arg("widen_from"), py::arg("widen_to"), py::arg("window"),
             py::arg("samples"), py::arg("anisotropy"), py::arg("tiles_a_frame"));
    py::class_<volume::VolumeOptions, TechniqueOptions, std::shared_ptr<volume::VolumeOptions>>(
        module, "VolumeOptions")
        .def(py::init([](bool exact, double arc_step) {
                 volume::VolumeOptions options;
                 options.grouping = exact ? volume::Grouping::exact : volume::Grouping::colors;
                 options.arc_step = arc_step;
                 return options;
             }),
             py::arg("exact"), py::arg("arc_step"));
    py::class_<DynamicOptions, TechniqueOptions, std::shared_ptr<DynamicOptions>>(module, "DynamicOptions")
        .def(py::init(&make_dynamic_options), py::arg("method"), py::arg("width_rule"), py::arg("cell"));

    py::class_<Scene>(module, "Scene")
        .def(py::init([](const Array<float>& heights, double x0, double y0, double dx, double dy,
                         double exaggeration, const Relief& relief) {
                 Scene scene;
                 scene.terrain = make_terrain(heights, x0, y0, dx, dy);
                 scene.exaggeration = exaggeration;
                 scene.relief = relief;
                 return scene;
             }),
             py::arg("heights"), py::arg("x0"), py::arg("y0"), py::arg("dx"), py::arg("dy"),
             py::arg("exaggeration"), py::arg("relief"))
        .def("add_layer", &add_layer, py::arg("name"), py::arg("technique"), py::arg("technique_options"),
             py::arg("polygons"), py::arg("coordinates"), py::arg("part_offsets"), py::arg("feature_offsets"),
             py::arg("rows"), py::arg("fill"), py::arg("stroke"), py::arg("casing"), py::arg("outline_mode"),
             py::arg("outline_order"), py::arg("draw_order"))
        .def("set_triangles", &set_triangles, py::arg("layer"), py::arg("coordinates"), py::arg("first_of"));
    module.def(
        "ascending", [](const Array<double>& keys) { return array_of<int64_t>(ascending(span_of(keys))); },
        py::arg("keys"),
        "The places of the keys from the least to the greatest; equal keys keep their order, NaN is as "
        "-inf.");
}

}  // namespace decalgl::bindings
