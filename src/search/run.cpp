#include "search/run.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/watch.h"
#include "geometry/io/files.h"
#include "metrics/shown.h"
#include "optim/pareto.h"
#include "search/building.h"
#include "search/levels.h"
#include "search/pick.h"
#include "search/stages.h"
#include "search/task.h"

namespace papilla::search {
namespace {

constexpr double kSecondsOfFiles = 1;  // tables, pictures and the page
// A patch of one skin, by one process where stages have several; skins of a confirmed task.
constexpr double kPagePatches = 2, kUsualSkins = 16;

// A rule that no front could meet is refused before the search.
void check_pick_rule(const std::string& rule, const StudyProblem& problem) {
  std::vector<std::string> names;
  for (const StudyObjective& o : problem.objectives()) names.push_back(o.name);
  read_pick_rule(rule, names, problem.judged_at_amplitude());
}

// What can be refused before anything is written.
std::string checked_folder(const OptimiseOptions& options, const StudyProblem& problem,
                           const SearchMethod& method) {
  require_images();
  require_method(method);
  check_pick_rule(options.pick, problem);
  study_warnings(problem);
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
  // Twice a worker's share: tasks are unlike, and one that waits for the others of its design
  // leaves them its processor.
  const int threads = std::min(jobs, 2 * jobs / count);
  return make_local_team(static_cast<std::size_t>(count),
                         work_function(problem, threads, response_text(options)), WorkerLimits{});
}

// Best values of a search so far, for people, as its level has them: what is confirmed later has
// other numbers.
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
    const MetricExpression& e = objectives[k].expression;
    const std::string unit = shown_unit(e).unit;
    out += fmt::format("{}{} {}{}{}", before, objectives[k].name,
                       shown_value(e, objectives[k].maximise ? -value : value),
                       unit.empty() ? "" : " ", unit);
  }
  return out + " (search level)";  // last: a narrow terminal cuts it off
}

// A resumed run has what it was started with.
void check_budget(const Run& run) {
  const int evaluated = run.replay.evaluated();
  if (evaluated <= run.search.evaluations) return;
  throw InputError(fmt::format(
      "{}: the earlier run has {} evaluations already, more than the {} asked for; continue it "
      "with as many as it was started with",
      run.folder.path(), evaluated, run.search.evaluations));
}

// Clock at the end of each stage.
struct StageSeconds {
  double search = 0, narrow = 0, confirm = 0;
};

StageSeconds run_stages(Run& run) {
  StageSeconds at;
  try {
    search_designs(run);
    at.search = run.clock.seconds();
    narrow(run);
    at.narrow = run.clock.seconds();
    confirm(run);
    at.confirm = run.clock.seconds();
    check(run);
    run.replay.end(run.result.end == SearchEnd::Exhausted);
  } catch (const WorkStopped&) {
    run.result.interrupted = true;
    for (double* end : {&at.search, &at.narrow, &at.confirm})
      if (*end == 0) *end = run.clock.seconds();
  }
  return at;
}

void write_files(Run& run, const StageSeconds& at) {
  const double checked = run.clock.seconds();
  run.result.hypervolumes = hypervolume_shares(run.history.evaluations);
  const std::string rule = run.unmet_pick.empty() ? run.options.pick : "";
  if (run.options.writer)
    run.options.writer->write(
        {run.folder.path(), run.study, run.problem, run.history, run.result, rule});
  // What each stage took of its price, so that prices and times left can be held against runs.
  constexpr std::array kTimed{Stage::Search,    Stage::Narrow,   Stage::Confirm,     Stage::Belief,
                              Stage::Stability, Stage::Rounding, Stage::Sensitivity, Stage::Steps};
  constexpr std::array kNames{"search",    "narrow",   "confirm",     "belief",
                              "stability", "rounding", "sensitivity", "steps"};
  std::string stages;
  for (std::size_t k = 0; k < kTimed.size(); ++k) {
    const Replay::Spent& spent = run.replay.spent(kTimed[k]);
    const bool confirmed = kTimed[k] == Stage::Confirm || kTimed[k] == Stage::Rounding;
    if (spent.tasks == 0) continue;
    stages += fmt::format(
        "{}\n  {{\"stage\": \"{}\", \"tasks\": {}, \"seconds\": {:.3f}, \"priced_seconds\": "
        "{:.3f}}}",
        stages.empty() ? "" : ",", kNames[k], spent.tasks, spent.seconds,
        spent.tasks * run.price(kTimed[k], confirmed ? run.confirm_seconds : 0));
  }
  run.folder.write(
      "timing.json",
      fmt::format("{{\"schema\": 1, \"search_seconds\": {:.3f}, "
                  "\"narrow_seconds\": {:.3f}, \"confirm_seconds\": {:.3f}, "
                  "\"check_seconds\": {:.3f}, \"files_seconds\": {:.3f}, "
                  "\"seconds_per_evaluation\": {:.4f}, \"workers\": {}, \"stages\": [{}]}}\n",
                  at.search, at.narrow - at.search, at.confirm - at.narrow, checked - at.confirm,
                  run.clock.seconds() - checked, run.seconds_of_designs(1, Stage::Search),
                  run.replay.workers(), stages));
}

}  // namespace

