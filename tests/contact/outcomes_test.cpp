// What a solve hands back, as a whole: without a load, of wrong input, short of its certificate,
// from starts that are of no use; and how many transforms and steps it takes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "fields/price.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"
#include "physics/contact/facts.h"
#include "physics/contact/solvers.h"

namespace papilla::tests::outcomes_test {
namespace {

using namespace papilla::contact;

const LayeredSolid kSolid{3e6, 0.4, 3e-7, 1e6, 0.45};
constexpr Grid kGrid{32, 24, 2e-6, 1.8e-6};

std::vector<double> rough() { return random_surface({1e-8, 1e-6, 0.8, 2e-7}, kGrid, 1, 7).z; }

double mean_of(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

RealArray displaced(const ContactKernel& kernel, const std::vector<double>& p,
                    const std::vector<double>& traction) {
  RealArray u(p.begin(), p.end());
  for (std::size_t i = 0; i < traction.size(); ++i) u[i] -= traction[i];
  SpectrumArray scratch(kernel.scratch_size());
  kernel.displace(u, u, scratch);
  return u;
}

// Eq. contact.4 of a pressure, by its definition.
double certificate_of(const ContactKernel& kernel, const std::vector<double>& height,
                      const std::vector<double>& traction, const ContactSolution& s,
                      double spread) {
  const RealArray u = displaced(kernel, s.pressure, traction);
  double work = 0, load = 0, low = kInfinity;
  for (std::size_t i = 0; i < u.size(); ++i) {
    work += s.pressure[i] * (u[i] - height[i]);
    load += s.pressure[i];
    low = std::min(low, u[i] - height[i]);
  }
  return (work - low * load) / (load * spread);
}

double deviation(const std::vector<double>& v) {
  const double mean = mean_of(v);
  double squares = 0;
  for (const double x : v) squares += square(x - mean);
  return std::sqrt(squares / static_cast<double>(v.size()));
}

TEST(ContactOutcome, WithoutALoadTheGapIsThatOfFirstTouch) {
  const ContactKernel kernel(kGrid, kSolid);
  const std::vector<double> h = rough();
  const double top = *std::max_element(h.begin(), h.end());
  const ContactSolution bare = solve_contact(kernel, h, 0, {}, {});
  EXPECT_EQ(bare.status, ContactStatus::NoLoad);
  EXPECT_EQ(bare.reason, "no load: first touch");
  EXPECT_EQ(bare.fft_pairs, 0);
  EXPECT_DOUBLE_EQ(bare.shift, -top);
  EXPECT_EQ(bare.pressure, std::vector<double>(kGrid.size(), 0.0));
  for (std::size_t i = 0; i < h.size(); ++i) ASSERT_DOUBLE_EQ(bare.gap[i], top - h[i]);
  EXPECT_EQ(solve_contact(kernel, h, -1, {}, {}).reason, "the tractions lift the surfaces apart");
  // Tractions that pull here and push there move the surface all the same.
  std::vector<double> traction(kGrid.size());
  for (std::size_t i = 0; i < traction.size(); ++i) traction[i] = i % 32 < 10 ? 3e3 : -4e3;
  const double lift = -mean_of(traction);
  ASSERT_GT(lift, 1e3);
  const ContactSolution lifted = solve_contact(kernel, h, 0.5 * lift, traction, {});
  EXPECT_EQ(lifted.status, ContactStatus::NoLoad);
  EXPECT_EQ(lifted.reason, "the tractions lift the surfaces apart");
  EXPECT_EQ(lifted.fft_pairs, 1);
  const RealArray u = displaced(kernel, std::vector<double>(kGrid.size(), 0.0), traction);
  double low = kInfinity;
  for (std::size_t i = 0; i < h.size(); ++i) low = std::min(low, u[i] - h[i]);
  EXPECT_NEAR(lifted.shift, low, 1e-18);
  for (std::size_t i = 0; i < h.size(); ++i) ASSERT_NEAR(lifted.gap[i], u[i] - h[i] - low, 1e-18);
  // A little more load than they lift is a contact.
  EXPECT_EQ(solve_contact(kernel, h, 1.01 * lift, traction, {}).status, ContactStatus::Converged);
}

TEST(ContactOutcome, OfWrongInputIsEmptyAndSaysWhatIsWrong) {
  const ContactKernel kernel(kGrid, kSolid);
  const std::vector<double> h = rough(), zero(kGrid.size(), 0.0);
  const auto expect_empty = [&](const ContactSolution& s, const std::string& reason) {
    EXPECT_EQ(s.status, ContactStatus::Invalid);
    EXPECT_EQ(s.reason, reason);
    EXPECT_EQ(s.pressure, zero);
    EXPECT_EQ(s.gap, zero);
  };
  const std::string what = "heights, load or tractions are not finite numbers on the kernel's grid";
  expect_empty(solve_contact(kernel, h, NAN, {}, {}), what);
  expect_empty(solve_contact(kernel, h, 1e3, std::vector<double>(3, 0.0), {}), what);
  expect_empty(solve_approach(kernel, h, NAN, {}),
               "heights or approach are not finite numbers on the kernel's grid");
  const ContactSolution hard = solve_contact(kernel, h, 2e6, {}, {.hardness = 1.5e6});
  EXPECT_EQ(hard.status, ContactStatus::Invalid);
  EXPECT_EQ(hard.reason, "mean load 2e+06 Pa is beyond the hardness 1.5e+06 Pa everywhere");
  EXPECT_EQ(hard.pressure, std::vector<double>(kGrid.size(), 1.5e6));
  // A quarter of it 4 nm high, the rest 0: full contact 3 nm below the top.
  std::vector<double> plateau(kGrid.size(), 0.0);
  for (std::size_t i = 0; i < plateau.size() / 4; ++i) plateau[i] = 4e-9;
  expect_empty(solve_approach(kernel, plateau, 5e-9, {}),
               "approach 5e-09 m beyond full contact, reached at 3e-09 m");
  EXPECT_EQ(solve_approach(kernel, plateau, 2.5e-9, {}).status, ContactStatus::Converged);
  const ContactSolution apart = solve_approach(kernel, plateau, -2e-9, {});
  EXPECT_EQ(apart.status, ContactStatus::NoLoad);
  EXPECT_EQ(apart.reason, "the surfaces do not touch yet");
  EXPECT_DOUBLE_EQ(apart.shift, -6e-9);
  EXPECT_EQ(apart.pressure, zero);
  for (std::size_t i = 0; i < zero.size(); ++i) ASSERT_NEAR(apart.gap[i], 6e-9 - plateau[i], 1e-22);
}

// The certificate of what is returned, over the heights' deviation; of a flat surface over a
// millionth of what a pixel gives under the mean load.
TEST(ContactOutcome, IsCertifiedOverTheHeightsOrAPixelsYield) {
  const ContactKernel kernel(kGrid, kSolid);
  const std::vector<double> h = rough(), flat(kGrid.size(), 2e-9);
  std::vector<double> traction(kGrid.size());
  for (std::size_t i = 0; i < traction.size(); ++i) traction[i] = i % 32 < 10 ? 3e3 : 1e3;
  for (const ContactMethod method : {ContactMethod::Dense, ContactMethod::Auto}) {
    const ContactOptions options{.tolerance = 1e-6, .method = method};
    const ContactSolution s = solve_contact(kernel, h, 500, traction, options);
    ASSERT_TRUE(s.converged());
    EXPECT_LE(s.certificate, 1e-6);
    EXPECT_NEAR(s.certificate, certificate_of(kernel, h, traction, s, deviation(h)), 1e-11);
  }
  const ContactOptions short_of{
      .tolerance = 1e-6, .max_iterations = 0, .method = ContactMethod::Dense};
  const ContactSolution s = solve_contact(kernel, flat, 500, traction, short_of);
  const double spread = 1e-6 * (500 + mean_of(traction)) * kernel.self_compliance();
  EXPECT_NEAR(s.certificate, certificate_of(kernel, flat, traction, s, spread),
              1e-8 * s.certificate);
  EXPECT_GT(s.certificate, 1);
}

TEST(ContactOutcome, ShortOfItsCertificateSaysAfterHowManySteps) {
  const ContactKernel kernel(kGrid, kSolid);
  const std::vector<double> h = rough();
  const auto after = [&](int most) {
    return solve_contact(
        kernel, h, 3e3, {},
        {.tolerance = 1e-9, .max_iterations = most, .method = ContactMethod::Dense});
  };
  for (const int most : {0, 1, 4}) {
    const ContactSolution s = after(most);
    EXPECT_EQ(s.status, ContactStatus::IterationLimit);
    EXPECT_EQ(s.iterations, most);
    EXPECT_TRUE(s.reason.ends_with(" above 1e-09 after " + std::to_string(most) + " iterations"))
        << s.reason;
    EXPECT_NEAR(std::stod(s.reason.substr(12)), s.certificate, 0.06 * s.certificate) << s.reason;
    EXPECT_NEAR(s.certificate, certificate_of(kernel, h, {}, s, deviation(h)), 1e-9);
  }
  const ContactSolution whole = after(1000);
  EXPECT_EQ(whole.status, ContactStatus::Converged);
  EXPECT_EQ(whole.reason, "");
  // As many steps as it takes are enough, one less is not.
  EXPECT_EQ(after(whole.iterations).status, ContactStatus::Converged);
  EXPECT_EQ(after(whole.iterations - 1).status, ContactStatus::IterationLimit);
  // Below rounding nothing is gained: it ends a hundred steps after its best.
  const ContactSolution best =
      solve_contact(kernel, h, 3e3, {},
                    {.tolerance = -1, .max_iterations = 5000, .method = ContactMethod::Dense});
  EXPECT_EQ(best.status, ContactStatus::Stagnated);
  EXPECT_GT(best.iterations, 100);
  EXPECT_LT(best.iterations, 400);
  EXPECT_LT(best.certificate, 1e-12);
}

TEST(ContactOutcome, AStartThatIsNoSolutionOfThisGridIsNotTaken) {
  for (const Grid& grid : {kGrid, Grid{64, 66, 2e-6, 1.8e-6}}) {  // the second with a coarser one
    const auto kernel = make_contact_kernel(grid, kSolid);
    const std::vector<double> h = random_surface({1e-8, 1e-6, 0.8, 2e-7}, grid, 1, 7).z;
    const ContactOptions options{.tolerance = 1e-8, .method = ContactMethod::Dense};
    const ContactSolution cold = solve_contact(*kernel, h, 3e3, {}, options);
    const ContactSolution near = solve_contact(*kernel, h, 2.9e3, {}, options);
    const ContactSolution warm = solve_contact(*kernel, h, 3e3, {}, options, &near);
    EXPECT_NE(warm.pressure, cold.pressure);
    EXPECT_LT(warm.fft_pairs, cold.fft_pairs);
    ContactSolution untouched = near, unfinished = near, small = near;
    untouched.pressure.assign(grid.size(), 0.0);
    unfinished.status = ContactStatus::IterationLimit;
    small.pressure.pop_back();
    const double approach = cold.shift + *std::max_element(h.begin(), h.end());
    const ContactSolution pushed = solve_approach(*kernel, h, approach, options);
    for (const ContactSolution* start : {&untouched, &unfinished, &small}) {
      const ContactSolution s = solve_contact(*kernel, h, 3e3, {}, options, start);
      EXPECT_EQ(s.pressure, cold.pressure);
      EXPECT_EQ(s.iterations, cold.iterations);
      EXPECT_EQ(solve_approach(*kernel, h, approach, options, start).pressure, pushed.pressure);
    }
    EXPECT_NE(solve_approach(*kernel, h, approach, options, &near).pressure, pushed.pressure);
    ContactSolution waiting = near;  // a solution without a load, whose pressures press
    waiting.status = ContactStatus::NoLoad;
    EXPECT_EQ(solve_contact(*kernel, h, 3e3, {}, options, &waiting).pressure, warm.pressure);
  }
}

// A price in transforms of the grid: three at least, 3.3 a digit less 5.
TEST(ContactFacts, ArePricedByTheTransformsOfTheGrid) {
  const double pair = fft_pair_seconds(kGrid);
  EXPECT_DOUBLE_EQ(contact_seconds(kGrid, 1e-2), 3 * pair);
  EXPECT_DOUBLE_EQ(contact_seconds(kGrid, 1e-5), 11.5 * pair);
  EXPECT_DOUBLE_EQ(contact_error(2e-3), 1e-2);
}

// One transform for the tractions where nothing is known, one for the start, one a step and one
// more where the direction comes from the whole plane.
TEST(ContactOutcome, TransformsOfACarefulStartAreCounted) {
  const ContactKernel kernel(kGrid, kSolid);  // without a coarser grid
  const std::vector<double> h = rough(), none(kGrid.size(), 0.0);
  const ContactOptions options{.tolerance = 1e-8, .method = ContactMethod::Dense};
  const ContactSolution bare = solve_contact(kernel, h, 3e3, {}, options),
                        zero = solve_contact(kernel, h, 3e3, none, options);
  EXPECT_EQ(zero.pressure, bare.pressure);
  EXPECT_EQ(zero.fft_pairs, bare.fft_pairs + 1);
  EXPECT_GT(bare.fft_pairs, 1 + bare.iterations);
  EXPECT_LE(bare.fft_pairs, 1 + 2 * bare.iterations);
  const ContactSolution start = solve_contact(kernel, h, 3e3, none, options, &bare);
  EXPECT_EQ(start.fft_pairs, 1);  // which says that nothing is left to do
  EXPECT_EQ(start.iterations, 0);
  ContactOptions none_allowed = options;
  none_allowed.max_iterations = 0;
  EXPECT_EQ(solve_contact(kernel, h, 3e3, {}, none_allowed).fft_pairs, 1);
  EXPECT_EQ(solve_contact(kernel, h, 3e3, none, none_allowed).fft_pairs, 2);
}

// Where the sparse solver gives up after transforms, the dense one goes on from what it found, and
// both are counted.
TEST(ContactOutcome, TheDenseSolverGoesOnFromTheSparse) {
  const ContactKernel kernel(kGrid, kSolid);
  const std::vector<double> h = rough();
  int found = 0;
  // Whether it gives up at a load hangs on the last bits, which other processors round otherwise.
  for (double mean = 50; mean < 1e4; mean *= 1.2) {
    const StandardProblem problem{kernel, h, {}, deviation(h), mean * 768};
    StandardState sparse;
    if (solve_sparse(problem, 1e-20, nullptr, true, sparse)) continue;
    const bool some = std::any_of(sparse.p.begin(), sparse.p.end(), [](double p) { return p > 0; });
    found += some;
    const ContactSolution s =
        solve_contact(kernel, h, mean, {},
                      {.tolerance = 1e-20, .max_iterations = 3, .method = ContactMethod::Sparse});
    const StandardState dense = solve_dense(
        problem, 1e-20, 3, some ? std::span<const double>(sparse.p) : std::span<const double>());
    EXPECT_EQ(s.method, ContactMethod::Dense);
    EXPECT_EQ(s.pressure, dense.p) << mean;
    EXPECT_EQ(s.gap, dense.gap);
    EXPECT_EQ(s.fft_pairs, sparse.pairs + dense.pairs);
    EXPECT_EQ(s.iterations, dense.iterations);
    EXPECT_DOUBLE_EQ(s.elastic_energy, 0.5 * dense.work * kGrid.pixel_area());
  }
  EXPECT_GT(found, 0);
}

// A millimetre up, in steps that a double holds, the heights deviate by as much: no digit is lost
// against the mean.
TEST(ContactOutcome, OfHeightsFarFromZeroIsMeasuredByTheirDeviation) {
  const ContactKernel kernel(kGrid, kSolid);
  std::vector<double> h = rough(), lifted;
  for (double& v : h) {
    v = std::ldexp(std::round(std::ldexp(v, 55)), -55);
    lifted.push_back(v + 0x1p-10);
  }
  const ContactOptions options{
      .tolerance = 1e-9, .max_iterations = 0, .method = ContactMethod::Dense};
  const ContactSolution low = solve_contact(kernel, h, 3e3, {}, options),
                        high = solve_contact(kernel, lifted, 3e3, {}, options);
  EXPECT_GT(low.certificate, 0.1);
  EXPECT_NEAR(high.certificate, low.certificate, 1e-8 * low.certificate);
}

}  // namespace
}  // namespace papilla::tests::outcomes_test
