// papilla._native: the public headers of the library as Python sees them, thin. The package around
// it (python/papilla) checks arrays and gives the names that people use.
#include "convert.h"

namespace {

namespace py = pybind11;

// papilla.errors.InputError, with every problem.
void raise_input_error(const papilla::InputError& error) {
  const py::module_ errors = py::module_::import("papilla.errors");
  py::list problems;
  for (const papilla::Problem& p : error.problems())
    problems.append(errors.attr("Problem")(p.file, p.line, p.column, p.key, p.message));
  PyErr_SetObject(errors.attr("InputError").ptr(), errors.attr("InputError")(problems).ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const papilla::InputError& error) {
    raise_input_error(error);
  } catch (const papilla::Stopped& stopped) {
    PyErr_SetString(py::module_::import("papilla.errors").attr("Stopped").ptr(), stopped.what());
  }
}

}  // namespace

PYBIND11_MODULE(_native, module) {
  module.doc() = "The library behind the package papilla; call the package.";
  py::register_exception_translator(translate);
  papilla::keep_freed_memory();
  module.attr("__version__") = papilla::version();
  module.def("in_si", &papilla::in_si, py::arg("text"), py::arg("unit"));
  module.def("quantity_text", &papilla::quantity_text, py::arg("si"), py::arg("unit"));
  module.def("si_unit", &papilla::si_unit, py::arg("unit"));
  papilla::python::bind_design(module);
  papilla::python::bind_response(module);
  papilla::python::bind_physics(module);
  papilla::python::bind_cases(module);
  papilla::python::bind_study(module);
  papilla::python::bind_trades(module);
  papilla::python::bind_lab(module);
}
