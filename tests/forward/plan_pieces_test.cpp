// Whole plans: every piece of three scenes with its words, its price and its error; and how the
// members of patches combine, row by row.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "design/design.h"
#include "fields/price.h"
#include "forward/electric_path.h"
#include "forward/forward.h"
#include "forward/patch_setup.h"
#include "forward/scene_terms.h"
#include "geometry/io/files.h"
#include "geometry/roughness.h"
#include "physics/capillary/facts.h"
#include "physics/contact/facts.h"
#include "physics/electrostatics/full_field.h"
#include "physics/electrostatics/rules.h"
#include "tests/temporary.h"

namespace papilla::tests::plan_pieces_test {
namespace {

struct Line {
  const char* name;
  std::string method, reason;
  double seconds, error;
};
struct Skipped {
  const char* name;
  std::string reason;
  double bound;
};

void expect_plan(const Plan& plan, const std::vector<Line>& steps,
                 const std::vector<Skipped>& skips) {
  ASSERT_EQ(plan.steps.size(), steps.size());
  double sum = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const PlanStep& s = plan.steps[i];
    EXPECT_STREQ(s.name(), steps[i].name);
    EXPECT_EQ(s.method, steps[i].method);
    EXPECT_EQ(s.reason, steps[i].reason);
    EXPECT_NEAR(s.seconds, steps[i].seconds, 1e-9 * steps[i].seconds) << s.name();
    EXPECT_NEAR(s.error, steps[i].error, 1e-9) << s.name();
    sum += steps[i].seconds;
  }
  EXPECT_NEAR(plan.seconds(), sum, 1e-9 * sum);
  ASSERT_EQ(plan.skipped.size(), skips.size());
  for (std::size_t i = 0; i < skips.size(); ++i) {
    EXPECT_STREQ(plan.skipped[i].name(), skips[i].name);
    EXPECT_EQ(plan.skipped[i].reason, skips[i].reason);
    EXPECT_EQ(plan.skipped[i].bound, skips[i].bound) << skips[i].name;
    EXPECT_TRUE(plan.skipped[i].estimate);
  }
}

const char* const kPatches =
    "patches differ by tens of percent; designs are compared on the same "
    "skins";
const Skipped kUniform{"distribution of patch pressures",
                       "closure = uniform: phi of the finger file stands for it", 0};
const Skipped kWaals{"van der Waals",
                     "Hamaker estimate below 5 % of the contact load (reported by reproduce)",
                     0.05};
const Skipped kKelvin{
    "Kelvin condensation",
    "menisci of nanometres; Eq. accuracy.8 on the published samples (a smooth skin: three times "
    "that), `papilla explain --measure` on this scene",
    0.15};
const Skipped kOptics{"optics",
                      "no part of friction: computed apart, where a metric or a limit asks", 0};

// Prices of one patch, by the facts of its pieces.
double contact_price(const Grid& g, double tolerance) { return contact_seconds(g, tolerance); }
double field_price(const Grid& g, FieldMethod m, double tolerance) {
  return field_rule(m).seconds(g, tolerance);
}
double water_price(const Scene& scene, const Grid& g) {
  const SkinWater& water = scene.finger.water;
  double droplets = 0;
  for (const double rh : scene.environment.relative_humidity)
    droplets += starting_droplets(g, water.volume_per_area(rh), water.drops_per_um3);
  return water_facts(WaterModel::Droplets)
      .seconds(g, droplets / static_cast<double>(scene.environment.relative_humidity.size()));
}

// Water and drive by the load law, on 2 humidities: 8 skins, of which 5 are controls.
TEST(PlanPieces, OfADrivenSearchWithControls) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.environment.relative_humidity = {0.3, 0.7};
  Fidelity f = fidelity_level("search");
  f.control_skins = 5, f.field_skins = 2;
  const Plan plan = make_plan(scene, Texture{}, f);
  EXPECT_TRUE(plan.field && plan.water && plan.retention);
  EXPECT_FALSE(plan.traction_solves);
  const Grid g{128, 128, 12e-6, 12e-6}, half{64, 64, 12e-6, 12e-6};
  EXPECT_EQ(plan.grid, g);
  EXPECT_EQ(plan.skin_cutoff, 100e-9);
  EXPECT_NEAR(plan.effective_cutoff, 2 * 12e-6 / 128, 1e-15);
  EXPECT_EQ(plan.feature_pixels, kInfinity);
  const double contact = contact_price(g, 1e-3), water = water_price(scene, g),
               field = field_price(g, FieldMethod::Spread, 1e-2);
  // Control skins: half the pixels and solved areas, each with both states under tractions.
  const double again = 3 * contact + water + field,
               halved = 3 * contact_price(half, 1e-3) + water_price(scene, half) +
                        field_price(half, FieldMethod::Spread, 1e-2);
  const double water_error =
      water_facts(WaterModel::Droplets)
          .error(std::vector<double>{scene.finger.water.volume_per_area(0.3),
                                     scene.finger.water.volume_per_area(0.7)});
  expect_plan(
      plan,
      {{"contact", "layered half-space, certified to 0.001",
        "8 skins on 128 x 128 pixels, skin resolved to 188 nm", 16 * contact, 0},
       {"water", "droplet ensemble by lowest energy",
        "its variation over humidity is what textures change; error: mobility and number",
        16 * water, water_error},
       {"field", "columns, the flux spreading in the dielectric",
        "scaled to the 3-D field of 2 skins", 16 * field + 2 * 2 * full_field_seconds(g), 0.03},
       {"electrowetting", "saturated law, averaged over the cycle",
        "bridges conduct; the angle saturates", 0, 0},
       {"retention", "contact-angle hysteresis", "F = tau A + F_ret", 0, 0},
       {"sampling", "8 skins, common to all designs", kPatches, 0, 0.09 / std::sqrt(8.0)},
       {"errors", "5 of the skins on half the pixels",
        "what the grid and the load law may be off by, on solved areas", 2 * 5 * (again + halved),
        0}},
      {{"contact with tractions",
        "the load law F ~ L^0.84 stands for it (Eq. friction.3): within 5 % of F_on/F_off and 15 % "
        "of the modulation on 95 % of 180 random scenes, 7 and 31 % on the worst",
        0.071},
       {"equilibrium",
        "one pass: the gap before the attractions gives them; an equilibrium would raise the "
        "modulation by 5 to 50 %",
        0.5},
       kUniform,
       kWaals,
       kKelvin,
       kOptics});
  EXPECT_TRUE(plan.warnings.empty());
}

