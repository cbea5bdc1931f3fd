// How many steps the dense solver takes: its constants were chosen by them (contact_steps_bench),
// and a worse choice, or a direction that is no longer the best one, shows in nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/roughness.h"
#include "physics/contact/contact.h"

namespace papilla::tests::dense_costs_test {
namespace {

// Light to nearly full contact, free, below a cap and by its approach, with and without a coarser
// grid to start from: 66 solves. One in a hundred more may come from rounding; a first length of
// 0.3 for 0.6, for one, costs 3 %.
TEST(DenseCosts, AreTheStepsThatTheConstantsWereChosenBy) {
  const LayeredSolid solid{3e6, 0.4, 3e-7, 1e6, 0.45};
  int solves = 0, steps = 0;
  double pairs = 0;
  for (const Grid& grid : {Grid{96, 72, 6e-6, 5.4e-6}, Grid{45, 50, 6e-6, 5.4e-6}}) {
    const auto kernel = make_contact_kernel(grid, solid);
    for (std::uint64_t k = 0; k < 3; ++k) {
      const std::vector<double> h = random_surface({1e-7, 3e-6, 0.8, 3e-7}, grid, 1, k).z;
      const double top = *std::max_element(h.begin(), h.end());
      for (const double load : {5e2, 5e3, 5e4, 3e5}) {
        ContactOptions options{.tolerance = 1e-7, .method = ContactMethod::Dense};
        const ContactSolution free = solve_contact(*kernel, h, load, {}, options);
        const ContactSolution pushed =
            load < 1e5 ? solve_approach(*kernel, h, free.shift + top, options) : free;
        options.hardness = 3e5 + load;
        const ContactSolution capped = solve_contact(*kernel, h, load, {}, options);
        for (const ContactSolution* s : {&free, &capped, &pushed}) {
          EXPECT_TRUE(s->converged()) << s->reason;
          if (s == &pushed && load > 1e5) continue;  // near full contact every level is hard
          ++solves;
          steps += s->iterations;
          pairs += s->fft_pairs;
        }
      }
    }
  }
  EXPECT_EQ(solves, 66);
  EXPECT_LE(steps, 1031 + 10);
  EXPECT_LE(pairs, 1618 + 16);
}

}  // namespace
}  // namespace papilla::tests::dense_costs_test
