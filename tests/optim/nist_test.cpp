// Least squares against the Statistical Reference Datasets of NIST for nonlinear regression: all 27
// problems from both starting points, certified values and standard deviations of the parameters
// (tests/data/optim/nist).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "optim/least_squares.h"

namespace papilla::tests::nist_test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
// Models and data in extended precision: the residuals of Lanczos1 are 1e-13 of its data.
using Real = long double;
using Row = std::array<Real, 3>;  // y, x, second x (of one problem)
using Values = std::span<const Real>;
using Model = Real (*)(Values b, const Row& row);

struct Problem {
  std::vector<double> starts[2], certified, deviation;
  double squares = 0;  // certified sum of squared residuals
  std::vector<Row> rows;
};

Problem read_problem(const std::string& name) {
  std::ifstream file(std::string(PAPILLA_TEST_DATA) + "/optim/nist/" + name + ".dat");
  Problem out;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t equals = line.find('=');
    const std::string squares = "Residual Sum of Squares:";
    if (number > 40 && number < 60 && equals != std::string::npos) {
      std::istringstream words(line.substr(equals + 1));
      double a = 0, b = 0, value = 0, deviation = 0;
      words >> a >> b >> value >> deviation;
      out.starts[0].push_back(a);
      out.starts[1].push_back(b);
      out.certified.push_back(value);
      out.deviation.push_back(deviation);
    } else if (line.starts_with(squares)) {
      out.squares = std::stod(line.substr(squares.size()));
    } else if (number > 60) {
      std::istringstream words(line);
      Row row{};
      if (words >> row[0] >> row[1]) {
        words >> row[2];
        out.rows.push_back(row);
      }
    }
  }
  return out;
}

Real exponentials(Values b, const Row& r) {
  return b[0] * std::exp(-b[1] * r[1]) + b[2] * std::exp(-b[3] * r[1]) +
         b[4] * std::exp(-b[5] * r[1]);
}

Real two_peaks(Values b, const Row& r) {
  const Real s = (r[1] - b[3]) / b[4], t = (r[1] - b[6]) / b[7];
  return b[0] * std::exp(-b[1] * r[1]) + b[2] * std::exp(-s * s) + b[5] * std::exp(-t * t);
}

Real cubic_over_cubic(Values b, const Row& r) {
  const Real x = r[1];
  return (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (1 + x * (b[4] + x * (b[5] + x * b[6])));
}

Real damped(Values b, const Row& r) { return std::exp(-b[0] * r[1]) / (b[1] + b[2] * r[1]); }

Real saturation(Values b, const Row& r) { return b[0] * (1 - std::exp(-b[1] * r[1])); }

const std::map<std::string, Model>& models() {
  static const std::map<std::string, Model> out{
      {"Bennett5", [](Values b, const Row& r) { return b[0] * std::pow(b[1] + r[1], -1 / b[2]); }},
      {"BoxBOD", saturation},
      {"Chwirut1", damped},
      {"Chwirut2", damped},
      {"DanWood", [](Values b, const Row& r) { return b[0] * std::pow(r[1], b[1]); }},
      {"ENSO",
       [](Values b, const Row& r) {
         const Real x = 2 * std::numbers::pi_v<Real> * r[1];
         return b[0] + b[1] * std::cos(x / 12) + b[2] * std::sin(x / 12) +
                b[4] * std::cos(x / b[3]) + b[5] * std::sin(x / b[3]) + b[7] * std::cos(x / b[6]) +
                b[8] * std::sin(x / b[6]);
       }},
      {"Eckerle4",
       [](Values b, const Row& r) {
         const Real t = (r[1] - b[2]) / b[1];
         return b[0] / b[1] * std::exp(-0.5 * t * t);
       }},
      {"Gauss1", two_peaks},
      {"Gauss2", two_peaks},
      {"Gauss3", two_peaks},
      {"Hahn1", cubic_over_cubic},
      {"Kirby2",
       [](Values b, const Row& r) {
         const Real x = r[1];
         return (b[0] + x * (b[1] + x * b[2])) / (1 + x * (b[3] + x * b[4]));
       }},
      {"Lanczos1", exponentials},
      {"Lanczos2", exponentials},
      {"Lanczos3", exponentials},
      {"MGH09",
       [](Values b, const Row& r) {
         const Real x = r[1];
         return b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]);
       }},
      {"MGH10", [](Values b, const Row& r) { return b[0] * std::exp(b[1] / (r[1] + b[2])); }},
      {"MGH17",
       [](Values b, const Row& r) {
         return b[0] + b[1] * std::exp(-r[1] * b[3]) + b[2] * std::exp(-r[1] * b[4]);
       }},
      {"Misra1a", saturation},
      {"Misra1b",
       [](Values b, const Row& r) { return b[0] * (1 - std::pow(1 + b[1] * r[1] / 2, -2)); }},
      {"Misra1c",
       [](Values b, const Row& r) { return b[0] * (1 - 1 / std::sqrt(1 + 2 * b[1] * r[1])); }},
      {"Misra1d", [](Values b, const Row& r) { return b[0] * b[1] * r[1] / (1 + b[1] * r[1]); }},
      {"Nelson",
       [](Values b, const Row& r) { return b[0] - b[1] * r[1] * std::exp(-b[2] * r[2]); }},
      {"Rat42", [](Values b, const Row& r) { return b[0] / (1 + std::exp(b[1] - b[2] * r[1])); }},
      {"Rat43",
       [](Values b, const Row& r) {
         return b[0] / std::pow(1 + std::exp(b[1] - b[2] * r[1]), 1 / b[3]);
       }},
      {"Roszman1",
       [](Values b, const Row& r) {
         return b[0] - b[1] * r[1] - std::atan(b[2] / (r[1] - b[3])) / std::numbers::pi_v<Real>;
       }},
      {"Thurber", cubic_over_cubic},
  };
  return out;
}