Run::Run(const Study& of, const OptimiseOptions& how, const MpiSession& mpi,
         std::unique_ptr<Team> team)
    : clock(of.search.time, how.spent),
      study(of),
      options(how),
      problem(of),
      search(search_problem(problem)),
      method(choose_method(of.search.method, search)),
      folder(Folder::made(checked_folder(how, problem, method))),
      lock(folder, ".lock", "another run is working"),
      replay(problem, search, folder, how.resume,
             team ? std::move(team) : make_team(problem, how, mpi), how.stop) {}

void Run::progress(const char* stage, int done, int total, double left) const {
  if (clock.limited() && left >= 0)
    left = std::min(left, std::max(0.0, study.search.time - clock.seconds()));
  const double now = clock.seconds();
  const double share = left >= 0 ? now / std::max(1e-9, now + left) : 0;
  // For who watches the folder: no more often than anybody looks.
  constexpr double kBetween = 0.5;  // [s]
  if (now - told_ >= kBetween) {
    told_ = now;
    folder.write(kProgressFile,
                 nlohmann::json{{"stage", stage},
                                {"done", done},
                                {"total", total},
                                {"seconds_left", left >= 0 ? nlohmann::json(left) : nullptr},
                                {"share", share}}
                     .dump());
  }
  if (!options.progress) return;
  options.progress(
      {stage, done, total, best_text(problem.objectives(), history.evaluations), left, share});
}

double Run::seconds_of(std::size_t tasks, Stage stage) const {
  const auto count = static_cast<double>(tasks);
  // The rounded design is one more to confirm.
  const Stage like = stage == Stage::Rounding ? Stage::Confirm : stage;
  if (const Replay::Spent& spent = replay.spent(like); spent.tasks > 0) return count * spent.each();
  // By all that was timed: one stage alone may have met a busy machine.
  double seconds = 0, expected = 0;
  for (const Stage timed : {Stage::Draft, Stage::Search, Stage::Narrow, Stage::Confirm}) {
    const Replay::Spent& spent = replay.spent(timed);
    if (spent.tasks == 0) continue;
    seconds += spent.seconds;
    expected += spent.tasks * expected_seconds(timed);
  }
  return expected > 0 ? count * expected_seconds(stage) * seconds / expected : 0;
}

double Run::expected_seconds(Stage stage) const {
  const bool whole = stage == Stage::Confirm || stage == Stage::Rounding;
  return over_price(stage) * price(stage, whole ? confirm_seconds : 0);
}

double Run::price(Stage stage, double most_seconds) const {
  const auto [at, is_new] = prices_.try_emplace({stage, most_seconds}, 0);
  if (is_new) at->second = task_price(problem, stage, most_seconds);
  return at->second;
}

double Run::seconds_of_designs(std::size_t designs, Stage stage) const {
  return seconds_of(designs * problem.tasks().size(), stage);
}

std::size_t Run::may_hold() const {
  const std::size_t known = result.finalists.size();
  if (known == 0 && chosen == 0) return most_finalists(search);
  const auto hold = std::count_if(result.finalists.begin(), result.finalists.end(),
                                  [](const FinalDesign& f) { return f.feasible; });
  return static_cast<std::size_t>(hold) + (chosen > known ? chosen - known : 0);
}

