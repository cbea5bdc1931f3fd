// Wide bridges on their way from disc to film.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/capillary/droplets.h"
#include "physics/electrostatics/field.h"

namespace papilla::tests::film_test {
namespace {

constexpr double kPatch = 12e-6;

// A periodic sum of cosines of random phases above a lowest gap of 50 nm.
Gap rough_gap(double rms, std::uint64_t seed) {
  const int n = 128;
  const Grid g{n, n, kPatch, kPatch};
  std::vector<double> z(g.size(), 0.0);
  RandomStream random(seed, "test gap");
  double power = 0;
  for (int ky = 0; ky <= 6; ++ky) {
    for (int kx = -6; kx <= 6; ++kx) {
      if (ky == 0 && kx <= 0) continue;
      const double a = std::pow(9 + kx * kx + ky * ky, -0.9) * random.normal();
      const double phase = random.uniform(0, 2 * kPi);
      power += 0.5 * a * a;
      for (int iy = 0; iy < n; ++iy) {
        for (int ix = 0; ix < n; ++ix) {
          z[g.index(ix, iy)] += a * std::cos(2 * kPi * (kx * ix + ky * iy) / n + phase);
        }
      }
    }
  }
  const double lowest = *std::min_element(z.begin(), z.end());
  for (double& v : z) v = 50e-9 + (v - lowest) * rms / std::sqrt(power);
  return {g, z};
}

// Droplets of one volume on a square lattice, the first above the lowest place; they stay there.
std::vector<DropletSeed> lattice(const Gap& gap, int rows, double volume) {
  const auto low = static_cast<std::size_t>(std::min_element(gap.value.begin(), gap.value.end()) -
                                            gap.value.begin());
  const int n = gap.grid.nx;
  std::vector<DropletSeed> out;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < rows; ++i) {
      out.push_back({std::fmod(gap.grid.x(static_cast<int>(low % n)) + i * kPatch / rows, kPatch),
                     std::fmod(gap.grid.y(static_cast<int>(low / n)) + j * kPatch / rows, kPatch),
                     volume});
    }
  }
  return out;
}

DropletOptions at_rest() {
  DropletOptions options;
  options.max_moves = 0;
  return options;
}

double film_share(const Wetting& w) {
  double share = 0;
  for (const Droplet& d : w.droplets) share = std::max(share, d.film);
  return share;
}

TEST(Film, ForceIsContinuousWhereAWideBridgeBecomesOne) {
  // One bridge on six rough gaps, its water raised by 1 % a step through the hand-over. What is
  // left of a step is the film's own: it spills over a saddle into the next hollow.
  std::vector<double> steps, own, gains;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Gap gap = rough_gap(150e-9, seed);
    DropletOptions discs = at_rest(), films = at_rest();
    discs.film_width = discs.film_area = 10;
    films.film_width = 0.1e-6;
    double last = 0, last_film = 0;
    bool started = false;
    for (double v = 1e-18; v < 20e-18; v *= 1.01) {
      const Wetting w = settle_droplets(gap, lattice(gap, 1, v), {}, at_rest());
      const double share = film_share(w);
      if (share > 0) {
        ASSERT_GT(last, 0);  // the sweep begins with a disc
        const double step = std::abs(w.capillary_force / last - 1);
        if (!started) {
          EXPECT_LT(step, 0.03) << seed;
        }
        started = true;
        steps.push_back(step);
        const double film = settle_droplets(gap, lattice(gap, 1, v), {}, films).capillary_force;
        if (last_film > 0) own.push_back(std::abs(film / last_film - 1));
        last_film = film;
      }
      last = w.capillary_force;
      if (share == 1) {
        const Wetting disc = settle_droplets(gap, lattice(gap, 1, v), {}, discs);
        gains.push_back(w.capillary_force / disc.capillary_force);
        break;
      }
    }
  }
  ASSERT_EQ(gains.size(), 6u);
  std::sort(steps.begin(), steps.end());
  std::sort(own.begin(), own.end());
  // All at once it would be a step of 90 to 200 %.
  EXPECT_GT(*std::min_element(gains.begin(), gains.end()), 1.5);
  EXPECT_LT(steps[steps.size() / 2], 0.015);
  EXPECT_LT(steps[steps.size() * 95 / 100], 0.05);
  EXPECT_LT(steps.back(), 0.2);
  EXPECT_LT(own.back(), 0.1);
}

