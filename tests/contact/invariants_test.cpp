// What no contact may depend on: where its patch is cut, which side is called x, in which units it
// is written, by which solver. And what each wrong input is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/constants.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"

namespace papilla::tests::invariants_test {
namespace {

const LayeredSolid kSkin{60e6, 0.45, 1e-6, 20e6, 0.49};
constexpr Grid kGrid{96, 64, 9e-6, 8e-6};  // oblong pixels
constexpr double kLoad = 2e5;

std::vector<double> heights() { return random_surface({1e-7, 3e-6, 0.8, 4e-7}, kGrid, 1, 3).z; }

// A pull that is stronger to one side.
std::vector<double> tractions() {
  std::vector<double> out(kGrid.size());
  for (int iy = 0; iy < kGrid.ny; ++iy) {
    for (int ix = 0; ix < kGrid.nx; ++ix) out[kGrid.index(ix, iy)] = 1e5 * ix / kGrid.nx;
  }
  return out;
}

using Place = std::function<std::size_t(int ix, int iy)>;  // on kGrid

std::vector<double> moved(const Grid& grid, const std::vector<double>& field, const Place& from) {
  std::vector<double> out(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) out[grid.index(ix, iy)] = field[from(ix, iy)];
  }
  return out;
}

ContactSolution solved(const Grid& grid, const LayeredSolid& solid, const std::vector<double>& h,
                       double load, const std::vector<double>& pull,
                       ContactMethod method = ContactMethod::Dense) {
  const ContactKernel kernel(grid, solid);
  return solve_contact(kernel, h, load, pull, {.tolerance = 1e-11, .method = method});
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  EXPECT_LT(most, tolerance);
}

double largest(const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); }

TEST(ContactInvariants, ATurnedMirroredOrMovedPatchIsTheSameContact) {
  const std::vector<double> h = heights(), t = tractions();
  const ContactSolution own = solved(kGrid, kSkin, h, kLoad, t);
  ASSERT_TRUE(own.converged()) << own.reason;
  const ContactArea area = measure_area(ContactKernel(kGrid, kSkin), own);
  ASSERT_GT(area.raw, 0.02);
  const Grid turned{kGrid.ny, kGrid.nx, kGrid.ly, kGrid.lx};
  struct Case {
    Grid grid;
    Place from;
  };
  for (const Case& c :
       {Case{turned, [](int ix, int iy) { return kGrid.index(iy, ix); }},
        Case{kGrid, [](int ix, int iy) { return kGrid.index(95 - ix, iy); }},
        Case{kGrid, [](int ix, int iy) { return kGrid.index(ix, 63 - iy); }},
        Case{kGrid, [](int ix, int iy) { return kGrid.index((ix + 40) % 96, (iy + 25) % 64); }}}) {
    const ContactSolution other =
        solved(c.grid, kSkin, moved(c.grid, h, c.from), kLoad, moved(c.grid, t, c.from));
    ASSERT_TRUE(other.converged()) << other.reason;
    expect_same(other.pressure, moved(c.grid, own.pressure, c.from), 2e-4 * largest(own.pressure));
    expect_same(other.gap, moved(c.grid, own.gap, c.from), 2e-4 * largest(own.gap));
    EXPECT_NEAR(other.elastic_energy, own.elastic_energy, 1e-6 * own.elastic_energy);
    const ContactArea again = measure_area(ContactKernel(c.grid, kSkin), other);
    EXPECT_NEAR(again.raw, area.raw, 3.0 / 6144);
    EXPECT_NEAR(again.near_edge, area.near_edge, 3e-3 * area.near_edge);
    EXPECT_NEAR(again.perimeter, area.perimeter, 3e-3);
    EXPECT_NEAR(again.se, area.se, 0.05 * area.se);
  }
}

// Lengths times two, moduli times three: pressures times three, gaps times two, energy times 24.
TEST(ContactInvariants, UnitsOfLengthAndForceCancel) {
  const std::vector<double> h = heights(), t = tractions();
  const ContactSolution own = solved(kGrid, kSkin, h, kLoad, t);
  Grid large = kGrid;
  large.lx *= 2, large.ly *= 2;
  LayeredSolid stiff = kSkin;
  stiff.layer_modulus *= 3, stiff.bulk_modulus *= 3, stiff.layer_thickness *= 2;
  std::vector<double> high = h, strong = t;
  for (double& v : high) v *= 2;
  for (double& v : strong) v *= 3;
  const ContactSolution other = solved(large, stiff, high, 3 * kLoad, strong);
  std::vector<double> pressure = other.pressure, gap = other.gap;
  for (double& v : pressure) v /= 3;
  for (double& v : gap) v /= 2;
  expect_same(pressure, own.pressure, 2e-4 * largest(own.pressure));
  expect_same(gap, own.gap, 2e-4 * largest(own.gap));
  EXPECT_NEAR(other.shift, 2 * own.shift, 1e-6 * std::abs(own.shift));
  EXPECT_NEAR(other.elastic_energy, 24 * own.elastic_energy, 1e-5 * 24 * own.elastic_energy);
}

