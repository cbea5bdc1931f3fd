// papilla/study.h
#include "convert.h"
#include "job.h"

namespace papilla::python {
namespace {

using namespace py::literals;

py::tuple variable_row(const Variable& v) {
  return py::make_tuple(v.path, v.unit, v.low, v.high, v.choices, v.names);
}

py::tuple judgement_row(const Judgement& j) {
  return py::make_tuple(j.ok, j.reason, j.values, j.errors, j.violations);
}

Judgement judgement_of(const py::tuple& row) {
  return {row[0].cast<bool>(), row[1].cast<std::string>(), row[2].cast<std::vector<double>>(),
          row[3].cast<std::vector<double>>(), row[4].cast<std::vector<double>>()};
}

RunOptions watched(RunOptions options, Job& job) {
  options.stop = job.stop();
  options.progress = [&job](const RunProgress& p) {
    job.post(
        [p](const py::object& progress) { progress(p.stage, p.done, p.total, p.seconds_left); });
  };
  return options;
}

// What it found is in the folder.
void run_study(const Study& study, const std::string& folder, bool resume, bool finish, bool force,
               const std::string& pick, const py::object& progress) {
  if (!all_jobs_ended()) {
    throw InputError({{"", 0, 0, "optimize",
                       "a search works in processes forked from this one: let the evaluations of "
                       "other threads end first"}});
  }
  RunOptions options;
  options.resume = resume;
  options.finish = finish;
  options.force = force;
  options.pick = pick;
  run_job([study, folder, options](Job& job) { return study.run(folder, watched(options, job)); },
          progress);
}

}  // namespace

void bind_study(py::module_& module) {
  py::class_<Study>(module, "Study")
      .def_static("read", &Study::read, py::arg("file"), py::arg("values"))
      .def_static("parse", &Study::parse, py::arg("toml"), py::arg("values"))
      .def("variables",
           [](const Study& self) {
             py::list out;
             for (const Variable& v : self.variables()) out.append(variable_row(v));
             return out;
           })
      .def("objectives",
           [](const Study& self) {
             py::list out;
             for (const Objective& o : self.objectives())
               out.append(py::make_tuple(o.name, o.maximise, o.unit));
             return out;
           })
      .def("violations", &Study::violations)
      .def("own_values", &Study::own_values)
      .def("design", &Study::design, py::arg("values"))
      .def(
          "judge",
          [](const Study& self, const std::vector<double>& values, int threads, bool force) {
            return judgement_row(run_job([self, values, threads, force](Job& job) {
              return self.judge(values, threads, job.stop(), force);
            }));
          },
          py::arg("values"), py::arg("threads"), py::arg("force"))
      .def("run", &run_study, py::arg("folder"), py::arg("resume"), py::arg("finish"),
           py::arg("force"), py::arg("pick"), py::arg("progress"));

  py::class_<Search>(module, "Search")
      .def(py::init<const Study&>(), py::arg("study"))
      .def("ask", &Search::ask, py::call_guard<py::gil_scoped_release>())
      .def(
          "tell",
          [](Search& self, const std::vector<py::tuple>& rows) {
            std::vector<Judgement> judgements;
            for (const py::tuple& row : rows) judgements.push_back(judgement_of(row));
            py::gil_scoped_release release;
            self.tell(judgements);
          },
          py::arg("judgements"));
}

}  // namespace papilla::python
