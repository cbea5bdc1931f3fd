// Shipped studies as they are without what is not known of the finger: a test of anything else need
// not ask its members.
#pragma once

#include "design/study.h"

namespace papilla::tests {

inline Study without_belief(Study study) {
  study.design.finger.belief.clear();
  for (Finger& finger : study.population) finger.belief.clear();
  return study;
}

}  // namespace papilla::tests
