#include "search/run.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <tuple>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "config/writer.h"
#include "forward/plan.h"
#include "geometry/io/files.h"
#include "optim/journal.h"
#include "optim/mpi.h"
#include "optim/pareto.h"
#include "optim/search.h"
#include "optim/worker.h"
#include "report/page.h"
#include "report/results.h"
#include "search/pick.h"

namespace papilla {
namespace {

namespace fs = std::filesystem;

constexpr int kNarrowSkins = 500;  // skins of the level between start here
constexpr int kFreshSkins = 1000;  // the confirmation's: none of what came before
constexpr std::size_t kFinalists = 8;
// Flat surface, sensitivity and parameters cost about as much as confirming so many designs; the
// stability of a design on the front as much as one.
constexpr int kOtherChecks = 4;
// Designs that the level between judges: one for so many evaluations of the search, at most.
constexpr int kEvaluationsPerNarrowing = 3;
constexpr int kMostNarrowings = 32;
constexpr double kSensitivityStep = 0.05;  // of a variable's range
constexpr double kToleratedLoss = 0.05;    // of an objective's value
// Last coordinate of a journal record: what was evaluated.
enum Stage {
  kSearch = 0,
  kConfirm = 1,
  kStability = 2,
  kDraft = 3,
  kSensitivity = 4,
  kSteps = 5,
  kNarrow = 6
};

// Of one design on its own: one finger, one choice of the model, a small step.
Fidelity check_fidelity(const Study& study) {
  Fidelity f = fidelity_level("search");
  f.seed = static_cast<std::uint64_t>(study.search.seed);
  return f;
}

// The cheapest that ranks designs as well as other skins at the level above do: sixteen skins in
// all, four a finger at least (results/bench/search_levels.csv). More designs for the same time
// find more than surer numbers do (docs/theory/search.md).
Fidelity search_fidelity(const Study& study) {
  Fidelity f = check_fidelity(study);
  f.level = "steer";
  f.grid = 64;
  f.skins = std::max(4, 16 / std::max(1, static_cast<int>(study.population.size())));
  return f;
}

// Every finger, two skins: what half of that cost knows best.
Fidelity draft_fidelity(const Study& study) {
  Fidelity f = search_fidelity(study);
  f.skins = 2;
  return f;
}

// Between search and confirmation: two thirds of the search's scatter about design level, at a
// tenth of the confirmation's cost (`search_bench scatter`, results/bench/search_scatter.csv).
Fidelity narrow_fidelity(const Study& study) {
  Fidelity f = search_fidelity(study);
  f.level = "narrow";
  f.grid = 128;
  f.first_skin = kNarrowSkins;
  f.skins *= 2;
  return f;
}

// The finger population shares the samples of the level: the mean over fingers is as sure as one
// finger at that level.
Fidelity confirm_fidelity(const Study& study, std::size_t tasks) {
  Fidelity f = fidelity_level(study.design.accuracy.level_name());
  f.seed = static_cast<std::uint64_t>(study.search.seed);
  f.first_skin = kFreshSkins;
  f.skins = std::max(10, f.skins / static_cast<int>(tasks));
  return f;
}

// What a worker is asked: (task, stage, flat, unit point...). Of kStability the task is the
// variant.
Point work_request(std::size_t task, Stage stage, bool flat, const Point& unit) {
  Point request{static_cast<double>(task), static_cast<double>(stage), flat ? 1.0 : 0.0};
  request.insert(request.end(), unit.begin(), unit.end());
  return request;
}

// The same surface without its relief. Of a lattice a picometre stays, so that it is judged on the
// patch and the skins of the lattice: the difference is the texture's, not that of other skins.
Texture without_relief(const Design& textured) {
  constexpr double kNone = 1e-12;  // [m]
  Design flat = textured;
  double* depth = roles(flat.texture).depth;
  if (depth) *depth = std::min(*depth, kNone);
  return depth || !facts(flat.texture).relief.present ? flat.texture : Texture{};
}

Evaluate work_function(const StudyProblem& problem, const Study& study, int threads) {
  return [&problem, &study, threads](const Point& request) {
    const auto task = static_cast<std::size_t>(request[0]);
    const auto stage = static_cast<Stage>(static_cast<int>(request[1]));
    Fidelity fidelity = stage == kConfirm || stage == kSteps
                            ? confirm_fidelity(study, problem.nominal_tasks())
                        : stage == kDraft  ? draft_fidelity(study)
                        : stage == kSearch ? search_fidelity(study)
                        : stage == kNarrow ? narrow_fidelity(study)
                                           : check_fidelity(study);
    fidelity.threads = threads;
    Design design = problem.design(Point(request.begin() + 3, request.end()));
    if (request[2] > 0) design.texture = without_relief(design);
    if (stage == kSteps) return problem.evaluate_steps(design, task, fidelity);
    if (stage == kStability) return evaluate_variant(problem, design, task, fidelity);
    return problem.evaluate_task(design, task, fidelity, stage == kConfirm);
  };
}

// Work on several processes: here, or on the ranks of an MPI job.
class Pool {
 public:
  Pool(const StudyProblem& problem, const Study& study, const MpiSession& mpi)
      : tasks_(problem.tasks().size()) {
    if (mpi.active()) {
      team_ = mpi.team();
      return;
    }
    const int jobs = study.search.jobs > 0 ? study.search.jobs : omp_get_num_procs();
    const int count = std::max(1, std::min(jobs, static_cast<int>(tasks_)));
    team_ =
        make_local_team(static_cast<std::size_t>(count),
                        work_function(problem, study, std::max(1, jobs / count)), WorkerLimits{});
  }