TEST(PlanPieces, OfALookThatIsAskedForHasItsTheory) {
  const Plan without = make_plan({}, Texture{}, fidelity_level("search"));
  const Plan with = with_look(without, "phase screen");
  ASSERT_EQ(with.steps.size(), without.steps.size() + 1);
  ASSERT_EQ(with.skipped.size() + 1, without.skipped.size());
  const auto optics = std::find_if(with.steps.begin(), with.steps.end(),
                                   [](const PlanStep& s) { return s.piece == Piece::Optics; });
  ASSERT_NE(optics, with.steps.end());
  EXPECT_EQ(optics->method, "phase screen");
  EXPECT_STREQ(std::next(optics)->name(), "sampling");
  EXPECT_EQ(with.seconds(), without.seconds());  // measured apart
}

// Two volumes and three placements are six times the water; of a gap that is full no droplet moves.
TEST(PlanPieces, ThePriceCountsDropletsPlacementsAndVolumes) {
  Scene scene;
  scene.environment.relative_humidity = {0.5};
  const auto seconds = [&](int placements) {
    Fidelity f = fidelity_level("search");
    f.droplet_seeds = placements;
    double water = 0;
    for (const PlanStep& step : make_plan(scene, Texture{}, f).steps) {
      if (step.piece == Piece::Water) water = step.seconds;
    }
    return water;
  };
  const double one = seconds(1);
  EXPECT_NEAR(one, 8 * water_price(scene, {128, 128, 12e-6, 12e-6}), 1e-9 * one);
  EXPECT_NEAR(seconds(3), 3 * one, 1e-9 * one);
  scene.finger.water.volume_spread = 0.33;
  EXPECT_NEAR(seconds(3), 6 * one, 1e-9 * one);
  scene.finger.water.volume_spread = 0, scene.finger.water.drops_per_um3 *= 100;
  EXPECT_NEAR(seconds(1), 8 * water_price(scene, {128, 128, 12e-6, 12e-6}), 1e-9 * one);
  for (double& volume : scene.finger.water.volume) volume *= 1000;
  EXPECT_NEAR(seconds(1), 8 * 1.28e-3, 1e-9);
}

