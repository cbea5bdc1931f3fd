// Least squares against the Statistical Reference Datasets of NIST (nonlinear regression,
// https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml): data, starting values, certified values
// and standard deviations typed from its tables; and against what priors, bounds and profiles must
// give where it can be computed by hand.
#include "optim/least_squares.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"

namespace papilla {
namespace {

using Values = std::vector<double>;
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Reference {
  std::string name, difficulty;
  Values x, y;
  double (*model)(std::span<const double> b, double x);
  std::vector<Values> starts;
  Values certified, deviation;
  double squares;
};

Values steps(double first, double step, int n) {
  Values out;
  for (int i = 0; i < n; ++i) out.push_back(first + step * i);
  return out;
}

std::vector<Reference> references() {
  std::vector<Reference> out;
  out.push_back(
      {"Misra1a",
       "lower",
       {77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1,
        760.0},
       {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47,
        81.78},
       [](std::span<const double> b, double x) { return b[0] * (1 - std::exp(-b[1] * x)); },
       {{500, 1e-4}, {250, 5e-4}},
       {2.3894212918E+02, 5.5015643181E-04},
       {2.7070075241E+00, 7.2668688436E-06},
       1.2455138894E-01});
  out.push_back({"Lanczos3",
                 "lower",
                 steps(0, 0.05, 24),
                 {2.5134, 2.0443, 1.6684, 1.3664, 1.1232, 0.9269, 0.7679, 0.6389,
                  0.5338, 0.4479, 0.3776, 0.3197, 0.2720, 0.2325, 0.1997, 0.1723,
                  0.1493, 0.1301, 0.1138, 0.1000, 0.0883, 0.0783, 0.0698, 0.0624},
                 [](std::span<const double> b, double x) {
                   return b[0] * std::exp(-b[1] * x) + b[2] * std::exp(-b[3] * x) +
                          b[4] * std::exp(-b[5] * x);
                 },
                 {{1.2, 0.3, 5.6, 5.5, 6.5, 7.6}, {0.5, 0.7, 3.6, 4.2, 4, 6.3}},
                 {8.6816414977E-02, 9.5498101505E-01, 8.4400777463E-01, 2.9515951832E+00,
                  1.5825685901E+00, 4.9863565084E+00},
                 {1.7197908859E-02, 9.7041624475E-02, 4.1488663282E-02, 1.0766312506E-01,
                  5.8371576281E-02, 3.4436403035E-02},
                 1.6117193594E-08});
  out.push_back(
      {"MGH17",
       "average",
       steps(0, 10, 33),
       {0.844, 0.908, 0.932, 0.936, 0.925, 0.908, 0.881, 0.850, 0.818, 0.784, 0.751,
        0.718, 0.685, 0.658, 0.628, 0.603, 0.580, 0.558, 0.538, 0.522, 0.506, 0.490,
        0.478, 0.467, 0.457, 0.448, 0.438, 0.431, 0.424, 0.420, 0.414, 0.411, 0.406},
       [](std::span<const double> b, double x) {
         return b[0] + b[1] * std::exp(-x * b[3]) + b[2] * std::exp(-x * b[4]);
       },
       {{0.5, 1.5, -1, 0.01, 0.02}},
       {3.7541005211E-01, 1.9358469127E+00, -1.4646871366E+00, 1.2867534640E-02, 2.2122699662E-02},
       {2.0723153551E-03, 2.2031669222E-01, 2.2175707739E-01, 4.4861358114E-04, 8.9471996575E-04},
       5.4648946975E-05});
  out.push_back({"Thurber",
                 "higher",
                 {-3.067, -2.981, -2.921, -2.912, -2.840, -2.797, -2.702, -2.699, -2.633, -2.481,
                  -2.363, -2.322, -1.501, -1.460, -1.274, -1.212, -1.100, -1.046, -0.915, -0.714,
                  -0.566, -0.545, -0.400, -0.309, -0.109, -0.103, 0.010,  0.119,  0.377,  0.790,
                  0.963,  1.006,  1.115,  1.572,  1.841,  2.047,  2.200},
                 {80.574,   84.248,   87.264,   87.195,   89.076,   89.608,   89.868,   90.101,
                  92.405,   95.854,   100.696,  101.060,  401.672,  390.724,  567.534,  635.316,
                  733.054,  759.087,  894.206,  990.785,  1090.109, 1080.914, 1122.643, 1178.351,
                  1260.531, 1273.514, 1288.339, 1327.543, 1353.863, 1414.509, 1425.208, 1421.384,
                  1442.962, 1464.350, 1468.705, 1447.894, 1457.628},
                 [](std::span<const double> b, double x) {
                   return (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) /
                          (1 + x * (b[4] + x * (b[5] + x * b[6])));
                 },
                 {{1000, 1000, 400, 40, 0.7, 0.3, 0.03}, {1300, 1500, 500, 75, 1, 0.4, 0.05}},
                 {1.2881396800E+03, 1.4910792535E+03, 5.8323836877E+02, 7.5416644291E+01,
                  9.6629502864E-01, 3.9797285797E-01, 4.9727297349E-02},
                 {4.6647963344E+00, 3.9571156086E+01, 2.8698696102E+01, 5.5675370270E+00,
                  3.1333340687E-02, 1.4984928198E-02, 6.5842344623E-03},
                 5.6427082397E+03});
  out.push_back(
      {"MGH09",
       "higher",
       {4, 2, 1, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625},
       {0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246},
       [](std::span<const double> b, double x) {
         return b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]);
       },
       {{0.25, 0.39, 0.415, 0.39}},
       {1.9280693458E-01, 1.9128232873E-01, 1.2305650693E-01, 1.3606233068E-01},
       {1.1435312227E-02, 1.9633220911E-01, 8.0842031232E-02, 9.0025542308E-02},
       3.0750560385E-04});
  out.push_back(
      {"MGH10",
       "higher",
       steps(50, 5, 16),
       {34780, 28610, 23650, 19630, 16370, 13720, 11540, 9744, 8261, 7030, 6005, 5147, 4427, 3820,
        3307, 2872},
       [](std::span<const double> b, double x) { return b[0] * std::exp(b[1] / (x + b[2])); },
       {{0.02, 4000, 250}},
       {5.6096364710E-03, 6.1813463463E+03, 3.4522363462E+02},
       {1.5687892471E-04, 2.3309021107E+01, 7.8486103508E-01},
       8.7945855171E+01});
  out.push_back({"Eckerle4",
                 "higher",
                 {400,   405, 410,   415, 420,   425, 430,   435, 436.5, 438, 439.5, 441,
                  442.5, 444, 445.5, 447, 448.5, 450, 451.5, 453, 454.5, 456, 457.5, 459,
                  460.5, 462, 463.5, 465, 470,   475, 480,   485, 490,   495, 500},
                 {0.0001575, 0.0001699, 0.0002350, 0.0003102, 0.0004917, 0.0008710, 0.0017418,
                  0.0046400, 0.0065895, 0.0097302, 0.0149002, 0.0237310, 0.0401683, 0.0712559,
                  0.1264458, 0.2073413, 0.2902366, 0.3445623, 0.3698049, 0.3668534, 0.3106727,
                  0.2078154, 0.1164354, 0.0616764, 0.0337200, 0.0194023, 0.0117831, 0.0074357,
                  0.0022732, 0.0008800, 0.0004579, 0.0002345, 0.0001586, 0.0001143, 0.0000710},
                 [](std::span<const double> b, double x) {
                   const double t = (x - b[2]) / b[1];
                   return b[0] / b[1] * std::exp(-0.5 * t * t);
                 },
                 {{1.5, 5, 450}},
                 {1.5543827178E+00, 4.0888321754E+00, 4.5154121844E+02},
                 {1.5408051163E-02, 4.6803020753E-02, 4.6800518816E-02},
                 1.4635887487E-03});
  out.push_back({"Rat43",
                 "higher",
                 steps(1, 1, 15),
                 {16.08, 33.83, 65.80, 97.20, 191.55, 326.20, 386.87, 520.53, 590.03, 651.92,
                  724.93, 699.56, 689.96, 637.56, 717.41},
                 [](std::span<const double> b, double x) {
                   return b[0] / std::pow(1 + std::exp(b[1] - b[2] * x), 1 / b[3]);
                 },
                 {{100, 10, 1, 1}, {700, 5, 0.75, 1.3}},
                 {6.9964151270E+02, 5.2771253025E+00, 7.5962938329E-01, 1.2792483859E+00},
                 {1.6302297817E+01, 2.0828735829E+00, 1.9566123451E-01, 6.8761936385E-01},
                 8.7864049080E+03});
  out.push_back(
      {"BoxBOD",
       "higher",
       {1, 2, 3, 5, 7, 10},
       {109, 149, 149, 191, 213, 224},
       [](std::span<const double> b, double x) { return b[0] * (1 - std::exp(-b[1] * x)); },
       {{100, 0.75}},
       {2.1380940889E+02, 5.4723748542E-01},
       {1.2354515176E+01, 1.0455993237E-01},
       1.1680088766E+03});
  return out;
}

