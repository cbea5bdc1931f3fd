#include "report/response.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "metrics/metrics.h"
#include "report/svg.h"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// Error by origin; null where it was not measured.
Json with_parts(double value, double se, const ErrorParts& parts) {
  Json list{{"sampling", number(parts.sampling)}};
  for (const ErrorOrigin& origin : kErrorOrigins) {
    const auto& part = parts.*origin.part;
    list[origin.name] = part ? number(*part) : Json(nullptr);
  }
  return {{"value", number(value)}, {"se", number(se)}, {"parts", list}};
}

Json measured(const Measured& m) { return with_parts(m.value, m.se(), m.parts); }

Json summarised(Summary kind, const char* metric, const Response& response) {
  const auto value = summarise(kind, metric, response);
  return value ? with_parts(value->value, value->se, value->parts) : Json(nullptr);
}

Json summary_json(const Response& response) {
  Json out = Json::object();
  const std::array<std::pair<const char*, Summary>, 5> kinds{{{"mean_modulation", Summary::Mean},
                                                              {"variation", Summary::Variation},
                                                              {"range", Summary::Range},
                                                              {"worst", Summary::Worst},
                                                              {"std", Summary::Std}}};
  for (const auto& [name, kind] : kinds) {
    out[name] = summarised(kind, "modulation", response);
  }
  for (const char* metric : {"friction", "adhesion", "compliance"}) {
    out[std::string("mean_") + metric] = summarised(Summary::Mean, metric, response);
  }
  return out;
}

Json plan_json(const Plan& plan) {
  Json steps = Json::array(), skipped = Json::array();
  for (const PlanStep& s : plan.steps) {
    steps.push_back({{"piece", s.name()},
                     {"method", s.method},
                     {"reason", s.reason},
                     {"seconds", s.seconds},
                     {"error", s.error}});
  }
  for (const PlanSkip& s : plan.skipped) {
    skipped.push_back({{"piece", s.name()},
                       {"reason", s.reason},
                       {"bound", number(s.bound)},
                       {"estimate", s.estimate}});
  }
  return {
      {"grid",
       {{"nx", plan.grid.nx}, {"ny", plan.grid.ny}, {"lx", plan.grid.lx}, {"ly", plan.grid.ly}}},
      {"effective_cutoff", plan.effective_cutoff},
      {"warning", plan.warning},
      {"seconds", plan.seconds()},
      {"steps", steps},
      {"skipped", skipped}};
}

// "sampling 3.1 %, grid 0.8 %, ...": of the value; then what ± leaves out, and what was not
// measured.
std::string budget_text(const SummaryValue& v) {
  const double size = std::abs(v.value);
  if (size == 0) return {};
  std::string out = fmt::format("sampling {:.1f} %", 100 * v.parts.sampling / size), apart, unknown;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (const auto& part = v.parts.*origin.part) {
      const std::string text = fmt::format("{} {:.2g} %", origin.name, 100 * *part / size);
      if (origin.in_total) {
        out += ", " + text;
      } else {
        apart = "; not in ±: " + text + ", common to all designs";
      }
    } else if (origin.part != &ErrorParts::parameters) {
      unknown += (unknown.empty() ? "" : ", ") + std::string(origin.name);
    }
  }
  out += apart;
  if (!v.parts.parameters) out += "; parameters not asked for (--parameters)";
  return out + (unknown.empty() ? "" : "; not measured: " + unknown);
}

bool beyond_contact(const Response& response) {
  return std::any_of(response.points.begin(), response.points.end(), [](const ResponsePoint& p) {
    return p.area_fraction_off.value > 1 || p.area_fraction_on.value > 1;
  });
}

// "sampling, solver; grid, method not in it": what ± of a voltage holds.
std::string voltage_parts(const ErrorParts& parts) {
  std::string in = "sampling", out;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (origin.part == &ErrorParts::humidity) continue;  // of one humidity
    std::string& list = origin.in_total && parts.*origin.part ? in : out;
    list += (list.empty() ? "" : ", ") + std::string(origin.name);
  }
  return in + (out.empty() ? "" : "; not in ±: " + out);
}

