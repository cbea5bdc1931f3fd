#include "physics/persson/persson.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>

#include "base/constants.h"
#include "numerics/quadrature.h"
#include "physics/persson/gap_integrals.h"
#include "physics/persson/power_law.h"
#include "tests/persson/table.h"

namespace papilla::tests::persson_test {
namespace {

constexpr MeanFieldOptions kPure{.kappa = kPurePersson};
// The reference tables leave out gaps below 0.01 nm, which carry 2 % of the pull.
constexpr MeanFieldOptions kTables{.kappa = kPurePersson, .smallest_gap = 1e-11};

double relative(double a, double b) { return std::abs(a - b) / std::abs(b); }

TEST(EffectiveModulus, MatchesTheFullElasticityProblem) {
  for (const TableRow& row : read_table("t01_layer_factor.csv", true)) {
    const auto& v = row.values;
    const MeanFieldSolid solid{v[1], v[2], 1.0, v[3], v[4]};
    const double s = v[1] / (1 - v[2] * v[2]) / effective_modulus(solid, v[0]);
    EXPECT_LT(relative(s, v[6]), 2e-7) << v[0] << " " << v[1];
  }
}

TEST(EffectiveModulus, HasTheStatedValuesAndLimits) {
  const MeanFieldSolid skin{40e6, 0.4999, 1, 10e3, 0.4999};
  const double layer = 40e6 / (1 - 0.4999 * 0.4999);
  EXPECT_NEAR(layer / effective_modulus(skin, 0.1), 2398.32, 0.01);
  EXPECT_NEAR(layer / effective_modulus(skin, 1), 7.36737, 1e-5);
  EXPECT_NEAR(layer / effective_modulus(skin, 3), 1.136736, 1e-6);
  EXPECT_NEAR(1e6 / 0.91 / effective_modulus({1e6, 0.3, 1, 1e12, 0.3}, 1), 0.41575, 1e-5);
  EXPECT_DOUBLE_EQ(effective_modulus(skin, 100), layer);
  EXPECT_LT(relative(effective_modulus(skin, 1e-7), 10e3 / (1 - 0.4999 * 0.4999)), 1e-6);
  // Plate on a soft base: E*(q) = E0* + E1* x^3 / 6.
  EXPECT_LT(relative(effective_modulus({100e6, 0.5, 1, 10e3, 0.5}, 0.15),
                     13333.333 + 133.3333e6 * std::pow(0.15, 3) / 6),
            0.03);
}

TEST(PowerSpectrum, WristHasThePrintedRoughness) {
  const PowerSpectrum wrist = wrist_spectrum();
  EXPECT_NEAR(wrist.rms(), 22.00e-6, 1e-9);
  EXPECT_NEAR(wrist.slope(), 0.9100, 1e-4);
  EXPECT_LT(relative(wrist.density[0], 1.9963e-18), 1e-4);
  EXPECT_LT(relative(wrist.moment(0, 800, 1e5) + wrist.moment(0, 1e5, 1e8), square(22e-6)), 1e-12);
  EXPECT_LT(relative(wrist.between(1e3, 1e6).rms(), std::sqrt(wrist.moment(0, 1e3, 1e6))), 1e-12);
}

TEST(MeanField, AreaHasTheExactLimits) {
  const PowerSpectrum wrist = wrist_spectrum();
  const MeanFieldSolid uniform{40e6, 0.5, 0, 40e6, 0.5};
  const double scale = 40e6 / 0.75 * wrist.slope();
  for (const double kappa : {kPurePersson, 2.0}) {
    const MeanField field(wrist, uniform, {.kappa = kappa});
    EXPECT_LT(relative(field.area(1e-4 * scale), kappa * 1e-4), 1e-6);
    EXPECT_NEAR(field.area(5 * scale), 1, 1e-10);
    EXPECT_LT(relative(field.stress_measure() * square(kappa / kPurePersson), scale * scale / 2),
              1e-8);
  }
}

TEST(MeanField, ReferenceSkinHasTheStatedValues) {
  const MeanField field(wrist_spectrum(), {}, kTables);
  const double homogeneous = square(40e6 / 0.75 * 0.91) / 2;
  EXPECT_LT(relative(field.stress_measure() / homogeneous, 0.98081), 1e-4);
  EXPECT_LT(relative(field.area(10e3), 3.3201e-4), 1e-4);
  EXPECT_LT(relative(field.mean_gap(10e3), 66.24e-6), 1e-3);
  const GapDistribution gaps = field.gaps(10e3);
  EXPECT_LT(relative(gaps.inverse_square(0.2e-6), 2.529e10), 1e-3);
  EXPECT_LT(relative(gaps.contact / square(0.2e-6) / gaps.inverse_square(0.2e-6), 0.3282), 1e-3);
}

TEST(MeanField, ModelSensitivitiesMatchTheTable) {
  const auto rows = read_table("t30_sensitivity.csv", true);
  std::map<std::string, std::vector<double>> table;
  for (const TableRow& row : rows) table[row.name] = row.values;
  const PowerSpectrum wrist = wrist_spectrum();
  const auto check = [&](const char* name, const MeanField& field) {
    const auto& v = table.at(name);
    EXPECT_LT(relative(field.area(10e3), v[1]), 5e-3) << name;
    EXPECT_LT(relative(field.mean_gap(10e3), v[2] * 1e-6), 5e-3) << name;
    EXPECT_LT(relative(field.gaps(10e3).inverse_square(0.2e-6), v[3]), 5e-3) << name;
  };
  check("gamma1",
        MeanField(wrist, {}, {.kappa = kPurePersson, .energy_factor = 1, .smallest_gap = 1e-11}));
  check(
      "gamma0.42",
      MeanField(wrist, {}, {.kappa = kPurePersson, .energy_factor = 0.42, .smallest_gap = 1e-11}));
  check("kappa2", MeanField(wrist, {}, {.kappa = 2, .smallest_gap = 1e-11}));
  check("nu_sc=.3", MeanField(wrist, {40e6, 0.3, 200e-6, 10e3, 0.5}, kTables));
  check("Ebulk=30k", MeanField(wrist, {40e6, 0.5, 200e-6, 30e3, 0.5}, kTables));
  check("homogeneous(E*=53MPa)", MeanField(wrist, {40e6, 0.5, 0, 40e6, 0.5}, kTables));
  check("truncate_q1=1e7 (same C)", MeanField(wrist.between(800, 1e7), {}, kTables));
}

TEST(MeanField, EnergyAndMeanGapAreConsistent) {
  const MeanField field(wrist_spectrum(), {}, kPure);
  const double p = 30e3, dp = 0.01 * p;
  const double force = -(field.elastic_energy(p + dp) - field.elastic_energy(p - dp)) /
                       (field.mean_gap(p + dp) - field.mean_gap(p - dp));
  EXPECT_LT(relative(force, p), 1e-3);
  // Full contact: all the energy of flattening.
  const MeanField uniform(wrist_spectrum(), {40e6, 0.5, 0, 40e6, 0.5}, kPure);
  const double full = kPi / 2 * 40e6 / 0.75 * wrist_spectrum().moment(1, 800, 1e8) / (2 * kPi);
  EXPECT_LT(relative(uniform.elastic_energy(1e9), full), 1e-6);
}

TEST(MeanField, GapDistributionHasItsNormAndItsMean) {
  const MeanField field(wrist_spectrum(), {}, kPure);
  for (const double p : {1e4, 1e6, 3e7}) {
    const GapDistribution gaps = field.gaps(p);
    EXPECT_NEAR(gaps.cumulative(1), 1, 1e-10);
    double share = 0, inverse_square = 0, mean = 0, previous = 1e-20;
    const double h0 = 0.2e-6;
    for (double u = 1.003e-20; u < 3e-4; u *= 1.003) {
      const double middle = 0.5 * (u + previous), p_u = gaps.density(middle) * (u - previous);
      share += p_u;
      inverse_square += p_u / square(middle + h0);
      mean += p_u * middle;
      previous = u;
    }
    EXPECT_NEAR(share, gaps.cumulative(previous) - gaps.cumulative(1e-20), 1e-5) << p;
    EXPECT_LT(relative(gaps.contact / square(h0) + inverse_square +
                           (gaps.cumulative(1e-20) - gaps.contact) / square(h0),
                       gaps.inverse_square(h0)),
              1e-4)
        << p;
    // Reflection at zero gap shifts the mean a little above the theory's mean gap.
    if (p < 1e5) {
      EXPECT_LT(relative(mean, gaps.mean_gap), 5e-3) << p;
    }
  }
}

// Bands that are narrow, wide, at a wall and below the smallest gap, integrated step by step.
TEST(GapDistribution, OfBandsIsTheIntegralOverThem) {
  GapDistribution gaps;
  gaps.contact = 0.1;
  gaps.share = {0.2, 0.3, 0.25, 0.15};
  gaps.offset = {3e-6, 4e-7, 5e-8, 0};
  gaps.width = {1e-7, 2e-7, 9e-8, 3e-8};
  gaps.wave_number = {1e4, 1e5, 1e6, 1e7};
  for (const double least : {0.0, 1e-9, 4e-8}) {
    gaps.smallest_gap = least;
    // Mean of f over the bands but for the contact, their share below `least` on the rest.
    const auto mean = [&](std::size_t count, const auto& f) {
      double sum = 0, kept = 0, all = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const double top = gaps.offset[i] + 8 * gaps.width[i], step = top / 40000;
        for (double u = 0.5 * step; u < top; u += step) {
          if (u < least) continue;
          double density = 0;
          for (const double sign : {1.0, -1.0})
            density += std::exp(-0.5 * std::pow((u - sign * gaps.offset[i]) / gaps.width[i], 2));
          density *= gaps.share[i] * step / (gaps.width[i] * std::sqrt(2 * kPi));
          sum += density * f(u);
          kept += density;
        }
        all += gaps.share[i];
      }
      return sum * all / kept;
    };
    for (const double h0 : {2e-8, 2e-7, 3e-6}) {
      const double inverse = mean(4, [&](double u) { return 1 / (u + h0); });
      EXPECT_LT(relative(gaps.inverse(h0), gaps.contact / h0 + inverse), 2e-4) << least << h0;
      const std::complex<double> lossy(h0, 0.4 * h0);
      const auto square_of = [&](double u) { return 1 / std::norm(u + lossy); };
      EXPECT_LT(relative(gaps.inverse_square(lossy),
                         gaps.contact / std::norm(lossy) + mean(4, square_of)),
                2e-4)
          << least << h0;
      EXPECT_LT(relative(gaps.far_inverse_square(lossy, 1e5), mean(2, square_of)), 2e-4);
    }
  }
  gaps.smallest_gap = 0;
  double below = gaps.contact, previous = 0;
  for (double u = 1e-11; u < 5e-6; u *= 1.002) {
    below += gaps.density(0.5 * (u + previous)) * (u - previous);
    previous = u;
  }
  EXPECT_NEAR(below, 1, 1e-4);
  EXPECT_NEAR(gaps.cumulative(previous), 1, 1e-9);
  EXPECT_NEAR(gaps.cumulative(2e-6), 0.8, 1e-6);  // all but the widest band
}

// The equilibrium is one: its pressure is the load and the pull of its own gaps.
TEST(Pull, BalancesLoadAndField) {
  const MeanField field(wrist_spectrum(), {}, kPure);
  const double h0 = 1e-6 / 8;
  for (const double external : {2e3, 2e4, 2e5}) {
    for (const double volts : {10.0, 60.0, 150.0, 220.0}) {
      const PullState s = solve_pull(field, external, volts, h0, 0);
      if (s.status != PullStatus::Solved) continue;
      EXPECT_LT(relative(s.pressure, external + s.pull), 3e-8) << external << " " << volts;
      const double pull =
          0.5 * kVacuumPermittivity * volts * volts * field.gaps(s.pressure).inverse_square(h0);
      EXPECT_LT(relative(s.pull, pull), 1e-5) << external << " " << volts;
      EXPECT_LT(relative(s.area, field.area(s.pressure)), 1e-12);
      EXPECT_LT(relative(s.mean_gap, field.mean_gap(s.pressure)), 1e-12);
    }
  }
}

// However finely the spectrum is divided, between the knots as on them.
TEST(MeanField, StressesDoNotDependOnTheDivision) {
  MeanFieldOptions fine = kPure;
  fine.intervals *= 3;
  const MeanField a(wrist_spectrum(), {}, kPure), b(wrist_spectrum(), {}, fine);
  double last = 0;
  for (double q = 900; q < 1e8; q *= 1.37) {
    EXPECT_LT(relative(a.stress_measure(q), b.stress_measure(q)), 2e-4) << q;
    EXPECT_GT(a.stress_measure(q), last) << q;
    last = a.stress_measure(q);
  }
  EXPECT_LT(relative(a.mean_gap(1e4), b.mean_gap(1e4)), 1e-3);
}

TEST(MeanField, PressuresCarryTheLoadOnTheirArea) {
  const MeanField field(wrist_spectrum(), {}, kPure);
  for (const double p : {1e4, 3e6}) {
    const double q = 5e5, most = p + 8 * std::sqrt(field.stress_measure(q));
    const Quadrature rule = gauss_legendre(800, 0, most);
    double area = 0, load = 0;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double density = rule.weights[k] * field.pressure_density(rule.nodes[k], p, q);
      area += density;
      load += density * rule.nodes[k];
    }
    EXPECT_LT(relative(area, field.area(p, q)), 1e-9) << p;
    EXPECT_LT(relative(load, p), 1e-9) << p;
  }
}

