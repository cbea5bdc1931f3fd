// papilla/cases.h
#include "convert.h"
#include "job.h"

namespace papilla::python {
namespace {

using namespace py::literals;

// Of each point whether it is so.
py::array_t<bool> flags(const std::vector<PerssonPoint>& list, bool PerssonPoint::*member) {
  py::array_t<bool> out(static_cast<py::ssize_t>(list.size()));
  bool* at = out.mutable_data();
  for (const PerssonPoint& p : list) *at++ = p.*member;
  return out;
}

py::dict points(const std::vector<PerssonPoint>& list) {
  const auto of = [&](double PerssonPoint::*member) {
    return column(list, [&](const PerssonPoint& p) { return p.*member; });
  };
  return py::dict(
      "voltage"_a = of(&PerssonPoint::voltage), "load"_a = of(&PerssonPoint::load),
      "frequency"_a = of(&PerssonPoint::frequency), "area_off"_a = of(&PerssonPoint::area_off),
      "area_on"_a = of(&PerssonPoint::area_on), "pressure"_a = of(&PerssonPoint::pressure),
      "pull"_a = of(&PerssonPoint::pull), "mean_gap"_a = of(&PerssonPoint::mean_gap),
      "friction"_a = of(&PerssonPoint::friction), "coefficient"_a = of(&PerssonPoint::coefficient),
      "capacitance"_a = of(&PerssonPoint::capacitance),
      "collapsed"_a = flags(list, &PerssonPoint::collapsed),
      "breaks_down"_a = flags(list, &PerssonPoint::breaks_down),
      "yielded"_a = flags(list, &PerssonPoint::yielded));
}

}  // namespace

void bind_cases(py::module_& module) {
  module.def(
      "persson",
      [](const std::string& file, const std::string& toml, const Design::Values& values) {
        const PerssonResult r =
            run_job([input = CaseInput{file, toml, values}](Job&) { return persson(input); });
        return py::dict(
            "rms"_a = r.rms, "slope"_a = r.slope, "contact_modulus"_a = r.contact_modulus,
            "collapsed"_a = r.point.collapsed, "breaks_down"_a = r.point.breaks_down,
            "yielded"_a = r.point.yielded, "point"_a = points({r.point}),
            "over_voltage"_a = points(r.over_voltage), "over_load"_a = points(r.over_load),
            "over_frequency"_a = points(r.over_frequency), "json"_a = r.json, "table"_a = r.table);
      },
      py::arg("file"), py::arg("toml"), py::arg("values"));
  module.def(
      "drive",
      [](const std::string& file, const std::string& toml, const Design::Values& values) {
        DriveResult r =
            run_job([input = CaseInput{file, toml, values}](Job&) { return drive(input); });
        return py::dict("period"_a = r.period, "source_voltage"_a = owned(r.source_voltage),
                        "current"_a = owned(r.current), "gap_voltage"_a = owned(r.gap_voltage),
                        "pull"_a = owned(r.pull), "friction"_a = owned(r.friction),
                        "line_frequency"_a = owned(r.line_frequency),
                        "line_amplitude"_a = owned(r.line_amplitude), "mean_pull"_a = r.mean_pull,
                        "distortion"_a = r.distortion, "json"_a = r.json, "table"_a = r.table);
      },
      py::arg("file"), py::arg("toml"), py::arg("values"));
}

}  // namespace papilla::python
