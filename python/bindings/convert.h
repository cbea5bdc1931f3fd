// Arrays, maps and texts between Python and the library.
#pragma once

#include <papilla/papilla.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

namespace papilla::python {

namespace py = pybind11;

// float64, C-contiguous; papilla/arrays.py has seen to it.
using Array = py::array_t<double, py::array::c_style>;

// z[y, x] with pixels of dx by dy [m].
inline Heights heights_of(const Array& z, double dx, double dy) {
  return {static_cast<int>(z.shape(1)), static_cast<int>(z.shape(0)), dx, dy,
          std::vector<double>(z.data(), z.data() + z.size())};
}

// A vector that an array owns from now on: no copy.
template <class T>
py::array_t<T> owned(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(std::move(shape), kept->data(), owner);
}
template <class T>
py::array_t<T> owned(std::vector<T> values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return owned(std::move(values), {count});
}
inline py::array_t<double> map_of(std::vector<double> values, int ny, int nx) {
  return owned(std::move(values), {ny, nx});
}

// Of each item one number.
template <class Items, class Number>
py::array_t<double> column(const Items& items, Number number) {
  std::vector<double> out;
  for (const auto& item : items) out.push_back(number(item));
  return owned(std::move(out));
}

// What each file of bindings adds.
void bind_design(py::module_& module);
void bind_response(py::module_& module);
void bind_physics(py::module_& module);
void bind_cases(py::module_& module);
void bind_study(py::module_& module);
void bind_trades(py::module_& module);
void bind_lab(py::module_& module);

}  // namespace papilla::python
