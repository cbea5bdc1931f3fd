#include "report/persson.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/constants.h"
#include "report/json.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// A number of the state under voltage; none (infinite) of a point that is not sound.
double of_state(const MeanFieldPoint& p, double value) { return p.sound() ? value : kInfinity; }

double ratio(const MeanFieldPoint& p) {
  return p.area_off > 0 ? of_state(p, p.on.pull.area / p.area_off) : kInfinity;
}

// "-" where there is none: the ratio to no area, the coefficient without a load, what is of no
// state.
std::string or_none(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "-";
}

double coefficient(const MeanFieldPoint& p) {
  return p.load > 0 ? of_state(p, p.on.coefficient) : kInfinity;
}

// The gaps stay as they are at the pressure below which the body is finite.
bool held(const MeanFieldPoint& p, const MeanFieldCase& c) {
  return p.sound() && p.on.pull.pressure < c.touch.finite_size_pressure;
}

Json point_json(const MeanFieldPoint& p, const MeanFieldCase& c) {
  const auto state = [&](double value) { return json_number(of_state(p, value)); };
  Json out{{"voltage", p.voltage},
           {"load", p.load},
           {"frequency", p.frequency},
           {"equivalent_thickness", json_number(std::abs(p.thickness))},
           {"collapsed", p.on.pull.status == PullStatus::Collapsed},
           {"dielectric_margin", json_number(p.dielectric_margin)},
           {"breaks_down", p.breaks_down()},
           {"pressure", state(p.on.pull.pressure)},
           {"pull", state(p.on.pull.pull)},
           {"area_off", p.area_off},
           {"area_on", state(p.on.pull.area)},
           {"area_ratio", json_number(ratio(p))},
           {"mean_gap", state(p.on.pull.mean_gap)},
           {"gap_held", held(p, c)},
           {"friction", state(p.on.friction)},
           {"coefficient", json_number(coefficient(p))},
           {"capacitance", state(p.capacitance)}};
  if (c.skin.hardness > 0) out["yielded"] = p.yielded;
  return out;
}

// Why a point has no numbers under its voltage.
const char* trouble(const MeanFieldPoint& p) {
  return p.breaks_down() ? "breaks down" : "pulled in";
}

std::string table(const std::vector<MeanFieldPoint>& points, const char* name,
                  const MeanFieldCase& c) {
  std::string out =
      fmt::format("\nover {}\n{:>8} {:>8} {:>10} {:>11} {:>11} {:>9} {:>9} {:>10} {:>7}\n", name,
                  "V", "N", "Hz", "pull Pa", "A/A0", "on/off", "gap um", "friction N", "mu");
  for (const MeanFieldPoint& p : points) {
    const auto state = [&](double value, int digits) {
      return or_none(of_state(p, value), digits);
    };
    out += fmt::format(
        "{:>8.4g} {:>8.4g} {:>10.5g} {:>11} {:>11} {:>9} {:>9} {:>10} {:>7}{}{}{}\n", p.voltage,
        p.load, p.frequency, state(p.on.pull.pull, 5), state(p.on.pull.area, 5),
        or_none(ratio(p), 5), state(1e6 * p.on.pull.mean_gap, 4), state(p.on.friction, 4),
        or_none(coefficient(p), 4), held(p, c) ? "  gap held" : "",
        p.sound() ? "" : fmt::format("  {}", trouble(p)), p.yielded ? "  yields everywhere" : "");
  }
  return out;
}

Json points_json(const std::vector<MeanFieldPoint>& points, const MeanFieldCase& c) {
  Json out = Json::array();
  for (const MeanFieldPoint& p : points) out.push_back(point_json(p, c));
  return out;
}

// At the case's own point or in its sweeps.
bool anywhere(const MeanFieldResult& r, const std::function<bool(const MeanFieldPoint&)>& is) {
  for (const auto* points : {&r.voltage, &r.load, &r.frequency}) {
    if (std::any_of(points->begin(), points->end(), is)) return true;
  }
  return is(r.point);
}

// The case's own point in words.
std::string point_text(const MeanFieldPoint& p, const MeanFieldCase& c) {
  if (!p.sound())
    return fmt::format(
        "contact area     off {:.5g} % of the nominal area; under {:.4g} V no number: {}\n",
        100 * p.area_off, p.voltage, trouble(p));
  return fmt::format(
      "pressure         {:.5g} kPa, of it pull {:.5g} kPa\n"
      "contact area     {:.5g} % of the nominal area; off {:.5g} %, ratio {}\n"
      "mean gap         {:.5g} um{}\nfriction         {:.5g} N (coefficient {})\n"
      "capacitance      {:.5g} pF\n",
      1e-3 * p.on.pull.pressure, 1e-3 * p.on.pull.pull, 100 * p.on.pull.area, 100 * p.area_off,
      or_none(ratio(p), 5), 1e6 * p.on.pull.mean_gap, held(p, c) ? ", held" : "", p.on.friction,
      or_none(coefficient(p), 4), 1e12 * p.capacitance);
}

}  // namespace