// What has a direction says that friction has none.
TEST(PlanPieces, ATextureWithADirectionIsWarnedOf) {
  const auto warned = [](const Texture& texture) {
    for (const std::string& said : make_plan({}, texture, fidelity_level("search")).warnings) {
      if (said.starts_with("the texture has a direction and friction has none here")) return true;
    }
    return false;
  };
  EXPECT_TRUE(warned({Grating{}}));
  EXPECT_TRUE(warned({VGrooves{}}));
  EXPECT_TRUE(warned({Waves{}}));
  EXPECT_TRUE(warned({Stack{.combine = {}, .parts = {{HoleArray{}}, {Grating{}}}}}));
  EXPECT_FALSE(warned({Waves{.directions = Waves::Directions::Both}}));
  EXPECT_FALSE(warned({HoleArray{}}));
  EXPECT_FALSE(warned({Flat{}}));
  EXPECT_FALSE(warned({Grating{.depth = 0}}));
}

// Solved areas, in equilibrium, patches of the ridges, without water.
TEST(PlanPieces, OfADryDesignInEquilibrium) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.environment.relative_humidity = {0.3};
  scene.finger.water.volume = {0, 0, 0, 0};
  scene.model.coupling = Coupling::Equilibrium;
  scene.model.closure = Closure::Persson;
  scene.model.field = FieldMethod::Local;
  Fidelity f = fidelity_level("design");
  f.grid = 64, f.skins = 10, f.bridge_nodes = 4, f.control_skins = 0, f.coupling_passes = 9;
  const Plan plan = make_plan(scene, Texture{}, f);
  EXPECT_TRUE(plan.field && plan.traction_solves);
  EXPECT_FALSE(plan.water || plan.retention);
  const Grid g{64, 64, 12e-6, 12e-6};
  const double contact = contact_price(g, 1e-4), field = field_price(g, FieldMethod::Local, 1e-3);
  expect_plan(
      plan,
      {{"contact", "layered half-space, certified to 0.0001",
        "10 skins on 64 x 64 pixels, skin resolved to 375 nm", 40 * contact, 0},
       {"field", "columns, one by one", "pull 20 to 45 % below the 3-D field", 40 * field, 0.3},
       {"contact with tractions", "off and on states",
        "areas from resolved contact, not from the load law", 40 * 2 * contact, 0},
       {"coupling", "equilibrium", "gap, field and water until they agree within 0.2 % of the load",
        40 * (contact + field), 0},
       {"scale bridge", "Persson, 4 patch pressures",
        "patches under a fingertip do not share one pressure", 0, 0.03},
       {"sampling", "10 skins, common to all designs", kPatches, 0, 0.11 / std::sqrt(10.0)}},
      {{"water", "no water at any of these humidities", 0},
       {"electrowetting", "no bridges without water", 0},
       {"retention", "no water", 0},
       kWaals,
       kKelvin,
       kOptics});
}

