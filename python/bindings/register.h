// What each register_<area>.cpp adds to the module.
#pragma once

#include <pybind11/pybind11.h>

namespace decalgl::bindings {

void register_errors(pybind11::module_& module);
void register_styles(pybind11::module_& module);
void register_scene(pybind11::module_& module);
void register_loops(pybind11::module_& module);
void register_distance_field(pybind11::module_& module);
void register_renderer(pybind11::module_& module);
void register_doctor(pybind11::module_& module);
void register_bench(pybind11::module_& module);

}  // namespace decalgl::bindings
