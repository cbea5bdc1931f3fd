// Laws that hold for every scene, on up to 10^4 random ones: numbers are finite, dimensions are
// homogeneous, more voltage pulls more, more load rubs more, a mirrored contact is the same
// contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "forward/forward.h"
#include "geometry/roughness.h"
#include "measure/coverage.h"
#include "physics/contact/contact.h"
#include "tests/support/thorough.h"

namespace papilla::tests::property_slow_test {
namespace {

const int kScenes = cases(1500, 10000);

Fidelity tiny() {
  Fidelity f = fidelity_level("search");
  f.grid = 16;
  f.skins = 1;
  f.threads = 1;
  return f;
}

Response run(const Scene& scene, const Texture& texture) {
  return evaluate(scene, texture, tiny());
}

// Every stress and modulus times four, at the same lengths: surface tension and forces times four,
// voltage times two.
Scene stiffer(Scene s) {
  Finger& f = s.finger;
  for (double* v : {&f.load, &f.skin.layer_modulus, &f.skin.bulk_modulus, &f.skin.hardness,
                    &f.macro.shear_strength, &f.macro.tissue_modulus, &f.water.surface_tension,
                    &s.surface.modulus})
    *v *= 4;
  // The gross area follows its own law of load.
  f.macro.area_15 /= std::pow(4, f.macro.load_exponent);
  s.drive.amplitude *= 2;
  for (Dielectric& layer : s.surface.dielectric) layer.strength *= 2;
  return s;
}

void expect_finite(const ResponsePoint& p, int scene) {
  for (const PointQuantity& q : kPointQuantities) {
    const Measured& m = p.*q.value;
    ASSERT_TRUE(std::isfinite(m.value) && std::isfinite(m.se()) && m.se() >= 0) << scene;
  }
  ASSERT_GE(p.friction_off.value, 0) << scene;
  ASSERT_GE(p.electrostatic_force.value, 0) << scene;
  ASSERT_GE(p.mean_gap.value, 0) << scene;
  ASSERT_TRUE(p.wetted_fraction.value >= 0 && p.wetted_fraction.value <= 1 + 1e-12) << scene;
}

TEST(Property, EverySceneIsFiniteAndHomogeneousAndMonotone) {
  int scaled = 0, voltages = 0, loads = 0, changed = 0;
  for (int i = 0; i < kScenes; ++i) {
    Texture texture;
    Scene scene = random_scene(i, texture);
    if (i % 10 == 0) {
      const Response settled = run(scene, texture);
      for (const ResponsePoint& p : settled.points) {
        if (p.status.sound()) expect_finite(p, i);
      }
    }
    // An equilibrium is found to a tolerance, far above rounding, and has none beyond pull-in; the
    // air breaks down at fields of its own.
    scene.model.coupling = Coupling::OnePass;
    scene.model.air_limit = AirLimit::None;
    const Response r = run(scene, texture);
    for (const ResponsePoint& p : r.points) expect_finite(p, i);
    if (i % 3 == 0) {
      const Response s = run(stiffer(scene), texture);
      for (std::size_t k = 0; k < r.points.size(); ++k) {
        // Droplets choose between states of nearly equal energy: rounding may decide a few.
        const double a = r.points[k].modulation.value, b = s.points[k].modulation.value;
        const double f = 4 * r.points[k].friction_off.value, g = s.points[k].friction_off.value;
        if (std::abs(a - b) > 1e-6 * (1 + std::abs(a)) || std::abs(f - g) > 1e-6 * f) ++changed;
        ++scaled;
      }
    } else if (i % 3 == 1) {
      scene.finger.water.volume = {0, 0, 0, 0};
      const Response low = run(scene, texture);
      scene.drive.amplitude *= 1.3;
      const Response high = run(scene, texture);
      for (std::size_t k = 0; k < low.points.size(); ++k) {
        ASSERT_NEAR(high.points[k].electrostatic_force.value,
                    1.69 * low.points[k].electrostatic_force.value,
                    1e-9 * high.points[k].electrostatic_force.value)
            << i;
        ASSERT_GE(high.points[k].modulation.value, low.points[k].modulation.value) << i;
        ++voltages;
      }
    } else {
      scene.finger.water.volume = {0, 0, 0, 0};
      scene.drive.amplitude = 0;
      const Response low = run(scene, texture);
      scene.finger.load *= 1.5;
      const Response high = run(scene, texture);
      for (std::size_t k = 0; k < low.points.size(); ++k) {
        ASSERT_GT(high.points[k].friction_off.value, low.points[k].friction_off.value) << i;
        ASSERT_LE(high.points[k].mean_gap.value, low.points[k].mean_gap.value * (1 + 1e-6)) << i;
        ++loads;
      }
    }
  }
  std::cout << kScenes << " scenes, " << scaled << " states scaled (" << changed << " differ), "
            << voltages << " with more voltage, " << loads << " with more load\n";
  EXPECT_LE(changed, scaled / 200);
}

TEST(Property, AMirroredOrTransposedContactIsTheSameContact) {
  const Grid grid{24, 24, 12e-6, 12e-6};
  const auto kernel = make_contact_kernel(grid, {66e6, 0.5, 1e-6, 60e6, 0.5, 0, 0.4});
  for (int i = 0; i < cases(200, 1000); ++i) {
    RandomStream random(1, "mirror", static_cast<std::uint64_t>(i));
    const std::vector<double> h =
        random_surface({256e-9, 3.7e-6, 0.8, 1e-6}, grid, 1, static_cast<std::uint64_t>(i)).z;
    const double pressure = 1e4 * std::pow(300, random.uniform());
    std::vector<double> other(h.size());
    for (int y = 0; y < grid.ny; ++y) {
      for (int x = 0; x < grid.nx; ++x) {
        other[grid.index(i % 2 == 0 ? grid.nx - 1 - x : y, i % 2 == 0 ? y : x)] =
            h[grid.index(x, y)];
      }
    }
    const ContactOptions options{.tolerance = 1e-10};
    const ContactSolution a = solve_contact(*kernel, h, pressure, {}, options);
    const ContactSolution b = solve_contact(*kernel, other, pressure, {}, options);
    ASSERT_NEAR(a.elastic_energy, b.elastic_energy, 1e-6 * a.elastic_energy) << i;
    ASSERT_NEAR(a.shift, b.shift, 1e-6 * std::abs(a.shift) + 1e-15) << i;
  }
}

}  // namespace
}  // namespace papilla::tests::property_slow_test
