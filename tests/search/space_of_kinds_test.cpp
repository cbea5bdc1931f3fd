// Spaces in which kinds of texture compete, limits at their borders, and frequencies that are felt:
// worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "config/describe.h"
#include "search/findings.h"
#include "search/problem.h"
#include "search/shared.h"
#include "tests/support/without_belief.h"

namespace papilla::tests::space_of_kinds_test {
namespace {

double kind_of(const std::string& name) {
  const auto& kinds = texture_kinds();
  return static_cast<double>(std::find(kinds.begin(), kinds.end(), name) - kinds.begin());
}

// Flat, holes or pillars; their width and their depth.
Study kinds() {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
  study.population.clear();
  study.constraints.clear();
  const double flat = kind_of("flat"), hole = kind_of("hole_array"),
               pillar = kind_of("pillar_array");
  study.variables = {{"texture.type",
                      "",
                      std::min({flat, hole, pillar}),
                      std::max({flat, hole, pillar}),
                      {flat, hole, pillar}},
                     {"texture.diameter", "um", 1e-6, 4e-6, {}},
                     {"texture.depth", "nm", 0, 600e-9, {}},
                     {"surface.contact_angle", "deg", 0.5, 1.5, {}}};
  return study;
}

TEST(SpaceOfKinds, ADesignHasTheNumbersOfItsKind) {
  const Study study = kinds();
  const StudyProblem problem(study);
  const DesignSpace& space = problem.space();
  const auto design = [&](const char* kind, double depth) {
    return space.design(space.snapped(space.unit({kind_of(kind), 2e-6, depth, 1.0})));
  };
  Design pillars = design("pillar_array", 300e-9);
  EXPECT_EQ(texture_name(pillars.texture), "pillar_array");
  EXPECT_NEAR(get_number(pillars, "texture.height"), 300e-9, 1e-15);  // its word for a depth
  EXPECT_NEAR(get_number(pillars, "texture.diameter"), 2e-6, 1e-12);
  EXPECT_NEAR(get_number(pillars, "surface.contact_angle"), 1.0, 1e-12);
  EXPECT_NEAR(get_number(design("hole_array", 300e-9), "texture.depth"), 300e-9, 1e-15);
  EXPECT_EQ(texture_name(design("flat", 300e-9).texture), "flat");
  // Of no depth every kind is the flat one.
  for (const char* kind : {"hole_array", "pillar_array"})
    EXPECT_EQ(texture_name(design(kind, 1e-9).texture), "flat") << kind;
}

// Pillars with a height of their own: the depth beside it is of the holes alone.
TEST(SpaceOfKinds, AKindsOwnKeyActsInPlaceOfTheSharedOne) {
  Study study = kinds();
  study.variables[2].low = 100e-9;
  study.variables.push_back({"texture.height", "nm", 100e-9, 900e-9, {}});
  const StudyProblem problem(study);
  const DesignSpace& space = problem.space();
  const Point unit = space.unit({kind_of("pillar_array"), 2e-6, 100e-9, 1.0, 546e-9});
  const Design pillars = space.design(unit),
               holes = space.design(space.unit({kind_of("hole_array"), 2e-6, 100e-9, 1.0, 546e-9}));
  EXPECT_NEAR(get_number(pillars, "texture.height"), 546e-9, 1e-15);
  EXPECT_NEAR(get_number(holes, "texture.depth"), 100e-9, 1e-15);
  for (const std::size_t everywhere : {0u, 1u, 3u}) {
    EXPECT_TRUE(space.acts(pillars, everywhere)) << everywhere;
    EXPECT_TRUE(space.acts(holes, everywhere)) << everywhere;
  }
  EXPECT_FALSE(space.acts(pillars, 2));
  EXPECT_TRUE(space.acts(pillars, 4));
  EXPECT_TRUE(space.acts(holes, 2));
  EXPECT_FALSE(space.acts(holes, 4));
  // What does not act lies on no bound and is shared by none.
  EXPECT_TRUE(variables_at_bound(problem, unit, {}).empty());
  JudgedDesigns history;
  history.evaluations = {{unit, {true, "", {-0.5, 0.3}, {-1}, {}}}};
  for (const SharedRange& range : shared_ranges(problem, history).ranges)
    EXPECT_NE(range.name, "texture.depth");
}

TEST(SpaceOfKinds, AllFlatDesignsAreOnePoint) {
  const Study study = kinds();
  const StudyProblem problem(study);
  const DesignSpace& space = problem.space();
  const auto snapped = [&](const char* kind, double width, double depth) {
    return space.snapped(space.unit({kind_of(kind), width, depth, 1.0}));
  };
  const Point flat = snapped("flat", 2e-6, 300e-9);
  EXPECT_EQ(snapped("flat", 3e-6, 500e-9), flat);
  EXPECT_EQ(snapped("hole_array", 3e-6, 1.9e-9), flat);
  EXPECT_EQ(snapped("pillar_array", 1e-6, 0), flat);
  // What has no effect there is the study's own.
  const std::vector<double> own = space.value(space.unit_of_study()), value = space.value(flat);
  EXPECT_NEAR(value[1], own[1], 1e-12);
  EXPECT_NEAR(own[1], 3e-6, 1e-12);
  EXPECT_NEAR(value[3], 1.0, 1e-12);
  EXPECT_NE(snapped("hole_array", 3e-6, 2.1e-9), flat);
  EXPECT_NE(snapped("hole_array", 2e-6, 300e-9), snapped("hole_array", 3e-6, 300e-9));
  EXPECT_NE(snapped("hole_array", 2e-6, 300e-9), snapped("pillar_array", 2e-6, 300e-9));
}

TEST(SpaceOfKinds, ASearchStartsAtEachKindOnceAndAtTheFlatOne) {
  const Study study = kinds();
  const StudyProblem problem(study);
  const DesignSpace& space = problem.space();
  const std::vector<Point> starts = space.starts();
  ASSERT_EQ(starts.size(), 3u);  // holes, as the study has them; flat; pillars
  EXPECT_EQ(space.design(starts[0]), study.design);
  std::vector<std::string> names;
  for (const Point& start : starts) names.push_back(texture_name(space.design(start).texture));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"flat", "hole_array", "pillar_array"}));
  const Point pillars = space.unit({kind_of("pillar_array"), 2e-6, 300e-9, 1.2});
  const auto flat = space.flattened(pillars);
  ASSERT_TRUE(flat);
  EXPECT_EQ(texture_name(space.design(*flat).texture), "flat");
  EXPECT_NEAR(space.value(*flat)[3], 1.2, 1e-12);
  EXPECT_FALSE(space.flattened(*flat));
}

