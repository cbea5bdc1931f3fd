// Planted truths: what recommendations are worth where the finger is one member of a belief that
// the recommendation does not know; CSV on standard output, a truth a row, then the sums.
//   decision_bench FILE FRONT MOST MEMBERS TRUTHS
//                    the designs of the table FRONT, at most MOST; TRUTHS members, evenly over all,
//                    are each left out of the belief and judged on other skins, four times as many
//                    and in four 3-D fields. MEMBERS 0: the study FILE as it is, with its fingers,
//                    its own belief and its level; else at level draft, so many drawn about its
//                    first finger, a fifth with the first droplet step 50 nm, a fifth with air by
//                    emission. First the finger as it is: what skins and the field alone leave
//                    open. What each design is said to be worth, and is, stands in a line below
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "bench/drawn_belief.h"
#include "bench/front_file.h"
#include "estimate/belief.h"
#include "forward/forward.h"
#include "search/levels.h"
#include "search/run.h"
#include "search/task.h"
#include "tests/temporary.h"

using namespace papilla::tests;

namespace {

// Skins of the truths start here: so many, so many of them in equilibrium and in the 3-D field,
// that the truths are known better than what is said of them.
constexpr int kFirstTruthSkin = 3000, kTruthSkins = 40, kTruthEquilibria = 16, kTruthFields = 4;

// Numbers of the finger times exp(s normal): skin, load, layer, water.
Belief planted(const Finger& finger, int members) {
  DrawnBelief out("decision_bench", finger, "planted belief");
  for (int m = 0; m < members; ++m) {
    BeliefMember& member = out.add(1.0 / members, 0.2, false);
    member.hypothesis = m % 5 == 3 ? "first droplet step 50 nm" : m % 5 == 4 ? "emission" : "fit";
    if (m % 5 == 3) member.set.push_back({"model.droplet_step", text_node("50 nm")});
    if (m % 5 == 4) member.set.push_back({"model.air_limit", text_node("emission")});
  }
  return out.take();
}

Study study_of(const std::string& file, int members) {
  Study study = read_study(file);
  if (members == 0) return study;
  study.design.accuracy.level = AccuracyLevel::Draft;
  if (!study.population.empty()) study.design.finger = study.population.front();
  study.population.clear();
  const std::string path = temporary("planted_belief.toml");
  std::ofstream(path) << belief_text(planted(study.design.finger, members));
  study.design.finger.belief = path;
  return study;
}

std::vector<TaskAnswer> confirmed(const StudyProblem& problem, const Design& design) {
  TaskWork work{stage_fidelity(problem, Stage::Confirm), true};
  work.fidelity.threads = 0;
  std::vector<TaskAnswer> out;
  for (std::size_t t = 0; t < problem.tasks().size(); ++t)
    out.push_back(evaluate_task(problem, design, t, work));
  return out;
}

// What a truth is judged by: the confirmation's level, on skins that nothing was chosen by.
Fidelity truth_fidelity(const StudyProblem& problem) {
  Fidelity out = stage_fidelity(problem, Stage::Confirm);
  out.threads = 0;
  out.first_skin = kFirstTruthSkin;
  out.skins = kTruthSkins;
  out.equilibrium_skins = kTruthEquilibria;
  out.field_skins = kTruthFields;
  return out;
}

// A design where the truth is a member, every task at that member's finger and model; without one,
// as the finger is.
Score true_score(const StudyProblem& problem, const Design& design,
                 std::optional<std::size_t> member) {
  const Fidelity fidelity = truth_fidelity(problem);
  std::vector<TaskAnswer> answers;
  for (const StudyTask& task : problem.tasks()) {
    const Design d = task_design(problem.study(), design, task);
    Scene scene = scene_of(d);
    if (member) scene = belief_scenes(*problem.belief(), scene)[*member];
    Response response = evaluate(scene, d.texture, fidelity);
    auto refused = complete(response, problem.goals(), scene, d, task.name, fidelity);
    answers.push_back(refused ? *std::move(refused)
                              : answer_of(problem.goals(), d, task.name, {std::move(response)}));
  }
  return problem.score(design, answers);
}

std::vector<FinalDesign> judged(const StudyProblem& problem, const std::vector<Point>& units) {
  std::vector<FinalDesign> out;
  for (const Point& unit : units) {
    FinalDesign f;
    f.unit = unit;
    f.design = problem.space().design(unit);
    f.answers = confirmed(problem, f.design);
    f.confirmed = problem.score(f.design, f.answers);
    f.feasible = problem.feasible(f.confirmed, f.design);
    if (!f.feasible) continue;
    Fidelity few = stage_fidelity(problem, Stage::Belief);
    few.threads = 0;
    std::vector<TaskAnswer> members;
    for (std::size_t t = 0; t < problem.nominal_tasks(); ++t)
      members.push_back(evaluate_steps(problem, f.design, t, few));
    add_members(problem, members, f);
    out.push_back(std::move(f));
  }
  return out;
}

struct Sums {
  double by_belief = 0, by_fit = 0, expected = 0, error = 0, spread = 0;
  int differences = 0;
  std::vector<double> said, so, scatter;
};

int planted_truths(const std::string& file, const std::string& front, std::size_t most, int members,
                   std::size_t truths) {
  const Study study = study_of(file, members);
  const StudyProblem problem(study);
  const std::vector<FinalDesign> designs = judged(problem, read_front(front, problem, most));
  std::vector<PickCandidate> candidates;
  for (const FinalDesign& f : designs) candidates.push_back(pick_candidate(problem, f.confirmed));
  if (candidates.size() < 2) throw InputError(front + ": fewer than two designs keep every limit");
  const PickRule rule = read_pick_rule("", candidates[0].names, problem.driven());
  const std::vector<Extent> extent = extents(candidates);
  const MemberWorth all = member_worth(problem, designs, rule, extent);
  const std::size_t by_fit = pick_design("", candidates);
  constexpr std::size_t kBins = 4;
  Sums sums;
  sums.said = sums.so = sums.scatter = std::vector<double>(kBins, 0);
  fmt::print("truth,hypothesis,by belief,p(best),expected regret,regret,by the fit,its regret\n");
  truths = std::min(truths, all.weights.size());
  const auto true_worth = [&](std::optional<std::size_t> member) {
    MemberWorth truth{{1}, {}, {}};
    for (const FinalDesign& f : designs) {
      const Score score = true_score(problem, f.design, member);
      truth.worth.push_back(
          {score.ok ? pick_worth(rule, pick_candidate(problem, score), extent) : std::nan("")});
      truth.kept.push_back({{problem.feasible(score, f.design)}});
    }
    return truth;
  };
  const auto print_worth = [&](const auto& said, const MemberWorth& truth) {
    fmt::print("# said:");
    for (std::size_t i = 0; i < designs.size(); ++i) fmt::print(" {:.4f}", said(i));
    fmt::print("; is:");
    for (const std::vector<double>& w : truth.worth) fmt::print(" {:.4f}", w[0]);
    fmt::print("\n");
    std::fflush(stdout);
  };
  const auto confirmed_worth = [&](std::size_t i) {
    return pick_worth(rule, candidates[i], extent);
  };
  print_worth(confirmed_worth, true_worth({}));
  for (std::size_t k = 0; k < truths; ++k) {
    const std::size_t t = k * all.weights.size() / truths;
    MemberWorth others = all;
    others.weights[t] = 0;
    const std::vector<Prospect> found = prospects(others, problem.belief_risk());
    const std::size_t choice = chosen(found, study.risk.limits);
    const MemberWorth truth = true_worth(t);
    const std::vector<Prospect> true_one = prospects(truth, {});
    for (std::size_t i = 0; i < designs.size(); ++i) {
      const std::size_t bin =
          std::min(kBins - 1, static_cast<std::size_t>(kBins * found[i].p_best));
      sums.said[bin] += found[i].p_best;
      sums.scatter[bin] += found[i].p_best * (1 - found[i].p_best);
      sums.so[bin] += true_one[i].p_best;
      // What few skins say of the difference of two designs at this member.
      const double said = all.worth[i][t] - all.worth[choice][t],
                   is = truth.worth[i][0] - truth.worth[choice][0];
      if (i == choice || std::isnan(said - is)) continue;
      sums.error += square(said - is);
      sums.spread += square(is);
      ++sums.differences;
    }
    sums.by_belief += true_one[choice].regret;
    sums.by_fit += true_one[by_fit].regret;
    sums.expected += found[choice].regret;
    fmt::print("{},{},{},{:.3f},{:.4f},{:.4f},{},{:.4f}\n", t + 1,
               problem.belief()->members[t].hypothesis, choice + 1, found[choice].p_best,
               found[choice].regret, true_one[choice].regret, by_fit + 1, true_one[by_fit].regret);
    print_worth([&](std::size_t i) { return all.worth[i][t]; }, truth);
  }
  const auto n = static_cast<double>(truths);
  fmt::print("# {} designs, the best at each member is worth {:.4f} on average\n", designs.size(),
             best_worth(all));
  fmt::print("# mean regret: by belief {:.4f} (expected {:.4f}), by the fit {:.4f}\n",
             sums.by_belief / n, sums.expected / n, sums.by_fit / n);
  fmt::print(
      "# differences of two designs at the truth: root mean square {:.4f}, error of few "
      "skins {:.4f}\n",
      std::sqrt(sums.spread / sums.differences), std::sqrt(sums.error / sums.differences));
  for (std::size_t bin = 0; bin < kBins; ++bin)
    fmt::print("# p(best) {:.2f} to {:.2f}: {:.1f} said, {:.0f} true, binomial error {:.1f}\n",
               static_cast<double>(bin) / kBins, static_cast<double>(bin + 1) / kBins,
               sums.said[bin], sums.so[bin], std::sqrt(sums.scatter[bin]));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 6) throw InputError("decision_bench FILE FRONT MOST MEMBERS TRUTHS");
    return planted_truths(argv[1], argv[2], static_cast<std::size_t>(std::atoi(argv[3])),
                          std::atoi(argv[4]), static_cast<std::size_t>(std::atoi(argv[5])));
  } catch (const InputError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
