// What can draw on this machine.
#include <pybind11/stl.h>

#include "gl/context.h"
#include "register.h"

namespace py = pybind11;

namespace decalgl::bindings {

void register_doctor(py::module_& module) {
    module.def("probe_backends", [] {
        py::list probes;
        for (const gl::Probe& probe : gl::probe_backends()) {
            py::dict entry;
            entry["name"] = probe.name;
            entry["ok"] = probe.ok;
            entry["detail"] = probe.detail;
            entry["cure"] = probe.cure;
            entry["max_texture_size"] = probe.info.max_texture_size;
            entry["max_texture_buffer_size"] = probe.info.max_texture_buffer_size;
            entry["missing_features"] = probe.info.missing_features;
            probes.append(entry);
        }
        return probes;
    });
}

}  // namespace decalgl::bindings