// A value against a limit of nothing: at least nothing is always kept, at most is the value itself.
TEST(LimitBorders, ALimitOfNothingIsKeptFromBelowAlone) {
  Study study = kinds();
  study.variables = {{"texture.depth", "nm", 0, 600e-9, {}}};
  const auto expect = [&](double limit, bool at_least,
                          const std::vector<std::pair<double, double>>& violations) {
    study.constraints = {{MetricLimit{parse_metric("mean(friction)")}, limit, at_least}};
    const StudyProblem problem(study);
    for (const auto& [friction, violation] : violations) {
      Score score;
      score.limited = {friction};
      EXPECT_NEAR(problem.constraints().violations(score).at(0), violation, 1e-9)
          << limit << " " << friction;
    }
  };
  expect(0, true, {{5, -1}, {-5, -1}});
  expect(0, false, {{5, 5}, {-5, -1}});
  // Up to ten as it is, then towards eleven.
  expect(2, true, {{8, -0.75}, {0.5, 3}, {2 / 11.0, 10}, {2 / 21.0, 11 - 0.5}, {0, 11}, {-1, 11}});
  expect(2, false, {{0.5, -0.75}, {2, 0}, {22, 10}, {42, 11 - 0.5}, {-9, -1}});
}

// Looks that take long are known with the evaluation: of the designs' own four numbers.
TEST(LimitBorders, EachLookHasItsLimit) {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
  study.population.clear();
  study.constraints = {read_constraint("haze", 0.02),
                       read_constraint("transmittance", 0.9),
                       read_constraint("gloss", 70),
                       read_constraint("colour_shift", 0.01),
                       read_constraint("most_gloss", 70),
                       read_constraint("distinctness", 0.9),
                       read_constraint("total_transmittance", 0.95)};
  const StudyProblem problem(study);
  ASSERT_EQ(problem.constraints().evaluated(), 0u);
  const Point unit = problem.space().unit_of_study();
  const Optics look = appearance_of(problem.space().design(unit));
  ASSERT_FALSE(look.refused());
  const std::vector<double> v = problem.constraints().look(unit);
  ASSERT_EQ(v.size(), 7u);
  const auto bounded = [](double x) { return std::max(-1.0, x > 10 ? 11 - 10 / x : x); };
  EXPECT_NEAR(v[0], bounded(look.haze / 0.02 - 1), 1e-12);
  EXPECT_NEAR(v[1], bounded(0.9 / look.transmittance - 1), 1e-12);
  EXPECT_NEAR(v[2], bounded(70 / look.gloss - 1), 1e-12);
  EXPECT_NEAR(v[3], bounded(look.colour_shift / 0.01 - 1), 1e-12);
  EXPECT_NEAR(v[4], bounded(look.gloss / 70 - 1), 1e-12);
  EXPECT_NEAR(v[5], bounded(0.9 / look.distinctness - 1), 1e-12);
  EXPECT_NEAR(v[6], bounded(0.95 / look.total_transmittance - 1), 1e-12);
  // Said with its unit.
  study.constraints = {read_constraint("transmittance", 0.999)};
  const StudyProblem clear(study);
  const std::string reason = clear.constraints().geometry_reason(unit);
  EXPECT_TRUE(reason.starts_with("transmittance ") && reason.ends_with(" % is below 99.9 %"))
      << reason;
}

