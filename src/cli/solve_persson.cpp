// papilla solve persson: mean field of a rough skin under voltage.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "cases/mean_field.h"
#include "cli/commands.h"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double ratio(const MeanFieldPoint& p) {
  return p.area_off > 0 ? p.on.pull.area / p.area_off : std::numeric_limits<double>::infinity();
}

// "-" where there is none: the ratio to no area, the coefficient without a load.
std::string or_none(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "-";
}

double coefficient(const MeanFieldPoint& p) {
  return p.load > 0 ? p.on.coefficient : std::numeric_limits<double>::infinity();
}

// The gaps stay as they are at the pressure below which the body is finite.
bool held(const MeanFieldPoint& p, const MeanFieldCase& c) {
  return p.on.pull.pressure < c.touch.finite_size_pressure;
}

Json point_json(const MeanFieldPoint& p, const MeanFieldCase& c) {
  return {{"voltage", p.voltage},
          {"load", p.load},
          {"frequency", p.frequency},
          {"equivalent_thickness", number(std::abs(p.thickness))},
          {"collapsed", p.on.pull.status == PullStatus::Collapsed},
          {"pressure", p.on.pull.pressure},
          {"pull", p.on.pull.pull},
          {"area_off", p.area_off},
          {"area_on", p.on.pull.area},
          {"area_ratio", number(ratio(p))},
          {"mean_gap", p.on.pull.mean_gap},
          {"gap_held", held(p, c)},
          {"friction", p.on.friction},
          {"coefficient", number(coefficient(p))},
          {"capacitance", p.capacitance}};
}

std::string table(const std::vector<MeanFieldPoint>& points, const char* name,
                  const MeanFieldCase& c) {
  std::string out =
      fmt::format("\nover {}\n{:>8} {:>8} {:>10} {:>11} {:>11} {:>9} {:>9} {:>10} {:>7}\n", name,
                  "V", "N", "Hz", "pull Pa", "A/A0", "on/off", "gap um", "friction N", "mu");
  for (const MeanFieldPoint& p : points) {
    out += fmt::format(
        "{:>8.4g} {:>8.4g} {:>10.5g} {:>11.5g} {:>11.5g} {:>9} {:>9.4g} {:>10.4g} "
        "{:>7}{}{}\n",
        p.voltage, p.load, p.frequency, p.on.pull.pull, p.on.pull.area, or_none(ratio(p), 5),
        1e6 * p.on.pull.mean_gap, p.on.friction, or_none(coefficient(p), 4),
        held(p, c) ? "  gap held" : "",
        p.on.pull.status == PullStatus::Collapsed ? "  pulled in" : "");
  }
  return out;
}

int solve(const DesignOptions& options) {
  const MeanFieldCase c = read_mean_field(options.file, options.overrides);
  const auto begin = std::chrono::steady_clock::now();
  const MeanFieldResult r = solve_mean_field(c);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (options.json) {
    Json out{{"schema", 1},
             {"title", c.title},
             {"rms", r.rms},
             {"slope", r.slope},
             {"contact_modulus", r.contact_modulus},
             {"point", point_json(r.point, c)}};
    const auto list = [&](const char* name, const std::vector<MeanFieldPoint>& points) {
      Json rows = Json::array();
      for (const MeanFieldPoint& p : points) rows.push_back(point_json(p, c));
      out[name] = rows;
    };
    list("over_voltage", r.voltage);
    list("over_load", r.load);
    list("over_frequency", r.frequency);
    out["seconds"] = seconds;
    std::cout << out.dump(2) << '\n';
  } else {
    const MeanFieldPoint& p = r.point;
    std::cout << fmt::format(
        "{}{}roughness        rms {:.4g} um, slope {:.4g}{}\npressure         {:.5g} kPa, of it "
        "pull "
        "{:.5g} kPa\ncontact area     {:.5g} % of the nominal area; off {:.5g} %, ratio {}\n"
        "mean gap         {:.5g} um{}\nfriction         {:.5g} N (coefficient {})\n"
        "capacitance      {:.5g} pF\n",
        c.title, c.title.empty() ? "" : "\n", 1e6 * r.rms, r.slope,
        c.skin.hardness > 0 ? " after plastic smoothing" : "", 1e-3 * p.on.pull.pressure,
        1e-3 * p.on.pull.pull, 100 * p.on.pull.area, 100 * p.area_off, or_none(ratio(p), 5),
        1e6 * p.on.pull.mean_gap, held(p, c) ? ", held" : "", p.on.friction,
        or_none(coefficient(p), 4), 1e12 * p.capacitance);
    if (p.on.pull.status == PullStatus::Collapsed) {
      std::cout << "pulled in: no equilibrium below 1 GPa\n";
    }
    if (!r.voltage.empty()) std::cout << table(r.voltage, "voltage", c);
    if (!r.load.empty()) std::cout << table(r.load, "load", c);
    if (!r.frequency.empty()) std::cout << table(r.frequency, "frequency", c);
    const auto any = [&](const std::vector<MeanFieldPoint>& points) {
      return std::any_of(points.begin(), points.end(), [&](const auto& q) { return held(q, c); });
    };
    if (held(p, c) || any(r.voltage) || any(r.load) || any(r.frequency)) {
      std::cout << fmt::format(
          "gap held: limited by the finite body; below {:.4g} kPa (touch.finite_size_pressure) the "
          "gaps stay as they are there\n",
          1e-3 * c.touch.finite_size_pressure);
    }
    std::cout << fmt::format("{:.3g} s\n", seconds);
  }
  return r.point.on.pull.status == PullStatus::Collapsed ? kWorkFailed : kSuccess;
}

}  // namespace

void add_solve_persson(Command solve_command, Context& context) {
  Command command = solve_command.add_command(
      "persson", "Mean field of a rough skin under voltage: area, gap, pull, friction");
  auto options = std::make_shared<DesignOptions>();
  command.add_option("file", options->file, "Case, e.g. designs/physics/wrist_on_glass.toml")
      .required()
      .type_name("FILE");
  add_set_option(command, options->overrides);
  command.add_flag("--json", options->json, "One JSON object, SI units");
  command.on_chosen(
      [&context, options] { context.action = [options] { return solve(*options); }; });
}

}  // namespace papilla
