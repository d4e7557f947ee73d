// Strokes and fills: resolved styles as attributes and NumPy arrays.
#include <pybind11/stl.h>

#include "arrays.h"
#include "decalgl/vector/layer.h"
#include "decalgl/vector/layer_look.h"
#include "register.h"

namespace py = pybind11;

namespace decalgl::bindings {
namespace {

// A property of std::vector<T> that is written from an array.
template <typename Owner, typename T>
void def_array(py::class_<Owner>& owner, const char* name, std::vector<T> Owner::*member) {
    owner.def_property(
        name, [member](const Owner& self) { return array_of(Span<const T>(self.*member)); },
        [member](Owner& self, const Array<T>& array) { self.*member = vector_of(array); });
}

void register_stroke(py::module_& module) {
    py::class_<PatternMark>(module, "PatternMark")
        .def(py::init([](double begin, double end, double begin_width, double end_width) {
                 return PatternMark{begin, end, begin_width, end_width};
             }),
             py::arg("begin"), py::arg("end"), py::arg("begin_width"), py::arg("end_width"));
    py::class_<LinePattern>(module, "LinePattern")
        .def(py::init([](double period, double offset, std::vector<PatternMark> marks) {
                 return LinePattern{period, offset, std::move(marks)};
             }),
             py::arg("period"), py::arg("offset"), py::arg("marks"));
    py::class_<ColorBand>(module, "ColorBand")
        .def(py::init([](double reach, std::array<uint8_t, 4> color) {
                 return ColorBand{reach, color};
             }),
             py::arg("reach"), py::arg("color"));
    py::class_<StrokeStyle>(module, "StrokeStyle")
        .def(py::init<>())
        .def_readwrite("corner", &StrokeStyle::corner)
        .def_readwrite("cap", &StrokeStyle::cap)
        .def_readwrite("miter_limit", &StrokeStyle::miter_limit)
        .def_readwrite("slope_correction", &StrokeStyle::slope_correction)
        .def_readwrite("pattern", &StrokeStyle::pattern)
        .def_readwrite("bands", &StrokeStyle::bands);
    py::class_<Stroke> stroke(module, "Stroke");
    stroke.def(py::init<>())
        .def_readwrite("styles", &Stroke::styles)
        .def_readwrite("widest", &Stroke::widest)
        .def_property(
            "in_pixels", [](const Stroke& self) { return self.units == WidthUnits::pixels; },
            [](Stroke& self, bool in_pixels) {
                self.units = in_pixels ? WidthUnits::pixels : WidthUnits::metres;
            })
        .def_property(
            "limits",
            [](const Stroke& self) {
                const WidthLimits& limits = self.limits;
                return std::array<double, 4>{limits.least_px, limits.most_px, limits.least_metres,
                                             limits.most_metres};
            },
            [](Stroke& self, const std::array<double, 4>& limits) {
                self.limits = {limits[0], limits[1], limits[2], limits[3]};
            });
    def_array(stroke, "colors", &Stroke::colors);
    def_array(stroke, "widths", &Stroke::widths);
    def_array(stroke, "style_of", &Stroke::style_of);
}

}  // namespace

void register_styles(py::module_& module) {
    py::enum_<Corner>(module, "Corner")
        .value("round", Corner::round)
        .value("miter", Corner::miter)
        .value("bevel", Corner::bevel);
    py::enum_<Cap>(module, "Cap")
        .value("round", Cap::round)
        .value("butt", Cap::butt)
        .value("square", Cap::square);
    py::enum_<SlopeCorrection>(module, "SlopeCorrection")
        .value("none", SlopeCorrection::none)
        .value("thoeny", SlopeCorrection::thoeny)
        .value("tangent", SlopeCorrection::tangent);
    py::enum_<OutlineMode>(module, "OutlineMode")
        .value("normal", OutlineMode::normal)
        .value("inset", OutlineMode::inset)
        .value("offset", OutlineMode::offset);
    py::enum_<OutlineOrder>(module, "OutlineOrder")
        .value("layer", OutlineOrder::layer)
        .value("feature", OutlineOrder::feature);
    register_stroke(module);
    py::class_<Hatch>(module, "Hatch")
        .def(py::init([](double spacing, double width, double angle, bool crossed) {
                 return Hatch{spacing, width, angle, crossed};
             }),
             py::arg("spacing"), py::arg("width"), py::arg("angle"), py::arg("crossed"));
    py::class_<Fill> fill(module, "Fill");
    fill.def(py::init<>()).def_readwrite("hatches", &Fill::hatches);
    def_array(fill, "colors", &Fill::colors);
    def_array(fill, "hatch_of", &Fill::hatch_of);
    py::class_<DecalLook> decals(module, "DecalLook");
    decals.def(py::init<>())
        .def_readwrite("styles", &DecalLook::styles)
        .def_readwrite("hatches", &DecalLook::hatches);
    def_array(decals, "colors", &DecalLook::colors);
    def_array(decals, "widths", &DecalLook::widths);
    def_array(decals, "style_of", &DecalLook::style_of);
    def_array(decals, "hatch_of", &DecalLook::hatch_of);
    py::class_<LayerLook> look(module, "LayerLook");
    look.def(py::init<>())
        .def_readwrite("layer", &LayerLook::layer)
        .def_readwrite("fill", &LayerLook::fill)
        .def_readwrite("stroke", &LayerLook::stroke)
        .def_readwrite("casing", &LayerLook::casing)
        .def_property(
            "technique_options", [](const LayerLook& self) { return self.options; },
            [](LayerLook& self, std::shared_ptr<TechniqueOptions> options) {
                self.options = std::move(options);
            });
    def_array(look, "draw_order", &LayerLook::draw_order);
}

}  // namespace decalgl::bindings
