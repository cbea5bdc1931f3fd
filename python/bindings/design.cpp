// papilla/design.h
#include <optional>

#include "convert.h"
#include "job.h"

namespace papilla::python {
namespace {

// A view of the library's own memory, which lives as long as the array.
py::array_t<double> view(const py::object& self) {
  auto& h = self.cast<Heights&>();
  return py::array_t<double>({h.ny, h.nx}, h.z.data(), self);
}

py::tuple number_row(const Number& n) {
  return py::make_tuple(n.path, n.unit, n.meaning, n.value, n.low, n.high);
}

py::dict look_row(const Look& look) {
  using namespace py::literals;
  return py::dict("haze"_a = look.haze, "transmittance"_a = look.transmittance,
                  "total_transmittance"_a = look.total_transmittance, "gloss"_a = look.gloss,
                  "gloss_20"_a = look.gloss_20, "gloss_85"_a = look.gloss_85,
                  "distinctness"_a = look.distinctness, "sparkle"_a = look.sparkle,
                  "colour_shift"_a = look.colour_shift, "regime"_a = look.regime,
                  "warning"_a = look.warning);
}

}  // namespace

void bind_design(py::module_& module) {
  py::class_<Heights>(module, "Heights")
      .def_readonly("dx", &Heights::dx)
      .def_readonly("dy", &Heights::dy)
      .def_property_readonly("z", &view);

  py::class_<Design>(module, "Design")
      .def_static("read", &Design::read, py::arg("file"), py::arg("values"))
      .def_static(
          "parse",
          [](const std::string& toml, const Design::Values& values) {
            return Design::parse(toml, values);
          },
          py::arg("toml"), py::arg("values"))
      .def_static(
          "parse_drawn",
          [](const std::string& toml, const Array& z, double dx, double dy) {
            return Design::parse(toml, heights_of(z, dx, dy));
          },
          py::arg("toml"), py::arg("z"), py::arg("dx"), py::arg("dy"))
      .def_static(
          "from_heights",
          [](const Array& z, double dx, double dy, const Design::Values& values, bool repeats) {
            return Design::from_heights(heights_of(z, dx, dy), values, repeats);
          },
          py::arg("z"), py::arg("dx"), py::arg("dy"), py::arg("values"), py::arg("repeats"))
      .def(
          "with_",
          [](const Design& self, const Design::Values& values) { return self.with(values); },
          py::arg("values"))
      .def("require_simulated", &Design::require_simulated)
      .def("number", &Design::number, py::arg("path"))
      .def("numbers",
           [](const Design& self) {
             py::list out;
             for (const Number& n : self.numbers()) out.append(number_row(n));
             return out;
           })
      .def("title", &Design::title)
      .def("toml", &Design::toml)
      .def("drawn",
           [](const Design& self) -> std::optional<Heights> {
             return self.drawn() ? std::optional(*self.drawn()) : std::nullopt;
           })
      .def(
          "heights",
          [](const Design& self, int pixels) {
            return run_job([self, pixels](Job&) { return self.heights(pixels); });
          },
          py::arg("pixels"))
      .def("look", [](const Design& self) {
        return look_row(run_job([self](Job&) { return self.look(); }));
      });

  module.def(
      "look",
      [](const Array& z, double dx, double dy, double index, double fill_index,
         const std::vector<double>& angles) {
        return look_row(run_job([h = heights_of(z, dx, dy), index, fill_index, angles](Job&) {
          return look(h, {index, fill_index, angles});
        }));
      },
      py::arg("z"), py::arg("dx"), py::arg("dy"), py::arg("index"), py::arg("fill_index"),
      py::arg("angles"));
}

}  // namespace papilla::python