TEST(LeastSquares, CertifiedValuesAndStandardDeviationsOfNist) {
  int fits = 0;
  for (const Reference& r : references()) {
    for (std::size_t s = 0; s < r.starts.size(); ++s) {
      SCOPED_TRACE(fmt::format("{} ({}), start {}", r.name, r.difficulty, s + 1));
      std::vector<FitParameter> parameters;
      for (std::size_t i = 0; i < r.certified.size(); ++i)
        parameters.push_back({fmt::format("b{}", i + 1), r.starts[s][i], -kInf, kInf});
      LeastSquaresOptions options;
      options.iterations = 2000;
      options.tolerance = 1e-20;
      options.variance = ResidualVariance::Estimated;
      const LeastSquaresFit fit = least_squares(
          parameters, static_cast<int>(r.x.size()),
          [&](std::span<const double> b, std::span<double> out) {
            for (std::size_t i = 0; i < r.x.size(); ++i) out[i] = r.y[i] - r.model(b, r.x[i]);
            return true;
          },
          options);
      for (std::size_t i = 0; i < r.certified.size(); ++i) {
        EXPECT_NEAR(fit.parameters[i].value / r.certified[i], 1, 1e-6) << i;
        EXPECT_NEAR(fit.parameters[i].se / r.deviation[i], 1, 1e-4) << i;
      }
      EXPECT_NEAR(fit.chi2 / r.squares, 1, 1e-8);
      ++fits;
    }
  }
  EXPECT_GE(fits, 12);
}