TEST(ContactInvariants, BothSolversAndBothControlsFindTheSame) {
  constexpr double kLight = 1e4;  // the sparse solver gives up where much touches
  const std::vector<double> h = heights();
  const ContactSolution dense = solved(kGrid, kSkin, h, kLight, {}),
                        sparse = solved(kGrid, kSkin, h, kLight, {}, ContactMethod::Sparse);
  EXPECT_EQ(sparse.method, ContactMethod::Sparse);
  EXPECT_EQ(dense.method, ContactMethod::Dense);
  expect_same(sparse.pressure, dense.pressure, 2e-4 * largest(dense.pressure));
  EXPECT_NEAR(sparse.shift, dense.shift, 1e-12);
  // Heights that are raised all alike come nearer by as much.
  std::vector<double> raised = h;
  for (double& v : raised) v += 5e-8;
  const ContactSolution up = solved(kGrid, kSkin, raised, kLight, {});
  expect_same(up.pressure, dense.pressure, 2e-4 * largest(dense.pressure));
  EXPECT_NEAR(up.shift, dense.shift - 5e-8, 1e-12);
  // By its approach beyond first touch instead of its load.
  const ContactKernel kernel(kGrid, kSkin);
  const double approach = dense.shift + largest(h);
  const ContactSolution pushed = solve_approach(kernel, h, approach, {.tolerance = 1e-11});
  ASSERT_TRUE(pushed.converged()) << pushed.reason;
  double mean = 0;
  for (const double p : pushed.pressure) mean += p / static_cast<double>(kGrid.size());
  EXPECT_NEAR(mean, kLight, 1e-4 * kLight);
  expect_same(pushed.pressure, dense.pressure, 1e-3 * largest(dense.pressure));
}

// A solution lies above no other: energy and tractions of a state that the gaps give back.
TEST(ContactInvariants, GapsAreTheHeightsLessWhatThePressureMoves) {
  const std::vector<double> h = heights(), t = tractions();
  const ContactKernel kernel(kGrid, kSkin);
  const ContactSolution s = solve_contact(kernel, h, kLoad, t, {.tolerance = 1e-11});
  RealArray net(kGrid.size()), rise;
  for (std::size_t i = 0; i < net.size(); ++i) net[i] = s.pressure[i] - t[i];
  rise.resize(net.size());
  SpectrumArray scratch(kernel.scratch_size());
  kernel.displace(net, rise, scratch);
  double energy = 0;
  for (std::size_t i = 0; i < net.size(); ++i) {
    ASSERT_NEAR(s.gap[i], rise[i] - h[i] - s.shift, 1e-11) << i;
    energy += 0.5 * net[i] * rise[i] * kGrid.pixel_area();
  }
  EXPECT_NEAR(s.elastic_energy, energy, 1e-6 * energy);
  // The pressure that moves the plane so is the way back.
  RealArray back = rise;
  kernel.press(back, scratch);
  const double mean = kLoad;  // of the net pressure: the pull is carried too
  for (std::size_t i = 0; i < net.size(); ++i)
    ASSERT_NEAR(back[i], net[i] - mean, 1e-8 * largest(s.pressure)) << i;
}

TEST(ContactModulus, IsThatOfTheSurfacesThatTouch) {
  const auto modulus = [](const LayeredSolid& s) {
    return ContactKernel({32, 32, 1e-6, 1e-6}, s).contact_modulus();
  };
  const LayeredSolid layer{60e6, 0.45, 1e-6, 20e6, 0.3};
  EXPECT_NEAR(modulus(layer), 60e6 / (1 - square(0.45)), 1);
  LayeredSolid bulk = layer;
  bulk.layer_thickness = 0;
  EXPECT_NEAR(modulus(bulk), 20e6 / (1 - square(0.3)), 1);
  LayeredSolid both = layer;
  both.counter_modulus = 5e6, both.counter_poisson = 0.35;
  EXPECT_NEAR(modulus(both), 1 / ((1 - square(0.45)) / 60e6 + (1 - square(0.35)) / 5e6), 1);
  both.counter_thickness = 0;
  EXPECT_NEAR(modulus(both), 60e6 / (1 - square(0.45)), 1);
}

