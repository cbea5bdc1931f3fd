// One balance over all gaps of the ridges: its limits, what it conserves, its open gaps against
// solved maps. Eq. coupling.7 to coupling.10
#include "forward/balance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/constants.h"
#include "forward/forward.h"
#include "forward/patch_setup.h"
#include "forward/scale_bridge.h"
#include "forward/scene_terms.h"
#include "geometry/roughness.h"
#include "geometry/texture.h"
#include "physics/capillary/droplets.h"
#include "physics/contact/contact.h"
#include "tests/support/one_pass.h"

namespace papilla::tests::balance_test {
namespace {

constexpr double kHumidity = 0.55;
const Grid kGrid{64, 64, 12e-6, 12e-6};
const double kPatchNumber = 2 * kPi / 12e-6;

Scene balanced(double amplitude) {
  Scene scene;
  scene.finger = one_pass_finger();  // ridges of 2.2 um
  scene.model.closure = Closure::Balance;
  scene.drive.amplitude = amplitude;
  scene.environment.relative_humidity = {kHumidity};
  return scene;
}

Fidelity small(Estimator estimator = Estimator::Load) {
  Fidelity f = fidelity_level("search");
  f.grid = 64;
  f.skins = 3;
  f.estimator = estimator;
  return f;
}

Balance solved(const Scene& scene, int nodes = 1, const SurfaceLevels& levels = {}) {
  return solve_balance(scene, kPatchNumber, kHumidity, nodes, levels);
}

SurfaceLevels holes(double depth) {  // half of the area, film of 500 nm
  const double film = 500e-9 / 3.9;
  return {{0.5, 0.5}, {0, depth}, {film, film}};
}

double carried(const std::vector<double>& share, const std::vector<double>& pressure) {
  return std::inner_product(share.begin(), share.end(), pressure.begin(), 0.0);
}

// phi given: ridges of the roughness at which as many patches touch as it says.
TEST(Balance, WithoutOpenGapsAndAtOnePressureItIsTheUniformClosure) {
  Scene uniform = balanced(150);
  uniform.model.closure = Closure::Uniform;
  Scene scene = balanced(150);
  MacroContact& macro = scene.finger.macro;
  macro.far_gaps = 0;
  macro.pressure_peak = 1;
  double low = 0.1e-6, high = 10e-6;
  for (int i = 0; i < 32; ++i) {
    macro.ridge_rms = std::sqrt(low * high);
    const ScaleBridge bridge(scene, small(), kGrid, kHumidity);
    (bridge.mean_pressure() < scene.finger.patch_pressure(kHumidity) ? low : high) =
        macro.ridge_rms;
  }
  for (const Estimator estimator : {Estimator::Load, Estimator::Area}) {
    const ResponsePoint a =
        evaluate(uniform, Texture{HoleArray{}}, small(estimator)).points.front();
    const ResponsePoint b = evaluate(scene, Texture{HoleArray{}}, small(estimator)).points.front();
    EXPECT_TRUE(b.status.sound());
    for (const auto quantity :
         {&ResponsePoint::friction_off, &ResponsePoint::friction_on, &ResponsePoint::modulation,
          &ResponsePoint::electrostatic_force, &ResponsePoint::capillary_force,
          &ResponsePoint::retention_force, &ResponsePoint::mean_gap, &ResponsePoint::bridges}) {
      EXPECT_NEAR((b.*quantity).value, (a.*quantity).value, 1e-6 * (a.*quantity).value);
    }
  }
}

// Over flat glass, without water, at one pressure of the ridges. Forces of patches are counted by
// Persson's share in contact there, by their load here: the share of three nodes is good to .3 %.
TEST(Balance, OverFlatGlassWithoutWaterItIsThePerssonClosure) {
  Scene scene = balanced(120);
  scene.finger.water.volume = {0, 0, 0, 0};
  scene.finger.macro.pressure_peak = 1;
  Scene persson = scene;
  persson.model.closure = Closure::Persson;
  Fidelity fidelity = small(Estimator::Area);
  fidelity.balance_nodes = fidelity.bridge_nodes;
  const ScaleBridge mine(scene, fidelity, kGrid, kHumidity);
  const ScaleBridge other(persson, fidelity, kGrid, kHumidity);
  ASSERT_EQ(mine.pressures().size(), other.pressures().size());
  for (std::size_t k = 0; k < mine.pressures().size(); ++k)
    EXPECT_NEAR(mine.pressures()[k], other.pressures()[k], 1e-12 * other.pressures()[k]);
  const std::vector<PatchResult> none(mine.pressures().size());
  const double far = other.combine(none).pull;
  EXPECT_NEAR(mine.combine(none).pull, far, 1e-3 * far);
  const ResponsePoint a = evaluate(persson, Texture{}, fidelity).points.front();
  const ResponsePoint b = evaluate(scene, Texture{}, fidelity).points.front();
  EXPECT_NEAR(b.friction_off.value, a.friction_off.value, 1e-9 * a.friction_off.value);
  EXPECT_NEAR(b.friction_on.value, a.friction_on.value, 3e-3 * a.friction_on.value);
  EXPECT_NEAR(b.electrostatic_force.value, a.electrostatic_force.value,
              3e-3 * a.electrostatic_force.value);
}

// What air withstands and what a film's charge makes hold the open gaps of both, gap by gap.
TEST(Balance, AirAndFilmHoldTheOpenGapsOfThePerssonClosureAsItsOwn) {
  Scene scene = balanced(200);
  scene.finger.water.volume = {0, 0, 0, 0};
  scene.finger.macro.pressure_peak = 1;
  const auto by_persson = [](Scene s) {
    s.model.closure = Closure::Persson;
    const ScaleBridge bridge(s, small(), kGrid, kHumidity);
    const PatchResult none = bridge.combine(std::vector<PatchResult>(bridge.pressures().size()));
    EXPECT_TRUE(none.status.sound()) << text(none.status);
    return none.pull / kGrid.area();
  };
  const double free = by_persson(scene);
  Scene of_air = scene, of_film = scene;
  of_air.model.air_limit = AirLimit::Emission;
  of_film.surface.dielectric[0].saturation_field = 10e6;
  for (const Scene& held : {of_air, of_film}) {
    const double pull = by_persson(held);
    EXPECT_GT(pull, 0);
    EXPECT_LT(pull, 0.9 * free);
    const Balance b = solved(held);
    EXPECT_NEAR(pull, b.far.pull, 0.01 * b.far.pull);
    const GapDistribution gaps =
        ridge_field(held.finger, kPatchNumber, kHumidity).gaps(b.nominal + pull);
    EXPECT_NEAR(pull,
                open_gap_pull(gap_shares(gaps, kPatchNumber), {}, field_problem(held, kHumidity)),
                1e-4 * pull);
  }
}

TEST(Balance, PatchesInContactCarryTheLoadAndAllThatTheOpenGapsAdd) {
  for (const double amplitude : {0.0, 60.0, 150.0}) {
    for (const int nodes : {1, 3}) {
      const Balance b = solved(balanced(amplitude), nodes, holes(350e-9));
      ASSERT_FALSE(b.pull_in);
      EXPECT_NEAR(carried(b.shares.nominal, b.pressures), b.nominal, 1e-9 * b.nominal);
      EXPECT_NEAR(b.shares.press_off * carried(b.shares.off, b.pressures),
                  b.nominal + b.far.capillary, 1e-9 * b.nominal);
      EXPECT_NEAR(b.shares.press_on * carried(b.shares.on, b.pressures),
                  b.nominal + b.far.pull + b.far.capillary_on, 1e-9 * b.pressed_on);
      EXPECT_NEAR(std::accumulate(b.shares.on.begin(), b.shares.on.end(), 0.0), b.touching_on,
                  1e-12);
      EXPECT_LT(b.touching_on, 1);
    }
  }
}

TEST(Balance, MoreVoltagePressesMoreUntilPullIn) {
  double pressed = 0, stability = 1;
  for (const double amplitude : {0.0, 25.0, 50.0, 75.0, 100.0, 125.0, 150.0}) {
    const Balance b = solved(balanced(amplitude));
    EXPECT_GT(b.pressed_on, pressed) << amplitude;
    EXPECT_LE(b.stability, stability) << amplitude;
    EXPECT_GT(b.stability, 0);
    pressed = b.pressed_on;
    stability = b.stability;
  }
  Scene smooth = balanced(20000);
  smooth.finger.macro.ridge_rms = 0.3e-6;
  const ScaleBridge closed(smooth, small(), kGrid, kHumidity);
  EXPECT_EQ(closed.combine(std::vector<PatchResult>(1)).status.trouble, Trouble::FarGapPullIn);
}

// The pull of open gaps ends as they close: the pressure rises steeply, without a jump or a fold,
// to where nearly all of the ridges touch, which the status says.
TEST(Balance, GapsCloseWithoutAJump) {
  for (const double ridges : {1e-6, 2.2e-6, 10e-6}) {
    Scene scene = balanced(100);
    scene.finger.macro.ridge_rms = ridges;
    Balance before = solved(scene);
    while (!before.pull_in && scene.drive.amplitude < 2e4) {
      scene.drive.amplitude *= 1.02;
      const Balance b = solved(scene);
      EXPECT_EQ(b.to_fold, kInfinity);
      EXPECT_GT(b.stability, 0);
      EXPECT_LT(b.pressed_on, 1.4 * before.pressed_on) << scene.drive.amplitude;
      before = b;
    }
    EXPECT_TRUE(before.pull_in);
    EXPECT_GT(before.touching_on, 0.9);
  }
}

// Nothing attracts: what the load has brought into contact is no pull-in, however smooth the ridges
// are, and the mean pressure of the patches goes over into that of the smooth face.
TEST(Balance, WithoutAttractionNoGapIsPulledShut) {
  Scene scene = balanced(0);
  scene.finger.water.volume = {0, 0, 0, 0};
  double touching = 0;
  for (const double ridges : {1e-6, 0.1e-6, 10e-9, 1e-9, 1e-11, 1e-13}) {
    scene.finger.macro.ridge_rms = ridges;
    const ScaleBridge bridge(scene, small(), kGrid, kHumidity);
    const Balance& b = bridge.balance();
    EXPECT_FALSE(b.pull_in) << ridges;
    EXPECT_FALSE(b.pull_in_undriven) << ridges;
    EXPECT_GE(b.touching_off, touching) << ridges;
    touching = b.touching_off;
    if (ridges <= 1e-11) {
      EXPECT_NEAR(bridge.mean_pressure(), b.nominal, 1e-6 * b.nominal) << ridges;
    }
  }
  EXPECT_NEAR(touching, 1, 1e-9);
}

// A relief that is deep beside the gap takes away what it opens.
TEST(Balance, OverHolesTheOpenGapsPullLess) {
  const double flat = solved(balanced(100), 1, holes(0)).far.pull;
  EXPECT_NEAR(flat, solved(balanced(100)).far.pull, 1e-3 * flat);
  double before = flat;
  for (const double depth : {100e-9, 300e-9, 1e-6, 3e-6}) {
    const double pull = solved(balanced(100), 1, holes(depth)).far.pull;
    EXPECT_LT(pull, before) << depth;
    before = pull;
  }
  EXPECT_LT(before, 0.75 * flat);  // next to half of the area is left
  EXPECT_GT(before, 0.25 * flat);
}

// Second method for Eq. coupling.8: a solved map of 48 um, whose windows of 12 um that do not touch
// pull pixel by pixel. The law is told how far each stands and how rough it is. It is high beside a
// contact, where real skin has no gaps below 0 for it to fold up: by up to 17 %, over all windows
// by 7 %. What a texture takes away of the pull it has within 5 %.
TEST(Balance, TheLawOfOpenGapsIsTheSumOverASolvedMap) {
  Scene scene = balanced(200);
  const Skin& skin = scene.finger.skin;
  const Grid wide{256, 256, 48e-6, 48e-6};
  const FieldProblem field = field_problem(scene, kHumidity);
  double flat_ratio = 0;
  for (const double depth : {0.0, 300e-9, 900e-9}) {
    HoleArray array;
    array.period = 6e-6, array.diameter = 4e-6, array.depth = depth;
    const CoveredSurface surface(generate(Texture{array}, wide), film_of(scene));
    // Skin within patches, and ridges above them that leave most of the map open.
    std::vector<double> height = surface.height.z;
    const Heightmap within =
        random_surface({skin.rms, skin.roll_off, skin.hurst, 400e-9}, wide, 1, 0);
    std::vector<double> ridge(wide.size());
    for (int iy = 0; iy < wide.ny; ++iy)
      for (int ix = 0; ix < wide.nx; ++ix)
        ridge[wide.index(ix, iy)] =
            0.8e-6 * (std::cos(2 * kPi * ix / wide.nx) + std::cos(2 * kPi * iy / wide.ny));
    for (std::size_t i = 0; i < height.size(); ++i) height[i] += within.z[i] + ridge[i];
    const ContactSolution contact = solve_contact(*contact_kernel(scene, {}, wide, kHumidity),
                                                  height, 1e3, {}, ContactOptions{});
    ASSERT_TRUE(contact.converged());
    const SurfaceLevels as_made = surface_levels(surface, scene.surface.equivalent_thickness());
    double direct_sum = 0, law_sum = 0, windows = 0;
    for (int wy = 0; wy < 4; ++wy) {
      for (int wx = 0; wx < 4; ++wx) {
        double mean = 0, direct = 0, touching = 0, open = 0, open2 = 0;
        const double count = 64.0 * 64;
        for (int iy = 64 * wy; iy < 64 * (wy + 1); ++iy) {
          for (int ix = 64 * wx; ix < 64 * (wx + 1); ++ix) {
            const std::size_t i = wide.index(ix, iy);
            const double gap = contact.gap[i];
            touching += gap <= 0;
            mean += (gap + surface.height.z[i]) / count;
            open += gap / count;
            open2 += square(gap + surface.height.z[i]) / count;
            direct += 1 /
                      (square(gap + surface.effective[i] + field.skin_layer.real()) +
                       square(field.skin_layer.imag())) /
                      count;
          }
        }
        if (touching > 0) continue;
        direct *= 0.5 * kVacuumPermittivity * square(field.v_rms);
        // The skin stands at `mean` over height 0, and about it by its own roughness.
        GapDistribution gaps;
        gaps.share = {1}, gaps.offset = {mean}, gaps.wave_number = {1};
        gaps.width = {std::sqrt(open2 - square(mean))};
        const double law = open_gap_pull(gap_shares(gaps, 10), as_made, field);
        EXPECT_NEAR(law, direct, 0.2 * direct) << depth << " window " << wx << " " << wy;
        direct_sum += direct, law_sum += law, windows += 1;
      }
    }
    EXPECT_GE(windows, 8) << depth;
    EXPECT_NEAR(law_sum, direct_sum, 0.1 * direct_sum) << depth;
    if (depth == 0) flat_ratio = law_sum / direct_sum;
    EXPECT_NEAR(law_sum / direct_sum, flat_ratio, 0.05) << depth;
  }
}

// What lies between two gaps of the row is shared out between them: nothing and no length is lost.
TEST(GapShares, KeepTheAreaAndTheMeanGapOnTheirPartOfTheRow) {
  GapDistribution gaps;
  gaps.share = {0.3, 0.7}, gaps.offset = {1e-6, 20e-6}, gaps.width = {0.1e-6, 2e-6};
  gaps.wave_number = {1, 1};
  const GapShares row = gap_shares(gaps, 10);
  ASSERT_FALSE(row.share.empty());
  EXPECT_GT(row.share.front(), 0);
  EXPECT_GT(row.share.back(), 0);
  EXPECT_GT(row.gaps().front(), 0.2e-6);
  EXPECT_LT(row.gaps().back(), 40e-6);
  double area = 0, volume = 0;
  for (std::size_t i = 0; i < row.share.size(); ++i) {
    area += row.share[i];
    volume += row.share[i] * row.gaps()[i];
  }
  EXPECT_NEAR(area, 1, 1e-6);
  EXPECT_NEAR(volume, 0.3 * 1e-6 + 0.7 * 20e-6, 1e-6 * volume);
  EXPECT_TRUE(gap_shares(gaps, 0.5).share.empty());
}

// Where skin comes to rest: on half of the area as on glass that has lost next to nothing by it,
// and never above the highest place.
TEST(Balance, SkinRestsOnTheHighestPlaces) {
  const SurfaceLevels flat = resting(holes(0), 256e-9, 0.01);
  for (const double below : flat.below) EXPECT_NEAR(below, 0, 1e-12);
  const SurfaceLevels deep = resting(holes(5e-6), 256e-9, 0.01);
  // Q(d/s) / 2 = .01 at d = 2.054 s in place of 2.326 s.
  EXPECT_NEAR(deep.below[0], -(2.3263 - 2.0537) * 256e-9, 1e-10);
  EXPECT_NEAR(deep.below[1] - deep.below[0], 5e-6, 1e-12);
}

// Second method for Eq. coupling.9: droplets settled under skin that hangs over flat glass.
TEST(Balance, WaterOfOpenGapsHoldsWhatSettledDropletsHold) {
  Scene scene = balanced(0);
  const PatchSetup setup(scene, Texture{}, small());
  const double humidity = 0.75;
  const FarWater water{scene.finger.water.volume_per_area(humidity),
                       scene.finger.water.drops_per_um3 * 1e18,
                       water_properties(scene, scene.surface.contact_angle),
                       water_properties(scene, scene.surface.contact_angle)};
  const double gain = wetting_gain(water.rest.theta_skin, water.rest.theta_substrate);
  const Grid& grid = setup.plan().grid;
  DropletOptions options;
  options.drops_per_volume = water.drops_per_volume;
  options.first_step = scene.model.droplet_step;
  for (const double stands : {0.75e-6, 0.85e-6}) {
    double direct = 0, law = 0;
    for (int k = 0; k < 6; ++k) {
      const Heightmap skin = setup.skin(k);
      const auto count = static_cast<double>(skin.z.size());
      const double mean = std::accumulate(skin.z.begin(), skin.z.end(), 0.0) / count;
      double square_sum = 0;
      Gap gap{grid, skin.z};
      for (double& g : gap.value) {
        square_sum += square(g - mean);
        g = std::max(0.0, stands - (g - mean));
      }
      direct += settle_droplets(gap, water.per_area * grid.area(), water.rest, options, 1,
                                static_cast<std::uint64_t>(k))
                    .capillary_force /
                grid.area();
      law += gain * held_by_water({}, std::sqrt(square_sum / count), stands, water).capillary;
    }
    EXPECT_GT(direct, 0);
    EXPECT_LT(law, 2 * direct) << stands;
    EXPECT_GT(law, 0.5 * direct) << stands;
  }
  // Nearly all of it lies within a droplet's reach of where patches just touch.
  EXPECT_LT(held_by_water({}, 256e-9, 1.3e-6, water).capillary,
            0.02 * held_by_water({}, 256e-9, 0.75e-6, water).capillary);
}

// Heights that are independent in a million places: the mean of their maximum is 4.86.
TEST(Balance, APatchTouchesWithTheHighestOfItsPlaces) {
  EXPECT_GT(touching_gap(256e-9, 1, 144e-12), 3 * 256e-9);
  EXPECT_LT(touching_gap(256e-9, 1, 144e-12), 4 * 256e-9);
  EXPECT_GT(touching_gap(256e-9, 2, 144e-12), touching_gap(256e-9, 1, 144e-12));
  EXPECT_EQ(touching_gap(0, 1, 144e-12), 0);
}

// Eq. scene.13: hydrated skin that has lost a tenth of its relief is skin that has a tenth less.
TEST(Balance, OpenGapsAreThoseOfTheReliefThatIsLeft) {
  Scene lost = balanced(60);
  lost.finger.skin.hydration = 0.2;
  lost.finger.skin.relief_saturated = 0.5;
  Scene less = lost;
  less.finger.skin.relief_saturated = 1;
  less.finger.skin.rms *= 0.9;
  const Balance a = solved(lost, 1, holes(300e-9)), b = solved(less, 1, holes(300e-9));
  ASSERT_GT(b.far.pull, 0);
  EXPECT_NEAR(a.far.pull, b.far.pull, 1e-9 * b.far.pull);
  EXPECT_NEAR(a.far.capillary, b.far.capillary, 1e-9 * std::abs(b.far.capillary));
  EXPECT_NEAR(a.pressed_on, b.pressed_on, 1e-9 * b.pressed_on);
}

// Eq. coupling.6: what gives without end finds no more patches than the ridges have.
TEST(Balance, ASoftFilmIsCarriedByNoMoreThanTheRidges) {
  Scene scene;
  scene.finger = one_pass_finger();
  const double most = scene.finger.macro.ridge_share;
  double share = 0;
  for (const double modulus : {1e9, 1e7, 2.6e6, 1e5, 1e3, 1.0}) {
    scene.surface.modulus = modulus;
    const ScaleBridge bridge(scene, small(), kGrid, kHumidity, {3e-6, 0.4});
    EXPECT_GE(bridge.carrying_share(), share) << modulus;
    EXPECT_LE(bridge.carrying_share(), most) << modulus;
    EXPECT_NEAR(bridge.carrying_share() * bridge.mean_pressure(),
                scene.finger.macro.load_share * scene.finger.patch_pressure(kHumidity),
                1e-6 * bridge.carrying_share() * bridge.mean_pressure());
    share = bridge.carrying_share();
    EXPECT_EQ(bridge.combine(std::vector<PatchResult>(1)).status.sound(), share < 0.95 * most);
    // Which hides no patch whose gap closes.
    std::vector<PatchResult> closes(1);
    closes[0].status.note({Trouble::ClosedPullIn, 0, ""});
    EXPECT_TRUE(bridge.combine(closes).status.pull_in()) << modulus;
  }
  EXPECT_GT(share, 0.95 * most);
  Scene balance = balanced(150);
  balance.surface.modulus = 1;
  const ScaleBridge bridge(balance, small(), kGrid, kHumidity, {3e-6, 0.4});
  EXPECT_LE(bridge.balance().touching_on, 1);
  EXPECT_GT(bridge.balance().touching_off, 0.5);
}

// Steps of a sweep lie on a smooth curve: no value is off the middle of its neighbours by more
// than neighbours of a smooth law are.
template <class Of>
void expect_smooth(const char* what, double first, double last, const Of& of) {
  constexpr int kCount = 17;
  std::vector<double> value;
  for (int i = 0; i < kCount; ++i)
    value.push_back(std::log(of(first * std::pow(last / first, i / (kCount - 1.0)))));
  double largest = 0;
  for (int i = 1; i < kCount; ++i) largest = std::max(largest, std::abs(value[i] - value[i - 1]));
  for (int i = 1; i + 1 < kCount; ++i)
    EXPECT_LT(std::abs(value[i + 1] - 2 * value[i] + value[i - 1]), 0.25 * largest + 1e-4)
        << what << " " << i;
}

TEST(Balance, HasNoStepOverRidgesLoadAndFilm) {
  const Scene scene = balanced(100);
  expect_smooth("ridge_rms", 1.5e-6, 6e-6, [&](double x) {
    Scene s = scene;
    s.finger.macro.ridge_rms = x;
    return solved(s, 1, holes(350e-9)).pressed_on;
  });
  expect_smooth("load", 0.1, 0.8, [&](double x) {
    Scene s = scene;
    s.finger.load = x;
    return solved(s, 1, holes(350e-9)).pressed_on;
  });
  for (const Closure closure : {Closure::Uniform, Closure::Balance}) {
    expect_smooth("modulus", 3e4, 1e6, [&](double x) {
      Scene s = scene;
      s.model.closure = closure;
      s.surface.modulus = x;
      return ScaleBridge(s, small(), kGrid, kHumidity, {3e-6, 0.4}).mean_pressure();
    });
  }
}

// The load law and solved areas speak of one model: more patches touch, in proportion.
TEST(Balance, TheLoadLawCountsTheOpenGapsInProportion) {
  Scene scene = balanced(150);
  scene.finger.water.volume = {0, 0, 0, 0};
  const double by_load =
      evaluate(scene, Texture{}, small(Estimator::Load)).points[0].modulation.value;
  const double by_area =
      evaluate(scene, Texture{}, small(Estimator::Area)).points[0].modulation.value;
  EXPECT_NEAR(by_load, by_area, 0.05 * (1 + by_area));
}

}  // namespace
}  // namespace papilla::tests::balance_test