TEST(MeanField, PressureDistributionsOfTwoBandsCombine) {
  const MeanField field(wrist_spectrum(), {}, kPure);
  const double q = 5.236e5, p = 10e3;
  const double below = field.stress_measure(q), above = field.stress_measure() - below;
  const Quadrature rule = gauss_legendre(400, 0, 8 * std::sqrt(below));
  double area = 0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    area += rule.weights[k] * field.pressure_density(rule.nodes[k], p, q) *
            std::erf(rule.nodes[k] / std::sqrt(above));
  }
  EXPECT_LT(relative(area, field.area(p)), 1e-12);
}

TEST(MeanField, MeanGapFallsWithTheLogarithmOfPressure) {
  const MeanField field(wrist_spectrum(), {40e6, 0.5, 0, 40e6, 0.5}, kPure);
  const auto slope = [&](double p) {
    return (field.mean_gap(p) - field.mean_gap(2 * p)) / std::log(2.0) / 22e-6;
  };
  EXPECT_LT(relative(slope(10), slope(100)), 5e-3);
  EXPECT_NEAR(slope(30), 0.543, 0.01);
}

struct SweepCase {
  MeanFieldSolid solid;
  PowerSpectrum spectrum;
};

SweepCase sweep_case(double modulus, bool plastic, double factor = 1, double thickness = 200e-6,
                     double bulk = 10e3) {
  SweepCase c{{modulus, 0.5, thickness, bulk, 0.5}, wrist_spectrum().scaled(factor)};
  if (plastic) c.spectrum = plastic_smoothing(c.spectrum, c.solid, 50e6, 10e3, kPurePersson);
  return c;
}

