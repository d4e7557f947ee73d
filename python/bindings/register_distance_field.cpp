// The options of the technique "distance_field".
#include <pybind11/stl.h>

#include "arrays.h"
#include "decalgl/technique/distance_field_options.h"
#include "register.h"

namespace py = pybind11;

namespace decalgl::bindings {
namespace {

NetworkRaster make_raster(const Array<uint8_t>& texels) {
    if (texels.ndim() != 3 || texels.shape(2) != 4)
        return {};
    return {static_cast<int>(texels.shape(1)), static_cast<int>(texels.shape(0)), vector_of(texels)};
}

void set_lod_texels(LevelOfDetail& lod, const Array<uint8_t>& texels) {
    if (texels.ndim() != 2)
        return;
    lod.height = static_cast<int>(texels.shape(0));
    lod.width = static_cast<int>(texels.shape(1));
    lod.texels = vector_of(texels);
}

void register_categories(py::module_& module) {
    py::class_<NetworkStyle>(module, "NetworkStyle")
        .def(py::init<>())
        .def_readwrite("lod", &NetworkStyle::lod)
        .def_readwrite("width", &NetworkStyle::width)
        .def_readwrite("main", &NetworkStyle::main)
        .def_readwrite("main_color", &NetworkStyle::main_color)
        .def_readwrite("border_color", &NetworkStyle::border_color)
        .def_readwrite("texture_share", &NetworkStyle::texture_share);
    py::class_<NetworkCategory>(module, "NetworkCategory")
        .def(py::init<>())
        .def_readwrite("name", &NetworkCategory::name)
        .def_readwrite("styles", &NetworkCategory::styles)
        .def_readwrite("caps", &NetworkCategory::caps)
        .def_readwrite("slope_correction", &NetworkCategory::slope_correction)
        .def_readwrite("pattern", &NetworkCategory::pattern)
        .def_readwrite("raster", &NetworkCategory::raster)
        .def_readwrite("raster_length", &NetworkCategory::raster_length)
        .def_property(
            "sketch",
            [](const NetworkCategory& self) { return std::pair(self.sketch.amplitude, self.sketch.length); },
            [](NetworkCategory& self, std::pair<double, double> sketch) {
                self.sketch = {sketch.first, sketch.second};
            });
}

void register_enums(py::module_& module) {
    py::enum_<LodSource>(module, "LodSource")
        .value("value", LodSource::value)
        .value("distance", LodSource::distance)
        .value("texture", LodSource::texture);
    py::enum_<LodSpace>(module, "LodSpace")
        .value("map", LodSpace::map)
        .value("screen", LodSpace::screen)
        .value("camera", LodSpace::camera);
    py::enum_<LodPlace>(module, "LodPlace")
        .value("fragment", LodPlace::fragment)
        .value("vertex", LodPlace::vertex);
    py::enum_<FieldBlending>(module, "FieldBlending")
        .value("minimum", FieldBlending::minimum)
        .value("nearest", FieldBlending::nearest);
    py::enum_<DropOff>(module, "DropOff").value("texture", DropOff::texture).value("exact", DropOff::exact);
    py::enum_<Borders>(module, "Borders")
        .value("over", Borders::over)
        .value("under", Borders::under)
        .value("smooth", Borders::smooth);
}

}  // namespace

void register_distance_field(py::module_& module) {
    register_enums(module);
    register_categories(module);
    py::class_<LevelOfDetail>(module, "LevelOfDetail")
        .def(py::init<>())
        .def_readwrite("source", &LevelOfDetail::source)
        .def_readwrite("value", &LevelOfDetail::value)
        .def_readwrite("near", &LevelOfDetail::near)
        .def_readwrite("far", &LevelOfDetail::far)
        .def_readwrite("space", &LevelOfDetail::space)
        .def_readwrite("extent", &LevelOfDetail::extent)
        .def("set_texels", &set_lod_texels, py::arg("texels"));

    py::class_<DistanceFieldOptions, TechniqueOptions, std::shared_ptr<DistanceFieldOptions>>(
        module, "DistanceFieldOptions")
        .def(py::init<>())
        .def_readwrite("categories", &DistanceFieldOptions::categories)
        .def_readwrite("lod", &DistanceFieldOptions::lod)
        .def_readwrite("widths_at", &DistanceFieldOptions::widths_at)
        .def_readwrite("bits", &DistanceFieldOptions::bits)
        .def_readwrite("drop_off", &DistanceFieldOptions::drop_off)
        .def_readwrite("blending", &DistanceFieldOptions::blending)
        .def_readwrite("borders", &DistanceFieldOptions::borders)
        .def_readwrite("keep_depth", &DistanceFieldOptions::keep_depth)
        .def_readwrite("mend_intrusion", &DistanceFieldOptions::mend_intrusion)
        .def_readwrite("mend_protrusion", &DistanceFieldOptions::mend_protrusion)
        .def(
            "set_category_of",
            [](DistanceFieldOptions& self, const Array<uint32_t>& category_of) {
                self.category_of = vector_of(category_of);
            },
            py::arg("category_of"))
        .def(
            "add_raster",
            [](DistanceFieldOptions& self, const Array<uint8_t>& texels) {
                self.rasters.push_back(make_raster(texels));
            },
            py::arg("texels"))
        .def(
            "add_drop_off",
            [](DistanceFieldOptions& self, const Array<uint8_t>& texels) {
                self.drop_offs.push_back(vector_of(texels));
            },
            py::arg("texels"));
}

}  // namespace decalgl::bindings
