#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/files.h"
#include "base/statistics.h"
#include "report/response.h"
#include "report/results.h"
#include "report/summary.h"
#include "search/pick.h"
#include "search/run.h"
#include "search/task.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

namespace fs = std::filesystem;

// One finger at one humidity: small enough for a test.
Study small_study() {
  Study study = read_study(PAPILLA_SOURCE_DIR "/designs/electroadhesive_glass/study.toml");
  study.population.clear();
  study.design.environment.relative_humidity = {0.35, 0.75};
  study.design.accuracy.level = AccuracyLevel::Draft;
  study.search.evaluations = 6;
  study.search.jobs = 2;
  return study;
}

std::string response_text(const Response& response) { return response_json(response, false); }

std::string fresh_folder(const std::string& name) {
  const fs::path folder = temporary(name);
  fs::remove_all(folder);
  return folder.string();
}

std::string bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST(Risk, HasItsClosedForms) {
  const std::vector<double> values{1, 2, 3, 4}, weights{1, 1, 1, 1};
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk(""), true, values, weights), 2.5);
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("worst"), true, values, weights), 1);
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("worst"), false, values, weights), 4);
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("mean - 2 std"), true, values, weights),
                   2.5 - 2 * std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("mean - 2 std"), false, values, weights),
                   2.5 + 2 * std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("cvar 50 %"), true, values, weights), 1.5);
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("cvar 37.5 %"), false, values, weights),
                   (4 + 0.5 * 3) / 1.5);
  EXPECT_THROW(parse_risk("mean - two std"), InputError);
  EXPECT_THROW(parse_risk("cvar 0 %"), InputError);
}

TEST(Risk, CvarOfANormalSampleIsItsFormula) {
  std::vector<double> values, weights;
  for (int i = 0; i < 4000; ++i) {
    values.push_back(normal_quantile((i + 0.5) / 4000));
    weights.push_back(1);
  }
  const double z = normal_quantile(0.2);
  EXPECT_NEAR(apply_risk(parse_risk("cvar 20 %"), true, values, weights),
              -std::exp(-0.5 * z * z) / std::sqrt(2 * std::acos(-1.0)) / 0.2, 2e-3);
}

TEST(StudyProblem, RefusesShapesOutsideTheFabricationLimits) {
  const Study study = small_study();
  const StudyProblem problem(study);
  // period 5 um, diameter 4.8 um, depth 350 nm, 50 deg
  const Point thin = problem.space().unit({5e-6, 4.8e-6, 350e-9, 0.87});
  EXPECT_EQ(problem.constraints().geometry_reason(thin), "min_wall 0.2 um is below 0.4 um");
  const Point flat = problem.space().unit({5e-6, 4.8e-6, 0, 0.87});
  EXPECT_EQ(problem.constraints().geometry_reason(flat), "");
  EXPECT_EQ(problem.space().starts().size(), 2u);  // the study's own design and the flat surface
}

TEST(StudyProblem, RefusesToMaximiseTheModulationOfAnUndrivenDesign) {
  Study study = small_study();
  study.design.drive.amplitude = 0;
  EXPECT_THROW(StudyProblem{study}, InputError);
}

TEST(StudyProblem, RefusesAFrequencyThatNothingFeels) {
  Study study = small_study();
  study.variables.push_back({"drive.frequency", "kHz", 1e3, 20e3, {}});
  try {
    const StudyProblem problem(study);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("drive.frequency has no effect: the dielectric has no"),
              std::string::npos)
        << e.what();
  }
  // One finger of the population that conducts at low frequency is enough.
  study.population.assign(2, study.design.finger);
  study.population[1].electrical.corner_frequency = 2e3;
  EXPECT_NO_THROW(StudyProblem{study});
}

