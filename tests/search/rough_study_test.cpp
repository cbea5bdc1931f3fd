// Surfaces without walls in a search: rough glass alone, in a stack and beside other kinds.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "base/files.h"
#include "design/study.h"
#include "search/problem.h"
#include "search/run.h"
#include "tests/support/without_belief.h"
#include "tests/temporary.h"

namespace papilla::tests::rough_study_test {
namespace {

const std::string kRough = R"(type = "random_rough"
rms = "60 nm"
)";

// A study of this texture and these variables at one humidity.
Study study_of(const std::string& texture, const std::string& variables) {
  const std::string path = temporary("rough_study.toml");
  write_bytes(path, "schema_version = 1\n[texture]\n" + texture + R"toml(
[surface]
contact_angle = "50 deg"
dielectric = [{ material = "SiO2", thickness = "500 nm", permittivity = 3.9, strength = "1 GV/m" }]
[finger]
base = "fingers/reference.toml"
load = "0.2 N"
[environment]
relative_humidity = ["35 %"]
[drive]
control = "voltage"
waveform = "sine"
amplitude = "200 V"
frequency = "5 kHz"
[accuracy]
level = "draft"
[objective]
maximise = "mean(modulation)"
[search]
evaluations = 5
jobs = 1
[design_space]
)toml" + variables);
  return read_study(path);
}

// How many different designs `count` values of one variable make.
std::size_t designs(const Study& study, std::size_t variable, int count) {
  const StudyProblem problem(study);
  std::set<Point> out;
  for (int i = 0; i < count; ++i) {
    Point unit = problem.space().unit_of_study();
    unit[variable] = static_cast<double>(i) / (count - 1);
    out.insert(problem.space().snapped(unit));
  }
  return out.size();
}

TEST(RoughStudy, EveryRmsIsADesign) {
  EXPECT_EQ(designs(study_of(kRough, R"("texture.rms" = ["5 nm", "200 nm"])"), 0, 9), 9u);
  const std::string parts = R"(type = "stack"
parts = [{ type = "hole_array" }, { type = "random_rough", rms = "20 nm" }]
)";
  EXPECT_EQ(designs(study_of(parts, R"("texture.parts.1.rms" = ["5 nm", "200 nm"])"), 0, 9), 9u);
}

TEST(RoughStudy, ARmsOfZeroIsOneDesignWhateverItsSpectrum) {
  const Study study = study_of(kRough, R"("texture.rms" = ["0 nm", "200 nm"]
"texture.hurst" = [0.5, 0.9])");
  const StudyProblem problem(study);
  const auto& space = problem.space();
  EXPECT_EQ(space.snapped({0, 0.2}), space.snapped({0, 0.7}));
  EXPECT_NE(space.snapped({0.5, 0.2}), space.snapped({0.5, 0.7}));
  EXPECT_FALSE(facts(problem.space().design(space.snapped({0, 0.2})).texture).relief.present);
  ASSERT_TRUE(problem.space().flattened(problem.space().unit_of_study()));
  EXPECT_EQ(*problem.space().flattened(problem.space().unit_of_study()), space.snapped({0, 0.2}));
}

TEST(RoughStudy, RoughCompetesWithFlat) {
  const std::string variables = R"("texture.type" = { choice = ["flat", "random_rough"] }
"texture.rms" = ["5 nm", "200 nm"])";
  const Study study = study_of(kRough, variables);
  const StudyProblem problem(study);
  ASSERT_TRUE(study.variables[0].is_kind());
  EXPECT_EQ(designs(study, 1, 9), 9u);
  std::set<Point> flat;
  for (const double rms : {5e-9, 50e-9, 200e-9})
    flat.insert(problem.space().snapped(problem.space().unit({study.variables[0].low, rms})));
  EXPECT_EQ(flat.size(), 1u);
}

// Neither kind is flat here: a depth of 0 is the same surface as a rms of 0 to no other measure.
TEST(RoughStudy, AFlatRoughSurfaceIsNoHole) {
  const Study study =
      study_of(kRough, R"("texture.type" = { choice = ["hole_array", "random_rough"] }
"texture.rms" = ["0 nm", "200 nm"]
"texture.depth" = ["0 nm", "500 nm"])");
  const StudyProblem problem(study);
  const Point smooth =
      problem.space().snapped(problem.space().unit({study.variables[0].high, 0, 300e-9}));
  EXPECT_FALSE(facts(problem.space().design(smooth).texture).relief.present);
}

TEST(RoughStudy, ASearchMakesAllEvaluationsThatItWasAskedFor) {
  Study study = without_belief(study_of(kRough, R"("texture.rms" = ["5 nm", "200 nm"])"));
  study.design.accuracy.grid = 64;
  study.design.finger.uncertainty.clear();
  OptimiseOptions options;
  options.folder = temporary("rough_search");
  std::filesystem::remove_all(options.folder);
  const OptimiseResult result = optimise(study, options);
  EXPECT_EQ(result.evaluations, 5);
  EXPECT_EQ(result.failures, 0);
  ASSERT_TRUE(result.flat);  // compared with the surface without its roughness
}

}  // namespace
}  // namespace papilla::tests::rough_study_test