TEST(Film, ForceIsContinuousWhereTheWettedAreaHandsOver) {
  std::vector<double> steps, gains;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Gap gap = rough_gap(20e-9, seed);
    DropletOptions discs = at_rest();
    discs.film_width = discs.film_area = 10;
    double last = 0;
    for (double v = 0.02e-18; v < 1e-18; v *= 1.01) {
      const Wetting w = settle_droplets(gap, lattice(gap, 6, v), {}, at_rest());
      const double share = film_share(w);
      if (share > 0) {
        ASSERT_GT(last, 0);
        const double step = std::abs(w.capillary_force / last - 1);
        steps.push_back(step);
      }
      last = w.capillary_force;
      if (share == 1) {
        const Wetting disc = settle_droplets(gap, lattice(gap, 6, v), {}, discs);
        gains.push_back(w.capillary_force / disc.capillary_force);
        break;
      }
    }
  }
  ASSERT_EQ(gains.size(), 2u);
  std::sort(steps.begin(), steps.end());
  EXPECT_LT(steps.back(), 0.03);
  for (double gain : gains) EXPECT_GT(gain, 1.03);
}

TEST(Film, ThePullOfTheFieldIsContinuousToo) {
  FieldProblem field;
  field.v_rms = 100;
  field.dielectric = 0.2e-6;
  std::vector<double> steps;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Gap gap = rough_gap(150e-9, seed);
    // Two bridges, one of them wide.
    std::vector<DropletSeed> drops = lattice(gap, 1, 0);
    const double x = drops[0].x, y = drops[0].y;
    drops.push_back({std::fmod(x + kPatch / 2, kPatch), std::fmod(y + kPatch / 2, kPatch), 1e-18});
    double last = 0, share = 0;
    for (double v = 1.5e-18; v < 20e-18 && share < 1; v *= 1.02) {
      drops[0].volume = v;
      const Wetting w = settle_droplets(gap, drops, {}, at_rest());
      const double pull = solve_local_field(gap, nullptr, w, field).mean_pressure;
      share = film_share(w);
      if (last > 0) steps.push_back(std::abs(pull / last - 1));
      last = pull;
    }
    EXPECT_EQ(share, 1);
  }
  std::sort(steps.begin(), steps.end());
  EXPECT_LT(steps[steps.size() * 95 / 100], 0.03);
  EXPECT_LT(steps.back(), 0.15);
}

TEST(Film, WithMovingDropletsOnlyTheirJumpsAreLargerSteps) {
  DropletOptions discs;
  discs.film_width = discs.film_area = 10;
  std::vector<double> steps;
  int jumps = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Gap gap = rough_gap(150e-9, seed);
    double last = 0, last_disc = 0, last_share = 0;
    for (double v = 3e-18; v < 20e-18 && last_share < 1; v *= 1.01) {
      const Wetting w = settle_droplets(gap, lattice(gap, 1, v), {}, {});
      const double disc = settle_droplets(gap, lattice(gap, 1, v), {}, discs).capillary_force;
      const double share = film_share(w);
      if (last > 0 && share > 0) {
        // A droplet that settles in another place: a step of discs as well, or back in the blend.
        const bool jump =
            std::abs(disc / last_disc - 1) > 0.03 || std::abs(share - last_share) > 0.05;
        const double step = std::abs(w.capillary_force / last - 1);
        jumps += jump;
        if (!jump) steps.push_back(step);
      }
      last = w.capillary_force;
      last_disc = disc;
      last_share = share;
    }
    EXPECT_EQ(last_share, 1) << seed;
  }
  std::sort(steps.begin(), steps.end());
  EXPECT_LT(jumps, 0.05 * static_cast<double>(steps.size()));
  EXPECT_LT(steps[steps.size() / 2], 0.015);
  EXPECT_LT(steps[steps.size() * 95 / 100], 0.05);
  EXPECT_LT(steps.back(), 0.20);  // Eq. capillary.23
}

TEST(Film, NoWaterIsLostOnTheWayAndRewettingKeepsIt) {
  const Gap gap = rough_gap(150e-9, 2);
  for (double v : {2.5e-18, 4e-18, 6e-18, 9e-18}) {
    const Wetting w = settle_droplets(gap, v, {}, {}, 3, 0);
    double sum = 0, bridges = 0;
    for (const Droplet& d : w.droplets) {
      sum += d.volume;
      bridges += d.state == DropletState::Bridge ? d.volume : 0;
    }
    EXPECT_NEAR(sum, v, 1e-12 * v);
    EXPECT_NEAR(bridges, w.bridge_volume, 1e-12 * v);
    const Wetting again = rewet(w, gap, {});
    EXPECT_EQ(again.status, w.status);
    EXPECT_NEAR(again.capillary_force, w.capillary_force, 1e-6 * std::abs(w.capillary_force)) << v;
    EXPECT_EQ(again.bridged, w.bridged);
    const Traction t = capillary_traction(w, gap, {});
    EXPECT_NEAR(t.mean() * gap.grid.area(), w.capillary_force, 1e-9 * w.capillary_force);
  }
}

}  // namespace
}  // namespace papilla::tests::film_test
