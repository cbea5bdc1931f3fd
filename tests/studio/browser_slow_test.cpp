// The studio's page in a real browser; with searches: tests/alone.
#include <gtest/gtest.h>

#include "tests/studio/in_browser.h"

namespace papilla::tests::browser_slow_test {
namespace {

TEST(StudioInChromium, AnswersSlidersAndKeysInLightAndDarkWideAndNarrow) {
  expect_in_browser("smoke");
}
TEST(StudioInChromium, ShowsWhatItIsToldAsItIs) { expect_in_browser("modules"); }
TEST(StudioInChromium, ShowsOneStateToTwoPagesAndToOneThatComesBack) { expect_in_browser("pages"); }
TEST(StudioInChromium, AnswersTheLastOfAThousandEvents) { expect_in_browser("thousand"); }

}  // namespace
}  // namespace papilla::tests::browser_slow_test