// Parts of the mean's ± that a target leaves out: humidities and finger are the user's.
std::string beside_target(const Response& response) {
  const auto v = summarise(Summary::Mean, response.driven ? "modulation" : "friction", response);
  if (!v || v->value == 0) return {};
  std::string out;
  for (const auto& [name, part] :
       {std::pair{"humidity", v->parts.humidity}, std::pair{"parameters", v->parts.parameters}}) {
    if (part && *part > 0) {
      out += fmt::format("{}{} {:.2g} %", out.empty() ? "" : ", ", name,
                         100 * *part / std::abs(v->value));
    }
  }
  return out;
}

std::string with_error(const Measured& m, double scale, int digits) {
  return fmt::format("{:.{}f} ±{:.{}f}", m.value * scale, digits, m.se() * scale, digits);
}

}  // namespace

std::string response_json(const Response& response, bool with_time) {
  Json points = Json::array();
  for (const ResponsePoint& p : response.points) {
    Json point;
    point["relative_humidity"] = p.relative_humidity;
    point["weight"] = p.weight;
    point["patch_pressure"] = number(p.patch_pressure);
    point["F_off"] = measured(p.friction_off);
    point["F_on"] = response.driven ? measured(p.friction_on) : Json(nullptr);
    point["modulation"] = response.driven ? measured(p.modulation) : Json(nullptr);
    point["area_fraction_off"] = measured(p.area_fraction_off);
    point["area_fraction_on"] = response.driven ? measured(p.area_fraction_on) : Json(nullptr);
    point["capillary_force"] = measured(p.capillary_force);
    point["electrostatic_force"] = measured(p.electrostatic_force);
    point["retention_force"] = measured(p.retention_force);
    point["bridges"] = measured(p.bridges);
    point["wetted_fraction"] = measured(p.wetted_fraction);
    point["mean_gap"] = measured(p.mean_gap);
    point["indentation"] = measured(p.indentation);
    point["bridge_water_share"] = number(p.bridge_water_share);
    point["over_limit_area"] = number(p.over_limit_area);
    point["over_limit_share"] = number(p.over_limit_share);
    point["peak_air_field"] = number(p.peak_air_field);
    point["peak_oxide_field"] = number(p.peak_oxide_field);
    point["field_error"] = number(p.field_error);
    point["oxide_margin"] = number(p.oxide_margin);
    for (const VoltageAnswer& v : p.voltages) {
      point["voltage_for"].push_back(
          {{"modulation", v.target},
           {"amplitude", v.reached() ? measured(v.amplitude) : Json(nullptr)},
           {"highest_modulation", number(v.modulation)},
           {"limit", number(v.limit)},
           {"evaluations", v.evaluations},
           {"status", v.reached() ? "ok" : text(v)}});
    }
    point["status"] = p.status.sound() && response.driven && p.oxide_margin < 1
                          ? "breakdown: the dielectric does not hold this field, the numbers under "
                            "voltage mean nothing physical"
                          : text(p.status);
    points.push_back(std::move(point));
  }
  Json out{{"schema", 1},
           {"points", points},
           {"summary", summary_json(response)},
           {"plan", plan_json(response.plan)}};
  if (const auto& look = response.appearance) {
    const bool refused = look->refused();
    const auto value = [&](double v) { return refused ? Json(nullptr) : number(v); };
    out["appearance"] = {
        {"regime", text(look->regime)}, {"warning", look->warning},
        {"haze", value(look->haze)},    {"transmittance", value(look->transmittance)},
        {"gloss", value(look->gloss)},  {"colour_shift", value(look->colour_shift)}};
  }
  if (const ParameterSteps& p = response.parameters; !p.steps.empty()) {
    out["parameters"] = {{"directions", p.steps.size()},
                         {"skins", p.skins},
                         {"grid", p.grid},
                         {"status", p.troubles.empty() ? "ok" : text(p.troubles)}};
  }
  if (with_time) {
    out["seconds"] = response.seconds;
    const PieceSeconds& pieces = response.piece_seconds;
    out["processor_seconds"] = {
        {"contact", pieces.contact}, {"water", pieces.water}, {"field", pieces.field}};
  }
  if (const TargetReport& a = response.accuracy; a.target > 0) {
    out["accuracy"] = {
        {"target", a.target},     {"reached", number(a.reached)},
        {"quantity", a.quantity}, {"parts", {"sampling", "grid", "method", "solver"}},
        {"status", text(a)},      {"steps", a.steps}};
  }
  out["fidelity"] = {
      {"level", response.fidelity.level},
      {"grid", response.fidelity.grid},
      {"window", kWindow},
      {"skins", response.fidelity.skins},
      {"estimator", response.fidelity.estimator == Estimator::Load ? "load" : "area"},
      {"contact_tolerance", response.fidelity.contact_tolerance}};
  out["contact_solves"] = response.contact_solves;
  out["fft_pairs"] = number(response.fft_pairs);
  return out.dump(2);
}

