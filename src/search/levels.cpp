#include "search/levels.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <filesystem>

#include "design/design.h"
#include "estimate/belief.h"
#include "forward/appearance.h"
#include "forward/plan.h"
#include "forward/price.h"
#include "search/building.h"
#include "search/stability.h"

namespace papilla::search {
namespace {

constexpr int kNarrowSkins = 500;  // skins of the level between start here
constexpr int kFreshSkins = 1000;  // the confirmation's: none of what came before
// Designs that the level between judges: one for so many evaluations of the search, at most.
constexpr int kEvaluationsPerNarrowing = 3;
constexpr int kMostNarrowings = 32;
// Steps of the parameters: skins over all fingers, pixels. Members of belief: skins over all
// fingers, and of each at least, as what they do differs from skin to skin.
constexpr int kStepSkins = 12, kMembersSkins = 8, kLeastMemberSkins = 4, kStepGrid = 64;
// Peak of a process, measured at 128, 256, 512 and 1024 pixels per side (53, 62, 104 and 262 MB):
// heights, gap, pressure, tractions, field and their transforms.
constexpr double kBytesOfProgram = 50e6, kBytesPerPixel = 210;
// Of designs for those to come a worker keeps kernels of 32 bytes a pixel (contact/kernel.cpp),
// skins of 8 (forward/patch_setup.cpp), their waves and what films do, and, of members of belief,
// gaps of the ridges (forward/ridges.cpp). What the allocator and small tables add is measured: a
// worker of the default study has 368 MB.
constexpr double kKernels = 64, kMostKernelPixels = 1 << 24, kSkins = 256, kMostSkinBytes = 64e6,
                 kWavesAndFilms = 384, kMostOfThem = 128e6, kBytesOfMembers = 72e6, kAdded = 1.25;
double kept_bytes(double pixels, bool belief) {
  return kAdded * (32 * std::min(kKernels * pixels, kMostKernelPixels) +
                   std::min(8 * kSkins * pixels, kMostSkinBytes) +
                   std::min(kWavesAndFilms * pixels, kMostOfThem) + (belief ? kBytesOfMembers : 0));
}
// Where time is short: skins are given up first, down to these, then pixels, then more skins.
constexpr int kFewSkins = 8, kFewestSkins = 4, kFewPixels = 64;
// Pixels of the search: so many across the smallest feature of the space (docs/theory/search.md).
constexpr int kSearchPixels = 64, kMostSearchPixels = 256;
constexpr double kPixelsPerFeature = 2;

int search_grid(const StudyProblem& problem) {
  int grid = kSearchPixels;
  while (grid < kMostSearchPixels &&
         kWindow / grid > problem.smallest_feature() / kPixelsPerFeature)
    grid *= 2;
  return grid;
}

// The cheapest that ranks designs as well as other skins at the level above do: eight skins in all,
// four per finger at least, four of them in equilibrium, as it is the load law that scatters
// (docs/theory/search.md). More designs for the same time find more than surer numbers do.
Fidelity search_fidelity(const StudyProblem& problem) {
  const Study& study = problem.study();
  Fidelity f = fidelity_level("search");
  f.seed = static_cast<std::uint64_t>(study.search.seed);
  f.level = "steer";
  f.grid = search_grid(problem);
  f.skins = std::max(4, f.skins / std::max(1, static_cast<int>(study.population.size())));
  return f;
}

// Every finger, two skins: what half of that cost knows best.
Fidelity draft_fidelity(const StudyProblem& problem) {
  Fidelity f = search_fidelity(problem);
  f.skins = 2;
  return f;
}

// Between search and confirmation: what the field rule lacks is not alike for all kinds and depths
// and decides their order, so the pull is corrected to the 3-D field of a skin; other skins, twice
// as many. A third of the search's scatter about design level in the mean modulation, a tenth of
// the confirmation's cost (`stack_bench order`, results/search/stack_order.csv).
Fidelity narrow_fidelity(const StudyProblem& problem) {
  Fidelity f = search_fidelity(problem);
  f.level = "narrow";
  f.first_skin = kNarrowSkins;
  f.skins *= 2;
  f.field_skins = 1;
  return f;
}

// For one design on its own, one finger, one choice of the model, a small step: as between search
// and confirmation, so that its numbers are near the confirmed ones.
Fidelity check_fidelity(const StudyProblem& problem) {
  Fidelity f = narrow_fidelity(problem);
  f.level = "check";
  f.first_skin = 0;
  f.skins = fidelity_level("search").skins;
  return f;
}

// The finger population shares the samples of the level, those of the 3-D field too: the mean over
// fingers is as sure as one finger at that level.
Fidelity confirm_fidelity(const Study& study, std::size_t tasks) {
  Fidelity f = fidelity_of(study.design);
  f.seed = static_cast<std::uint64_t>(study.search.seed);
  f.first_skin = kFreshSkins;
  f.skins = std::max(10, f.skins / static_cast<int>(tasks));
  f.field_skins = std::max(1, f.field_skins / static_cast<int>(tasks));
  return f;
}

// Of the study's own design: the same for all, so that they keep common skins.
Plan plan_at(const StudyProblem& problem, const Fidelity& fidelity) {
  const Design& d = problem.study().design;
  return make_plan(scene_of(d), d.texture, fidelity);
}

// Of the pen, where a goal is about it [s].
double pen_seconds(const StudyProblem& problem, const Fidelity& fidelity) {
  if (!problem.goals().pen) return 0;
  const Design d = under_pen(problem.study().design);
  return make_plan(scene_of(d), d.texture, fidelity).seconds();
}

// What a plan does not know: each target of voltage_for is found by driving the same patches four
// to six times at every humidity. By the load law these are fields alone: 0.87 of an evaluation at
// level draft (the surface of designs/electroadhesive_glass), 2.1 to 2.3 of one that solves no 3-D
// field, as in a search (holes, FieldStudy.ThePriceOfAnEvaluationKnowsItsVoltages); with solved
// areas contacts too (level design: 2.3).
constexpr double kVoltageByLoads = 0.9, kVoltageByRuleAlone = 2.1, kVoltageByAreas = 2.3;
// The branch to pull-in, over an evaluation: a few patches in many states.
constexpr double kPullIn = 1;

// Of a task's model part.
ModelCost steps_cost(const StudyProblem& problem, const Fidelity& confirmed) {
  const Fidelity few = steps_fidelity(problem, confirmed);
  const Design& design = problem.study().design;
  const Design own = task_design(problem.study(), design, problem.tasks().front());
  return model_cost(scene_of(own), few, few.skins);
}

double priced(const StudyProblem& problem, const Fidelity& fidelity) {
  const double each = fidelity.estimator == Estimator::Area ? kVoltageByAreas
                      : fidelity.field_skins > 0            ? kVoltageByLoads
                                                            : kVoltageByRuleAlone;
  const auto targets = static_cast<double>(problem.goals().voltage_targets.size());
  const double pull_in = problem.goals().pull_in ? kPullIn : 0;
  return plan_at(problem, fidelity).seconds() * (1 + each * targets + pull_in) +
         pen_seconds(problem, fidelity);
}

Fidelity full_fidelity(const StudyProblem& problem, Stage stage) {
  const Study& study = problem.study();
  switch (stage) {
    case Stage::Search:
      return search_fidelity(problem);
    case Stage::Draft:
      return draft_fidelity(problem);
    case Stage::Narrow:
      return narrow_fidelity(problem);
    case Stage::Confirm:
    case Stage::Rounding:
    case Stage::Steps:
    case Stage::Belief:
      return confirm_fidelity(study, problem.nominal_tasks());
    case Stage::Stability:
    case Stage::Sensitivity:
    case Stage::Done:
      break;
  }
  return check_fidelity(problem);
}

}  // namespace

Fidelity stage_fidelity(const StudyProblem& problem, Stage stage, double most_seconds) {
  Fidelity f = full_fidelity(problem, stage);
  const auto too_dear = [&] { return most_seconds > 0 && priced(problem, f) > most_seconds; };
  while (f.skins > kFewSkins && too_dear()) --f.skins;
  while (f.grid > kFewPixels && too_dear()) f.grid /= 2;
  while (f.skins > kFewestSkins && too_dear()) --f.skins;
  return f;
}

std::size_t designs_with_model_part(const StudyProblem& problem, const SearchProblem& search) {
  if (problem.belief()) return 1;
  return problem.has_belief() ? most_finalists(search) : 2;
}

Fidelity steps_fidelity(const StudyProblem& problem, Fidelity confirmed) {
  const auto tasks = static_cast<int>(problem.nominal_tasks());
  const int wanted = problem.belief() ? std::max(kLeastMemberSkins, kMembersSkins / tasks)
                                      : std::max(2, kStepSkins / tasks);
  confirmed.skins = std::min(confirmed.skins, wanted);
  confirmed.grid = std::min(kStepGrid, confirmed.grid);
  return confirmed;
}

std::size_t narrowings(const SearchProblem& p) {
  if (p.objectives > 2 || p.space.single_point()) return 0;
  return static_cast<std::size_t>(
      std::min(kMostNarrowings, p.evaluations / kEvaluationsPerNarrowing));
}

std::size_t most_finalists(const SearchProblem& p) {
  return std::min(kFinalists, static_cast<std::size_t>(p.evaluations)) + 1;
}

double task_price(const StudyProblem& problem, Stage stage, double most_seconds) {
  const Fidelity f = stage_fidelity(problem, stage, most_seconds);
  if (stage != Stage::Steps && stage != Stage::Belief) return priced(problem, f);
  const ModelCost cost = steps_cost(problem, f);
  // Who feels it is said with the errors of the confirmed modulation (evaluate_steps).
  const double confirmed = problem.goals().felt ? plan_at(problem, f).seconds() : 0;
  if (problem.belief()) return confirmed + cost.runs * priced(problem, cost.fidelity);
  return confirmed + cost.runs * plan_at(problem, cost.fidelity).seconds();
}

double over_price(Stage stage) {
  switch (stage) {
    case Stage::Narrow:
      return 1.15;
    case Stage::Confirm:
      return 1.5;
    case Stage::Rounding:
      return 1.4;
    case Stage::Belief:
      return 0.9;
    case Stage::Steps:
    case Stage::Stability:
      return 0.8;
    case Stage::Search:
    case Stage::Draft:
    case Stage::Sensitivity:
    case Stage::Done:
      break;
  }
  return 1;
}

int processors_for(const Study& study) {
  const int processors = omp_get_num_procs();
  return study.search.jobs > 0 ? std::min(study.search.jobs, processors) : processors;
}

double search_pace(const StudyProblem& problem) {
  const Study& study = problem.study();
  std::vector<Scene> scenes;
  for (std::size_t t = 0; t < problem.nominal_tasks(); ++t)
    scenes.push_back(scene_of(task_design(study, study.design, problem.tasks()[t])));
  return machine_pace(scenes, study.design.texture, stage_fidelity(problem, Stage::Search));
}

StudyCost study_cost(const StudyProblem& problem) {
  const Study& study = problem.study();
  const SearchProblem search = search_problem(problem);
  StudyCost out;
  out.evaluations = search.evaluations;
  out.tasks = static_cast<int>(problem.tasks().size());
  out.narrowed = narrowings(search);
  out.finalists = most_finalists(search);
  if (YieldModel::exists(study)) out.plates = plates_of(study, true);
  const auto price = [&](std::size_t tasks, Stage stage) {
    return static_cast<double>(tasks) * over_price(stage) * task_price(problem, stage);
  };
  const std::size_t tasks = problem.tasks().size(), variables = search.space.size();
  out.seconds = price(static_cast<std::size_t>(search.evaluations) * tasks, Stage::Search) +
                price(out.narrowed * tasks, Stage::Narrow) +
                // Finalists, the surface without texture twice, designs of the fab's grid.
                price((out.finalists + 2 + kJudgedOnGrid) * tasks, Stage::Confirm) +
                price((out.finalists - 1) * stability_variants(problem).size(), Stage::Stability) +
                price((1 + 2 * variables) * tasks, Stage::Sensitivity);
  if (problem.parameters_unknown().empty())
    out.seconds +=
        price(designs_with_model_part(problem, search) * problem.nominal_tasks(), Stage::Steps);
  if (problem.belief()) {
    out.members = problem.belief()->members.size();
    out.belief_seconds = price(out.finalists * problem.nominal_tasks(), Stage::Belief);
    out.seconds += out.belief_seconds;
  }
  const StudyConstraints& constraints = problem.constraints();
  const std::size_t looks =
      constraints.in_look().empty() ? 0 : constraints.looked_at(study.design).size();
  const auto searched = static_cast<std::size_t>(search.evaluations + search.drafts);
  const std::size_t drawn = searched + out.narrowed + 1 + 2 * variables;
  out.seconds += yield_price(study, looks, drawn, out.finalists + 2 + kJudgedOnGrid);
  if (problem.goals().looks) out.looked_at = drawn + kJudgedOnGrid;
  out.pixels = stage_fidelity(problem, Stage::Search).grid;
  out.feature = problem.smallest_feature();
  out.feature_pixels = out.feature * out.pixels / kWindow;
  const auto pixels =
      static_cast<double>(plan_at(problem, stage_fidelity(problem, Stage::Confirm)).grid.size());
  out.bytes = kBytesOfProgram + kBytesPerPixel * pixels + kept_bytes(pixels, problem.has_belief());
  return out;
}

namespace {

// The study's own design in each scenario; none where no metric and no limit asks for looks.
std::vector<Design> own_looks(const StudyProblem& problem) {
  if (!problem.goals().looks) return {};
  return problem.constraints().looked_at(problem.study().design);
}

}  // namespace

std::string look_theory(const StudyProblem& problem) {
  const std::vector<Design> seen = own_looks(problem);
  if (seen.empty()) return {};
  const Design& first = seen.front();
  return optics_theory(first.texture, first.surface, first.view);
}

double look_price(const StudyProblem& problem) {
  double out = 0;
  for (const Design& d : own_looks(problem)) out += work_seconds([&] { appearance_of(d); });
  return out;
}

std::string search_plan(const StudyProblem& problem) {
  const Study& study = problem.study();
  const SearchProblem search = search_problem(problem);
  const SearchMethod method = choose_method(study.search.method, search);
  std::string out =
      fmt::format("search: {} ({}), {}{} evaluations, seed {}\n", method.name, method.why,
                  search.drafts > 0 ? fmt::format("{} drafts, ", search.drafts) : "",
                  search.evaluations, study.search.seed);
  out += "tasks of an evaluation (finger, scenario):";
  for (const StudyTask& task : problem.tasks()) out += " [" + task.name + "]";
  const auto level = [&](Stage stage) {
    return plan_at(problem, stage_fidelity(problem, stage)).text();
  };
  out += "\n\nsearch level:\n" + level(Stage::Search);
  if (narrowings(search) > 1) {
    out += fmt::format("\n{} of them and of their neighbours again, other skins:\n",
                       narrowings(search)) +
           level(Stage::Narrow);
  }
  out +=
      fmt::format("\nconfirmation of up to {} finalists, fresh skins:\n", most_finalists(search)) +
      level(Stage::Confirm);
  if (problem.belief()) {
    const ModelCost cost = steps_cost(problem, stage_fidelity(problem, Stage::Belief));
    out += fmt::format(
               "\nfinalists at the {} members of the belief in {}, for which of them to build:\n",
               problem.belief()->members.size(),
               std::filesystem::path(problem.belief()->file).filename().string()) +
           plan_at(problem, cost.fidelity).text();
  }
  return out;
}

}  // namespace papilla::search
