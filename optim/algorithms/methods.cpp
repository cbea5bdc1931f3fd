#include <limits>

#include "optim/algorithms/searchers.h"
#include "optim/descent.h"
#include "optim/evolution.h"

namespace papilla::optim {

const std::vector<MethodKind>& method_kinds() {
  constexpr auto kPagmo = [] { evolution(); };
  constexpr auto kCeres = [] { descent(); };
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  static const std::vector<MethodKind> kinds{
      {"bayesian", 1, 2, make_bayesian},
      {"nsga2", 2, kAny, make_nsga2, false, kPagmo},
      {"cmaes", 1, 1, make_cmaes, false, kPagmo},
      {"bobyqa", 1, 1, make_bobyqa},
      {"sbplx", 1, 1, make_sbplx},
      {"direct", 1, 1, make_direct},
      {"least_squares", 1, 1, make_least_squares, true, kCeres},
  };
  return kinds;
}

}  // namespace papilla::optim