// Friction is proportional to the shear strength: of fingers that share its uncertainty the errors
// add, of others they add in squares.
TEST(StudyProblem, FingersOfOneUncertaintyMoveTogether) {
  Study study = small_study();
  study.design.environment.relative_humidity = {0.35};
  study.objective.maximise.clear();
  study.objective.minimise = {"friction"};
  study.design.accuracy.parameters = true;
  study.population.assign(2, study.design.finger);
  for (Finger& f : study.population) {
    f.water.hysteresis = 0;
    f.uncertainty = {{"macro.shear_strength", 0.1, {}}};
  }
  Fidelity f = fidelity_level("search");
  f.grid = 64;
  f.skins = 6;
  const auto score = [&] {
    const StudyProblem problem(study);
    const Design design = problem.space().design(problem.space().unit_of_study());
    std::vector<TaskAnswer> tasks;
    for (std::size_t t = 0; t < problem.tasks().size(); ++t)
      tasks.push_back(evaluate_task(problem, design, t, {f, true, response_text}));
    return problem.score(tasks);
  };
  const Score same = score();
  ASSERT_TRUE(same.ok) << same.reason;
  const double friction = same.values[0];
  EXPECT_NEAR(*parameter_error(same, 0) / friction, std::sinh(0.1), 2e-3);
  EXPECT_EQ(*parameter_error(same, same, 0), 0);
  EXPECT_NE(same.reports[0].find("\"directions\": 1"), std::string::npos);
  {
    const StudyProblem problem(study);  // the steps alone
    const Design design = problem.space().design(problem.space().unit_of_study());
    Score alone;
    problem.add_steps(
        alone, {evaluate_steps(problem, design, 0, f), evaluate_steps(problem, design, 1, f)});
    EXPECT_EQ(alone.parameter_steps, same.parameter_steps);
  }

  study.population[1].uncertainty[0].deviation = 0.1 + 1e-9;
  const Score other = score();
  EXPECT_EQ(other.parameter_steps[0].size(), 2u);
  EXPECT_NEAR(*parameter_error(other, 0) / friction, std::sinh(0.1) / std::sqrt(2), 2e-3);
  EXPECT_EQ(other.errors[0], same.errors[0]);  // of its own

  study.population[1].uncertainty.clear();
  EXPECT_FALSE(parameter_error(score(), 0));
  EXPECT_NE(StudyProblem(study).parameters_unknown().find("[[uncertainty]]"), std::string::npos);
}

TEST(Optimise, WritesItsResultsAndResumesToTheSameBytes) {
  const Study study = small_study();
  const std::string whole = fresh_folder("whole");
  const OptimiseResult result = optimise_to_folder(study, {whole, false, {}, nullptr});
  EXPECT_EQ(result.evaluations, 6);
  EXPECT_TRUE(result.any_feasible);
  for (const char* file :
       {"resolved.toml", "plan.txt", "journal", "timing.json", "pareto.csv", "history.csv",
        "summary.md", "sensitivity.json", "best/design.toml", "best/metrics.json",
        "best/heightmap.exr", "best/mask.tif", "front/01/design.toml"}) {
    EXPECT_TRUE(fs::exists(whole + "/" + file)) << file;
  }
  ASSERT_FALSE(result.sensitivity.empty());
  double shares = 0;
  for (const VariableSensitivity& s : result.sensitivity) shares += s.share[0];
  EXPECT_NEAR(shares, 1, 1e-12);
  EXPECT_EQ(read_design(whole + "/best/design.toml"), result.finalists[result.best].design);

  // The journal cut in the middle of a record, as by a kill, then resumed with another worker
  // count.
  const std::string journal = bytes(whole + "/journal");
  for (const double share : {0.12, 0.6}) {
    const std::string folder = fresh_folder("resumed");
    fs::create_directories(folder);
    std::ofstream(folder + "/journal", std::ios::binary)
        << journal.substr(0, static_cast<std::size_t>(share * static_cast<double>(journal.size())));
    Study again = study;
    again.search.jobs = 1;
    optimise_to_folder(again, {folder, true, {}, nullptr});
    for (const char* file : {"journal", "pareto.csv", "history.csv", "best/metrics.json"}) {
      EXPECT_EQ(bytes(folder + "/" + file), bytes(whole + "/" + file)) << file;
    }
  }
  EXPECT_THROW(optimise_to_folder(study, {whole, false, {}, nullptr}),
               InputError);  // an earlier run's folder
  Study other = study;
  other.search.seed = 2;
  EXPECT_THROW(optimise_to_folder(other, {whole, true, {}, nullptr}),
               InputError);  // of another study
}