  // Designs at a time that keep everyone busy; no more, so that a kill loses little.
  std::size_t designs() const { return (team_->size() + tasks_ - 1) / tasks_ + 1; }

  std::vector<Outcome> evaluate(const std::vector<Point>& requests) {
    return team_->evaluate(requests);
  }
  std::size_t size() const { return team_->size(); }

  // Every task of every point; outcomes by point, then task. flat: without the texture.
  std::vector<std::vector<Outcome>> evaluate(const std::vector<Point>& units, Stage stage,
                                             bool flat) {
    std::vector<Point> requests;
    for (const Point& u : units) {
      for (std::size_t t = 0; t < tasks_; ++t) requests.push_back(work_request(t, stage, flat, u));
    }
    const std::vector<Outcome> flat_list = team_->evaluate(requests);
    std::vector<std::vector<Outcome>> out;
    for (std::size_t i = 0; i < units.size(); ++i) {
      out.emplace_back(flat_list.begin() + static_cast<std::ptrdiff_t>(i * tasks_),
                       flat_list.begin() + static_cast<std::ptrdiff_t>((i + 1) * tasks_));
    }
    return out;
  }

 private:
  std::unique_ptr<Team> team_;
  std::size_t tasks_ = 1;
};

SearchProblem search_problem(const StudyProblem& problem, const Study& study) {
  SearchProblem p;
  p.space = problem.space();
  p.objectives = problem.objectives().size();
  p.constraints = problem.constraints();
  p.residuals = problem.residuals();
  p.cheap_constraints = [&problem](const Point& u) { return problem.geometry(u); };
  if (problem.limits_look()) {
    // Each point is asked of again when it is evaluated and counted.
    p.costly_constraints = [&problem,
                            known = std::make_shared<std::map<Point, Point>>()](const Point& u) {
      const auto [it, is_new] = known->try_emplace(u);
      if (is_new) it->second = problem.look(u);
      return it->second;
    };
  }
  if (problem.has_features())
    p.features = [&problem](const Point& u) { return problem.features(u); };
  p.starts = problem.starts();
  p.evaluations =
      study.search.evaluations > 0 ? study.search.evaluations : default_evaluations(study);
  p.seed = static_cast<std::uint64_t>(study.search.seed);
  if (choose_method(study.search.method, p).name == "bayesian") p.drafts = study.search.drafts;
  return p;
}

// How many designs the level between judges: where there is a model of the front.
std::size_t narrowings(const SearchProblem& p) {
  if (p.objectives > 2 || p.space.single_point()) return 0;
  return static_cast<std::size_t>(
      std::min(kMostNarrowings, p.evaluations / kEvaluationsPerNarrowing));
}

// A rule that no front could meet is refused before the search.
void check_pick_rule(const std::string& rule, const std::vector<StudyObjective>& objectives) {
  if (rule.find_first_not_of("0123456789") == std::string::npos) return;
  PickCandidate any;
  for (const StudyObjective& o : objectives) any.names.push_back(o.name);
  any.objectives.assign(objectives.size(), 0.0);
  pick_design(rule, {any});
}

// The values of a resolved file by their path, as it is written there.
std::vector<std::pair<std::string, std::string>> resolved_values(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> out;
  std::istringstream lines(text);
  std::string table;
  std::map<std::string, int> count;  // of an array's tables
  for (std::string line; std::getline(lines, line);) {
    line.erase(std::min(line.find("  # "), line.size()));
    if (line.starts_with("[[")) {
      table = line.substr(2, line.size() - 4);
      table += fmt::format("[{}].", count[table]++);
    } else if (line.starts_with("[")) {
      table = line.substr(1, line.size() - 2) + ".";
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      out.emplace_back(table + line.substr(0, equals), line.substr(equals + 3));
    }
  }
  return out;
}

// "texture.depth \"350 nm\", \"400 nm\"": what two resolved files say otherwise, three at most.
// Without the keys that a run may be continued with.
std::string differing_keys(const std::string& there, const std::string& here) {
  const std::set<std::string> free{"search.evaluations", "search.jobs", "search.time"};
  const auto known = resolved_values(there), own = resolved_values(here);
  const std::map<std::string, std::string> before(known.begin(), known.end()),
      now(own.begin(), own.end());
  std::string out;
  int left = 3;
  const auto add = [&](const std::string& path, const std::string& a, const std::string& b) {
    if (a == b || free.count(path) > 0 || left-- <= 0) return;
    out += fmt::format("{}{} {}, {}", out.empty() ? "" : "; ", path, a, b);
  };
  const auto value = [](const std::map<std::string, std::string>& of, const std::string& path) {
    const auto found = of.find(path);
    return found == of.end() ? std::string("none") : found->second;
  };
  for (const auto& [path, text] : own) add(path, value(before, path), text);
  for (const auto& [path, text] : known) {
    if (now.count(path) == 0) add(path, text, "none");
  }
  return out;
}

class Run {
 public:
  Run(const Study& study, const OptimiseOptions& options, const MpiSession& mpi)
      : study_(study),
        options_(options),
        problem_(study),
        search_(search_problem(problem_, study)),
        method_(choose_method(study.search.method, search_)),
        folder_(checked_folder(options, problem_)),
        lock_(open_folder(folder_)),
        journal_(open_journal(options, text_hash(problem_.identity()), resolved_toml(study))),
        pool_(problem_, study, mpi) {}