std::string mean_field_text(const MeanFieldCase& c, const MeanFieldResult& r, double seconds) {
  const MeanFieldPoint& p = r.point;
  std::string out =
      fmt::format("{}{}roughness        rms {:.4g} um, slope {:.4g}{}\n{}", c.title,
                  c.title.empty() ? "" : "\n", 1e6 * r.rms, r.slope,
                  c.skin.hardness > 0 ? " after plastic smoothing" : "", point_text(p, c));
  if (p.yielded) {
    out += fmt::format(
        "yields everywhere: the pressure is beyond the hardness, {:.5g} kPa, the numbers under "
        "voltage mean nothing physical\n",
        1e-3 * c.skin.hardness);
  }
  if (!r.voltage.empty()) out += table(r.voltage, "voltage", c);
  if (!r.load.empty()) out += table(r.load, "load", c);
  if (!r.frequency.empty()) out += table(r.frequency, "frequency", c);
  if (anywhere(r, [](const auto& at) { return !at.sound() && !at.breaks_down(); }))
    out += "pulled in: no equilibrium below 1 GPa, so no number under the voltage\n";
  if (anywhere(r, [](const auto& at) { return at.breaks_down(); }))
    out +=
        "breaks down: where the skin touches it, the dielectric has more than its strength "
        "(interface.dielectric), so no number under the voltage\n";
  if (anywhere(r, [&](const auto& at) { return held(at, c); })) {
    out += fmt::format(
        "gap held: limited by the finite body; below {:.4g} kPa (touch.finite_size_pressure) the "
        "gaps stay as they are there\n",
        1e-3 * c.touch.finite_size_pressure);
  }
  return out + fmt::format("{:.3g} s\n", seconds);
}

std::string mean_field_json(const MeanFieldCase& c, const MeanFieldResult& r, double seconds) {
  return Json{{"schema", 1},
              {"title", c.title},
              {"rms", r.rms},
              {"slope", r.slope},
              {"contact_modulus", r.contact_modulus},
              {"point", point_json(r.point, c)},
              {"over_voltage", points_json(r.voltage, c)},
              {"over_load", points_json(r.load, c)},
              {"over_frequency", points_json(r.frequency, c)},
              {"seconds", seconds}}
      .dump(2);
}

std::string mean_field_grid_csv(const std::vector<MeanFieldPoint>& grid) {
  std::string out = "voltage,load,pull,area,area_off,mean_gap,friction,coefficient\n";
  for (const MeanFieldPoint& p : grid) {
    const PullState& pull = p.on.pull;
    const auto cell = [&](double value) {  // empty where there is no number
      return std::isfinite(of_state(p, value)) ? fmt::format("{:.6g}", value) : std::string();
    };
    out += fmt::format("{:g},{:g},{},{},{:.6g},{},{},{}\n", p.voltage, p.load, cell(pull.pull),
                       cell(pull.area), p.area_off, cell(pull.mean_gap), cell(p.on.friction),
                       cell(coefficient(p)));
  }
  return out;
}

std::string roughness_csv(const MeanFieldCurves& curves) {
  std::string out =
      "wave_number,magnification,density,density_smoothed,area,area_elastic,area_yielded\n";
  for (const auto& p : curves.roughness)
    out += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", p.wave_number,
                       p.wave_number / curves.roughness.front().wave_number, p.given, p.smoothed,
                       p.area, p.elastic, p.yielded);
  return out;
}

std::string stress_csv(const MeanFieldCurves& curves) {
  std::string out = "gap,stress,density,pull_per_decade\n";
  for (const StressPoint& p : curves.stress)
    out += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}\n", p.gap, p.stress, p.density, p.per_decade);
  return out;
}

std::string separation_csv(const MeanFieldCurves& curves) {
  std::string out = "pressure,mean_gap,mean_gap_held\n";
  for (const auto& p : curves.separation)
    out += fmt::format("{:.6g},{:.6g},{:.6g}\n", p.pressure, p.gap, p.held_gap);
  return out;
}

std::string step_csv(const MeanFieldCurves& curves) {
  std::string out = "time,field_in_mean_gap,pull\n";
  for (const auto& p : curves.step)
    out += fmt::format("{:.6g},{:.6g},{:.6g}\n", p.time, p.field, p.pull);
  return out;
}

}  // namespace papilla::report
