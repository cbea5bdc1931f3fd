#include "report/contact_statistics.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/units.h"
#include "report/json.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

Json number_json(const StatisticsNumber& n) {
  return {{"value", n.value},
          {"error", json_number(n.error())},
          {"seeds", json_number(n.seeds)},
          {"grid", json_number(n.grid)}};
}

Json list_json(const std::vector<StatisticsNumber>& numbers) {
  Json out = Json::array();
  for (const StatisticsNumber& n : numbers) out.push_back(number_json(n));
  return out;
}

std::string cell(const StatisticsNumber& n, double scale) {
  const std::optional<double> error = n.error();
  return fmt::format("{:>11.5g} ± {:<8}", scale * n.value,
                     error ? fmt::format("{:.2g}", scale * *error) : "unknown");
}

// What stands behind ± in a table.
std::string meaning_of(const StatisticsNumber& n) {
  if (n.seeds && n.grid) return "one standard error over the surfaces and what the grid changes";
  if (n.seeds)
    return "one standard error over the surfaces; what the grid changes was not measured "
           "(sampling.controls)";
  if (n.grid) return "what the grid changes; how surfaces differ was not measured (sampling.seeds)";
  return "neither how surfaces differ nor what the grid changes was measured (sampling.seeds, "
         "sampling.controls)";
}

std::string distribution_csv(const StatisticsResult& result, const char* name,
                             Distribution StatisticsPoint::*member) {
  std::string out = fmt::format("pressure_Pa,{},density,density_se\n", name);
  for (const StatisticsPoint& p : result.points) {
    const Distribution& d = p.*member;
    for (std::size_t b = 0; b < d.density.size(); ++b)
      out += fmt::format("{:.10g},{:.10g},{:.8g},{}\n", p.pressure,
                         d.width * (static_cast<double>(b) + 0.5), d.density[b].value,
                         p.area.seeds ? fmt::format("{:.4g}", d.density[b].se) : "");
  }
  return out;
}

}  // namespace

std::string statistics_text(const StatisticsCase& c, const StatisticsResult& result,
                            double seconds) {
  const SamplingSettings& s = c.sampling;
  std::string out = fmt::format(
      "{}{} surfaces of {:.5g} um on {} x {} pixels, {} of them also on half of these; {:.3g} s\n"
      "rms {:.5g} um, slope {:.4g}; E* {}; ±: {}\n\n{:>12} {:>22} {:>12} {:>22}",
      c.title.empty() ? "" : c.title + "\n", s.seeds, 1e6 * c.side(), s.grid, s.grid, s.controls,
      seconds, 1e6 * result.rms.value, result.slope.value, format_quantity(c.press.modulus, "MPa"),
      meaning_of(result.rms), "p/E*", "contact area %", "pixels %", "mean gap nm");
  for (const double h0 : c.thickness)
    out += fmt::format(" {:>22}", fmt::format("<(g+{:.4g} nm)^-2>^-1/2 nm", 1e9 * h0));
  out += '\n';
  for (const StatisticsPoint& p : result.points) {
    out += fmt::format("{:>12.5g} {} {:>12.5g} {}", p.pressure / c.press.modulus, cell(p.area, 100),
                       100 * p.pixels.value, cell(p.mean_gap, 1e9));
    for (const StatisticsNumber& n : p.inverse_square) {
      const double gap = 1 / std::sqrt(n.value), part = 0.5 * gap / n.value;
      const auto of_gap = [part](std::optional<double> error) {
        if (error) *error *= part;
        return error;
      };
      out += " " + cell({gap, of_gap(n.seeds), of_gap(n.grid)}, 1e9);
    }
    out += '\n';
  }
  if (!result.converged)
    out += fmt::format("not converged: certificate {:.2g}\n", result.largest_certificate);
  return out;
}

std::string statistics_json(const StatisticsCase& c, const StatisticsResult& result,
                            double seconds) {
  Json points = Json::array();
  for (const StatisticsPoint& p : result.points) {
    points.push_back({{"pressure", p.pressure},
                      {"area_fraction", number_json(p.area)},
                      {"pixel_fraction", number_json(p.pixels)},
                      {"mean_gap", number_json(p.mean_gap)},
                      {"mean_inverse", list_json(p.inverse)},
                      {"mean_inverse_square", list_json(p.inverse_square)}});
  }
  return Json{{"schema", 1},
              {"title", c.title},
              {"modulus", c.press.modulus},
              {"rms", number_json(result.rms)},
              {"slope", number_json(result.slope)},
              {"thickness", c.thickness},
              {"points", points},
              {"converged", result.converged},
              {"largest_certificate", result.largest_certificate},
              {"seconds", seconds}}
      .dump(2);
}

std::string gap_distribution_csv(const StatisticsResult& result) {
  return distribution_csv(result, "gap_m", &StatisticsPoint::gap);
}

std::string stress_distribution_csv(const StatisticsResult& result) {
  return distribution_csv(result, "stress_Pa", &StatisticsPoint::stress);
}

}  // namespace papilla::report
