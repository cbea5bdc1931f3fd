#include "report/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/constants.h"
#include "base/text.h"
#include "base/units.h"
#include "numerics/statistics.h"
#include "report/fit_belief.h"
#include "report/json.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kIdentified = 0.5;   // share of the data in what is known of a parameter
constexpr double kInDirection = 0.2;  // weight of a parameter that belongs to a direction
constexpr double kKnown = 1000;       // [%] half an interval beyond which nothing is said of it

std::string shown(const CalibrationParameter& p, double si) {
  const auto unit = find_unit(p.unit);
  const double value = si / (unit ? unit->to_si : 1);
  return fmt::format("{:.4g}{}{}", value, p.unit.empty() ? "" : " ", p.unit);
}

std::string band(const FitRow& row) {
  if (row.low == row.high) return fmt::format("{:.4g}", row.low);
  if (!std::isfinite(row.high)) return fmt::format("above {:.3g}", row.low);
  if (!std::isfinite(row.low)) return fmt::format("below {:.3g}", row.high);
  return fmt::format("{:.3g} to {:.3g}", row.low, row.high);
}

std::string misfit_text(const CalibrationResult& r) {
  return fmt::format(
      "the fitted finger does not explain the data: χ² per degree of freedom is {:.3g}, where 1 is "
      "expected; {}. Check units and the stated standard deviations, or let more parameters move; "
      "do not use this finger",
      misfit(r), worst_miss_text(r.rows));
}

// What stopped it, without its full stop.
std::string stopped_by(const CalibrationResult& r) {
  std::string out = r.fit.message;
  while (out.ends_with('.')) out.pop_back();
  return out;
}

// χ² per degree of freedom by the stated deviations alone: what the model's sampling adds to them
// would make any table's look large. None where a band counts as no miss.
std::optional<double> misfit_as_stated(const CalibrationResult& r) {
  double sum = 0;
  for (const FitRow& row : r.rows) {
    if (row.low != row.high) return std::nullopt;
    sum += square((row.after - row.low) / row.sd);
  }
  return sum / std::max(1, r.fit.degrees_of_freedom);
}

// χ² per degree of freedom that less than one table in two thousand falls below where its
// deviations are right (Wilson and Hilferty 1931); 0 for few rows.
double least_misfit(int degrees_of_freedom) {
  const double variance = 2 / (9.0 * std::max(1, degrees_of_freedom));
  const double root = 1 - variance - normal_quantile(0.9995) * std::sqrt(variance);
  return root > 0 ? root * root * root : 0;
}

bool holds(const ClaimResult& r) {
  return r.papilla.verdict == Verdict::Agrees || r.papilla.verdict == Verdict::Fitted;
}

bool is_fitted(const Calibration& c, const std::string& id) {
  return std::find(c.fit.begin(), c.fit.end(), id) != c.fit.end();
}

std::string direction_text(const Calibration& c, const FitDirection& d) {
  std::string out;
  for (std::size_t i = 0; i < d.weights.size(); ++i) {
    if (std::abs(d.weights[i]) < kInDirection) continue;
    out += fmt::format("{}{:+.2f} {}", out.empty() ? "" : " ", d.weights[i], c.parameters[i].path);
  }
  return out;
}

std::string summary_section(const Calibration& c, const CalibrationResult& r) {
  std::string out = fmt::format("# Fit: {}\n\n", c.title.empty() ? c.finger.name : c.title);
  if (const std::string warning = calibration_warning(r); !warning.empty())
    out += "Warning: " + warning + ".\n\n";
  out += fmt::format(
      "{} residuals, {} parameters; χ² of the data {:.3g} before, {:.3g} after, of the priors "
      "{:.3g}; {} degrees of freedom; errors times {:.3g}; {} of the model; {}.\n",
      r.rows.size(), c.parameters.size(), r.chi2_before, r.fit.chi2, r.fit.prior_chi2,
      r.fit.degrees_of_freedom, std::sqrt(r.fit.variance_factor),
      counted(r.evaluations, "evaluation"),
      r.fit.converged ? "converged" : "stopped: " + stopped_by(r));
  out += fmt::format(
      "Skins {} to {} at level {}{}.\n", c.sampling.first_skin,
      c.sampling.first_skin + c.sampling.skins - 1, c.sampling.level,
      c.data.empty()
          ? ""
          : fmt::format(
                "; frictions times {:.3f} to {:.3f}, which level {} says over it on the same "
                "skins (Eq. calibration.6)",
                r.least_factor, r.largest_factor, c.check.level));
  // So few know badly what rows of a table have in common (Eq. calibration.12), and nothing is
  // known of what claims have.
  const int few_skins = c.fit.empty() ? 6 : 12;
  if (c.sampling.skins < few_skins)
    out += fmt::format(
        "All residuals meet these skins: of fewer than {} the parameters may be off by more than "
        "their intervals say (`[sampling] skins`).\n",
        few_skins);
  if (!c.data_notes.empty())
    out += fmt::format("Of the table of friction: {}.\n", join_names(c.data_notes, "; "));
  return out;
}