  OptimiseResult run() {
    check_budget();
    result_.lost = journal_.lost();
    result_.method = method_.name;
    result_.why = method_.why;
    write_bytes(folder_ + "/resolved.toml", resolved_toml(study_));
    write_bytes(folder_ + "/plan.txt", search_plan(study_));
    search();
    const double searched = seconds();
    const bool go_on = !result_.interrupted && narrow();
    const double narrowed = seconds();
    if (go_on) confirm();
    const double confirmed = seconds();
    if (go_on && !result_.interrupted) check();
    // Of a finished run that was to be written anew: what is there stays.
    if (result_.interrupted && fs::exists(folder_ + "/best/design.toml")) return std::move(result_);
    const std::string rule = unmet_pick_.empty() ? options_.pick : "";
    ResultFiles files{folder_, study_, problem_, history_, result_, rule};
    write_results(files);
    if (!result_.interrupted && result_.has_best())
      write_bytes(folder_ + "/report.html", report_page(folder_));
    write_bytes(folder_ + "/timing.json",
                fmt::format("{{\"schema\": 1, \"search_seconds\": {:.3f}, "
                            "\"narrow_seconds\": {:.3f}, \"confirm_seconds\": {:.3f}, "
                            "\"check_seconds\": {:.3f}, \"seconds_per_evaluation\": {:.4f}}}\n",
                            searched, narrowed - searched, confirmed - narrowed,
                            seconds() - confirmed, evaluation_seconds()));
    if (!unmet_pick_.empty()) {
      throw InputError(unmet_pick_ + "; " + folder_ +
                       " is written with the usual choice: another with --resume --pick");
    }
    return std::move(result_);
  }

 private:
  // What can be refused before anything is written.
  static std::string checked_folder(const OptimiseOptions& options, const StudyProblem& problem) {
    require_images();
    check_pick_rule(options.pick, problem.objectives());
    if (options.resume && !fs::exists(options.folder + "/journal"))
      throw InputError(options.folder + ": no run to continue here (no journal)");
    return options.folder;
  }

  // A journal of another study is refused by the keys in which the studies differ.
  static Journal open_journal(const OptimiseOptions& options, const std::string& key,
                              const std::string& study) {
    try {
      return Journal(options.folder + "/journal", key, options.resume);
    } catch (const InputError& e) {
      const std::string file = options.folder + "/resolved.toml";
      if (!options.resume || !fs::exists(file)) throw;
      const std::string differ = differing_keys(read_bytes(file), study);
      if (differ.empty()) throw;
      throw InputError(std::string(e.what()) + "; there and here: " + differ);
    }
  }

  // The earlier run's searched designs, without those that the shape's limits refused.
  void check_budget() const {
    int evaluated = 0;
    for (const Evaluation& e : journal_.records()) {
      if (stage_of(e) != kSearch) continue;
      evaluated += e.outcome.ok || e.outcome.constraints.empty();
    }
    if (evaluated <= search_.evaluations) return;
    throw InputError(fmt::format(
        "{}: the earlier run has {} evaluations already, more than the {} asked for; continue it "
        "with as many as it was started with",
        folder_, evaluated, search_.evaluations));
  }

