#include "search/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "base/digest.h"
#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
#include "config/writer.h"
#include "design/design.h"
#include "estimate/belief.h"
#include "estimate/evaluation.h"
#include "geometry/io/files.h"
#include "search/protocol.h"

namespace papilla::search {
namespace {

// Corners of the space, as small features lie there, and places inside; then smaller steps from the
// smallest, as searches end on the limits of the shape, where few places lie.
double smallest_feature_of(const DesignSpace& space, const StudyConstraints& constraints) {
  constexpr int kSteps = 400;
  RandomStream random(1, "smallest feature");
  double out = std::numeric_limits<double>::infinity();
  Point smallest;
  const auto consider = [&](const Point& raw) {
    const Point unit = space.snapped(raw);
    const std::vector<double> limits = constraints.geometry(unit);
    if (std::any_of(limits.begin(), limits.end(), [](double v) { return v > 0; })) return;
    const double feature = facts(space.design(unit).texture).margins.smallest();
    if (feature < out) out = feature, smallest = unit;
  };
  for (const Point& unit : space.corners_and_places(random)) consider(unit);
  for (int k = 0; k < kSteps && !smallest.empty(); ++k) {
    Point unit = smallest;
    const double reach = 0.3 * std::pow(0.01, k / static_cast<double>(kSteps));
    for (double& u : unit) u = std::clamp(u + reach * random.normal(), 0.0, 1.0);
    consider(unit);
  }
  return out;
}

// A design with what is in its files in the place of their names: where a folder and its maps were
// copied to, it is the same.
std::string content_of(Design design) {
  std::string files;
  for (std::string* name : map_files(design)) {
    const MapName map = map_name(*name);
    files += sha256(read_bytes(map.file)) + " " + map.channel + "\n";
    name->clear();
  }
  if (!design.finger.belief.empty()) files += belief_text(belief_of(design.finger));
  design.finger.belief.clear();
  return to_toml(design) + files;
}

}  // namespace

StudyProblem::StudyProblem(const Study& study)
    : study_(study),
      space_(study),
      tasks_(study_tasks(study)),
      goals_(study_goals(study, tasks_)),
      constraints_(study, space_, tasks_, goals_),
      scoring_{goals_, tasks_,
               static_cast<std::size_t>(std::count_if(
                   tasks_.begin(), tasks_.end(), [](const StudyTask& t) { return t.nominal(); })),
               ScatterLaw(study.scatter, study.correlations), study.design.environment.weights},
      belief_risk_(parse_belief_risk(study.risk.belief)),
      smallest_feature_(smallest_feature_of(space_, constraints_)) {
  if (belief_absent().empty()) belief_ = belief_of(tasks_.front().finger);
}

bool StudyProblem::driven() const {
  return std::any_of(tasks_.begin(), tasks_.end(), [](const StudyTask& t) { return t.driven; });
}

Score StudyProblem::score(const Design& design, const std::vector<TaskAnswer>& answers) const {
  Score out = score_without_yield(answers);
  if (!out.ok || !goals_.yield) return out;
  const bool confirmed = !out.samples.empty();
  out.yield =
      YieldModel(study_, constraints_, scoring_).share(design, out, plates_of(study_, confirmed));
  return out;
}

std::optional<Yield> StudyProblem::yield(const Design& design, const Score& score) const {
  if (!score.ok || !YieldModel::exists(study_)) return std::nullopt;
  return YieldModel(study_, constraints_, scoring_).yield(design, score, plates_of(study_, true));
}

std::string StudyProblem::parameters_unknown() const {
  for (std::size_t t = 0; t < nominal_tasks(); ++t) {
    if (const std::string why = unknown_model(tasks_[t].finger); !why.empty()) return why;
  }
  return {};
}

bool StudyProblem::has_belief() const {
  for (std::size_t t = 0; t < nominal_tasks(); ++t) {
    if (tasks_[t].finger.belief.empty()) return false;
  }
  return true;
}

std::string StudyProblem::belief_absent() const {
  const Finger& first = tasks_.front().finger;
  for (std::size_t t = 0; t < nominal_tasks(); ++t) {
    const Scene scene = scene_of(task_design(study_, study_.design, tasks_[t]));
    if (scene.finger.belief.empty())
      return fmt::format(
          "finger \"{}\" names no belief: give its file belief = \"FILE\" (papilla calibrate "
          "makes one)",
          scene.finger.name);
    if (scene.finger.belief != first.belief)
      return fmt::format(
          "fingers \"{}\" and \"{}\" name different beliefs, whose members are not common to "
          "both: name one file in all fingers of the study",
          first.name, scene.finger.name);
    if (scene.model != scene.finger.calibrated_for)
      return fmt::format(
          "the belief of finger \"{}\" is of other model options than [model]: leave [model] "
          "out, or calibrate with these options",
          scene.finger.name);
  }
  return {};
}

std::string StudyProblem::model_source() const {
  return has_belief() ? "belief about finger and model" : "the fit of the finger";
}

std::size_t StudyProblem::residuals() const {
  const bool squares =
      objectives().size() == 1 && objectives()[0].aimed && goals_.risk.kind == Risk::Kind::Mean;
  return squares ? nominal_tasks() * study_.design.environment.relative_humidity.size() : 0;
}

std::vector<double> StudyProblem::minimised(const Score& score) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < objectives().size(); ++k)
    out.push_back(objectives()[k].maximise ? -score.values[k] : score.values[k]);
  return out;
}