// The paper's rules on a wetting surface, undriven: one more solve, and controls of the grid alone.
TEST(PlanPieces, OfThePaperAtRest) {
  Scene scene;
  scene.environment.relative_humidity = {0.5};
  scene.model.preset = Preset::M3;
  Fidelity f = fidelity_level("design");
  f.grid = 64, f.skins = 6, f.control_skins = 4;
  Plan plan = make_plan(scene, Texture{}, f);
  EXPECT_TRUE(plan.water && plan.traction_solves);
  EXPECT_FALSE(plan.field || plan.retention);
  const Grid g{64, 64, 12e-6, 12e-6}, half{32, 32, 12e-6, 12e-6};
  const double contact = contact_price(g, 1e-4);
  const double error = water_facts(WaterModel::Droplets)
                           .error(std::vector<double>{scene.finger.water.volume_per_area(0.5)});
  const std::vector<Skipped> skips{
      {"field", "the drive is at 0", 0},
      {"electrowetting", "the drive is at 0", 0},
      {"retention", "preset m3 counts it for hydrophobic surfaces only", 0.05},
      kUniform,
      kWaals,
      kKelvin,
      kOptics};
  expect_plan(plan,
              {{"contact", "layered half-space, certified to 0.0001",
                "6 skins on 64 x 64 pixels, skin resolved to 375 nm", 6 * contact, 0},
               {"water", "droplet ensemble by lowest energy",
                "its variation over humidity is what textures change; error: mobility and number",
                6 * water_price(scene, g), error},
               {"contact with tractions", "off state",
                "areas from resolved contact, not from the load law", 6 * contact, 0},
               {"sampling", "6 skins, common to all designs", kPatches, 0, 0.11 / std::sqrt(6.0)},
               {"errors", "4 of the skins on half the pixels", "what the grid may be off by",
                4 * (2 * contact_price(half, 1e-4) + water_price(scene, half)), 0}},
              skips);
  // By the load law at rest it is off by what the published samples had.
  f.estimator = Estimator::Load;
  plan = make_plan(scene, Texture{}, f);
  for (const PlanSkip& s : plan.skipped) {
    if (s.piece != Piece::Tractions) continue;
    EXPECT_EQ(s.reason, "the load law F ~ L^0.84 stands for it (Eq. friction.3)");
    EXPECT_EQ(s.bound, 0.02);
  }
}

// As people read it, to the letter.
TEST(PlanPieces, AreSaidALineEach) {
  Plan plan;
  plan.grid = {200, 100, 14.96e-6, 7.2e-6};
  plan.steps = {{Piece::Contact, "half-space", "40 skins", 150.1, 0},
                {Piece::PatchPressures, "Persson", "unlike", 0, 0.0312}};
  plan.skipped = {{Piece::PatchPressures, "closure", 0, true},
                  {Piece::VanDerWaals, "small", 0.05, true},
                  {Piece::Kelvin, "steep", kInfinity, false},
                  {Piece::Retention, "rest", 0.123, false}};
  plan.warnings = {"first", "second"};
  EXPECT_EQ(plan.text(),
            "patch 15 x 7.2 um, 200 x 100 pixels of 75 nm\n"
            "modelled:\n"
            "  contact                half-space                                   40 skins; about "
            "3 min\n"
            "  scale bridge           Persson                                      unlike; error "
            "3.1 %\n"
            "not modelled:\n"
            "  distribution of patch pressures  closure\n"
            "  van der Waals                    small (estimate 5 % of friction)\n"
            "  Kelvin condensation              steep (no bound)\n"
            "  retention                        rest (bound 12 % of friction)\n"
            "expected 3 min on one core of a usual machine\n"
            "warning: first\n"
            "warning: second\n");
}

