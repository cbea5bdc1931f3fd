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
#include <array>
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
#include "numerics/statistics.h"
#include "search/levels.h"
#include "search/run.h"
#include "search/task.h"
#include "tests/temporary.h"

using namespace papilla::tests;

namespace {

// Skins of a truth, twice as many as of a confirmation, so many of them in the 3-D field; where the
// sets of skins start.
constexpr int kTruthSkins = 20, kTruthFields = 2;
constexpr std::array kTruthSets{3000, 4000};

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

// A design where the truth is a member, every task at that member's finger and model; without one,
// as the finger is.
Score true_score(const StudyProblem& problem, const Design& design, int first_skin,
                 std::optional<std::size_t> member) {
  Fidelity fidelity = stage_fidelity(problem, Stage::Confirm);
  fidelity.threads = 0;
  fidelity.first_skin = first_skin;
  fidelity.skins = kTruthSkins;
  fidelity.field_skins = kTruthFields;
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
      members.push_back(evaluate_steps(problem, f.design, t, {few}));
    add_members(problem, members, f);
    out.push_back(std::move(f));
  }
  return out;
}

// What the designs are worth at a member, or as the finger is, by each set of skins.
class Truth {
 public:
  Truth(const StudyProblem& problem, const std::vector<FinalDesign>& designs, const PickRule& rule,
        const std::vector<ObjectiveRange>& ranges, std::optional<std::size_t> member) {
    for (const int first_skin : kTruthSets) {
      MemberWorth worth{{1}, {}, {}};
      for (const FinalDesign& f : designs) {
        const Score score = true_score(problem, f.design, first_skin, member);
        worth.worth.push_back(
            {score.ok ? pick_worth(rule, pick_candidate(problem, score), ranges) : std::nan("")});
        worth.kept.push_back({{problem.feasible(score, f.design)}});
      }
      prospects_.push_back(prospects(worth, {}));
      sets_.push_back(std::move(worth));
    }
  }

  double worth(std::size_t set, std::size_t design) const { return sets_[set].worth[design][0]; }
  double worth(std::size_t design) const { return (worth(0, design) + worth(1, design)) / 2; }
  double share_of_best(std::size_t design) const {
    return (prospects_[0][design].p_best + prospects_[1][design].p_best) / 2;
  }
  // How much more the best by one set is worth by the other: no set flatters what it has chosen.
  double regret(std::size_t choice) const {
    double sum = 0;
    for (std::size_t set = 0; set < 2; ++set) {
      const std::vector<Prospect>& other = prospects_[1 - set];
      sum += other[choice].regret - other[chosen(prospects_[set], 0)].regret;
    }
    return sum / 2;
  }
  // Standard error of a worth, without what the skins do to all designs alike.
  double error() const {
    std::vector<double> differences;
    for (std::size_t i = 0; i < sets_[0].worth.size(); ++i) {
      if (!std::isnan(worth(i))) differences.push_back(worth(0, i) - worth(1, i));
    }
    return mean_estimate(differences).se * std::sqrt(static_cast<double>(differences.size())) / 2;
  }

 private:
  std::vector<MemberWorth> sets_;
  std::vector<std::vector<Prospect>> prospects_;
};

struct Sums {
  double by_belief = 0, by_fit = 0, expected = 0, error = 0, spread = 0, noise = 0;
  int differences = 0;
  std::vector<double> said, so, scatter;
};

template <class Said>
void print_worth(std::size_t designs, const Said& said, const Truth& truth) {
  fmt::print("# said, is by either set:");
  for (std::size_t i = 0; i < designs; ++i)
    fmt::print(" {:.4f} {:.4f} {:.4f}{}", said(i), truth.worth(0, i), truth.worth(1, i),
               i + 1 < designs ? "," : "\n");
  std::fflush(stdout);
}

