// The equations of docs/theory/persson.md where their integrals are known or quickly taken by a
// second way: one power law on one elastic half-space, bands of gaps without a spread, single
// pulls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/constants.h"
#include "base/random.h"
#include "numerics/quadrature.h"
#include "physics/contact/contact.h"
#include "physics/persson/gap_integrals.h"
#include "physics/persson/persson.h"
#include "physics/persson/power_law.h"

namespace papilla::tests::theory_test {
namespace {

double relative(double a, double b) { return std::abs(a - b) / std::abs(b); }

// C = 2e-22 (q/2e4)^-3.6 m^4 from 2e4 to 1e7 1/m on E* = 3.2 MPa.
constexpr double kLow = 2e4, kHigh = 1e7, kScale = 2e-22, kExponent = -3.6, kStar = 2.4e6 / 0.75;
constexpr double kKappa = 1.9, kGamma = 0.6;
constexpr int kIntervals = 200;
constexpr MeanFieldSolid kUniform{1, 0.5, 0, 2.4e6, 0.5};
constexpr MeanFieldOptions kOptions{
    .kappa = kKappa, .energy_factor = kGamma, .intervals = kIntervals};

double power_of(double q) { return kScale * std::pow(q / kLow, kExponent); }
PowerSpectrum power_law() { return {{kLow, kHigh}, {kScale, power_of(kHigh)}}; }
// 2 pi int q^(order + 1) C dq
double moment_of(int order, double a, double b) {
  const double n = order + 2 + kExponent;
  return 2 * kPi * kScale * std::pow(kLow, -kExponent) * (std::pow(b, n) - std::pow(a, n)) / n;
}
// Eq. persson.3
double measure_of(double q, double kappa = kKappa) {
  return 0.5 * square(kPurePersson / kappa) * square(kStar) * moment_of(2, kLow, q);
}
double integral(double a, double b, int nodes, const std::function<double(double)>& f) {
  static std::map<int, Quadrature> rules;  // each made once
  Quadrature& rule = rules[nodes];
  if (rule.nodes.empty()) rule = gauss_legendre(nodes);
  double sum = 0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k)
    sum += rule.weights[k] * f(0.5 * (a + b) + 0.5 * (b - a) * rule.nodes[k]);
  return 0.5 * (b - a) * sum;
}
// F of Eq. persson.7, over ln t.
double gap_factor(double x, double gamma) {
  if (x > 6) return 0;
  return integral(std::log(x), std::log(6.5), 50, [&](double v) {
    const double t = std::exp(v);
    return std::exp(-t * t) * (gamma + 3 * (1 - gamma) * square(std::erf(t)));
  });
}
// Eq. persson.7 at a magnification, under the pressure of the area that touches there.
double gap_of(double from, double pressure) {
  return integral(std::log(from), std::log(kHigh), 100, [&](double v) {
    const double q = std::exp(v), s = 1 / std::sqrt(measure_of(q) - measure_of(from));
    return std::sqrt(kPi) * cube(q) * power_of(q) * kStar * s * gap_factor(s * pressure, kGamma);
  });
}

TEST(MeanFieldTheory, DefaultsAreThePapersSkin) {
  EXPECT_EQ(MeanFieldSolid{}, (MeanFieldSolid{40e6, 0.5, 200e-6, 10e3, 0.5}));
  const MeanFieldOptions options;
  EXPECT_EQ(options.kappa, 2);
  EXPECT_EQ(options.energy_factor, 0.45);
  EXPECT_EQ(options.intervals, 450);
  EXPECT_EQ(options.smallest_gap, 0);
  const SkinDielectric skin;
  EXPECT_EQ(skin.frequency, (std::vector<double>{1, 30, 1000}));
  EXPECT_EQ(skin.permittivity, (std::vector<double>{1e4, 5e3, 1e3}));
  EXPECT_EQ(skin.resistivity_frequency, (std::vector<double>{30, 1000}));
  EXPECT_EQ(skin.resistivity, (std::vector<double>{6e4, 2e4}));
  const PowerSpectrum wrist = wrist_spectrum();
  EXPECT_EQ(wrist.wave_number, (std::vector<double>{800, 5998.2, 1e8}));
  EXPECT_EQ(wrist.density[0], wrist.density[1]);
  EXPECT_NEAR(std::log(wrist.density[2] / wrist.density[1]) / std::log(1e8 / 5998.2), -3.72, 1e-12);
}

// E* = 2/(q C) of the layered half-space that the contact solver has, in its own words.
TEST(MeanFieldTheory, TheModulusOfALayeredSolidIsThatOfTheContactSolver) {
  RandomStream random(3, "solids", 0);
  for (int k = 0; k < 200; ++k) {
    const double layer = std::pow(10, random.uniform(4, 9)),
                 bulk = std::pow(10, random.uniform(4, 9)), n1 = random.uniform(0, 0.5),
                 n2 = random.uniform(0, 0.5), d = 1e-4, q = std::pow(10, random.uniform(2.5, 5.4));
    const double expected = 2 / (q * compliance(LayeredSolid{layer, n1, d, bulk, n2}, q));
    EXPECT_LT(relative(effective_modulus({layer, n1, d, bulk, n2}, q), expected), 1e-9) << k;
  }
  const MeanFieldSolid solid{3e6, 0.3, 1e-4, 2e5, 0.4};
  MeanFieldSolid alone = solid;
  alone.layer_thickness = 0;
  EXPECT_DOUBLE_EQ(effective_modulus(alone, 1e4), 2e5 / 0.84);
  alone.layer_thickness = kInfinity;
  EXPECT_DOUBLE_EQ(effective_modulus(alone, 1e4), 3e6 / 0.91);
}

TEST(PowerSpectrum, HasTheMomentsAndValuesOfItsPieces) {
  // Flat to 1e4, then q^-3: C = 5e-20 and 5e-20 (q/1e4)^-3.
  const PowerSpectrum s{{1e3, 1e4, 1e6}, {5e-20, 5e-20, 5e-26}};
  EXPECT_EQ(s.at(999), 0);
  EXPECT_EQ(s.at(1.001e6), 0);
  EXPECT_DOUBLE_EQ(s.at(1e3), 5e-20);
  EXPECT_LT(relative(s.at(1e6), 5e-26), 1e-12);
  EXPECT_DOUBLE_EQ(s.at(5e3), 5e-20);
  EXPECT_LT(relative(s.at(2e4), 5e-20 / 8), 1e-12);
  EXPECT_LT(relative(s.at(5e5), 5e-20 / 125000), 1e-12);
  // 2 pi int q C, q^2 C, q^3 C over both pieces, by hand: q^-2, q^-1, 1 above the knee.
  const double c = 2 * kPi * 5e-20;
  const auto whole = [&](int order) { return s.moment(order, 1e3, 1e6); };
  EXPECT_LT(relative(whole(0), c * ((1e8 - 1e6) / 2 + 1e12 * (1e-4 - 1e-6))), 1e-12);
  EXPECT_LT(relative(whole(1), c * ((1e12 - 1e9) / 3 + 1e12 * std::log(100.0))), 1e-12);
  EXPECT_LT(relative(whole(2), c * ((1e16 - 1e12) / 4 + 1e12 * (1e6 - 1e4))), 1e-12);
  EXPECT_LT(relative(s.moment(0, 4e3, 2e4), c * ((1e8 - 16e6) / 2 + 1e12 * (1e-4 - 5e-5))), 1e-12);
  EXPECT_DOUBLE_EQ(s.moment(0, 10, 1e9), whole(0));
  EXPECT_EQ(s.moment(0, 1e7, 1e8), 0);
  EXPECT_EQ(s.moment(0, 2e4, 2e4), 0);
  EXPECT_DOUBLE_EQ(s.rms(), std::sqrt(whole(0)));
  EXPECT_DOUBLE_EQ(s.slope(), std::sqrt(whole(2)));
  EXPECT_EQ(s.lowest(), 1e3);
  EXPECT_EQ(s.highest(), 1e6);
  EXPECT_EQ(s.scaled(4), (PowerSpectrum{{1e3, 1e4, 1e6}, {2e-19, 2e-19, 2e-25}}));
}

TEST(PowerSpectrum, ABandKeepsItsKnotsAndEndsWhereItIsCut) {
  const PowerSpectrum s{{1e3, 1e4, 1e5, 1e6}, {5e-20, 5e-20, 5e-23, 5e-26}};
  const PowerSpectrum cut = s.between(2e3, 2e5);
  EXPECT_EQ(cut.wave_number, (std::vector<double>{2e3, 1e4, 1e5, 2e5}));
  ASSERT_EQ(cut.density.size(), 4u);
  EXPECT_EQ(cut.density[1], 5e-20);
  EXPECT_EQ(cut.density[2], 5e-23);
  EXPECT_LT(relative(cut.density[0], 5e-20), 1e-12);
  EXPECT_LT(relative(cut.density[3], 5e-23 / 8), 1e-12);
  EXPECT_EQ(s.between(1e4, 1e5).wave_number, (std::vector<double>{1e4, 1e5}));  // none twice
  EXPECT_EQ(s.between(1, 1e9).wave_number, s.wave_number);
  EXPECT_THROW(s.between(2e4, 2e4), InternalError);
  EXPECT_THROW(s.between(1, 1e3), InternalError);
}

// Eq. persson.1
TEST(PowerSpectrum, SelfAffineRoughnessIsFlatAndThenFallsByItsHurstExponent) {
  const PowerSpectrum s = self_affine_spectrum(3e-6, 1e3, 4e3, 1e6, 0.7);
  EXPECT_EQ(s.wave_number, (std::vector<double>{1e3, 4e3, 1e6}));
  EXPECT_DOUBLE_EQ(s.rms(), 3e-6);
  EXPECT_EQ(s.density[0], s.density[1]);
  EXPECT_LT(relative(s.at(4e4) / s.at(4e3), std::pow(10, -3.4)), 1e-12);
  const PowerSpectrum steep = self_affine_spectrum(3e-6, 4e3, 4e3, 1e6, 0.7);
  EXPECT_EQ(steep.wave_number, (std::vector<double>{4e3, 1e6}));
  EXPECT_DOUBLE_EQ(steep.rms(), 3e-6);
  EXPECT_THROW(self_affine_spectrum(3e-6, 0, 4e3, 1e6, 0.7), InternalError);
  EXPECT_THROW(self_affine_spectrum(3e-6, 5e3, 4e3, 1e6, 0.7), InternalError);
  EXPECT_THROW(self_affine_spectrum(3e-6, 1e3, 1e6, 1e6, 0.7), InternalError);
}

TEST(PowerLaw, CurvesAreStraightInLogLogAndGoOnBeyondTheirEnds) {
  const std::vector<double> x{1, 10, 1000}, y{2, 200, 2};  // q^2, then 1/q
  for (const auto& [at, value] :
       {std::pair{0.1, 0.02}, {1.0, 2.0}, {3.0, 18.0}, {10.0, 200.0}, {20.0, 100.0}, {1e4, 0.2}})
    EXPECT_LT(relative(persson::log_log(x, y, at), value), 1e-12) << at;
  EXPECT_EQ(persson::log_log({5}, {7}, 100), 7);
  // int_a^b q^n dq on both sides of n = -1, and where the exponential's series would lose it.
  for (const double n : {-2.5, -1.001, -0.999, 0.0, 3.0}) {
    const double exact = (std::pow(5, n + 1) - std::pow(2, n + 1)) / (n + 1);
    EXPECT_LT(relative(persson::power_integral(n, 2, 5), exact), 1e-11) << n;
  }
  EXPECT_LT(relative(persson::power_integral(-1 + 1e-13, 2, 5), std::log(2.5)), 1e-11);
}

// Eqs. persson.3-5
TEST(MeanFieldTheory, StressAndAreaOfAPowerLawAreTheirClosedForms) {
  const MeanField field(power_law(), kUniform, kOptions);
  for (double q = 1.01 * kLow; q < kHigh; q *= 1.173)
    EXPECT_LT(relative(field.stress_measure(q), measure_of(q)), 1e-7) << q;
  EXPECT_LT(relative(field.stress_measure(), measure_of(kHigh)), 1e-10);
  EXPECT_EQ(field.stress_measure(2 * kHigh), field.stress_measure());
  EXPECT_EQ(field.stress_measure(kHigh), field.stress_measure());
  EXPECT_EQ(field.stress_measure(kLow), 0);
  EXPECT_EQ(field.stress_measure(kLow / 2), 0);
  const double q = 3e5, p = 4e3, m = measure_of(q);
  EXPECT_LT(relative(field.area(p), std::erf(p / std::sqrt(measure_of(kHigh)))), 1e-9);
  EXPECT_LT(relative(field.area(p, q), std::erf(p / std::sqrt(m))), 1e-7);
  EXPECT_EQ(field.area(p, kLow), 1);
  EXPECT_EQ(field.area(0, kLow), 0);
  EXPECT_EQ(field.area(0, q), 0);
  for (const double s : {1e3, 5e3, 2e4}) {
    const double expected =
        (std::exp(-square(s - p) / m) - std::exp(-square(s + p) / m)) / std::sqrt(kPi * m);
    EXPECT_LT(relative(field.pressure_density(s, p, q), expected), 1e-6) << s;
  }
  EXPECT_THROW(field.pressure_density(1e3, p, kLow), InternalError);
  EXPECT_EQ(field.solid(), kUniform);
  EXPECT_EQ(field.spectrum(), power_law());
  EXPECT_EQ(field.options().kappa, kKappa);
}

// Eqs. persson.6 and 7, the integrals over ln q by a rule of their own.
TEST(MeanFieldTheory, EnergyAndMeanGapAreTheirIntegrals) {
  const MeanField field(power_law(), kUniform, kOptions);
  for (const double p : {3e4, 1e5}) {
    const double energy = integral(std::log(kLow), std::log(kHigh), 200, [&](double v) {
      const double q = std::exp(v), a = std::erf(p / std::sqrt(measure_of(q)));
      return kPi / 2 * cube(q) * kStar * power_of(q) * a * (kGamma + (1 - kGamma) * a * a);
    });
    EXPECT_LT(relative(field.elastic_energy(p), energy), 1e-6) << p;
    EXPECT_LT(relative(field.mean_gap(p), gap_of(kLow, p)), 1e-4) << p;
  }
  EXPECT_THROW(field.mean_gap(0), InternalError);
  EXPECT_THROW(field.gaps(0), InternalError);
}

// Eq. persson.8: by each band's end as much is open as does not touch there, the volume of the
// bands is that of the gaps less what is still to come, and a spread is what roughness is left.
TEST(MeanFieldTheory, BandsOfGapsAddUpToOpenAreaAndVolume) {
  const MeanField field(power_law(), kUniform, kOptions);
  const double ratio = std::pow(kHigh / kLow, 1.0 / kIntervals);
  for (const double p : {1e4, 6e4}) {
    const GapDistribution gaps = field.gaps(p);
    EXPECT_EQ(gaps.pressure, p);
    EXPECT_EQ(gaps.contact, field.area(p));
    EXPECT_EQ(gaps.mean_gap, field.mean_gap(p));
    EXPECT_EQ(gaps.smallest_gap, 0);
    const std::size_t n = gaps.share.size();
    ASSERT_TRUE(gaps.offset.size() == n && gaps.width.size() == n && gaps.wave_number.size() == n);
    EXPECT_EQ(gaps.wave_number.back(), kHigh);
    EXPECT_EQ(n, static_cast<std::size_t>(
                     std::lround(std::log(kHigh / gaps.wave_number.front()) / std::log(ratio))) +
                     1);
    // The first bands are one, as far as they hold a hundred-thousandth.
    const double first = gaps.wave_number.front(), open = 1 - gaps.contact;
    EXPECT_GT(std::erfc(p / std::sqrt(measure_of(first))), 1e-5 * open);
    EXPECT_LT(std::erfc(p / std::sqrt(measure_of(first / ratio))), 1e-5 * open);
    double share = 0, volume = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double q = gaps.wave_number[k], x = p / std::sqrt(measure_of(q));
      share += gaps.share[k];
      volume += gaps.share[k] * gaps.offset[k];
      EXPECT_LT(relative(share, std::erfc(x)), 1e-6) << q;
      if (k % 16 == 0) {
        const double to_come = std::erf(x) * gap_of(q, p / std::erf(x));
        EXPECT_NEAR(volume, gaps.mean_gap - to_come, 1e-4 * gaps.mean_gap) << q;
      }
      const double variance = 0.5 * (moment_of(0, q, kHigh) + moment_of(0, q / ratio, kHigh));
      const double width =  // none where the gap is none: the last band, whose volume is rounding
          gaps.offset[k] > 0 ? 1 / std::hypot(1 / std::sqrt(variance), 1 / gaps.offset[k]) : 0;
      EXPECT_NEAR(gaps.width[k], width, 1e-9 * width) << q;
      EXPECT_TRUE(gaps.offset[k] > 0 || k + 1 == n) << q;
    }
    EXPECT_NEAR(volume, gaps.mean_gap, 1e-12 * gaps.mean_gap);
    EXPECT_NEAR(share, 1 - gaps.contact, 1e-12);
  }
}

