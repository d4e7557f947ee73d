// Arrays between NumPy and the library.
#pragma once

#include <pybind11/numpy.h>

#include <vector>

#include "decalgl/core/span.h"

namespace decalgl::bindings {

// Row by row and of this type, converted where the caller's is not.
template <typename T>
using Array = pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast>;

template <typename T>
Span<const T> span_of(const Array<T>& array) {
    return {array.data(), static_cast<size_t>(array.size())};
}

template <typename T>
std::vector<T> vector_of(const Array<T>& array) {
    return std::vector<T>(array.data(), array.data() + array.size());
}

// A copy.
template <typename T>
pybind11::array_t<T> array_of(Span<const T> values) {
    return pybind11::array_t<T>(static_cast<pybind11::ssize_t>(values.size()), values.data());
}

}  // namespace decalgl::bindings