TEST(Optimise, AnInterruptLeavesAResumableFolder) {
  const Study study = small_study();
  const std::string folder = fresh_folder("interrupted");
  std::atomic<bool> stop{false};
  const auto progress = [&](const Progress& p) { stop = p.done >= 2; };
  EXPECT_TRUE(optimise_to_folder(study, {folder, false, progress, &stop}).interrupted);
  const OptimiseResult result = optimise_to_folder(study, {folder, true, {}, nullptr});
  EXPECT_FALSE(result.interrupted);
  EXPECT_EQ(result.evaluations, 6);
}

TEST(Optimise, ARunInterruptedBeforeItsChecksEndsAsIfItHadNotBeen) {
  Study study = small_study();
  study.search.drafts = 6;  // their records are not the search's
  const std::string folder = fresh_folder("unchecked"), whole = fresh_folder("checked");
  std::atomic<bool> stop{false};
  const auto progress = [&](const Progress& p) {
    stop = p.stage == "confirm" && p.done == p.total;
  };
  EXPECT_TRUE(optimise_to_folder(study, {folder, false, progress, &stop}).interrupted);
  EXPECT_FALSE(optimise_to_folder(study, {folder, true, {}, nullptr}).interrupted);
  EXPECT_FALSE(optimise_to_folder(study, {whole, false, {}, nullptr}).interrupted);
  for (const char* file : {"journal", "pareto.csv", "summary.md"})
    EXPECT_EQ(bytes(folder + "/" + file), bytes(whole + "/" + file)) << file;
}

// The level between judges a third as many designs as the search, the best of it first; what it
// judged is in the journal, so the finished run continues without a new evaluation.
TEST(Optimise, FinalistsComeFromALevelBetween) {
  Study study = small_study();
  study.search.evaluations = 9;
  const std::string folder = fresh_folder("narrow");
  std::vector<std::string> stages;
  const auto progress = [&](const Progress& p) {
    if (stages.empty() || stages.back() != p.stage) stages.push_back(p.stage);
    if (p.stage == "narrow") {
      EXPECT_EQ(p.total, 3);
    }
  };
  const OptimiseResult first = optimise_to_folder(study, {folder, false, progress, nullptr});
  EXPECT_EQ(stages, (std::vector<std::string>{"search", "narrow", "confirm", "check"}));
  const std::string journal = bytes(folder + "/journal"), front = bytes(folder + "/pareto.csv");
  optimise_to_folder(study, {folder, true, {}, nullptr});
  EXPECT_EQ(bytes(folder + "/journal"), journal);
  EXPECT_EQ(bytes(folder + "/pareto.csv"), front);
}

TEST(Optimise, AnEmptyFeasibleSetNamesTheLeastViolatingDesign) {
  Study study = small_study();
  study.search.evaluations = 3;
  study.constraints = {{"min_wall", 20e-6, true}, {"min_hole", 20e-6, true}};
  study.variables = {{"texture.diameter", "um", 1e-6, 4e-6, {}}};
  const OptimiseResult result =
      optimise_to_folder(study, {fresh_folder("empty"), false, {}, nullptr});
  EXPECT_FALSE(result.any_feasible);
  ASSERT_EQ(result.finalists.size(), 1u);
  EXPECT_FALSE(result.finalists[0].feasible);
}

// Nothing was evaluated, so nothing is best so far; the result says which limit no design keeps.
TEST(Optimise, ASpaceThatNeverKeepsALimitEndsInASummary) {
  Study study = small_study();
  study.search.evaluations = 2;
  study.constraints = {{"min_wall", 5.5e-6, true}, {"aspect_ratio", 3, false}};
  study.variables = {{"texture.diameter", "um", 1e-6, 4e-6, {}}};
  for (const char* method : {"nsga2", "bobyqa"}) {
    const bool several = std::string(method) == "nsga2";
    study.objective.minimise.clear();
    if (several) study.objective.minimise = {"variation(modulation)"};
    study.search.method = method;
    const std::string folder = fresh_folder(std::string("never_") + method);
    int said = 0;
    const auto progress = [&](const Progress& p) {
      said += p.best == "none keeps every constraint yet";
    };
    const OptimiseResult result = optimise_to_folder(study, {folder, false, progress, nullptr});
    EXPECT_GT(said, 0);
    EXPECT_EQ(result.evaluations, 0);
    EXPECT_FALSE(result.any_feasible);
    EXPECT_EQ(result.never_kept, std::vector<std::string>{"min_wall (at least 5.5 um)"}) << method;
    EXPECT_NE(bytes(folder + "/summary.md").find("keeps min_wall (at least 5.5 um)"),
              std::string::npos);
  }
}

