// The library as other programs see it: public headers alone.
#include <gtest/gtest.h>
#include <papilla/papilla.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace {

constexpr const char* kHoles =
    "schema_version = 1\nbase = \"m3_samples/a3h350.toml\"\n[accuracy]\nlevel = \"draft\"\n"
    "[environment]\nrelative_humidity = [\"50 %\"]\n";

TEST(Library, ReadsTextAndTakesValuesWithUnits) {
  const papilla::Design design = papilla::Design::parse(kHoles);
  EXPECT_EQ(design.with("texture.depth", "262 nm").number("texture.depth"), 262e-9);
  EXPECT_EQ(design.number("texture.depth"), 350e-9) << "the first is as before";
}

TEST(Library, SaysEveryProblemWithItsPlace) {
  try {
    papilla::Design::parse(
        "schema_version = 1\n[texture]\ntype = \"hole_array\"\nperiod = 3\ndepht = \"1 nm\"\n");
    FAIL() << "no problem";
  } catch (const papilla::InputError& error) {
    const std::vector<papilla::Problem>& problems = error.problems();
    ASSERT_EQ(problems.size(), 2u) << error.what();
    EXPECT_EQ(problems[0].text(), "design.toml:4:10: texture.period: needs a unit, e.g. \"3 um\"");
    EXPECT_EQ(problems[1].line, 5);
  }
}

TEST(Library, HeightsAreHolesInALand) {
  const papilla::Heights h = papilla::Design::parse(kHoles).heights(64);
  EXPECT_EQ(h.z.size(), static_cast<std::size_t>(h.nx) * static_cast<std::size_t>(h.ny));
  EXPECT_NEAR(*std::min_element(h.z.begin(), h.z.end()), -350e-9, 1e-12);
  EXPECT_EQ(*std::max_element(h.z.begin(), h.z.end()), 0);
}

TEST(Library, WorkIsCountedAndStops) {
  const papilla::Design design = papilla::Design::parse(kHoles);
  int done = 0;
  std::atomic<bool> stop = false;
  papilla::EvaluateOptions options;
  options.stop = &stop;
  options.progress = [&](int count) {
    done = count;
    stop = true;
  };
  options.threads = 1;
  EXPECT_THROW(papilla::evaluate(design, options), papilla::Stopped);
  EXPECT_EQ(done, 1);
}

TEST(Library, FullContactOfAFlatPlaneCarriesItsLoad) {
  papilla::Heights plane{16, 16, 1e-7, 1e-7, std::vector<double>(256, 0.0)};
  const papilla::ContactResult r = papilla::contact(plane, papilla::Solid::half_space(1e6), 1e4);
  EXPECT_TRUE(r.converged);
  EXPECT_NEAR(r.mean_pressure, 1e4, 1e-4);
  EXPECT_NEAR(r.area_fraction, 1, 1e-12);
}

TEST(Library, ABridgeRupturesBeyondItsLimit) {
  const double right_angle = std::acos(0.0);
  const papilla::BridgeResult b = papilla::bridge(1e-20, 100e-9, 0.8, right_angle, 0.072);
  ASSERT_TRUE(b.exists);
  EXPECT_GT(b.rupture_gap, 100e-9);
  EXPECT_FALSE(papilla::bridge(1e-20, 1.1 * b.rupture_gap, 0.8, right_angle, 0.072).exists);
}

TEST(Library, AStudyIsSearchedByAskAndTell) {
  const papilla::Study study = papilla::Study::parse(
      "schema_version = 1\nbase = \"m3_samples/a3h350.toml\"\n"
      "[design_space]\n\"texture.depth\" = [\"100 nm\", \"500 nm\"]\n"
      "[objective]\nmaximise = \"mean(modulation)\"\n[search]\nevaluations = 30\n");
  ASSERT_EQ(study.variables().size(), 1u);
  EXPECT_TRUE(study.objectives().at(0).maximise);
  papilla::Search search(study);
  double best = 0, found = 0;
  for (int step = 0; step < 30; ++step) {
    std::vector<papilla::Judgement> judgements;
    for (const std::vector<double>& values : search.ask()) {
      const double off = (values[0] - 300e-9) / 1e-7;  // a caller's own evaluation
      papilla::Judgement judgement;
      judgement.ok = true;
      judgement.values = {1 - off * off};
      judgement.errors = {0};
      if (judgement.values[0] > best) best = judgement.values[0], found = values[0];
      judgements.push_back(judgement);
    }
    if (judgements.empty()) break;
    search.tell(judgements);
  }
  EXPECT_NEAR(found, 300e-9, 10e-9);
}

}  // namespace
