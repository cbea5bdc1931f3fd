// The yield from the ends of the tolerances against plates evaluated one by one, of five designs;
// CSV on standard output.
//   yield_bench [PLATES [CASE]]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>

#include "tests/search/direct_plates.h"

using namespace papilla::tests;

int main(int argc, char** argv) {
  const int plates = argc > 1 ? std::atoi(argv[1]) : 2000, few = plates / 5;
  fmt::print(
      "design,yield,se,direct,difference,costliest,gain of half,costliest direct,gain of half "
      "direct,seconds,seconds direct\n");
  for (const YieldCase& of : yield_cases()) {
    if (argc > 2 && of.name != argv[2]) continue;
    const auto clock = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    const JudgedYield judged(of);
    const double begun = clock();
    const Yield yield = judged.by_the_ends();
    const double found = clock();
    const double direct = judged.direct(plates), done = clock();
    const double own = judged.direct(few);
    std::vector<double> gains;
    for (std::size_t k = 0; k < yield.halved.size(); ++k)
      gains.push_back(judged.direct(few, k, 0.5) - own);
    const auto most = std::max_element(gains.begin(), gains.end()) - gains.begin();
    const auto said = yield.costliest();
    fmt::print("{},{:.4f},{:.4f},{:.4f},{:+.4f},{},{:.3f},{},{:.3f},{:.1f},{:.1f}\n", of.name,
               yield.now.share, yield.now.error, direct, yield.now.share - direct,
               said ? judged.study().scatter[*said].path : "none",
               said ? yield.halved[*said].share : 0.0,
               judged.study().scatter[static_cast<std::size_t>(most)].path,
               gains[static_cast<std::size_t>(most)], found - begun, done - found);
    std::fflush(stdout);
  }
  return 0;
}
