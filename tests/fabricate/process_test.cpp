// What a process does to an array, by closed forms; and the mask that undoes it, by simulation.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "fabricate/made.h"
#include "fabricate/wafer_drawing.h"
#include "tests/support/refusal.h"

namespace papilla::tests::process_test {
namespace {

HoleArray holes() {
  HoleArray out;
  out.period = 6e-6, out.diameter = 3e-6, out.depth = 400e-9, out.wall_angle = 85 * kPi / 180;
  return out;
}

// The surface that a process makes of the mask that is drawn for a texture.
MadeArray made(const Texture& texture, const Process& process) {
  WaferPlan plan;
  plan.list.process = process;
  plan.list.wafer.pad_width = plan.list.wafer.pad_height = 100e-6;
  plan.treatments.push_back({"T", {}, 1});
  plan.treatments[0].design.texture = texture;
  plan.rows = plan.columns = 1;
  plan.pitch_x = plan.pitch_y = 1e-3;
  const WaferDrawing drawing = draw_wafer(plan);
  for (const LayoutCell& cell : drawing.layout.cells) {
    if (cell.name == drawing.arrays.at(0).cell)
      return made_of(drawing.arrays[0].masked, around_centre(drawing.arrays[0], cell), process);
  }
  return {};
}

Process uncompensated() {
  Process out;
  out.compensate = false;
  return out;
}

TEST(Process, ASquareCornerIsRoundedToItsRadius) {
  // A quarter plane after a blur is Phi(x/s) Phi(y/s); on its diagonal it is 1/2 where an arc of
  // the radius passes, (1 - sqrt(1/2)) r from either edge.
  Process process;
  process.corner_radius = 300e-9;
  const double t = (1 - std::sqrt(0.5)) * 300e-9;
  const double phi = 0.5 * std::erfc(-t / (std::sqrt(2.0) * process.blur()));
  EXPECT_NEAR(phi * phi, 0.5, 1e-7);
}

TEST(Process, BiasAndUndercutWidenHolesByTwiceTheirSum) {
  Process process = uncompensated();
  process.resist_bias = 40e-9;
  process.undercut = 0.25;
  const MadeArray m = made(Texture{holes()}, process);
  EXPECT_NEAR(m.width - m.wanted_width, 2 * (40e-9 + 0.25 * 400e-9), 1e-9);
  PillarArray pillars;
  pillars.period = 6e-6, pillars.diameter = 3e-6, pillars.height = 400e-9;
  const MadeArray p = made(Texture{pillars}, process);
  EXPECT_NEAR(p.width - p.wanted_width, -2 * (40e-9 + 0.25 * 400e-9), 1e-9);
}

TEST(Process, TaperTakesTheRunOfTheWallFromTheMeanWidth) {
  Grating grooves;
  grooves.period = 4e-6, grooves.width = 1.5e-6, grooves.depth = 300e-9,
  grooves.wall_angle = kPi / 2;
  Process process = uncompensated();
  process.wall_angle = 70 * kPi / 180;
  const MadeArray m = made(Texture{grooves}, process);
  EXPECT_NEAR(m.width, 1.5e-6 - 300e-9 / std::tan(70 * kPi / 180), 1e-9);
  EXPECT_NEAR(m.wanted_width, 1.5e-6, 1e-12);
}

// Curvature flow: to first order an edge of radius R moves inwards by s^2 / (2 R).
TEST(Process, ABlurShrinksDiscsByItsVarianceOverTheirRadius) {
  Process process = uncompensated();
  process.corner_radius = 300e-9;
  const MadeArray m = made(Texture{holes()}, process);
  const double s = process.blur(), radius = 1.5e-6;
  EXPECT_NEAR(m.wanted_width - m.width, s * s / radius, 0.05 * s * s / radius + 0.4e-9);
}

TEST(Process, ImprintShrinksLengthsAndHeights) {
  Process process = uncompensated();
  process.shrinkage = 0.02;
  process.height_shrinkage = 0.05;
  const MadeArray m = made(Texture{holes()}, process);
  EXPECT_NEAR(m.period, 0.98 * 6e-6, 1e-12);
  EXPECT_NEAR(m.depth, 0.95 * 400e-9, 1e-15);
  EXPECT_NEAR(m.width, 0.98 * m.wanted_width, 1e-9);
}

// Closed forms draw the mask, a simulation by the Fourier series of its polygons judges it.
TEST(Compensation, TheMadeSurfaceIsTheWantedOneWithinTwoNanometres) {
  HoleArray small = holes();
  small.diameter = 1.2e-6, small.period = 2.5e-6, small.lattice = Lattice::Hexagonal;
  PillarArray pillars;
  pillars.period = 4e-6, pillars.diameter = 2e-6, pillars.height = 300e-9;
  pillars.lattice = Lattice::Hexagonal;
  PillarArray wide = pillars;
  wide.diameter = 3.5e-6;
  Grating grooves;
  grooves.period = 3e-6, grooves.width = 1e-6, grooves.depth = 250e-9;
  Process process;
  process.corner_radius = 350e-9;
  process.resist_bias = -35e-9;
  process.undercut = 0.2;
  process.shrinkage = 0.006;
  process.height_shrinkage = 0.03;
  int seen = 0;
  for (const Texture& texture :
       {Texture{holes()}, Texture{small}, Texture{pillars}, Texture{wide}, Texture{grooves}}) {
    const MadeArray m = made(texture, process);
    EXPECT_NEAR(m.width, m.wanted_width, 2e-9) << texture_name(texture);
    EXPECT_NEAR(m.depth, m.wanted_depth, 0.01 * m.wanted_depth);
    EXPECT_NEAR(m.period, m.wanted_period, 1e-9);
    EXPECT_NEAR(m.wall_angle, m.wanted_wall_angle, 0.5 * kPi / 180);
    Process none = process;
    none.compensate = false;
    const MadeArray without = made(texture, none);
    EXPECT_GT(std::abs(without.width - without.wanted_width), 5e-9) << texture_name(texture);
    EXPECT_FALSE(without.as_wanted());
    ++seen;
  }
  EXPECT_EQ(seen, 5);
}

TEST(Compensation, WallsThatTheEtchLeavesAreSaidToStay) {
  Process process;
  process.wall_angle = 70 * kPi / 180;
  const MadeArray m = made(Texture{holes()}, process);
  ASSERT_EQ(m.left().size(), 1u);
  EXPECT_EQ(m.left()[0], "walls of 70 deg, wanted 85 deg: no mask changes them");
  EXPECT_NEAR(m.width, m.wanted_width, 2e-9);  // at half the depth
}

// Of round holes slanted walls take another volume than upright ones of the same width half-way
// down; the mask keeps the width.
TEST(Compensation, TheWidthAtHalfTheDepthIsKeptByWallsOfAnyAngle) {
  PillarArray pillars;
  pillars.period = 6e-6, pillars.diameter = 3e-6, pillars.height = 400e-9;
  Process process;
  process.wall_angle = 12 * kPi / 180;  // 1.9 um from the land to the floor
  for (const Texture& texture : {Texture{holes()}, Texture{pillars}}) {
    const MadeArray m = made(texture, process);
    EXPECT_NEAR(m.width, m.wanted_width, 2e-9) << texture_name(texture);
    EXPECT_NEAR(m.depth, 400e-9, 1e-15) << texture_name(texture);
  }
  EXPECT_NEAR(made(Texture{holes()}, process).wanted_width,
              3e-6 - 400e-9 / std::tan(85 * kPi / 180), 1e-15);
}

// Walls of 45 deg meet at half the width of what is deep at the land: of grooves 0.5 um wide
// half-way down 800 nm at 650 nm, between pillars of 1.2 um at their top at the distance of their
// edges from the middle of three.
TEST(Process, WhereWallsMeetTheDepthIsThatOfTheirMeeting) {
  Grating grooves;
  grooves.period = 3e-6, grooves.width = 0.5e-6, grooves.depth = 800e-9;
  grooves.wall_angle = kPi / 2;
  PillarArray pillars;
  pillars.lattice = Lattice::Hexagonal;
  pillars.period = 2e-6, pillars.diameter = 1.8e-6, pillars.height = 600e-9;
  pillars.wall_angle = kPi / 2;
  Process process;
  process.wall_angle = kPi / 4;
  const MadeArray m = made(Texture{grooves}, process);
  EXPECT_NEAR(m.depth, 650e-9, 1e-9);
  EXPECT_NEAR(m.width, 0.5e-6, 2e-9);
  ASSERT_EQ(m.left().size(), 2u);
  EXPECT_NE(m.left()[0].find("wanted 800 nm (-19 %): its walls meet above it; steeper walls"),
            std::string::npos)
      << m.left()[0];
  EXPECT_NEAR(made(Texture{pillars}, process).depth, 2e-6 / std::sqrt(3.0) - 0.6e-6, 3e-9);
}

TEST(Compensation, RimsThatTheProcessLeavesAreSaidToStay) {
  Process process;
  process.edge_radius = 100e-9;
  const MadeArray m = made(Texture{holes()}, process);
  EXPECT_EQ(m.left(),
            std::vector<std::string>{"rims of 100 nm, wanted 0 nm: no mask changes them"});
  EXPECT_NEAR(m.width, m.wanted_width, 2e-9);  // half-way down it is the same
}

// Upright walls round the land over the radius on either side, as the radius of a design does.
TEST(Process, RefusesRimsThatLeaveNothingOfTheLand) {
  HoleArray upright = holes();
  upright.period = 5e-6, upright.wall_angle = kPi / 2;
  const auto refused = [&](const Process& process) {
    return refusal_of([&] { masked(Texture{upright}, process); });
  };
  Process process;
  process.edge_radius = 0.999e-6;
  EXPECT_EQ(refused(process), "");
  process.edge_radius = 1.001e-6;
  EXPECT_EQ(refused(process),
            "process.edge_radius: rims of 1001 nm leave nothing of the land of 2 um between two "
            "edges; less than 1000 nm");
  PillarArray pillars;
  pillars.period = 9e-6, pillars.diameter = 2e-6, pillars.wall_angle = kPi / 2;
  EXPECT_THROW(masked(Texture{pillars}, process), InputError);
  process.edge_radius = 0.999e-6;
  masked(Texture{pillars}, process);
  // The design's own, of which an undercut that no mask undoes takes 100 nm of the land a side.
  upright.edge_radius = 0.95e-6;
  process = {};
  process.undercut = 0.25;
  EXPECT_EQ(refused(process), "");
  process.compensate = false;
  EXPECT_EQ(refused(process),
            "edge_radius: rims of 950 nm leave nothing of the land of 1.8 um between two edges; "
            "less than 900 nm");
}

// 6025.3 and 2008.4 nm of a master: rounded alone, 6025 and 2008, they slip by a nanometre a
// period.
TEST(Process, PeriodsOfAStackAreDrawnAsWholeFractionsOfTheLongest) {
  Process process;
  process.shrinkage = 0.0042;
  const auto drawn = [&](const std::vector<double>& periods) {
    std::vector<Texture> arrays;
    for (const double period : periods) {
      HoleArray array = holes();
      array.period = period, array.diameter = 0.3 * period, array.depth = 0.1 * period;
      arrays.emplace_back(Texture{array});
    }
    std::vector<double> out;
    for (const MaskedArray& array : masked(arrays, process))
      out.push_back(std::round(1e13 * array.mask.period) / 1e4);  // [nm]
    return out;
  };
  EXPECT_EQ(drawn({6e-6}), (std::vector<double>{6025}));
  EXPECT_EQ(drawn({6e-6, 2e-6}), (std::vector<double>{6024, 2008}));
  EXPECT_EQ(drawn({2e-6, 6e-6, 3e-6}), (std::vector<double>{2008, 6024, 3012}));
  EXPECT_NE(refusal_of([&] {
              drawn({6e-6, 6e-6 / 7, 6e-6 / 11, 6e-6 / 13});
            }).find("no common grid of whole nanometres within 1 % of 6 um"),
            std::string::npos);
}

TEST(Compensation, RefusesFeaturesThatNoMaskMakes) {
  HoleArray tiny = holes();
  tiny.diameter = 0.3e-6;
  Process process;
  process.resist_bias = 200e-9;
  EXPECT_THROW(masked(Texture{tiny}, process), InputError);
  process = {};
  process.corner_radius = 5e-6;
  EXPECT_THROW(masked(Texture{tiny}, process), InputError);
}

}  // namespace
}  // namespace papilla::tests::process_test
