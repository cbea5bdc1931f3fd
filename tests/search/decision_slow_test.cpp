// A study with a belief of three members, solved: each hypothesis has its best, and a run that is
// killed among the members ends in the same bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>

#include "base/files.h"
#include "report/results.h"
#include "scene/belief.h"
#include "tests/search/small_study.h"
#include "tests/support/thorough.h"

namespace papilla::tests::decision_slow_test {
namespace {

namespace fs = std::filesystem;

// Moist skin as fitted, and skin with next to no water on it.
std::string moist_or_dry() {
  const std::string path = temporary("moist_or_dry.toml");
  const Finger finger = small_study().design.finger;
  scene::Belief belief;
  belief.calibrated_for = finger.calibrated_for;
  for (const auto& [weight, name, water] :
       {std::tuple(0.4, "moist", 1.0), std::tuple(0.4, "moist", 1.5), std::tuple(0.2, "dry", 0.02)})
    belief.members.push_back({weight, name, {{"water.scale", config::number_node(water)}}});
  std::ofstream(path) << belief_text(belief);
  return path;
}

Study believing() {
  Study study = quick_study();
  study.design.finger.belief = moist_or_dry();
  study.search.evaluations = cases(2, 8);
  return study;
}

const char* const kFiles[] = {"journal",    "pareto.csv", "history.csv",
                              "summary.md", "run.json",   "best/metrics.json"};

TEST(DecisionSlow, EachHypothesisHasItsBestAndAKilledRunDecidesTheSame) {
  const Study study = believing();
  const std::string folder = fresh_folder("decided"), again = fresh_folder("decided_again");
  ASSERT_FALSE(report::optimise_to_folder(study, {folder, false, {}, nullptr}).interrupted);
  const auto run = nlohmann::json::parse(read_bytes(folder + "/run.json"));
  const auto& decision = run.at("decision");
  ASSERT_EQ(decision.at("absent"), "");
  EXPECT_EQ(decision.at("members"), 3);
  double p = 0;
  for (const auto& [name, design] : decision.at("designs").items())
    p += design.at("p_best").get<double>();
  EXPECT_NEAR(p, 1, 1e-9);
  ASSERT_EQ(decision.at("hypotheses").size(), 2u);
  // Under each hypothesis the one that is worth most at its members; what is said names those under
  // which another than the choice is.
  const std::string overturned = decision.at("overturned").dump();
  for (const auto& h : decision["hypotheses"]) {
    const bool moist = h.at("name") == "moist";
    std::string best;
    double most = -1e9;
    for (const auto& [name, design] : decision.at("designs").items()) {
      const auto& at = design.at("worth_at_members");
      const double worth =
          moist ? 0.5 * (at[0].get<double>() + at[1].get<double>()) : at[2].get<double>();
      if (worth > most) best = name;
      most = std::max(most, worth);
    }
    EXPECT_EQ(h.at("best"), best) << h;
    const bool named = overturned.find(h.at("name").get<std::string>()) != std::string::npos;
    EXPECT_TRUE(!named || best != decision.at("best")) << overturned;
  }

  // Stopped after the members of a first design, its last record torn.
  std::atomic<bool> stop{false};
  const auto among_members = [&](const Progress& at) { stop = at.stage == "belief"; };
  EXPECT_TRUE(report::optimise_to_folder(study, {again, false, among_members, &stop}).interrupted);
  fs::resize_file(again + "/journal", fs::file_size(again + "/journal") - 10);
  Study alone = study;
  alone.search.jobs = 1;
  EXPECT_FALSE(report::optimise_to_folder(alone, {again, true, {}, nullptr}).interrupted);
  for (const char* file : kFiles)
    EXPECT_EQ(read_bytes(again + "/" + file), read_bytes(folder + "/" + file)) << file;
}

}  // namespace
}  // namespace papilla::tests::decision_slow_test
