// Sweat in a gap of a file: between flat plates, where a bridge and a film have closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "cases/droplets.h"
#include "design/design.h"
#include "forward/forward.h"
#include "geometry/io/files.h"
#include "tests/temporary.h"

namespace papilla::tests::given_gaps_test {
namespace {

DropletCase of_gap(const std::string& name, const std::vector<double>& z) {
  Heightmap map;
  map.grid = {4, 4, 8e-6, 8e-6};
  map.z = z;
  const std::string file = temporary(name);
  write_npy(file, map);
  return droplets_of_file(file, 8e-6);
}

TEST(GivenGaps, AreThoseOfTheirFileAndNotBelowContact) {
  std::vector<double> z(16, 1e-6);
  z[5] = 0;
  z[6] = 3e-7;
  const DropletCase c = of_gap("gap.npy", z);
  EXPECT_EQ(c.gap.value, z);
  EXPECT_EQ(c.gap.grid.nx, 4);
  EXPECT_DOUBLE_EQ(c.gap.grid.lx, 8e-6);
  EXPECT_EQ(c.volume, 0);
  z[5] = -1e-9;
  EXPECT_THROW(of_gap("below.npy", z), InputError);
}

// Plates 1 um apart, a tenth of the gap full: threshold water is a level one, so at contact angles
// of 60 degrees it fills either nothing or all. Droplets: 6.4 um3, one for each.
TEST(GivenGaps, WaterIsThatOfItsModel) {
  std::vector<double> z;
  for (int i = 0; i < 16; ++i) z.push_back(1e-7 * (i + 1));
  DropletCase c = of_gap("wedge.npy", z);
  c.volume = 1e-18;
  c.water = {0.07, kPi / 3, kPi / 3, 0.3};
  c.how.drops_per_volume = 4e18;
  const DropletResult droplets = solve_droplets(c, WaterModel::Droplets, 3, 5);
  const Wetting own = settle_droplets(c.gap, 1e-18, c.water, c.how, 3, 5);
  EXPECT_EQ(droplets.wetting.capillary_force, own.capillary_force);
  EXPECT_EQ(droplets.wetting.bridges, own.bridges);
  EXPECT_EQ(droplets.report.initial_droplets, 4);
  const DropletResult level = solve_droplets(c, WaterModel::Threshold, 3, 5);
  EXPECT_EQ(level.report.initial_droplets, 0);
  // The lowest pixels hold it: heights h 4 um2 each, k of them filled to the level of the next.
  double held = 0, filled = 0;
  for (const double gap : z) {
    if (held + gap * 4e-12 > 1e-18) break;
    held += gap * 4e-12, ++filled;
  }
  EXPECT_NEAR(level.wetting.wetted_fraction, filled / 16, 1.0 / 16);
  const Wetting unmoved = unmoved_droplets(c, 3, 5);
  const std::vector<DropletSeed> seeds = scatter_droplets(c.gap.grid, 1e-18, c.how, 3, 5);
  ASSERT_EQ(seeds.size(), 4u);
  double volume = 0;
  for (const Droplet& drop : unmoved.droplets) volume += drop.volume;
  EXPECT_NEAR(volume, 1e-18, 1e-27);
  DropletOptions still = c.how;
  still.max_moves = 0;
  EXPECT_EQ(unmoved.capillary_force,
            settle_droplets(c.gap, 1e-18, c.water, still, 3, 5).capillary_force);
  EXPECT_NE(unmoved.capillary_force, own.capillary_force);
}

// The gap is that of the design's dry patch at rest on the same skin, its water that of the finger
// in its state.
TEST(GivenGaps, OfADesignAreThoseOfItsDryPatchAtRest) {
  const std::string file = std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/a3h350.toml";
  const DropletCase c = droplets_of_design(file, 0.35, 2, false, true);
  const Design design = read_design(file);
  Scene scene = scene_of(design);
  for (double& v : scene.finger.water.volume) v = 0;
  scene.drive.amplitude = 0;
  const PatchPicture dry = picture_patch(scene, design.texture, fidelity_of(design), 0.35, 2);
  ASSERT_EQ(c.gap.value.size(), dry.fields.off.gap.size());
  for (std::size_t i = 0; i < c.gap.value.size(); ++i)
    ASSERT_NEAR(c.gap.value[i], dry.fields.off.gap[i], 1e-15) << i;
  const Finger finger = scene_of(design).finger.applied();
  EXPECT_EQ(c.water.theta_skin, finger.water.contact_angle);
  EXPECT_EQ(c.water.theta_substrate, design.surface.contact_angle);
  EXPECT_EQ(c.water.hysteresis, finger.water.hysteresis);
  EXPECT_FALSE(c.how.rim_pinning);
  EXPECT_TRUE(c.how.corner_wicking);
}

// Standard errors are those of the placements.
TEST(GivenGaps, AnEnsembleHasTheScatterOfItsPlacements) {
  std::vector<double> z;
  for (int i = 0; i < 16; ++i) z.push_back(5e-8 * ((7 * i) % 16));
  DropletCase c = of_gap("rough.npy", z);
  c.volume = 1e-18;
  c.water = {0.07, kPi / 3, kPi / 3, 0.3};
  c.how.drops_per_volume = 6e18;
  const DropletEnsemble e = solve_droplet_ensemble(c, 0.5, 2, 3, 5);
  ASSERT_EQ(e.volumes.size(), 2u);
  const auto force = [&](double volume, std::uint64_t index) {
    return settle_droplets(c.gap, volume, c.water, c.how, 3, index).capillary_force;
  };
  const double a = force(0.5e-18, 5), b = force(0.5e-18, 6), d = force(1.5e-18, 5),
               f = force(1.5e-18, 6);
  EXPECT_NEAR(e.volumes[0].capillary_force.value, 0.5 * (a + b), 1e-12 * (a + b));
  EXPECT_NEAR(e.volumes[0].capillary_force.se, 0.5 * std::abs(a - b), 1e-12 * (a + b));
  EXPECT_NEAR(e.volumes[1].capillary_force.value, 0.5 * (d + f), 1e-12 * (d + f));
  EXPECT_NEAR(e.volumes[1].capillary_force.se, 0.5 * std::abs(d - f), 1e-12 * (d + f));
  EXPECT_NEAR(e.mean_capillary_force, 0.25 * (a + b + d + f), 1e-12 * (a + b + d + f));
}

}  // namespace
}  // namespace papilla::tests::given_gaps_test