Outcome StudyProblem::outcome(const Score& score) const {
  Outcome out;
  out.ok = score.ok;
  if (!score.ok) {
    out.reason = score.reason;
    return out;
  }
  out.objectives = minimised(score);
  out.constraints = constraints_.violations(score);
  out.residuals = score.residuals;
  return out;
}

bool StudyProblem::feasible(const Score& score, const Design& design) const {
  return score.ok && constraints_.kept(design, score);
}

std::string StudyProblem::identity() const {
  std::string out = fmt::format("papilla {}, records {}\n", PAPILLA_VERSION, kProtocol) +
                    content_of(study_.design);
  for (const Variable& v : study_.variables) {
    out += fmt::format("{} {:a} {:a}", v.path, v.low, v.high);
    for (double c : v.choices) out += fmt::format(" {:a}", c);
    for (const Excluded& e : v.excluded) out += fmt::format(" without {:a} {:a}", e.from, e.to);
    out += '\n';
  }
  for (const StudyObjective& o : goals_.objectives)
    out += (o.maximise ? "max " : "min ") + o.name + "\n";
  for (const Scatter& s : study_.scatter) {
    const char* kind = s.kind == Scatter::Kind::Normal ? "sigma" : "+-";
    out += fmt::format("{} {} {:a}\n", s.path, kind, s.tolerance);
  }
  for (const ScatterCorrelation& c : study_.correlations)
    out += fmt::format("{} with {} {:a}\n", c.first, c.second, c.value);
  out += study_.objective.risk + "\n";
  for (const Constraint& c : study_.constraints)
    out += fmt::format("{} {:a}\n", limit_name(c.on), c.limit);
  for (const StudyTask& t : tasks_) {
    Design touched_by;
    touched_by.finger = t.finger;
    out += fmt::format("{} {:a}\n", t.name, t.weight) + content_of(touched_by);
    for (const Setting& s : t.settings) out += fmt::format("{} {:a}\n", s.path, s.value);
  }
  return out +
         fmt::format("{} {} {}\n", study_.search.method, study_.search.seed, study_.search.drafts);
}

std::vector<std::string> study_warnings(const StudyProblem& problem) {
  std::vector<std::string> out;
  if (const auto wrong = problem.constraints().contradiction()) {
    if (!wrong->flat_keeps) throw InputError(wrong->text);
    out.push_back(wrong->text + "; only the flat surface is left");
  }
  const std::string absent = problem.belief_absent();
  if (absent.empty()) return out;
  // A resolved file states the usual [risk] of every study.
  if (problem.study().risk != StudyRisk{})
    throw InputError("risk: no belief decides what to build, as " + absent +
                     "; or leave [risk] out");
  const std::vector<StudyTask>& tasks = problem.tasks();
  if (std::any_of(tasks.begin(), tasks.end(),
                  [](const StudyTask& t) { return !t.finger.belief.empty(); }))
    out.push_back("no belief decides what to build, the fit of the fingers does: " + absent);
  return out;
}

void require_fitted_fingers(const StudyProblem& problem, const std::string& file,
                            const std::string& way_out) {
  std::vector<Design> touched;
  for (const StudyTask& task : problem.tasks()) {
    if (task.nominal())
      touched.push_back(task_design(problem.study(), problem.study().design, task));
  }
  require_fitted_model(touched, file, way_out);
}

int default_evaluations(const Study& study) {
  const int n = static_cast<int>(study.variables.size());
  const std::size_t objectives = study.objective.maximise.size() + study.objective.minimise.size() +
                                 study.objective.targets.size();
  const bool surrogate =
      (study.search.method == "auto" && objectives <= 2) || study.search.method == "bayesian";
  return surrogate ? std::clamp(25 * n, 20, 100) : std::clamp(50 * n, 50, 400);
}

SearchProblem search_problem(const StudyProblem& problem) {
  const Study& study = problem.study();
  const StudyConstraints& constraints = problem.constraints();
  const DesignSpace& space = problem.space();
  SearchProblem p;
  p.space = space.cube();
  p.objectives = problem.objectives().size();
  p.constraints = constraints.evaluated();
  p.residuals = problem.residuals();
  p.cheap_constraints = [&constraints](const Point& u) { return constraints.geometry(u); };
  if (!constraints.in_look().empty()) {
    // Each point is asked of again when it is evaluated and counted.
    p.costly_constraints = [&constraints,
                            known = std::make_shared<std::map<Point, Point>>()](const Point& u) {
      const auto [it, is_new] = known->try_emplace(u);
      if (is_new) it->second = constraints.look(u);
      return it->second;
    };
  }
  if (space.has_features()) p.features = [&space](const Point& u) { return space.features(u); };
  p.starts = space.starts();
  p.evaluations =
      study.search.evaluations > 0 ? study.search.evaluations : default_evaluations(study);
  p.seed = static_cast<std::uint64_t>(study.search.seed);
  if (choose_method(study.search.method, p).name == "bayesian") p.drafts = study.search.drafts;
  return p;
}

}  // namespace papilla::search