// The one shown is the least violating of all that were evaluated, and not on any front.
TEST(Optimise, TheNearestToAnImpossibleLimitIsShown) {
  Study study = small_study();
  study.search.evaluations = 6;
  study.search.method = "nsga2";
  study.variables = {{"texture.diameter", "um", 1e-6, 4.9e-6, {}},
                     {"texture.depth", "nm", 100e-9, 1e-6, {}}};
  study.constraints = {{"min_wall", 1.5e-6, true}, {"worst(modulation)", 5, true}};
  const std::string folder = fresh_folder("nearest");
  const OptimiseResult result = optimise_to_folder(study, {folder, false, {}, nullptr});
  EXPECT_FALSE(result.any_feasible);
  EXPECT_EQ(result.never_kept, std::vector<std::string>{"worst(modulation) (at least 5)"});
  ASSERT_TRUE(result.has_best());
  const FinalDesign& best = result.finalists[result.best];
  EXPECT_FALSE(best.on_front);
  EXPECT_EQ(best.folder, "best");
  EXPECT_TRUE(fs::exists(folder + "/report.html"));
  EXPECT_FALSE(fs::exists(folder + "/front"));
  double highest = 0;  // at the search level
  std::string line, row;
  std::istringstream history(bytes(folder + "/history.csv"));
  const auto cells = [](const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> out;
    for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
    return out;
  };
  while (std::getline(history, line)) {
    const auto c = cells(line);
    if (c.back() != "ok" || std::stod(c[c.size() - 4]) <= highest) continue;
    highest = std::stod(c[c.size() - 4]);
    row = c[1] + "," + c[2];
  }
  EXPECT_NE(bytes(folder + "/pareto.csv").find("best," + row), std::string::npos) << row;
  EXPECT_EQ(bytes(folder + "/pareto.csv").find(",yes,ok"), std::string::npos);
}

TEST(Optimise, AFewEvaluationsHaveFinalists) {
  Study study = small_study();
  for (const int evaluations : {1, 3}) {
    study.search.evaluations = evaluations;
    const std::string folder = fresh_folder("few");
    EXPECT_TRUE(optimise_to_folder(study, {folder, false, {}, nullptr}).has_best()) << evaluations;
    EXPECT_TRUE(fs::exists(folder + "/report.html"));
  }
}

TEST(Optimise, ARefusedStartLeavesNothingBehind) {
  const Study study = small_study();
  const std::string folder = fresh_folder("refused");
  EXPECT_THROW(optimise_to_folder(study, {folder, true, {}, nullptr}),
               InputError);  // nothing to continue
  EXPECT_THROW(optimise_to_folder(study, {folder, false, {}, nullptr, "bestest"}), InputError);
  EXPECT_FALSE(fs::exists(folder));
}

TEST(Optimise, AResumedRunIsNotShortened) {
  Study study = small_study();
  study.search.evaluations = 5;
  const std::string folder = fresh_folder("shortened");
  std::atomic<bool> stop{false};
  const auto progress = [&](const Progress& p) { stop = p.done >= 4; };
  EXPECT_TRUE(optimise_to_folder(study, {folder, false, progress, &stop}).interrupted);
  study.search.evaluations = 3;
  try {
    optimise_to_folder(study, {folder, true, {}, nullptr});
    ADD_FAILURE() << "went on";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("has 4 evaluations already, more than the 3"),
              std::string::npos)
        << e.what();
  }
}

TEST(Optimise, ADesignSpaceOfOnePointIsEvaluated) {
  Study study = small_study();
  study.variables = {{"texture.diameter", "um", 3e-6, 3e-6, {3e-6}}};
  const OptimiseResult result =
      optimise_to_folder(study, {fresh_folder("point"), false, {}, nullptr});
  EXPECT_EQ(result.evaluations, 1);
  EXPECT_TRUE(result.any_feasible);
}

