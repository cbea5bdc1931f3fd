// A time limit bounds a run and leaves the search most of it.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "base/files.h"
#include "report/results.h"
#include "search/run.h"
#include "tests/temporary.h"

namespace papilla::tests::clock_slow_test {
namespace {

// Pillars whose two scattering numbers make five tasks of each design: one design was searched in a
// minute, and the run took 158 s.
Study pillars() {
  return parse_study(R"toml(schema_version = 1
title = "Pillars"
[texture]
type = "pillar_array"
period = "6 um"
diameter = "3 um"
height = "300 nm"
[surface]
contact_angle = "60 deg"
[environment]
relative_humidity = ["35 %", "75 %"]
[drive]
amplitude = "200 V"
frequency = "5 kHz"
[accuracy]
level = "draft"
[design_space]
"texture.period" = ["4 um", "10 um"]
"texture.height" = ["0 nm", "600 nm"]
"surface.contact_angle" = ["40 deg", "90 deg"]
[scatter]
"texture.diameter" = "100 nm"
"texture.height" = "20 nm"
[objective]
maximise = "mean(modulation)"
minimise = "variation(modulation)"
[search]
evaluations = 40
time = "12 s"
jobs = 2
)toml",
                     "pillars.toml");
}

TEST(Clock, ARunEndsInItsTimeAndHasSearchedForMostOfIt) {
  const std::string folder = temporary("clock");
  std::filesystem::remove_all(folder);
  const Study study = pillars();
  std::vector<double> at;  // of each progress
  const auto begin = std::chrono::steady_clock::now();
  const auto clock = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  double searched = 0, longest = 0, before = 0;
  const OptimiseResult r = optimise_to_folder(study, {folder, false,
                                                      [&](const Progress& p) {
                                                        longest =
                                                            std::max(longest, clock() - before);
                                                        before = clock();
                                                        if (p.stage == "search") searched = before;
                                                      },
                                                      nullptr});
  const double used = clock();
  EXPECT_LE(used, 1.1 * study.search.time + longest);
  EXPECT_GE(searched, 0.4 * study.search.time);
  EXPECT_GE(r.evaluations, 1);
  ASSERT_TRUE(r.has_best());
  const std::string summary = read_bytes(folder + "/summary.md");
  const std::string first = "# Pillars\n\n**Stopped by the clock (12 s) after " +
                            std::to_string(r.evaluations) + " of 40 evaluations;";
  if (r.end == SearchEnd::Clock) {
    EXPECT_TRUE(summary.starts_with(first)) << summary.substr(0, 400);
  }
  // A finished run is taken from its journal, whatever the clock says now.
  const OptimiseResult again = optimise_to_folder(study, {folder, true, {}, nullptr});
  EXPECT_EQ(again.evaluations, r.evaluations);
  EXPECT_EQ(again.finalists.size(), r.finalists.size());
  EXPECT_EQ(read_bytes(folder + "/summary.md"), summary);
}

}  // namespace
}  // namespace papilla::tests::clock_slow_test
