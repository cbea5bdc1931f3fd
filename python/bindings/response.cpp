// papilla/evaluate.h and papilla/differences.h
#include <array>
#include <limits>
#include <optional>

#include "convert.h"
#include "job.h"

namespace papilla::python {
namespace {

using namespace py::literals;

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

struct Part {
  const char* name;
  std::optional<double> ErrorParts::*part;
};
constexpr std::array kParts{
    Part{"grid", &ErrorParts::grid},         Part{"solver", &ErrorParts::solver},
    Part{"humidity", &ErrorParts::humidity}, Part{"method", &ErrorParts::method},
    Part{"field", &ErrorParts::field},       Part{"parameters", &ErrorParts::parameters},
    Part{"model", &ErrorParts::model},       Part{"water", &ErrorParts::water},
};

py::dict quantity_columns(const Response& r, Quantity Quantities<Quantity>::*q) {
  py::dict parts("sampling"_a =
                     column(r.points(), [&](const Point& p) { return (p.*q).parts.sampling; }));
  for (const Part& part : kParts) {
    parts[part.name] = column(r.points(), [&](const Point& p) {
      return ((p.*q).parts.*part.part).value_or(kNotMeasured);
    });
  }
  return py::dict(
      "value"_a = column(r.points(), [&](const Point& p) { return (p.*q).value; }),
      "error"_a = column(r.points(), [&](const Point& p) { return (p.*q).error; }),
      "parts"_a = parts,
      "numerical"_a = column(r.points(), [&](const Point& p) { return (p.*q).numerical; }),
      "model"_a =
          column(r.points(), [&](const Point& p) { return (p.*q).model.value_or(kNotMeasured); }));
}

// Plain arrays and texts: what a response is in Python, and what is pickled.
py::dict response_columns(const Response& r) {
  py::dict quantities;
  for (const auto& q : kQuantities<Quantity>) {
    if (q.drive != FingerDrive::On || r.driven()) quantities[q.name] = quantity_columns(r, q.value);
  }
  py::list sound, status;
  for (const Point& p : r.points()) {
    sound.append(p.sound);
    status.append(p.status);
  }
  return py::dict("relative_humidity"_a =
                      column(r.points(), [](const Point& p) { return p.relative_humidity; }),
                  "quantities"_a = quantities, "sound"_a = sound, "status"_a = status,
                  "driven"_a = r.driven(), "trouble"_a = r.trouble(), "json"_a = r.json(),
                  "table"_a = r.table(), "svg"_a = r.svg());
}

// Name, unit, whether it is of a drive alone, meaning.
py::list quantity_list() {
  py::list out;
  for (const auto& q : kQuantities<Quantity>)
    out.append(py::make_tuple(q.name, q.unit, q.drive == FingerDrive::On, q.doc));
  return out;
}

// level, target, threads, model, parameters, look, voltage_for, force: of papilla/evaluate.py.
EvaluateOptions options_of(const py::dict& d) {
  EvaluateOptions o;
  o.level = d["level"].cast<std::string>();
  o.target = d["target"].cast<double>();
  o.threads = d["threads"].cast<int>();
  o.model = d["model"].cast<bool>();
  o.parameters = d["parameters"].cast<bool>();
  o.look = d["look"].cast<bool>();
  o.voltage_for = d["voltage_for"].cast<std::vector<double>>();
  o.force = d["force"].cast<bool>();
  return o;
}

EvaluateOptions watched(EvaluateOptions options, Job& job) {
  options.stop = job.stop();
  options.progress = [&job](int done) {
    job.post([done](const py::object& progress) { progress(done); });
  };
  return options;
}

py::tuple difference_row(const Difference& d) {
  return py::make_tuple(d.value, d.error, d.paired, d.model.value_or(kNotMeasured),
                        d.above.value_or(kNotMeasured));
}

py::dict difference_columns(const std::vector<ComparedPoint>& points,
                            Difference ComparedPoint::*member) {
  py::list paired;
  for (const ComparedPoint& p : points) paired.append((p.*member).paired);
  return py::dict(
      "value"_a = column(points, [&](const ComparedPoint& p) { return (p.*member).value; }),
      "error"_a = column(points, [&](const ComparedPoint& p) { return (p.*member).error; }),
      "paired"_a = paired,
      "model"_a = column(
          points, [&](const ComparedPoint& p) { return (p.*member).model.value_or(kNotMeasured); }),
      "above"_a = column(points, [&](const ComparedPoint& p) {
        return (p.*member).above.value_or(kNotMeasured);
      }));
}

py::dict comparison_columns(const Comparison& c) {
  const bool driven = c.first.driven() && c.second.driven();
  py::dict out("first"_a = response_columns(c.first), "second"_a = response_columns(c.second),
               "friction_off"_a = difference_columns(c.points, &ComparedPoint::friction_off),
               "mean_friction"_a = difference_row(c.mean_friction));
  if (driven) {
    out["modulation"] = difference_columns(c.points, &ComparedPoint::modulation);
    out["friction_on"] = difference_columns(c.points, &ComparedPoint::friction_on);
    out["mean_modulation"] = difference_row(c.mean_modulation);
  }
  return out;
}

py::tuple sensitivity_row(const Sensitivity& s) {
  return py::make_tuple(s.path, s.unit, s.value, s.down, s.up, difference_row(s.change), s.slope,
                        s.slope_error);
}

}  // namespace

void bind_response(py::module_& module) {
  module.def("quantities", quantity_list);
  module.def(
      "evaluate",
      [](const Design& design, const py::dict& how, const py::object& progress) {
        return response_columns(run_job(
            [design, options = options_of(how)](Job& job) {
              return evaluate(design, watched(options, job));
            },
            progress));
      },
      py::arg("design"), py::arg("how"), py::arg("progress"));
  module.def(
      "compare",
      [](const Design& first, const Design& second, const py::dict& how,
         const py::object& progress) {
        return comparison_columns(run_job(
            [first, second, options = options_of(how)](Job& job) {
              return compare(first, second, watched(options, job));
            },
            progress));
      },
      py::arg("first"), py::arg("second"), py::arg("how"), py::arg("progress"));
  module.def(
      "sensitivity",
      [](const Design& design, const std::string& metric, const std::vector<std::string>& keys,
         double step, const py::dict& how, const py::object& progress) {
        const auto found = run_job(
            [design, metric, keys, step, options = options_of(how)](Job& job) {
              return sensitivity(design, metric, {keys, step, watched(options, job)});
            },
            progress);
        py::list out;
        for (const Sensitivity& s : found) out.append(sensitivity_row(s));
        return out;
      },
      py::arg("design"), py::arg("metric"), py::arg("keys"), py::arg("step"), py::arg("how"),
      py::arg("progress"));
}

}  // namespace papilla::python