// Every row of a table: total pressure, pull, area, mean gap.
void check_sweeps(const char* file, const std::map<std::string, SweepCase>& cases) {
  std::map<std::string, MeanField> fields;
  for (const auto& [name, c] : cases) fields.emplace(name, MeanField(c.spectrum, c.solid, kTables));
  double worst = 0;
  for (const TableRow& row : read_table(file, false)) {
    const auto& v = row.values;
    if (row.name == "case") continue;
    ASSERT_TRUE(fields.count(row.name)) << row.name;
    const double finite = row.name.find("pc10kPa") != std::string::npos ? 10e3 : 0;
    const PullState state =
        solve_pull(fields.at(row.name), v[2] * 1e3, v[3] / std::sqrt(2.0), v[1] * 1e-6, finite);
    const std::string where = std::string(file) + " " + row.name + " V=" + std::to_string(v[3]);
    EXPECT_EQ(state.status, PullStatus::Solved) << where;
    EXPECT_LT(relative(state.pressure, v[4] * 1e3), 5e-3) << where;
    EXPECT_LT(relative(state.area, v[6]), 5e-3) << where;
    if (v[3] > 0) {
      EXPECT_LT(relative(state.pull, v[5] * 1e3), 5e-3) << where << " " << state.pull;
      worst = std::max(worst, relative(state.pull, v[5] * 1e3));
    }
    if (v[6] < 0.1 && finite == 0) {
      EXPECT_LT(relative(state.mean_gap, v[7] * 1e-6), 5e-3) << where << " " << state.mean_gap;
    }
  }
  ::testing::Test::RecordProperty("worst_pull_error", std::to_string(worst));
}