std::string plan_document(const Plan& plan) {
  return Json{{"schema", 1}, {"plan", plan_json(plan)}}.dump(2);
}

std::string response_svg(const Response& response, const std::string& title) {
  const auto curve = [&](const char* name, const char* colour, double scale, auto member) {
    SvgSeries s{.name = name, .colour = colour, .x = {}, .y = {}, .ex = {}, .ey = {}};
    s.line = s.band = true;
    for (const ResponsePoint& p : response.points) {
      s.x.push_back(100 * p.relative_humidity);
      s.y.push_back(scale * (p.*member).value);
      s.ey.push_back(2 * scale * (p.*member).se());
    }
    return s;
  };
  SvgPlot force{.title = title,
                .x = "relative humidity [%]",
                .y = "friction [mN]",
                .series = {curve("drive off", "#1f6f9f", 1e3, &ResponsePoint::friction_off)},
                .from_zero = true};
  if (!response.driven) return svg_picture({force});
  force.series.push_back(curve("drive on", "#c2571a", 1e3, &ResponsePoint::friction_on));
  return svg_picture({force,
                      {.title = "",
                       .x = "relative humidity [%]",
                       .y = "modulation (F_on - F_off)/F_off",
                       .series = {curve("", "#3a7d44", 1, &ResponsePoint::modulation)},
                       .from_zero = true}});
}