// "shear strength known to 10 %": what the data say of each parameter, in words.
std::vector<std::string> verdicts(const Calibration& c, const CalibrationResult& r) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < c.parameters.size(); ++i) {
    const ParameterFit& f = r.fit.parameters[i];
    const std::string& path = c.parameters[i].path;
    if (f.data_share < kIdentified) {
      out.push_back(
          fmt::format("{} is not identified: {:.0f} % of what is known of it is the prior's", path,
                      100 * (1 - f.data_share)));
    } else if (f.low_open && f.high_open) {
      out.push_back(fmt::format(
          "{} is known to neither side: its interval is all of what the bounds leave", path));
    } else if (f.at_bound || f.low_open || f.high_open) {
      out.push_back(
          fmt::format("{} is known to one side only: its interval ends at a bound", path));
    } else {
      const double half = 50 * (f.high - f.low) / std::abs(f.value);  // [%]
      out.push_back(
          half < kKnown
              ? fmt::format("{} is known within ± {} % (95 %)", path, significant(half, 2))
              : fmt::format("{} is not known: its 95 % interval is wider than ± {:g} %", path,
                            kKnown));
    }
  }
  for (const FitDirection& d : r.fit.directions) {
    std::vector<std::string> together;
    for (std::size_t i = 0; i < d.weights.size(); ++i) {
      if (std::abs(d.weights[i]) >= kInDirection) together.push_back(c.parameters[i].path);
    }
    if (d.singular_value < 1 && together.size() > 1)
      out.push_back(join_names(together, " and ") + " are not told apart by these data");
  }
  return out;
}

std::string parameters_section(const Calibration& c, const CalibrationResult& r) {
  std::string out = fmt::format("\nVerdict: {}.\n", join_names(verdicts(c, r), "; "));
  out +=
      "\n## Parameters\n\n| parameter | start | fitted | 95 % interval | prior | from the data, % "
      "|\n"
      "|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < c.parameters.size(); ++i) {
    const CalibrationParameter& p = c.parameters[i];
    const ParameterFit& f = r.fit.parameters[i];
    const std::string prior =
        p.fit.prior_sd == 0 ? "none"
        : p.fit.logarithmic
            ? fmt::format("{} times or by {:.3g}", shown(p, p.fit.prior), std::exp(p.fit.prior_sd))
            : fmt::format("{} ± {}", shown(p, p.fit.prior), shown(p, p.fit.prior_sd));
    out += fmt::format("| {} | {} | {} | {}{} to {}{} | {} | {:.0f}{} |\n", p.path,
                       shown(p, p.fit.start), shown(p, f.value), shown(p, f.low),
                       f.low_open ? " (bound)" : "", shown(p, f.high),
                       f.high_open ? " (bound)" : "", prior, 100 * f.data_share,
                       !f.at_bound                 ? ""
                       : f.low_open && f.high_open ? "; at its bound"
                                                   : "; at its bound, interval by profile");
  }
  return out;
}

std::string correlations_section(const Calibration& c, const CalibrationResult& r) {
  std::string out = "\n## Correlations\n\n|  |";
  for (const CalibrationParameter& p : c.parameters) out += " " + p.path + " |";
  out += "\n|---|";
  for (std::size_t i = 0; i < c.parameters.size(); ++i) out += "---|";
  out += "\n";
  const std::size_t n = c.parameters.size();
  for (std::size_t i = 0; i < n; ++i) {
    out += "| " + c.parameters[i].path + " |";
    for (std::size_t k = 0; k < n; ++k)
      out += fmt::format(" {:.2f} |", r.fit.correlation[i * n + k]);
    out += "\n";
  }
  return out;
}

