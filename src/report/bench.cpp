#include "report/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "numerics/statistics.h"
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

std::string prices_text(const std::vector<PriceRow>& rows) {
  std::vector<double> ratios, sound;
  const PriceRow* slowest = nullptr;
  for (const PriceRow& row : rows) {
    ratios.push_back(row.ratio());
    if (row.sound) sound.push_back(row.ratio());
    if (!slowest || row.taken > slowest->taken) slowest = &row;
  }
  if (!slowest) return "no designs\n";
  std::string out =
      fmt::format("taken over announced, {} legal designs at draft, processor time of one core:\n",
                  rows.size());
  const auto list = [&](const char* which, const std::vector<double>& of) {
    if (of.empty()) return;
    const auto within =
        std::count_if(of.begin(), of.end(), [](double r) { return r >= 0.5 && r <= 2; });
    out += fmt::format("{} ({}): ", which, of.size());
    for (const double p : {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0})
      out += fmt::format("{:.0f} % {:.2f}, ", 100 * p, quantile(of, p));
    out += fmt::format("{:.0f} % within a factor 2\n",
                       100 * static_cast<double>(within) / static_cast<double>(of.size()));
  };
  list("all", ratios);
  list("of those whose answer is sound", sound);
  return out + fmt::format("longest: design {} ({}), {:.3g} s, announced {:.3g} s: {}\n",
                           slowest->design, slowest->texture, slowest->taken, slowest->announced,
                           slowest->numbers);
}

std::string prices_csv(const std::vector<PriceRow>& rows, const std::string& provenance) {
  std::string out = "# " + provenance + "\ndesign,texture,announced [s],taken [s],status,numbers\n";
  for (const PriceRow& row : rows)
    out += fmt::format("{},{},{:.3g},{:.3g},{},{}\n", row.design, row.texture, row.announced,
                       row.taken, csv_cell(row.status), csv_cell(row.numbers));
  return out;
}

}  // namespace papilla::report