// A counter-body adds its own compliance: of a half-space 2 (1 - nu^2) / (E q), of a thin layer on
// what does not give d (1 + nu) (1 - 2 nu) / (E (1 - nu)).
TEST(ContactModulus, ACounterBodyGivesBesideTheSkin) {
  LayeredSolid both = kSkin;
  both.counter_modulus = 5e6, both.counter_poisson = 0.3;
  for (const double q : {1e4, 1e6, 1e8}) {
    const double own = compliance(kSkin, q), counter = 2 * (1 - 0.09) / (5e6 * q);
    EXPECT_NEAR(compliance(both, q), own + counter, 1e-9 * (own + counter)) << q;
  }
  both.counter_thickness = 2e-7;
  const double thin = 2e-7 * 1.3 * 0.4 / (5e6 * 0.7);
  EXPECT_NEAR(compliance(both, 1e3) - compliance(kSkin, 1e3), thin, 1e-3 * thin);
}

TEST(ContactInput, EachMistakeIsRefusedAlone) {
  const ContactKernel kernel(kGrid, kSkin);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> h = heights(), t = tractions();
  const auto with = [](std::vector<double> v, double value) {
    v[7] = value;
    return v;
  };
  const std::vector<double> few(kGrid.size() - 1, 0.0);
  const auto status = [&](const std::vector<double>& height, double load,
                          const std::vector<double>& pull) {
    const ContactSolution s = solve_contact(kernel, height, load, pull, {});
    EXPECT_EQ(s.pressure.size(), kGrid.size());
    return s.status;
  };
  EXPECT_EQ(status(h, kLoad, t), ContactStatus::Converged);
  EXPECT_EQ(status(few, kLoad, t), ContactStatus::Invalid);
  EXPECT_EQ(status(h, kLoad, few), ContactStatus::Invalid);
  EXPECT_EQ(status(with(h, nan), kLoad, t), ContactStatus::Invalid);
  EXPECT_EQ(status(h, kLoad, with(t, nan)), ContactStatus::Invalid);
  EXPECT_EQ(status(h, kInfinity, t), ContactStatus::Invalid);
  const auto approached = [&](const std::vector<double>& height, double approach) {
    return solve_approach(kernel, height, approach, {});
  };
  EXPECT_EQ(approached(h, 1e-8).status, ContactStatus::Converged);
  EXPECT_EQ(approached(few, 1e-8).status, ContactStatus::Invalid);
  EXPECT_EQ(approached(with(h, nan), 1e-8).status, ContactStatus::Invalid);
  EXPECT_EQ(approached(h, nan).status, ContactStatus::Invalid);
  EXPECT_EQ(approached(h, kInfinity).status, ContactStatus::Invalid);
  // From first touch to the mean height, below the highest point.
  double mean = 0;
  for (const double z : h) mean += z / static_cast<double>(h.size());
  const double full = largest(h) - mean;
  EXPECT_EQ(approached(h, 0).status, ContactStatus::NoLoad);
  EXPECT_EQ(approached(h, -1e-9).status, ContactStatus::NoLoad);
  const std::vector<double> apart = approached(h, -1e-9).gap;
  EXPECT_NEAR(*std::min_element(apart.begin(), apart.end()), 1e-9, 1e-15);
  EXPECT_NE(approached(h, 0.999 * full).status, ContactStatus::Invalid);
  const ContactSolution beyond = approached(h, 1.001 * full);
  EXPECT_EQ(beyond.status, ContactStatus::Invalid);
  const std::size_t at = beyond.reason.find("reached at ");
  ASSERT_NE(at, std::string::npos) << beyond.reason;
  EXPECT_NEAR(std::stod(beyond.reason.substr(at + 11)), full, 1e-3 * full);
  // A load at the hardness or beyond is carried by nothing.
  const auto hard = [&](double load) {
    return solve_contact(kernel, h, load, {}, {.hardness = 1e6});
  };
  EXPECT_EQ(hard(1e6).status, ContactStatus::Invalid);
  EXPECT_NE(hard(1.5e6).reason.find("1.5e+06 Pa is beyond the hardness 1e+06 Pa"),
            std::string::npos);
}

