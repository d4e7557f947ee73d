// The yardsticks of the benchmarks.
#include <numeric>
#include <random>

#include "decalgl/core/parallel.h"
#include "decalgl/core/radix_sort.h"
#include "decalgl/core/timing.h"
#include "register.h"

namespace py = pybind11;

namespace decalgl::bindings {

void register_bench(py::module_& module) {
    module.def(
        "time_radix_sort",
        [](size_t count, unsigned threads) {
            std::vector<uint32_t> keys(count);
            std::vector<uint32_t> payload(count);
            std::mt19937 random(1);
            for (uint32_t& key : keys)
                key = random();
            std::iota(payload.begin(), payload.end(), 0U);
            const Stopwatch watch;
            radix_sort(keys, payload, threads);
            return watch.milliseconds();
        },
        py::arg("count"), py::arg("threads"),
        "Milliseconds to sort random 32-bit keys with a 32-bit payload.");
}

}  // namespace decalgl::bindings