TEST(Pull, MatchesTheTablesOverThicknessOfTheDielectric) {
  check_sweeps("t10_fig14_h0.csv", {{"E100pl", sweep_case(100e6, true)}});
}
TEST(Pull, MatchesTheTablesOverLoad) {
  const SweepCase c = sweep_case(100e6, true);
  check_sweeps("t11_fig15_p0.csv", {{"E100pl_pc10kPa", c}, {"E100pl_pcnone", c}});
}
TEST(Pull, MatchesTheTablesOverTheSkinModulus) {
  check_sweeps("t12_fig12_ESC.csv", {{"E1MPa_el", sweep_case(1e6, false)},
                                     {"E10MPa_el", sweep_case(10e6, false)},
                                     {"E100MPa_el", sweep_case(100e6, false)},
                                     {"E100MPa_pl", sweep_case(100e6, true)},
                                     {"E1000MPa_el", sweep_case(1e9, false)},
                                     {"E1000MPa_pl", sweep_case(1e9, true)}});
}
TEST(Pull, MatchesTheTablesOverSkinThicknessAndBulk) {
  check_sweeps("t13_fig13_d2.csv", {{"d100um", sweep_case(100e6, true, 1, 100e-6)},
                                    {"d200um", sweep_case(100e6, true, 1, 200e-6)},
                                    {"d300um", sweep_case(100e6, true, 1, 300e-6)},
                                    {"d400um", sweep_case(100e6, true, 1, 400e-6)}});
  check_sweeps("t15_ebulk.csv", {{"Eb3kPa", sweep_case(100e6, true, 1, 200e-6, 3e3)},
                                 {"Eb10kPa", sweep_case(100e6, true, 1, 200e-6, 10e3)},
                                 {"Eb30kPa", sweep_case(100e6, true, 1, 200e-6, 30e3)}});
}
TEST(Pull, MatchesTheTablesOverRoughness) {
  check_sweeps("t14_fig11_psd.csv", {{"fac0.25_el", sweep_case(100e6, false, 0.25)},
                                     {"fac0.25_pl", sweep_case(100e6, true, 0.25)},
                                     {"fac1_el", sweep_case(100e6, false)},
                                     {"fac1_pl", sweep_case(100e6, true)},
                                     {"fac4_el", sweep_case(100e6, false, 4)},
                                     {"fac4_pl", sweep_case(100e6, true, 4)}});
}