  static FolderLock open_folder(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError("cannot make the folder " + folder + ": " + error.message());
    return FolderLock(folder);
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  double evaluation_seconds() const { return fresh_ > 0 ? spent_ / fresh_ : 0; }
  bool stopped() const { return options_.stop && options_.stop->load(); }

  bool replaying() const { return next_record_ < journal_.records().size(); }

  // The earlier run's answer to a question.
  const Outcome& replayed(const Point& key) {
    const Evaluation& e = journal_.records()[next_record_++];
    if (e.unit != key) refuse_journal();
    return e.outcome;
  }
  [[noreturn]] void refuse_journal() const {
    throw InputError(folder_ +
                     "/journal: the earlier run took another path (other budget or another "
                     "version of Papilla); start again with another --out folder");
  }

  void record(const Point& key, const Outcome& outcome) {
    journal_.append({key, outcome});
    ++next_record_;
  }

  static Point keyed(Point unit, Stage stage, double part = 0) {
    unit.push_back(static_cast<double>(stage));
    unit.push_back(part);
    return unit;
  }

  // Outcomes of designs, from the journal while there are records, else evaluated together.
  std::vector<Outcome> search_outcomes(const std::vector<Point>& units) {
    std::vector<Outcome> out;
    while (out.size() < units.size() && replaying())
      out.push_back(replayed(keyed(units[out.size()], kSearch)));
    std::vector<Point> fresh;
    for (std::size_t i = out.size(); i < units.size(); ++i) {
      if (search_.feasible_before_evaluation(units[i])) fresh.push_back(units[i]);
    }
    const double from = seconds();
    const auto answers = pool_.evaluate(fresh, kSearch, false);
    spent_ += seconds() - from;
    fresh_ += static_cast<int>(fresh.size());
    std::size_t next = 0;
    for (std::size_t i = out.size(); i < units.size(); ++i) {
      Outcome outcome;
      if (search_.feasible_before_evaluation(units[i])) {
        outcome = guarded(problem_.outcome(problem_.score(answers[next++])), search_.objectives,
                          search_.constraints);
      } else {
        outcome.reason = problem_.geometry_reason(units[i]);
        outcome.constraints = problem_.geometry(units[i]);
        for (double c : problem_.look(units[i])) outcome.constraints.push_back(c);
      }
      record(keyed(units[i], kSearch), outcome);
      out.push_back(std::move(outcome));
    }
    return out;
  }

  // Outcomes of another stage than the search's own.
  std::vector<Evaluation> judged(const std::vector<Point>& units, Stage stage) {
    std::vector<Evaluation> out;
    const std::vector<Score> scores = scored(units, stage);
    for (std::size_t i = 0; i < units.size(); ++i) {
      out.push_back({units[i], guarded(problem_.outcome(scores[i]), search_.objectives,
                                       search_.constraints)});
    }
    return out;
  }

  std::vector<Score> scored(const std::vector<Point>& units, Stage stage) {
    const std::size_t tasks = problem_.tasks().size();
    std::vector<Point> requests;
    for (const Point& u : units) {
      for (std::size_t t = 0; t < tasks; ++t) requests.push_back(work_request(t, stage, false, u));
    }
    const std::vector<Outcome> outcomes = answers(requests);
    std::vector<Score> out;
    for (std::size_t i = 0; i < units.size(); ++i) {
      const auto first = outcomes.begin() + static_cast<std::ptrdiff_t>(i * tasks);
      out.push_back(problem_.score({first, first + static_cast<std::ptrdiff_t>(tasks)}));
    }
    return out;
  }

  // Cheap outcomes that steer.
  void draft(Searcher& searcher, const std::vector<Point>& units) {
    std::vector<Evaluation> batch;
    // Few at a time, so that a kill loses little and Ctrl-C is heard.
    while (batch.size() < units.size()) {
      if (!replaying() && stopped()) {
        result_.interrupted = true;
        return;
      }
      const auto begin = units.begin() + static_cast<std::ptrdiff_t>(batch.size());
      const std::size_t count = std::min(units.size() - batch.size(), 4 * pool_.size());
      for (Evaluation& e : judged({begin, begin + static_cast<std::ptrdiff_t>(count)}, kDraft))
        batch.push_back(std::move(e));
      drafts_ += static_cast<int>(count);
      report_progress("draft", drafts_, search_.drafts, -1);
    }
    searcher.tell(batch);
  }

  // Expected of `designs` at a fidelity, by what one of the search took.
  double seconds_of(std::size_t designs, const Fidelity& fidelity) const {
    const Scene scene{study_.design.surface, study_.design.finger, study_.design.environment,
                      study_.design.drive, study_.design.model};
    const auto cost = [&](const Fidelity& f) {
      return make_plan(scene, study_.design.texture, f).seconds();
    };
    return evaluation_seconds() * static_cast<double>(designs) * cost(fidelity) /
           cost(search_fidelity(study_));
  }
  double seconds_to_confirm() const {
    return seconds_of(2 * kFinalists + kOtherChecks,
                      confirm_fidelity(study_, problem_.nominal_tasks()));
  }
  double seconds_after_search() const {
    return seconds_of(narrowings(search_), narrow_fidelity(study_)) + seconds_to_confirm();
  }

  void report_progress(const char* stage, int done, int total, double left) {
    if (!options_.progress) return;
    std::string best;
    const auto front = pareto_front(history_);
    const auto& objectives = problem_.objectives();
    if (!front.empty() && !history_[front[0]].outcome.feasible())
      best = "none keeps every constraint yet";
    for (std::size_t k = 0; k < objectives.size() && !front.empty(); ++k) {
      if (!history_[front[0]].outcome.feasible()) break;
      double value = history_[front[0]].outcome.objectives[k];
      for (std::size_t i : front) value = std::min(value, history_[i].outcome.objectives[k]);
      // The ends of a front are different designs.
      best += fmt::format("{}{} {:.3f}",
                          !best.empty()      ? ", "
                          : front.size() > 1 ? "best of each: "
                                             : "best ",
                          objectives[k].name, objectives[k].maximise ? -value : value);
    }
    options_.progress({stage, done, total, best, left});
  }

  static Stage stage_of(const Evaluation& record) {
    if (record.unit.size() < 2) return kSearch;
    return static_cast<Stage>(static_cast<int>(record.unit.rbegin()[1]));
  }

  Point unit_of(const Evaluation& record) const {
    const std::size_t n = search_.space.size();
    if (record.unit.size() != n + 2) refuse_journal();
    return {record.unit.begin(), record.unit.begin() + static_cast<std::ptrdiff_t>(n)};
  }

  // Whether the journal goes beyond a stage: nothing of it is left to ask.
  bool finished(Stage stage) const {
    const auto& records = journal_.records();
    const auto later = [&](const Evaluation& e) {
      const Stage s = stage_of(e);
      if (s == kSearch || s == kDraft) return false;
      return stage == kSearch || s != stage;
    };
    return !records.empty() && later(records.back());
  }

  // The searched designs of a run that went on to confirm, from its journal.
  void replay_search() {
    while (replaying()) {
      const Evaluation& e = journal_.records()[next_record_];
      const Stage stage = stage_of(e);
      if (stage != kSearch && stage != kDraft) return;
      ++next_record_;
      if (stage == kDraft) continue;
      if (e.outcome.ok && e.outcome.objectives.size() != search_.objectives) refuse_journal();
      add_to_history({unit_of(e), e.outcome});
    }
  }

  // Whether the design was evaluated, not refused before.
  bool add_to_history(Evaluation e) {
    history_.push_back(std::move(e));
    const Evaluation& added = history_.back();
    const bool refused = !added.outcome.ok && !search_.feasible_before_evaluation(added.unit);
    result_.refused += refused;
    result_.evaluations += !refused;
    result_.failures += !added.outcome.ok && !refused;
    return !refused;
  }

  void search() {
    if (finished(kSearch)) return replay_search();
    const auto searcher = make_searcher(method_, search_);
    const std::size_t budget = static_cast<std::size_t>(search_.evaluations);
    const auto out_of_time = [&] {
      return study_.search.time > 0 && seconds() + seconds_after_search() > study_.search.time;
    };
    const auto searching_record = [&] {  // a resumed run stops where its confirmation began
      const auto& records = journal_.records();
      return next_record_ >= records.size() || stage_of(records[next_record_]) == kSearch ||
             stage_of(records[next_record_]) == kDraft;
    };
    std::size_t evaluated = 0;
    while (evaluated < budget && history_.size() < 10 * budget && searching_record()) {
      const std::vector<Point> asked = searcher->ask();
      if (asked.empty()) break;
      if (searcher->asks_drafts()) {
        draft(*searcher, asked);
        if (result_.interrupted) return;
        continue;
      }
      std::vector<Evaluation> batch;
      while (batch.size() < asked.size() && evaluated < budget && searching_record()) {
        if (!replaying() && stopped()) {
          result_.interrupted = true;
          return;
        }
        if (!replaying() && evaluated > 0 && out_of_time()) return;
        // One at a time from the journal, which may end or change stage within the batch.
        std::vector<Point> units;
        std::size_t counted = evaluated;
        const std::size_t most = replaying() ? 1 : pool_.designs();
        for (std::size_t i = batch.size();
             i < asked.size() && units.size() < most && counted < budget; ++i) {
          units.push_back(asked[i]);
          counted += search_.feasible_before_evaluation(asked[i]);
        }
        const std::vector<Outcome> outcomes = search_outcomes(units);
        for (std::size_t i = 0; i < units.size(); ++i) {
          batch.push_back({units[i], outcomes[i]});
          evaluated += add_to_history(batch.back());
        }
        const double left = fresh_ > 0 ? static_cast<double>(budget - evaluated) *
                                                 evaluation_seconds() * overhead() +
                                             seconds_after_search()
                                       : -1;
        report_progress("search", static_cast<int>(evaluated), search_.evaluations, left);
      }
      searcher->tell(batch);
    }
  }

  // Clock over evaluation time: what the searcher itself takes.
  double overhead() const { return spent_ > 0 ? std::max(1.0, seconds() / spent_) : 1; }

  static Point request_key(const Point& r) {
    return keyed(Point(r.begin() + 3, r.end()), static_cast<Stage>(static_cast<int>(r[1])),
                 2 * r[0] + r[2]);
  }
  // Answers of the workers, in order: from the journal while there are records. What hangs on the
  // picked design is evaluated anew, beside the journal, when the earlier run picked another.
  std::vector<Outcome> answers(const std::vector<Point>& requests) {
    if (picked_ && replaying() &&
        journal_.records()[next_record_].unit != request_key(requests.front()))
      beside_journal_ = true;
    if (beside_journal_) return pool_.evaluate(requests);
    std::vector<Outcome> out;
    while (out.size() < requests.size() && replaying())
      out.push_back(replayed(request_key(requests[out.size()])));
    const std::vector<Point> rest(requests.begin() + static_cast<std::ptrdiff_t>(out.size()),
                                  requests.end());
    const std::vector<Outcome> fresh = pool_.evaluate(rest);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      record(request_key(rest[i]), fresh[i]);
      out.push_back(fresh[i]);
    }
    return out;
  }

