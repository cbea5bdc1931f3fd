#include "report/accuracy.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "report/json.h"
#include "report/tables.h"

namespace papilla::report {

using Json = nlohmann::ordered_json;

std::string accuracy_text(const std::vector<AccuracyRow>& rows) {
  std::string out = fmt::format("{:<10} {:<26}", "sweep", "setting");
  for (const AccuracyQuantity& q : accuracy_quantities()) out += fmt::format(" {:>15}", q.name);
  out += fmt::format(" {:>9} {:>9} {:>8}\n", "pairs", "work", "proc. s");
  for (const AccuracyRow& row : rows) {
    out += fmt::format("{:<10} {:<26}", row.sweep, row.setting);
    for (double e : row.error) out += fmt::format(" {:>+13.2f} %", 100 * e);
    out += fmt::format(" {:>9.0f} {:>9.1f} {:>8.2f}\n", row.fft_pairs, row.work, row.seconds);
  }
  return out;
}

std::string coverage_text(const std::vector<CoverageRow>& rows) {
  std::string out =
      fmt::format("{:<34} {:<16} {:>6} {:>8} {:>11} {:>13} {:>6} {:>15}\n", "fidelity", "quantity",
                  "scenes", "inside", "half-width", "95 % of error", "ratio", "error/stated");
  for (const CoverageSummary& s : coverage_summary(rows)) {
    out += fmt::format("{:<34} {:<16} {:>6} {:>6.0f} % {:>11.4g} {:>13.4g} {:>6.2f} {:>15.2f}\n",
                       s.fidelity, s.quantity, s.scenes, 100 * s.inside, s.median_half_width,
                       s.error_quantile, s.median_half_width / s.error_quantile, s.rms_ratio);
  }
  return out;
}

std::string accuracy_csv(const std::vector<AccuracyRow>& rows, const std::string& provenance) {
  std::string out = provenance + "sweep,setting,grid,skins,estimator,tolerance";
  for (const AccuracyQuantity& q : accuracy_quantities())
    out += fmt::format(",{0},{0}_stated,{0}_error", q.name);
  out += ",processor_seconds,fft_pairs,work,status\n";
  const auto number = [](double v) {
    return std::isfinite(v) ? fmt::format("{:.5g}", v) : std::string();
  };
  for (const AccuracyRow& r : rows) {
    out += fmt::format("{},{},{},{},{},{:g}", r.sweep, r.setting, r.fidelity.grid, r.fidelity.skins,
                       r.fidelity.estimator == Estimator::Load ? "load" : "area",
                       r.fidelity.contact_tolerance);
    for (std::size_t q = 0; q < accuracy_quantities().size(); ++q) {
      out += fmt::format(",{},{},{}", number(r.value[q]), number(r.stated[q]), number(r.error[q]));
    }
    out += fmt::format(",{:.3g},{:.0f},{:.1f},{}\n", r.seconds, r.fft_pairs, r.work,
                       csv_cell(r.status));
  }
  return out;
}

std::string coverage_csv(const std::vector<CoverageRow>& rows, const std::string& provenance) {
  std::string out = provenance +
                    "scene,texture,fidelity,quantity,value,half_width,reference,reference_error,"
                    "sampling,grid,method,"
                    "solver,inside\n";
  for (const CoverageRow& r : rows) {
    out += fmt::format("{},{},{},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.3g},{:.3g},{:.3g},{:.3g},{}\n",
                       r.scene, r.texture, r.fidelity, r.quantity, r.value, r.half_width,
                       r.reference, r.reference_error, r.parts.sampling, r.parts.grid.value_or(0),
                       r.parts.method.value_or(0), r.parts.solver.value_or(0), r.inside() ? 1 : 0);
  }
  return out;
}

std::vector<CoverageRow> read_coverage(const std::string& path) {
  const CsvTable table = read_csv(path);
  std::vector<CoverageRow> rows;
  for (const auto& row : table.rows) {
    const auto text = [&](const char* name) { return row[table.column(name)]; };
    const auto value = [&](const char* name) { return std::strtod(text(name).c_str(), nullptr); };
    rows.push_back({static_cast<int>(value("scene")),
                    text("texture"),
                    text("fidelity"),
                    text("quantity"),
                    value("value"),
                    value("half_width"),
                    value("reference"),
                    value("reference_error"),
                    {}});
  }
  return rows;
}

std::string accuracy_json(const std::vector<AccuracyRow>& rows) {
  Json list = Json::array();
  for (const AccuracyRow& r : rows) {
    Json quantities = Json::object();
    for (std::size_t q = 0; q < accuracy_quantities().size(); ++q) {
      quantities[accuracy_quantities()[q].name] = {{"value", json_number(r.value[q])},
                                                   {"se", json_number(r.stated[q])},
                                                   {"relative_error", json_number(r.error[q])}};
    }
    list.push_back({{"sweep", r.sweep},
                    {"setting", r.setting},
                    {"quantities", quantities},
                    {"processor_seconds", r.seconds},
                    {"fft_pairs", r.fft_pairs},
                    {"work", r.work},
                    {"status", r.status}});
  }
  return Json{{"schema", 1}, {"sweeps", list}}.dump(2);
}

std::string coverage_json(const std::vector<CoverageRow>& rows) {
  Json list = Json::array();
  for (const CoverageSummary& s : coverage_summary(rows)) {
    list.push_back({{"fidelity", s.fidelity},
                    {"quantity", s.quantity},
                    {"scenes", s.scenes},
                    {"inside", json_number(s.inside)},
                    {"inside_with_reference_error", json_number(s.inside_both)},
                    {"median_half_width", json_number(s.median_half_width)},
                    {"error_quantile", json_number(s.error_quantile)},
                    {"rms_error_over_stated", json_number(s.rms_ratio)}});
  }
  return Json{{"schema", 1}, {"coverage", list}}.dump(2);
}

std::string field_accuracy_csv(const std::vector<FieldAccuracyRow>& rows) {
  std::string out =
      "sample,relative_humidity [%],method,pixels,pull [kPa],error to the finest full field "
      "[%],seconds,status\n";
  for (const FieldAccuracyRow& r : rows) {
    out += fmt::format("{},{:.0f},{},{},{:.4g},{:.2f},{:.2g},{}\n", r.sample,
                       100 * r.relative_humidity, r.method, r.pixels, 1e-3 * r.pull, 100 * r.error,
                       r.seconds, r.status.empty() ? "ok" : r.status);
  }
  return out;
}

}  // namespace papilla::report