TEST(Pull, GrowsWithTheSquareOfTheVoltage) {
  const MeanField field(wrist_spectrum(), {}, kTables);
  const auto pull = [&](double v, double finite) {
    return solve_pull(field, 5e3, v / std::sqrt(2.0), 0.2e-6, finite).pull;
  };
  EXPECT_LT(relative(pull(10, 0) / pull(5, 0), 4), 1e-3);
  EXPECT_LT(relative(pull(100, 10e3) / pull(50, 10e3), 4), 1e-12);
}

TEST(Pull, CollapseIsAStatus) {
  // A solid so soft, at a voltage so high, that no finite pressure balances the pull.
  const MeanField field(wrist_spectrum(), {1e6, 0.5, 200e-6, 10e3, 0.5}, kTables);
  const PullState state = solve_pull(field, 10e3, 1e5, 0.3e-6);
  EXPECT_EQ(state.status, PullStatus::Collapsed);
  EXPECT_TRUE(std::isfinite(state.area));
}

TEST(Friction, MatchesTheTables) {
  for (const bool pure : {true, false}) {
    const MeanField field(wrist_spectrum(), {},
                          {.kappa = pure ? kPurePersson : 2.0, .smallest_gap = 1e-11});
    const auto rows =
        read_table(pure ? "t20_fig17_friction_k1596.csv" : "t20_fig17_friction_k2.csv", false);
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const auto& v = rows[i].values;
      const FrictionPoint point =
          friction_at(field, v[1], 1e-4, 8e6, v[0] / std::sqrt(2.0), 0.2e-6, 10e3);
      const std::string where = "F=" + std::to_string(v[1]) + " V=" + std::to_string(v[0]);
      EXPECT_NEAR(point.friction, v[5], 5e-3 * v[5] + 1e-12) << where;
      EXPECT_NEAR(point.pull.pull, v[3] * 1e3, 5e-3 * v[3] * 1e3) << where;
    }
  }
}

