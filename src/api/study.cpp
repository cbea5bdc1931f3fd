#include "papilla/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "api/inside.h"
#include "config/writer.h"
#include "design/title.h"
#include "metrics/shown.h"
#include "optim/search.h"
#include "report/results.h"
#include "report/summary.h"
#include "search/levels.h"
#include "search/task.h"

namespace papilla::api {

struct Study::Inside {
  rooms::Study study;
  std::optional<StudyProblem> problem;  // refers to the study
  std::vector<Variable> variables;
  std::vector<Objective> objectives;
};

namespace {

std::shared_ptr<const Study::Inside> judged_by(const Design& design) {
  const rooms::Study& study = design.inside().study;
  if (!study.is_study()) throw rooms::InputError("expected a study: it has no [design_space]");
  design.require_simulated();
  auto inside = std::make_shared<Study::Inside>();
  inside->study = study;
  inside->problem.emplace(inside->study);
  for (const rooms::Variable& v : inside->study.variables) {
    Variable out{v.path, v.unit, v.low, v.high, v.choices, {}};
    if (v.is_kind())
      for (const double choice : v.choices) out.names.push_back(variable_text(v, choice));
    inside->variables.push_back(std::move(out));
  }
  for (const StudyObjective& o : inside->problem->objectives())
    inside->objectives.push_back({o.name, o.maximise, rooms::si_unit(o.expression)});
  return inside;
}

Judgement judgement_of(const StudyProblem& problem, const Score& score) {
  Judgement out{score.ok, score.reason, score.values, score.errors, {}};
  if (score.ok) out.violations = problem.constraints().violations(score);
  return out;
}

// Of the search the objectives alone are kept.
Judgement searched_judgement(const Score& score) {
  return {score.ok, score.reason, score.values, score.errors, {}};
}

// Of values of the space, as a search has it, and of the study's own beside it, exactly these.
// Throws rooms::InputError for others.
rooms::Design design_at(const StudyProblem& problem, const std::vector<double>& values) {
  const DesignSpace& space = problem.space();
  if (values.size() != space.size()) {
    throw wrong("values", fmt::format("expected one value for each of {} variables, got {}",
                                      space.size(), values.size()));
  }
  const rooms::Point unit = space.unit(values);
  std::vector<double> taken = space.value(unit);
  bool beside = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (space.own_is_beside(i) && values[i] == space.own_values()[i]) {
      taken[i] = values[i];
      beside = true;
      continue;
    }
    const rooms::Variable& v = problem.study().variables[i];
    const double slack = 1e-9 * std::max(std::abs(v.low), std::abs(v.high));
    if (!(values[i] >= v.low - slack && values[i] <= v.high + slack)) {
      throw wrong(v.path,
                  fmt::format("{:.6g} is outside {:.6g} to {:.6g}", values[i], v.low, v.high));
    }
  }
  return beside ? space.design_of(taken) : space.design(space.snapped(unit));
}

// Throws rooms::InputError where a judgement that is ok lacks a number.
void require_numbers(const StudyProblem& problem, const Judgement& judgement) {
  const auto known = [](const std::vector<double>& numbers, std::size_t count) {
    return numbers.size() == count &&
           std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
  };
  const std::size_t objectives = problem.objectives().size(),
                    violations = problem.constraints().evaluated();
  if (!judgement.ok ||
      (known(judgement.values, objectives) && known(judgement.violations, violations)))
    return;
  throw wrong("judgements",
              fmt::format("expected {} finite values and {} violations of a design that is ok; of "
                          "one that could not be judged say ok = false",
                          objectives, violations));
}

// As searchers are told: minimised.
Outcome outcome_of(const StudyProblem& problem, const Judgement& judgement) {
  Outcome out;
  out.ok = judgement.ok;
  out.reason = judgement.reason;
  for (std::size_t k = 0; k < judgement.values.size(); ++k) {
    const bool maximise = k < problem.objectives().size() && problem.objectives()[k].maximise;
    out.objectives.push_back(maximise ? -judgement.values[k] : judgement.values[k]);
  }
  out.constraints = judgement.violations;
  return guarded(std::move(out), problem.objectives().size(), problem.constraints().evaluated());
}

}  // namespace

Study Study::read(const std::string& file, const Design::Values& values) {
  return across([&] { return Study(judged_by(Design::read(file, values))); });
}

Study Study::parse(const std::string& toml, const Design::Values& values) {
  return across([&] { return Study(judged_by(Design::parse(toml, values))); });
}

const std::vector<Variable>& Study::variables() const { return inside_->variables; }

const std::vector<Objective>& Study::objectives() const { return inside_->objectives; }

std::size_t Study::violations() const { return inside_->problem->constraints().evaluated(); }