TEST(Optimise, ATargetIsMetByLeastSquares) {
  Study study = small_study();
  study.objective = {};
  study.objective.targets = {{"modulation", 0.45}};
  study.constraints.clear();
  study.variables = {{"texture.depth", "nm", 0, 1e-6, {}}, {"drive.amplitude", "V", 100, 220, {}}};
  study.search.evaluations = 12;
  const OptimiseResult result =
      optimise_to_folder(study, {fresh_folder("target"), false, {}, nullptr});
  EXPECT_EQ(result.method, "least_squares");
  ASSERT_FALSE(result.finalists.empty());
  const StudyProblem problem(study);
  const Score own =
      problem.score({evaluate_task(problem, study.design, 0, {fidelity_level("search")})});
  EXPECT_LT(result.finalists[0].searched.values[0], own.values[0]);
}

TEST(Optimise, AnotherPickOfTheSameRunNeedsNoNewSearch) {
  Study study = small_study();
  const std::string folder = fresh_folder("pick");
  const OptimiseResult first = optimise_to_folder(study, {folder, false, {}, nullptr});
  const std::string journal = bytes(folder + "/journal");
  OptimiseOptions options{folder, true, {}, nullptr, "mean"};
  const OptimiseResult second = optimise_to_folder(study, options);
  EXPECT_EQ(bytes(folder + "/journal"), journal);
  ASSERT_TRUE(second.finalists[second.best].on_front);
  for (const FinalDesign& f : second.finalists) {
    if (!f.on_front) continue;
    EXPECT_LE(f.confirmed.values[0], second.finalists[second.best].confirmed.values[0]);
  }
  EXPECT_EQ(read_design(picked_design_file(folder, "mean")), second.finalists[second.best].design);
  EXPECT_EQ(read_design(picked_design_file(folder, "")), second.finalists[second.best].design);
  options.pick = "best of all";
  EXPECT_THROW(optimise_to_folder(study, options), InputError);
  // Neither a number beyond the front nor an interruption takes what is there.
  const std::string best = bytes(folder + "/best/design.toml"),
                    summary = bytes(folder + "/summary.md");
  options.pick = "99";
  EXPECT_THROW(optimise_to_folder(study, options), InputError);
  std::atomic<bool> stop{true};
  EXPECT_TRUE(optimise_to_folder(study, {folder, true, {}, &stop, "variation"}).interrupted);
  EXPECT_EQ(bytes(folder + "/best/design.toml"), best);
  EXPECT_EQ(bytes(folder + "/summary.md"), summary);
}

// A rule that fits no design of the front costs a first run nothing but the rule.
TEST(Optimise, ResultsAreWrittenBeforeARuleOfPickIsRefused) {
  OptimiseOptions options{fresh_folder("unmet"), false, {}, nullptr};
  options.pick = "99";
  try {
    optimise_to_folder(small_study(), options);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("is written with the usual choice"), std::string::npos);
  }
  EXPECT_TRUE(std::filesystem::exists(options.folder + "/best/design.toml"));
  EXPECT_TRUE(std::filesystem::exists(options.folder + "/report.html"));
}

// Who continues a run with another study hears in which keys they differ.
TEST(Optimise, AnotherStudyIsRefusedByTheKeysThatDiffer) {
  Study study = small_study();
  const std::string folder = fresh_folder("another");
  std::atomic<bool> stop{true};
  EXPECT_TRUE(optimise_to_folder(study, {folder, false, {}, &stop}).interrupted);
  study.search.evaluations += 5;  // may be more
  study.design.drive.amplitude = 150;
  try {
    optimise_to_folder(study, {folder, true, {}, nullptr});
    FAIL();
  } catch (const InputError& e) {
    const std::string why = e.what();
    EXPECT_NE(why.find("written for another study"), std::string::npos) << why;
    EXPECT_NE(why.find("drive.amplitude \"200 V\", \"150 V\""), std::string::npos) << why;
    EXPECT_EQ(why.find("evaluations"), std::string::npos) << why;
  }
}

