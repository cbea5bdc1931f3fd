// Error of the contact area against time, loaded and light.
//     contact_area_bench > results/bench/contact_area.csv
#include <fmt/format.h>

#include "base/memory.h"
#include "study/area_error.h"

int main() {
  papilla::keep_freed_memory();
  const auto loaded = papilla::area_error_against_time("loaded", {});
  auto rows = papilla::area_error_against_time("light", {.skins = 6});
  rows.insert(rows.begin(), loaded.begin(), loaded.end());
  fmt::print("{}", area_error_csv(rows));
}