// A patch of 48 um on 256 pixels a side at most keeps waves of 375 nm: a level's own are 188 nm.
TEST(PlanPieces, ALongPatchSaysWhatItsSkinLacks) {
  Scene scene;
  Fidelity f = fidelity_level("search");
  f.most_pixels = 256;
  const Texture wide{HoleArray{.period = 48e-6, .diameter = 20e-6}};
  const Plan plan = make_plan(scene, wide, f);
  ASSERT_EQ(plan.grid, (Grid{256, 256, 48e-6, 48e-6}));
  EXPECT_NEAR(plan.effective_cutoff, 375e-9, 1e-15);
  ASSERT_EQ(plan.warnings.size(), 1u);
  const std::string said =
      "the patch is 48 um long and has 256 pixels per side, so its skin has no waves below 375 nm "
      "(the finger's end at 100 nm): this is a smoother skin, its contact area and friction are "
      "not the finger's; ";
  EXPECT_EQ(plan.warnings[0], said +
                                  "accuracy.grid = 512, or a period of at most 24 um, resolves "
                                  "it as on a small patch");
  // Beyond the largest key: the period alone, or another skin.
  const Texture vast{HoleArray{.period = 1.2e-3, .diameter = 20e-6}};
  const Plan lost = make_plan(scene, vast, f);
  ASSERT_FALSE(lost.warnings.empty());
  EXPECT_NE(lost.warnings[0].find("; a period of at most 24 um resolves it as on a small patch, "
                                  "accuracy.grid = 4096 to 586 nm"),
            std::string::npos)
      << lost.warnings[0];
  // A fifth longer than usual is no reason to warn, more is.
  f.most_pixels = 128;
  const auto warned = [&](double period) {
    const Texture t{HoleArray{.period = period, .diameter = 6e-6}};
    return !make_plan(scene, t, f).warnings.empty();
  };
  EXPECT_FALSE(warned(14.3e-6));
  EXPECT_TRUE(warned(14.6e-6));
}

TEST(PlanPieces, WaterOnANearlyWettingSurfaceIsWarnedOf) {
  const auto warned = [](double degrees, WaterModel water, bool dry = false) {
    Scene scene;
    scene.surface.contact_angle = degrees * kPi / 180;
    scene.model.water = water;
    if (dry) scene.finger.water.volume.assign(4, 0);
    const auto said = make_plan(scene, Texture{}, fidelity_level("search")).warnings;
    return said.size() == 1 &&
           said[0].starts_with(fmt::format("nearly wetting, {:g} deg", degrees));
  };
  EXPECT_TRUE(warned(0, WaterModel::Droplets));
  EXPECT_TRUE(warned(9.5, WaterModel::Droplets));
  EXPECT_FALSE(warned(10.5, WaterModel::Droplets));
  EXPECT_FALSE(warned(2, WaterModel::Threshold));
  EXPECT_FALSE(warned(2, WaterModel::Droplets, true));
}

// The limits that the warning names are what the model answers.
TEST(PlanPieces, TheLimitsOfANearlyWettingSurfaceAreThoseOfTheModel) {
  Design design =
      read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/flat.toml",
                  {"surface.contact_angle=0 deg", "environment.relative_humidity=[\"55 %\"]"});
  Fidelity fidelity = fidelity_level("search");
  fidelity.skins = 6;
  const std::string said = make_plan(scene_of(design), design.texture, fidelity).warnings.at(0);
  for (const auto& [water, before] : {std::pair{WaterModel::Droplets, "modulation of some "},
                                      std::pair{WaterModel::Threshold, "by droplets, "}}) {
    const std::size_t at = said.find(before);
    ASSERT_NE(at, std::string::npos) << said;
    design.model.water = water;
    const double modulation =
        evaluate(scene_of(design), design.texture, fidelity).points.at(0).modulation.value;
    EXPECT_NEAR(std::stod(said.substr(at + std::string(before).size())) / modulation, 1, 0.25)
        << said;
  }
}

