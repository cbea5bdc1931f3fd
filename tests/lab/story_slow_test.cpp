// The worked story of docs/how_to/measuring.md: the shipped finger with its belief, a wafer's
// manifest, records of a tribometer, and a decision that grows sure.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "lab/lab.h"
#include "report/lab_trace.h"
#include "scene/belief.h"
#include "tests/cli/program.h"
#include "tests/lab/small_lab.h"
#include "tests/lab/tribometer.h"
#include "tests/support/thorough.h"

namespace papilla::tests::story_slow_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Four fields of a wafer, each at two humidities.
std::string manifest() {
  std::string out =
      "field,row,column,design,repeat,load_N,humidity_percent,voltage_V,frequency_Hz,state,made\n";
  int column = 0;
  for (const char* design : {"a3h350", "a3h900", "a4h600", "flat"}) {
    ++column;
    for (const int humidity : {15, 75})
      out += fmt::format("A{0},1,{0},designs/{1}.toml,1,0.2,{2},200,5000,clean,yes\n", column,
                         design, humidity);
  }
  return out;
}

class Story : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    place_ = new Workplace;
    for (const char* design : {"a3h350", "a3h900", "a4h600", "flat"}) {
      Design d = read_design(find_design("m3_samples/" + std::string(design) + ".toml"),
                             {"accuracy.level=draft", "accuracy.grid=48"});
      fs::create_directories(place_->path() / "wafer/designs");
      write_design((place_->path() / "wafer/designs" / (std::string(design) + ".toml")).string(),
                   d);
    }
    place_->write("wafer/manifest.csv", manifest());
    place_->write("belief.toml", belief_text(some_members()));
    opened_ = new Outcome(place_->run(
        "next wafer --belief belief.toml --worth 'worst(modulation)' --lab lab --count 8 --date "
        "2026-03-01"));
  }
  static void TearDownTestSuite() {
    delete opened_;
    delete place_;
  }

  // The belief of the shipped finger, of which every third member without all cases. The pictures
  // of the page are of all.
  static Belief some_members() {
    const Finger finger = read_finger(find_design("fingers/reference.toml"));
    Belief belief = belief_of(finger);
    const bool all = std::getenv("PAPILLA_UPDATE_PICTURES") != nullptr;
    const auto every = static_cast<std::size_t>(all ? 1 : cases(3, 1));
    std::vector<BeliefMember> kept;
    double weight = 0;
    for (std::size_t m = 0; m < belief.members.size(); m += every) {
      kept.push_back(belief.members[m]);
      weight += kept.back().weight;
    }
    for (BeliefMember& member : kept) member.weight /= weight;
    belief.members = std::move(kept);
    return belief;
  }

  static std::string lab() { return (place_->path() / "lab").string(); }
  static Json state() { return Json::parse(file_text(place_->path() / "lab/lab.json")); }

  // The record of a planned touch, of a finger that is one of the members.
  static std::string record(const PlannedExperiment& e, std::size_t member, std::uint64_t seed) {
    const Lab lab(Story::lab(), 1);
    MemberModel model(lab.belief(), Story::lab(), 1);
    const MemberFriction f = model.friction(lab.designs()[e.experiment.design], e.experiment.at);
    Tribometer t;
    t.off = f.off.at[member];
    t.on = f.on.at[member];
    t.humidity = e.experiment.at.relative_humidity;
    t.noise = 0.02 * t.off;
    t.zero_drift = 0.3 * t.off;
    t.drift = 0.1;
    t.lag = 0.04;
    t.slip = seed % 3 == 0 ? 0.2 * t.off : 0;
    t.seed = seed;
    return t.record(
        fmt::format("# experiment: {}\n# finger: Ada\n# day: 1\n# repeat: {}\n", e.id, seed));
  }
  // Records of every touch of the last plan; one of them is broken.
  static std::string tell_plan(std::size_t member, const std::string& day, bool broken) {
    const std::vector<PlannedExperiment> planned = Lab(lab(), 1).planned();
    std::string files;
    std::uint64_t seed = planned.size();
    for (const PlannedExperiment& e : planned) {
      if (fs::exists(place_->path() / ("records/" + e.id + "_1.csv"))) continue;
      for (int k = 1; k <= e.repeats; ++k) {
        std::string text = record(e, member, ++seed);
        if (broken && files.empty())
          for (std::size_t i = 400; i < text.size(); i += 700) text[i] = '#';
        files += " " + place_->write(fmt::format("records/{}_{}.csv", e.id, k), text);
      }
    }
    return "tell lab" + files + " --day " + day + " --date 2026-03-0" + day;
  }

  static Workplace* place_;
  static Outcome* opened_;
};
Workplace* Story::place_ = nullptr;
Outcome* Story::opened_ = nullptr;