  Score confirmed(const Point& unit, bool flat) {
    std::vector<Point> requests;
    for (std::size_t t = 0; t < problem_.tasks().size(); ++t)
      requests.push_back(work_request(t, kConfirm, flat, unit));
    return problem_.score(answers(requests));
  }

  // The best design moved by a step along each continuous variable, both ways where the space and
  // the shape allow. Eq. search.9
  void find_sensitivity() {
    const FinalDesign& best = result_.finalists[result_.best];
    if (!best.confirmed.ok) return;
    const Point centre = best.unit;
    const auto shifted = [&](std::size_t k, double step) {
      Point u = centre;
      u[k] += step;
      return u;
    };
    const auto possible = [&](const Point& u, std::size_t k) {
      return u[k] >= 0 && u[k] <= 1 && problem_.geometry(u).front() <= 0;
    };
    std::vector<Point> points{centre};
    std::vector<std::pair<std::size_t, int>> moves;
    for (std::size_t k = 0; k < centre.size(); ++k) {
      if (!search_.space.dimensions[k].choices.empty()) continue;
      for (int sign : {-1, 1}) {
        const Point u = shifted(k, sign * kSensitivityStep);
        if (!possible(u, k) || search_.space.snapped(u) == centre) continue;
        points.push_back(u);
        moves.emplace_back(k, sign);
      }
    }
    if (moves.empty()) return;
    const std::vector<Score> scores = scored(points, kSensitivity);
    if (!scores.front().ok) return;
    const std::size_t m = problem_.objectives().size();
    const std::vector<double> centre_values = problem_.values(centre);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const auto [k, sign] = moves[i];
      if (result_.sensitivity.empty() || result_.sensitivity.back().variable != k) {
        result_.sensitivity.push_back({k, {}, {}, 0, 0, 0, false, false});
        result_.sensitivity.back().share.assign(m, 0);
      }
      VariableSensitivity& s = result_.sensitivity.back();
      const Score& moved = scores[i + 1];
      if (!moved.ok) continue;
      const double change = std::abs(problem_.values(points[i + 1])[k] - centre_values[k]);
      s.step = change;
      double allowed = kInfinity;
      if (s.change.empty()) s.change.assign(m, 0);
      const bool both = (sign > 0 && i > 0 && moves[i - 1].first == k && scores[i].ok);
      for (std::size_t o = 0; o < m; ++o) {
        const double up = sign * (moved.values[o] - scores[0].values[o]);
        s.change[o] = both ? 0.5 * (s.change[o] + up) : up;
        const double loss =
            (problem_.objectives()[o].maximise ? -1 : 1) * (moved.values[o] - scores[0].values[o]);
        const double most = kToleratedLoss * std::abs(scores[0].values[o]);
        if (loss > most) allowed = std::min(allowed, change * most / loss);
      }
      const bool beyond = !std::isfinite(allowed);
      (sign < 0 ? s.down : s.up) = beyond ? change : allowed;
      (sign < 0 ? s.down_beyond : s.up_beyond) = beyond;
    }
    for (std::size_t o = 0; o < m; ++o) {
      double sum = 0;
      for (const auto& s : result_.sensitivity) sum += s.change.empty() ? 0 : square(s.change[o]);
      for (auto& s : result_.sensitivity)
        s.share[o] = sum > 0 && !s.change.empty() ? square(s.change[o]) / sum : 0;
    }
  }

