#include "report/bench.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/tables.h"

namespace papilla::report {

using Json = nlohmann::ordered_json;

std::string bench_text(const std::vector<BenchRow>& rows) {
  std::string out;
  for (const BenchRow& r : rows) {
    out += fmt::format("{:<58} {:>9.3g} {:<14} {} {:<6g} {}\n", r.what, r.measured, r.unit,
                       r.at_most ? "<=" : ">=", r.target, r.met() ? "met" : "not met");
  }
  return out;
}

std::string bench_csv(const std::vector<BenchRow>& rows, const std::string& provenance) {
  std::string out = "# " + provenance + "\nwhat,unit,measured,bound,target,exact,met\n";
  for (const BenchRow& r : rows) {
    out +=
        fmt::format("{},{},{:.4g},{},{:g},{},{}\n", csv_cell(r.what), r.unit, r.measured,
                    r.at_most ? "at most" : "at least", r.target, r.exact ? 1 : 0, r.met() ? 1 : 0);
  }
  return out;
}

std::string bench_page(const std::vector<BenchRow>& rows, const std::string& provenance) {
  std::string out = fmt::format(
      "# Performance\n\nMade by `papilla bench --page` ({}). Counts are the same on every machine; "
      "times "
      "are upper bounds where the machine has other work.\n\n{}",
      provenance, markdown_head({"what", "measured", "target", "met"}));
  for (const BenchRow& r : rows) {
    const std::string unit = r.unit.empty() ? "" : " " + r.unit;
    out += fmt::format("| {} | {:.3g}{} | {} {:g}{} | {} |\n", r.what, r.measured, unit,
                       r.at_most ? "≤" : "≥", r.target, unit, r.met() ? "yes" : "no");
  }
  return out;
}

std::string bench_json(const std::vector<BenchRow>& rows) {
  Json list = Json::array();
  for (const BenchRow& r : rows) {
    list.push_back({{"what", r.what},
                    {"unit", r.unit},
                    {"measured", r.measured},
                    {"bound", r.at_most ? "at most" : "at least"},
                    {"target", r.target},
                    {"exact", r.exact},
                    {"met", r.met()}});
  }
  return Json{{"schema", 1}, {"rows", list}}.dump(2);
}

}  // namespace papilla::report