// Where the roughness is so slight that a pascal is much, or none.
TEST(MeanFieldTheory, SlightPressuresAndRoughnessCountAsTheyAre) {
  const MeanField slight(power_law().scaled(1e-12), kUniform, kOptions);  // M below 1 Pa^2
  const double q = 3e5, m = 1e-12 * measure_of(q);
  ASSERT_LT(m, 0.1);
  for (const double p : {0.1, 0.5}) {
    EXPECT_LT(relative(slight.area(p, q), std::erf(p / std::sqrt(m))), 1e-7) << p;
    EXPECT_EQ(slight.area(p, kLow), 1);
    EXPECT_LT(relative(slight.pressure_density(p, p, q),
                       -std::expm1(-4 * p * p / m) / std::sqrt(kPi * m)),
              1e-6);
  }
  EXPECT_EQ(slight.area(0, kLow), 0);
  EXPECT_EQ(MeanField(power_law(), kUniform, kOptions).area(0.5, kLow), 1);
  const PullState s = solve_pull(slight, 0.5, 0, 1e-7);
  EXPECT_EQ(s.mean_gap, slight.mean_gap(0.5));
  EXPECT_GT(friction_at(slight, 0.5e-4, 1e-4, 1e6, 0, 1e-7).coefficient, 0);
}

