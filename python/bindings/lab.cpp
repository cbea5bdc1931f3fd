// papilla/lab.h
#include "convert.h"
#include "job.h"

namespace papilla::python {

void bind_lab(py::module_& module) {
  const auto noted = [](Job& job) {
    return [&job](const std::string& text) {
      job.post([text](const py::object& progress) { progress(text); });
    };
  };
  module.def(
      "next_experiments",
      [noted](const std::vector<std::string>& sources, const std::string& folder,
              const std::string& purpose, int count, double seconds, const std::string& belief,
              const std::string& worth, const std::vector<std::string>& conditions,
              const Design::Values& values, const std::string& finger, const std::string& day,
              const std::string& date, int threads, const py::object& progress) {
        const NextExperiments found = run_job(
            [=](Job& job) {
              NextExperimentOptions o;
              o.folder = folder;
              o.purpose = purpose;
              o.count = count;
              o.seconds = seconds;
              o.belief = belief;
              o.worth = worth;
              o.load = conditions.at(0);
              o.humidity = conditions.at(1);
              o.voltage = conditions.at(2);
              o.frequency = conditions.at(3);
              o.states = conditions.at(4);
              o.values = values;
              o.finger = finger;
              o.day = day;
              o.date = date;
              o.threads = threads;
              o.progress = noted(job);
              o.stop = job.stop();
              return next_experiments(sources, o);
            },
            progress);
        return py::make_tuple(found.folder, found.stop, found.table, found.json);
      },
      py::arg("sources"), py::arg("folder"), py::arg("purpose"), py::arg("count"),
      py::arg("seconds"), py::arg("belief"), py::arg("worth"), py::arg("conditions"),
      py::arg("values"), py::arg("finger"), py::arg("day"), py::arg("date"), py::arg("threads"),
      py::arg("progress"));
  module.def(
      "tell_lab",
      [noted](const std::string& folder, const std::vector<std::string>& files,
              const std::vector<std::string>& said, bool replace, int threads,
              const py::object& progress) {
        const TellResult told = run_job(
            [=](Job& job) {
              return tell_lab(folder, files,
                              {said.at(0), said.at(1), said.at(2), said.at(3), said.at(4),
                               said.at(5), replace, threads, noted(job), job.stop()});
            },
            progress);
        py::list refused;
        for (const Problem& p : told.refused)
          refused.append(py::make_tuple(p.file, p.line, p.column, p.key, p.message));
        return py::make_tuple(refused, told.table, told.json);
      },
      py::arg("folder"), py::arg("files"), py::arg("said"), py::arg("replace"), py::arg("threads"),
      py::arg("progress"));
  module.def(
      "lab_state",
      [](const std::string& folder, int threads) {
        const LabState state = run_job([=](Job&) { return lab_state(folder, threads); });
        return py::make_tuple(state.page, state.json);
      },
      py::arg("folder"), py::arg("threads"));
}

}  // namespace papilla::python
