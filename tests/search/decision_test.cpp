// Which finalist a run recommends where its finger names a belief; formulas answer.
#include "search/decision.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "base/error.h"
#include "base/text.h"
#include "base/watch.h"
#include "report/decision.h"
#include "report/grounds.h"
#include "report/recommendation.h"
#include "report/run_json.h"
#include "report/stated_number.h"
#include "search/levels.h"
#include "tests/search/formula_run.h"
#include "tests/support/refusal.h"
#include "tests/support/thorough.h"

namespace papilla::tests::decision_test {
namespace {

// Three members: the third is another law of the air. weight: its own.
std::string belief_file(const std::string& name, double weight) {
  const std::string path = temporary(name);
  std::ofstream(path) << "schema_version = 1\n[[member]]\nweight = " << 0.5 * (1 - weight)
                      << "\nhypothesis = \"as fitted\"\n"
                         "set = { \"macro.shear_strength\" = \"8 MPa\" }\n[[member]]\nweight = "
                      << 0.5 * (1 - weight)
                      << "\nhypothesis = \"as fitted\"\n"
                         "set = { \"macro.shear_strength\" = \"10 MPa\" }\n[[member]]\nweight = "
                      << weight
                      << "\nhypothesis = \"emission\"\n"
                         "set = { \"model.air_limit\" = \"emission\" }\n";
  return path;
}

// By depth from flat on, and contact angle.
Study believing(double weight) {
  Study study = small_study();
  study.design.finger.uncertainty.clear();
  study.design.finger.belief = belief_file("three_members.toml", weight);
  study.design.model = study.design.finger.calibrated_for = Finger{}.calibrated_for;
  study.variables = {study.variables[2], study.variables[3]};
  study.search.method = "nsga2";
  study.search.evaluations = 12;
  study.search.jobs = 1;
  return study;
}

TaskAnswer at(double depth, double angle, double worst) {
  TaskAnswer out;
  const double mean = 0.8 - 0.3 * depth + 0.1 * angle, variation = 0.5 - 0.4 * depth + 0.02 * angle;
  out.objectives = {{mean, 0.01, {mean, mean}}, {variation, 0.01, {variation, variation}}};
  out.worst = worst;
  out.oxide_margin = 10;
  return out;
}

// A deep texture has the highest worst modulation; under the third member the flat surface. On the
// few skins of the members all modulations are half of the confirmed ones.
TaskAnswer overturning(const TaskRequest& r) {
  const double depth = r.flat ? 0 : r.unit[0], angle = r.unit[1];
  if (r.stage != Stage::Belief) return at(depth, angle, 0.2 + 0.1 * depth);
  TaskAnswer out;
  out.members = {at(depth, angle, 0.1 + 0.05 * depth), at(depth, angle, 0.1 + 0.05 * depth),
                 at(depth, angle, 0.1 - 0.05 * depth), at(depth, angle, 0.1 + 0.05 * depth)};
  return out;
}

struct BelievingRun : FormulaRun {
  BelievingRun(double weight, const std::string& folder, const TaskFormula& formula = overturning)
      : BelievingRun(believing(weight), folder, formula) {}
  BelievingRun(const Study& of, const std::string& folder, const TaskFormula& formula)
      : FormulaRun(of, fresh_folder(folder), formula) {
    search_designs(run);
    narrow(run);
    confirm(run);
    check(run);
  }
  const Decision& decision() const { return run.result.decision; }
  const FinalDesign& best() const { return run.result.finalists[run.result.best]; }
  ResultFiles files() const {
    static const std::string none;
    return {options.folder, study, run.problem, run.history, run.result, none};
  }
};

std::string grounds_of(const BelievingRun& a) {
  std::string out;
  for (const std::string& said : report::decision_grounds(a.files())) out += said + "\n";
  return report::as_read(out);
}

TEST(Decision, IsTheLeastExpectedRegretAndNamesWhatOverturnsIt) {
  const BelievingRun a(0.3, "decision_regret");
  const Decision& d = a.decision();
  ASSERT_TRUE(d.made()) << d.absent;
  ASSERT_GE(d.designs.size(), 3u);
  const auto depth = [&](std::size_t i) { return a.run.result.finalists[i].unit[0]; };
  for (std::size_t i = 0; i < d.designs.size(); ++i) {
    EXPECT_LE(depth(i), depth(d.best));
    EXPECT_EQ(d.designs[i].p_limits, 1);
  }
  EXPECT_NEAR(d.designs[d.best].p_best, 0.7, 1e-12);
  EXPECT_EQ(d.nominal, d.best);
  EXPECT_EQ(a.run.result.best, d.best);
  ASSERT_EQ(d.hypotheses.size(), 2u);
  EXPECT_EQ(d.hypotheses[0].best, d.best);
  EXPECT_EQ(d.hypotheses[1].name, "emission");
  EXPECT_NEAR(d.hypotheses[1].weight, 0.3, 1e-12);
  for (std::size_t i = 0; i < d.designs.size(); ++i)
    EXPECT_GE(depth(i), depth(d.hypotheses[1].best));
  // The confirmed .2 + .1 depth times (.1 - .05 depth)/(.1 + .05 depth).
  const double most = depth(d.best), least = depth(d.hypotheses[1].best);
  const auto there = [](double x) { return (0.2 + 0.1 * x) * (0.1 - 0.05 * x) / (0.1 + 0.05 * x); };
  EXPECT_NEAR(d.designs[d.best].regret, 0.3 * (there(least) - there(most)), 1e-12);
  EXPECT_NEAR(d.hypotheses[1].loss, there(least) - there(most), 1e-12);
  const std::string said = grounds_of(a);
  EXPECT_NE(said.find("with probability 70 %"), std::string::npos) << said;
  EXPECT_NE(said.find("if the choice of the model \"emission\" holds (30 % of belief), " +
                      report::design_name(a.run.result.finalists[d.hypotheses[1].best].folder) +
                      " is better by "),
            std::string::npos)
      << said;
  // What to measure: the choice, and what overturns it.
  const auto name = [&](std::size_t i) {
    return report::design_name(a.run.result.finalists[i].folder);
  };
  EXPECT_NE(
      said.find("measure the friction of " + name(d.best) + " and of " +
                name(d.hypotheses[1].best) +
                " (without texture; contact angle of water 76 deg) with the drive off and on"),
      std::string::npos)
      << said;
  // People notice .2: the third member has less of it.
  ASSERT_LT(there(most), 0.2);
  EXPECT_NE(
      said.find("with probability 70 % it is felt by every finger of the study at every humidity."),
      std::string::npos)
      << said;
  const std::string lead = report::as_read(report::recommendation(a.files()));
  EXPECT_NE(lead.find(fmt::format(
                "is {0:.3f} as fitted and {1:.3f} on average over belief ({2:.3f} to {0:.3f} on 95 "
                "% of it)",
                0.2 + 0.1 * most, 0.7 * (0.2 + 0.1 * most) + 0.3 * there(most), there(most))),
            std::string::npos)
      << lead;
}

// What another beats by the confirmed numbers and at every member is off the front; one member that
// says otherwise of what it answers itself keeps it there.
TEST(Decision, AFrontOverBeliefHasWhatAMemberMayPrefer) {
  const BelievingRun a(0.3, "decision_front");
  FinalDesign better = a.best(), worse = better;
  const auto worsen = [](Score& score) {
    score.values[0] -= 0.1;
    score.values[1] += 0.1;
    score.worst *= 0.5;
  };
  worsen(worse.confirmed);
  for (Score& score : worse.members) worsen(score);
  for (ScoreBySkin& few : worse.few) worsen(few.score);
  const auto on_front = [&] { return on_front_of_belief(a.run.problem, {better, worse}); };
  EXPECT_EQ(on_front(), (std::vector<bool>{true, false}));
  worse.few[2].score.worst *= 10;
  EXPECT_EQ(on_front(), (std::vector<bool>{true, true}));
  // A member at which neither has an answer says nothing; one that answers of one alone prefers it.
  for (Score* there : {&worse.members[2], &worse.few[2].score}) there->ok = false;
  EXPECT_EQ(on_front(), (std::vector<bool>{true, false}));
  std::swap(worse.members[2], better.members[2]);
  std::swap(worse.few[2], better.few[2]);
  EXPECT_EQ(on_front(), (std::vector<bool>{true, true}));
  for (Score* there : {&worse.members[2], &worse.few[2].score}) there->ok = false;
  EXPECT_EQ(on_front(), (std::vector<bool>{true, false}));
  // Without members it stays where its confirmed numbers put it.
  worse.members.clear();
  EXPECT_EQ(on_front(), (std::vector<bool>{true, true}));
  worse.on_front = false;
  EXPECT_EQ(on_front(), (std::vector<bool>{true, false}));
}

// The members of the deeper designs take too long. The run goes on, by the numbers of the fit; so
// does one that is resumed, whose journal has that answer.
TEST(Decision, ATaskThatFailsAtTheMembersIsSaidAndEndsNoRun) {
  const TaskFormula slow = [](const TaskRequest& r) {
    return r.stage == Stage::Belief && r.unit[0] > 0.3
               ? TaskAnswer::refused(TaskStatus::Kind::TimedOut, "took longer than 600 s")
               : overturning(r);
  };
  BelievingRun a(believing(0.3), "decision_failed", slow);
  const auto first = std::find_if(a.run.result.finalists.begin(), a.run.result.finalists.end(),
                                  [](const FinalDesign& f) { return f.members.empty(); });
  ASSERT_NE(first, a.run.result.finalists.end());
  EXPECT_TRUE(first->on_front);
  EXPECT_GT(first->unit[0], 0.3);
  EXPECT_FALSE(a.decision().made());
  const std::string& absent = a.decision().absent;
  EXPECT_TRUE(absent.starts_with(first->folder + " has no answer at the members of belief ("))
      << absent;
  EXPECT_NE(absent.find(": took longer than 600 s), and --resume asks no task again"),
            std::string::npos)
      << absent;
  EXPECT_NE(report::as_read(report::decision_text(a.files())).find(absent), std::string::npos);

  std::vector<TaskRequest> asked;
  const OptimiseOptions options{.folder = a.options.folder, .resume = true, .progress = {}};
  search::Run again(a.study, options, a.mpi, std::make_unique<FormulaWorker>(slow, asked));
  search_designs(again);
  narrow(again);
  confirm(again);
  check(again);
  EXPECT_TRUE(asked.empty());
  EXPECT_EQ(again.result.decision.absent, absent);
}

TEST(Decision, SaysWhichDesignBehindTheFrontHasNoMembers) {
  BelievingRun a(0.3, "decision_unjudged");
  ASSERT_TRUE(a.decision().made());
  const auto text = [&] { return report::as_read(report::decision_text(a.files())); };
  EXPECT_EQ(text().find("has no answer at the members"), std::string::npos);
  FinalDesign behind = a.best();
  behind.on_front = false;
  behind.members.clear();
  behind.unjudged = "finger 1: ran out of memory";
  a.run.result.finalists.push_back(behind);
  EXPECT_NE(text().find("it has no answer at the members (finger 1: ran out of memory)."),
            std::string::npos)
      << text();
}

// By the fit all designs have the same variation, members tell them apart by .4 and .2 a unit of
// depth: the knee weighs it by what they say, and no regret is more than both objectives.
TEST(Decision, TheKneeDividesByWhatDesignsDifferByOverBelief) {
  const TaskFormula formula = [](const TaskRequest& r) {
    TaskAnswer out = overturning(r);
    const double depth = r.flat ? 0 : r.unit[0];
    const auto varies = [](TaskAnswer& a, double by) {
      TaskObjective& variation = a.objectives[1];
      variation = {0.5 + by, 0, {0.5 + by, 0.5 + by}};
    };
    if (r.stage != Stage::Belief) varies(out, 0);
    for (std::size_t m = 0; m < out.members.size(); ++m)
      varies(out.members[m], m == 3 ? 0 : (m == 2 ? 0.2 : 0.4) * depth);
    return out;
  };
  BelievingRun a(believing(0.3), "decision_knee", formula);
  const Decision d = decide(a.run.problem, a.run.result.finalists, "knee");
  ASSERT_TRUE(d.made()) << d.absent;
  double least = 1, most = 0;
  for (std::size_t i = 0; i < d.designs.size(); ++i) {
    least = std::min(least, a.run.result.finalists[i].unit[0]);
    most = std::max(most, a.run.result.finalists[i].unit[0]);
  }
  ASSERT_GT(most, least);
  EXPECT_NEAR(d.ranges[1].width, (0.7 * 0.4 + 0.3 * 0.2) * (most - least), 1e-9);
  for (const Prospect& p : d.designs) EXPECT_LT(p.regret, 2);
  EXPECT_EQ(d.by_knee, d.best);
  EXPECT_EQ(a.decision().by_knee, d.best);  // where another rule decides
  a.run.result.decision = d;
  EXPECT_NE(report::as_read(report::decision_text(a.files())).find("variation(modulation) 0."),
            std::string::npos);
  EXPECT_NEAR(report::decision_json(a.files())["ranges"]["variation(modulation)"].get<double>(),
              d.ranges[1].width, 1e-12);
}

// What has no samples of single skins (felt, pull_in_margin): "over skins" is said of what has
// them.
TEST(Decision, SaysOverSkinsOnlyOfWhatHasSamplesOfThem) {
  const auto skinned = [](bool worst) {
    return [worst](const TaskRequest& r) {
      TaskAnswer out = overturning(r);
      const auto add = [&](TaskAnswer& a) {
        ErrorSamples mean;
        mean.sampling.assign(4, a.objectives[0].value);
        a.samples = {{mean}, {ErrorSamples{}}};  // none of the variation
        if (worst) a.worst_samples.sampling.assign(4, a.worst);
      };
      if (r.stage != Stage::Belief) add(out);
      for (TaskAnswer& member : out.members) add(member);
      return out;
    };
  };
  const BelievingRun with(believing(0.3), "decision_skins", skinned(true)),
      without(believing(0.3), "decision_no_skins", skinned(false));
  EXPECT_NE(
      grounds_of(with).find("open) and over skins, without errors of the grid and of what all"),
      std::string::npos)
      << grounds_of(with);
  const std::string said = grounds_of(without);
  EXPECT_NE(said.find("open), without what skins leave open of the worst modulation, of which "
                      "single skins are not known, and without errors of the grid"),
            std::string::npos)
      << said;
  const std::string text = report::as_read(report::decision_text(with.files()));
  EXPECT_NE(text.find(" Probabilities in variation(modulation) are over the members alone: "),
            std::string::npos)
      << text;
}

TEST(Decision, AHypothesisOfEnoughWeightOverturnsTheNumbersOfTheFit) {
  const BelievingRun a(0.8, "decision_overturned");
  const Decision& d = a.decision();
  ASSERT_TRUE(d.made());
  EXPECT_NE(d.best, d.nominal);
  EXPECT_EQ(a.run.result.best, d.best);
  EXPECT_EQ(d.best, d.hypotheses[1].best);
  EXPECT_GT(d.designs[d.nominal].regret, d.designs[d.best].regret);
  const std::string said = grounds_of(a);
  EXPECT_NE(said.find("By the finger and the model as fitted alone, " +
                      report::design_name(a.run.result.finalists[d.nominal].folder) +
                      " would be chosen (0.300 there, where design 01 has 0.200); over the members "
                      "it stays "),
            std::string::npos)
      << said;
}

// As above, with the worst modulation of the third member .2 - 2 slope depth.
TaskFormula falling(double slope) {
  return [slope](const TaskRequest& r) {
    TaskAnswer out = overturning(r);
    if (r.stage == Stage::Belief) out.members[2].worst = 0.1 - slope * (r.flat ? 0 : r.unit[0]);
    return out;
  };
}

TEST(Decision, NeitherNamesAHypothesisNorAsksForAMeasurementThatChangesLessThanAPerCent) {
  const BelievingRun a(believing(0.3), "decision_alike", falling(0.0005));
  const Decision& d = a.decision();
  EXPECT_NE(d.hypotheses[1].best, d.best);
  EXPECT_GT(d.hypotheses[1].loss, 0);
  EXPECT_LT(d.hypotheses[1].loss, 0.01 * d.best_worth);
  const std::string said = grounds_of(a);
  EXPECT_EQ(said.find("emission"), std::string::npos) << said;
  EXPECT_NE(said.find("by 1 % or more"), std::string::npos) << said;
  EXPECT_EQ(said.find("measure the friction of "), std::string::npos) << said;
}

TEST(Decision, NamesTheDesignThatIsTheBestMoreOften) {
  const BelievingRun a(believing(0.4), "decision_more_often", falling(0.09));
  const Decision& d = a.decision();
  EXPECT_EQ(d.best, d.hypotheses[1].best);
  EXPECT_NEAR(d.designs[d.best].p_best, 0.4, 1e-12);
  const std::string said = grounds_of(a);
  EXPECT_NE(said.find("By the finger and the model as fitted alone, " +
                      report::design_name(a.run.result.finalists[d.nominal].folder) +
                      ", the best more often (probability 60 %), would be chosen (0.300 there, "
                      "where design 01 has 0.200); "),
            std::string::npos)
      << said;
}

// Deep textures are steadier, but under no member is their worst modulation the best.
TEST(Decision, OfASurfaceWithoutTextureItSaysHowSureThatIs) {
  const TaskFormula flat_is_best = [](const TaskRequest& r) {
    const double depth = r.flat ? 0 : r.unit[0], angle = r.unit[1];
    if (r.stage != Stage::Belief) return at(depth, angle, 0.3 - 0.1 * depth);
    TaskAnswer out;
    out.members.assign(4, at(depth, angle, 0.3 - 0.1 * depth));
    return out;
  };
  const BelievingRun a(believing(0.3), "decision_flat", flat_is_best);
  const ResultFiles files = a.files();
  EXPECT_FALSE(report::run_json(files)["textured"].get<bool>());
  const auto place = report::recommended_place(files);
  ASSERT_TRUE(place);
  const std::string said = report::as_read(join_names(report::grounds(files), "\n"));
  EXPECT_NE(said.find(" designs of the front " +
                      report::design_name(a.run.result.finalists[*place].folder) +
                      ", the surface that is recommended, is the best in the worst modulation with "
                      "probability 100 %"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("felt by every finger"), std::string::npos) << said;
}

TEST(Decision, AsksForNoMeasurementOfWhatIsSure) {
  const BelievingRun a(believing(0.04), "decision_known", falling(0.09));
  ASSERT_GT(a.decision().designs[a.decision().best].p_best, 0.95);
  const std::string said = grounds_of(a);
  EXPECT_EQ(said.find("To be surer"), std::string::npos) << said;
}

// The third member answers for none: what the others say is all that is said of the best.
TEST(Decision, SaysWhatShareOfBeliefHasNoAnswer) {
  const TaskFormula silent = [](const TaskRequest& r) {
    TaskAnswer out = overturning(r);
    if (r.stage == Stage::Belief)
      out.members[2] = TaskAnswer::refused(TaskStatus::Kind::NotDefined, "no voltage");
    return out;
  };
  const BelievingRun a(believing(0.3), "decision_silent", silent);
  const Decision& d = a.decision();
  ASSERT_TRUE(d.made()) << d.absent;
  double all = 0;
  for (const Prospect& p : d.designs) {
    all += p.p_best;
    for (std::size_t k = 0; k < p.p_limit.size(); ++k) {
      const bool of_shape = std::holds_alternative<ShapeLimit>(a.study.constraints[k].on);
      EXPECT_NEAR(p.p_limit[k], of_shape ? 1 : 0.7, 1e-12) << limit_name(a.study.constraints[k].on);
    }
  }
  EXPECT_NEAR(all, 1, 1e-12);
  const char* const said =
      " At 1 of these members (30 % of belief) no design of the front has an answer: ";
  EXPECT_NE(grounds_of(a).find(said), std::string::npos) << grounds_of(a);
  const std::string text = report::as_read(report::decision_text(a.files()));
  EXPECT_NE(text.find(said), std::string::npos) << text;
  EXPECT_NE(text.find("\"emission\" (30 % of belief) no design of the front has an answer."),
            std::string::npos)
      << text;
  EXPECT_NEAR(report::decision_json(a.files())["belief_without_answer"].get<double>(), 0.3, 1e-12);
  const BelievingRun told(0.3, "decision_told");
  EXPECT_FALSE(report::decision_json(told.files()).contains("belief_without_answer"));
  EXPECT_EQ(grounds_of(told).find("has an answer"), std::string::npos);
}

TEST(Decision, TheRiskOfTheStudyDecides) {
  Study study = believing(0.3);
  study.risk.belief = "worst 10 %";
  const BelievingRun a(study, "decision_worst", overturning);
  EXPECT_EQ(a.decision().best, a.decision().hypotheses[1].best);
}

// The third member breaks every film, the second that of deep textures: none is sure enough, and
// three members do not tell 35 % from 70 %.
TEST(Decision, WhereNoneIsSureEnoughTheBestOfTheSurestIsRecommended) {
  const TaskFormula weak = [](const TaskRequest& r) {
    TaskAnswer out = overturning(r);
    if (r.stage != Stage::Belief) return out;
    out.members[1].oxide_margin = !r.flat && r.unit[0] > 0.3 ? 1 : 10;
    out.members[2].oxide_margin = 1;
    return out;
  };
  const BelievingRun a(believing(0.3), "decision_unsure", weak);
  const Decision& d = a.decision();
  EXPECT_GT(a.best().unit[0], 0.3);
  EXPECT_NEAR(d.designs[d.best].p_limits, 0.35, 1e-12);
  EXPECT_FALSE(d.sure(0.9));
  const auto surest =
      static_cast<std::size_t>(std::find_if(d.designs.begin(), d.designs.end(),
                                            [](const Prospect& p) { return p.p_limits > 0.69; }) -
                               d.designs.begin());
  ASSERT_LT(surest, d.designs.size());
  const std::string said = grounds_of(a);
  const auto name = [&](std::size_t i) {
    return report::design_name(a.run.result.finalists[i].folder);
  };
  EXPECT_NE(
      said.find("With probability 35 % " + name(d.best) + " keeps every limit, " + name(surest) +
                " with 70 %, too little more for the members to tell, where "
                "the study wants 90 %"),
      std::string::npos)
      << said;
}

// Under the third member the deep textures break the film.
TEST(Decision, WhatIsRecommendedKeepsItsLimitsWithTheProbabilityAskedFor) {
  const TaskFormula weak = [](const TaskRequest& r) {
    TaskAnswer out = overturning(r);
    if (r.stage == Stage::Belief) out.members[2].oxide_margin = r.unit[0] > 0.3 ? 1 : 10;
    return out;
  };
  Study study = believing(0.3);
  const BelievingRun sure(study, "decision_sure", weak);
  EXPECT_LE(sure.best().unit[0], 0.3);
  EXPECT_TRUE(sure.decision().sure(0.9));
  const auto among = [](const BelievingRun& run) {
    return report::as_read(report::of_the_sure_text(run.files()));
  };
  EXPECT_EQ(among(sure), " of those that keep every limit with probability 90 % or more");
  study.risk.limits = 0.6;
  const BelievingRun bold(study, "decision_bold", weak);
  EXPECT_GT(bold.best().unit[0], 0.3);
  EXPECT_EQ(among(bold), "");
  EXPECT_NEAR(bold.decision().designs[bold.run.result.best].p_limits, 0.7, 1e-12);
}

// The best of one objective is a front of one design; with belief all that may be the best are.
TEST(Decision, TheFrontHoldsWhatIsBestSomewhere) {
  const TaskFormula formula = [](const TaskRequest& r) {
    TaskAnswer out = overturning(r);
    if (r.stage == Stage::Belief) {
      TaskObjective& mean = out.members[2].objectives[0];
      mean.value += 0.6 * r.unit[0];
      mean.points = {mean.value, mean.value};
      for (TaskAnswer& m : out.members) m.objectives.pop_back();
    } else {
      out.objectives.pop_back();
    }
    return out;
  };
  Study study = believing(0.6);
  study.objective.minimise.clear();
  study.search.method = "bayesian";
  const BelievingRun a(study, "decision_one_objective", formula);
  const Decision& d = a.decision();
  ASSERT_TRUE(d.made()) << d.absent;
  ASSERT_GE(d.designs.size(), 2u);
  EXPECT_EQ(d.nominal, 0u);
  double p = 0;
  for (const double one : d.p_best_by[0]) p += one;
  EXPECT_NEAR(p, 1, 1e-12);
  EXPECT_TRUE(std::all_of(a.run.result.finalists.begin(), a.run.result.finalists.end(),
                          [](const FinalDesign& f) { return f.on_front == !f.folder.empty(); }));
}

// One design of the level between is the best in both objectives. In the first the deeper ones come
// next, one after another; in the second the one of another angle.
TEST(Decision, RivalsAreTheBestInEachObjectiveInTurn) {
  const TaskFormula formula = [](const TaskRequest& r) {
    const double depth = r.unit[0], angle = r.unit[1];
    TaskAnswer out = at(depth, angle, 0.2);
    const double mean = 0.8 - 0.1 * (depth + 1.5 * angle),
                 variation = 0.2 + 0.1 * (3 * depth + angle);
    out.objectives = {{mean, 0.01, {mean, mean}}, {variation, 0.01, {variation, variation}}};
    return out;
  };
  FormulaRun a(believing(0.3), fresh_folder("decision_rivals"), formula);
  const Point best{0, 0}, deeper{0.2, 0}, deep{0.4, 0}, deepest{0.6, 0}, turned{0, 0.5};
  for (const Point& unit : {best, deeper, deep, deepest, turned})
    a.run.narrowed.add(unit, judged_at(Stage::Narrow, a.run, formula, unit));
  confirm(a.run);
  EXPECT_EQ(a.units(Stage::Confirm), (std::vector<Point>{best, deeper, turned, deep}));
}

TEST(Decision, WithoutABeliefItSaysWhyAndNothingElseChanges) {
  Study study = believing(0.3);
  study.design.finger.belief.clear();
  const BelievingRun a(study, "decision_none", overturning);
  EXPECT_FALSE(a.decision().made());
  EXPECT_NE(a.decision().absent.find("names no belief"), std::string::npos);
  EXPECT_EQ(grounds_of(a), "");
  EXPECT_EQ(a.units(Stage::Belief).size(), 0u);
  EXPECT_NE(report::as_read(report::decision_text(a.files())).find("names no belief"),
            std::string::npos);
}

TEST(Decision, FingersOfDifferentBeliefsHaveNoneInCommon) {
  Study study = believing(0.3);
  Finger first = study.design.finger, second = first;
  second.name = "other";
  second.belief = belief_file("three_others.toml", 0.5);
  study.population = {first, second};
  const StudyProblem problem(study);
  EXPECT_FALSE(problem.belief());
  EXPECT_NE(problem.belief_absent().find("different beliefs"), std::string::npos);
  // Said before anything is evaluated; refused of a study that says how belief is to decide.
  EXPECT_EQ(
      study_warnings(problem),
      std::vector<std::string>{"no belief decides what to build, the fit of the fingers does: " +
                               problem.belief_absent()});
  study.risk.limits = 0.6;
  EXPECT_EQ(refusal_of([&] { study_warnings(StudyProblem(study)); }),
            "risk: no belief decides what to build, as " + problem.belief_absent() +
                "; or leave [risk] out");
  study.population[1].belief = first.belief;
  EXPECT_TRUE(study_warnings(StudyProblem(study)).empty());
  // Of fingers that name none nobody expects it.
  study.risk = {};
  study.population[0].belief = study.population[1].belief = "";
  EXPECT_TRUE(study_warnings(StudyProblem(study)).empty());
}

TEST(Decision, ItsPriceIsStated) {
  Study study = believing(0.3);
  const StudyCost with = study_cost(StudyProblem(study));
  EXPECT_EQ(with.members, 3u);
  EXPECT_GT(with.belief_seconds, 0);
  EXPECT_NE(search_plan(StudyProblem(study)).find("3 members"), std::string::npos);
  study.design.finger.belief.clear();
  const StudyCost without = study_cost(StudyProblem(study));
  EXPECT_EQ(without.members, 0u);
  EXPECT_NEAR(with.bytes, without.bytes + 1.25 * 72e6, 1);
}

// Interrupted at either side of every change of the stage and after each fourth answer, and
// continued: nothing is asked twice, and the same is decided.
TEST(Decision, ARunThatIsContinuedDecidesTheSame) {
  const BelievingRun straight(0.3, "decision_straight");
  const auto every = static_cast<std::size_t>(cases(16, 4));
  std::set<Stage> ended_in;
  for (std::size_t after = 1; after < straight.asked.size(); ++after) {
    const auto stage = [&](std::size_t i) {
      return straight.asked[std::min(i, straight.asked.size() - 1)].stage;
    };
    const bool changes = stage(after - 1) != stage(after) || stage(after) != stage(after + 1);
    if (!changes && after % every != 0) continue;
    const std::string folder = fresh_folder("decision_continued");
    const Study study = believing(0.3);
    const MpiSession mpi;
    std::vector<TaskRequest> asked;
    std::atomic<bool> stop{false};
    const auto run_on = [&](search::Run& run) {
      search_designs(run);
      narrow(run);
      confirm(run);
      check(run);
    };
    {
      const TaskFormula stopping = [&](const TaskRequest& r) {
        stop = asked.size() >= after;
        return overturning(r);
      };
      const OptimiseOptions options{.folder = folder, .progress = {}, .stop = &stop};
      search::Run run(study, options, mpi, std::make_unique<FormulaWorker>(stopping, asked));
      try {
        run_on(run);
        EXPECT_EQ(asked, straight.asked);  // of the last question there is nothing to stop
      } catch (const WorkStopped&) {
        EXPECT_EQ(asked.size(), after);
        ended_in.insert(asked.back().stage);
      }
    }
    const OptimiseOptions options{.folder = folder, .resume = true, .progress = {}};
    search::Run run(study, options, mpi, std::make_unique<FormulaWorker>(overturning, asked));
    run_on(run);
    EXPECT_EQ(asked, straight.asked);
    EXPECT_EQ(run.result.best, straight.run.result.best);
    ASSERT_EQ(run.result.decision.designs.size(), straight.decision().designs.size());
    for (std::size_t i = 0; i < straight.decision().designs.size(); ++i)
      EXPECT_EQ(run.result.decision.designs[i].regret, straight.decision().designs[i].regret);
  }
  for (const Stage stage : {Stage::Search, Stage::Confirm, Stage::Belief, Stage::Stability,
                            Stage::Rounding, Stage::Sensitivity})
    EXPECT_TRUE(ended_in.count(stage)) << static_cast<int>(stage);
}

// What fit and model leave open takes .6 s a design of the front: of a second the clock leaves time
// for one, and the others are said to be cut.
TEST(Decision, ALimitEndsTheModelPartsOfTheFront) {
  Study study = believing(0.3);
  study.search.time = 1;
  std::ptrdiff_t steps = 0;
  const BelievingRun a(study, "decision_clock", [&](const TaskRequest& r) {
    if (r.stage == Stage::Steps) {
      ++steps;
      std::this_thread::sleep_for(std::chrono::milliseconds(600));
    }
    return overturning(r);
  });
  EXPECT_LE(steps, 1);
  const std::vector<ClockCut>& cuts = a.run.result.cuts;
  const auto cut = std::find_if(cuts.begin(), cuts.end(),
                                [](const ClockCut& c) { return c.part == RunPart::Parameters; });
  ASSERT_NE(cut, cuts.end());
  EXPECT_EQ(cut->done, static_cast<std::size_t>(steps));
}

// Another rule, or another risk, decides by the same answers.
TEST(Decision, ARunThatIsContinuedWithAnotherRiskAsksNoMemberAgain) {
  const BelievingRun straight(0.3, "decision_again");
  Study study = believing(0.3);
  study.risk.belief = "worst";
  const MpiSession mpi;
  std::vector<TaskRequest> asked;
  const OptimiseOptions options{.folder = straight.options.folder, .resume = true, .progress = {}};
  search::Run run(study, options, mpi, std::make_unique<FormulaWorker>(overturning, asked));
  search_designs(run);
  narrow(run);
  confirm(run);
  check(run);
  EXPECT_NE(run.result.best, straight.run.result.best);
  EXPECT_TRUE(std::none_of(asked.begin(), asked.end(),
                           [](const TaskRequest& r) { return r.stage == Stage::Belief; }));
}

// Of one task, with its answers at members of belief, last the finger as it is.
FinalDesign with_members(const StudyProblem& problem, const TaskAnswer& confirmed,
                         const std::vector<TaskAnswer>& members) {
  FinalDesign out;
  out.design = problem.study().design;
  out.answers = {confirmed};
  TaskAnswer few;
  few.members = members;
  add_members(problem, {few}, out);
  return out;
}

TEST(Decision, AMemberMovesSizesByAFactorAndSpreadsByADifference) {
  const Study study = believing(0.3);
  const StudyProblem problem(study);
  const TaskAnswer confirmed = at(0, 0, 0.4), own = at(0, 0, 0.2);
  TaskAnswer there = at(0, 0, 0.3);
  there.objectives[0].value *= 1.5;
  for (double& p : there.objectives[0].points) p *= 1.5;
  there.objectives[1].value += 0.07;
  const FinalDesign f = with_members(
      problem, confirmed, {there, TaskAnswer::refused(TaskStatus::Kind::NoEquilibrium, "x"), own});
  ASSERT_EQ(f.members.size(), 3u);
  const Score& score = f.members[0];
  ASSERT_TRUE(score.ok);
  EXPECT_NEAR(score.values[0], 1.5 * 0.8, 1e-12);
  EXPECT_NEAR(score.values[1], 0.5 + 0.07, 1e-12);
  EXPECT_NEAR(score.worst, 0.4 * 1.5, 1e-12);
  EXPECT_FALSE(f.members[1].ok);
  EXPECT_FALSE(f.members[2].ok);  // belief has three members, the answer two
  ASSERT_EQ(f.few.size(), 4u);    // and the finger as it is, by themselves
  EXPECT_NEAR(f.few[0].score.values[1], there.objectives[1].value, 1e-12);
  EXPECT_NEAR(f.few[3].score.worst, 0.2, 1e-12);
  EXPECT_FALSE(f.few[2].score.ok);
  EXPECT_TRUE(f.few[0].by_skin.empty());  // no skins are known
}

// Of a member the yield is asked once; as a skin or the few skins move it, it is only compared.
TEST(Decision, AYieldIsDrawnOfEachMemberOnce) {
  Study study = believing(0.3);
  study.scatter = {{"texture.depth", 20e-9}};
  study.constraints = {read_constraint("min_wall", 1e-9), read_constraint("yield", 0.9)};
  const StudyProblem problem(study);
  TaskAnswer there = at(0, 0, 0.3);
  there.worst_samples.sampling = {0.27, 0.33};
  FinalDesign f;
  f.design = study.design;
  f.answers.assign(problem.tasks().size(), at(0, 0, 0.4));
  f.confirmed = problem.score(f.design, f.answers);
  TaskAnswer few;
  few.members = {there, there, there, at(0, 0, 0.2)};
  add_members(problem, {few}, f);
  ASSERT_EQ(f.members.size(), 3u);
  for (const Score& member : f.members) {
    ASSERT_TRUE(member.ok) << member.reason;
    EXPECT_TRUE(member.yield.has_value());
  }
  ASSERT_EQ(f.few.size(), 4u);
  EXPECT_EQ(f.few[0].by_skin.size(), 2u);
  for (const ScoreBySkin& alone : f.few) {
    EXPECT_TRUE(alone.score.ok);
    EXPECT_FALSE(alone.score.yield.has_value());
    for (const Score& moved : alone.by_skin) EXPECT_FALSE(moved.yield.has_value());
  }
  const MemberWorth worth = member_worth(problem, {f}, decision_rule(problem, ""), {});
  EXPECT_NEAR(worth.worth.at(0).at(0), 0.4 * 0.3 / 0.2, 1e-12);
}

// Scatter of fabrication moves a member that has an answer; one that has none stays without.
TEST(Decision, AMemberWithoutAnAnswerHasNoneWhereNumbersScatter) {
  Study study = believing(0.3);
  study.scatter = {{"texture.depth", 20e-9}};
  const StudyProblem problem(study);
  FinalDesign f;
  f.design = study.design;
  f.answers.assign(problem.tasks().size(), at(0, 0, 0.4));
  ASSERT_GT(f.answers.size(), problem.nominal_tasks());
  f.confirmed = problem.score(f.design, f.answers);
  TaskAnswer few;
  few.members = {at(0, 0, 0.3), TaskAnswer::refused(TaskStatus::Kind::NoEquilibrium, "pulled in"),
                 at(0, 0, 0.1), at(0, 0, 0.2)};
  add_members(problem, {few}, f);
  EXPECT_TRUE(f.members.at(0).ok);
  EXPECT_FALSE(f.members.at(1).ok);
  EXPECT_TRUE(f.few.at(0).score.ok);
  EXPECT_FALSE(f.few.at(1).score.ok);
  EXPECT_NE(f.few[1].score.reason.find("pulled in"), std::string::npos) << f.few[1].score.reason;
}

// What few skins leave open of the correction to the 3-D field moves each design by itself.
TEST(Decision, TheFieldOfADesignMovesItsWorthByAnErrorOfItsOwn) {
  const StudyProblem problem(believing(0.3));
  const auto design = [&](double worst, double correction) {
    TaskAnswer confirmed = at(0, 0, worst);
    const FieldPart field{0.02, 0.03, {correction}, 0.03};
    confirmed.samples = {{{{}, {}, {}, field}}, {{{}, {}, {}, {}}}};
    confirmed.worst_samples.field = field;
    const TaskAnswer few = at(0, 0, 0.2);
    FinalDesign f = with_members(problem, confirmed, {few, few, few, few});
    f.confirmed = problem.score(f.design, {confirmed});
    return f;
  };
  const FinalDesign first = design(0.4, -0.3), other = design(0.3, -0.1), twin = design(0.4, -0.3);
  EXPECT_NEAR(first.confirmed_by_field.worst, 0.43, 1e-12);
  const MemberWorth worth =
      member_worth(problem, {first, other, twin}, decision_rule(problem, ""), {});
  for (std::size_t m = 0; m < 3; ++m) {
    const auto moves = [&](std::size_t i) { return worth.by_error[i][m]; };
    EXPECT_NEAR(std::hypot(moves(1)[0], moves(1)[1]), 0.03, 1e-9);
    EXPECT_NEAR(moves(0)[0] * moves(1)[0] + moves(0)[1] * moves(1)[1], 0, 1e-9);
    EXPECT_EQ(moves(0), moves(2));  // the same field is off alike
  }
}

// A skin moves a member by what it moves of its worst modulation alone.
TEST(Decision, ASkinMovesAMemberByItsOwnSamples) {
  const Study study = believing(0.3);
  const StudyProblem problem(study);
  TaskAnswer confirmed = at(0, 0, 0.4), own = at(0, 0, 0.2), there = at(0, 0, 0.3);
  there.worst_samples.sampling = {0.27, 0.33, 0.3, 0.3};
  FinalDesign f = with_members(problem, confirmed, {there, own});
  f.confirmed = problem.score(f.design, {confirmed});
  ASSERT_EQ(f.few.at(0).by_skin.size(), 4u);
  const double tenth = 0.1 / std::sqrt(4 * 3.0);
  EXPECT_NEAR(f.few[0].by_skin[0].worst, 0.3 - 0.3 * tenth, 1e-12);
  EXPECT_NEAR(f.few[0].by_skin[1].worst, 0.3 + 0.3 * tenth, 1e-12);
  EXPECT_TRUE(f.few.back().by_skin.empty());
  EXPECT_TRUE(f.confirmed_by_skin.empty());
  // One design: what the levels differ by is taken off in full.
  const MemberWorth worth = member_worth(problem, {f}, decision_rule(problem, ""), {});
  EXPECT_NEAR(worth.worth.at(0).at(0), 0.4 * 0.3 / 0.2, 1e-12);
  EXPECT_TRUE(std::isnan(worth.worth[0][2]));  // no answer there
}

}  // namespace
}  // namespace papilla::tests::decision_test