PartSeconds Run::wanted() const {
  PartSeconds out{};
  const auto set = [&](RunPart part, double seconds) {
    out[static_cast<std::size_t>(part)] = seconds;
  };
  // Until the confirmed numbers have decided the front, all that may be on it.
  const auto decided = static_cast<std::size_t>(
      std::count_if(result.finalists.begin(), result.finalists.end(),
                    [](const FinalDesign& f) { return !f.folder.empty(); }));
  const bool begun = chosen > 0 || !result.finalists.empty();
  const std::size_t front = decided > 0 ? decided : begun ? may_hold() : most_finalists(search) - 1;
  // A level between of too few designs is none: its time is the search's.
  const bool enough = !clock.limited() || seconds_of_designs(kFewNarrowed, Stage::Narrow) <=
                                              part_share(RunPart::Narrow) * study.search.time;
  if (enough) set(RunPart::Narrow, seconds_of_designs(narrowings(search), Stage::Narrow));
  set(RunPart::Confirm,
      seconds_of_designs(chosen > 0 ? chosen : most_finalists(search), Stage::Confirm));
  if (problem.belief())
    set(RunPart::Belief, seconds_of(believed(*this) * problem.nominal_tasks(), Stage::Belief));
  set(RunPart::Stability, seconds_of(front * stability_variants(problem).size(), Stage::Stability));
  set(RunPart::Flat, seconds_of_designs(2, Stage::Confirm));
  set(RunPart::Rounding, seconds_of_designs(kJudgedOnGrid, Stage::Rounding));
  set(RunPart::Sensitivity, seconds_of_designs(1 + 2 * search.space.size(), Stage::Sensitivity));
  if (problem.parameters_unknown().empty())
    set(RunPart::Parameters,
        seconds_of(designs_with_model_part(problem, search) * problem.nominal_tasks(),
                   Stage::Steps));
  // The page solves a patch of the best design at each humidity, and files are written.
  set(RunPart::Files, kSecondsOfFiles + seconds_of(1, Stage::Confirm) * kPagePatches / kUsualSkins);
  return out;
}

double Run::seconds_from(RunPart on) const {
  const PartSeconds all = wanted();
  return std::accumulate(all.begin() + static_cast<std::ptrdiff_t>(on), all.end(), 0.0);
}

bool Run::begin(RunPart part, Stage stage, bool flat, double seconds) {
  clock.enter(part);
  const bool recorded = !replay.beside_journal() && replay.has(stage, flat);
  if (recorded || may_ask(stage, flat, seconds)) return true;
  cut(part, 0, 1);
  return false;
}

bool Run::goes_on(Stage stage, bool flat, double seconds) const {
  const auto next = replay.next();
  const bool recorded =
      !replay.beside_journal() && next && next->stage == stage && next->flat == flat;
  return recorded || may_ask(stage, flat, seconds);
}

bool Run::may_ask(Stage stage, bool flat, double seconds) const {
  return (replay.beside_journal() || !replay.finished(stage, flat)) && fits(seconds);
}

void Run::cut(RunPart part, std::size_t done, std::size_t of) {
  const bool known = std::any_of(result.cuts.begin(), result.cuts.end(),
                                 [part](const ClockCut& c) { return c.part == part; });
  if (clock.limited() && done < of && !known) result.cuts.push_back({part, done, of});
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
  run.result.kept_copy = run.replay.kept_copy();
  run.result.method = run.method.name;
  run.result.why = run.method.why;
  run.result.asked = run.search.evaluations;
  run.folder.write("resolved.toml", resolved_toml(study));
  run.folder.write("plan.txt", search_plan(run.problem));
  const StageSeconds at = run_stages(run);
  run.folder.remove(kProgressFile);
  // What a finished run wrote stays when it was to be written anew.
  const bool stays = run.result.interrupted && run.folder.has("best/design.toml");
  if (!stays) write_files(run, at);
  if (!stays && !run.unmet_pick.empty()) {
    throw InputError(run.unmet_pick + "; " + run.folder.path() +
                     " is written with the usual choice: another with --resume --pick");
  }
  return std::move(run.result);
}

}  // namespace papilla::search