// Sebum that keeps all water off leaves none to model: as the evaluation of that finger does.
TEST(PlanPieces, AreThoseOfTheFingerInItsState) {
  Scene natural;
  natural.finger.state = FingerState::Natural;
  natural.finger.natural.water_factor = 0;
  const Fidelity f = fidelity_level("search");
  EXPECT_FALSE(make_plan(natural, Texture{}, f).water);
  EXPECT_EQ(make_plan(natural, Texture{}, f), make_plan(in_its_state(natural), Texture{}, f));
  natural.finger.state = FingerState::Clean;
  EXPECT_TRUE(make_plan(natural, Texture{}, f).water);
}

TEST(PlanPieces, OfAMappedPinUnderCurrentTheRoughnessIsSaidToBeLeftOut) {
  const std::string file = temporary("face.gsf");
  write_gsf(file, random_surface({100e-9, 3e-6, 0.8, 200e-9}, {256, 256, 24e-6, 24e-6}, 7, 0), {});
  Scene scene;
  scene.finger.skin.map = file;
  scene.finger.skin.rms = scene.finger.macro.ridge_rms = 0;
  const auto warned = [&] {
    const Plan plan = make_plan(scene, Texture{}, fidelity_level("search"));
    return std::any_of(plan.warnings.begin(), plan.warnings.end(), [](const std::string& said) {
      return said.find("the roughness of the map is not in the impedance") != std::string::npos;
    });
  };
  scene.drive.amplitude = 100;
  EXPECT_FALSE(warned());
  scene.drive.amplitude = 0;
  scene.drive.control = DriveControl::Current;
  EXPECT_FALSE(warned());  // undriven
  scene.drive.current = 0.1e-3;
  EXPECT_TRUE(warned());
  scene.finger.macro.ridge_rms = 1e-6;  // as of skin: its spectrum stands for the map
  EXPECT_FALSE(warned());
}

TEST(PlanPieces, WarningsAreSaidInWhole) {
  const Fidelity f = fidelity_level("search");
  Scene direct;
  direct.drive.amplitude = 100;
  direct.drive.waveform = Waveform::Dc;
  const double a = 1e3 * relaxation_time(direct, 0.5, 0.1e-6),
               b = 1e3 * relaxation_time(direct, 0.5, 1e-6);
  EXPECT_EQ(make_plan(direct, Texture{}, f).warnings,
            (std::vector<std::string>{fmt::format(
                "direct voltage: the pull is the one that stays when charge has leaked through "
                "gap, film and skin, {:.2g} to {:.2g} ms after the touch (gaps of 0.1 and 1 um); a "
                "film that insulates better than the gap has taken the voltage by then",
                std::min(a, b), std::max(a, b))}));
  direct.drive.amplitude = 0;  // nothing stays of none
  EXPECT_TRUE(make_plan(direct, Texture{}, f).warnings.empty());
  direct.drive.amplitude = 100;
  direct.finger.electrical.gap_resistivity = direct.finger.electrical.corner_frequency = 0;
  direct.surface.dielectric[0].resistivity = 0;
  EXPECT_EQ(
      make_plan(direct, Texture{}, f).warnings,
      (std::vector<std::string>{"direct voltage: nothing leaks, the charge stays where it is"}));
  Scene current;
  current.environment.relative_humidity = {0.154, 0.75};
  current.drive.control = DriveControl::Current;
  current.drive.current = 0.25e-3;
  current.drive.source_compliance = 40;
  EXPECT_EQ(make_plan(current, Texture{}, f).warnings,
            (std::vector<std::string>{"at 15 %, 75 % RH 0.25 mA would need more than "
                                      "source_compliance, 40 V: judged at that voltage"}));
  // Lands of 1.45 um on pixels of 375 nm: 3.9, twice as many are not yet 8.
  Fidelity coarse = f;
  coarse.grid = 32;
  Scene still;
  const Texture holes{HoleArray{.period = 3e-6, .diameter = 1.55e-6, .wall_angle = kPi / 2}};
  const Plan plan = make_plan(still, holes, coarse);
  ASSERT_EQ(plan.grid.dx(), 375e-9);
  const double smallest = facts(holes).margins.smallest();
  EXPECT_NEAR(plan.feature_pixels, smallest / 375e-9, 1e-12);
  ASSERT_EQ(plan.warnings.size(), 1u);
  EXPECT_EQ(plan.warnings[0],
            fmt::format("the smallest feature of the texture, 1450 nm, is {:.2g} pixels wide: "
                        "its friction is known as well as its error part `grid` says and not "
                        "better; accuracy.grid = 128 gives it {:.2g}",
                        smallest / 375e-9, 4 * smallest / 375e-9));
}