// Numbers of some sections are those of all that stand in them, at the same places.
TEST(NumberFields, OfSomeSectionsAreThoseOfAllThatStandThere) {
  Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_glass/directional.toml");
  std::vector<NumberField> wanted = number_fields(design);
  std::erase_if(wanted, [](const NumberField& f) {
    return !f.path.starts_with("surface.") && !f.path.starts_with("texture.");
  });
  const std::vector<NumberField> some = number_fields_in(design, {"surface", "texture"});
  ASSERT_EQ(some.size(), wanted.size());
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some[i].path, wanted[i].path);
    EXPECT_EQ(some[i].value, wanted[i].value);
  }
  EXPECT_EQ(number_fields_in(design, {}).size(), number_fields(design).size());
}

// A corner above 1 Hz is felt: 1 / (2 pi eps0 eps rho) of a layer or of the gap, or the finger's.
TEST(LimitBorders, AFrequencyIsFeltAboveACornerOfOneHertz) {
  Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml");
  design.finger.electrical.corner_frequency = 0;
  design.finger.electrical.gap_resistivity = 0;
  for (FilmDielectric& layer : design.surface.dielectric) layer.resistivity = 0;
  const std::string deaf =
      "neither film nor gap nor skin conducts (surface.dielectric.resistivity, "
      "finger.electrical.gap_resistivity, finger.electrical.corner_frequency)";
  EXPECT_EQ(frequency_not_felt(design), deaf);
  const double rho = 1 / (2 * kPi * kVacuumPermittivity);  // of a corner of 1 Hz in air
  design.finger.electrical.gap_resistivity = 1.01 * rho;
  EXPECT_EQ(frequency_not_felt(design), deaf);
  design.finger.electrical.gap_resistivity = 0.99 * rho;
  EXPECT_EQ(frequency_not_felt(design), "");
  design.finger.electrical.gap_resistivity = 0;
  design.finger.electrical.corner_frequency = 0.99;
  EXPECT_EQ(frequency_not_felt(design), deaf);
  design.finger.electrical.corner_frequency = 1.01;
  EXPECT_EQ(frequency_not_felt(design), "");
  design.finger.electrical.corner_frequency = 0;
  FilmDielectric& layer = design.surface.dielectric.front();
  layer.permittivity = 4;
  layer.resistivity = 1.01 * rho / 4;
  EXPECT_EQ(frequency_not_felt(design), deaf);
  layer.resistivity = 0.99 * rho / 4;
  EXPECT_EQ(frequency_not_felt(design), "");
  layer.resistivity = 0;
  design.finger.electrical.skin_exponent = 0.9;  // disperses at every frequency
  EXPECT_EQ(frequency_not_felt(design), "");
  design.finger.electrical.skin_exponent = 1;
  design.drive.control = DriveControl::Current;  // then the voltage follows the frequency
  EXPECT_EQ(frequency_not_felt(design), "");
  design.drive.waveform = Waveform::Dc;
  EXPECT_EQ(frequency_not_felt(design), "the drive is a direct voltage");
}

}  // namespace
}  // namespace papilla::tests::space_of_kinds_test
