// Where a result steps: every number of a design of each kind swept by 30 % either way, and lines
// between designs drawn at random, on common skins. An interval that its neighbours do not announce
// is halved ten times; what is left of it then is a step, beside what a move by a thousandth does.
// Lines at random are walked with threshold water and one period, with the period too (the patch
// holds whole numbers of them), and with droplets, which settle elsewhere. Prints a table:
// ninja -C build/release steps_bench
// build/release/bench/steps_bench designs 64 8 100 > results/accuracy/steps.csv
#include <cstdlib>

#include "tests/hard_cases/steps.h"

using namespace papilla::tests;

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "designs";
  Fidelity fidelity = fidelity_level("search");
  fidelity.grid = argc > 2 ? std::atoi(argv[2]) : 64;
  fidelity.skins = argc > 3 ? std::atoi(argv[3]) : 2;
  fidelity.control_skins = 0;
  fidelity.threads = 1;
  std::vector<Line> lines = every_number(folder);
  for (const Walk& walk : kWalks) {
    for (Line& line : random_lines(folder, argc > 4 ? std::atoi(argv[4]) : 200, walk))
      lines.push_back(std::move(line));
  }
  fmt::print(
      "design,key,quantity,place,value,unannounced_percent,step_percent,moved_percent,verdict\n");
  std::vector<std::string> rows(lines.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const Judged& j : judge_steps(lines[i], fidelity)) {
      rows[i] +=
          fmt::format("{},{},{},{:.6g},{:.4g},{:.2f},{:.2f},{:.2f},{}\n", lines[i].design,
                      lines[i].key, kQuantities[j.quantity], j.place, j.value, 100 * j.unannounced,
                      100 * j.step, 100 * j.moved, j.is_step ? "step" : "");
    }
  }
  for (const std::string& row : rows) fmt::print("{}", row);
}