// y = a + b t with unit errors at five times.
LeastSquaresFit line(std::vector<FitParameter> parameters, LeastSquaresOptions options = {}) {
  const Values t{0, 1, 2, 3, 4}, y{1.2, 2.9, 5.1, 7.2, 8.8};
  return least_squares(
      parameters, 5,
      [&](std::span<const double> p, std::span<double> r) {
        for (std::size_t i = 0; i < 5; ++i) r[i] = y[i] - p[0] - p[1] * t[i];
        return true;
      },
      options);
}

TEST(LeastSquares, APriorAddsItsInformation) {
  // Normal equations by hand: [5 10; 10 30] and [25.2; 69.9], plus 1/sd^2 at the slope.
  LeastSquaresOptions known;
  known.variance = ResidualVariance::Known;
  known.tolerance = 1e-18;
  const LeastSquaresFit free = line({{"a", 0, -100, 100}, {"b", 1, -100, 100}}, known);
  EXPECT_NEAR(free.parameters[1].value, (5 * 69.9 - 10 * 25.2) / 50, 1e-9);
  EXPECT_NEAR(free.parameters[1].se, std::sqrt(5.0 / 50), 1e-8);
  EXPECT_NEAR(free.correlation[1], -10 / std::sqrt(150.0), 1e-8);
  const LeastSquaresFit prior = line({{"a", 0, -100, 100}, {"b", 1, -100, 100, 1.0, 0.1}}, known);
  const double n = 30 + 100, det = 5 * n - 100;
  EXPECT_NEAR(prior.parameters[1].value, (5 * (69.9 + 100) - 10 * 25.2) / det, 1e-8);
  EXPECT_NEAR(prior.parameters[1].se, std::sqrt(5 / det), 1e-8);
  EXPECT_NEAR(prior.parameters[1].data_share, 30.0 / 130, 1e-8);
}