int planted_truths(const std::string& file, const std::string& front, std::size_t most, int members,
                   std::size_t truths) {
  const Study study = study_of(file, members);
  const StudyProblem problem(study);
  const std::vector<FinalDesign> designs = judged(problem, read_front(front, problem, most));
  std::vector<PickCandidate> candidates;
  for (const FinalDesign& f : designs) candidates.push_back(pick_candidate(problem, f.confirmed));
  if (candidates.size() < 2) throw InputError(front + ": fewer than two designs keep every limit");
  const PickRule rule = read_pick_rule("", candidates[0].names, problem.driven());
  std::vector<MemberWorth> by_objective;
  for (std::size_t k = 0; k < candidates[0].names.size(); ++k)
    by_objective.push_back(member_worth(problem, designs, {PickRule::Kind::Objective, k}, {}));
  const std::vector<ObjectiveRange> ranges = ranges_over_belief(candidates, by_objective);
  const MemberWorth all = member_worth(problem, designs, rule, ranges);
  const std::size_t by_fit = pick_design("", candidates, ranges);
  constexpr std::size_t kBins = 4;
  Sums sums;
  sums.said = sums.so = sums.scatter = std::vector<double>(kBins, 0);
  fmt::print("truth,hypothesis,by belief,p(best),expected regret,regret,by the fit,its regret\n");
  truths = std::min(truths, all.weights.size());
  const auto row = [&](std::size_t number, const std::string& name,
                       const std::vector<Prospect>& found, std::size_t choice, const Truth& truth) {
    fmt::print("{},{},{},{:.3f},{:.4f},{:.4f},{},{:.4f}\n", number, name, choice + 1,
               found[choice].p_best, found[choice].regret, truth.regret(choice), by_fit + 1,
               truth.regret(by_fit));
  };
  {
    const Truth truth(problem, designs, rule, ranges, {});
    const std::vector<Prospect> found = prospects(all, problem.belief_risk());
    row(0, "the finger as it is", found, chosen(found, study.risk.limits), truth);
    print_worth(
        designs.size(), [&](std::size_t i) { return pick_worth(rule, candidates[i], ranges); },
        truth);
  }
  for (std::size_t k = 0; k < truths; ++k) {
    const std::size_t t = k * all.weights.size() / truths;
    MemberWorth others = all;
    others.weights[t] = 0;
    const std::vector<Prospect> found = prospects(others, problem.belief_risk());
    const std::size_t choice = chosen(found, study.risk.limits);
    const Truth truth(problem, designs, rule, ranges, t);
    for (std::size_t i = 0; i < designs.size(); ++i) {
      const std::size_t bin =
          std::min(kBins - 1, static_cast<std::size_t>(kBins * found[i].p_best));
      sums.said[bin] += found[i].p_best;
      sums.scatter[bin] += found[i].p_best * (1 - found[i].p_best);
      sums.so[bin] += truth.share_of_best(i);
      // What few skins say of the difference of two designs at this member.
      const double said = all.worth[i][t] - all.worth[choice][t],
                   is = truth.worth(i) - truth.worth(choice);
      if (i == choice || std::isnan(said - is)) continue;
      sums.error += square(said - is);
      sums.spread += square(is);
      ++sums.differences;
    }
    sums.by_belief += truth.regret(choice);
    sums.by_fit += truth.regret(by_fit);
    sums.expected += found[choice].regret;
    sums.noise += square(truth.error());
    row(t + 1, problem.belief()->members[t].hypothesis, found, choice, truth);
    print_worth(
        designs.size(), [&](std::size_t i) { return all.worth[i][t]; }, truth);
  }
  const auto n = static_cast<double>(truths);
  fmt::print("# {} designs, the best at each member is worth {:.4f} on average\n", designs.size(),
             best_worth(all));
  fmt::print("# mean regret: by belief {:.4f} (expected {:.4f}), by the fit {:.4f}\n",
             sums.by_belief / n, sums.expected / n, sums.by_fit / n);
  fmt::print(
      "# differences of two designs at the truth: root mean square {:.4f}, of what is said {:.4f} "
      "off it, which is known to {:.4f}\n",
      std::sqrt(sums.spread / sums.differences), std::sqrt(sums.error / sums.differences),
      std::sqrt(2 * sums.noise / n));
  for (std::size_t bin = 0; bin < kBins; ++bin)
    fmt::print("# p(best) {:.2f} to {:.2f}: {:.1f} said, {:.1f} true, binomial error {:.1f}\n",
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
