// The closed forms of water, the empty values of its structs, and what is said of its models.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/constants.h"
#include "geometry/texture.h"
#include "physics/capillary/bridge.h"
#include "physics/capillary/bridge_branch.h"
#include "physics/capillary/bridge_table.h"
#include "physics/capillary/drop.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/facts.h"
#include "physics/capillary/film.h"
#include "physics/capillary/threshold.h"
#include "physics/capillary/water.h"

namespace papilla::tests::water_laws_test {
namespace {

using namespace papilla::capillary;

constexpr double kDegree = kPi / 180;

TEST(WaterLaws, WaterIsThatOf24DegreesOnSkinOf80AndGlassOf50Degrees) {
  const WaterProperties water;
  EXPECT_EQ(water.surface_tension, kWaterSurfaceTension);
  EXPECT_DOUBLE_EQ(water.theta_skin, 80 * kDegree);
  EXPECT_DOUBLE_EQ(water.theta_substrate, 50 * kDegree);
  EXPECT_EQ(water.hysteresis, 0.33);
  EXPECT_FALSE(water.pressure_alone);
}

TEST(WaterLaws, DropletsAreThoseOfTheTheoryPage) {
  const DropletOptions
      o;  // docs/theory/capillary.md: 100 a um3, 200 nm halved 4 times, 0.3 nm, 4 um, 40 %
  EXPECT_EQ(o.drops_per_volume, 100e18);
  EXPECT_EQ(o.first_step, 200e-9);
  EXPECT_EQ(o.halvings, 4);
  EXPECT_EQ(o.gap_floor, 0.3e-9);
  EXPECT_EQ(o.film_width, 4e-6);
  EXPECT_EQ(o.film_area, 0.4);
  EXPECT_EQ(o.max_moves, 1000);
  EXPECT_EQ(o.rims, nullptr);
  EXPECT_FALSE(o.rim_pinning || o.corner_wicking);
}

TEST(WaterLaws, WhatIsNotYetKnownIsNothing) {
  const Drop d;
  for (const double v : {d.x, d.y, d.volume, d.radius, d.edge_gap, d.edge_slope, d.energy, d.film,
                         d.footprint, d.height})
    EXPECT_EQ(v, 0);
  EXPECT_EQ(d.side, DropletState::OnSubstrate);
  EXPECT_TRUE(d.alive && !d.bridge);
  const Film f;
  EXPECT_EQ(f.height + f.area + f.force + f.retention + f.regions, 0);
  const FilmSource s;
  for (const double v : {s.x, s.y, s.radius, s.edge_gap, s.volume}) EXPECT_EQ(v, 0);
  EXPECT_EQ(s.share, 1);
  const FilmRegion r;
  for (const double v : {r.height, r.area, r.volume, r.share, r.force, r.retention})
    EXPECT_EQ(v, 0);
  EXPECT_FALSE(r.full);
  const SettleReport report;
  EXPECT_EQ(report.initial_energy, 0);
  EXPECT_EQ(report.final_energy, 0);
  EXPECT_EQ(report.initial_droplets, 0);
  EXPECT_EQ(report.moves, 0);
  EXPECT_EQ(report.merges, 0);
  EXPECT_EQ(report.evaluations, 0);
  EXPECT_TRUE(report.converged && !report.energy_rose);
  const DropletSeed seed;
  for (const double v : {seed.x, seed.y, seed.volume}) EXPECT_EQ(v, 0);
  const Fillet fillet;
  EXPECT_EQ(fillet.area, 0);
  EXPECT_EQ(fillet.leg, 0);
  const RimMap::Hole hole;
  EXPECT_EQ(hole.perimeter, 0);
  EXPECT_EQ(hole.area, 0);
  const DropletBand band;
  EXPECT_EQ(band.capillary, 0);
  EXPECT_EQ(band.pull, 0);
  const BridgeLimits limits;
  EXPECT_EQ(limits.status, BridgeStatus::Invalid);
  for (const double v : {limits.rupture, limits.switching, limits.snap_in, limits.zero_force})
    EXPECT_EQ(v, 0);
  EXPECT_FALSE(limits.pitchfork);
  const Bridge b;
  EXPECT_EQ(b.status, BridgeStatus::Invalid);
  for (const double v : {b.energy, b.force, b.pressure, b.radius1, b.radius2, b.free_area, b.arc})
    EXPECT_EQ(v, 0);
  const bridge_branch::Unknowns x;
  for (const double v : {x.r1, x.p, x.arc}) EXPECT_EQ(v, 0);
  const bridge_branch::Profile q;
  for (const double v : {q.height, q.volume, q.free_area, q.w, q.u, q.r2}) EXPECT_EQ(v, 0);
  const bridge_branch::Limit limit;
  EXPECT_FALSE(limit.found || limit.pitchfork);
  EXPECT_EQ(limit.height, 0);
}

// Eqs. capillary.1 and 2 as sums over the two plates.
TEST(WaterLaws, GainAndMeniscusOfAllAnglesAreTheirSums) {
  for (int i = 0; i <= 18; ++i) {
    for (int j = 0; j <= 18; ++j) {
      const double a = 10 * i * kDegree, b = 10 * j * kDegree;
      const double c = std::cos(a) + std::cos(b);
      EXPECT_NEAR(wetting_gain(a, b), c, 1e-14) << i << " " << j;
      if (i + j == 18) {
        EXPECT_NEAR(meniscus_factor(a, b), std::sin(a), 1e-12)
            << i;  // the limit of a straight line
        EXPECT_NEAR(wetting_gain(a, b), 0, 1.3e-16);
      } else {
        const double f =
            (kPi - a - b + std::sin(a) * std::cos(a) + std::sin(b) * std::cos(b)) / (2 * c);
        EXPECT_NEAR(meniscus_factor(a, b), f, 1e-12) << i << " " << j;
      }
    }
  }
  EXPECT_EQ(meniscus_factor(0, kPi), 0);
  EXPECT_EQ(meniscus_factor(kPi, 0), 0);
}

TEST(WaterLaws, ACapHasItsVolumeAndTheEnergyOfItsSurfaces) {
  for (const double degrees : {1.0, 10.0, 50.0, 80.0, 90.0, 100.0, 130.0, 179.0, 180.0}) {
    const double theta = degrees * kDegree, c = std::cos(theta);
    const CapShape cap = cap_shape(theta);
    const double a = cap.footprint, h = cap.height, radius = cap.sphere_radius;
    // Of the cap's own lengths: volume pi h (3 a^2 + h^2) / 6, free area pi (a^2 + h^2).
    EXPECT_NEAR(kPi * h * (3 * a * a + h * h) / 6, 1, 1e-11) << degrees;
    EXPECT_NEAR(kPi * (a * a + h * h) - c * kPi * a * a, cap.energy, 1e-10) << degrees;
    EXPECT_NEAR(a, radius * std::sin(theta), 1e-12 * radius) << degrees;
    EXPECT_NEAR(h, radius * (1 - c), 1e-11) << degrees;
    EXPECT_EQ(cap.widest, degrees > 90.5 ? radius : a) << degrees;
  }
  for (const double degrees : {0.0, 0.5, 0.999}) {
    EXPECT_EQ(cap_shape(degrees * kDegree).height, cap_shape(1 * kDegree).height);
    EXPECT_EQ(cap_shape(degrees * kDegree).energy, cap_shape(1 * kDegree).energy);
  }
  EXPECT_GT(cap_shape(1.01 * kDegree).height, cap_shape(1 * kDegree).height);
}

TEST(WaterLaws, ThePapersForceIsTheGainOverTheGapLessTheWaist) {
  WaterProperties water;
  water.theta_skin = 60 * kDegree, water.theta_substrate = 90 * kDegree;  // C = 1/2
  EXPECT_NEAR(laplace_force(water, 3, 0.25, 4), 3 * (0.5 / 0.25 - 0.25), 1e-14);
  EXPECT_NEAR(laplace_force(water, 3, 0.25, kInfinity), 6, 1e-14);
  EXPECT_NEAR(laplace_force(water, 3, 4, 0.5), 3 * (0.125 - 2), 1e-14);
}

TEST(WaterLaws, ThresholdWaterFallsShortByALogarithm) {
  // Eq. capillary.21: 0.60 + 0.05 ln(t / 0.5 nm), within 0 and 0.9.
  const double e = std::exp(1.0);
  EXPECT_NEAR(threshold_shortfall(0.5e-9), 0.6, 1e-15);
  EXPECT_NEAR(threshold_shortfall(0.5e-9 * e * e), 0.7, 1e-14);
  EXPECT_NEAR(threshold_shortfall(0.5e-9 / e), 0.55, 1e-14);
  EXPECT_EQ(threshold_shortfall(1e-3), 0.9);  // 1.33 of it
  EXPECT_EQ(threshold_shortfall(1e-20), 0);   // -0.63
  EXPECT_EQ(threshold_shortfall(0), 0);
  EXPECT_EQ(threshold_shortfall(-1), 0);
}

TEST(WaterLaws, BandsOfDropletsAreTheirFits) {
  const double e = std::exp(1.0);
  // Eqs. capillary.19 and 20.
  const DropletBand a = droplet_band(7e-9, 700e-9, 0.25);
  EXPECT_NEAR(a.pull, 0.7 * 0.5625 * (1 - 1 / e), 1e-14);
  EXPECT_NEAR(a.capillary, 0.75, 1e-14);  // 7 nm of 1 % of 700 nm
  const DropletBand b = droplet_band(14e-9, 400e-9, 0);
  EXPECT_NEAR(b.pull, 0.7 * (1 - 1 / (e * e)), 1e-14);
  EXPECT_NEAR(b.capillary, 1.5 / 4.5, 1e-14);
  EXPECT_EQ(droplet_band(7e-9, 700e-9, 1).pull, 0);
  EXPECT_EQ(droplet_band(7e-9, 0, 0.5).capillary, 0);
  for (const double none : {0.0, -1e-9}) {
    EXPECT_EQ(droplet_band(none, 1e-6, 0).pull, 0);
    EXPECT_EQ(droplet_band(none, 1e-6, 0).capillary, 0);
  }
}

TEST(WaterLaws, OfTheDropletModelWordsErrorAndPriceAreKnown) {
  const WaterFacts& facts = water_facts(WaterModel::Droplets);
  EXPECT_EQ(std::string_view(facts.method), "droplet ensemble by lowest energy");
  EXPECT_EQ(std::string_view(facts.reason),
            "its variation over humidity is what textures change; error: mobility and number");
  // Bridges hold 0.2 + 0.009 a nm of the water, 0.75 at most; the humidity of the largest band
  // counts.
  const auto band = [](double nm) {
    const double share = std::min(0.75, 0.2 + 0.009 * nm);
    return 0.7 * (1 - share) * (1 - share) * (1 - std::exp(-nm / 7));
  };
  for (const double nm : {0.5, 7.0, 20.0, 52.0, 100.0})
    EXPECT_NEAR(facts.error(std::vector{nm * 1e-9}), band(nm), 1e-13) << nm;
  // 20 nm has the most, neither the least nor the most water.
  const std::vector<double> humidities{0.5e-9, 7e-9, 20e-9, 52e-9};
  EXPECT_NEAR(facts.error(humidities), band(20), 1e-13);
  EXPECT_EQ(facts.error(std::vector{0.0}), 0);
  // 10 us a pixel of the side, and 2 us a droplet.
  EXPECT_NEAR(facts.seconds({256, 256, kWindow, kWindow}, 0), 2.56e-3, 1e-12);
  EXPECT_NEAR(facts.seconds({400, 100, kWindow, 0.25 * kWindow}, 1e4), 2e-3 + 0.02, 1e-12);
  // 50 nm of water on 144 um2 are 7.2 um3.
  EXPECT_NEAR(starting_droplets({128, 128, kWindow, kWindow}, 50e-9, 100), 720, 1e-9);
}

TEST(WaterLaws, OfTheThresholdModelWordsErrorAndPriceAreKnown) {
  const WaterFacts& facts = water_facts(WaterModel::Threshold);
  EXPECT_EQ(std::string_view(facts.method), "volume threshold");
  EXPECT_EQ(std::string_view(facts.reason),
            "cheap and smooth; it reverses the sign of the texture's effect on variation");
  const std::vector<double> humidities{0.5e-9, 0.5e-9 * std::exp(3.0), 0.5e-9 * std::exp(1.0)};
  EXPECT_NEAR(facts.error(humidities), 0.75, 1e-13);  // of the most water
  EXPECT_NEAR(facts.seconds({200, 50, 1, 1}, 1e5), 9e-5, 1e-15);
}

TEST(WaterLaws, AStatusHasItsWords) {
  EXPECT_EQ(text(BridgeStatus::Converged), "converged");
  EXPECT_EQ(text(BridgeStatus::Ruptured), "ruptured");
  EXPECT_EQ(text(BridgeStatus::NotConverged), "not converged");
  EXPECT_EQ(text(BridgeStatus::Invalid), "invalid");
}

}  // namespace
}  // namespace papilla::tests::water_laws_test
