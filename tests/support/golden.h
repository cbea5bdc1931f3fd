#pragma once

#include <gtest/gtest.h>

#include <string>

namespace papilla::tests {

// Whether the text is that of tests/`name`, e.g. "report/golden/drive.svg"; else where they part.
// With PAPILLA_UPDATE_GOLDEN=1 in the environment the file is written instead: look at what git
// shows of it before it is committed.
testing::AssertionResult is_golden(const std::string& text, const std::string& name);

}  // namespace papilla::tests
