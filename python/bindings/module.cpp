// decalgl._core: the table of contents. The public Python classes stand over it, in python/decalgl.
#include "register.h"

PYBIND11_MODULE(_core, module) {
    module.doc() = "The C++ core of decalgl. Use the classes of the package decalgl instead.";
    module.attr("__version__") = DECALGL_VERSION;
    decalgl::bindings::register_errors(module);
    decalgl::bindings::register_styles(module);
    decalgl::bindings::register_scene(module);
    decalgl::bindings::register_loops(module);
    decalgl::bindings::register_distance_field(module);
    decalgl::bindings::register_renderer(module);
    decalgl::bindings::register_doctor(module);
    decalgl::bindings::register_bench(module);
}