  // step: after each design; false: interrupted.
  bool check_stability(const std::function<void()>& step) {
    const std::size_t variants = stability_variants(problem_).size();
    std::vector<std::vector<Outcome>> outcomes;
    // The front comes first.
    for (const FinalDesign& f : result_.finalists) {
      if (f.folder.empty()) break;
      if (stopped()) return false;
      std::vector<Point> requests;
      for (std::size_t v = 0; v < variants; ++v)
        requests.push_back(work_request(v, kStability, false, f.unit));
      outcomes.push_back(answers(requests));
      step();
    }
    result_.stability = judge_stability(problem_, outcomes);
    return true;
  }

  // Of evaluations at one level, those to judge at the next.
  std::vector<std::size_t> finalists(const std::vector<Evaluation>& of, std::size_t most) const {
    std::vector<std::size_t> chosen = promising(search_, of, most);
    if (chosen.empty()) return chosen;
    // The one with the highest worst modulation is always among them.
    const std::vector<std::size_t> front = pareto_front(of);
    std::size_t steady = front.front();
    for (std::size_t i : front) {
      const auto& info = of[i].outcome.info;
      if (!info.empty() && info.back() > of[steady].outcome.info.back()) steady = i;
    }
    if (std::find(chosen.begin(), chosen.end(), steady) == chosen.end()) chosen.push_back(steady);
    return chosen;
  }

  // The search's level is noisy and biased, and not everywhere alike. On other skins and a finer
  // grid its best designs are judged again, then others where the front has most to gain, with the
  // search's evaluations as drafts (Eq. search.7-8): the finalists come from these. False:
  // interrupted.
  bool narrow() {
    const std::size_t count = narrowings(search_);
    SearchProblem problem = search_;
    problem.residuals = 0;
    std::vector<std::size_t> drafts;
    for (std::size_t i = 0; i < history_.size(); ++i) {
      if (history_[i].outcome.ok) drafts.push_back(i);
    }
    if (drafts.size() > kMostModelled) drafts = least_dominated(history_, kMostModelled);
    for (std::size_t i : drafts) problem.known_drafts.push_back(history_[i]);
    if (count < 2 || drafts.empty()) return true;
    const auto searcher = make_searcher({"bayesian", ""}, problem);
    std::vector<Point> asked;
    for (std::size_t i : finalists(history_, count / 2)) asked.push_back(history_[i].unit);
    const bool done_before = finished(kNarrow);
    const double from = seconds();
    while (narrowed_.size() < count) {
      if (done_before) {
        asked.clear();
        if (replaying() && stage_of(journal_.records()[next_record_]) == kNarrow)
          asked.push_back(unit_of(journal_.records()[next_record_]));
      } else if (asked.empty()) {
        asked = searcher->ask();
      }
      if (asked.empty() || !search_.feasible_before_evaluation(asked.front())) break;
      if (!replaying() && stopped()) {
        result_.interrupted = true;
        return false;
      }
      narrowed_.push_back(judged({asked.front()}, kNarrow).front());
      searcher->tell({narrowed_.back()});
      asked.erase(asked.begin());
      const auto done = static_cast<double>(narrowed_.size());
      report_progress("narrow", static_cast<int>(done), static_cast<int>(count),
                      (seconds() - from) / done * (static_cast<double>(count) - done));
    }
    return true;
  }

