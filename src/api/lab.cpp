#include "papilla/lab.h"

#include <algorithm>

#include "api/inside.h"
#include "base/text.h"
#include "report/lab_folder.h"

namespace papilla::api {
namespace {

std::string date_or_today(const std::string& date) { return date.empty() ? today() : date; }

std::optional<Aim> aim_named(const std::string& name) {
  if (name.empty()) return std::nullopt;
  const auto found = std::find(aim_names().begin(), aim_names().end(), name);
  if (found == aim_names().end())
    throw wrong("purpose", "\"" + name + "\": expected " + join_names(aim_names()));
  return static_cast<Aim>(found - aim_names().begin());
}

}  // namespace

NextExperiments next_experiments(const std::vector<std::string>& sources,
                                 const NextExperimentOptions& options) {
  return across([&] {
    if (sources.empty()) throw wrong("sources", "name one at least");
    if (options.count < 1) throw wrong("count", "expected 1 at least");
    if (!(options.seconds >= 0)) throw wrong("seconds", "expected 0, no limit, or more");
    require_threads(options.threads);
    const Watch watch({}, options.stop);
    NextRun run;
    run.source = {sources,           options.belief,   options.worth,
                  options.load,      options.humidity, options.voltage,
                  options.frequency, options.states,   overrides(options.values)};
    run.folder = options.folder;
    run.options = {
        aim_named(options.purpose), options.count, options.seconds, options.finger, options.day,
        date_or_today(options.date)};
    run.threads = options.threads;
    run.note = options.progress;
    const NextReport report = next_in_lab(run);
    return NextExperiments{report.folder, report.stop, report.markdown, report.json};
  });
}

TellResult tell_lab(const std::string& folder, const std::vector<std::string>& files,
                    const TellOptions& options) {
  return across([&] {
    require_threads(options.threads);
    const Watch watch({}, options.stop);
    const TellRun run{folder,
                      files,
                      {options.experiment, options.field, options.design, options.finger,
                       options.day, date_or_today(options.date), options.replace},
                      options.threads,
                      options.progress};
    const TellReport report = rooms::tell_lab(run);
    TellResult out{{}, report.markdown, report.json};
    for (const rooms::Problem& p : report.refused)
      out.refused.push_back({p.file, p.line, p.column, p.key, p.message});
    return out;
  });
}

LabState lab_state(const std::string& folder, int threads) {
  return across([&] {
    require_threads(threads);
    const NextReport report = rooms::lab_state(folder, threads);
    return LabState{report.markdown, report.json};
  });
}

}  // namespace papilla::api
