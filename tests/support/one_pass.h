// The finger that was fitted in one pass: what numbers of that time are compared with.
#pragma once

#include "design/design.h"

namespace papilla::tests {

inline Finger one_pass_finger() { return read_finger(find_design("fingers/one_pass.toml")); }

}  // namespace papilla::tests