TEST(Frequency, MatchesTheTable) {
  const SkinDielectric skin;
  const MeanField field(wrist_spectrum(), {}, kTables);
  const MeanField soft(wrist_spectrum(), {10e6, 0.5, 200e-6, 10e3, 0.5}, kTables);
  const auto ratio = [&](const MeanField& f, double eps, double frequency, double gap) {
    const std::complex<double> h0 = series_thickness(1e-6 / eps, 200e-6, skin, frequency, gap);
    return solve_pull(f, 5e3, 100 / std::sqrt(2.0), h0, 10e3).area / f.area(5e3);
  };
  const auto rows = read_table("t21_fig19_frequency.csv", true);
  for (std::size_t i = 0; i < rows.size(); i += 5) {
    const auto& v = rows[i].values;
    EXPECT_LT(relative(skin.permittivity_at(v[0]), v[1]), 1e-3);
    EXPECT_LT(relative(skin.resistivity_at(v[0]), v[2]), 1e-3);
    const std::complex<double> h0 = series_thickness(1e-6 / 8, 200e-6, skin, v[0]);
    EXPECT_LT(relative(h0.real(), v[3] * 1e-6), 1e-3);
    EXPECT_LT(relative(h0.imag(), v[4] * 1e-6), 1e-3);
    EXPECT_LT(relative(ratio(field, 4, v[0], 0), v[5]), 5e-3) << v[0];
    EXPECT_LT(relative(ratio(field, 8, v[0], 0), v[6]), 5e-3) << v[0];
    EXPECT_LT(relative(ratio(field, 10, v[0], 0), v[7]), 5e-3) << v[0];
    EXPECT_LT(relative(ratio(field, 8, v[0], 1e5), v[8]), 5e-3) << v[0];
    EXPECT_LT(relative(ratio(field, 8, v[0], 1e6), v[9]), 5e-3) << v[0];
    EXPECT_LT(relative(ratio(field, 8, v[0], 1e7), v[10]), 5e-3) << v[0];
    EXPECT_LT(relative(ratio(soft, 8, v[0], 0), v[11]), 5e-3) << v[0];
  }
}

