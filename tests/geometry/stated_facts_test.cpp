// What each kind says of itself, number by number, from its own formulas.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "geometry/texture.h"

namespace papilla::tests::stated_facts_test {
namespace {

struct Said {
  double low, high;           // planes
  double cell_x, cell_y;      // 0: none
  double hole, wall, aspect;  // margins
  double open;                // share
  double rim;                 // radius
};

void expect_facts(const Texture& texture, const Said& said) {
  const TextureFacts known = facts(texture);
  const std::string name = texture_name(texture);
  ASSERT_TRUE(known.relief.planes && known.cell && known.open_share && known.rim_radius) << name;
  EXPECT_TRUE(known.relief.present) << name;
  const auto near = [&](double is, double wanted, const char* what) {
    EXPECT_NEAR(is, wanted, 1e-9 * std::abs(wanted) + 1e-18) << name << " " << what;
  };
  near(known.relief.planes->low, said.low, "low");
  near(known.relief.planes->high, said.high, "high");
  near(*known.relief.height(), said.high - said.low, "height");
  near(known.cell->x, said.cell_x, "cell x");
  near(known.cell->y, said.cell_y, "cell y");
  near(known.period(), said.cell_x, "period");
  near(known.margins.min_hole, said.hole, "hole");
  near(known.margins.min_wall, said.wall, "wall");
  near(known.margins.smallest(), std::min(said.hole, said.wall), "smallest");
  near(known.margins.aspect_ratio, said.aspect, "aspect");
  near(*known.open_share, said.open, "open");
  near(*known.rim_radius, said.rim, "rim");
  EXPECT_FALSE(known.free_patch.exact) << name;
  EXPECT_EQ(known.free_patch.least, 0) << name;
  EXPECT_TRUE(known.scans.empty()) << name;
}

// Walls of 45 deg are as wide as they are high: 0.5 um less on either side of a floor.
TEST(StatedFacts, OfArraysAreThoseOfTheirLatticeAndWalls) {
  const double right = kPi / 4, disc = kPi / 4;  // an angle; the area of a disc of diameter 1
  const double root = std::sqrt(3.0);
  expect_facts({HoleArray{.period = 5e-6,
                          .diameter = 3e-6,
                          .depth = 0.5e-6,
                          .wall_angle = right,
                          .edge_radius = 20e-9}},
               {-0.5e-6, 0, 5e-6, 5e-6, 2e-6, 2e-6, 0.25, disc * 9 / 25, 20e-9});
  expect_facts({HoleArray{.lattice = Lattice::Hexagonal,
                          .period = 5e-6,
                          .diameter = 2e-6,
                          .depth = 0.5e-6,
                          .wall_angle = right}},
               {-0.5e-6, 0, 5e-6, 5e-6 * root, 1e-6, 3e-6, 0.5, disc * 4 / (12.5 * root), 0});
  // The floor between pillars is a micrometre less than their gap at the top.
  expect_facts({PillarArray{.period = 5e-6,
                            .diameter = 3e-6,
                            .height = 0.5e-6,
                            .wall_angle = right,
                            .edge_radius = 10e-9}},
               {0, 0.5e-6, 5e-6, 5e-6, 1e-6, 3e-6, 0.5, 1 - disc * 9 / 25, 10e-9});
  expect_facts({Grating{.period = 4e-6, .width = 1.5e-6, .depth = 0.25e-6, .wall_angle = right}},
               {-0.25e-6, 0, 4e-6, 4e-6, 1e-6, 2.5e-6, 0.25, 1.5 / 4, 0});
}

// Half way down a groove is half as wide. A wave is as wide as it is far to the next; of both
// directions the squares that it leaves have half the area. A crest of A/2 (1 - cos kx) bends by
// A k^2 / 2, of both directions by half of that each.
TEST(StatedFacts, OfGradualKindsAreThoseAtHalfTheirDepth) {
  expect_facts({VGrooves{.period = 5e-6, .width = 4e-6, .depth = 1e-6}},
               {-1e-6, 0, 5e-6, 5e-6, 2e-6, 3e-6, 0.5, 0.4, 0});
  const double k = 2 * kPi / 4e-6;
  expect_facts({Waves{.period = 4e-6, .depth = 0.5e-6}},
               {-0.5e-6, 0, 4e-6, 4e-6, 2e-6, 2e-6, 0.25, 0.5, 2 / (0.5e-6 * k * k)});
  const double side = 4e-6 / std::sqrt(2.0);
  expect_facts({Waves{.directions = Waves::Directions::Both, .period = 4e-6, .depth = 0.5e-6}},
               {-0.5e-6, 0, 4e-6, 4e-6, side, side, 0.5e-6 / side, 0.5, 4 / (0.5e-6 * k * k)});
}

// A cap 1 um high and 4 um wide is of a sphere of 2.5 um: half way up it is 2 sqrt(2.5^2 - 2^2) = 3
// um wide.
TEST(StatedFacts, OfCapsAreThoseOfTheirSphere) {
  const double disc = kPi / 4 * 9 / 36, root = std::sqrt(3.0);
  expect_facts({CapArray{.period = 6e-6, .diameter = 4e-6, .depth = 1e-6}},
               {-1e-6, 0, 6e-6, 6e-6, 3e-6, 3e-6, 1.0 / 3, disc, 0});
  expect_facts({CapArray{.form = CapArray::Form::Domes,
                         .lattice = Lattice::Hexagonal,
                         .period = 6e-6,
                         .diameter = 4e-6,
                         .depth = 1e-6}},
               {0, 1e-6, 6e-6, 6e-6 * root, 3e-6, 3e-6, 1.0 / 3, 1 - disc * 2 / root, 2.5e-6});
  // The height of a cap at a distance: sqrt(2.5^2 - r^2) - 1.5 um, by pixels of a hundredth.
  const CapArray caps{.period = 6e-6, .diameter = 4e-6, .depth = 1e-6};
  const Heightmap h = generate({caps}, {600, 600, 6e-6, 6e-6});
  for (const int away : {0, 50, 120, 180}) {
    const double r = (away + 0.5) * 1e-8, off = 0.5e-8;
    const double wanted = std::sqrt(6.25e-12 - r * r - off * off) - 1.5e-6;
    EXPECT_NEAR(h(300 + away, 300), -wanted, 1e-10) << away;
  }
  EXPECT_EQ(h(300 + 205, 300), 0);
}

TEST(StatedFacts, OfWhatIsFlatAreNone) {
  for (const Texture& texture :
       {Texture{}, Texture{HoleArray{.depth = 0}}, Texture{VGrooves{.depth = 0}},
        Texture{CapArray{.depth = 0}}, Texture{Waves{.depth = 0}}}) {
    const TextureFacts known = facts(texture);
    EXPECT_FALSE(known.relief.present);
    EXPECT_EQ(known.relief.height(), 0) << texture_name(texture);
    EXPECT_FALSE(known.cell || known.rim_radius) << texture_name(texture);
    EXPECT_EQ(known.period(), 0);
    EXPECT_EQ(known.open_share, 0) << texture_name(texture);
    EXPECT_EQ(known.margins.min_hole, kInfinity);
    EXPECT_EQ(known.margins.min_wall, kInfinity);
    EXPECT_EQ(known.margins.aspect_ratio, 0) << texture_name(texture);
  }
}

TEST(StatedFacts, OfParticlesAreTheTopOfAMeanOne) {
  const TextureFacts film = facts(Texture{ParticleFilm{.radius = 2e-6, .embedding = 0.3}});
  EXPECT_NEAR(film.relief.planes->high, 2.8e-6, 1e-18);
  EXPECT_EQ(film.relief.planes->low, 0);
  EXPECT_NEAR(film.free_patch.side(1e-6), 16e-6, 1e-18);
  EXPECT_EQ(film.free_patch.side(20e-6), 20e-6);
  EXPECT_EQ(facts(Texture{ParticleFilm{.coverage = 0}}).relief.height(), 0);
}

Texture stack(Combine combine, std::vector<Texture> parts) {
  Stack out;
  out.combine = combine;
  out.parts = std::move(parts);
  return {out};
}

// Of walls, of sections with a formula, and where a large rim is cut by the floor before it is as
// steep as its wall.
TEST(StatedFacts, TheSteepestSlopeIsThatOfWallsOrOfTheFormula) {
  const auto steepest = [](const Texture& t) { return facts(t).steepest; };
  const auto near = [&](const Texture& t, double angle) {
    ASSERT_TRUE(steepest(t)) << texture_name(t);
    EXPECT_NEAR(*steepest(t), angle, 1e-7) << texture_name(t);
  };
  near({HoleArray{.wall_angle = kPi / 3}}, kPi / 3);
  near({PillarArray{.height = 100e-9, .wall_angle = kPi / 2, .edge_radius = 200e-9}}, kPi / 3);
  near({Grating{.depth = 0}}, 0);
  near({VGrooves{.width = 4e-6, .depth = 2e-6}}, kPi / 4);
  near({Waves{.period = 4e-6, .depth = 4e-6 / kPi}}, kPi / 4);
  near({Waves{.directions = Waves::Directions::Both, .period = 4e-6, .depth = 4e-6 / kPi}},
       std::atan(std::sqrt(0.5)));
  // Half a sphere, and a cap of 1 um on 4 um: of a sphere of 2.5 um.
  near({CapArray{.period = 6e-6, .diameter = 4e-6, .depth = 2e-6}}, kPi / 2);
  near({CapArray{.period = 6e-6, .diameter = 4e-6, .depth = 1e-6}}, std::asin(0.8));
  near({ParticleFilm{.embedding = 0.3}}, kPi / 2);
  near({ParticleFilm{.embedding = 0.75}}, kPi / 3);
  near({Flat{}}, 0);
  near({RandomRough{.rms = 0}}, 0);
  for (const Texture& t : {Texture{RandomRough{}}, Texture{EtchedGlass{}}, Texture{Measured3d{}}})
    EXPECT_FALSE(steepest(t)) << texture_name(t);
  // A rough part states none; slopes of a sum may lie on each other.
  const Texture slope{VGrooves{.width = 4e-6, .depth = 2e-6}};
  near(stack(Combine::Sum, {slope, Texture{RandomRough{}}}), kPi / 4);
  near(stack(Combine::Sum, {slope, slope}), std::atan(2));
  near(stack(Combine::Maximum, {slope, slope}), kPi / 4);
}

// The longest cell, the largest patch, the worst margins and the sharpest rim of its parts; planes
// that add up or the higher ones.
TEST(StatedFacts, OfAStackAreThoseOfItsParts) {
  const Texture holes{HoleArray{.period = 6e-6,
                                .diameter = 2e-6,
                                .depth = 0.5e-6,
                                .wall_angle = kPi / 4,
                                .edge_radius = 30e-9}},
      pillars{PillarArray{.period = 3e-6,
                          .diameter = 1.25e-6,
                          .height = 0.25e-6,
                          .wall_angle = kPi / 4,
                          .edge_radius = 20e-9}};
  for (const auto& [combine, low, high] :
       {std::tuple{Combine::Sum, -0.5e-6, 0.25e-6}, {Combine::Maximum, 0.0, 0.25e-6}}) {
    for (const bool turned : {false, true}) {
      const TextureFacts both =
          facts(turned ? stack(combine, {pillars, holes}) : stack(combine, {holes, pillars}));
      EXPECT_NEAR(both.relief.planes->low, low, 1e-18);
      EXPECT_NEAR(both.relief.planes->high, high, 1e-18);
      EXPECT_NEAR(both.cell->x, 6e-6, 1e-18);
      EXPECT_NEAR(both.margins.min_hole, 1e-6, 1e-15);     // of the holes; between pillars 1.25
      EXPECT_NEAR(both.margins.min_wall, 1.25e-6, 1e-15);  // a pillar
      EXPECT_NEAR(both.margins.aspect_ratio, 0.5, 1e-9);   // of the holes; 0.2
      EXPECT_NEAR(*both.rim_radius, 20e-9, 1e-18);
      EXPECT_FALSE(both.open_share);
    }
  }
  Measured3d wide, narrow;
  wide.file = "a.gsf", wide.patch = 30e-6, narrow.file = "b.gsf", narrow.patch = 25e-6;
  const TextureFacts maps = facts(
      stack(Combine::Sum, {Texture{ParticleFilm{.radius = 2e-6}}, Texture{wide}, Texture{narrow}}));
  EXPECT_FALSE(maps.relief.planes);
  EXPECT_TRUE(maps.relief.present);
  EXPECT_EQ(maps.free_patch.exact, 25e-6);
  EXPECT_NEAR(maps.free_patch.least, 16e-6, 1e-18);
  ASSERT_EQ(maps.scans.size(), 2u);
  EXPECT_EQ(maps.scans[0].file, "a.gsf");
  EXPECT_EQ(maps.scans[1].file, "b.gsf");
}

std::string said_of(const Texture& texture) {
  std::string out;
  for (const auto& [key, message] : problems(texture)) out += key + ": " + message + "\n";
  return out;
}

// Each with its border on either side.
TEST(Contradictions, OfNumbersAreSaidInTheirUnits) {
  EXPECT_EQ(said_of({HoleArray{.period = 3e-6, .diameter = 3e-6}}),
            "diameter: 3 um is not smaller than the period 3 um; features would overlap\n");
  EXPECT_EQ(said_of({PillarArray{.period = 2e-6, .diameter = 2.5e-6}}),
            "diameter: 2.5 um is not smaller than the period 2 um; features would overlap\n");
  EXPECT_EQ(said_of({Grating{.period = 2e-6, .width = 2.25e-6}}),
            "width: 2.25 um is not smaller than the period 2 um; features would overlap\n");
  EXPECT_EQ(said_of({PillarArray{.period = 2e-6, .diameter = 1.999e-6, .wall_angle = kPi / 2}}),
            "");
  // V-grooves may meet in a ridge.
  EXPECT_EQ(said_of({VGrooves{.period = 2e-6, .width = 2e-6}}), "");
  EXPECT_EQ(said_of({VGrooves{.period = 2e-6, .width = 2.1e-6}}),
            "width: 2.1 um is not smaller than the period 2 um; features would overlap\n");
  // Walls of 30 deg run 1.732 times their depth: 866 nm to the middle of 1.732 um.
  const auto groove = [](double width) {
    return said_of(
        {Grating{.period = 4e-6, .width = width, .depth = 500e-9, .wall_angle = kPi / 6}});
  };
  EXPECT_EQ(groove(1.733e-6), "");
  EXPECT_EQ(groove(1.731e-6),
            "wall_angle: walls of 30 deg meet before the depth of 500 nm is reached; make them "
            "30.02 deg or steeper, or the depth 499.6 nm or less\n");
  EXPECT_EQ(said_of({HoleArray{
                .period = 4e-6, .diameter = 1.731e-6, .depth = 500e-9, .wall_angle = kPi / 6}}),
            groove(1.731e-6));
  EXPECT_EQ(said_of({CapArray{.period = 5e-6, .diameter = 2e-6, .depth = 1.001e-6}}),
            "depth: 1001 nm is more than half the diameter: a cap is a half sphere at most\n");
  EXPECT_EQ(said_of({CapArray{.period = 5e-6, .diameter = 2e-6, .depth = 0.999e-6}}), "");
  EXPECT_EQ(said_of({ParticleFilm{.coverage = 0.52}}), "");
  EXPECT_EQ(said_of({ParticleFilm{.coverage = 0.525}}),
            "coverage: random non-overlapping particles jam near 55 %; use at most 52 %\n");
  EXPECT_EQ(said_of({RandomRough{.roll_off = 1e-6, .cutoff = 1e-6}}),
            "cutoff: must be shorter than the roll-off wavelength\n");
  EXPECT_EQ(said_of({RandomRough{.roll_off = 1e-6, .cutoff = 0.999e-6}}), "");
  EXPECT_EQ(said_of({RandomRough{.roll_off = 1e-3, .cutoff = 12e-6}}), "");
  EXPECT_EQ(said_of({RandomRough{.roll_off = 1e-3, .cutoff = 12.1e-6}}),
            "cutoff: 12.1 um is longer than the 12 um that rms is of; no wave would be left\n");
}

// Walls of 45 deg run as far as they are high: 100 nm to the middle of a gap of 200 nm. Their feet
// may touch; merged, they would leave less than the height and no gap at all.
TEST(Contradictions, OfPillarsWhoseFeetMergeSayTheGreatestHeight) {
  const auto pillars = [](double height) {
    return Texture{
        PillarArray{.period = 3.2e-6, .diameter = 3e-6, .height = height, .wall_angle = kPi / 4}};
  };
  EXPECT_EQ(said_of(pillars(100e-9)), "");
  EXPECT_EQ(said_of(pillars(1e-6)),
            "wall_angle: walls of 45 deg meet before the height of 1000 nm is reached; make them "
            "84.29 deg or steeper, or the height 100 nm or less\n");
  const FabricationMargins merged = facts(pillars(1e-6)).margins;
  EXPECT_EQ(merged.min_hole, 0);
  EXPECT_EQ(merged.aspect_ratio, kInfinity);  // above every limit, not below 0
}

// Rims begin radius tan(angle / 2) beyond their edge: 1 um at 90 deg, on lands of 2 um. Of pillars
// the land is their top.
TEST(Contradictions, OfRimsThatLeaveNoLandSayTheLargestRadius) {
  const auto refused = [](const std::string& radius) {
    return "edge_radius: rims of " + radius +
           " nm leave nothing of the land of 2 um between two edges; less than 1000 nm\n";
  };
  for (const auto& [radius, why] :
       {std::pair{0.999e-6, std::string()}, {1.001e-6, refused("1001")}, {3e-6, refused("3000")}}) {
    EXPECT_EQ(said_of({HoleArray{
                  .period = 5e-6, .diameter = 3e-6, .wall_angle = kPi / 2, .edge_radius = radius}}),
              why);
    EXPECT_EQ(said_of({PillarArray{
                  .period = 9e-6, .diameter = 2e-6, .wall_angle = kPi / 2, .edge_radius = radius}}),
              why);
    EXPECT_EQ(said_of({Grating{
                  .period = 3e-6, .width = 1e-6, .wall_angle = kPi / 2, .edge_radius = radius}}),
              why);
  }
  // A slope of 45 deg is rounded over 0.414 of the radius. Of a flat surface nothing is.
  EXPECT_EQ(said_of({HoleArray{
                .period = 5e-6, .diameter = 3e-6, .wall_angle = kPi / 4, .edge_radius = 2.4e-6}}),
            "");
  EXPECT_NE(said_of({HoleArray{
                .period = 5e-6, .diameter = 3e-6, .wall_angle = kPi / 4, .edge_radius = 2.42e-6}}),
            "");
  EXPECT_EQ(said_of({HoleArray{.period = 5e-6, .diameter = 3e-6, .depth = 0, .edge_radius = 9e-6}}),
            "");
}

// The longest period is a whole number of each other one, to a millionth.
TEST(Contradictions, OfAStackNameThePart) {
  const auto periods = [](double a, double b) {
    return said_of(stack(Combine::Sum, {Texture{HoleArray{.period = a, .diameter = 0.3e-6}},
                                        Texture{Grating{.period = b, .width = 0.3e-6}}}));
  };
  EXPECT_EQ(said_of(stack(Combine::Sum, {})), "parts: a stack needs at least one part\n");
  EXPECT_EQ(periods(6e-6, 2e-6), "");
  EXPECT_EQ(periods(2e-6, 6e-6), "");
  EXPECT_EQ(periods(6e-6, 2e-6 * (1 + 0.2e-6)), "");
  EXPECT_EQ(
      periods(6e-6, 2e-6 * (1 + 0.5e-6)),
      "parts.1.period: 2.000001 um does not divide the largest period of the stack, 6 um; the "
      "nearest that do are 2 um and 3 um\n");
  EXPECT_EQ(
      periods(2e-6 * (1 - 0.5e-6), 6e-6),
      "parts.0.period: 1.999999 um does not divide the largest period of the stack, 6 um; the "
      "nearest that do are 1.5 um and 2 um\n");
  EXPECT_EQ(said_of(stack(Combine::Sum, {Texture{}, Texture{ParticleFilm{.coverage = 0.6}}})),
            "parts.1.coverage: random non-overlapping particles jam near 55 %; use at most 52 %\n");
}

// Rows of hexagons repeat after the root of three periods: of no square lattice of any period.
// Lines are alike along y and ask for nothing there.
TEST(Contradictions, OfAStackNameTheLatticesThatMissEachOtherAlongY) {
  const auto holes = [](Lattice lattice, double period) {
    return Texture{HoleArray{.lattice = lattice, .period = period, .diameter = 0.3e-6}};
  };
  const Texture hexagons = holes(Lattice::Hexagonal, 6e-6), lines{Grating{.period = 6e-6}};
  EXPECT_EQ(
      said_of(stack(Combine::Sum, {holes(Lattice::Square, 6e-6), hexagons})),
      "parts.0.lattice: its rows repeat after 6 um along y, which does not divide the 10.3923 "
      "um of the stack; make all lattices of it square, or all hexagonal\n");
  EXPECT_NE(said_of(stack(Combine::Sum, {holes(Lattice::Square, 12e-6), hexagons})), "");
  // A stack within has parts, and neither a lattice nor a period.
  const std::string along_y = said_of(
      stack(Combine::Sum, {stack(Combine::Sum, {holes(Lattice::Square, 6e-6), lines}), hexagons}));
  EXPECT_TRUE(along_y.starts_with("parts.0.parts: its rows repeat after 6 um along y")) << along_y;
  const std::string along_x = said_of(stack(
      Combine::Sum, {stack(Combine::Sum, {holes(Lattice::Hexagonal, 4e-6), Texture{}}), hexagons}));
  EXPECT_TRUE(along_x.starts_with("parts.0.parts: 4 um does not divide")) << along_x;
  EXPECT_EQ(said_of(stack(Combine::Sum, {holes(Lattice::Hexagonal, 3e-6), hexagons})), "");
  const auto cell_of = [](std::vector<Texture> parts) {
    const Texture texture = stack(Combine::Sum, std::move(parts));
    EXPECT_EQ(said_of(texture), "");
    return *facts(texture).cell;
  };
  const UnitCell whole = *facts(hexagons).cell;
  EXPECT_EQ(cell_of({lines, hexagons}), whole);
  EXPECT_EQ(cell_of({hexagons, lines}), whole);
  EXPECT_EQ(cell_of({stack(Combine::Sum, {lines, Texture{}}), hexagons}), whole);
  // Roughness has no cell, and leaves lines as alike along y as they are.
  EXPECT_EQ(cell_of({stack(Combine::Sum, {lines, Texture{RandomRough{}}}), hexagons}), whole);
  EXPECT_EQ(cell_of({lines, holes(Lattice::Square, 3e-6)}), (UnitCell{6e-6, 3e-6}));
  EXPECT_EQ(cell_of({lines, Texture{Grating{.period = 3e-6, .width = 1e-6}}}),
            (UnitCell{6e-6, 6e-6}));
}

// The members that a kind names are its own, each in its place.
TEST(StatedRoles, AreTheMembersOfTheKind) {
  Texture texture{PillarArray{}};
  auto& pillars = std::get<PillarArray>(texture.kind);
  const Roles r = roles(texture);
  EXPECT_EQ(r.lattice, &pillars.lattice);
  EXPECT_EQ(r.period, &pillars.period);
  EXPECT_EQ(r.width, &pillars.diameter);
  EXPECT_EQ(r.depth, &pillars.height);
  EXPECT_EQ(r.wall_angle, &pillars.wall_angle);
  EXPECT_EQ(r.edge_radius, &pillars.edge_radius);
  EXPECT_EQ(r.relief, &pillars.height);
  texture = {Grating{}};
  auto& grooves = std::get<Grating>(texture.kind);
  const Roles g = roles(texture);
  EXPECT_EQ(g.lattice, nullptr);
  EXPECT_EQ(g.width, &grooves.width);
  EXPECT_EQ(g.depth, &grooves.depth);
  EXPECT_EQ(g.wall_angle, &grooves.wall_angle);
  EXPECT_EQ(g.edge_radius, &grooves.edge_radius);
  texture = {CapArray{}};
  auto& caps = std::get<CapArray>(texture.kind);
  const Roles c = roles(texture);
  EXPECT_EQ(c.lattice, &caps.lattice);
  EXPECT_EQ(c.period, &caps.period);
  EXPECT_EQ(c.width, &caps.diameter);
  EXPECT_EQ(c.depth, &caps.depth);
  EXPECT_EQ(c.wall_angle, nullptr);
  EXPECT_EQ(c.edge_radius, nullptr);
}

}  // namespace
}  // namespace papilla::tests::stated_facts_test