// Digits that agree, by the worst of the values.
double digits(const std::vector<double>& values, const std::vector<double>& certified) {
  double worst = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    worst = std::max(worst, std::abs(values[i] / certified[i] - 1));
  return std::isfinite(worst) ? -std::log10(std::max(worst, 1e-16)) : 0;
}

TEST(Nist, CertifiedValuesAndStandardErrorsOfAllProblemsFromBothStarts) {
  LeastSquaresOptions options;  // one set for all
  options.iterations = 2000;
  options.tolerance = 1e-20;
  options.variance = ResidualVariance::Estimated;
  int held = 0, runs = 0;
  for (const auto& [name, model] : models()) {
    const Problem problem = read_problem(name);
    ASSERT_GT(problem.rows.size(), problem.certified.size()) << name;
    for (const std::vector<double>& start : problem.starts) {
      std::vector<FitParameter> parameters;
      for (std::size_t i = 0; i < start.size(); ++i)
        parameters.push_back({fmt::format("b{}", i + 1), start[i], -kInf, kInf});
      const LeastSquaresFit fit = least_squares(
          parameters, static_cast<int>(problem.rows.size()),
          [&](std::span<const double> b, std::span<double> out) {
            const std::vector<Real> values(b.begin(), b.end());
            for (std::size_t i = 0; i < problem.rows.size(); ++i) {
              const Row& row = problem.rows[i];
              const Real y = name == "Nelson" ? std::log(row[0]) : row[0];
              out[i] = static_cast<double>(y - model(values, row));
            }
            return true;
          },
          options);
      std::vector<double> errors;
      for (const ParameterFit& p : fit.parameters) errors.push_back(p.se);
      const double values = digits(fit.values(), problem.certified);
      const double deviations = digits(errors, problem.deviation);
      const bool good = values >= 6 && deviations >= 4;
      std::printf("%-9s start %d: %4.1f digits, standard errors %4.1f, %5d evaluations%s\n",
                  name.c_str(), &start == problem.starts ? 1 : 2, values, deviations,
                  fit.evaluations, good ? "" : "  <-");
      held += good;
      ++runs;
    }
  }
  std::printf("%d of %d runs hold\n", held, runs);
  EXPECT_EQ(runs, 54);
  EXPECT_GE(held, 53);
}

}  // namespace
}  // namespace papilla::tests::nist_test