TEST(StepResponse, MatchesTheTable) {
  const MeanField field(wrist_spectrum(), {}, kTables);
  const GapDistribution gaps = field.gaps(10e3);
  const StepResponse step{1e-6 / 3.9, 200e-6, 2000, 2e4};
  for (const TableRow& row : read_table("t22_step_response.csv", false)) {
    const auto& v = row.values;
    EXPECT_LT(relative(step.pull(gaps, 100, v[0]), v[1]), 5e-3) << v[0];
    EXPECT_LT(relative(step.field(100, 0, v[0]), v[2]), 5e-4) << v[0];
    EXPECT_LT(relative(step.field(100, 1e-6, v[0]), v[3]), 5e-4) << v[0];
  }
  EXPECT_LT(relative(step.relaxation_time(1e-6), 3.82e-4), 2e-3);
  EXPECT_LT(relative(step.relaxation_time(0), 4.92e-4), 2e-3);
  const StepResponse ideal{1e-7, 1e-6, 10, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(ideal.field(1, 1e-7, 1e9), ideal.field(1, 1e-7, 0));  // an insulator never charges
}

TEST(StressDistribution, MatchesTheTable) {
  // As many bands as the table's maker had. Row k lies at the gap 0.01 nm * 10^(0.0266963 k): near
  // the top the printed digits of the stress do not fix it.
  const MeanField field(wrist_spectrum(), {},
                        {.kappa = kPurePersson, .intervals = 900, .smallest_gap = 1e-11});
  const GapDistribution gaps = field.gaps(10e3);
  const double h0 = 0.2e-6;
  double peak = 0, peak_stress = 0, area = 0, table_area = 0, u = 1e-11;
  double previous_u = u, previous = 0, table_previous = 0;
  const auto rows = read_table("t23_fig16_Psigma.csv", false);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto& v = rows[i].values;
    u = 1e-11 * std::pow(10, 0.026696341 * static_cast<double>(i - 1));
    const StressPoint point =
        stress_distribution(gaps, 100 / std::sqrt(2.0), h0, std::vector{u})[0];
    ASSERT_LT(relative(point.stress, v[0]), 5e-5) << i;
    // Beyond, 0.05 % of the area lies at gaps of more than six times the rms height, where both
    // sides show the single bands of their grids: there the shares of the area are compared.
    if (v[0] > 1.0) {
      EXPECT_LT(relative(point.density, v[1]), 5e-3) << v[0];
      EXPECT_LT(relative(point.per_decade, v[2]), 5e-3) << v[0];
    }
    if (point.per_decade > peak) {
      peak = point.per_decade;
      peak_stress = v[0];
    }
    // P(u) du = P(s) 2 s/(u + h0) du, by trapezoids in ln u.
    const double ours = point.density * 2 * point.stress / (u + h0) * u;
    const double table = v[1] * 2 * v[0] / (u + h0) * u;
    if (i > 1) {
      area += 0.5 * (ours + previous) * std::log(u / previous_u);
      table_area += 0.5 * (table + table_previous) * std::log(u / previous_u);
    }
    EXPECT_NEAR(area, table_area, 3e-4) << v[0];
    previous_u = u;
    previous = ours;
    table_previous = table;
  }
  EXPECT_GT(peak_stress, 0.99 * rows[1].values[0]);
  EXPECT_NEAR(area, gaps.cumulative(u) - gaps.cumulative(1e-11), 1e-3);
}

TEST(Plasticity, YieldedAndElasticSharesAreExact) {
  for (const double p : {1e4, 5e6, 20e6}) {
    const double yield = 50e6;
    // Far beyond yield everything that touches has yielded.
    EXPECT_NEAR(plastic_shares(p, 1e4 * yield * yield, yield).plastic, p / yield, 1e-12);
    EXPECT_NEAR(plastic_shares(p, 1e-6 * yield * yield, yield).plastic, 0, 1e-12);
    // Both series agree where they meet, and far from yield the elastic share is Persson's.
    const double seam = 4 * yield * yield / (kPi * kPi);
    const ContactShares a = plastic_shares(p, seam * (1 - 1e-10), yield);
    const ContactShares b = plastic_shares(p, seam * (1 + 1e-10), yield);
    EXPECT_LT(relative(a.elastic, b.elastic), 1e-6);
    EXPECT_LT(relative(a.plastic, b.plastic), 1e-6);
    const double small = square(0.05 * yield);
    EXPECT_LT(relative(plastic_shares(p, small, yield).elastic, std::erf(p / std::sqrt(small))),
              1e-10);
  }
}

