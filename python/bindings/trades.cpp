// papilla/rank.h, papilla/calibrate.h, papilla/files.h and papilla/scan.h
#include "convert.h"
#include "job.h"

namespace papilla::python {
namespace {

using namespace py::literals;

std::function<void(const std::string&)> noted(Job& job) {
  return [&job](const std::string& text) {
    job.post([text](const py::object& progress) { progress(text); });
  };
}

py::dict ranking_row(const Ranking& ranking) {
  py::list states;
  for (const std::vector<Ranked>& state : ranking.states) {
    py::list rows;
    for (const Ranked& r : state)
      rows.append(py::make_tuple(r.index, r.rank, r.p_best_by, r.score, r.low, r.high, r.p_best));
    states.append(rows);
  }
  return py::dict("states"_a = states, "table"_a = ranking.table, "json"_a = ranking.json);
}

py::dict calibration_row(const CalibrateResult& r) {
  py::list parameters;
  for (const FittedParameter& p : r.parameters)
    parameters.append(py::make_tuple(p.path, p.value, p.error, p.low, p.high, p.data_share));
  return py::dict("converged"_a = r.converged, "explains_data"_a = r.explains_data,
                  "warning"_a = r.warning, "parameters"_a = parameters,
                  "chi2_before"_a = r.chi2_before, "chi2"_a = r.chi2,
                  "degrees_of_freedom"_a = r.degrees_of_freedom, "finger"_a = r.finger,
                  "table"_a = r.table, "json"_a = r.json);
}

py::tuple verdict_row(const FolderVerdict& v) {
  py::list files;
  for (const FileVerdict& f : v.files) files.append(py::make_tuple(f.path, f.sound, f.faults));
  const py::dict felt("min_hole"_a = v.verdict.min_hole, "min_wall"_a = v.verdict.min_wall,
                      "design"_a = v.verdict.design, "file"_a = v.verdict.file,
                      "loss"_a = v.verdict.loss, "faults"_a = v.verdict.faults);
  return py::make_tuple(v.folder, v.sound(), files, v.felt ? py::object(felt) : py::none());
}

py::tuple scan_row(const Scan& scan) {
  return py::make_tuple(scan.heights, scan.changes, scan.json);
}

}  // namespace

void bind_trades(py::module_& module) {
  module.def(
      "rank",
      [](const std::vector<Design>& designs, const std::string& by,
         const std::vector<double>& weights, const std::string& states, int max_skins, int threads,
         bool parameters, bool any_conditions, bool force, const std::vector<std::string>& names,
         const py::object& progress) {
        return ranking_row(run_job(
            [=](Job& job) {
              return rank(designs, {by, weights, states, max_skins, threads, parameters,
                                    any_conditions, force, names, noted(job), job.stop()});
            },
            progress));
      },
      py::arg("designs"), py::arg("by"), py::arg("weights"), py::arg("states"),
      py::arg("max_skins"), py::arg("threads"), py::arg("parameters"), py::arg("any_conditions"),
      py::arg("force"), py::arg("names"), py::arg("progress"));
  module.def(
      "calibrate",
      [](const std::string& file, const std::string& folder, int threads,
         const py::object& progress) {
        return calibration_row(run_job(
            [=](Job& job) {
              return calibrate(file, {threads, folder, noted(job), job.stop()});
            },
            progress));
      },
      py::arg("file"), py::arg("folder"), py::arg("threads"), py::arg("progress"));
  module.def(
      "export_files",
      [](const Design& design, const std::string& folder, const std::vector<std::string>& formats,
         double size, int pixels, const std::string& polarity) {
        const Exported e = run_job([=](Job&) {
          return export_files(design, folder, {formats, size, pixels, polarity});
        });
        return py::make_tuple(e.files, e.warnings);
      },
      py::arg("design"), py::arg("folder"), py::arg("formats"), py::arg("size"), py::arg("pixels"),
      py::arg("polarity"));
  module.def(
      "verify",
      [](const std::string& path, bool geometry, double tolerance) {
        const auto verdicts = run_job([=](Job&) {
          return verify(path, VerifyOptions{geometry, tolerance});
        });
        py::list out;
        for (const FolderVerdict& v : verdicts) out.append(verdict_row(v));
        return out;
      },
      py::arg("path"), py::arg("geometry"), py::arg("tolerance"));
  module.def(
      "read_scan",
      [](const std::string& file, double width, bool fill, bool as_is, double tip) {
        return scan_row(run_job([=](Job&) { return read_scan(file, {width, fill, as_is, tip}); }));
      },
      py::arg("file"), py::arg("width"), py::arg("fill"), py::arg("as_is"), py::arg("tip"));
  module.def(
      "measured",
      [](const Array& z, double dx, double dy, double tip) {
        return scan_row(
            run_job([h = heights_of(z, dx, dy), tip](Job&) { return measured(h, tip); }));
      },
      py::arg("z"), py::arg("dx"), py::arg("dy"), py::arg("tip"));
}

}  // namespace papilla::python
