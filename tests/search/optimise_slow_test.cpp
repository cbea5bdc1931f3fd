// Whole runs of small studies: what they write, that they go on from anywhere, what they refuse.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "base/files.h"
#include "base/units.h"
#include "design/title.h"
#include "report/results.h"
#include "search/advice.h"
#include "search/pick.h"
#include "search/run.h"
#include "search/task.h"
#include "tests/search/small_study.h"

namespace papilla::tests::optimise_slow_test {
namespace {

namespace fs = std::filesystem;

// A run that the tests of its suite read: with drafts, whose records are not the search's, and a
// limit on the look.
struct FinishedRun {
  Study study = small_study();
  std::string folder = fresh_folder("whole");
  std::vector<std::string> stages;  // in their order
  int narrowed = 0;                 // designs of the level between
  OptimiseResult result;

  FinishedRun() {
    study.design.accuracy.grid = 64;  // as the search: what is tested is no question of pixels
    study.search.evaluations = 9;
    study.search.drafts = 6;
    study.constraints.push_back(read_constraint("haze", 0.03));
    study.design.surface.refractive_index = 1.52;
    const auto progress = [this](const Progress& p) {
      if (stages.empty() || stages.back() != p.stage) stages.push_back(p.stage);
      if (p.stage == "narrow") narrowed = p.total;
    };
    result = optimise_to_folder(study, {folder, false, progress, nullptr});
  }
  std::string file(const std::string& name) const { return read_bytes(folder + "/" + name); }
  // Another folder with its journal, or the first records of it and a torn one, and nothing else.
  std::string journal_alone(const std::string& name, int records = 0) const {
    const std::string to = fresh_folder(name), journal = file("journal");
    std::size_t end = journal.size();
    if (records > 0) {
      end = journal.find('\n');  // of the heading
      for (int k = 0; k < records; ++k) end = journal.find('\n', end + 1);
      end += 60;
    }
    fs::create_directories(to);
    write_bytes(to + "/journal", journal.substr(0, end));
    return to;
  }
};

// The cells of a table that the run wrote.
std::vector<std::vector<std::string>> rows(const std::string& csv) {
  std::vector<std::vector<std::string>> out;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    out.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) out.back().push_back(cell);
  }
  return out;
}

const FinishedRun& run_of_all() {
  static const FinishedRun run;
  return run;
}

TEST(OptimiseOfOneRun, WritesItsResults) {
  const FinishedRun& run = run_of_all();
  EXPECT_EQ(run.result.evaluations, 9);
  EXPECT_TRUE(run.result.any_feasible);
  for (const char* file :
       {"resolved.toml", "plan.txt", "journal", "timing.json", "pareto.csv", "history.csv",
        "summary.md", "sensitivity.json", "best/design.toml", "best/metrics.json",
        "best/build.toml", "best/heightmap.exr", "front/01/design.toml"}) {
    EXPECT_TRUE(fs::exists(run.folder + "/" + file)) << file;
  }
  ASSERT_FALSE(run.result.sensitivity.empty());
  double shares = 0;
  for (const VariableSensitivity& s : run.result.sensitivity) shares += s.share[0];
  EXPECT_NEAR(shares, 1, 1e-12);
  Design recommended = recommended_design(StudyProblem(run.study), run.result).design;
  recommended.title = title_as_changed(run.study.design, recommended);
  EXPECT_EQ(read_design(run.folder + "/best/design.toml"), recommended);
  EXPECT_EQ(fs::exists(run.folder + "/best/mask.tif"), facts(recommended.texture).relief.present);
  EXPECT_FALSE(fs::exists(run.folder + "/" + kProgressFile));
}