std::string directions_section(const Calibration& c, const CalibrationResult& r) {
  std::string out =
      "\n## What the data tell apart\n\nSingular directions of the data, in prior widths; below 1 "
      "the prior decides.\n\n| standard deviations per prior width | direction | "
      "|\n|---|---|---|\n";
  for (const FitDirection& d : r.fit.directions) {
    out += fmt::format("| {:.3g} | {} | {} |\n", d.singular_value, direction_text(c, d),
                       d.singular_value < 1 ? "not identified" : "");
  }
  return out;
}

std::string residuals_section(const Calibration& c, const CalibrationResult& r) {
  std::string out =
      "\n## Residuals\n\n| source | quantity | data | sd | sampling of the model | before | after "
      "| miss, sd |\n|---|---|---|---|---|---|---|---|\n";
  for (const FitRow& row : r.rows) {
    out +=
        fmt::format("| {} | {} | {} | {:.3g} | {:.2g} | {:.4g} | {:.4g} | {:+.2f} |\n", row.source,
                    row.what, band(row), row.sd, row.sampling_sd, row.before, row.after, row.miss);
  }
  return out +
         "\nMiss: after less data (beyond its nearer end, of a band), over the root of the squares "
         "of sd and sampling, which counts for more where few skins know what rows have in common "
         "(Eq. calibration.12)." +
         (c.data.empty()
              ? ""
              : " Frictions after are corrected to the finer level at the fitted finger; "
                "the fit had the correction of where it started, and χ² is of that.") +
         "\n";
}

std::string claims_section(const Calibration& c, const JudgedFit& claims, bool fitted) {
  std::string table;
  int before = 0, after = 0, count = 0;
  for (std::size_t i = 0; i < claims.after.size(); ++i) {
    const ClaimResult &a = claims.before[i], &b = claims.after[i];
    if (is_fitted(c, b.claim->id) != fitted) continue;
    ++count;
    before += holds(a);
    after += holds(b);
    table += fmt::format("| {} | {} | {}: {} | {}: {} |\n", b.claim->id, b.claim->statement,
                         holds(a) ? "holds" : "differs", a.papilla.model,
                         holds(b) ? "holds" : "differs", b.papilla.model);
  }
  if (count == 0) return "";
  return fmt::format(
             "\n## {} claims\n\nOn {} other skins at level {}: {} of {} hold before, {} "
             "after.\n\n| id | claim | before | after |\n|---|---|---|---|\n",
             fitted ? "Fitted" : "Held-out", c.check.skins, c.check.level, before, count, after) +
         table;
}

std::string other_measurements_section(const CalibrationResult& r) {
  std::string out = fmt::format(
      "\n## Beside other measurements\n\nGap by capacitance under the ridges at 1 N on 30 mm² "
      "(published 1.06 µm): {:.2f} µm before, {:.2f} µm after (docs/theory/coupling.md).\n",
      1e6 * r.gap_before, 1e6 * r.gap_after);
  if (r.friction_coefficient.size() == 4) {
    out += fmt::format(
        "Friction coefficient on flat glass at 0.2 N: {:.2f}, {:.2f}, {:.2f}, {:.2f} at 15, 35, "
        "55, 75 % RH (published on screens at 1 N: 0.2 and 0.4; by mean field with 8 MPa 0.27 to "
        "0.33).\n",
        r.friction_coefficient[0], r.friction_coefficient[1], r.friction_coefficient[2],
        r.friction_coefficient[3]);
  }
  return out;
}

Json parameters_json(const Calibration& c, const CalibrationResult& r) {
  Json parameters = Json::array();
  for (std::size_t i = 0; i < c.parameters.size(); ++i) {
    const ParameterFit& f = r.fit.parameters[i];
    const FitParameter& given = c.parameters[i].fit;
    const auto unit = find_unit(c.parameters[i].unit);
    Json prior;
    if (given.prior_sd > 0) {
      prior = {{"value", given.prior}};
      prior[given.logarithmic ? "factor" : "sd"] =
          given.logarithmic ? std::exp(given.prior_sd) : given.prior_sd;
    }
    parameters.push_back({{"path", c.parameters[i].path},
                          {"unit", c.parameters[i].unit},
                          {"per_unit", unit ? unit->to_si : 1},
                          {"lowest", given.low},
                          {"highest", given.high},
                          {"prior", prior},
                          {"start", given.start},
                          {"value", f.value},
                          {"se", f.se},
                          {"low", f.low},
                          {"high", f.high},
                          {"low_open", f.low_open},
                          {"high_open", f.high_open},
                          {"at_bound", f.at_bound},
                          {"data_share", f.data_share}});
  }
  return parameters;
}

