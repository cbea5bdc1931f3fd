// One solved patch on finer grids is the same body: its pull goes to one number.
#include "measure/field_accuracy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace papilla::tests::field_accuracy_test {
namespace {

TEST(FieldAccuracy, RefinedBodiesAreTheSameAndRulesAreNearTheirPotential) {
  Design design = read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/flat.toml");
  design.environment.relative_humidity = {0.15};
  FieldAccuracyOptions options;
  options.pixels = 48;
  options.refinements = {1, 2};
  const auto rows = field_accuracy("flat", design, options);
  ASSERT_EQ(rows.size(), 5u);
  const char* methods[] = {"local", "screened", "spread", "full", "full"};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(rows[i].method, methods[i]);
    EXPECT_EQ(rows[i].sample, "flat");
    EXPECT_EQ(rows[i].relative_humidity, 0.15);
    EXPECT_EQ(rows[i].pixels, i < 4 ? 48 : 96);
    EXPECT_EQ(rows[i].status, "");
    EXPECT_NEAR(rows[i].error, rows[i].pull / rows[4].pull - 1, 1e-15);
    // Columns miss the flux that gathers on contact spots.
    EXPECT_LT(std::abs(rows[i].error), i < 2 ? 0.45 : 0.06) << rows[i].method;
  }
  EXPECT_GE(rows[0].pull, rows[1].pull);  // screening takes away
}

}  // namespace
}  // namespace papilla::tests::field_accuracy_test