  void add_finalist(const Point& unit) {
    FinalDesign f;
    f.unit = unit;
    f.design = problem_.design(unit);
    for (const Evaluation& e : history_) {
      if (e.unit != unit) continue;
      f.searched.ok = e.outcome.ok;
      for (std::size_t k = 0; k < e.outcome.objectives.size(); ++k) {
        const double v = e.outcome.objectives[k];
        f.searched.values.push_back(problem_.objectives()[k].maximise ? -v : v);
      }
      break;
    }
    f.confirmed = confirmed(unit, false);
    f.feasible = f.confirmed.ok && problem_.feasible(f.confirmed, unit);
    result_.finalists.push_back(std::move(f));
  }

  Evaluation as_evaluation(const FinalDesign& f) const {
    Evaluation e{f.unit, problem_.outcome(f.confirmed)};
    if (f.confirmed.ok && !f.feasible && e.outcome.violation() <= 0)
      e.outcome.constraints.push_back(1);  // outside the fabrication limits
    return e;
  }

  // The finalists, and the surface of the first one by the first objective without its texture: a
  // texture of a nanometre must not pass for a design because its patch has other skins.
  std::vector<Point> to_confirm(const std::vector<Evaluation>& below) const {
    const std::vector<std::size_t> chosen = finalists(below, kFinalists);
    std::vector<Point> out;
    const Evaluation* first = nullptr;
    for (std::size_t i : chosen) {
      out.push_back(below[i].unit);
      if (below[i].outcome.ok &&
          (!first || below[i].outcome.objectives[0] < first->outcome.objectives[0]))
        first = &below[i];
    }
    const auto flat = first ? problem_.flattened(first->unit) : std::nullopt;
    if (flat && search_.feasible_before_evaluation(*flat) &&
        std::find(out.begin(), out.end(), *flat) == out.end())
      out.push_back(*flat);
    return out;
  }

  void confirm() {
    const std::vector<Evaluation>& below = narrowed_.empty() ? history_ : narrowed_;
    const std::vector<Point> chosen = to_confirm(below);
    const std::size_t total = chosen.size();
    const double from = seconds();
    report_progress("confirm", 0, static_cast<int>(total), seconds_to_confirm());
    for (std::size_t done = 1; done <= total; ++done) {
      if (stopped()) {
        result_.interrupted = true;
        return;
      }
      add_finalist(chosen[done - 1]);
      const double each = (seconds() - from) / static_cast<double>(done);
      report_progress("confirm", static_cast<int>(done), static_cast<int>(total),
                      each * static_cast<double>(2 * total - done + kOtherChecks));
    }
    judge();
  }

  // What is said of the front and the best beside their numbers: whether the order holds under
  // other models, what is the texture's, what the variables and the fit of the finger do.
  void check() {
    if (result_.finalists.empty()) return;
    int done = 0, total = kOtherChecks;
    for (const FinalDesign& f : result_.finalists) total += !f.folder.empty();
    const double from = seconds();
    const auto step = [&](int by = 1) {
      done += by;
      report_progress("check", done, total, (seconds() - from) / done * (total - done));
    };
    if (!check_stability([&] { step(); }) || stopped()) {
      result_.interrupted = true;
      return;
    }
    pick();
    if (facts(study_.design.texture).relief.present) compare_with_flat();
    step();
    find_sensitivity();
    step(2);
    FinalDesign& best = result_.finalists[result_.best];
    find_parameters(best.confirmed, best.unit, false);
    if (result_.flat) find_parameters(*result_.flat, best.unit, true);
    step();
  }

  // What the fit of the fingers leaves open. Eq. accuracy.12
  void find_parameters(Score& score, const Point& unit, bool flat) {
    if (!score.ok || !score.parameter_steps.empty() || !problem_.parameters_unknown().empty())
      return;
    std::vector<Point> requests;
    for (std::size_t t = 0; t < problem_.nominal_tasks(); ++t)
      requests.push_back(work_request(t, kSteps, flat, unit));
    std::vector<std::vector<double>> steps;
    for (const Outcome& outcome : answers(requests)) steps.push_back(outcome.info);
    problem_.add_steps(score, steps);
  }

