#include "search/run.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/files.h"
#include "optim/pareto.h"
#include "search/levels.h"
#include "search/pick.h"
#include "search/stages.h"
#include "search/task.h"

namespace papilla::search {
namespace {

// A rule that no front could meet is refused before the search.
void check_pick_rule(const std::string& rule, const std::vector<StudyObjective>& objectives) {
  if (rule.find_first_not_of("0123456789") == std::string::npos) return;
  PickCandidate any;
  for (const StudyObjective& o : objectives) any.names.push_back(o.name);
  any.objectives.assign(objectives.size(), 0.0);
  pick_design(rule, {any});
}

// What can be refused before anything is written.
std::string checked_folder(const OptimiseOptions& options, const StudyProblem& problem) {
  require_images();
  check_pick_rule(options.pick, problem.objectives());
  if (options.resume && !std::filesystem::exists(options.folder + "/journal"))
    throw InputError(options.folder + ": no run to continue here (no journal)");
  return options.folder;
}

ResponseText response_text(const OptimiseOptions& options) {
  if (!options.writer) return {};
  return [writer = options.writer](const Response& response) { return writer->text(response); };
}

// Workers here, or the ranks of an MPI job.
std::unique_ptr<Team> make_team(const StudyProblem& problem, const OptimiseOptions& options,
                                const MpiSession& mpi) {
  if (mpi.active()) return mpi.team();
  const int wanted = problem.study().search.jobs;
  const int jobs = wanted > 0 ? wanted : omp_get_num_procs();
  const int count = std::max(1, std::min(jobs, static_cast<int>(problem.tasks().size())));
  return make_local_team(static_cast<std::size_t>(count),
                         work_function(problem, std::max(1, jobs / count), response_text(options)),
                         WorkerLimits{});
}

// Best values of a search so far, for people.
std::string best_text(const std::vector<StudyObjective>& objectives,
                      const std::vector<Evaluation>& history) {
  const auto front = pareto_front(history);
  if (front.empty()) return {};
  if (!history[front[0]].outcome.feasible()) return "none keeps every constraint yet";
  std::string out;
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    double value = history[front[0]].outcome.objectives[k];
    for (std::size_t i : front) value = std::min(value, history[i].outcome.objectives[k]);
    // The ends of a front are different designs.
    const char* before = !out.empty() ? ", " : front.size() > 1 ? "best of each: " : "best ";
    out += fmt::format("{}{} {:.3f}", before, objectives[k].name,
                       objectives[k].maximise ? -value : value);
  }
  return out;
}

// A resumed run has what it was started with.
void check_budget(const Run& run) {
  const int evaluated = run.replay.evaluated();
  if (evaluated <= run.search.evaluations) return;
  throw InputError(fmt::format(
      "{}: the earlier run has {} evaluations already, more than the {} asked for; continue it "
      "with as many as it was started with",
      run.folder, evaluated, run.search.evaluations));
}

// Clock at the end of each stage.
struct StageSeconds {
  double search = 0, narrow = 0, confirm = 0;
};

StageSeconds run_stages(Run& run) {
  StageSeconds at;
  bool on = search_designs(run);
  at.search = run.seconds();
  on = on && narrow(run);
  at.narrow = run.seconds();
  on = on && confirm(run);
  at.confirm = run.seconds();
  on = on && check(run);
  run.result.interrupted = !on;
  return at;
}

void write_files(Run& run, const StageSeconds& at) {
  run.result.hypervolumes = hypervolume_shares(run.history.evaluations);
  const std::string rule = run.unmet_pick.empty() ? run.options.pick : "";
  if (run.options.writer)
    run.options.writer->write({run.folder, run.study, run.problem, run.history, run.result, rule});
  write_bytes(run.folder + "/timing.json",
              fmt::format("{{\"schema\": 1, \"search_seconds\": {:.3f}, "
                          "\"narrow_seconds\": {:.3f}, \"confirm_seconds\": {:.3f}, "
                          "\"check_seconds\": {:.3f}, \"seconds_per_evaluation\": {:.4f}}}\n",
                          at.search, at.narrow - at.search, at.confirm - at.narrow,
                          run.seconds() - at.confirm, run.replay.seconds_each()));
}

}  // namespace

Run::Run(const Study& of, const OptimiseOptions& how, const MpiSession& mpi)
    : study(of),
      options(how),
      problem(of),
      search(search_problem(problem)),
      method(choose_method(of.search.method, search)),
      folder(checked_folder(how, problem)),
      lock(folder),
      replay(problem, search, folder, how.resume, make_team(problem, how, mpi)) {}

double Run::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void Run::progress(const char* stage, int done, int total, double left) const {
  if (!options.progress) return;
  options.progress(
      {stage, done, total, best_text(problem.objectives(), history.evaluations), left});
}

double Run::seconds_of(std::size_t designs, Stage stage) const {
  return replay.seconds_each() * static_cast<double>(designs) * relative_cost(problem, stage);
}

double Run::seconds_to_confirm() const {
  return seconds_of(2 * kFinalists + kOtherChecks, Stage::Confirm);
}

bool Run::add_to_history(const Point& unit, const Judgement& judgement) {
  history.add(unit, judgement);
  const bool ok = judgement.outcome.ok;
  const bool refused = !ok && !search.feasible_before_evaluation(unit);
  result.refused += refused;
  result.evaluations += !refused;
  result.failures += !ok && !refused;
  return !refused;
}

OptimiseResult optimise(const Study& study, const OptimiseOptions& options) {
  if (!study.is_study()) {
    throw InputError(
        study.file +
        ": no [design_space]: nothing to search; `papilla evaluate` judges one design");
  }
  MpiSession mpi;
  if (mpi.rank() > 0) {
    const StudyProblem problem(study);
    mpi.serve(work_function(problem, 1, response_text(options)), WorkerLimits{});
    return {};
  }
  Run run(study, options, mpi);
  check_budget(run);
  run.result.lost = run.replay.lost();
  run.result.method = run.method.name;
  run.result.why = run.method.why;
  write_bytes(run.folder + "/resolved.toml", resolved_toml(study));
  write_bytes(run.folder + "/plan.txt", search_plan(study));
  const StageSeconds at = run_stages(run);
  // What a finished run wrote stays when it was to be written anew.
  const bool stays =
      run.result.interrupted && std::filesystem::exists(run.folder + "/best/design.toml");
  if (!stays) write_files(run, at);
  if (!stays && !run.unmet_pick.empty()) {
    throw InputError(run.unmet_pick + "; " + run.folder +
                     " is written with the usual choice: another with --resume --pick");
  }
  return std::move(run.result);
}

}  // namespace papilla::search