// Of the design that is built, in the units beside the numbers; the best one is told by its rule.
TEST(OptimiseOfOneRun, TheSheetHasTheNumbersOfTheBestDesign) {
  const FinishedRun& run = run_of_all();
  const nlohmann::json sheet = nlohmann::json::parse(run.file("run.json")).at("sheet");
  const StudyProblem problem(run.study);
  const FinalDesign recommended = recommended_design(problem, run.result);
  const Design& best = recommended.design;
  const bool textured = facts(best.texture).relief.present;
  int free = 0;
  for (const nlohmann::json& row : sheet) {
    const std::string path = row.at("name"), unit = row.at("unit");
    const double value = get_number(best, path);
    EXPECT_NEAR(row.at("value").get<double>() * find_unit(unit)->to_si, value,
                1e-9 * std::abs(value))
        << path;
    const double build = row.at("build").get<double>() * find_unit(unit)->to_si;
    const double fab = run.study.search.rounding;
    if (unit == "um" && row.at("free")) {
      EXPECT_NEAR(build, fab * std::round(value / fab), 1e-6 * fab) << path;
    }
    EXPECT_TRUE(row.at("text").at("build").get<std::string>().ends_with(unit)) << path;
    free += row.at("free").get<bool>();
  }
  // Of a flat surface the finish alone.
  const auto finish =
      std::count_if(run.study.variables.begin(), run.study.variables.end(),
                    [](const Variable& v) { return !v.path.starts_with("texture."); });
  EXPECT_EQ(free, textured ? static_cast<int>(run.study.variables.size()) : finish);
  EXPECT_NE(
      run.file("summary.md")
          .find(recommended.flat ? "`best/` is the flat surface that is recommended."
                                 : "`best/` is " + recommended.folder +
                                       ": the highest worst modulation over fingers and humidity"),
      std::string::npos);
}

// The level between judges a third as many designs as the search.
TEST(OptimiseOfOneRun, FinalistsComeFromALevelBetween) {
  EXPECT_EQ(run_of_all().stages,
            (std::vector<std::string>{"draft", "search", "narrow", "confirm", "check"}));
  EXPECT_EQ(run_of_all().narrowed, 3);
}

TEST(OptimiseOfOneRun, ALimitOnTheLookIsKept) {
  for (const FinalDesign& f : run_of_all().result.finalists) {
    if (f.feasible) {
      EXPECT_LE(appearance_of(f.design).haze, 0.03);
    }
  }
}

// A journal cut in the middle of a record, as by a kill; then interrupted in the search and before
// the checks, with another number of workers.
TEST(OptimiseOfOneRun, CutAndInterruptedItEndsInTheSameBytes) {
  const FinishedRun& run = run_of_all();
  const std::string folder = run.journal_alone("resumed", 8);
  Study again = run.study;
  again.search.jobs = 1;
  std::atomic<bool> stop{false};
  const auto in_search = [&](const Progress& p) { stop = p.stage == "search" && p.done >= 5; };
  const auto before_checks = [&](const Progress& p) {
    stop = p.stage == "confirm" && p.done == p.total;
  };
  EXPECT_TRUE(optimise_to_folder(again, {folder, true, in_search, &stop}).interrupted);
  const auto length = fs::file_size(folder + "/journal");
  EXPECT_LT(length, run.file("journal").size());
  stop = false;
  EXPECT_TRUE(optimise_to_folder(again, {folder, true, before_checks, &stop}).interrupted);
  EXPECT_GT(fs::file_size(folder + "/journal"), length);
  const OptimiseResult result = optimise_to_folder(again, {folder, true, {}, nullptr});
  EXPECT_FALSE(result.interrupted);
  EXPECT_EQ(result.evaluations, 9);
  for (const char* file :
       {"journal", "pareto.csv", "history.csv", "summary.md", "best/metrics.json"})
    EXPECT_EQ(read_bytes(folder + "/" + file), run.file(file)) << file;
}

TEST(OptimiseOfOneRun, IsNotOverwrittenNorContinuedAsAnotherStudy) {
  const FinishedRun& run = run_of_all();
  EXPECT_THROW(optimise_to_folder(run.study, {run.folder, false, {}, nullptr}), InputError);
  Study other = run.study;
  other.search.seed = 2;
  EXPECT_THROW(optimise_to_folder(other, {run.folder, true, {}, nullptr}), InputError);
}

