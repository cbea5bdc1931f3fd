// Permittivities over frequency, and the field that a saturating film still makes.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "scene/environment.h"

namespace papilla::tests::relaxation_test {
namespace {

Relaxation relaxation(RelaxationLaw law, double infinite, double time, double alpha = 0) {
  Relaxation out;
  out.law = law, out.infinite = infinite, out.time = time, out.alpha = alpha;
  return out;
}

Relaxation table(std::vector<double> frequency, std::vector<double> permittivity,
                 std::vector<double> loss) {
  Relaxation out;
  out.law = RelaxationLaw::Table;
  out.frequency = std::move(frequency);
  out.permittivity = std::move(permittivity);
  out.loss = std::move(loss);
  return out;
}

TEST(Relaxation, DebyeLosesHalfAtItsFrequency) {
  const Relaxation debye = relaxation(RelaxationLaw::Debye, 2, 1e-3);
  const std::complex<double> there = 10.0 * debye.share(10, 1 / (2 * kPi * 1e-3));
  EXPECT_NEAR(there.real(), 6, 1e-12);
  EXPECT_NEAR(there.imag(), -4, 1e-12);
  EXPECT_NEAR(debye.share(10, 1e-9).real(), 1, 1e-9);
  EXPECT_NEAR(debye.share(10, 1e12).real(), 0.2, 1e-6);
}

// At its frequency (j)^(1 - alpha) = exp(j pi (1 - alpha)/2): by hand for alpha = 1/2.
TEST(Relaxation, ColeAndColeIsWider) {
  const Relaxation wide = relaxation(RelaxationLaw::ColeCole, 2, 1e-3, 0.5);
  const std::complex<double> there = 10.0 * wide.share(10, 1 / (2 * kPi * 1e-3));
  EXPECT_NEAR(there.real(), 6, 1e-12);
  EXPECT_NEAR(there.imag(), -4 * std::tan(kPi / 8), 1e-12);
  const Relaxation debye = relaxation(RelaxationLaw::Debye, 2, 1e-3);
  const Relaxation narrow = relaxation(RelaxationLaw::ColeCole, 2, 1e-3);
  EXPECT_EQ(narrow.share(10, 70), debye.share(10, 70));
}

TEST(Relaxation, ATableIsStraightOverTheLogarithmAndHeldOutside) {
  const Relaxation known = table({10, 1000}, {8, 4}, {0, 2});
  EXPECT_EQ(known.share(8, 1), std::complex(1.0, -0.0));
  EXPECT_NEAR(known.share(8, 100).real(), 0.75, 1e-12);
  EXPECT_NEAR(known.share(8, 100).imag(), -0.125, 1e-12);
  EXPECT_NEAR(known.share(8, 1e6).real(), 0.5, 1e-12);
}

TEST(Relaxation, WhatContradictsIsNamed) {
  Dielectric film;
  EXPECT_EQ(relaxation_problem(film).key, "");
  film.relaxation.law = RelaxationLaw::Debye;
  EXPECT_EQ(relaxation_problem(film).key, "time");
  film.relaxation.time = 1e-3;
  film.relaxation.infinite = 5;  // above 3.9
  EXPECT_EQ(relaxation_problem(film).key, "infinite");
  film.relaxation = table({10, 10}, {3, 2}, {});
  EXPECT_EQ(relaxation_problem(film).key, "frequency");
}

// D = eps0 eps E up to the field of saturation, and the air above carries the same D.
TEST(Saturation, TheWeakestLayerHoldsTheFieldInTheAir) {
  Surface surface;
  EXPECT_EQ(surface.saturated_air_field(), kInfinity);
  surface.dielectric[0].saturation_field = 50e6;
  surface.dielectric.push_back(surface.dielectric[0]);
  surface.dielectric[1].permittivity = 2;
  EXPECT_NEAR(surface.saturated_air_field(), 2 * 50e6, 1e-3);
}

}  // namespace
}  // namespace papilla::tests::relaxation_test