// A relief that nobody feels is no better than none: both are judged on the same skins.
TEST(Optimise, TheSurfaceWithoutTextureIsJudgedOnTheSkinsOfTheTexture) {
  Study study = small_study();
  for (Variable& v : study.variables) {
    if (v.path == "texture.depth") {
      v.low = 2.5e-9;
      v.high = 3e-9;
    }
  }
  // Under a risk, over humidities and fingers, as without.
  for (const char* risk : {"", "mean - 2 std"}) {
    study.objective.risk = risk;
    const OptimiseResult r =
        optimise_to_folder(study, {fresh_folder("relief"), false, {}, nullptr});
    ASSERT_TRUE(r.flat && r.has_best());
    const Score& best = r.finalists[r.best].confirmed;
    for (std::size_t k = 0; k < best.values.size(); ++k)
      EXPECT_NEAR(r.flat->values[k], best.values[k], 0.05 * best.values[k]) << k;
    // Skin by skin the two are nearly one; the bar of the difference knows.
    for (std::size_t k = 0; k < best.values.size(); ++k) {
      const double error = difference_error(best, *r.flat, k);
      EXPECT_GT(error, 0) << k;
      // A risk takes each humidity alone, where the droplets of a skin may settle otherwise.
      EXPECT_LT(error, (*risk ? 0.8 : 0.3) * std::min(best.errors[k], r.flat->errors[k])) << k;
      EXPECT_EQ(difference_error(best, best, k), 0) << k;
    }
  }
}

TEST(Optimise, ALimitOnTheLookIsKept) {
  Study study = small_study();
  study.constraints.push_back({"haze", 0.03, false});
  study.design.surface.refractive_index = 1.52;
  const OptimiseResult r = optimise_to_folder(study, {fresh_folder("haze"), false, {}, nullptr});
  ASSERT_TRUE(r.any_feasible);
  for (const FinalDesign& f : r.finalists) {
    if (f.feasible) {
      EXPECT_LE(appearance_of(f.design).haze, 0.03);
    }
  }
}

// What the finger leaves open of two designs cancels where both answer alike, and only there.
TEST(Results, DifferencesAreSaidToBeBetterKnownWhereTheyAre) {
  const Study study = read_study(find_design("electroadhesive_glass/study.toml"));
  const StudyProblem problem(study);
  ASSERT_EQ(problem.objectives().size(), 2u);
  FinalDesign d;
  d.unit.assign(study.variables.size(), 0.5);
  d.design = study.design;
  d.feasible = d.on_front = true;
  d.folder = "front/01";
  d.confirmed.ok = true;
  d.confirmed.values = {0.366, 0.215};
  d.confirmed.errors = {0.075, 0.120};
  d.confirmed.parameter_steps = {{{0.05, 0.05}}, {{0.010, 0.010}}};
  OptimiseResult result;
  result.evaluations = 1;
  result.any_feasible = true;
  result.finalists = {d};
  result.stability.variants = {{"alone", {d.confirmed.values}, {true}}};
  result.stability.times_on_front = {1};
  result.flat = d.confirmed;
  result.flat->values = {0.344, 0.222};
  result.flat->errors = {0.071, 0.114};
  result.flat->parameter_steps = {{{0.04, 0.04}}, {{-0.005, -0.005}}};
  const std::string first = problem.objectives()[0].name, second = problem.objectives()[1].name;
  const std::string table = result_table(study, result);
  EXPECT_NE(table.find("better known than the values in " + first + ";"), std::string::npos);
  EXPECT_NE(table.find("in " + second + " it leaves the difference from flat no better"),
            std::string::npos)
      << table;

  const std::string folder = temporary("results"), pick;
  std::filesystem::create_directories(folder);
  write_results({folder, study, problem, {}, result, pick});
  const std::string summary = read_bytes(folder + "/summary.md");
  EXPECT_NE(summary.find("| +0.022 ± 0.075 (0.010) | -0.007 ± 0.120 (0.015) |"), std::string::npos)
      << summary;
  EXPECT_NE(summary.find("1 evaluation."), std::string::npos) << summary;
  result.flat->parameter_steps.clear();
  EXPECT_EQ(result_table(study, result).find("difference"), std::string::npos);
}

}  // namespace
}  // namespace papilla::tests
