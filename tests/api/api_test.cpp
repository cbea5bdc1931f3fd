// The library as other programs see it: public headers alone.
#include <gtest/gtest.h>
#include <papilla/papilla.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>

namespace {

constexpr const char* kHoles =
    "schema_version = 1\nbase = \"m3_samples/a3h350.toml\"\n[accuracy]\nlevel = \"draft\"\n"
    "[environment]\nrelative_humidity = [\"50 %\"]\n";

TEST(Library, ReadsTextAndTakesValuesWithUnits) {
  const papilla::Design design = papilla::Design::parse(kHoles);
  EXPECT_EQ(design.with("texture.depth", "262 nm").number("texture.depth"), 262e-9);
  EXPECT_EQ(design.number("texture.depth"), 350e-9) << "the first is as before";
}

TEST(Library, TitleSaysWhatWasChanged) {
  const papilla::Design design = papilla::Design::parse(kHoles);
  ASSERT_FALSE(design.title().empty());
  const papilla::Design shallow = design.with("texture.depth", "262 nm");
  EXPECT_EQ(shallow.title(), design.title() + "; texture.depth 262 nm");
  EXPECT_EQ(shallow.with({{"texture.depth:", "2e-07"}, {"accuracy.grid", "48"}}).title(),
            design.title() + "; texture.depth 200 nm");
  EXPECT_EQ(papilla::Design::parse(shallow.toml()).title(), shallow.title());
  EXPECT_EQ(shallow.with("title", "\"mine\"").title(), "mine");
  EXPECT_EQ(design.with("accuracy.grid", "48").title(), design.title());
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

TEST(Library, NumbersBehindAColonAreSi) {
  const papilla::Design design = papilla::Design::parse(kHoles);
  EXPECT_EQ(design.with("texture.depth:", "2.62e-07").number("texture.depth"), 262e-9);
  EXPECT_THROW(design.with("texture.depth", "2.62e-07"), papilla::InputError);
  EXPECT_EQ(papilla::in_si("262 nm", "m"), 262e-9);
}

TEST(Library, DrawnHeightsComeBackToTheLastBit) {
  papilla::Heights drawn{48, 48, 0.125e-6, 0.125e-6, {}};
  for (int i = 0; i < 48 * 48; ++i) drawn.z.push_back(1e-8 * std::sin(0.1 * i * (i % 7)));
  const papilla::Design design =
      papilla::Design::from_heights(drawn, {{"base", "m3_samples/flat.toml"}});
  std::vector<double> below_top = drawn.z;  // its highest place is the untouched land
  const double top = *std::max_element(drawn.z.begin(), drawn.z.end());
  for (double& z : below_top) z -= top;
  EXPECT_EQ(design.heights(48).z, below_top);
  EXPECT_EQ(papilla::Design::parse(design.toml(), drawn).heights(48).z, below_top);
  drawn.z[5] = std::nan("");
  EXPECT_THROW(papilla::Design::from_heights(drawn), papilla::InputError);
}

// A process that was forked off, as Python's pools are, leaves the file of its parent's map alone.
TEST(Library, AForkLeavesDrawnHeightsToItsParent) {
  papilla::Heights drawn{8, 8, 1e-6, 1e-6, std::vector<double>(64, 0)};
  drawn.z[9] = -1e-7;
  auto design =
      std::make_optional(papilla::Design::from_heights(drawn, {{"base", "m3_samples/flat.toml"}}));
  const pid_t child = ::fork();
  if (child == 0) {
    design.reset();
    ::_exit(0);
  }
  ASSERT_GT(child, 0);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(design->with("drive.amplitude", "90 V").heights(8).z, drawn.z);
}

// What was given for the kind before, when the design was made or later, is none of the new one's.
TEST(Library, AnotherKindHasNothingOfTheOneBefore) {
  const papilla::Design holes = papilla::Design::parse(
      "schema_version = 1\nbase = \"m3_samples/common.toml\"\n", {{"texture.type", "hole_array"},
                                                                  {"texture.period", "7 um"},
                                                                  {"texture.diameter", "3 um"},
                                                                  {"texture.depth:", "3.5e-7"},
                                                                  {"drive.amplitude", "90 V"}});
  const papilla::Design flat = holes.with("texture.type", "\"flat\"");
  EXPECT_THROW(flat.number("texture.period"), papilla::InputError);
  EXPECT_EQ(flat.number("drive.amplitude"), 90);
  EXPECT_EQ(flat.with("texture.type", "hole_array").number("texture.period"), 6e-6)
      << "its default";
  const papilla::Design grooves =
      holes.with({{"texture.type", "grating"}, {"texture.period", "8 um"}});
  EXPECT_EQ(grooves.number("texture.period"), 8e-6);
  EXPECT_EQ(holes.with("texture.type", "'hole_array'").number("texture.depth"), 350e-9);
  const papilla::Design file = papilla::Design::parse(kHoles).with("texture.depth", "262 nm");
  EXPECT_THROW(file.with("texture.type", "flat").number("texture.depth"), papilla::InputError);

  papilla::Heights drawn{8, 8, 1e-6, 1e-6, std::vector<double>(64, 0)};
  drawn.z[9] = -1e-7;
  const papilla::Design map =
      papilla::Design::from_heights(drawn, {{"base", "m3_samples/flat.toml"}});
  ASSERT_NE(map.with("drive.amplitude", "90 V").drawn(), nullptr);
  EXPECT_EQ(map.with("texture.type", "flat").drawn(), nullptr);
}

TEST(Library, ADifferenceOfADesignFromItselfIsNoneAndSure) {
  const papilla::Design design = papilla::Design::parse(kHoles).with("accuracy.grid", "48");
  const papilla::Comparison same = papilla::compare(design, design);
  EXPECT_EQ(same.points.at(0).modulation.value, 0);
  EXPECT_EQ(same.points.at(0).modulation.error, 0);
  EXPECT_TRUE(same.mean_friction.paired);
}

TEST(Library, ASensitivityIsAFiniteStepOnCommonSkins) {
  const papilla::Design design = papilla::Design::parse(kHoles).with("accuracy.grid", "48");
  papilla::SensitivityOptions options;
  options.keys = {"texture.depth"};
  const auto found = papilla::sensitivity(design, "mean(friction)", options);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].path, "texture.depth");
  EXPECT_EQ(found[0].unit, "nm");
  EXPECT_DOUBLE_EQ(found[0].value, 350e-9);
  const auto friction = [&](double depth) {
    return papilla::evaluate(design.with("texture.depth:", std::to_string(1e9 * depth) + "e-9"))
        .points()
        .at(0)
        .friction_off.value;
  };
  EXPECT_NEAR(found[0].change.value, friction(found[0].up) - friction(found[0].down),
              1e-9 * friction(350e-9));
  EXPECT_NEAR(found[0].slope * 35e-9, found[0].change.value, 1e-9 * friction(350e-9));
}

