// No cliffs: a sample of the sweeps of results/accuracy/steps.csv.
#include <gtest/gtest.h>

#include <mutex>

#include "steps.h"
#include "tests/support/thorough.h"

namespace papilla::tests::steps_slow_test {
namespace {

Fidelity common_skins() {
  Fidelity fidelity = fidelity_level("search");
  fidelity.skins = 2;
  fidelity.control_skins = 0;
  fidelity.threads = 1;
  return fidelity;
}

void expect_no_steps(const std::vector<Line>& lines, std::size_t least) {
  const Fidelity fidelity = common_skins();
  std::size_t judged = 0;
  std::mutex mutex;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<Judged> found = judge_steps(lines[i], fidelity);
    const std::lock_guard lock(mutex);
    judged += found.size();
    for (const Judged& j : found) {
      EXPECT_FALSE(j.is_step) << lines[i].design << ", " << lines[i].key << ": "
                              << kQuantities[j.quantity] << " steps by " << 100 * j.step << " % at "
                              << j.place << ", a move by a thousandth by " << 100 * j.moved << " %";
    }
  }
  EXPECT_GE(judged, least);
}

TEST(NoCliffs, ASweptNumberOfADesignHasNoStep) {
  // A whole number of particles or periods in the patch steps, and says so
  // (docs/theory/accuracy.md).
  const auto stated = [](const Line& line) {
    return line.design.starts_with("particle_film") || line.key == "texture.period";
  };
  std::vector<Line> sample;
  const auto every = static_cast<std::size_t>(cases(120, 10));
  std::size_t at = 0;
  for (Line& line : every_number(PAPILLA_DESIGNS_DIR)) {
    if (!stated(line) && at++ % every == 0) sample.push_back(std::move(line));
  }
  const auto least = static_cast<std::size_t>(cases(2, 20));
  ASSERT_GE(sample.size(), least);
  expect_no_steps(sample, 5 * least / 2);
}

TEST(NoCliffs, ALineBetweenTwoDesignsHasNoStep) {
  const int drawn = cases(8, 24);
  std::vector<Line> sample;
  for (Line& line : random_lines(PAPILLA_DESIGNS_DIR, drawn, kWalks[0])) {
    if (!line.design.starts_with("particle_film")) sample.push_back(std::move(line));
  }
  expect_no_steps(sample, static_cast<std::size_t>(cases(8, 30)));
}

}  // namespace
}  // namespace papilla::tests::steps_slow_test
