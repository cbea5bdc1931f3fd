// First answers of friction and modulation, each part of their errors; and the level that they are
// computed at.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "config/describe.h"
#include "estimate/voltage.h"
#include "forward/forward.h"
#include "studio/first_answer.h"

namespace papilla::tests::first_answers_test {
namespace {

const std::string kHoles = PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml";

using Member = Measured PointQuantities::*;
constexpr std::array<Member, 3> kNumbers{
    &PointQuantities::friction_off, &PointQuantities::friction_on, &PointQuantities::modulation};

Response response_of(const std::array<double, 3>& values) {
  Response out;
  out.driven = true;
  ResponsePoint point;
  for (std::size_t k = 0; k < 3; ++k) {
    Measured& m = point.*kNumbers[k];
    m.value = values[k];
    m.parts = {.sampling = 0.01,
               .grid = 0.02,
               .solver = 0.03,
               .humidity = 0.04,
               .method = 0.05,
               .field = std::nullopt,
               .parameters = 0.06,
               .water = 0.07};
  }
  out.points = {point};
  return out;
}

// Eq. studio.3: what a refined answer usually is of the quick one, and how far that is off.
TEST(FirstAnswers, WithoutAnAnchorAreUsualShares) {
  const Design coarse = read_design(kHoles);
  Design fine = coarse;
  set_number(fine, "texture.diameter", 0.5e-6);
  constexpr std::array<double, 3> kCoarse{0.69, 0.64, 0.83}, kFine{0.77, 0.7, 0.85},
      kSpread{0.06, 0.07, 0.145};
  for (const bool narrow : {false, true}) {
    for (const bool known : {false, true}) {
      Response quick = response_of({0.2, 0.5, -1.5});
      quick.plan.steps = {{Piece::Contact, "m", "r", 1, 0.9}, {Piece::Field, "m", "r", 1, 0.3}};
      if (known) quick.points[0].field_error = 0.1;
      const Response out = first_answer(quick, narrow ? fine : coarse, nullptr);
      for (std::size_t k = 0; k < 3; ++k) {
        const Measured &m = out.points[0].*kNumbers[k], &before = quick.points[0].*kNumbers[k];
        const double usual = narrow ? kFine[k] : kCoarse[k], value = usual * before.value;
        EXPECT_NEAR(m.value, value, 1e-12) << k;
        EXPECT_NEAR(m.parts.sampling, usual * 0.01, 1e-12);
        EXPECT_EQ(m.parts.grid, 0.02);
        EXPECT_EQ(m.parts.parameters, 0.06);
        EXPECT_NEAR(*m.parts.method, std::hypot(0.05, kSpread[k] * std::abs(value)), 1e-12) << k;
        ASSERT_EQ(m.parts.field.has_value(), !known);
        EXPECT_NEAR(m.parts.field.value_or(0), known ? 0 : 0.3 * std::abs(value), 1e-12);
      }
    }
  }
}

// What a ratio may have changed by where the quick number moved so. Eq. studio.2
double drift(double logarithm, double of_skins = 0) {
  return std::hypot(0.01, 0.2 * logarithm, 1.6 * of_skins);
}

// Eq. studio.1 and studio.2: each number by its own ratio, its errors by its own share.
TEST(FirstAnswers, ByAnAnchorAreItsRatios) {
  const Design at = read_design(kHoles);
  Anchor anchor{at, {}, response_of({0.4, 0.8, 0.5}), response_of({0.2, 0.72, -0.4})};
  Design away = at;
  set_number(away, "texture.depth", 1200e-9);
  const Response out = first_answer(response_of({0.1, 0.2, -0.3}), away, &anchor);
  const std::array<double, 3> ratio{0.5, 0.9, -0.8}, quick{0.1, 0.2, -0.3};
  // What changes its sign has moved as far as by e.
  const std::array<double, 3> moved{std::log(4.0), std::log(4.0), 1};
  for (std::size_t k = 0; k < 3; ++k) {
    const Measured& m = out.points[0].*kNumbers[k];
    const double value = ratio[k] * quick[k],
                 share = std::abs(value / (anchor.refined.points[0].*kNumbers[k]).value);
    EXPECT_NEAR(m.value, value, 1e-12) << k;
    EXPECT_NEAR(m.parts.sampling, 0.01 * share, 1e-12);
    EXPECT_NEAR(*m.parts.grid, 0.02 * share, 1e-12);
    EXPECT_NEAR(*m.parts.solver, 0.03 * share, 1e-12);
    EXPECT_NEAR(*m.parts.humidity, 0.04 * share, 1e-12);
    EXPECT_NEAR(*m.parts.parameters, 0.06 * share, 1e-12);
    EXPECT_NEAR(*m.parts.water, 0.07 * share, 1e-12);
    EXPECT_FALSE(m.parts.field);
    EXPECT_NEAR(*m.parts.method, std::hypot(0.05 * share, drift(moved[k]) * std::abs(value)), 1e-12)
        << k;
  }
  // Nothing moved: the floor.
  const Response same = first_answer(anchor.quick, at, &anchor);
  EXPECT_NEAR(*same.points[0].friction_off.parts.method, std::hypot(0.05, 0.01 * 0.2), 1e-12);
  // What one of the two levels does not have, no ratio carries.
  for (const bool coarse : {true, false}) {
    Anchor none = anchor;
    ((coarse ? none.quick : none.refined).points[0].friction_on).value = 0;
    const Response other = first_answer(response_of({0.1, 0.2, 0.3}), away, &none);
    EXPECT_NEAR(other.points[0].friction_off.value, 0.05, 1e-12);
    EXPECT_NEAR(other.points[0].friction_on.value, 0.64 * 0.2, 1e-12);
  }
}

// Of the number with all skins, and without each.
Response on_skins(double all, const std::vector<double>& without_each) {
  Response out = response_of({all, all, all});
  for (const double value : without_each) {
    out.without.emplace_back(1);
    for (const Member number : kNumbers) (out.without.back()[0].*number).value = value;
  }
  return out;
}

// Eq. studio.2: skins that agree by how much a number moved leave nothing open, however far they
// lie from each other.
TEST(FirstAnswers, KnowWhatSkinsLeaveOpenOfAMove) {
  const Response from = on_skins(1, {0.9, 1.1}), twice = on_skins(2, {1.8, 2.2}),
                 apart = on_skins(2, {2.2, 1.8});
  const QuickMove alike = quick_move(0, kModulation, from, twice),
                  unlike = quick_move(0, kModulation, from, apart);
  EXPECT_NEAR(alike.logarithm, std::log(2.0), 1e-12);
  EXPECT_NEAR(alike.error, 0, 1e-12);
  // Two skins at 1.1 and 0.9 times the number have a standard error of 0.1; twice that apart.
  EXPECT_NEAR(unlike.error, 0.2, 1e-12);
  const Design at = read_design(kHoles);
  const Anchor anchor{at, {}, from, response_of({1, 1, 1})};
  const Measured m = first_answer(apart, at, &anchor).points[0].modulation;
  EXPECT_NEAR(*m.parts.method, std::hypot(0.05 * 2, 2 * drift(std::log(2.0), 0.2)), 1e-12);
}

// Eq. studio.4: of the modulation, or of friction where nothing is driven; the largest over
// humidity.
TEST(FirstAnswers, ADifferenceDriftsWithItsFarthestMove) {
  Response from = response_of({0.4, 0.8, 0.5}), to = response_of({0.2, 0.72, 0.44});
  from.points.push_back(from.points[0]), to.points.push_back(to.points[0]);
  to.points[1].modulation.value = 0.6;
  EXPECT_NEAR(difference_drift(from, to), drift(std::log(1.2)), 1e-12);
  to.driven = false;
  EXPECT_NEAR(difference_drift(from, to), drift(std::log(2.0)), 1e-12);
}

// What the drive and the water do to the gap as they close it is measured once, at the anchor.
TEST(FirstAnswers, TakeTheLoadLawsOfTheirAnchor) {
  Design at = read_design(kHoles);
  at.environment.relative_humidity = {0.35, 0.75};
  const Anchor anchor = anchor_of(at, response_of({1, 1, 1}));
  Design away = at;
  set_number(away, "texture.depth", 500e-9);
  const Fidelity fidelity = quick_fidelity(away);
  ASSERT_EQ(anchor.laws.size(), 2u);
  ASSERT_FALSE(anchor.laws[0].empty());
  EXPECT_NE(anchor.laws[0][0].pull, 0);
  const Response own = quick_answer(away, nullptr), quick = quick_answer(away, &anchor);
  const Scene scene = scene_of(away);
  const auto points = [&](Response response) {
    set_bridged_margins(response, scene, away.texture);
    return response.points;
  };
  EXPECT_EQ(own.points, points(evaluate(scene, away.texture, fidelity)));
  EXPECT_EQ(quick.points,
            points(respond(scene, fidelity,
                           solve_patches(scene, away.texture, fidelity, {}, anchor.laws))));
  EXPECT_LT(quick.contact_solves, 0.75 * own.contact_solves);
  // The anchor itself is answered so; its own laws let forces grow to its load and no farther.
  EXPECT_EQ(anchor.quick.points, quick_answer(at, &anchor).points);
  EXPECT_LT(anchor.quick.contact_solves, quick.contact_solves);  // on the patches of its laws
  const Response alone = quick_answer(at, nullptr);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(anchor.quick.points[i].modulation.value / alone.points[i].modulation.value, 1,
                0.02);
  const double moved = own.points[0].modulation.value;
  EXPECT_NEAR(quick.points[0].modulation.value, moved, 0.02 * moved);
  KeptPatches kept;
  quick_answer(at, nullptr, &kept);
  EXPECT_EQ(quick_answer(away, &anchor, &kept).points, quick.points);
}

// A law that was measured where a gap closes says nothing about another design.
TEST(FirstAnswers, TakeNoLoadLawsOfAnAnchorThatIsPulledIn) {
  Design at = read_design(kHoles);
  at.environment.relative_humidity = {0.35};
  set_number(at, "drive.amplitude", 20000);
  at.model.air_limit = AirLimit::None;
  const Anchor anchor = anchor_of(at, response_of({1, 1, 1}));
  EXPECT_TRUE(anchor.quick.points[0].status.pull_in());
  EXPECT_TRUE(anchor.laws.empty());
}

TEST(FirstAnswers, AreComputedOnMorePixelsWhereFeaturesAreNarrow) {
  Design design = read_design(kHoles);
  design.accuracy.seed = 41;
  // Three pixels of 12 um / 64 are 0.5625 um, of 12 um / 96 0.375 um.
  for (const auto& [diameter, grid] : {std::pair{0.57e-6, 64},
                                       {0.56e-6, 96},
                                       {0.376e-6, 96},
                                       {0.374e-6, 128},
                                       {5.43e-6, 64},
                                       {5.44e-6, 96}}) {
    set_number(design, "texture.diameter", diameter);
    Fidelity expected = fidelity_level("search");
    expected.seed = 41, expected.grid = grid;
    expected.skins = 6, expected.equilibrium_skins = 2;
    EXPECT_EQ(quick_fidelity(design), expected) << diameter;
  }
}

TEST(FirstAnswers, AreCarriedToDesignsThatDifferInNumbersAlone) {
  const Design at = read_design(kHoles);
  const Anchor anchor{at, {}, response_of({0.4, 0.8, 0.5}), response_of({0.2, 0.72, 0.4})};
  const auto carried = [&](const std::function<void(Design&)>& change) {
    Design out = at;
    change(out);
    return carries(anchor, out);
  };
  EXPECT_TRUE(carried([](Design& d) {
    set_number(d, "texture.depth", 300e-9);
    set_number(d, "finger.load", 3 * d.finger.load);
  }));
  EXPECT_TRUE(carried([](Design& d) { set_number(d, "texture.depth", 0); }));
  EXPECT_TRUE(carried([](Design& d) { d.title = "another"; }));
  EXPECT_FALSE(carried([](Design& d) { d.environment.relative_humidity.push_back(0.9); }));
  EXPECT_FALSE(carried([](Design& d) { d.surface.dielectric.push_back(d.surface.dielectric[0]); }));
  EXPECT_FALSE(carried([](Design& d) { d.texture = default_texture(2); }));
  EXPECT_FALSE(carried([](Design& d) { d.drive.amplitude = 0; }));
  // Narrow holes are answered on other pixels: that ratio is another one.
  EXPECT_FALSE(carried([](Design& d) { set_number(d, "texture.diameter", 0.5e-6); }));
}

}  // namespace
}  // namespace papilla::tests::first_answers_test