// What a finished run judged is in its journal: another choice is made without a new evaluation.
TEST(OptimiseOfOneRun, AnotherPickNeedsNoNewSearch) {
  const FinishedRun& run = run_of_all();
  const std::string folder = run.journal_alone("pick"), front = run.file("pareto.csv");
  OptimiseOptions options{folder, true, {}, nullptr, "mean"};
  const OptimiseResult second = optimise_to_folder(run.study, options);
  EXPECT_EQ(read_bytes(folder + "/journal"), run.file("journal"));
  // The fit's part of an error is that of the design that is picked; all else is as it was.
  const auto picked = rows(read_bytes(folder + "/pareto.csv")), before = rows(front);
  ASSERT_EQ(picked.size(), before.size());
  for (std::size_t i = 0; i < picked.size(); ++i) {
    for (std::size_t k = 0; k < picked[0].size(); ++k) {
      if (!picked[0][k].ends_with(" model")) {
        EXPECT_EQ(picked[i][k], before[i][k]) << i << ", " << picked[0][k];
      }
    }
  }
  ASSERT_TRUE(second.finalists[second.best].on_front);
  for (const FinalDesign& f : second.finalists) {
    if (!f.on_front) continue;
    EXPECT_LE(f.confirmed.values[0], second.finalists[second.best].confirmed.values[0]);
  }
  // In files the title says what the search changed.
  const auto untitled = [](Design d) {
    d.title.clear();
    return d;
  };
  EXPECT_EQ(untitled(read_design(picked_design_file(folder, "mean"))),
            untitled(second.finalists[second.best].design));
  EXPECT_EQ(untitled(read_design(picked_design_file(folder, ""))),
            untitled(recommended_design(StudyProblem(run.study), second).design));
  options.pick = "best of all";
  EXPECT_THROW(optimise_to_folder(run.study, options), InputError);
  // Neither a number beyond the front nor an interruption takes what is there.
  const std::string best = read_bytes(folder + "/best/design.toml"),
                    summary = read_bytes(folder + "/summary.md");
  options.pick = "99";
  EXPECT_THROW(optimise_to_folder(run.study, options), InputError);
  fs::resize_file(folder + "/journal", fs::file_size(folder + "/journal") / 2);
  std::atomic<bool> stop{true};
  EXPECT_TRUE(optimise_to_folder(run.study, {folder, true, {}, &stop, "variation"}).interrupted);
  EXPECT_EQ(read_bytes(folder + "/best/design.toml"), best);
  EXPECT_EQ(read_bytes(folder + "/summary.md"), summary);
}

// A rule that fits no design of the front costs a run without results nothing but the rule.
TEST(OptimiseOfOneRun, ResultsAreWrittenBeforeARuleOfPickIsRefused) {
  const FinishedRun& run = run_of_all();
  OptimiseOptions options{run.journal_alone("unmet"), true, {}, nullptr, "99"};
  try {
    optimise_to_folder(run.study, options);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("is written with the usual choice"), std::string::npos)
        << e.what();
  }
  EXPECT_EQ(read_bytes(options.folder + "/best/design.toml"), run.file("best/design.toml"));
  EXPECT_TRUE(fs::exists(options.folder + "/report.html"));
}

// Limits of a shape cost nothing: that no texture keeps one is told before anything is written.
TEST(Optimise, RefusesASpaceThatNeverKeepsALimitOfTheShape) {
  Study study = quick_study();
  study.search.evaluations = 2;
  study.constraints = {read_constraint("min_wall", 5.5e-6), read_constraint("aspect_ratio", 3)};
  study.variables = {{"texture.diameter", "um", 1e-6, 4e-6, {}}};
  const std::string folder = fresh_folder("never");
  try {
    optimise_to_folder(study, {folder, false, {}, nullptr});
    FAIL() << "a search without a design began";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("keeps min_wall (at least 5.5 um): the nearest has "
                                         "min_wall 5 um (at texture.diameter 1 um)"),
              std::string::npos)
        << e.what();
  }
  EXPECT_FALSE(fs::exists(folder + "/journal"));
}

