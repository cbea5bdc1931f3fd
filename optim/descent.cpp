#include "optim/descent.h"

#include "base/module.h"

namespace papilla::optim {

const Descent& descent() {
  static const auto* const loaded = static_cast<const Descent*>(
      load_module("descent", kDescentInterface, "fit a sum of squares"));
  return *loaded;
}

}  // namespace papilla::optim