TEST(LeastSquares, AtABoundTheIntervalIsTheProfileOfTheLikelihood) {
  LeastSquaresOptions known;
  known.variance = ResidualVariance::Known;
  // The slope wants 1.95; held at 1.5 or below, it sits on the bound.
  const LeastSquaresFit fit = line({{"a", 0, -100, 100}, {"b", 1, -100, 1.5}}, known);
  EXPECT_TRUE(fit.parameters[1].at_bound);
  EXPECT_NEAR(fit.parameters[1].value, 1.5, 1e-6);
  EXPECT_TRUE(fit.parameters[1].high_open);
  // chi2 after a refit of the offset: 10 (b - 1.938)^2 + const; it rises by 1.96^2 from b = 1.5.
  const double best = (5 * 69.9 - 10 * 25.2) / 50, gap = best - 1.5;
  EXPECT_NEAR(fit.parameters[1].low, best - std::sqrt(gap * gap + 1.96 * 1.96 / 10), 2e-3);
}

TEST(LeastSquares, OfALineTheProfileIsTheInterval) {
  LeastSquaresOptions options;
  options.variance = ResidualVariance::Known;
  const auto a = line({{"a", 0, -100, 100}, {"b", 1, -100, 100}}, options);
  options.profiles = true;
  const auto b = line({{"a", 0, -100, 100}, {"b", 1, -100, 100}}, options);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(a.parameters[i].low, b.parameters[i].low, 2e-3);
    EXPECT_NEAR(a.parameters[i].high, b.parameters[i].high, 2e-3);
  }
}

TEST(LeastSquares, SingularDirectionsSayWhatTheDataCannotTellApart) {
  // Only the product p q is seen.
  const LeastSquaresFit fit =
      least_squares({{"p", 2, 0.1, 10, 2, 1, true}, {"q", 3, 0.1, 10, 3, 1, true}}, 3,
                    [](std::span<const double> p, std::span<double> r) {
                      for (std::size_t i = 0; i < 3; ++i)
                        r[i] = (p[0] * p[1] - 8) * (1 + double(i));
                      return true;
                    });
  ASSERT_EQ(fit.directions.size(), 2u);
  EXPECT_GT(fit.directions[0].singular_value, 10);
  EXPECT_LT(fit.directions[1].singular_value, 1e-3);
  EXPECT_NEAR(fit.directions[1].weights[0], -fit.directions[1].weights[1], 1e-4);
  EXPECT_LT(fit.correlation[1], -0.99);
  // The priors decide: both grow by the same factor.
  EXPECT_NEAR(fit.parameters[0].value / 2, fit.parameters[1].value / 3, 1e-3);
  EXPECT_NEAR(fit.parameters[0].value * fit.parameters[1].value, 8, 0.02);
}

TEST(LeastSquares, IntervalsHoldTheTruthAsOftenAsTheySay) {
  int inside = 0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    RandomStream random(3, "least squares test", static_cast<std::uint64_t>(run));
    Values y;
    for (int i = 0; i < 8; ++i) y.push_back(3 * std::exp(-0.4 * i) + 0.1 * random.normal());
    LeastSquaresOptions options;
    options.variance = ResidualVariance::Known;
    const LeastSquaresFit fit = least_squares(
        {{"amplitude", 1, 0.01, 100, 0, 0, true}, {"rate", 1, 0.01, 10, 0, 0, true}}, 8,
        [&](std::span<const double> p, std::span<double> r) {
          for (std::size_t i = 0; i < 8; ++i)
            r[i] = (y[i] - p[0] * std::exp(-p[1] * static_cast<double>(i))) / 0.1;
          return true;
        },
        options);
    inside += fit.parameters[1].low < 0.4 && 0.4 < fit.parameters[1].high;
  }
  EXPECT_NEAR(inside / double(kRuns), 0.95, 0.03);
}

TEST(LeastSquares, SenselessParametersAreRefused) {
  const ResidualFunction f = [](std::span<const double>, std::span<double>) { return true; };
  EXPECT_THROW(least_squares({{"p", 0, 1, 0}}, 1, f), InputError);
  EXPECT_THROW(least_squares({{"p", 5, 0, 1}}, 1, f), InputError);
  EXPECT_THROW(least_squares({{"p", 0.5, 0, 1, 0, 0, true}}, 1, f), InputError);
}

}  // namespace
}  // namespace papilla