TEST_F(Story, GoesFromABeliefByAWaferAndItsRecordsToASurerDecision) {
  ASSERT_EQ(opened_->status, 0) << opened_->err;
  EXPECT_NE(opened_->err.find("columns that are not read: row, column, made"), std::string::npos)
      << opened_->err;
  const Json first = state();
  const std::string best = first["standing"]["best"];
  const double p_first = first["standing"]["designs"][0]["p_best"];
  EXPECT_GT(p_first, 0);
  // A member at which another design than the recommended one is the best, if there is one.
  std::size_t member = 0;
  {
    Lab lab(Story::lab(), 1);
    const Standing& s = lab.standing();
    for (std::size_t m = 0; m < s.ensemble.members(); ++m) {
      std::size_t d = 0;
      for (std::size_t i = 1; i < s.ensemble.worth.size(); ++i)
        if (s.ensemble.worth[i][m] > s.ensemble.worth[d][m]) d = i;
      if (d != s.best) member = m;
    }
  }
  Outcome told = place_->run(tell_plan(member, "2", true));
  EXPECT_EQ(told.status, 2);  // one file was refused, the others are kept
  EXPECT_NE(told.err.find("the file is damaged"), std::string::npos) << told.err;
  EXPECT_NE(told.out.find("stick-slip in"), std::string::npos) << told.out;
  EXPECT_NE(told.out.find("the zero of the force drifts by"), std::string::npos) << told.out;
  const std::size_t readings = state()["standing"]["readings"];
  EXPECT_GE(readings, 5u);
  EXPECT_EQ(std::distance(fs::directory_iterator(place_->path() / "lab/traces"), {}),
            static_cast<long>(readings));
  const Outcome again = place_->run("next lab --count 8 --date 2026-03-03");
  EXPECT_EQ(again.status, 0) << again.err;
  if (state()["plans"].back()["experiments"].empty()) return;
  told = place_->run(tell_plan(member, "4", false));
  EXPECT_EQ(told.status, 0) << told.err;
  const Json last = state();
  // The recommendation changes, or its probability rises.
  double p_last = 0, p_before = 0;
  for (std::size_t d = 0; d < last["standing"]["designs"].size(); ++d) {
    if (last["standing"]["designs"][d]["name"] == last["standing"]["best"])
      p_last = last["standing"]["designs"][d]["p_best"];
    if (first["standing"]["designs"][d]["name"] == best)
      p_before = first["standing"]["designs"][d]["p_best"];
  }
  EXPECT_TRUE(last["standing"]["best"] != best || p_last > p_before)
      << p_before << " -> " << p_last << "\n"
      << told.out;
  EXPECT_GE(last["decisions"].size(), 4u);
  if (const char* pictures = std::getenv("PAPILLA_UPDATE_PICTURES")) {
    fs::copy_file(place_->path() / "lab/decisions.svg",
                  std::string(pictures) + "/lab_decisions.svg",
                  fs::copy_options::overwrite_existing);
    fs::copy_file(fs::directory_iterator(place_->path() / "lab/traces")->path(),
                  std::string(pictures) + "/lab_record.svg", fs::copy_options::overwrite_existing);
    std::ofstream(std::string(pictures) + "/lab_story.txt") << opened_->out << told.out;
  }
}

// tell, killed at moments all over its life: what it told is there once or not at all, and the same
// command makes it whole.
TEST_F(Story, OfATellKilledAtManyMomentsLosesNothingAndCountsNothingTwice) {
  ASSERT_EQ(opened_->status, 0) << opened_->err;
  std::string rows = "field,repeat,humidity_percent,day,F_off_N,F_on_N\n";
  for (int k = 1; k <= 12; ++k)
    rows += fmt::format("A{},{},15,9,{:.4f},{:.4f}\n", 1 + k % 4, k, 0.05 + 0.001 * k,
                        0.07 + 0.001 * k);
  place_->write("killed/table.csv", rows);
  Tribometer t;
  t.strokes = 6;
  place_->write("killed/A2_record.csv", t.record("# day: 9\n# repeat: 77\n"));
  // What a tell that is not killed comes to.
  place_->shell("cp -r lab killed/whole");
  const std::string command = "tell LAB killed/table.csv killed/A2_record.csv --date 2026-03-09";
  const auto in = [&](const std::string& folder) {
    std::string c = command;
    return c.replace(c.find("LAB"), 3, folder);
  };
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(place_->run(in("killed/whole")).status, 0);
  const double life =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::size_t whole = Lab((place_->path() / "killed/whole").string(), 1).readings().size();
  const int moments = cases(12, 30);
  int killed = 0;
  for (int k = 0; k < moments; ++k) {
    place_->shell("rm -rf killed/lab && cp -r lab killed/lab");
    // In the foreground: the signal is not its own too, so that it waits until the killed one is
    // gone.
    place_->shell(fmt::format("timeout --foreground -s KILL {:.3f} '" PAPILLA_PROGRAM "' {}",
                              life * (k + 0.5) / moments, in("killed/lab")));
    const std::size_t then = Lab((place_->path() / "killed/lab").string(), 1).readings().size();
    killed += then < whole;
    const Outcome again = place_->run(in("killed/lab"));
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(Lab((place_->path() / "killed/lab").string(), 1).readings().size(), whole);
    for (const std::string file : {"readings.csv", "belief.toml", "lab.json"})
      EXPECT_EQ(file_text(place_->path() / "killed/lab" / file),
                file_text(place_->path() / "killed/whole" / file))
          << file << " after a kill at " << k;
  }
  EXPECT_GT(killed, moments / 10);
}

}  // namespace
}  // namespace papilla::tests::story_slow_test