Json directions_json(const CalibrationResult& r) {
  Json directions = Json::array();
  for (const FitDirection& d : r.fit.directions)
    directions.push_back({{"singular_value", d.singular_value}, {"weights", d.weights}});
  return directions;
}

Json residuals_json(const CalibrationResult& r) {
  Json rows = Json::array();
  for (const FitRow& row : r.rows) {
    rows.push_back({{"source", row.source},
                    {"what", row.what},
                    {"low", json_number(row.low)},
                    {"high", json_number(row.high)},
                    {"sd", row.sd},
                    {"sampling_sd", row.sampling_sd},
                    {"deviation", row.deviation},
                    {"before", row.before},
                    {"after", row.after},
                    {"residual", row.miss}});
  }
  return rows;
}

Json claims_rows_json(const Calibration& c, const JudgedFit& claims) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < claims.after.size(); ++i) {
    const ClaimResult& b = claims.after[i];
    rows.push_back({{"id", b.claim->id},
                    {"statement", b.claim->statement},
                    {"fitted", is_fitted(c, b.claim->id)},
                    {"held_before", holds(claims.before[i])},
                    {"holds", holds(b)},
                    {"before", claims.before[i].papilla.model},
                    {"after", b.papilla.model},
                    {"model", json_number(b.papilla.value)},
                    {"se", json_number(b.papilla.se)}});
  }
  return rows;
}

}  // namespace

std::string calibration_warning(const CalibrationResult& result) {
  std::vector<std::string> out;
  if (!result.fit.converged)
    out.push_back(
        fmt::format("not converged after {} ({}): raise `iterations`; what is written is where it "
                    "stopped",
                    counted(result.iterations, "iteration"), stopped_by(result)));
  if (!explains_data(result)) out.push_back(misfit_text(result));
  if (const auto stated = misfit_as_stated(result);
      stated && *stated < least_misfit(result.fit.degrees_of_freedom))
    out.push_back(
        fmt::format("the stated standard deviations are larger than what is missed: by them alone "
                    "χ² per degree of freedom is {:.2g}, where 1 is expected. Check their unit; "
                    "intervals are too wide with them",
                    *stated));
  return join_names(out, "; ");
}

std::string calibration_markdown(const Calibration& c, const CalibrationResult& r,
                                 const JudgedFit& claims) {
  return summary_section(c, r) + parameters_section(c, r) + correlations_section(c, r) +
         directions_section(c, r) + (r.belief ? belief_section(c, *r.belief) : "") +
         residuals_section(c, r) + claims_section(c, claims, true) +
         claims_section(c, claims, false) + other_measurements_section(r);
}

std::string calibration_json(const Calibration& c, const CalibrationResult& r,
                             const JudgedFit& claims) {
  Json out{{"schema", 1},
           {"title", c.title},
           {"converged", r.fit.converged},
           {"explains_data", explains_data(r)},
           {"warning", calibration_warning(r)},
           {"verdicts", verdicts(c, r)},
           {"chi2_before", r.chi2_before},
           {"chi2", r.fit.chi2},
           {"prior_chi2", r.fit.prior_chi2},
           {"degrees_of_freedom", r.fit.degrees_of_freedom},
           {"variance_factor", r.fit.variance_factor},
           {"evaluations", r.evaluations},
           {"parameters", parameters_json(c, r)},
           {"correlation", r.fit.correlation},
           {"directions", directions_json(r)},
           {"check_skins", c.check.skins},
           {"residuals", residuals_json(r)},
           {"claims", claims_rows_json(c, claims)},
           {"gap_by_capacitance", {{"before", r.gap_before}, {"after", r.gap_after}}},
           {"friction_coefficient", r.friction_coefficient}};
  if (r.belief) out["belief"] = belief_fit_json(*r.belief);
  return out.dump(2);
}

}  // namespace papilla::report