// Row by row, over water and over patch pressures.
TEST(PatchMemberLaws, EveryMemberCombinesByItsRow) {
  PatchResult a, b;
  for (std::size_t i = 0; i < kPatchMembers.size(); ++i) {
    a.*kPatchMembers[i].value = 2 + static_cast<double>(i);
    b.*kPatchMembers[i].value = 7 - 0.5 * static_cast<double>(i);
  }
  a.status = {Trouble::None, 0, ""};
  b.status = {Trouble::Flooded, 0, ""};
  const std::vector<PatchResult> two{a, b};
  const PatchResult water = over_water(two);
  EXPECT_EQ(water.status.trouble, Trouble::Flooded);
  using Double = double PatchResult::*;
  const auto mean = [&](Double m) { EXPECT_NEAR(water.*m, (a.*m + b.*m) / 2, 1e-12); };
  for (const Double common : {&PatchResult::load, &PatchResult::area_dry, &PatchResult::mean_gap,
                              &PatchResult::indentation})
    EXPECT_EQ(water.*common, a.*common);
  for (const Double m :
       {&PatchResult::capillary_off, &PatchResult::capillary_on, &PatchResult::pull,
        &PatchResult::retention, &PatchResult::retention_on, &PatchResult::area_off,
        &PatchResult::area_on, &PatchResult::bridges, &PatchResult::wetted,
        &PatchResult::bridge_volume, &PatchResult::volume, &PatchResult::on_its_way,
        &PatchResult::over_limit_area, &PatchResult::over_limit_share})
    mean(m);
  for (const Double m :
       {&PatchResult::peak_oxide_field, &PatchResult::peak_air_field, &PatchResult::certificate})
    EXPECT_EQ(water.*m, std::max(a.*m, b.*m));
  EXPECT_EQ(water.oxide_margin, std::min(a.oxide_margin, b.oxide_margin));

  const PressureShares shares{{0.1, 0.3}, {0.1, 0.3}, {0.15, 0.45}};
  PatchResult out;
  out.load = 9, out.pull = 4;
  out.status = {Trouble::FarGapPullIn, 0, ""};
  add_over_pressures(two, shares, out);
  EXPECT_EQ(out.load, 9);
  EXPECT_EQ(out.status.trouble, Trouble::FarGapPullIn);  // the first that is known
  for (const Double m : {&PatchResult::capillary_off, &PatchResult::retention,
                         &PatchResult::area_dry, &PatchResult::area_off})
    EXPECT_NEAR(out.*m, 0.1 * a.*m + 0.3 * b.*m, 1e-12);
  for (const Double m :
       {&PatchResult::capillary_on, &PatchResult::retention_on, &PatchResult::area_on})
    EXPECT_NEAR(out.*m, 0.15 * a.*m + 0.45 * b.*m, 1e-12);
  const double pull = 4 + 0.15 * a.pull + 0.45 * b.pull;
  EXPECT_NEAR(out.pull, pull, 1e-12);
  for (const Double m : {&PatchResult::bridges, &PatchResult::wetted, &PatchResult::bridge_volume,
                         &PatchResult::volume, &PatchResult::on_its_way, &PatchResult::mean_gap,
                         &PatchResult::indentation, &PatchResult::over_limit_area})
    EXPECT_NEAR(out.*m, 0.25 * a.*m + 0.75 * b.*m, 1e-12);
  EXPECT_NEAR(out.over_limit_share,
              (0.15 * a.pull * a.over_limit_share + 0.45 * b.pull * b.over_limit_share) / pull,
              1e-12);
  for (const Double m :
       {&PatchResult::peak_oxide_field, &PatchResult::peak_air_field, &PatchResult::certificate})
    EXPECT_EQ(out.*m, std::max(a.*m, b.*m));
  EXPECT_EQ(out.oxide_margin, std::min(a.oxide_margin, b.oxide_margin));
  // A surface that pushes has no share of its pull.
  PatchResult none;
  PatchResult still = a;
  still.pull = 0;
  add_over_pressures({&still, 1}, {{1}, {1}, {1}}, none);
  EXPECT_EQ(none.over_limit_share, 0);
}