  // What of the gain is the texture's and what the finish's: the best surface without its texture,
  // and the study's own surface without texture where the search changed more than the texture.
  void compare_with_flat() {
    const auto keep = [&](std::optional<Score>& to, const Point& unit) {
      Score score = confirmed(unit, true);
      if (score.ok) to = std::move(score);
    };
    const Point own = problem_.unit_of_study();
    const Point& best = result_.finalists[result_.best].unit;
    keep(result_.flat, best);
    bool finish_differs = false;
    for (std::size_t k = 0; k < own.size(); ++k) {
      finish_differs = finish_differs ||
                       (!study_.variables[k].path.starts_with("texture.") && own[k] != best[k]);
    }
    if (finish_differs) keep(result_.flat_before, own);
  }

  // The confirmed numbers decide the front and the best.
  void judge() {
    std::vector<Evaluation> confirmed;
    for (const FinalDesign& f : result_.finalists) {
      confirmed.push_back(as_evaluation(f));
      result_.any_feasible = result_.any_feasible || f.feasible;
    }
    if (!result_.any_feasible) result_.never_kept = problem_.never_kept(history_);
    for (std::size_t i : pareto_front(confirmed)) {
      FinalDesign& f = result_.finalists[i];
      f.on_front = f.feasible;
      if (!f.feasible && f.confirmed.ok) f.folder = "best";
    }
    std::stable_sort(result_.finalists.begin(), result_.finalists.end(),
                     [&](const FinalDesign& a, const FinalDesign& b) {
                       if (a.on_front != b.on_front) return a.on_front;
                       if (a.folder.empty() != b.folder.empty()) return b.folder.empty();
                       if (!a.confirmed.ok || !b.confirmed.ok) return a.confirmed.ok;
                       const double d = a.confirmed.values[0] - b.confirmed.values[0];
                       return problem_.objectives()[0].maximise ? d > 0 : d < 0;
                     });
    int number = 0;
    for (FinalDesign& f : result_.finalists) {
      if (f.on_front) f.folder = fmt::format("front/{:02d}", ++number);
    }
  }

  // The best of the front by the rule asked for.
  void pick() {
    std::vector<PickCandidate> front;  // the first ones; none: the first finalist is best
    for (const FinalDesign& f : result_.finalists) {
      if (!f.on_front) continue;
      PickCandidate c;
      for (const StudyObjective& o : problem_.objectives()) c.names.push_back(o.name);
      c.objectives = problem_.outcome(f.confirmed).objectives;
      c.worst = f.confirmed.worst;
      front.push_back(std::move(c));
    }
    picked_ = true;
    if (front.empty()) return;
    try {
      result_.best = pick_design(options_.pick, front);
    } catch (const InputError& e) {
      // Of a first run the results are worth more than the rule that fits none of them.
      if (fs::exists(folder_ + "/best/design.toml")) throw;
      result_.best = pick_design("", front);
      unmet_pick_ = e.what();
    }
  }

  const Study& study_;
  const OptimiseOptions& options_;
  StudyProblem problem_;
  SearchProblem search_;
  SearchMethod method_;
  std::string folder_;
  FolderLock lock_;
  Journal journal_;
  Pool pool_;
  OptimiseResult result_;
  std::vector<Evaluation> history_, narrowed_;
  std::string unmet_pick_;  // why the rule of options_.pick fits no design of the front
  std::size_t next_record_ = 0;
  bool picked_ = false, beside_journal_ = false;
  double spent_ = 0;
  int fresh_ = 0, drafts_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

int default_evaluations(const Study& study) {
  const int n = static_cast<int>(study.variables.size());
  const std::size_t objectives = study.objective.maximise.size() + study.objective.minimise.size() +
                                 study.objective.targets.size();
  const bool surrogate =
      (study.search.method == "auto" && objectives <= 2) || study.search.method == "bayesian";
  return surrogate ? std::clamp(25 * n, 20, 100) : std::clamp(50 * n, 50, 400);
}

std::string search_plan(const Study& study) {
  const StudyProblem problem(study);
  const SearchProblem search = search_problem(problem, study);
  const SearchMethod method = choose_method(study.search.method, search);
  std::string out =
      fmt::format("search: {} ({}), {}{} evaluations, seed {}\n", method.name, method.why,
                  search.drafts > 0 ? fmt::format("{} drafts, ", search.drafts) : "",
                  search.evaluations, study.search.seed);
  out += "tasks of an evaluation (finger, scenario):";
  for (const StudyTask& task : problem.tasks()) out += " [" + task.name + "]";
  const Scene scene{study.design.surface, study.design.finger, study.design.environment,
                    study.design.drive, study.design.model};
  out +=
      "\n\nsearch level:\n" + make_plan(scene, study.design.texture, search_fidelity(study)).text();
  if (narrowings(search) > 1) {
    out += fmt::format("\n{} of them and of their neighbours again, other skins:\n",
                       narrowings(search)) +
           make_plan(scene, study.design.texture, narrow_fidelity(study)).text();
  }
  out += fmt::format("\nconfirmation of up to {} finalists, fresh skins:\n", kFinalists + 1) +
         make_plan(scene, study.design.texture, confirm_fidelity(study, problem.nominal_tasks()))
             .text();
  return out;
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
    mpi.serve(work_function(problem, study, 1), WorkerLimits{});
    return {};
  }
  return Run(study, options, mpi).run();
}

}  // namespace papilla