Design Study::design(const std::vector<double>& values) const {
  return across([&] {
    Design::Inside made;
    made.study.design = design_at(*inside_->problem, values);
    made.study.design.title = title_as_changed(inside_->study.design, made.study.design);
    made.text = to_toml(made.study.design);
    made.study = parse_study(made.text, "design.toml", {}, DesignUse::Drawn);
    return Design(std::make_shared<const Design::Inside>(std::move(made)));
  });
}

std::vector<double> Study::own_values() const { return inside_->problem->space().own_values(); }

Judgement Study::judge(const std::vector<double>& values, int threads,
                       const std::atomic<bool>* stop, bool force) const {
  return across([&] {
    require_threads(threads);
    const StudyProblem& problem = *inside_->problem;
    if (!force) require_fitted_fingers(problem, "", "set `force`");
    const rooms::Design design = design_at(problem, values);
    if (const std::string refused = problem.constraints().geometry_reason(design); !refused.empty())
      return Judgement{false, refused, {}, {}, {}};
    Watch watch({}, stop);
    TaskWork work{stage_fidelity(problem, Stage::Search)};
    work.fidelity.threads = threads;
    std::vector<TaskAnswer> answers;
    for (std::size_t task = 0; task < problem.tasks().size(); ++task)
      answers.push_back(evaluate_task(problem, design, task, work));
    return judgement_of(problem, problem.score(design, answers));
  });
}

RunResult Study::run(const std::string& folder, const RunOptions& options) const {
  return across([&] {
    if (options.finish && !options.resume)
      throw wrong("finish", "goes on with a run that was interrupted: resume it");
    OptimiseOptions inside;
    inside.folder = folder;
    inside.resume = options.resume;
    inside.finish = options.finish;
    inside.pick = options.pick;
    inside.stop = options.stop;
    if (options.progress) {
      inside.progress = [&](const Progress& p) {
        options.progress({p.stage, p.done, p.total, p.seconds_left});
      };
    }
    const StudyProblem& problem = *inside_->problem;
    if (!options.force) require_fitted_fingers(problem, "", "set `force`");
    const OptimiseResult result = optimise_to_folder(inside_->study, inside);
    RunResult out;
    out.interrupted = result.interrupted;
    out.any_feasible = result.any_feasible;
    out.evaluations = result.evaluations;
    for (const FinalDesign& f : result.finalists)
      out.finalists.push_back({problem.space().value(f.unit), searched_judgement(f.searched),
                               judgement_of(problem, f.confirmed), f.folder});
    out.best = result.best;
    if (!result.interrupted) out.table = result_table(inside_->study, result);
    return out;
  });
}

struct Search::Inside {
  Study study;  // keeps what the searcher refers to
  std::unique_ptr<Searcher> searcher;
  std::vector<rooms::Point> asked;
  std::size_t left = 0;  // of the evaluations of the study, after those that were told

  const StudyProblem& problem() const { return *study.inside().problem; }
};

Search::Search(const Study& study) : inside_(new Inside{study, nullptr, {}, 0}) {
  across([&] {
    SearchProblem search = search_problem(inside_->problem());
    search.residuals = 0;  // a judgement has none
    search.drafts = 0;
    inside_->left = static_cast<std::size_t>(search.evaluations);
    inside_->searcher =
        make_searcher(choose_method(study.inside().study.search.method, search), search);
  });
}

Search::Search(Search&&) noexcept = default;
Search& Search::operator=(Search&&) noexcept = default;
Search::~Search() = default;

std::vector<std::vector<double>> Search::ask() {
  return across([&] {
    if (!inside_->asked.empty()) {
      throw wrong("ask", fmt::format("tell() first what the {} designs of the last ask() are worth",
                                     inside_->asked.size()));
    }
    if (inside_->left > 0) inside_->asked = inside_->searcher->ask();
    inside_->asked.resize(std::min(inside_->asked.size(), inside_->left));
    std::vector<std::vector<double>> out;
    for (const rooms::Point& unit : inside_->asked)
      out.push_back(inside_->problem().space().value(unit));
    return out;
  });
}

void Search::tell(const std::vector<Judgement>& judgements) {
  across([&] {
    if (judgements.size() != inside_->asked.size())
      throw wrong("judgements", "expected one per design that was asked for");
    for (const Judgement& judgement : judgements) require_numbers(inside_->problem(), judgement);
    std::vector<Evaluation> told;
    for (std::size_t i = 0; i < judgements.size(); ++i)
      told.push_back({inside_->asked[i], outcome_of(inside_->problem(), judgements[i])});
    inside_->searcher->tell(told);
    inside_->left -= told.size();
    inside_->asked.clear();  // each answer counts once
  });
}

}  // namespace papilla::api