TEST(Plasticity, SmoothedRoughnessHasThePrintedValues) {
  const PowerSpectrum wrist = wrist_spectrum();
  const MeanFieldSolid soft{100e6, 0.5, 200e-6, 10e3, 0.5}, hard{1e9, 0.5, 200e-6, 10e3, 0.5};
  EXPECT_NEAR(plastic_smoothing(wrist, soft, 50e6, 10e3, kPurePersson).rms(), 22.00e-6, 0.02e-6);
  EXPECT_NEAR(plastic_smoothing(wrist, hard, 50e6, 10e3, kPurePersson).rms(), 20.18e-6, 0.05e-6);
  const PowerSpectrum smooth = plastic_smoothing(wrist, hard, 50e6, 10e3, kPurePersson);
  EXPECT_LT(relative(smooth.slope(), 0.1309), 5e-3);
  // The elastic area of the smoothed surface is load over hardness: fully yielded.
  EXPECT_LT(relative(MeanField(smooth, hard, kTables).area(10e3), 2.000e-4), 1e-3);
  EXPECT_LT(
      relative(MeanField(plastic_smoothing(wrist, soft, 50e6, 10e3, kPurePersson), soft, kTables)
                   .area(10e3),
               2.003e-4),
      1e-3);
}

TEST(GapDistribution, CapacitanceGapMatchesTheTable) {
  for (const TableRow& row : read_table("t52_gap_calibration.csv", true)) {
    const auto& v = row.values;
    const MeanField field(
        wrist_spectrum().scaled(v[1]), {v[0] * 1e6, 0.5, 200e-6, 10e3, 0.5},
        {.kappa = 2, .energy_factor = 0.45, .intervals = 450, .smallest_gap = 1e-11});
    const double p = 1.0 / 30e-6, h0 = 0.256e-6;
    EXPECT_LT(relative(field.area(p), v[4]), 5e-3);
    if (v[4] > 0.3) continue;
    const GapDistribution gaps = field.gaps(p);
    EXPECT_LT(relative(1 / gaps.inverse(h0), v[6] * 1e-6 + h0), 5e-3) << v[0] << " " << v[1];
    EXPECT_LT(relative(1 / std::sqrt(gaps.inverse_square(h0)), v[7] * 1e-6 + h0), 5e-3)
        << v[0] << " " << v[1];
  }
}

TEST(GfmdSimulation, AreaIsWithinTenPercent) {
  // Published simulations, H = 0.8, two decades: kappa = 2 is -16 .. +9 %, the pure theory -33 %.
  for (const TableRow& row : read_table("t02_gfmd_area_energy.csv", true)) {
    const auto& v = row.values;
    if (v[1] < 0.01 || v[1] > 0.9) continue;
    PowerSpectrum s = self_affine_spectrum(1e-6, 1e3, 1e3, 1e5, 0.8);
    const MeanField field(s, {1e6, 0, 0, 1e6, 0}, {});
    EXPECT_LT(relative(field.area(v[1] * 1e6 * s.slope()), v[2]), 0.11) << v[1];
  }
}

// Eq. persson.7 with gamma = 1 is half an exponential integral, E1(1/y) / 2.
TEST(GapIntegrals, NodesOfTheTableAreExponentialIntegrals) {
  const std::vector<double> table = *gap_integral_table(1);
  for (int exponent = -3; exponent < 60; exponent += 7) {
    for (int cell : {0, 1, 77, 127}) {
      const double y = std::ldexp(1 + cell / 128.0, exponent);
      const double expected = -0.5 * std::expint(-1 / y) / std::sqrt(y);
      EXPECT_NEAR(look_up(table, y), expected, 1e-9 * expected) << y;
    }
  }
}

TEST(PowerIntegral, IsThatOfAPowerAndOfTheLogarithmBetweenThem) {
  EXPECT_DOUBLE_EQ(power_integral(-1, 2, 6), std::log(3.0));
  EXPECT_NEAR(power_integral(-1 + 1e-9, 2, 6), std::log(3.0), 1e-8);
  EXPECT_NEAR(power_integral(2, 1, 3), 26.0 / 3, 1e-12);
  EXPECT_NEAR(power_integral(-3, 1, 2), 3.0 / 8, 1e-12);
}

}  // namespace
}  // namespace papilla::tests::persson_test
