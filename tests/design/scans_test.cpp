// What is said of the measured maps behind a design.
#include "design/scans.h"

#include <gtest/gtest.h>

namespace papilla::tests {
namespace {

TEST(DesignScans, APartThatAloneIsTakenIsSaid) {
  DesignScan scan{"a.gsf", {}, 12e-6};
  scan.changes.width = 25.6e-6;
  scan.changes.height = 20e-6;
  EXPECT_NE(text(scan).find("of its 25.6 x 20 um the middle 12 um are the texture"),
            std::string::npos)
      << text(scan);
  scan.changes.width = scan.changes.height = 12e-6;
  EXPECT_EQ(text(scan).find("the middle"), std::string::npos) << text(scan);
}

}  // namespace
}  // namespace papilla::tests
