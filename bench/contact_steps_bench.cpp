// Transform pairs of the dense contact solver, summed over many states: what the constants of its
// step control are chosen by (change one in physics/contact, build, compare). The same number on
// every machine without fused multiply-adds.
//     contact_steps_bench
#include <fmt/format.h>

#include <cmath>

#include "base/constants.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"
#include "scene/finger.h"

namespace papilla::tests {
namespace {

class Pairs {
 public:
  ContactSolution solve(const ContactKernel& kernel, const Heightmap& height, double load,
                        ContactOptions options, std::span<const double> traction = {},
                        const ContactSolution* start = nullptr) {
    options.method = ContactMethod::Dense;
    return count(solve_contact(kernel, height.z, load, traction, options, start));
  }
  ContactSolution count(ContactSolution s) {
    pairs_ += s.fft_pairs;
    ++states_;
    unsolved_ += s.converged() ? 0 : 1;
    return s;
  }
  void print() const {
    fmt::print("pairs {:.1f}, states {}, unsolved {}\n", pairs_, states_, unsolved_);
  }

 private:
  double pairs_ = 0;
  int states_ = 0, unsolved_ = 0;
};

// H = 0.8, rms slope 0.5, cut-off of 8 pixels, E* = 1.
void rough(int n, Pairs& pairs) {
  const Grid grid{n, n, 1, 1};
  Heightmap surface = random_surface({0.1, 1, 0.8, 8.0 / n, 1}, grid, 7, 0);
  double slope = 0;
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix) {
      slope += 2 * square((surface(wrap(ix + 1, n), iy) - surface(ix, iy)) * n) /
               static_cast<double>(grid.size());
    }
  }
  for (double& z : surface.z) z *= 0.5 / std::sqrt(slope);
  const auto kernel = make_contact_kernel(grid, {1, 0, 0, 1, 0});
  for (double load : {0.01, 0.05, 0.2, 0.4}) {
    for (double t : {1e-3, 1e-4, 1e-8}) {
      pairs.solve(*kernel, surface, load, {.tolerance = t});
      if (load < 0.1) pairs.solve(*kernel, surface, load, {.tolerance = t, .hardness = 0.5});
    }
  }
}

// The reference finger: cold, at the next humidity, under a disc of traction.
void finger(int n, std::uint64_t seed, Pairs& pairs) {
  const Finger finger;
  const Skin& skin = finger.skin;
  const Grid grid{n, n, 12e-6, 12e-6};
  const auto kernel =
      make_contact_kernel(grid, {skin.layer_modulus, skin.layer_poisson, skin.layer_thickness,
                                 skin.bulk_modulus, skin.bulk_poisson});
  const Heightmap height =
      random_surface({skin.rms, skin.roll_off, skin.hurst, skin.cutoff}, grid, seed, 0);
  const double mean = finger.patch_pressure(0.15),
               humid = finger.patch_pressure(0.35) / skin.modulus_factor(0.35);
  std::vector<double> traction(grid.size(), 0.0);
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix) {
      if (std::hypot(grid.x(ix) - 4e-6, grid.y(iy) - 7e-6) < 2e-6) {
        traction[grid.index(ix, iy)] = 2 * mean;
      }
    }
  }
  for (double t : {1e-3, 1e-4, 1e-6, 1e-8}) {
    const ContactSolution base = pairs.solve(*kernel, height, mean, {.tolerance = t});
    pairs.solve(*kernel, height, humid, {.tolerance = t}, {}, &base);
    pairs.solve(*kernel, height, mean, {.tolerance = t}, traction, &base);
  }
}

// Light contact on stiff skin, and a given approach.
void light(int n, std::uint64_t seed, Pairs& pairs) {
  const Grid grid{n, n, 12e-6, 12e-6};
  const auto kernel = make_contact_kernel(grid, {200e6, 0.5, 1e-6, 25e6, 0.5});
  const Heightmap height = random_surface({330e-9, 12e-6, 0.8, 50e-9}, grid, seed, 0);
  for (double t : {1e-4, 1e-8}) {
    const ContactSolution base = pairs.solve(*kernel, height, 15e3, {.tolerance = t});
    pairs.solve(*kernel, height, 16.5e3, {.tolerance = t}, {}, &base);
    pairs.count(solve_approach(*kernel, height.z, 2e-7, {.tolerance = t}));
  }
}

}  // namespace
}  // namespace papilla::tests

int main() {
  papilla::tests::Pairs pairs;
  for (int n : {64, 128, 256}) {
    papilla::tests::rough(n, pairs);
    for (std::uint64_t seed : {1, 2, 3}) {
      papilla::tests::finger(n, seed, pairs);
      papilla::tests::light(n, seed, pairs);
    }
  }
  pairs.print();
}
