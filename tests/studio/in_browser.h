// A part of browser.py in Chromium.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "base/rooms.h"

namespace papilla::tests {

inline void expect_in_browser(const std::string& part) {
  const auto status = [](const std::string& command) { return std::system(command.c_str()); };
  if (status("command -v chromium chromedriver python3 > /dev/null") != 0)
    GTEST_SKIP() << "needs chromium, chromium-driver and python3 (scripts/setup --test)";
  EXPECT_EQ(
      status("python3 " PAPILLA_SOURCE_DIR "/tests/studio/browser.py " PAPILLA_PROGRAM " " + part),
      0);
}

}  // namespace papilla::tests
