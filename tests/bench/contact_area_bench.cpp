// Error of the contact area against time, loaded and light.
//     contact_area_bench > results/bench/contact_area.csv
#include <fmt/format.h>

#include "base/memory.h"
#include "measure/area_error.h"

int main() {
  papilla::keep_freed_memory();
  std::vector<papilla::AreaErrorRow> rows;
  for (const char* scene : {"loaded", "light"}) {
    for (const auto& row : papilla::area_error_against_time(scene, {.skins = 4})) {
      rows.push_back(row);
    }
  }
  fmt::print("{}", area_error_csv(rows));
}