// Low and high volume by placements: stream of skin k, placement s at 2^32 s.
TEST(PatchSetupLaws, WaterHasItsVolumesAndStreams) {
  Scene scene;
  scene.environment.relative_humidity = {0.5};
  Fidelity f = fidelity_level("search");
  f.grid = 16, f.first_skin = 10, f.droplet_seeds = 2;
  const auto members = [&](int k) { return PatchSetup(scene, Texture{}, f).water_members(k); };
  const std::uint64_t second = std::uint64_t{1} << 32;
  std::vector<WaterMember> m = members(3);
  ASSERT_EQ(m.size(), 2u);
  EXPECT_EQ(m[0].factor, 1);
  EXPECT_EQ(m[0].index, 13u);
  EXPECT_EQ(m[1].index, 13 + second);
  scene.finger.water.volume_spread = 0.4;
  m = members(0);
  ASSERT_EQ(m.size(), 4u);
  EXPECT_NEAR(m[0].factor, 0.6, 1e-12);
  EXPECT_NEAR(m[1].factor, 1.4, 1e-12);
  EXPECT_EQ(m[1].index, 10u);
  EXPECT_EQ(m[2].index, 10 + second);
  EXPECT_NEAR(m[3].factor, 1.4, 1e-12);
  scene.model.water = WaterModel::Threshold;  // has no places
  EXPECT_EQ(members(0).size(), 2u);
  scene.finger.water.volume = {0, 0, 0, 0};
  m = members(2);
  ASSERT_EQ(m.size(), 1u);
  EXPECT_EQ(m[0].factor, 1);
  EXPECT_EQ(m[0].index, 12u);
}

// A surface cut through its film says so where a voltage meets it; heights are those of texture and
// skin.
TEST(PatchSetupLaws, HeightsAddUpAndACutFilmIsSaidUnderVoltage) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.surface.process = FilmProcess::Planar;
  scene.surface.dielectric[0].thickness = 200e-9;
  Fidelity f = fidelity_level("search");
  f.grid = 48;
  const auto setup = [&](double depth) {
    return std::make_unique<PatchSetup>(scene, Texture{HoleArray{.depth = depth}}, f);
  };
  const auto whole = setup(150e-9), cut = setup(300e-9);
  EXPECT_TRUE(whole->plan().warnings.empty());
  Scene undriven = scene;
  undriven.drive.amplitude = 0;
  EXPECT_TRUE(PatchSetup(undriven, Texture{HoleArray{.depth = 300e-9}}, f).plan().warnings.empty());
  ASSERT_EQ(cut->plan().warnings.size(), 1u);
  EXPECT_EQ(cut->plan().warnings[0],
            fmt::format("the texture cuts through its planar film on {:.2g} % of the patch: the "
                        "drive meets the bare electrode there, and the numbers under voltage mean "
                        "nothing physical; make the film thicker, or the texture shallower",
                        100 * cut->surface().cut_through));
  const Heightmap skin = whole->skin(1);
  const std::vector<double> height = whole->height(skin);
  for (std::size_t i = 0; i < height.size(); ++i)
    ASSERT_NEAR(height[i], skin.z[i] + whole->texture().z[i], 1e-18);
}

}  // namespace
}  // namespace papilla::tests::plan_pieces_test
