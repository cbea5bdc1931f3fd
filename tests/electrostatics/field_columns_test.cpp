// Nodes and media of a column by hand, and what two columns exchange against a walk through every
// height of either.
#include "physics/electrostatics/field_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"

namespace papilla::tests::field_columns_test {
namespace {

constexpr double kNano = 1e-9;

// Two columns of pixels 100 nm wide: the first of them in nanometres, the second bare and far.
PotentialProblem column(double electrode, double surface, double skin, double dielectric,
                        double layer) {
  PotentialProblem p;
  p.grid = {2, 1, 200e-9, 150e-9};
  p.electrode = {electrode * kNano, 0};
  p.surface = {surface * kNano, 0};
  p.skin = {skin * kNano, 1e-6};
  p.dielectric = {dielectric * kNano, 0};
  p.skin_layer = layer * kNano;
  return p;
}

struct Nodes {
  std::vector<double> z, rise, permittivity, resistance;  // z and resistance in nm
};
void expect_nodes(const PotentialProblem& p, const Nodes& n) {
  const FieldColumns c(p, 2, 3);
  ASSERT_EQ(c.nodes(), 6);
  ASSERT_EQ(c.cells_below_surface(), 2);
  for (int k = 0; k < 6; ++k) {
    const auto at = static_cast<std::size_t>(k);
    EXPECT_NEAR(c.z(0, k), n.z[at] * kNano, 1e-9 * kNano) << k;
    EXPECT_NEAR(c.rise(0, k), n.rise[at], 1e-12) << k;
    if (k == 5) break;
    EXPECT_NEAR(c.permittivity(0, k), n.permittivity[at], 1e-9) << k;
    EXPECT_NEAR(c.resistance(0, k), n.resistance[at] * kNano, 1e-9 * kNano) << k;
    EXPECT_NEAR(c.inverse_height(0, k) * (n.z[at + 1] - n.z[at]) * kNano, 1, 1e-9) << k;
  }
}

constexpr double kThird = 1.0 / 81, kTwoThirds = 16.0 / 81;  // to the fourth power

// Half as deep, a quarter of the way; above, the layer on the skin as air.
TEST(FieldColumns, NodesGatherAtTheDielectricsSurface) {
  expect_nodes(column(-400, 0, 120, 100, 30), {{-400, -100, 0, 50, 100, 150},
                                               {0, 0, 0, kThird, kTwoThirds, 1},
                                               {4, 4, 1, 1, 1},
                                               {75, 25, 50, 50, 50}});
  // The surface stands anywhere.
  expect_nodes(column(-330, 70, 190, 100, 30), {{-330, -30, 70, 120, 170, 220},
                                                {0, 0, 0, kThird, kTwoThirds, 1},
                                                {4, 4, 1, 1, 1},
                                                {75, 25, 50, 50, 50}});
}

TEST(FieldColumns, DropletsTakeTheFirstAndTheLastCellOfTheAir) {
  PotentialProblem below = column(-400, 0, 120, 100, 30);
  below.water_below = {20 * kNano, 0};
  expect_nodes(below, {{-400, -100, 0, 20, 85, 150},
                       {0, 0, 0, 0, 1.0 / 16, 1},
                       {4, 4, 80, 1, 1},
                       {75, 25, 0.25, 65, 65}});
  // Water above carries the layer of the skin: 30 nm of each, 0.375 + 30 nm of resistance.
  PotentialProblem above = column(-400, 0, 120, 100, 30);
  above.water_above = {30 * kNano, 0};
  expect_nodes(above, {{-400, -100, 0, 45, 90, 150},
                       {0, 0, 0, 1.0 / 16, 1, 1},
                       {4, 4, 1, 1, 40.5},
                       {75, 25, 45, 45, 30.375}});
  PotentialProblem both = below;
  both.water_above = {30 * kNano, 0};
  expect_nodes(both, {{-400, -100, 0, 20, 90, 150},
                      {0, 0, 0, 0, 1, 1},
                      {4, 4, 80, 1, 40.5},
                      {75, 25, 0.25, 70, 30.375}});
}

// No more water than the gap has room for, the lower first.
TEST(FieldColumns, WaterEndsWhereTheGapDoes) {
  PotentialProblem p = column(-400, 0, 120, 100, 30);
  p.water_below = {200 * kNano, 0};
  p.water_above = {50 * kNano, 0};
  expect_nodes(p, {{-400, -100, 0, 120, 135, 150},
                   {0, 0, 0, 0, 1.0 / 16, 1},
                   {4, 4, 80, 1, 1},
                   {75, 25, 1.5, 15, 15}});
  p.water_below = {80 * kNano, 0};  // 40 nm of 50 are left, and of air what counts as the thinnest
  expect_nodes(p, {{-400, -100, 0, 80, 80.01, 150.01},
                   {0, 0, 0, 0, 1, 1},
                   {4, 4, 80, 1, (40 * 80 + 30) / 70.0},
                   {75, 25, 1, 0.01, 30.5}});
}

// A ten-thousandth of the narrower side, 0.01 nm, so that nothing divides by zero.
TEST(FieldColumns, WhatTouchesHasNextToNothingBetween) {
  expect_nodes(column(0, 0, -5, 0, 0), {{-0.01, -0.0025, 0, 0.01 / 3, 0.02 / 3, 0.01},
                                        {0, 0, 0, kThird, kTwoThirds, 1},
                                        {1, 1, 1, 1, 1},
                                        {0.0075, 0.0025, 0.01 / 3, 0.01 / 3, 0.01 / 3}});
  // A film that conducts less than the gap takes more of the voltage than as much gap would.
  expect_nodes(column(-400, 0, 90, 800, 0), {{-400, -100, 0, 30, 60, 90},
                                             {0, 0, 0, kThird, kTwoThirds, 1},
                                             {0.5, 0.5, 1, 1, 1},
                                             {600, 200, 30, 30, 30}});
}

TEST(FieldColumns, TheNodesAtBodiesHaveTheirPotential) {
  PotentialProblem p = column(-400, 0, 120, 100, 30);
  const FieldColumns open(p, 2, 3);
  p.bridged = {1, 0};
  const FieldColumns wet(p, 2, 3);
  EXPECT_FALSE(open.bridged(0));
  EXPECT_EQ(open.top(0), 5);
  EXPECT_TRUE(wet.bridged(0));
  EXPECT_EQ(wet.top(0), 2);  // at the dielectric's surface
  EXPECT_FALSE(wet.bridged(1));
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(open.fixed(0, k), k == 0 || k == 5) << k;
    EXPECT_EQ(wet.fixed(0, k), k == 0 || k >= 2) << k;
    EXPECT_EQ(open.body_potential(k), k == 0 ? 1 : 0) << k;
  }
}

// Water with a potential of its own: its node is the one on the film, the body is behind the layer,
// and its wall ends at the skin, beside which no layer of the skin leads.
TEST(FieldColumns, WaterWithAPotentialOfItsOwnIsANodeBelowTheSkinsLayer) {
  PotentialProblem p;
  p.grid = {2, 1, 200e-9, 100e-9};
  p.electrode = {-400e-9, -400e-9};
  p.surface = {0, 0};
  p.skin = {90e-9, 90e-9};
  p.dielectric = {100e-9, 100e-9};
  p.bridged = {1, 0};
  p.skin_layer = 30e-9;
  p.water_skin_layer = 25e-9;
  const FieldColumns c(p, 2, 4);
  EXPECT_TRUE(c.bridged(0));
  EXPECT_EQ(c.top(0), 3);
  EXPECT_FALSE(c.fixed(0, 2));
  EXPECT_TRUE(c.fixed(0, 3));
  EXPECT_EQ(c.resistance(0, 2), 25e-9);
  double wall = 0, rising = 0;
  c.exchanges(0, 1, 1, [&](const Exchange& e) {
    if (e.body != Body::Water) return;
    EXPECT_EQ(e.here, -1);
    wall += e.conductance;
    rising += e.per_rise;
  });
  EXPECT_NEAR(wall, 2 * 90e-9, 1e-15);  // over half a pixel
  EXPECT_NEAR(rising, 2, 1e-9);
  p.water_skin_layer = 0;
  const FieldColumns grounded(p, 2, 4);
  EXPECT_EQ(grounded.top(0), 2);
  wall = 0;
  grounded.exchanges(0, 1, 1, [&](const Exchange& e) {
    if (e.body == Body::Water) wall += e.conductance;
  });
  EXPECT_NEAR(wall, 2 * 120e-9, 1e-15);  // as high as the body
}

// The cell of a column that holds a height; -1 below it, `top` above.
int cell_at(const FieldColumns& c, std::size_t column, double z) {
  if (z < c.z(column, 0)) return -1;
  int k = 0;
  while (k < c.top(column) && c.z(column, k + 1) < z) ++k;
  return k;
}

// Eq. electrostatics.13, height by height between all nodes of the two.
std::vector<Exchange> walked(const FieldColumns& c, std::size_t i, std::size_t j, double face) {
  std::vector<double> heights;
  for (const std::size_t column : {i, j}) {
    for (int k = 0; k <= c.top(column); ++k) heights.push_back(c.z(column, k));
  }
  std::sort(heights.begin(), heights.end());
  std::vector<Exchange> out;
  for (std::size_t h = 0; h + 1 < heights.size(); ++h) {
    const double thick = heights[h + 1] - heights[h];
    if (thick == 0) continue;
    Exchange e;
    e.middle = 0.5 * (heights[h] + heights[h + 1]);
    const int a = cell_at(c, i, e.middle), b = cell_at(c, j, e.middle);
    const bool in_a = a >= 0 && a < c.top(i), in_b = b >= 0 && b < c.top(j);
    if (!in_a && !in_b) continue;  // the one ends below where the other begins
    e.here = in_a ? a : -1;
    e.there = in_b ? b : -1;
    double resistance = 0;  // of one step sideways
    if (in_a && in_b) {
      resistance = 0.5 / c.permittivity(i, a) + 0.5 / c.permittivity(j, b);
    } else {
      const std::size_t own = in_a ? i : j, other = in_a ? j : i;
      const bool electrode = e.middle < c.z(other, 0);
      const double from = electrode ? c.z(own, 0) : c.z(own, c.top(own));
      const double to = electrode ? c.z(other, 0) : c.z(other, c.top(other));
      e.body = electrode                      ? Body::Electrode
               : c.bridged(i) != c.bridged(j) ? Body::Water
                                              : Body::Skin;
      e.jump = std::abs(from - to);
      // The straight line from surface to surface crosses the height there.
      e.share = e.body == Body::Water ? 0.5 : std::abs(e.middle - from) / e.jump;
      e.share = std::max(e.share, 1e-3);
      resistance = e.share / c.permittivity(own, in_a ? a : b);
    }
    e.conductance = face * thick / resistance;
    out.push_back(e);
  }
  return out;
}

void expect_same(const std::vector<Exchange>& is, const std::vector<Exchange>& expected) {
  ASSERT_EQ(is.size(), expected.size());
  for (std::size_t k = 0; k < is.size(); ++k) {
    EXPECT_NEAR(is[k].middle, expected[k].middle, 1e-9 * kNano) << k;
    EXPECT_NEAR(is[k].conductance, expected[k].conductance, 1e-7 * expected[k].conductance) << k;
    EXPECT_EQ(is[k].here, expected[k].here) << k;
    EXPECT_EQ(is[k].there, expected[k].there) << k;
    EXPECT_EQ(is[k].body, expected[k].body) << k;
    EXPECT_NEAR(is[k].share, expected[k].share, 1e-7) << k;
    EXPECT_NEAR(is[k].jump, expected[k].jump, 1e-9 * kNano) << k;
  }
}

std::vector<Exchange> exchanges(const FieldColumns& c, std::size_t i, std::size_t j, double face) {
  std::vector<Exchange> out;
  c.exchanges(i, j, face, [&](const Exchange& e) { out.push_back(e); });
  return out;
}

// By hand: 4 above 300 nm and 2 above the same give 8/3 over it, half a step through each.
TEST(Exchanges, OfTwoFlatColumnsGoCellByCell) {
  PotentialProblem p = column(-400, 0, 120, 100, 30);
  p.electrode[1] = p.electrode[0], p.surface[1] = p.surface[0], p.skin[1] = p.skin[0];
  p.dielectric[1] = 2 * p.dielectric[0];
  const FieldColumns c(p, 2, 3);
  std::vector<Exchange> expected(5);
  const double middle[] = {-250, -50, 25, 75, 125}, wide[] = {300, 100, 50, 50, 50};
  for (int k = 0; k < 5; ++k) {
    Exchange& e = expected[static_cast<std::size_t>(k)];
    e.middle = middle[k] * kNano;
    e.conductance = 1.5 * wide[k] * kNano * (k < 2 ? 8.0 / 3 : 1);
    e.here = e.there = k;
  }
  expect_same(exchanges(c, 0, 1, 1.5), expected);
}

// By hand: a step of 100 nm. Below the higher electrode the way to it shrinks from a whole step to
// none; of what stands above the lower column's body, likewise.
TEST(Exchanges, OfAColumnBesideABodyGoToItsSurface) {
  PotentialProblem p = column(-100, 0, 90, 50, 0);
  p.electrode[1] = -200 * kNano, p.surface[1] = -100 * kNano, p.skin[1] = -10 * kNano;
  p.dielectric[1] = 50 * kNano;
  const FieldColumns c(p, 2, 3);
  const std::vector<Exchange> out = exchanges(c, 0, 1, 2);
  // Nodes: -100 -25 0 30 60 90 and -200 -125 -100 -70 -40 -10.
  ASSERT_EQ(out.size(), 10u);
  EXPECT_EQ(out[0].here, -1);
  EXPECT_EQ(out[0].there, 0);
  EXPECT_EQ(out[0].body, Body::Electrode);
  EXPECT_NEAR(out[0].share, 0.375, 1e-9);  // -162.5 lies 37.5 of 100 up from the column's foot
  EXPECT_NEAR(out[0].jump, 100 * kNano, 1e-16);
  EXPECT_NEAR(out[0].conductance, 2 * 75 * kNano * 2 / 0.375, 1e-15);
  const Exchange& last = out.back();  // 60 to 90 nm, beside the skin that stands at -10
  EXPECT_EQ(last.here, 4);
  EXPECT_EQ(last.there, -1);
  EXPECT_EQ(last.body, Body::Skin);
  EXPECT_NEAR(last.share, 0.15, 1e-9);
  EXPECT_NEAR(last.conductance, 30 * kNano * 2 / 0.15, 1e-15);
  expect_same(out, walked(c, 0, 1, 2));
}

TEST(Exchanges, OfAnyColumnsAreThoseOfEveryHeight) {
  PotentialProblem p;
  p.grid = {40, 1, 4e-6, 0.1e-6};
  RandomStream random(8, "columns of a test", 0);
  p.skin_layer = 20e-9;
  for (int i = 0; i < 40; ++i) {
    const double foot = -300e-9 * random.uniform(), thick = 250e-9 * random.uniform();
    p.electrode.push_back(foot);
    p.surface.push_back(foot + thick);
    p.skin.push_back(foot + thick + 200e-9 * random.uniform());
    p.dielectric.push_back(thick / (1 + 5 * random.uniform()));
    p.water_below.push_back(random.uniform() < 0.3 ? 30e-9 : 0);
    p.water_above.push_back(random.uniform() < 0.3 ? 30e-9 : 0);
    p.bridged.push_back(random.uniform() < 0.25);
  }
  const FieldColumns c(p, 4, 4);
  int bodies[4] = {}, gaps = 0;
  for (std::size_t i = 0; i + 1 < 40; ++i) {
    const std::vector<Exchange> out = exchanges(c, i, i + 1, 0.7);
    expect_same(out, walked(c, i, i + 1, 0.7));
    std::vector<Exchange> back = exchanges(c, i + 1, i, 0.7);
    for (Exchange& e : back) std::swap(e.here, e.there);
    expect_same(out, back);
    for (const Exchange& e : out) ++bodies[static_cast<int>(e.body)];
    gaps += c.z(i, c.top(i)) < c.z(i + 1, 0) || c.z(i + 1, c.top(i + 1)) < c.z(i, 0);
  }
  for (const int seen : bodies) EXPECT_GT(seen, 5);
  EXPECT_GT(gaps, 0);  // columns that do not overlap exchange nothing between them
}

}  // namespace
}  // namespace papilla::tests::field_columns_test