// The one shown is the least violating of all that were evaluated, and not on any front.
TEST(Optimise, TheNearestToAnImpossibleLimitIsShown) {
  Study study = quick_study();
  study.search.evaluations = 6;
  study.search.method = "nsga2";
  study.variables = {{"texture.diameter", "um", 1e-6, 4.9e-6, {}},
                     {"texture.depth", "nm", 100e-9, 1e-6, {}}};
  study.constraints = {read_constraint("min_wall", 1.5e-6),
                       read_constraint("worst(modulation)", 5)};
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
  // Of the search's designs the nearest is confirmed, and the best is as near on fresh skins.
  const auto history = rows(read_bytes(folder + "/history.csv"));
  const auto nearest = *std::max_element(
      history.begin() + 1, history.end(),
      [](const auto& a, const auto& b) { return std::stod(a[5]) < std::stod(b[5]); });
  EXPECT_EQ(history[0][5], "worst modulation");
  const auto confirmed = rows(read_bytes(folder + "/pareto.csv"));
  ASSERT_EQ(confirmed[0][11], "worst modulation");
  EXPECT_EQ(confirmed[1][0], "best");
  bool among_them = false;
  const auto on_front = std::find(confirmed[0].begin(), confirmed[0].end(), "on front");
  ASSERT_NE(on_front, confirmed[0].end());
  const auto column = static_cast<std::size_t>(on_front - confirmed[0].begin());
  for (std::size_t i = 1; i < confirmed.size(); ++i) {
    EXPECT_LE(std::stod(confirmed[i][11]), std::stod(confirmed[1][11])) << i;
    EXPECT_EQ(confirmed[i][column], "no") << "on the front: " << i;
    among_them = among_them || (confirmed[i][1] == nearest[1] && confirmed[i][2] == nearest[2]);
  }
  EXPECT_TRUE(among_them) << nearest[1] << ", " << nearest[2];
}

TEST(Optimise, OneEvaluationHasAFinalist) {
  Study study = quick_study();
  study.search.evaluations = 1;
  const std::string folder = fresh_folder("few");
  EXPECT_TRUE(optimise_to_folder(study, {folder, false, {}, nullptr}).has_best());
  EXPECT_TRUE(fs::exists(folder + "/report.html"));
}

TEST(Optimise, ADesignSpaceOfOnePointIsEvaluated) {
  Study study = quick_study();
  study.variables = {{"texture.diameter", "um", 3e-6, 3e-6, {3e-6}}};
  const OptimiseResult result =
      optimise_to_folder(study, {fresh_folder("point"), false, {}, nullptr});
  EXPECT_EQ(result.evaluations, 1);
  EXPECT_TRUE(result.any_feasible);
}

TEST(Optimise, ATargetIsMetByLeastSquares) {
  Study study = quick_study();
  study.objective = {};
  study.objective.targets = {{kModulation, 0.45}};
  study.constraints.clear();
  study.variables = {{"texture.depth", "nm", 0, 1e-6, {}}, {"drive.amplitude", "V", 100, 220, {}}};
  study.search.evaluations = 12;
  const OptimiseResult result =
      optimise_to_folder(study, {fresh_folder("target"), false, {}, nullptr});
  EXPECT_EQ(result.method, "least_squares");
  ASSERT_FALSE(result.finalists.empty());
  const StudyProblem problem(study);
  // A finalist may be a neighbour of what was searched, judged later: both are judged here, alike.
  const auto distance = [&](const Design& design) {
    const TaskAnswer answer = evaluate_task(problem, design, 0, {fidelity_level("search")});
    EXPECT_TRUE(answer.status.ok()) << answer.status.text;
    return answer.status.ok() ? problem.score(problem.study().design, {answer}).values.at(0)
                              : kInfinity;
  };
  EXPECT_LT(distance(result.finalists[0].design), distance(study.design));
}

// A relief that nobody feels is no better than none: both are judged on the same skins.
TEST(Optimise, TheSurfaceWithoutTextureIsJudgedOnTheSkinsOfTheTexture) {
  Study study = quick_study();
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

}  // namespace
}  // namespace papilla::tests::optimise_slow_test
