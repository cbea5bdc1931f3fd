// What is kept of the patches before changes nothing but the time.
#include "forward/kept_patches.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/watch.h"
#include "config/describe.h"
#include "design/design.h"
#include "forward/forward.h"
#include "geometry/io/files.h"
#include "tests/temporary.h"

namespace papilla::tests::kept_patches_test {
namespace {

Fidelity small() {
  Fidelity f = fidelity_level("search");
  f.grid = 48;
  f.skins = 3;
  return f;
}

Response kept_response(const Design& design, KeptPatches& kept) {
  return respond(scene_of(design), small(), kept.solve(scene_of(design), design.texture, small()));
}

// A design with one number moved, and what a run after the design itself takes over.
using Moved = std::pair<const char*, std::pair<double, KeptPatches::Held>>;
const std::array<Moved, 7> kMoved{{
    {"drive.amplitude", {120, KeptPatches::Held::Water}},
    {"drive.frequency", {2e3, KeptPatches::Held::Water}},
    {"surface.dielectric.0.thickness", {7e-7, KeptPatches::Held::Water}},
    {"surface.contact_angle", {1.2, KeptPatches::Held::Contact}},
    {"finger.load", {0.4, KeptPatches::Held::Nothing}},
    {"texture.depth", {2e-7, KeptPatches::Held::Nothing}},
    {"finger.water.drops_per_um3", {2, KeptPatches::Held::Nothing}},
}};

TEST(KeptPatches, GiveTheNumbersOfARunThatKeepsNothing) {
  const Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml");
  for (const auto& [path, value] : kMoved) {
    KeptPatches kept;
    kept_response(design, kept);
    Design moved = design;
    set_number(moved, path, value.first);
    const Response fresh = evaluate(scene_of(moved), moved.texture, small());
    const Response after = kept_response(moved, kept);
    EXPECT_EQ(kept.held(), value.second) << path;
    ASSERT_EQ(after.points.size(), fresh.points.size());
    for (std::size_t i = 0; i < fresh.points.size(); ++i)
      EXPECT_EQ(after.points[i], fresh.points[i]) << path << " at humidity " << i;
  }
}

TEST(KeptPatches, HoldWithADistributionOfPatchPressures) {
  Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml");
  design.model.closure = Closure::Persson;
  KeptPatches kept;
  kept_response(design, kept);
  design.drive.amplitude = 90;
  const Response fresh = evaluate(scene_of(design), design.texture, small());
  EXPECT_EQ(kept_response(design, kept).points, fresh.points);
  EXPECT_EQ(kept.held(), KeptPatches::Held::Water);
}

TEST(KeptPatches, SpareTheContactSolvesWhenOnlyTheVoltageMoves) {
  Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml");
  for (const Coupling coupling : {Coupling::OnePass, Coupling::Equilibrium}) {
    design.model.coupling = coupling;
    KeptPatches kept;
    kept_response(design, kept);
    const Response again = kept_response(design, kept);
    EXPECT_EQ(kept.held(), KeptPatches::Held::Water);
    EXPECT_GT(again.piece_seconds.field, 0.0);
    if (coupling == Coupling::OnePass) {
      EXPECT_EQ(again.contact_solves, 0);
      EXPECT_EQ(again.piece_seconds.contact, 0.0);
    } else {  // the skins of the load law close under the voltage; no dry contact is solved
      EXPECT_GT(again.contact_solves, 0);
      KeptPatches none;
      EXPECT_LT(again.contact_solves, kept_response(design, none).contact_solves);
    }
  }
}

// Dry skin at rest is one skin; driven, those that its equilibrium is solved on.
TEST(KeptPatches, GrowWithTheSkinsThatADriveAsksFor) {
  Scene scene = scene_of(read_design(PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml"));
  scene.model.coupling = Coupling::Equilibrium;
  scene.environment.relative_humidity = {0.3};
  scene.environment.weights.clear();
  for (double& volume : scene.finger.water.volume) volume = 0;
  Fidelity one = small();
  one.skins = 1, one.equilibrium_skins = 3;
  KeptPatches kept;
  for (const double amplitude : {0.0, 120.0, 0.0, 90.0}) {
    scene.drive.amplitude = amplitude;
    const Response after = respond(scene, one, kept.solve(scene, Texture{}, one));
    EXPECT_EQ(after.points, evaluate(scene, Texture{}, one).points) << amplitude;
  }
  EXPECT_EQ(kept.held(), KeptPatches::Held::Water);
}

// A map that is written anew under its name is another texture.
TEST(KeptPatches, HoldNothingOfAMapThatWasWrittenAnew) {
  Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml");
  design.environment.relative_humidity = {0.3};
  design.environment.weights.clear();
  const std::string file = temporary("kept.npy");
  const auto write = [&](double height) {
    const Grid grid{64, 64, 20e-6, 20e-6};
    Heightmap map{grid, std::vector<double>(grid.size(), 0)};
    for (int ix = 0; ix < 64; ix += 2) map(ix, 32) = height;
    write_npy(file, map);
  };
  Measured3d measured;
  measured.file = file, measured.width = 20e-6, measured.patch = 12e-6;
  design.texture = Texture{measured};
  KeptPatches kept;
  write(100e-9);
  const auto before = std::filesystem::last_write_time(file);
  kept_response(design, kept);
  kept_response(design, kept);
  EXPECT_EQ(kept.held(), KeptPatches::Held::Water);
  write(300e-9);
  std::filesystem::last_write_time(file, before + std::chrono::seconds(1));
  const Response after = kept_response(design, kept);
  EXPECT_EQ(kept.held(), KeptPatches::Held::Nothing);
  EXPECT_EQ(after.points, evaluate(scene_of(design), design.texture, small()).points);
}

TEST(KeptPatches, AStoppedRunLeavesNothingBehind) {
  const Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml");
  KeptPatches kept;
  std::atomic<bool> stop{true};
  {
    const Watch watch({}, &stop);
    EXPECT_THROW(kept_response(design, kept), WorkStopped);
  }
  const Response after = kept_response(design, kept);
  EXPECT_EQ(kept.held(), KeptPatches::Held::Nothing);
  EXPECT_EQ(after.points, evaluate(scene_of(design), design.texture, small()).points);
}

}  // namespace
}  // namespace papilla::tests::kept_patches_test
