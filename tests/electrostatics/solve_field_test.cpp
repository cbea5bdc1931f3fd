// papilla solve field on a flat gap against the capacitor's closed form.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "geometry/io/files.h"
#include "tests/cli/program.h"

namespace papilla::tests::solve_field_test {
namespace {

TEST(SolveField, AFlatGapIsTheSeriesCapacitor) {
  const Workplace place;
  const Grid grid{32, 32, 12e-6, 12e-6};
  write_npy((place.path() / "gap.npy").string(), {grid, std::vector<double>(grid.size(), 100e-9)});
  const double expected =
      0.5 * kVacuumPermittivity * 200 * 200 / 2 / square(100e-9 + 500e-9 / 3.9 + 20e-9);
  for (const char* method : {"local", "full"}) {
    const Outcome run = place.run(std::string("solve field --gap gap.npy --size '12 um' --voltage "
                                              "'200 V' --skin-layer '20 nm' --json --method ") +
                                  method);
    ASSERT_EQ(run.status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_TRUE(json["converged"]);
    EXPECT_NEAR(json["mean_pressure"].get<double>() / expected, 1, 1e-6) << method;
  }
}

}  // namespace
}  // namespace papilla::tests::solve_field_test