// Areas of a stripe of whole pixels whose edges are written down here: pixels less 0.106 of their
// free sides; crossings at d of a pixel beyond the last centres, less 0.0187 of those sides.
TEST(AreaEstimators, OfAStripeAreTheirFormulas) {
  const Grid grid{40, 20, 4e-6, 6e-6};  // 100 x 300 nm
  const LayeredSolid solid{1, 0.5, 0, 12e6, 0.5};
  const ContactKernel kernel(grid, solid);
  const double modulus = 12e6 / 0.75;
  for (const bool upright : {true, false}) {
    const int width = 6, length = upright ? grid.ny : grid.nx;
    const double pixel = upright ? grid.dx() : grid.dy(), n = static_cast<double>(grid.size());
    for (const double d : {0.2, 0.5, 0.8}) {
      // Eq. contact.7: p = c sqrt(d), gap = 4c/(3E*) s^1.5 in units of the pixel.
      const double p = 1e5 * std::sqrt(d), gap = 4e5 / (3 * modulus) * std::pow(1 - d, 1.5) * pixel;
      ContactSolution s;
      s.pressure.assign(grid.size(), 0.0);
      s.gap.assign(grid.size(), gap);
      for (int iy = 0; iy < grid.ny; ++iy) {
        for (int ix = 0; ix < grid.nx; ++ix) {
          const int across = upright ? ix : iy;
          if (across < 3 || across >= 3 + width) continue;
          s.pressure[grid.index(ix, iy)] = p;
          s.gap[grid.index(ix, iy)] = 0;
        }
      }
      const ContactArea a = measure_area(kernel, s);
      const double pixels = width * length, edges = 2 * length;
      EXPECT_NEAR(a.raw, pixels / n, 1e-12);
      EXPECT_NEAR(a.perimeter, (pixels - 0.106 * edges) / n, 1e-12);
      EXPECT_NEAR(a.near_edge, ((width - 1 + 2 * d) * length - 0.0187 * edges) / n, 1e-9)
          << upright << d;
      const double chord = kPi * pixels / edges;
      EXPECT_NEAR(a.se,
                  std::hypot(0.07 * std::sqrt(edges) * (1 + 3.5 / chord) / n,
                             (0.001 + 0.075 / square(chord)) * a.near_edge,
                             0.5 * (a.near_edge - a.perimeter)),
                  1e-12);
      // At the cap of the pressure the edge is half way, and follows no square root.
      const ContactArea capped = measure_area(kernel, s, p);
      EXPECT_NEAR(capped.near_edge, pixels / n, 1e-9);
    }
  }
}

// One pixel, its hole, and two that touch at a corner: islands less holes turn by 2 pi each.
TEST(AreaEstimators, OfFewPixelsAreCountedByHand) {
  const Grid grid{12, 12, 1.2e-6, 1.2e-6};
  const ContactKernel kernel(grid, {1, 0.5, 0, 12e6, 0.5});
  const double modulus = 12e6 / 0.75, d = 0.5, p = 1e5 * std::sqrt(d),
               gap = 4e5 / (3 * modulus) * std::pow(1 - d, 1.5) * grid.dx();
  const auto area = [&](const std::vector<std::pair<int, int>>& pressed, bool inverted) {
    ContactSolution s;
    s.pressure.assign(grid.size(), inverted ? p : 0.0);
    s.gap.assign(grid.size(), inverted ? 0.0 : gap);
    for (const auto& [ix, iy] : pressed) {
      s.pressure[grid.index(ix, iy)] = inverted ? 0 : p;
      s.gap[grid.index(ix, iy)] = inverted ? gap : 0;
    }
    return 144 * measure_area(kernel, s).near_edge;
  };
  // A square on its corner of half diagonals d: 2 d^2 = 1/2; four free sides.
  const double diamond = 0.5, turn = kPi / 6;
  EXPECT_NEAR(area({{5, 5}}, false), diamond - 0.0187 * 4 + turn, 1e-9);
  EXPECT_NEAR(area({{0, 11}}, false), diamond - 0.0187 * 4 + turn, 1e-9);  // across the border
  EXPECT_NEAR(area({{5, 5}, {6, 5}}, false), 2 * d + diamond - 0.0187 * 6 + turn, 1e-9);
  // Two by their corners: joined, one island.
  EXPECT_NEAR(area({{5, 5}, {6, 6}}, false), 2 * diamond - 0.0187 * 8 + turn, 1e-9);
  EXPECT_NEAR(area({{5, 5}}, true), 144 - diamond - 0.0187 * 4 - turn, 1e-9);
}

}  // namespace
}  // namespace papilla::tests::invariants_test
