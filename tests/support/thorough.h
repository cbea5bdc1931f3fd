// How many of its drawn cases a test goes through: a sample of them in the usual suite, all in
// `scripts/test --thorough`.
#pragma once

#include <cstdlib>

namespace papilla::tests {

inline bool is_thorough() { return std::getenv("PAPILLA_THOROUGH") != nullptr; }
inline int cases(int sample, int all) { return is_thorough() ? all : sample; }

}  // namespace papilla::tests