TEST(Library, DropletsAndPullOfAPlaneGapAreThoseOfTheTheory) {
  const papilla::Heights gap{32, 32, 1e-7, 1e-7, std::vector<double>(1024, 100e-9)};
  papilla::FieldOptions options;
  options.dc = true;
  const papilla::FieldResult field = papilla::field(gap, 100, options);
  const double gap_and_oxide = 100e-9 + 500e-9 / 3.9, eps0 = 8.8541878128e-12;
  EXPECT_NEAR(field.mean_pressure, 0.5 * eps0 * std::pow(100 / gap_and_oxide, 2),
              1e-3 * field.mean_pressure);
  const papilla::DropletsResult water = papilla::droplets(gap, 0.2e-18);
  EXPECT_TRUE(water.converged);
  EXPECT_GT(water.capillary_force, 0);
  EXPECT_THROW(papilla::droplets(gap, -1), papilla::InputError);
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

TEST(Library, AnExceptionOfTheProgressComesBackToTheCaller) {
  papilla::EvaluateOptions options;
  options.progress = [](int) { throw std::domain_error("mine"); };
  EXPECT_THROW(papilla::evaluate(papilla::Design::parse(kHoles), options), std::domain_error);
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
  std::size_t told = 0;
  for (;;) {
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
    told += judgements.size();
    ASSERT_LE(told, 30u);
  }
  EXPECT_EQ(told, 30u);  // search.evaluations: the first batch is of several, the last one of fewer
  EXPECT_NEAR(found, 300e-9, 10e-9);
}

}  // namespace
