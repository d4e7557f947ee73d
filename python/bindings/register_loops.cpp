// LOOPS: its options, its levels of detail, and features as they are at a tolerance.
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "arrays.h"
#include "decalgl/core/error.h"
#include "decalgl/technique/loops_options.h"
#include "register.h"
#include "technique/loops/hierarchy.h"

namespace py = pybind11;

namespace decalgl::bindings {
namespace {

RemovalOrder order_named(const std::string& name) {
    for (const auto& [order, known] : {std::pair(RemovalOrder::douglas_peucker, "douglas_peucker"),
                                       std::pair(RemovalOrder::wang_mueller, "wang_mueller"),
                                       std::pair(RemovalOrder::visvalingam_whyatt, "visvalingam_whyatt")})
        if (name == known)
            return order;
    throw Error(ErrorKind::input, "there is no order '" + name + "'");
}

// Called with the interpreter let go, and let go itself by any thread.
RemovalFunction removal_function(const py::function& given) {
    const std::shared_ptr<const py::function> kept(new py::function(given), [](const py::function* held) {
        const py::gil_scoped_acquire interpreter;
        delete held;
    });
    return [kept](Span<const double> coordinates) {
        const py::gil_scoped_acquire interpreter;
        const auto vertices = static_cast<py::ssize_t>(coordinates.size() / 2);
        const py::array_t<double> points({vertices, py::ssize_t{2}}, coordinates.data());
        const auto answer = (*kept)(points).cast<std::pair<Array<int64_t>, Array<double>>>();
        std::vector<Removal> order;
        for (py::ssize_t i = 0; i < std::min(answer.first.size(), answer.second.size()); ++i)
            order.push_back(
                {static_cast<uint32_t>(std::clamp<int64_t>(answer.first.data()[i], 0, UINT32_MAX)),
                 answer.second.data()[i]});
        return order;
    };
}

LoopsDetail::Shows shows_named(const std::string& name) {
    return name == "tested"   ? LoopsDetail::Shows::tested
           : name == "active" ? LoopsDetail::Shows::active
                              : LoopsDetail::Shows::layers;
}

// Coordinates, part offsets and feature offsets at each tolerance.
py::list simplified(bool polygons, const Array<double>& coordinates, const Array<int64_t>& part_offsets,
                    const Array<int64_t>& feature_offsets, const std::array<double, 4>& corners,
                    const std::vector<double>& tolerances, const LoopsChoice& choice) {
    const FeatureKind kind = polygons ? FeatureKind::polygons : FeatureKind::lines;
    const Bounds bounds{corners[0], corners[1], corners[2], corners[3]};
    Layer layer;
    layer.features =
        Features::own(kind, vector_of(coordinates), vector_of(part_offsets), vector_of(feature_offsets));
    validate(layer.features, "features");
    validate(choice.options);
    std::vector<Features> all;
    {
        const py::gil_scoped_release others_may_run;
        Progress progress;
        const loops::Hierarchy hierarchy =
            loops::build_hierarchy(Span<const Layer>(&layer, 1), bounds, PositionGrid::around(bounds),
                                   Heightfield::flat(bounds, 0.0F), 0.0, choice.options, 0, progress);
        for (const double tolerance : tolerances)
            all.push_back(loops::simplified(hierarchy, 0, kind, tolerance));
    }
    py::list result;
    for (const Features& each : all)
        result.append(py::make_tuple(array_of(each.coordinates), array_of(each.part_offsets),
                                     array_of(each.feature_offsets)));
    return result;
}

}  // namespace

void register_loops(py::module_& module) {
    py::class_<DetailEye>(module, "DetailEye")
        .def(py::init<>())
        .def_readwrite("eye", &DetailEye::eye)
        .def_readwrite("forward", &DetailEye::forward)
        .def_readwrite("pixels", &DetailEye::pixels)
        .def_readwrite("corner", &DetailEye::corner)
        .def_readwrite("metres_per_pixel", &DetailEye::metres_per_pixel);

    py::class_<LoopsDetail>(module, "LoopsDetail")
        .def(py::init<>())
        .def_readwrite("uniform", &LoopsDetail::uniform)
        .def_readwrite("screen", &LoopsDetail::screen)
        .def_readwrite("lens", &LoopsDetail::lens)
        .def_readwrite("lens_centre", &LoopsDetail::lens_centre)
        .def_readwrite("lens_radius", &LoopsDetail::lens_radius)
        .def_readwrite("heat_top", &LoopsDetail::heat_top)
        .def("set_steps",
             [](LoopsDetail& detail, const std::vector<std::pair<double, double>>& steps) {
                 detail.steps.clear();
                 for (const auto& [distance, tolerance] : steps)
                     detail.steps.push_back({distance, tolerance});
             })
        .def("set_eye",
             [](LoopsDetail& detail, const DetailEye& eye) {
                 detail.has_eye = true;
                 detail.eye = eye;
             })
        .def("set_shows",
             [](LoopsDetail& detail, const std::string& name) { detail.shows = shows_named(name); });

    py::class_<LoopsBvh>(module, "LoopsBvh")
        .def(py::init<>())
        .def_readwrite("primary_branching", &LoopsBvh::primary_branching)
        .def_readwrite("node_capacity", &LoopsBvh::node_capacity)
        .def_readwrite("largest_share", &LoopsBvh::largest_share)
        .def_readwrite("secondary_depths", &LoopsBvh::secondary_depths)
        .def_readwrite("secondary_branching", &LoopsBvh::secondary_branching)
        .def_readwrite("coverage_depth", &LoopsBvh::coverage_depth)
        .def_readwrite("minimum_coverage", &LoopsBvh::minimum_coverage);

    py::class_<LoopsChoice, TechniqueOptions, std::shared_ptr<LoopsChoice>>(module, "LoopsChoice")
        .def(py::init([](const py::object& order, bool segments, const std::optional<LoopsBvh>& bvh,
                         const LoopsDetail& detail) {
                 LoopsChoice choice;
                 if (py::isinstance<py::str>(order)) {
                     choice.options.order = order_named(order.cast<std::string>());
                 } else {
                     choice.options.order = RemovalOrder::function;
                     choice.options.function = removal_function(order.cast<py::function>());
                 }
                 choice.options.primitives = segments ? LinePrimitives::segments : LinePrimitives::triangles;
                 choice.options.bvh = bvh;
                 choice.detail = detail;
                 validate(choice.options);
                 validate(choice.detail);
                 return choice;
             }),
             py::arg("order"), py::arg("segments"), py::arg("bvh"), py::arg("detail"));

    module.def("loops_simplified", &simplified, py::arg("polygons"), py::arg("coordinates"),
               py::arg("part_offsets"), py::arg("feature_offsets"), py::arg("bounds"), py::arg("tolerances"),
               py::arg("choice"));
}

}  // namespace decalgl::bindings
