// Kinds of texture, and levels, in one study.
#include "design/families.h"

#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "search/problem.h"

namespace papilla::tests::families_test {
namespace {

Study family_study() {
  return read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml",
                    {"design_space.texture.type={ choice = [\"flat\", \"hole_array\", "
                     "\"pillar_array\", \"grating\"] }"});
}

// type, period, diameter, depth, angle
Point unit_of(const StudyProblem& p, const char* kind, double period, double diameter,
              double depth) {
  const auto& kinds = texture_kinds();
  const auto index = std::find(kinds.begin(), kinds.end(), kind) - kinds.begin();
  return p.space().unit({static_cast<double>(index), period, diameter, depth, 0.9});
}

TEST(Family, AnotherKindKeepsTheMeasures) {
  HoleArray holes;
  holes.lattice = Lattice::Hexagonal;
  holes.period = 7e-6;
  holes.diameter = 4e-6;
  holes.depth = 500e-9;
  const Texture own{holes};
  const Texture pillars = of_kind(own, "pillar_array"), grating = of_kind(own, "grating");
  const auto& p = std::get<PillarArray>(pillars.kind);
  EXPECT_EQ(p.height, 500e-9);
  EXPECT_EQ(p.diameter, 4e-6);
  EXPECT_EQ(p.lattice, Lattice::Hexagonal);
  const auto& g = std::get<Grating>(grating.kind);
  EXPECT_EQ(g.width, 4e-6);
  EXPECT_EQ(g.period, 7e-6);
  EXPECT_EQ(of_kind(own, "hole_array"), own);
}

TEST(Family, AnotherKindHasRoomInThePeriodThatItShares) {
  Waves waves;
  waves.period = 2.5e-6;  // holes are 3 um wide by default
  VGrooves ridges;
  ridges.width = ridges.period = 7e-6;  // sharp ones
  for (const Texture& own : {Texture{waves}, Texture{ridges}}) {
    for (const char* kind : {"hole_array", "pillar_array", "grating", "cap_array"})
      EXPECT_TRUE(problems(of_kind(own, kind)).empty()) << kind;
  }
  const auto holes = std::get<HoleArray>(of_kind(Texture{waves}, "hole_array").kind);
  EXPECT_EQ(holes.period, 2.5e-6);
  EXPECT_DOUBLE_EQ(holes.diameter, 1.25e-6);
  waves.period = 4e-6;  // has room for them
  EXPECT_EQ(std::get<HoleArray>(of_kind(Texture{waves}, "hole_array").kind).diameter, 3e-6);
}

TEST(Family, OneVariableActsOnEveryKindThatHasTheMeasure) {
  const Study study = family_study();
  const StudyProblem problem(study);
  ASSERT_EQ(problem.space().size(), 5u);
  const Design pillars =
      problem.space().design(unit_of(problem, "pillar_array", 5e-6, 2e-6, 800e-9));
  ASSERT_EQ(texture_name(pillars.texture), "pillar_array");
  EXPECT_NEAR(std::get<PillarArray>(pillars.texture.kind).height, 800e-9, 1e-15);
  const Design grating = problem.space().design(unit_of(problem, "grating", 5e-6, 2e-6, 800e-9));
  EXPECT_NEAR(std::get<Grating>(grating.texture.kind).width, 2e-6, 1e-15);
  EXPECT_EQ(
      texture_name(problem.space().design(unit_of(problem, "flat", 5e-6, 2e-6, 8e-7)).texture),
      "flat");
  // The study's own design, each other kind; the flat surface is one of them.
  EXPECT_EQ(problem.space().starts().size(), 4u);
}

TEST(Family, FlatDesignsAreOnePoint) {
  const Study study = family_study();
  const StudyProblem problem(study);
  std::set<Point> points;
  for (const char* kind : {"flat", "hole_array", "pillar_array", "grating"}) {
    for (double period : {4e-6, 9e-6}) {
      for (double diameter : {1e-6, 3e-6})
        points.insert(problem.space().snapped(unit_of(problem, kind, period, diameter, 0)));
    }
  }
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(problem.space().snapped(*points.begin()), *points.begin());
  EXPECT_EQ(texture_name(problem.space().design(*points.begin()).texture), "flat");
  EXPECT_EQ(problem.constraints().geometry_reason(*points.begin()), "");
  const Point deep = unit_of(problem, "grating", 4e-6, 1e-6, 5e-7);
  EXPECT_EQ(problem.space().snapped(deep), problem.space().unit(problem.space().value(deep)));
}

TEST(Family, AtDepthZeroPeriodAndDiameterCollapseWithoutKindsToo) {
  const Study study = read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml");
  const StudyProblem problem(study);
  const auto flat = [&](double period, double diameter) {
    return problem.space().snapped(problem.space().unit({period, diameter, 0, 0.9}));
  };
  EXPECT_EQ(flat(4e-6, 1e-6), flat(9e-6, 5e-6));
  EXPECT_NEAR(problem.space().value(flat(4e-6, 1e-6))[0],
              study.design.texture == Texture{} ? 0 : 6e-6, 1e-15);
}

TEST(Family, LevelsCutAStackAndUnusedLevelsCollapse) {
  const Study study = read_study(PAPILLA_SOURCE_DIR "/designs/two_level_glass/study.toml",
                                 {"design_space.texture.levels={ choice = [1, 2] }"});
  const StudyProblem problem(study);
  std::size_t fine = 0;
  for (std::size_t i = 0; i < study.variables.size(); ++i) {
    if (study.variables[i].path == "texture.parts.1.diameter") fine = i;
  }
  ASSERT_TRUE(study.variables[0].is_levels());
  std::vector<double> value = problem.space().value(problem.space().unit_of_study());
  EXPECT_EQ(texture_levels(problem.space().design(problem.space().unit_of_study()).texture), 2);
  value[0] = 1;
  std::vector<double> other = value;
  other[fine] = 1.3e-6;
  EXPECT_EQ(texture_levels(problem.space().design(problem.space().unit(value)).texture), 1);
  EXPECT_EQ(problem.space().snapped(problem.space().unit(value)),
            problem.space().snapped(problem.space().unit(other)));
  // Fine holes of no depth are one level.
  other[0] = 2;
  other[fine + 1] = 0;
  EXPECT_EQ(problem.space().snapped(problem.space().unit(value)),
            problem.space().snapped(problem.space().unit(other)));
}

TEST(Family, WrongKindsAndLevelsAreReported) {
  const auto read = [](const char* text) {
    read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml", {text});
  };
  EXPECT_THROW(read("design_space.texture.type={ choice = [\"holes\"] }"), InputError);
  EXPECT_THROW(read("design_space.texture.type=[\"flat\", \"grating\"]"), InputError);
  EXPECT_THROW(read("design_space.texture.levels={ choice = [2] }"), InputError);
}

TEST(Parts, AreFoundByTheirNumberAndWhatIsNoneIsTheWhole) {
  HoleArray holes;
  Grating grooves;
  PillarArray pillars;
  Stack inner, outer;
  inner.parts = {Texture{grooves}, Texture{pillars}};
  outer.parts = {Texture{holes}, Texture{inner}};
  const Texture whole{outer};
  EXPECT_EQ(part_at(whole, "texture.parts.0.depth"), Texture{holes});
  EXPECT_EQ(part_at(whole, "texture.parts.1"), Texture{inner});
  EXPECT_EQ(part_at(whole, "texture.parts.1.parts.0.width"), Texture{grooves});
  EXPECT_EQ(part_at(whole, "texture.parts.1.parts.1.height"), Texture{pillars});
  for (const char* path : {"texture.parts.2.depth", "texture.parts.x", "texture.combine", "drive"})
    EXPECT_EQ(part_at(whole, path), whole) << path;
}

}  // namespace
}  // namespace papilla::tests::families_test
