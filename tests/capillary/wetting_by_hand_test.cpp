// Settled drops as the wetting that other physics sees, and the wetting as a traction: every
// member.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/capillary/drop_energy.h"
#include "physics/capillary/drop_wetting.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/film.h"
#include "physics/capillary/threshold.h"

namespace papilla::tests::wetting_by_hand_test {
namespace {

using namespace papilla::capillary;

constexpr double kUm = 1e-6, kGap = 100e-9;
constexpr Grid kPatch{120, 100, 12 * kUm, 10 * kUm};

Gap flat_gap(double h = kGap) { return {kPatch, std::vector<double>(kPatch.size(), h)}; }
double disc(double radius) { return kPi * radius * radius * kGap; }

DropletOptions at_rest() {
  DropletOptions options;
  options.max_moves = 0;
  return options;
}

struct Settled {
  Gap gap;
  DropEnergy energy;
  std::vector<Drop> drops;

  explicit Settled(Gap over = flat_gap()) : gap(std::move(over)), energy(gap, {}, 0.3e-9) {}
  void add(double x, double y, double volume) {
    drops.push_back(energy.placed(x * kUm, y * kUm, volume, 0, false));
  }
  Wetting wetting(const DropletOptions& options = {}) {
    return wetting_of(gap, {}, options, energy, drops, 7, 3);
  }
};

TEST(WettingByHand, DiscsAreSummedAndListed) {
  Settled s;
  s.add(3, 4, disc(0.5 * kUm));
  s.add(11.9, 9.9, disc(0.7 * kUm));
  s.add(8, 4, cube(60e-9));  // a cap
  s.add(6, 6, disc(0.5 * kUm));
  s.drops[3].alive = false;
  const Wetting w = s.wetting();
  EXPECT_TRUE(w.grid == kPatch);
  EXPECT_EQ(w.status, WettingStatus::Discs);
  EXPECT_EQ(w.volume, 7);
  EXPECT_EQ(w.wicked_volume, 3);
  EXPECT_EQ(w.bridges, 2);
  EXPECT_TRUE(w.film.empty());
  ASSERT_EQ(w.droplets.size(), 3u);
  const double first = s.energy.force(s.drops[0]), second = s.energy.force(s.drops[1]);
  EXPECT_NEAR(w.capillary_force, first + second, 1e-12 * (first + second));
  EXPECT_NEAR(w.bridge_volume, disc(0.5 * kUm) + disc(0.7 * kUm), 1e-30);
  EXPECT_NEAR(w.retention, s.energy.retention(s.drops[0]) + s.energy.retention(s.drops[1]), 1e-20);
  EXPECT_NEAR(w.wetted_fraction, kPi * (0.25 + 0.49) / 120, 1e-9);
  const Droplet& b = w.droplets[1];
  EXPECT_EQ(b.x, 11.9 * kUm);
  EXPECT_EQ(b.y, 9.9 * kUm);
  EXPECT_EQ(b.state, DropletState::Bridge);
  EXPECT_NEAR(b.radius, 0.7 * kUm, 1e-15);
  EXPECT_NEAR(b.height, kGap, 1e-16);
  EXPECT_NEAR(b.edge_gap, kGap, 1e-17);
  EXPECT_EQ(b.force, second);
  EXPECT_EQ(b.energy, s.drops[1].energy);
  EXPECT_EQ(b.volume, disc(0.7 * kUm));
  EXPECT_EQ(b.film, 0);
  const Droplet& c = w.droplets[2];
  const CapShape cap = cap_shape(50 * kPi / 180);
  EXPECT_EQ(c.state, DropletState::OnSubstrate);
  EXPECT_NEAR(c.radius, cap.footprint * 60e-9, 1e-18);
  EXPECT_NEAR(c.height, cap.height * 60e-9, 1e-18);
  EXPECT_EQ(c.edge_gap, 0);
  EXPECT_EQ(c.force, 0);
  EXPECT_NEAR(c.energy, s.drops[2].energy, 0);
  for (std::size_t k = 0; k < kPatch.size(); ++k) {
    const bool wet = square_distance(kPatch, k, 3 * kUm, 4 * kUm) < square(0.5 * kUm) ||
                     square_distance(kPatch, k, 11.9 * kUm, 9.9 * kUm) < square(0.7 * kUm);
    ASSERT_EQ(w.bridged[k], wet) << k;
  }
}

// Eq. capillary.22 of a width or an area x over its limit: t = (x - 0.8) / 0.45 in 0 to 1.
double blend(double x) {
  const double t = std::clamp((x - 0.8) / 0.45, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

TEST(WettingByHand, AWideBridgeGoesOverIntoAFilm) {
  for (const double x : {0.79, 0.81, 0.9, 1.0, 1.1, 1.24, 1.26, 2.0}) {
    DropletOptions options;
    options.film_width = 2 * kUm / x;  // of a bridge 2 um wide
    Settled s;
    s.add(3, 4, disc(1 * kUm));
    s.add(8, 4, disc(0.3 * kUm));
    const double alone = s.energy.force(s.drops[0]), other = s.energy.force(s.drops[1]);
    const Wetting w = s.wetting(options);
    const double share = blend(x);
    ASSERT_EQ(w.droplets.size(), 2u);
    EXPECT_NEAR(w.droplets[0].film, share, 1e-9) << x;
    EXPECT_EQ(w.droplets[1].film, 0) << x;
    EXPECT_EQ(w.status, share > 0 ? WettingStatus::Film : WettingStatus::Discs) << x;
    EXPECT_EQ(w.bridges, 2);
    EXPECT_NEAR(w.droplets[0].force, (1 - share) * alone, 1e-9 * alone);
    EXPECT_NEAR(w.droplets[1].force, other, 1e-12 * other);
    EXPECT_NEAR(w.bridge_volume, disc(1 * kUm) + disc(0.3 * kUm), 1e-30);
    // In a flat gap disc and film of the same water have one area.
    EXPECT_NEAR(w.wetted_fraction, kPi * 1.09 / 120, 1e-9) << x;
    if (share == 0) continue;
    // The film's line from its part of the retention; the force of area and line, Eq. capillary.9,
    // at the level of the outermost pixel: of as many as hold the water, the nearest to the centre.
    const WaterProperties water;
    const double rest =
        (1 - share) * s.energy.retention(s.drops[0]) + s.energy.retention(s.drops[1]);
    const double line =
        (w.retention - rest) / share * 4 / (water.surface_tension * water.hysteresis);
    std::vector<double> rho2;
    for (std::size_t k = 0; k < kPatch.size(); ++k)
      rho2.push_back(square_distance(kPatch, k, 3 * kUm, 4 * kUm) / square(kUm));
    std::sort(rho2.begin(), rho2.end());
    const double height =
        (1 - share) * kGap *
            rho2[static_cast<std::size_t>(kPi * square(kUm) / kPatch.pixel_area())] +
        share * kGap;
    const double film =
        water.surface_tension *
        (wetting_gain(water.theta_skin, water.theta_substrate) * kPi * square(kUm) / height +
         meniscus_factor(water.theta_skin, water.theta_substrate) * line);
    EXPECT_NEAR(w.capillary_force, (1 - share) * alone + other + share * film, 1e-7 * alone) << x;
    // A circle's; all film, it takes any pixels of the flat gap, around which the line is longer.
    EXPECT_GT(line, 2 * kPi * kUm - 0.15 * kUm) << x;
    EXPECT_EQ(line < 2 * kPi * kUm + 0.15 * kUm, share < 1) << x;
    for (std::size_t k = 0; k < kPatch.size(); ++k) {
      const bool small = square_distance(kPatch, k, 8 * kUm, 4 * kUm) < square(0.3 * kUm);
      ASSERT_TRUE(w.film[k] == FilmPixel::None || w.bridged[k] == 1);
      ASSERT_EQ(w.bridged[k], small || w.film[k] != FilmPixel::None);
      ASSERT_FALSE(small && w.film[k] != FilmPixel::None);
    }
    const auto kind = share < 1 ? FilmPixel::OnItsWay : FilmPixel::Film;
    const auto pixels = std::count(w.film.begin(), w.film.end(), kind);
    EXPECT_EQ(pixels, std::ceil(kPi * square(kUm) / kPatch.pixel_area()));
    EXPECT_EQ(pixels + std::count(w.film.begin(), w.film.end(), FilmPixel::None), 12000);
  }
}

TEST(WettingByHand, ManyBridgesGoOverByTheirArea) {
  for (const double x : {0.79, 0.85, 1.0, 1.2}) {
    Settled s;
    for (const double at : {2.0, 5.0, 8.0}) s.add(at, 4, disc(1 * kUm));
    s.add(10.5, 8, cube(60e-9));
    DropletOptions options;
    options.film_area = 3 * kPi / 120 / x;
    const Wetting w = s.wetting(options);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(w.droplets[i].film, blend(x), 1e-9) << x;
    EXPECT_EQ(w.droplets[3].film, 0);
    EXPECT_EQ(w.bridges, 3);
    EXPECT_NEAR(w.wetted_fraction, 3 * kPi / 120, 1e-9);
  }
}

// A bridge as wide as the patch's shorter side is all film, whatever the limit: then the share goes
// from 0.8 of the side to the side.
TEST(WettingByHand, NoDiscIsWiderThanThePatch) {
  for (const auto& [width, share] : {std::pair{7.9, 0.0}, {9.0, 0.5}, {10.0, 1.0}}) {
    Settled s;
    s.add(3, 4, disc(0.5 * width * kUm));
    DropletOptions options;
    options.film_width = 50 * kUm;
    options.film_area = 50;
    EXPECT_NEAR(s.wetting(options).droplets.at(0).film, share, 1e-8) << width;
  }
  // A cap that is wider is a film too, of one that is not none; it has no force of its own.
  for (const double width : {9.9, 10.1}) {
    Settled s(flat_gap(60e-6));
    const double size = 0.5 * width * kUm / cap_shape(50 * kPi / 180).widest;
    s.add(3, 4, cube(size));
    ASSERT_FALSE(s.drops[0].bridge);
    const Wetting w = s.wetting();
    EXPECT_EQ(w.droplets.at(0).film, width > 10 ? 1 : 0);
    EXPECT_EQ(w.droplets.at(0).state,
              width > 10 ? DropletState::Bridge : DropletState::OnSubstrate);
    EXPECT_EQ(w.bridges, width > 10 ? 1 : 0);
    EXPECT_NEAR(w.droplets.at(0).height, cap_shape(50 * kPi / 180).height * size, 1e-15);
  }
}

// A trench along x, 1 um wide and narrowest, 50 nm, in its middle: a film runs along it and takes
// in a bridge and a cap.
struct Trench : Settled {
  Trench() : Settled(over()) {
    add(6, 5, 0.25e-18);
    add(4, 5, 0.002e-18);      // a bridge in the trench
    add(8.1, 5, cube(40e-9));  // a cap: a bridge of 40 nm has no 50 nm
    add(6, 8, 0.01e-18);       // a bridge outside
  }
  static Gap over() {
    Gap gap{kPatch, {}};
    for (int iy = 0; iy < kPatch.ny; ++iy) {
      for (int ix = 0; ix < kPatch.nx; ++ix)
        gap.value.push_back(iy >= 45 && iy < 55 ? 50e-9 + 1e-3 * std::abs(kPatch.x(ix) - 6 * kUm)
                                                : kGap);
    }
    return gap;
  }
};

TEST(WettingByHand, AFilmTakesInWhatItReaches) {
  Trench t;
  ASSERT_TRUE(t.drops[0].bridge && t.drops[1].bridge && !t.drops[2].bridge && t.drops[3].bridge);
  DropletOptions options;
  options.film_width = 0.4 * kUm;
  options.film_area = 10;
  ASSERT_GT(t.drops[0].radius, 0.25 * kUm);
  ASSERT_LT(t.drops[1].radius, 0.16 * kUm);
  ASSERT_LT(t.drops[3].radius, 0.2 * kUm);
  const double outside = t.energy.force(t.drops[3]);
  const double share = blend(2 * t.drops[3].radius / (0.4 * kUm));
  const Wetting w = t.wetting(options);
  EXPECT_EQ(w.status, WettingStatus::Film);
  ASSERT_EQ(w.droplets.size(), 4u);
  EXPECT_EQ(w.droplets[0].film, 1);
  EXPECT_EQ(w.droplets[1].film, 1);
  EXPECT_EQ(w.droplets[2].film, 1);
  EXPECT_NEAR(w.droplets[3].film, share, 1e-12);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(w.droplets[i].state, DropletState::Bridge);
    EXPECT_EQ(w.droplets[i].force, 0);
  }
  EXPECT_NEAR(w.droplets[3].force, (1 - share) * outside, 1e-9 * outside);
  EXPECT_EQ(w.bridges, 2);
  EXPECT_NEAR(w.bridge_volume, 0.262e-18 + cube(40e-9), 1e-12 * 0.262e-18);
  // The lowest of the trench's pixels hold the water of three; the other film's area is its disc's.
  std::vector<double> trench(t.gap.value.begin() + 45 * 120, t.gap.value.begin() + 55 * 120);
  std::sort(trench.begin(), trench.end());
  double left = (0.252e-18 + cube(40e-9)) / kPatch.pixel_area(), pixels = 0;
  std::size_t full = 0;
  for (; left > trench[full]; ++full) left -= trench[full], pixels += 1;
  pixels += left / trench[full];
  EXPECT_NEAR(w.wetted_fraction * kPatch.area(),
              pixels * kPatch.pixel_area() + kPi * square(t.drops[3].radius), 1e-9 * kUm * kUm);
  EXPECT_EQ(std::count(w.film.begin(), w.film.end(), FilmPixel::Film), static_cast<long>(full + 1));
}

// Between two trenches a film goes into the one that is lower, though its centre lies over the
// other.
TEST(WettingByHand, AFilmBeginsAtTheLowestPlaceOfItsDisc) {
  Gap gap = flat_gap(400e-9);
  for (int ix = 0; ix < kPatch.nx; ++ix) {
    for (int iy = 46; iy < 53; ++iy) gap.value[kPatch.index(ix, iy)] = 60e-9;
    for (int iy = 55; iy < 59; ++iy) gap.value[kPatch.index(ix, iy)] = 50e-9;
  }
  Settled s(gap);
  s.add(6, 4.95, 0.2e-18);
  ASSERT_TRUE(s.drops[0].bridge);
  ASSERT_GT(s.drops[0].radius, 0.61 * kUm);  // up to pixels of row 55, 0.6 um away
  DropletOptions options;
  options.film_width = 0.1 * kUm;
  const Wetting w = s.wetting(options);
  // 4 rows of 120 pixels of 50 nm hold 0.24 um3: 400 pixels of them are wet.
  EXPECT_EQ(w.droplets.at(0).film, 1);
  EXPECT_NEAR(w.wetted_fraction, 400.0 / 12000, 1e-9);
  for (std::size_t k = 0; k < kPatch.size(); ++k) {
    const std::size_t row = k / 120;
    ASSERT_TRUE(w.film[k] == FilmPixel::None || (row >= 55 && row < 59)) << row;
  }
}

// On the way the joined drop counts as its disc by what is left of it.
TEST(WettingByHand, WhatAFilmOnItsWayTakesInCountsAsItsDiscByTheRest) {
  Trench t;
  DropletOptions options;
  options.film_width = 2 * t.drops[0].radius / 1.2;
  options.film_area = 10;
  const double share = blend(1.2);
  ASSERT_GT(share, 0.9);
  const std::vector<Drop> before = t.drops;
  const Wetting w = t.wetting(options);
  ASSERT_EQ(w.droplets[1].film, 1);
  const double joined = t.energy.force(before[1]);
  EXPECT_NEAR(w.droplets[1].force, (1 - share) * joined, 1e-9 * joined);
  EXPECT_NEAR(capillary_traction(w, t.gap, {}).mean() * kPatch.area(), w.capillary_force,
              1e-10 * w.capillary_force);
  // Grown anew: seeds at the lowest level inside the disc; the two small drops are met on the way.
  const FilmSource source{before[0].x,        before[0].y,      before[0].radius,
                          before[0].edge_gap, before[0].volume, share};
  std::size_t seed = 0;
  double lowest = 1;
  for (std::size_t k = 0; k < kPatch.size(); ++k) {
    const double rho2 = square_distance(kPatch, k, before[0].x, before[0].y);
    const double level = film_level(source, rho2, t.gap.value[k]);
    if (rho2 < square(before[0].radius) && level < lowest) lowest = level, seed = k;
  }
  std::vector<bool> met(4);
  const FilmRegions films = grow_films(t.gap, {source}, {seed}, {}, [&](std::size_t k, int) {
    for (const int i : {1, 2}) {
      const bool reached =
          i == 1 ? square_distance(kPatch, k, before[1].x, before[1].y) < square(before[1].radius)
                 : k == pixel_of(kPatch, before[2].x, before[2].y);
      if (reached && !met[i]) {
        met[i] = true;
        return before[i].volume;
      }
    }
    return 0.0;
  });
  const FilmRegion& region = films.regions.at(0);
  EXPECT_NEAR(region.share, share, 1e-9);
  const double force = share * region.force +
                       (1 - share) * (t.energy.force(before[0]) + t.energy.force(before[1])) +
                       t.energy.force(before[3]);
  EXPECT_NEAR(w.capillary_force, force, 1e-9 * force);
  const double retention =
      share * region.retention + t.energy.retention(before[3]) +
      (1 - share) * (t.energy.retention(before[0]) + t.energy.retention(before[1]));
  EXPECT_NEAR(w.retention, retention, 1e-9 * retention);
  const double area = share * region.area + kPi * square(before[3].radius) +
                      (1 - share) * kPi * (square(before[0].radius) + square(before[1].radius));
  EXPECT_NEAR(w.wetted_fraction, area / kPatch.area(), 1e-9 * area / kPatch.area());
  EXPECT_TRUE(met[1]);
  EXPECT_EQ(met[2], w.droplets[2].film == 1);
  EXPECT_NEAR(w.bridge_volume, region.volume + before[3].volume, 1e-12 * w.bridge_volume);
  for (std::size_t k = 0; k < kPatch.size(); ++k)
    ASSERT_EQ(w.film[k], films.source[k] ? FilmPixel::OnItsWay : FilmPixel::None);
}

// --- all of settling and rewetting ---

TEST(WettingByHand, ScatteredDropletsAreTheStreamsNumbers) {
  DropletOptions options;
  options.drops_per_volume = 10e18;
  const double volume = 0.34e-18;  // 3.4: three drops
  const std::vector<DropletSeed> got = scatter_droplets(kPatch, volume, options, 17, 5);
  ASSERT_EQ(got.size(), 3u);
  RandomStream random(17, "droplets", 5);
  std::vector<DropletSeed> want(3);
  double sum = 0;
  for (DropletSeed& d : want) {
    d.x = 12 * kUm * random.uniform();
    d.y = 10 * kUm * random.uniform();
    d.volume = 1 - random.uniform();
    sum += d.volume;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(got[i].x, want[i].x, 1e-20);
    EXPECT_NEAR(got[i].y, want[i].y, 1e-20);
    EXPECT_NEAR(got[i].volume, volume * want[i].volume / sum, 1e-32);
  }
}

TEST(WettingByHand, ThereAreAsManyDropletsAsTheWaterSays) {
  DropletOptions options;
  options.drops_per_volume = 10e18;
  const auto count = [&](double volume) {
    return scatter_droplets(kPatch, volume, options, 1, 0).size();
  };
  EXPECT_EQ(count(0), 0u);
  EXPECT_EQ(count(1e-25), 1u);
  EXPECT_EQ(count(0.149e-18), 1u);
  EXPECT_EQ(count(0.151e-18), 2u);
  EXPECT_EQ(count(0.249e-18), 2u);
  EXPECT_EQ(count(100e-18), 1000u);
  EXPECT_EQ(count(1), 1000000u);
  EXPECT_ANY_THROW(count(-1e-30));
  EXPECT_ANY_THROW(count(kInfinity));
  EXPECT_ANY_THROW(count(std::numeric_limits<double>::quiet_NaN()));
}

TEST(WettingByHand, WaterThatTheGapDoesNotHoldFloodsIt) {
  const double all = kGap * kPatch.area();
  SettleReport report;
  report.moves = 5;
  const Wetting w = settle_droplets(flat_gap(), {{kUm, kUm, 0.5 * all}, {kUm, kUm, 0.501 * all}},
                                    {}, {}, &report);
  EXPECT_EQ(w.status, WettingStatus::Flooded);
  EXPECT_NEAR(w.volume, 1.001 * all, 1e-12 * all);
  EXPECT_EQ(report.moves, 0);
  const Wetting less =
      settle_droplets(flat_gap(), {{kUm, kUm, 0.5 * all}, {kUm, kUm, 0.499 * all}}, {}, at_rest());
  EXPECT_EQ(less.status, WettingStatus::Film);
  const Wetting dry = settle_droplets(flat_gap(), std::vector<DropletSeed>{}, {}, {}, &report);
  EXPECT_EQ(dry.status, WettingStatus::Dry);
  EXPECT_TRUE(dry.grid == kPatch);
}

TEST(WettingByHand, RewettingKeepsPlacesAndVolumesAndFloatingShapes) {
  Settled s;
  s.add(3, 4, disc(0.5 * kUm));
  s.add(8, 4, cube(60e-9));
  Wetting w = s.wetting();
  w.wicked_volume = 2;
  w.volume = 9;
  // A gap of 80 nm and a surface of 30 deg: the bridge is wider, the cap keeps its shape and
  // energy.
  WaterProperties lower;
  lower.theta_substrate = 30 * kPi / 180;
  const Wetting on = rewet(w, flat_gap(80e-9), lower);
  ASSERT_EQ(on.droplets.size(), 2u);
  EXPECT_EQ(on.volume, 9);
  EXPECT_EQ(on.wicked_volume, 2);
  EXPECT_NEAR(on.droplets[0].radius, 0.5 * kUm * std::sqrt(1.25), 1e-15);
  DropEnergy anew(flat_gap(80e-9), lower, 0.3e-9);
  const Drop there = anew.kept(3 * kUm, 4 * kUm, disc(0.5 * kUm), 0);
  EXPECT_NEAR(on.droplets[0].energy, there.energy, 1e-9 * std::abs(there.energy));
  EXPECT_NEAR(on.capillary_force, anew.force(there), 1e-9 * on.capillary_force);
  EXPECT_EQ(on.droplets[1].state, DropletState::OnSubstrate);
  EXPECT_EQ(on.droplets[1].x, 8 * kUm);
  EXPECT_EQ(on.droplets[1].y, 4 * kUm);
  EXPECT_EQ(on.droplets[1].volume, w.droplets[1].volume);
  EXPECT_EQ(on.droplets[1].energy, w.droplets[1].energy);
  EXPECT_EQ(on.droplets[1].radius, w.droplets[1].radius);
  EXPECT_EQ(on.droplets[1].height, w.droplets[1].height);
  // A skin that comes down to the height of the cap is touched by it.
  const double height = w.droplets[1].height;
  EXPECT_EQ(rewet(w, flat_gap(0.999 * height), {}).droplets[1].state, DropletState::Bridge);
  EXPECT_EQ(rewet(w, flat_gap(1.001 * height), {}).droplets[1].state, DropletState::OnSubstrate);
  // A bridge stays up to its rupture at 0.994 of its size.
  const double size = std::cbrt(disc(0.5 * kUm));
  EXPECT_EQ(rewet(w, flat_gap(0.95 * size), {}).bridges, 1);
  EXPECT_EQ(rewet(w, flat_gap(1.05 * size), {}).bridges, 0);
  // Discs that now overlap are one; what has become film stays film.
  Settled two;
  two.add(3, 4, disc(0.5 * kUm));
  two.add(4.1, 4, disc(0.5 * kUm));
  EXPECT_EQ(rewet(two.wetting(), flat_gap(), {}).droplets.size(), 2u);
  EXPECT_EQ(rewet(two.wetting(), flat_gap(70e-9), {}).droplets.size(), 1u);
  Wetting film = two.wetting();
  film.droplets[0].film = film.droplets[1].film = 1;
  EXPECT_EQ(rewet(film, flat_gap(70e-9), {}).droplets.size(), 2u);
}

// The side of the lower angle is where a cap was laid down, not where one would be laid now.
TEST(WettingByHand, RewettingLeavesACapOnItsSide) {
  WaterProperties rest, driven;  // 80 deg on the skin
  rest.theta_substrate = 90 * kPi / 180;
  driven.theta_substrate = 68 * kPi / 180;
  const Wetting off =
      settle_droplets(flat_gap(), {{8 * kUm, 4 * kUm, cube(60e-9)}}, rest, at_rest());
  ASSERT_EQ(off.droplets.at(0).state, DropletState::OnSkin);
  const Droplet on = rewet(off, flat_gap(), driven).droplets.at(0);
  EXPECT_EQ(on.state, DropletState::OnSkin);
  EXPECT_EQ(on.radius, off.droplets[0].radius);
  EXPECT_EQ(on.height, off.droplets[0].height);
}

// Caps of more than 90 deg are wider than their feet.
TEST(WettingByHand, RewettingMergesCapsWhereTheyAreWidest) {
  WaterProperties water;
  water.theta_skin = water.theta_substrate = 110 * kPi / 180;
  const double size = 60e-9;
  const CapShape cap = cap_shape(water.theta_skin);
  Wetting w =
      settle_droplets(flat_gap(), {{4 * kUm, 4 * kUm, cube(size)}, {8 * kUm, 4 * kUm, cube(size)}},
                      water, at_rest());
  ASSERT_EQ(w.droplets.size(), 2u);
  ASSERT_NE(w.droplets[0].state, DropletState::Bridge);
  w.droplets[1].x = w.droplets[0].x + 2.001 * size * cap.widest;
  EXPECT_EQ(rewet(w, flat_gap(), water).droplets.size(), 2u);
  w.droplets[1].x = w.droplets[0].x + size * (cap.footprint + cap.widest);
  EXPECT_EQ(rewet(w, flat_gap(), water).droplets.size(), 1u);
}

TEST(WettingByHand, ThresholdWaterIsFilledAnew) {
  const Wetting w = fill_threshold(flat_gap(), 0.3 * kGap * kPatch.area(), {});
  const Wetting on = rewet(w, flat_gap(50e-9), {});
  EXPECT_EQ(on.status, WettingStatus::Film);
  EXPECT_NEAR(on.wetted_fraction, 0.6, 1e-9);
  EXPECT_EQ(rewet(w, flat_gap(20e-9), {}).status, WettingStatus::Flooded);
  EXPECT_EQ(rewet(Wetting{}, flat_gap(), {}).status, WettingStatus::Dry);
}

TEST(WettingByHand, TractionIsTheForceOverThePixelsOfEachBridge) {
  Wetting w;
  w.grid = Grid{4, 3, 8, 9};
  w.droplets.resize(5);
  for (Droplet& d : w.droplets) d.state = DropletState::Bridge;
  w.droplets[0] = {.x = 1,
                   .y = 1.5,
                   .state = DropletState::Bridge,
                   .radius = 2.1,
                   .force = 18};  // pixels 3, 0, 1
  w.droplets[1] = {
      .x = 5.5, .y = 4.5, .state = DropletState::Bridge, .radius = 0.1, .force = -6};  // none: 6
  w.droplets[2] = {.x = 1, .y = 7.5, .state = DropletState::OnSubstrate, .radius = 1, .force = 50};
  // What of a bridge on its way to a film is still a disc: pixel 8.
  w.droplets[3] = {
      .x = 1, .y = 7.5, .state = DropletState::Bridge, .radius = 1, .force = 12, .film = 0.1};
  w.droplets[4] = {
      .x = 3, .y = 1.5, .state = DropletState::Bridge, .radius = 1, .force = 4};  // pixel 1
  const Gap gap{w.grid, std::vector<double>(12, 1)};
  // Pixels of 2 x 3: 18 / (3 x 6) each, -6 / 6, 12 / 6, 4 / 6 more.
  std::vector<double> want(12, 0);
  want[3] = want[0] = want[1] = 1;
  want[6] = -1;
  want[8] = 2;
  want[1] += 4.0 / 6;
  const Traction discs = capillary_traction(w, gap, {});
  ASSERT_EQ(discs.value.size(), 12u);
  EXPECT_TRUE(discs.grid == w.grid);
  for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(discs.value[k], want[k], 1e-12) << k;
  // The regions of a film, each with a pressure of its own.
  w.film_region = {0, 1, 0, 0, 0, 0, 0, 0, 2, 2, 0, 0};
  w.film_pressure = {7, -3};
  const Traction all = capillary_traction(w, gap, {});
  want[1] += 7;
  want[8] -= 3;
  want[9] -= 3;
  for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(all.value[k], want[k], 1e-12) << k;
}

// Where the hand-over to a film begins, each bridge still pulls where it did: no pixel steps.
TEST(WettingByHand, BridgesThatBeginToBeFilmPullOnTheirOwnPixels) {
  Gap gap = flat_gap();  // 60 nm on the right
  for (std::size_t k = 0; k < kPatch.size(); ++k) gap.value[k] = k % 120 < 60 ? kGap : 0.6 * kGap;
  const auto wetting = [&](double film_width) {
    Settled s(gap);
    s.add(3, 4, disc(1 * kUm));
    s.add(9, 4, 0.6 * disc(1 * kUm));
    DropletOptions options;
    options.film_width = film_width;
    return s.wetting(options);
  };
  const Wetting discs = wetting(50 * kUm);
  const double t = 5.7746e-4;  // t^2 (3 - 2 t) = 1e-6
  const Wetting films = wetting(2 * kUm / (0.8 + 0.45 * t));
  ASSERT_EQ(discs.status, WettingStatus::Discs);
  ASSERT_EQ(films.status, WettingStatus::Film);
  for (const Droplet& d : films.droplets) ASSERT_NEAR(d.film, 1e-6, 1e-8);
  const Traction before = capillary_traction(discs, gap, {});
  const Traction after = capillary_traction(films, gap, {});
  const double left = before.value[kPatch.index(30, 40)],
               right = before.value[kPatch.index(90, 40)];
  ASSERT_GT(right, 1.3 * left);
  for (std::size_t k = 0; k < kPatch.size(); ++k)
    ASSERT_NEAR(after.value[k], before.value[k], 1e-4 * left) << k;
  EXPECT_NEAR(after.mean() * kPatch.area(), films.capillary_force, 1e-10 * films.capillary_force);
}

TEST(WettingByHand, EachRegionOfAFilmPullsOnItsOwnPixels) {
  // Two bowls, of 100 nm on the left and of 60 nm on the right.
  Gap gap = flat_gap();
  for (std::size_t k = 0; k < kPatch.size(); ++k) {
    const bool left = k % 120 < 60;
    gap.value[k] = (left ? kGap : 0.6 * kGap) +
                   2e4 * square_distance(kPatch, k, (left ? 3 : 9) * kUm, 4 * kUm);
  }
  DropletOptions options;
  options.film_width = 1 * kUm;
  const auto wetting = [&](bool left, bool right) {
    Settled s(gap);
    if (left) s.add(3, 4, disc(1 * kUm));
    if (right) s.add(9, 4, disc(1 * kUm));
    return s.wetting(options);
  };
  const Wetting both = wetting(true, true);
  for (const Droplet& d : both.droplets) ASSERT_EQ(d.film, 1);
  ASSERT_EQ(both.bridges, 2);
  const Traction t = capillary_traction(both, gap, {});
  for (const bool left : {true, false}) {
    const double force = wetting(left, !left).capillary_force;
    const auto here = [&](std::size_t k) { return (k % 120 < 60) == left; };
    double pixels = 0;
    for (std::size_t k = 0; k < kPatch.size(); ++k)
      pixels += here(k) && both.film[k] != FilmPixel::None;
    const double pressure = force / (pixels * kPatch.pixel_area());
    for (std::size_t k = 0; k < kPatch.size(); ++k) {
      if (!here(k)) continue;
      const double want = both.film[k] != FilmPixel::None ? pressure : 0;
      ASSERT_NEAR(t.value[k], want, 1e-9 * pressure) << k;
    }
  }
  EXPECT_NEAR(t.mean() * kPatch.area(), both.capillary_force, 1e-10 * both.capillary_force);
}

}  // namespace
}  // namespace papilla::tests::wetting_by_hand_test
