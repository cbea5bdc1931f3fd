#include <limits>

#include "optim/algorithms/searchers.h"

namespace papilla {

const std::vector<MethodKind>& method_kinds() {
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  static const std::vector<MethodKind> kinds{
      {"bayesian", 1, 2, make_bayesian},
      {"nsga2", 2, kAny, make_nsga2},
      {"cmaes", 1, 1, make_cmaes},
      {"bobyqa", 1, 1, make_bobyqa},
      {"sbplx", 1, 1, make_sbplx},
      {"direct", 1, 1, make_direct},
      {"least_squares", 1, 1, make_least_squares, true},
  };
  return kinds;
}

}  // namespace papilla
