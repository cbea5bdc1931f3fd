// JSON compared as numbers are: to rounding.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/rooms.h"

namespace papilla::tests {

inline void expect_same(const nlohmann::json& a, const nlohmann::json& b, const std::string& path) {
  if (a.is_number() && b.is_number()) {
    const double x = a.get<double>(), y = b.get<double>();
    EXPECT_NEAR(x, y, 1e-12 * std::max(std::abs(x), std::abs(y))) << path;
  } else if (a.is_object() && b.is_object()) {
    for (const auto& [key, value] : b.items()) {
      ASSERT_TRUE(a.contains(key)) << path << "/" << key;
      expect_same(a[key], value, path + "/" + key);
    }
    EXPECT_EQ(a.size(), b.size()) << path << ": " << a.dump();
  } else if (a.is_array() && b.is_array() && a.size() == b.size()) {
    for (std::size_t i = 0; i < a.size(); ++i)
      expect_same(a[i], b[i], path + "/" + std::to_string(i));
  } else {
    EXPECT_EQ(a, b) << path;
  }
}

inline void expect_document(const std::string& text, const nlohmann::json& expected) {
  expect_same(nlohmann::json::parse(text), expected, "");
  // Printed documents step by two blanks, files of a run by one and end their last line.
  const auto own = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(text, text.ends_with('\n') ? own.dump(1) + "\n" : own.dump(2));
}

}  // namespace papilla::tests