// So many intervals over the whole, each piece between knots in equal steps of ln q no longer.
TEST(MeanFieldTheory, PiecesOfASpectrumAreDividedInEqualSteps) {
  const PowerSpectrum s{{1e5, 1.3e5, 1.301e5, 2e5}, {1e-22, 5e-23, 4.9e-23, 1e-23}};
  const MeanField field(s, kUniform, {.intervals = 10});
  const GapDistribution gaps = field.gaps(0.05 * std::sqrt(field.stress_measure()));
  std::vector<double> expected;  // ln 2/10: 3.8, 0.01 and 6.2 of it
  for (const auto& [a, b, pieces] :
       {std::tuple{1e5, 1.3e5, 4}, {1.3e5, 1.301e5, 1}, {1.301e5, 2e5, 7}}) {
    for (int k = 1; k <= pieces; ++k) expected.push_back(a * std::pow(b / a, 1.0 * k / pieces));
  }
  ASSERT_EQ(gaps.wave_number.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_LT(relative(gaps.wave_number[k], expected[k]), 1e-12) << k;
  EXPECT_LT(
      relative(field.stress_measure(), 0.5 * square(kPurePersson / 2) * square(kStar * s.slope())),
      1e-10);
  const MeanField one({{1e5, 2e5}, {1e-22, 1e-23}}, kUniform, {.intervals = 10});
  EXPECT_EQ(one.gaps(0.05 * std::sqrt(one.stress_measure())).wave_number.size(), 10u);
}

// 3 (1 - gamma) erf^2 beside gamma, linear between the nodes, and both ends of the table.
TEST(GapIntegrals, AreTheIntegralOfEitherPartAndLinearBetweenNodes) {
  const std::vector<double> none = *gap_integral_table(0), all = *gap_integral_table(1),
                            some = *gap_integral_table(0.45);
  ASSERT_EQ(none.size(), 126u * 128 + 1);  // octaves from 2^-6 to 2^120
  for (std::size_t i = 0; i < none.size(); i += 97)
    EXPECT_NEAR(some[i], 0.45 * all[i] + 0.55 * none[i], 1e-14);
  for (const double y : {0.25, 1.0, 1.4921875, 96.0, 4096.0}) {  // nodes: 1.4921875 = 191/128
    const double x = 1 / std::sqrt(y);
    EXPECT_LT(relative(look_up(none, y), gap_factor(x, 0) * x), 1e-8) << y;
    EXPECT_LT(relative(look_up(all, y), gap_factor(x, 1) * x), 1e-8) << y;
  }
  const auto at = [&](double y) { return look_up(none, y); };
  EXPECT_DOUBLE_EQ(at(3 + 0.25 * 2 / 128), 0.75 * at(3) + 0.25 * at(3 + 2.0 / 128));
  EXPECT_EQ(at(0x1p-6), 0);
  EXPECT_EQ(at(0), 0);
  EXPECT_EQ(at(-1), 0);
  EXPECT_EQ(at(0x1p120), none.back());
  EXPECT_EQ(at(0x1p121), none.back());
  EXPECT_EQ(at(1e300), none.back());
  // Half a cell before the last node.
  EXPECT_DOUBLE_EQ(at(0x1p120 - 0x1p111), 0.5 * (none[none.size() - 2] + none.back()));
}

// Bands of one gap each: every mean is a sum.
GapDistribution sharp_gaps() {
  GapDistribution gaps;
  gaps.contact = 0.1;
  gaps.share = {0.4, 0.3, 0.2};
  gaps.offset = {4e-6, 1e-6, 1e-8};
  gaps.width = {0, 0, 0};
  gaps.wave_number = {1e4, 1e5, 1e6};
  return gaps;
}

TEST(GapDistribution, OfSharpBandsIsTheirSum) {
  GapDistribution gaps = sharp_gaps();
  const double h = 2e-7;
  const auto inverse = [&](double u) { return 1 / (u + h); };
  EXPECT_DOUBLE_EQ(gaps.inverse(h),
                   0.1 / h + 0.4 * inverse(4e-6) + 0.3 * inverse(1e-6) + 0.2 * inverse(1e-8));
  const std::complex<double> lossy(h, 3e-7);
  const auto square_of = [&](double u) { return 1 / (square(u + h) + 9e-14); };
  const double open = 0.4 * square_of(4e-6) + 0.3 * square_of(1e-6), near = 0.2 * square_of(1e-8);
  EXPECT_LT(relative(gaps.inverse_square(lossy), 0.1 / (4e-14 + 9e-14) + open + near), 1e-12);
  const auto part = [&](double u) { return std::complex<double>(u + h, -3e-7) * square_of(u); };
  const auto parts = 0.1 * part(0) + 0.4 * part(4e-6) + 0.3 * part(1e-6) + 0.2 * part(1e-8);
  EXPECT_LT(std::abs(gaps.inverse(lossy) - parts), 1e-12 * std::abs(parts));
  EXPECT_LT(relative(gaps.far_inverse_square(lossy, 1e5), open),
            1e-12);  // the band that ends there
  EXPECT_LT(relative(gaps.far_inverse_square(lossy, 0.99e5), 0.4 * square_of(4e-6)), 1e-12);
  EXPECT_EQ(gaps.far_inverse_square(lossy, 9e3), 0);
  EXPECT_EQ(gaps.density(1e-6), 0);
  EXPECT_DOUBLE_EQ(gaps.cumulative(0), 0.1);
  EXPECT_DOUBLE_EQ(gaps.cumulative(1e-8), 0.3);
  EXPECT_DOUBLE_EQ(gaps.cumulative(0.999e-6), 0.3);
  EXPECT_DOUBLE_EQ(gaps.cumulative(1e-6), 0.6);
  EXPECT_DOUBLE_EQ(gaps.cumulative(1), 1);
  // What lies nearer than the smallest gap is spread over the rest, the contact stays.
  gaps.smallest_gap = 1e-8;
  EXPECT_LT(relative(gaps.far_inverse_square(lossy, 1e6), open + near), 1e-12);
  gaps.smallest_gap = 1.01e-8;
  EXPECT_LT(relative(gaps.far_inverse_square(lossy, 1e6), open * 0.9 / 0.7), 1e-12);
  EXPECT_LT(relative(gaps.inverse_square(lossy), 0.1 / 13e-14 + open * 0.9 / 0.7), 1e-12);
  gaps.smallest_gap = 1e-5;
  EXPECT_EQ(gaps.far_inverse_square(lossy, 1e6), 0);
}

// One band: |N(offset, width)| between its branches, by trapezoids of the folded bell.
TEST(GapDistribution, OfOneBandIsTheMeanOverItsFoldedBell) {
  for (const auto& [offset, width] :
       {std::pair{1e-6, 1e-7}, {1e-6, 1.6e-7}, {1e-7, 1e-7}, {0.0, 3e-7}}) {
    GapDistribution gaps;
    gaps.share = {0.5};
    gaps.offset = {offset};
    gaps.width = {width};
    gaps.wave_number = {1e5};
    const auto density = [&, o = offset, w = width](double u) {
      return 0.5 * (std::exp(-0.5 * square((u - o) / w)) + std::exp(-0.5 * square((u + o) / w))) /
             (w * std::sqrt(2 * kPi));
    };
    for (const double u : {1e-9, 1e-7, 9e-7}) EXPECT_DOUBLE_EQ(gaps.density(u), density(u)) << u;
    for (const double least : {0.0, 5e-8}) {
      gaps.smallest_gap = least;
      const double h = 1e-7, top = offset + 9 * width;
      const auto over = [&](const std::function<double(double)>& f) {
        double sum = 0;
        for (int k = 0; k < 40; ++k) {
          const double a = least + (top - least) * k / 40, b = least + (top - least) * (k + 1) / 40;
          sum += integral(a, b, 20, [&](double u) { return density(u) * f(u); });
        }
        return sum;
      };
      const double kept = over([](double) { return 1; });
      EXPECT_LT(relative(gaps.inverse(h), 0.5 / kept * over([&](double u) { return 1 / (u + h); })),
                1e-7)
          << offset << " " << width << " " << least;
      EXPECT_LT(relative(gaps.inverse_square({h, 2e-8}),
                         0.5 / kept * over([&](double u) { return 1 / (square(u + h) + 4e-16); })),
                1e-7)
          << offset << " " << width << " " << least;
    }
    gaps.smallest_gap = 0;
    for (const double u : {1e-7, 1e-6}) {
      const double below = integral(0, u, 60, density);
      EXPECT_NEAR(gaps.cumulative(u), below, 1e-9) << offset << " " << width;
    }
  }
}

// Eq. persson.14
TEST(StressDistribution, OfABandFollowsFromItsGaps) {
  GapDistribution gaps;
  gaps.share = {0.7};
  gaps.offset = {8e-7};
  gaps.width = {2e-7};
  gaps.wave_number = {1e5};
  const double v = 30;
  const std::vector<double> at{2e-7, 9e-7};
  for (const std::complex<double> h0 :
       {std::complex<double>(1e-7), std::complex<double>(2e-7, -3e-7)}) {
    const double re = h0.real(), im = h0.imag();
    const auto points = stress_distribution(gaps, v, h0, at);
    ASSERT_EQ(points.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      const double u = at[k], size = square(u + re) + square(im);
      const double stress = kVacuumPermittivity * v * v / (2 * size);
      const double density =
          square(size) / (u + re) / (kVacuumPermittivity * v * v) * gaps.density(u);
      EXPECT_EQ(points[k].gap, u);
      EXPECT_LT(relative(points[k].stress, stress), 1e-12);
      EXPECT_LT(relative(points[k].density, density), 1e-12);
      EXPECT_LT(relative(points[k].per_decade, std::log(10) * square(stress) * density), 1e-12);
    }
  }
}

// Eqs. persson.9 and 14 under a skin that conducts: with what the contact takes the stresses add up
// to the pull.
TEST(StressDistribution, UnderALossySkinAddsUpToThePull) {
  GapDistribution gaps;
  gaps.contact = 0.01;
  gaps.share = {0.4, 0.59};
  gaps.offset = {3e-8, 4e-7};
  gaps.width = {1.5e-8, 2e-7};
  gaps.wave_number = {1e5, 2e5};
  const std::complex<double> h0(2e-8, -3e-8);
  const double v = 30, scale = 0.5 * kVacuumPermittivity * v * v;
  std::vector<double> at;
  for (int k = 0; k <= 400; ++k) at.push_back(1e-11 * std::pow(1e6, k / 400.0));
  const auto points = stress_distribution(gaps, v, h0, at);
  double sum = gaps.contact * scale / std::norm(h0);
  for (std::size_t k = 1; k < points.size(); ++k)
    sum += 0.5 * (points[k].per_decade + points[k - 1].per_decade) *
           std::log10(points[k - 1].stress / points[k].stress);
  EXPECT_LT(relative(sum, scale * gaps.inverse_square(h0)), 2e-3);
}

// Eq. persson.13: from the field of all layers in series to that of the dielectric and the gap.
TEST(StepResponse, GoesFromAllLayersToTheLossless) {
  const StepResponse step{2e-7, 1e-4, 500, 3e4};
  const double u = 1e-6, skin = 1e-4 / 500;
  const double tau = kVacuumPermittivity * 3e4 * 500 * (1 + skin / (u + 2e-7));
  EXPECT_LT(relative(step.relaxation_time(u), tau), 1e-12);
  const double first = 100 / (u + 2e-7 + skin), last = 100 / (u + 2e-7);
  EXPECT_LT(relative(step.field(100, u, 0), first), 1e-12);
  EXPECT_LT(relative(step.field(100, u, 50 * tau), last), 1e-12);
  EXPECT_LT(relative(step.field(100, u, tau), last + (first - last) / std::exp(1)), 1e-12);
  const GapDistribution gaps = sharp_gaps();
  double pull = 0.1 * square(step.field(100, 0, tau));
  for (std::size_t k = 0; k < 3; ++k)
    pull += gaps.share[k] * square(step.field(100, gaps.offset[k], tau));
  EXPECT_LT(relative(step.pull(gaps, 100, tau), kVacuumPermittivity / 2 * pull), 1e-12);
}

// Eq. persson.12
TEST(SkinDielectric, IsALossyFilmInSeries) {
  SkinDielectric skin;
  skin.frequency = {10, 1000};
  skin.permittivity = {4000, 1000};
  skin.resistivity_frequency = {10, 1000};
  skin.resistivity = {1e5, 1e4};
  EXPECT_LT(relative(skin.permittivity_at(100), 2000), 1e-12);
  EXPECT_LT(relative(skin.resistivity_at(100), std::sqrt(1e9)), 1e-12);
  const double loss = 1 / (2 * kPi * 100 * kVacuumPermittivity * std::sqrt(1e9));
  const std::complex<double> eps = skin.complex_permittivity(100);
  EXPECT_LT(relative(eps.real(), 2000), 1e-12);
  EXPECT_LT(relative(eps.imag(), loss), 1e-12);
  // d/(e' + i e'') = d (e' - i e'')/|e|^2
  const double size = square(2000) + square(loss), d = 2e-4;
  const std::complex<double> film(3e-7 + d * 2000 / size, -d * loss / size);
  const std::complex<double> h0 = series_thickness(3e-7, d, skin, 100);
  EXPECT_LT(std::abs(h0 - film), 1e-12 * std::abs(film));
  const double gap = 1 / (2 * kPi * 100 * kVacuumPermittivity * 1e6);
  const std::complex<double> leaky(film.real() - film.imag() * gap,
                                   film.imag() + film.real() * gap);
  EXPECT_LT(std::abs(series_thickness(3e-7, d, skin, 100, 1e6) - leaky), 1e-12 * std::abs(leaky));
}

// Eq. persson.9, the lowest of all equilibria.
TEST(Pull, IsTheFirstEquilibriumAboveTheLoad) {
  const MeanField field(power_law(), kUniform, kOptions);
  const std::complex<double> h0(1e-7, 2e-8);
  const double external = 200;
  const auto pull_at = [&](double p, double v) {
    return 0.5 * kVacuumPermittivity * v * v * field.gaps(p).inverse_square(h0);
  };
  for (const double v : {1.0, 6.0, 15.0, 40.0}) {
    const PullState s = solve_pull(field, external, v, h0);
    ASSERT_EQ(s.status, PullStatus::Solved);
    EXPECT_LT(relative(s.pull, pull_at(s.pressure, v)), 1e-8) << v;
    EXPECT_LE(std::abs(external + s.pull - s.pressure), 1e-8 * s.pressure) << v;
    EXPECT_EQ(s.area, field.area(s.pressure));
    EXPECT_EQ(s.mean_gap, field.mean_gap(s.pressure));
    for (int k = 0; k < 60; ++k) {  // nowhere below is there another
      const double p = external * std::pow(0.999 * s.pressure / external, k / 59.0);
      EXPECT_GT(external + pull_at(p, v), p) << v << " " << p;
    }
  }
}

TEST(Pull, OfAFiniteBodyIsThatOfItsHighestAsperity) {
  const MeanField field(power_law(), kUniform, kOptions);
  const double h0 = 1e-7, finite = 3e3, v = 2;
  const double still = 0.5 * kVacuumPermittivity * v * v * field.gaps(finite).inverse_square(h0);
  for (const double external : {0.0, 500.0}) {
    ASSERT_LT(external + still, finite);
    const PullState s = solve_pull(field, external, v, h0, finite);
    EXPECT_EQ(s.status, PullStatus::Solved);
    EXPECT_DOUBLE_EQ(s.pull, still);
    EXPECT_DOUBLE_EQ(s.pressure, external + still);
    EXPECT_EQ(s.area, field.area(s.pressure));
    EXPECT_EQ(s.mean_gap, field.mean_gap(finite));
    const PullState off = solve_pull(field, external, 0, h0, finite);
    EXPECT_EQ(off.pull, 0);
    EXPECT_EQ(off.pressure, external);
    EXPECT_EQ(off.area, field.area(external));
    EXPECT_EQ(off.mean_gap, field.mean_gap(finite));
  }
  const PullState above = solve_pull(field, 4e3, v, h0, finite);  // there it is as without
  EXPECT_EQ(above.pressure, solve_pull(field, 4e3, v, h0).pressure);
  EXPECT_EQ(above.mean_gap, field.mean_gap(above.pressure));
  EXPECT_EQ(solve_pull(field, 4e3, 0, h0).mean_gap, field.mean_gap(4e3));
  EXPECT_THROW(solve_pull(field, 0, v, h0), InternalError);
  EXPECT_THROW(solve_pull(field, 0, 0, h0), InternalError);
}

// Pressed flat the pull is that of the contact alone: 1 GPa is the most that is looked for.
TEST(Pull, IsLookedForUpToAGigapascal) {
  const MeanField field(power_law(), kUniform, kOptions);
  const double h0 = 1e-7;
  const auto at = [&](double flat) {
    return solve_pull(field, 1e3, h0 * std::sqrt(2 * flat / kVacuumPermittivity), h0);
  };
  const PullState half = at(5e8);
  EXPECT_EQ(half.status, PullStatus::Solved);
  EXPECT_LT(relative(half.pressure, 5e8 + 1e3), 1e-7);
  EXPECT_LT(relative(half.pull, 5e8), 1e-7);
  EXPECT_EQ(half.area, 1);
  const PullState beyond = at(1.2e9);
  EXPECT_EQ(beyond.status, PullStatus::Collapsed);
  EXPECT_LT(beyond.pressure, 1e9);
  EXPECT_LT(beyond.pressure, beyond.pull + 1e3);  // more pulls than is carried
}

// Eq. persson.11
TEST(Friction, IsTheStrengthOfTheAreaThatTouches) {
  const MeanField field(power_law(), kUniform, kOptions);
  const FrictionPoint point = friction_at(field, 0.3, 2e-4, 5e6, 3, 1e-7, 2e3);
  const PullState pull = solve_pull(field, 0.3 / 2e-4, 3, 1e-7, 2e3);
  EXPECT_EQ(point.normal_force, 0.3);
  EXPECT_EQ(point.pull.pressure, pull.pressure);
  EXPECT_EQ(point.pull.area, pull.area);
  EXPECT_DOUBLE_EQ(point.friction, 5e6 * 2e-4 * pull.area);
  EXPECT_DOUBLE_EQ(point.coefficient, point.friction / 0.3);
  const FrictionPoint none = friction_at(field, 0, 2e-4, 5e6, 3, 1e-7, 2e3);
  EXPECT_GT(none.friction, 0);
  EXPECT_EQ(none.coefficient, 0);
}

TEST(MeanFieldTheory, RefusesWhatHasNoSpectrumOrNoScale) {
  const PowerSpectrum good = power_law();
  EXPECT_NO_THROW(MeanField(good, kUniform, {.intervals = 1}));
  EXPECT_THROW(MeanField(good, kUniform, {.kappa = 0}), InternalError);
  EXPECT_THROW(MeanField(good, kUniform, {.intervals = 0}), InternalError);
  EXPECT_THROW(MeanField({{1e4}, {1e-20}}, kUniform), InternalError);
  EXPECT_THROW(MeanField({{1e4, 1e5}, {1e-20, 1e-22, 1e-24}}, kUniform), InternalError);
  EXPECT_THROW(MeanField({{0, 1e5, 1e6}, {1e-20, 1e-21, 1e-22}}, kUniform), InternalError);
  EXPECT_THROW(MeanField({{1e4, 1e6, 1e6}, {1e-20, 1e-21, 1e-22}}, kUniform), InternalError);
  EXPECT_THROW(MeanField({{1e4, 1e5, 1e6}, {0, 1e-21, 1e-22}}, kUniform), InternalError);
  EXPECT_THROW(MeanField({{1e4, 1e5, 1e6}, {1e-20, 1e-21, 0}}, kUniform), InternalError);
}

// Eq. persson.10 by its series alone, wherever the solver sums images instead.
ContactShares shares_by_series(double p, double theta) {
  ContactShares s{0, p};
  for (int n = 1; n < 200; ++n) {
    const double term = 2 / (n * kPi) * std::sin(n * kPi * p) * std::exp(-n * n * theta);
    s.plastic += n % 2 == 0 ? term : -term;
    s.elastic += n % 2 == 0 ? 0 : 2 * term;
  }
  return s;
}

TEST(Plasticity, SharesAreThoseOfTheSeriesForAnyRoughness) {
  const double yield = 4e6;
  for (const double p : {0.02, 0.3, 0.5, 0.9}) {
    for (const double theta : {0.02, 0.1, 0.6, 0.99, 1.01, 2.0, 5.0}) {
      const ContactShares s =
          plastic_shares(p * yield, theta * 4 * square(yield) / square(kPi), yield);
      const ContactShares expected = shares_by_series(p, theta);
      EXPECT_NEAR(s.plastic, expected.plastic, 1e-9) << p << " " << theta;
      EXPECT_NEAR(s.elastic, expected.elastic, 1e-9) << p << " " << theta;
    }
  }
  for (const double p : {1.0, 3.0}) {
    EXPECT_EQ(plastic_shares(p * yield, 1e12, yield).plastic, 1);
    EXPECT_EQ(plastic_shares(p * yield, 1e12, yield).elastic, 0);
  }
}

TEST(Plasticity, SmoothingLeavesWhatHasNotYielded) {
  // theta passes 1 within the spectrum, and the end is smooth.
  const double yield = 4e4, p = 1e4;
  for (const double kappa : {2.0, 1.7}) {
    const PowerSpectrum s = kappa == 2 ? plastic_smoothing(power_law(), kUniform, yield, p)
                                       : plastic_smoothing(power_law(), kUniform, yield, p, kappa);
    ASSERT_GT(s.wave_number.size(), 100u);
    EXPECT_EQ(s.wave_number.front(), kLow);
    EXPECT_EQ(s.density.front(), kScale);
    const auto factor = [&](double q) {
      const double theta = square(kPi) * measure_of(q, kappa) / (4 * square(yield));
      return 1 - std::pow(shares_by_series(p / yield, theta).plastic / (p / yield), 6);
    };
    double least = 1;
    for (std::size_t k = 1; k < s.wave_number.size(); ++k) {
      const double q = s.wave_number[k], step = std::log(q / s.wave_number[k - 1]);
      EXPECT_NEAR(step, std::log(kHigh / kLow) / 450, 3e-5);  // 450 or 451 of them
      if (measure_of(q, kappa) > 0.02 * square(yield))        // the series of the test holds
        EXPECT_NEAR(s.density[k] / power_of(q), factor(q), 2e-7) << q;
      else
        EXPECT_LT(relative(s.density[k], power_of(q)), 1e-9) << q;
      least = std::min(least, s.density[k] / power_of(q));
    }
    // It ends before less than a thousand-millionth is left.
    ASSERT_LT(s.highest(), 0.9 * kHigh);
    EXPECT_GE(least, 1e-9);
    EXPECT_LT(factor(s.highest() * 1.03), 1e-9);
  }
  // Nothing of it yields: knots and densities stay.
  const PowerSpectrum firm = plastic_smoothing(power_law(), kUniform, 1e12, 1e3);
  EXPECT_EQ(firm.highest(), kHigh);
  EXPECT_LT(relative(firm.density.back(), power_of(kHigh)), 1e-12);
  EXPECT_LT(relative(firm.rms(), power_law().rms()), 1e-9);
}

}  // namespace
}  // namespace papilla::tests::theory_test