std::string modulation_sparkline(const Response& response) {
  if (!response.driven || response.points.empty()) return {};
  static constexpr std::array<const char*, 8> kBars{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  double high = 0;
  for (const ResponsePoint& p : response.points) high = std::max(high, p.modulation.value);
  std::string out;
  for (const ResponsePoint& p : response.points) {
    const double share = high > 0 ? std::clamp(p.modulation.value / high, 0.0, 1.0) : 0;
    out += kBars[static_cast<std::size_t>(std::lround(7 * share))];
  }
  return out;
}

std::string response_table(const Response& response) {
  std::string out =
      fmt::format("{:>6} {:>9} {:>16} {:>16} {:>15} {:>14} {:>14} {:>14} {:>9} {:>9}\n", "RH",
                  "patch kPa", "F_off mN", "F_on mN", "modulation", "contact off %", "capillary mN",
                  "electro mN", "bridges", "gap nm");
  for (const ResponsePoint& p : response.points) {
    out += fmt::format(
        "{:>5.0f}% {:>9.0f} {:>16} {:>16} {:>15} {:>14} {:>14} {:>14} {:>9.1f} {:>9.0f}\n",
        100 * p.relative_humidity, 1e-3 * p.patch_pressure, with_error(p.friction_off, 1e3, 1),
        response.driven ? with_error(p.friction_on, 1e3, 1) : "-",
        response.driven ? with_error(p.modulation, 1, 3) : "-",
        with_error(p.area_fraction_off, 100, 3), with_error(p.capillary_force, 1e3, 1),
        response.driven ? with_error(p.electrostatic_force, 1e3, 1) : "-", p.bridges.value,
        1e9 * p.mean_gap.value);
  }
  if (response.driven) {
    const auto mean = summarise(Summary::Mean, "modulation", response);
    std::optional<SummaryValue> variation, range;
    if (response.points.size() > 1) {  // one humidity does not vary
      variation = summarise(Summary::Variation, "modulation", response);
      range = summarise(Summary::Range, "modulation", response);
    }
    const auto worst = summarise(Summary::Worst, "modulation", response);
    out += fmt::format("modulation {}", modulation_sparkline(response));
    if (mean) out += fmt::format("  mean {:.3f} ±{:.3f}", mean->value, mean->se);
    if (worst) out += fmt::format("  worst {:.3f} ±{:.3f}", worst->value, worst->se);
    if (variation)
      out += fmt::format("  variation (sd/mean) {:.3f} ±{:.3f}", variation->value, variation->se);
    if (range) out += fmt::format("  range/mean {:.3f} ±{:.3f}", range->value, range->se);
    out += '\n';
    if (mean && mean->value != 0)
      out += "error of the mean modulation: " + budget_text(*mean) + "\n";
    if (variation && variation->value != 0)
      out += "error of the variation: " + budget_text(*variation) + "\n";
    double area = 0, share = 0, oxide = 0, margin = kInfinity, least = 1, most = 0;
    for (const ResponsePoint& p : response.points) {
      area = std::max(area, p.over_limit_area);
      share = std::max(share, p.over_limit_share);
      oxide = std::max(oxide, p.peak_oxide_field);
      margin = std::min(margin, p.oxide_margin);
      least = std::min(least, p.field_error);
      most = std::max(most, p.field_error);
    }
    out += fmt::format(
        "air beyond its breakdown field on up to {:.1f} % of the patch, {:.0f} % of the pull; "
        "peak field in the dielectric {:.0f} V/um\n",
        100 * area, 100 * share, 1e-6 * oxide);
    if (margin < 1) {
      out += fmt::format(
          "warning: the dielectric breaks down: the field in a layer is {:.3g} times its strength; "
          "at most {:.3g} of this amplitude holds; the numbers under voltage mean nothing "
          "physical\n",
          1 / margin, margin);
    }
    const bool physical = margin >= 1 && !beyond_contact(response);
    const auto low = fmt::format("{:.0f}", 100 * least), high = fmt::format("{:.0f}", 100 * most);
    if (physical) {
      out += fmt::format(
          "pull by this field rule: typically {} % from the refined 3-D field, as on the published "
          "samples; on this texture: --check-field\n",
          low == high ? low : low + " to " + high);
    }
  } else {
    out += "undriven (0 V): no modulation\n";
    if (const auto friction = summarise(Summary::Mean, "friction", response))
      out += fmt::format("mean friction {:.1f} ±{:.1f} mN; error: {}\n", 1e3 * friction->value,
                         1e3 * friction->se, budget_text(*friction));
  }
  if (const auto& look = response.appearance) {
    if (look->refused()) {
      out += "appearance: " + look->warning + "\n";
    } else {
      out += fmt::format(
          "haze {:.2f} %  transmittance {:.1f} %  gloss {:.1f} %  colour shift {:.4f}  ({}{}{})\n",
          100 * look->haze, 100 * look->transmittance, 100 * look->gloss, look->colour_shift,
          text(look->regime), look->warning.empty() ? "" : ": ", look->warning);
    }
  }
  for (const ResponsePoint& p : response.points) {
    for (const VoltageAnswer& v : p.voltages) {
      out += fmt::format("modulation {:.3g} at {:.0f} % RH: ", v.target, 100 * p.relative_humidity);
      out += v.reached() ? with_error(v.amplitude, 1, 1) +
                               " V (±: " + voltage_parts(v.amplitude.parts) + ")\n"
                         : fmt::format("{} first (modulation {:.3g})\n", text(v), v.modulation);
    }
  }
  if (const TargetReport& a = response.accuracy; a.target > 0) {
    out +=
        fmt::format("accuracy {:.2g} % asked for, {:.2g} % of {}: {} ({} pixels, {} skins, {})\n",
                    100 * a.target, 100 * a.reached, a.quantity, text(a), response.fidelity.grid,
                    response.fidelity.skins,
                    response.fidelity.estimator == Estimator::Load ? "load law" : "solved areas");
    if (const std::string apart = beside_target(response); !apart.empty())
      out += "not counted in it: " + apart + "\n";
  }
  if (const ParameterSteps& p = response.parameters; !p.steps.empty()) {
    out += fmt::format(
        "parameters: {} directions of the finger's covariance, one standard deviation up and down, "
        "{} skins, {} pixels{}\n",
        p.steps.size(), p.skins, p.grid,
        p.troubles.empty() ? "" : "; a step is not sound: " + text(p.troubles));
  }
  if (!response.plan.warning.empty()) out += "warning: " + response.plan.warning + "\n";
  if (const auto troubles = response.troubles(); !troubles.empty())
    out += "note: " + text(troubles) + "\n";
  return out;
}

}  // namespace papilla
