// Student's distribution by its finite sums (Abramowitz & Stegun 26.7.3 and 4), its quantiles by
// the series as it is printed (26.7.5), and rules and transforms of other sizes than the solvers
// use.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/constants.h"
#include "base/random.h"
#include "numerics/convolution.h"
#include "numerics/statistics.h"

namespace papilla::tests::distributions_test {
namespace {

// P(|T| < t) by sums of powers of cos(atan(t/sqrt(n))).
double within(double t, int n) {
  const double theta = std::atan(t / std::sqrt(n)), s = std::sin(theta), c = std::cos(theta);
  double sum = 0, term = n % 2 == 0 ? 1 : c;
  for (int k = n % 2 == 0 ? 0 : 1; k <= n - 2; k += 2) {
    sum += term;
    term *= c * c * (k + 1) / (k + 2);
  }
  return n % 2 == 0 ? s * sum : 2 / kPi * (theta + s * sum);
}

TEST(Distributions, StudentsIsItsFiniteSums) {
  for (const int n : {1, 2, 3, 4, 5, 6, 7, 12, 25, 60, 301, 2000}) {
    for (const double t : {0.02, 0.4, 1.0, 1.9, 3.3, 8.0, 40.0}) {
      const double inside = within(t, n);
      EXPECT_NEAR(student_t_cdf(t, n), 0.5 + 0.5 * inside, 1e-11) << n << " " << t;
      EXPECT_NEAR(student_t_cdf(-t, n), 0.5 - 0.5 * inside, 1e-11) << n << " " << t;
    }
    EXPECT_EQ(student_t_cdf(0, n), 0.5);
  }
  // Between whole degrees it lies between: 2.5 of 2 and 3, by a fifth of their difference from the
  // middle at most.
  for (const double t : {0.5, 2.0})
    EXPECT_NEAR(student_t_cdf(t, 2.5), 0.5 + 0.25 * (within(t, 2) + within(t, 3)),
                0.1 * (within(t, 3) - within(t, 2)));
  // Small tails keep their digits: t^-n (n = 3: the first term of the series about infinity).
  EXPECT_NEAR(student_t_cdf(-1e5, 3) / (2 * std::sqrt(3.0) / kPi * 1e-15), 1, 1e-9);
}

TEST(Distributions, StudentsIsTheSameByBothWaysWhereItIsNearlyNormal) {
  for (const double t : {-2.0, -0.3, 1.0, 3.0}) {
    const double inside = within(std::abs(t), 100002);
    EXPECT_NEAR(student_t_cdf(t, 100002), 0.5 + (t > 0 ? 0.5 : -0.5) * inside, 2e-11) << t;
    EXPECT_NEAR(student_t_cdf(t, 99998), 0.5 + (t > 0 ? 0.5 : -0.5) * within(std::abs(t), 99998),
                1e-9)
        << t;
  }
}

TEST(Distributions, StudentsQuantilesAreThePrintedSeries) {
  for (const double p : {0.02, 0.3, 0.7, 0.95, 0.999}) {
    const double x = normal_quantile(p);
    const auto power = [&](int k) { return std::pow(x, k); };
    const double g1 = (power(3) + x) / 4, g2 = (5 * power(5) + 16 * power(3) + 3 * x) / 96,
                 g3 = (3 * power(7) + 19 * power(5) + 17 * power(3) - 15 * x) / 384,
                 g4 = (79 * power(9) + 776 * power(7) + 1482 * power(5) - 1920 * power(3) -
                       945 * x) /
                      92160;
    for (const int n : {3, 4, 9, 30}) {
      const double series =
          x + g1 / n + g2 / std::pow(n, 2) + g3 / std::pow(n, 3) + g4 / std::pow(n, 4);
      EXPECT_NEAR(student_t_quantile(p, n), series, 1e-12 * (1 + std::abs(series)))
          << p << " " << n;
    }
    EXPECT_NEAR(student_t_quantile(p, 1), std::tan(kPi * (p - 0.5)), 1e-12 * std::abs(1 / p));
    const double q = student_t_quantile(p, 2);  // inverted: P = 1/2 + q / (2 sqrt(2 + q^2))
    EXPECT_NEAR(0.5 + q / (2 * std::sqrt(2 + q * q)), p, 1e-14);
  }
  EXPECT_EQ(student_t_quantile(0.9, 0), kInfinity);
  EXPECT_EQ(student_t_quantile(0.9, -3), kInfinity);
}

TEST(Distributions, NormalQuantilesAreThePrinted) {
  // Abramowitz & Stegun, table 26.5 and its neighbours.
  for (const auto& [p, x] : {std::pair{0.5, 0.0},
                             {0.9, 1.2815515655446004},
                             {0.99, 2.3263478740408408},
                             {0.999, 3.0902323061678132},
                             {1e-9, -5.9978070150076865}})
    EXPECT_NEAR(normal_quantile(p), x, 1e-12) << p;
  EXPECT_THROW(normal_quantile(0), InternalError);
  EXPECT_THROW(normal_quantile(1), InternalError);
  EXPECT_THROW(quantile({}, 0.5), InternalError);
  EXPECT_THROW(ratio_estimate(std::vector<double>{1}, std::vector<double>{1, 2}), InternalError);
}

// A ratio by the delta method: 12/6 of pairs (2, 1), (3, 2), (7, 3), whose rests are 0, -1, 1.
TEST(Distributions, ARatioHasTheErrorOfItsRests) {
  const Estimate e = ratio_estimate(std::vector<double>{2, 3, 7}, std::vector<double>{1, 2, 3});
  EXPECT_DOUBLE_EQ(e.value, 2);
  EXPECT_DOUBLE_EQ(e.se, std::sqrt(3.0) / 6);
}

TEST(Distributions, TheJackknifeOfOneAndOfSquares) {
  // The square of a mean of 1, 2, 6: 9 in all, 16, 12.25 and 2.25 without each, 61/6 on average.
  const std::vector<double> samples = jackknife_samples(9, std::vector<double>{16, 12.25, 2.25});
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_NEAR(samples[0], 9 - 2 * (16 - 61 / 6.0), 1e-13);
  EXPECT_NEAR(samples[1], 9 - 2 * (12.25 - 61 / 6.0), 1e-13);
  EXPECT_NEAR(samples[2], 9 - 2 * (2.25 - 61 / 6.0), 1e-13);
  EXPECT_EQ(jackknife_samples(5, std::vector<double>{4}), std::vector<double>{5});
}

// Multiples of 16 from 32 on whose sixteenth has no prime above 13, and nothing else.
TEST(Convolutions, SuitTheseSizesAlone) {
  std::vector<int> sizes;
  for (int n = 1; n <= 512; ++n) {
    EXPECT_EQ(Convolution::suits(n, 32), Convolution::suits(32, n)) << n;
    if (Convolution::suits(n, 32)) sizes.push_back(n);
  }
  EXPECT_EQ(sizes,
            (std::vector<int>{32,  48,  64,  80,  96,  112, 128, 144, 160, 176, 192, 208, 224,
                              240, 256, 288, 320, 336, 352, 384, 400, 416, 432, 448, 480, 512}));
  EXPECT_FALSE(Convolution::suits(16, 16));
  EXPECT_FALSE(Convolution::suits(0, 32));
  EXPECT_THROW(Convolution(16, 32), InternalError);
  EXPECT_THROW(Convolution(32, 36), InternalError);
  EXPECT_EQ(Convolution::shared(48, 32), Convolution::shared(48, 32));
  EXPECT_NE(Convolution::shared(48, 32), Convolution::shared(32, 48));
}

// Half the spectrum and one strip of at most eight columns side by side.
TEST(Convolutions, NeedHalfASpectrumAndAStripOfColumns) {
  EXPECT_EQ(Convolution(32, 48).scratch_size(), 48u * (16 + 8));
  EXPECT_EQ(Convolution(96, 32).scratch_size(), 32u * (48 + 8));
}

// By its waves one by one: an impulse under a kernel of three waves, whatever the radices are.
TEST(Convolutions, OfAnImpulseIsTheKernel) {
  for (const auto& [nx, ny] :
       {std::pair{32, 48}, {80, 32}, {112, 64}, {176, 32}, {32, 208}, {144, 96}}) {
    const Convolution convolution(nx, ny);
    const int half = nx / 2 + 1;
    std::vector<double> symbol(static_cast<std::size_t>(half * ny), 0.0);
    struct Wave {
      int kx, ky;
      double size;
    };
    const std::vector<Wave> waves{
        {0, 0, 0.5},      {3, 0, 1},     {0, 5, 2},           {nx / 2, 0, 3},
        {0, ny / 2, 0.7}, {2, 7, -1.5},  {nx / 2, ny / 2, 4}, {nx / 2 - 1, 1, 1.1},
        {5, ny / 2, 0.3}, {nx / 2, 3, 6}};
    for (const Wave& w : waves) {
      symbol[static_cast<std::size_t>(w.ky * half + w.kx)] = w.size;
      symbol[static_cast<std::size_t>((ny - w.ky) % ny * half + w.kx)] = w.size;
    }
    const int px = 7, py = 11;
    RealArray field(static_cast<std::size_t>(nx * ny), 0.0);
    field[static_cast<std::size_t>(py * nx + px)] = 1;
    SpectrumArray scratch(convolution.scratch_size());
    convolution.apply(field.data(), convolution.arrange(symbol), scratch.data(), field.data());
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        double sum = 0;  // each wave of a real field with its conjugate, and mirrored in y
        for (const Wave& w : waves) {
          const double along = (w.kx == 0 || 2 * w.kx == nx ? 1 : 2) *
                               std::cos(2 * kPi * w.kx * (x - px) / nx),
                       across = (w.ky == 0 || 2 * w.ky == ny ? 1 : 2) *
                                std::cos(2 * kPi * w.ky * (y - py) / ny);
          sum += w.size * along * across;
        }
        ASSERT_NEAR(field[static_cast<std::size_t>(y * nx + x)], sum, 1e-12)
            << nx << " " << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace papilla::tests::distributions_test
