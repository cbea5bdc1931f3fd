#include "report/response.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/constants.h"
#include "base/text.h"
#include "metrics/metrics.h"
#include "report/svg.h"

namespace papilla::report {
namespace {

// "sampling 3.1 %, grid 0.8 %, ...": of the value; then what stands beside it, and what was not
// measured.
std::string budget_text(const SummaryValue& v, const Response& response) {
  // Errors that such a run cannot have: of solved areas, of one humidity, without a field or water.
  const auto none = [&](const ErrorOrigin& origin) {
    return (origin.part == &ErrorParts::method && response.fidelity.estimator == Estimator::Area) ||
           (origin.part == &ErrorParts::humidity && response.points.size() == 1) ||
           (origin.part == &ErrorParts::field && !response.plan.field) ||
           (origin.part == &ErrorParts::water && !response.plan.water);
  };
  const double size = std::abs(v.value);
  if (size == 0) return {};
  std::string out = fmt::format("sampling {:.1f} %", 100 * v.parts.sampling / size), apart, unknown;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (const auto& part = v.parts.*origin.part) {
      constexpr double kRounding = 1e-12;  // less of a value is that of its arithmetic
      const double share = *part > kRounding * size ? *part / size : 0;
      const std::string text = fmt::format("{} {:.2g} %", origin.name, 100 * share);
      if (origin.in_total) {
        out += ", " + text;
      } else {
        apart += (apart.empty() ? "; beside it: " : ", ") + text;
      }
    } else if (origin.part != &ErrorParts::parameters && origin.part != &ErrorParts::model &&
               !none(origin)) {
      unknown += (unknown.empty() ? "" : ", ") + std::string(origin.name);
    }
  }
  if (!apart.empty()) out += apart + ", common to all designs";
  if (!v.parts.model_part()) out += "; parameters not asked for (--parameters)";
  return out + (unknown.empty() ? "" : "; error from " + unknown + ": not measured");
}

// Whether every humidity has numbers under the drive.
bool knows_driven(const Response& response) {
  return std::all_of(response.points.begin(), response.points.end(),
                     [](const ResponsePoint& p) { return p.knows_driven(); });
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
  const auto v = summarise(Summary::Mean, response.driven ? kModulation : kFriction, response);
  if (!v || v->value == 0) return {};
  std::string out;
  for (const auto& [name, part] :
       {std::pair{"humidity", v->parts.humidity}, std::pair{"field", v->parts.field},
        std::pair{"parameters", v->parts.parameters}}) {
    if (part && *part > 0) {
      out += fmt::format("{}{} {:.2g} %", out.empty() ? "" : ", ", name,
                         100 * *part / std::abs(v->value));
    }
  }
  return out;
}

// So many digits behind the point, or as many more as show the first one of the error or three of
// the value, what of both takes fewer; no more for what is zero but for rounding.
int digits_shown(double value, double error, int digits) {
  constexpr int kMost = 9;
  const auto shows = [](double number, int significant) {
    return number > 0 && std::isfinite(number)
               ? significant - 1 - static_cast<int>(std::floor(std::log10(number)))
               : kMost + 1;
  };
  const int wanted = std::min(shows(error, 1), shows(std::abs(value), 3));
  return wanted > kMost ? digits : std::max(digits, wanted);
}

std::string with_error(double value, double error, double scale, int digits) {
  const int shown = digits_shown(value * scale, error * scale, digits);
  return fmt::format("{} ±{:.{}f}", fixed(value * scale, shown), error * scale, shown);
}

std::string with_error(const Measured& m, double scale, int digits) {
  return with_error(m.value, m.se(), scale, digits);
}

// As per cent, unlike what other humidities of the response read.
std::string humidity_text(const ResponsePoint& point, const Response& response) {
  std::vector<double> all;
  for (const ResponsePoint& p : response.points) all.push_back(p.relative_humidity);
  return fixed(100 * point.relative_humidity, humidity_decimals(std::move(all)));
}

// The table over humidity.
std::string humidity_table(const Response& response) {
  std::string out =
      fmt::format("{:>6} {:>9} {:>16} {:>16} {:>15} {:>14} {:>14} {:>14} {:>9} {:>9}\n", "RH",
                  "patch kPa", "F_off mN", "F_on mN", "modulation", "contact off %", "capillary mN",
                  "electro mN", "bridges", "gap nm");
  for (const ResponsePoint& p : response.points) {
    const auto shown = [](bool known, const Measured& m, double scale, int digits) {
      return known ? with_error(m, scale, digits) : std::string("-");
    };
    const bool off = p.knows_undriven(), on = response.driven && p.knows_driven();
    out += fmt::format(
        "{:>5}% {:>9.0f} {:>16} {:>16} {:>15} {:>14} {:>14} {:>14} {:>9.1f} {:>9.0f}\n",
        humidity_text(p, response), 1e-3 * p.patch_pressure, shown(off, p.friction_off, 1e3, 1),
        shown(on, p.friction_on, 1e3, 1), shown(on, p.modulation, 1, 3),
        shown(off, p.area_fraction_off, 100, 3), with_error(p.capillary_force, 1e3, 1),
        shown(on, p.electrostatic_force, 1e3, 1), p.bridges.value, 1e9 * p.mean_gap.value);
  }
  return out;
}

// Load that F_on has beside the pull: from the columns of the table alone it would not follow. Eq.
// friction.3, friction.4
std::string capillary_gain_line(const Response& response) {
  constexpr double kCounts = 0.2;  // of the pull
  std::vector<std::string> gains;
  for (const ResponsePoint& p : response.points) {
    const double gain = 1e3 * p.capillary_gain;  // [mN]
    if (p.knows_driven() && std::abs(gain) > kCounts * 1e3 * p.electrostatic_force.value)
      gains.push_back(fmt::format("{}{} mN at {} % RH", gain > 0 ? "+" : "",
                                  fixed(gain, digits_shown(gain, 0, 1)),
                                  humidity_text(p, response)));
  }
  if (gains.empty()) return {};
  return "F_on follows the pull and the capillary force under the drive, which differs from that "
         "without it by " +
         join_names(gains) + "\n";
}

// What no ± holds: choices of the model, each as far as the plan expects it to move the numbers.
std::string choices_line(const Response& response) {
  const auto mean = summarise(Summary::Mean, kModulation, response);
  const bool water = mean && mean->parts.water;  // what its free choices leave is said already
  std::vector<std::string> choices;
  for (const PlanStep& step : response.plan.steps) {
    if (step.piece == Piece::Water && step.error > 0 && !water)
      choices.push_back(fmt::format("{} {:.2g} %", step.name(), 100 * step.error));
  }
  for (const PlanSkip& skip : response.plan.skipped) {
    if (skip.bound > 0)
      choices.push_back(fmt::format("{} {:.2g} %", skip.name(), 100 * skip.bound));
  }
  double share = 0;
  for (const ResponsePoint& p : response.points) share = std::max(share, p.over_limit_share);
  if (share > 0 && !response.belief.over_air_limits)
    choices.push_back(fmt::format(
        "what air withstands (model.air_limit), where {:.2g} % of the pull stands", 100 * share));
  return choices.empty() ? ""
                         : "not in ±: choices of the model (papilla explain), expected " +
                               join_names(choices) + "\n";
}

// What the modulation is over humidity, and how sure that is.
std::string modulation_lines(const Response& response) {
  if (!knows_driven(response)) return "modulation: no number over humidity, see the notes below\n";
  std::string out;
  const auto mean = summarise(Summary::Mean, kModulation, response);
  std::optional<SummaryValue> variation, range;
  if (response.points.size() > 1) {  // one humidity does not vary
    variation = summarise(Summary::Variation, kModulation, response);
    range = summarise(Summary::Range, kModulation, response);
  }
  const auto worst = summarise(Summary::Worst, kModulation, response);
  out += fmt::format("modulation {}", modulation_sparkline(response));
  // With belief two parts with their names, else one ±.
  const auto with_parts = [](const SummaryValue& v) {
    return v.parts.model ? fmt::format("{:.3f} ±{:.3f} numerical ±{:.3f} model", v.value,
                                       v.parts.numerical(), *v.parts.model)
                         : fmt::format("{:.3f} ±{:.3f}", v.value, v.se);
  };
  if (mean) out += "  mean " + with_parts(*mean);
  if (worst) out += "  worst " + with_parts(*worst);
  if (variation) out += "  variation (sd/mean) " + with_parts(*variation);
  if (range) out += "  range/mean " + with_parts(*range);
  out += '\n';
  if (mean && mean->value != 0)
    out += "error of the mean modulation: " + budget_text(*mean, response) + "\n";
  if (variation && variation->value != 0)
    out += "error of the variation: " + budget_text(*variation, response) + "\n";
  return out;
}

// How far the field is from what air and dielectric hold, and what that says of the numbers.
std::string field_lines(const Response& response) {
  std::string out;
  double area = 0, share = 0, oxide = 0, margin = kInfinity, bridged = kInfinity, least = kInfinity,
         most = 0, error = 0;
  bool measured = true;
  for (const ResponsePoint& p : response.points) {
    area = std::max(area, p.over_limit_area);
    share = std::max(share, p.over_limit_share);
    oxide = std::max(oxide, p.peak_oxide_field);
    margin = std::min(margin, p.oxide_margin);
    bridged = std::min(bridged, p.bridged_margin);
    least = std::min(least, p.field_correction);
    most = std::max(most, p.field_correction);
    measured = measured && p.field_error;
    error = std::max(error, p.field_error.value_or(0));
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
  } else if (bridged == 0) {
    out +=
        "warning: the dielectric is at risk: it holds the field that was solved, but the electrode "
        "is bare on side walls, where a bridge or a contact would short the drive; voltage_for and "
        "studies that limit oxide_breakdown_margin refuse it: cover the walls "
        "(surface.step_coverage, a conformal layer)\n";
  } else if (bridged < 1) {
    out += fmt::format(
        "warning: the dielectric is at risk: it holds the field that was solved, but under a "
        "bridge or a contact on its thinnest place the field is {:.3g} times its strength; at most "
        "{:.3g} of this amplitude is sure to hold, and voltage_for and studies that limit "
        "oxide_breakdown_margin go no farther\n",
        1 / bridged, bridged);
  }
  for (const ResponsePoint& p : response.points) {
    if (!p.pull_in) continue;
    const Measured& m = p.pull_in->margin;
    const std::string percent = humidity_text(p, response);
    if (m.value >= kFarthestPullIn) {
      out += fmt::format("pull-in at {} % RH: beyond {:g} times this voltage\n", percent,
                         kFarthestPullIn);
    } else if (m.value == 0) {
      out += fmt::format("pull-in at {} % RH: water alone closes the gap\n", percent);
    } else {
      out += fmt::format("pull-in at {} % RH: {} at {:.3g} ± {:.2g} times this voltage\n", percent,
                         p.pull_in->folds > 0 ? "the gap jumps shut" : "the gap has closed",
                         m.value, 2 * m.se());
    }
  }
  const bool physical = knows_driven(response);
  if (physical && measured) {
    out +=
        fmt::format("pull: field rule times {:.2f} to {:.2f}, by the 3-D field; good to {:.0f} %\n",
                    least, most, 100 * error);
  } else if (physical) {
    out += "pull: by the field rule, its distance from the 3-D field not measured at this level\n";
  }
  return out;
}

// Under current control the voltage is an answer, another at each humidity.
std::string source_line(const Response& response) {
  const auto of = [](const ResponsePoint& a, const ResponsePoint& b) {
    return a.source_voltage < b.source_voltage;
  };
  const auto [least, most] =
      std::minmax_element(response.points.begin(), response.points.end(), of);
  if (response.points.empty() || least->source_voltage == most->source_voltage) return {};
  return fmt::format("the current takes {:.0f} V at {} % RH to {:.0f} V at {} %\n",
                     least->source_voltage, humidity_text(*least, response), most->source_voltage,
                     humidity_text(*most, response));
}

std::string undriven_lines(const Response& response) {
  std::string out = "undriven (0 V): no modulation\n";
  if (!std::all_of(response.points.begin(), response.points.end(),
                   [](const ResponsePoint& p) { return p.knows_undriven(); }))
    return out + "friction: no number over humidity, see the notes below\n";
  if (const auto friction = summarise(Summary::Mean, kFriction, response))
    out += fmt::format(
        "mean friction {} mN{}; error: {}\n", with_error(friction->value, friction->se, 1e3, 1),
        friction->parts.model
            ? fmt::format(" numerical ±{:.1f} mN model", 1e3 * *friction->parts.model)
            : "",
        budget_text(*friction, response));
  return out;
}

std::string appearance_line(const Optics& look) {
  if (look.refused()) {
    return "appearance: " + look.warning + "\n";
  }
  return fmt::format(
      "haze {:.2f} %  transmittance {:.1f} %, {:.1f} % in all  gloss {:.1f} GU  distinctness of "
      "image {:.1f} %{}  colour shift {:.4f}  ({}{}{})\n",
      100 * look.haze, 100 * look.transmittance, 100 * look.total_transmittance, look.gloss,
      100 * look.distinctness,
      look.sparkle > 0 ? fmt::format("  sparkle {:.2f} %", 100 * look.sparkle) : "",
      look.colour_shift, text(look.regime), look.warning.empty() ? "" : ": ", look.warning);
}

std::string voltage_lines(const Response& response) {
  std::string out;
  for (const ResponsePoint& p : response.points) {
    for (const VoltageAnswer& v : p.voltages) {
      out += fmt::format("modulation {:.3g} at {} % RH: ", v.target, humidity_text(p, response));
      out += v.reached() ? with_error(v.amplitude, 1, 1) +
                               " V (±: " + voltage_parts(v.amplitude.parts) + ")\n"
             : v.limit > 0 ? fmt::format("{} first (modulation {:.3g})\n", text(v), v.modulation)
                           : text(v) + "\n";
    }
  }
  return out;
}

std::string target_lines(const Response& response) {
  const TargetReport& a = response.accuracy;
  std::string out;
  out += fmt::format("accuracy {:.2g} % asked for, {:.2g} % of {}: {} ({} pixels, {} skins, {})\n",
                     100 * a.target, 100 * a.reached, a.quantity, text(a), response.fidelity.grid,
                     response.fidelity.skins,
                     response.fidelity.estimator == Estimator::Load ? "load law" : "solved areas");
  if (const std::string apart = beside_target(response); !apart.empty())
    out += "not counted in it: " + apart + "\n";
  return out;
}

// What the members of belief leave of the numbers: of each humidity, and over all.
struct BeliefColumn {
  const char* head;
  QuantityMetric metric;
  double scale;
  int digits;
  bool driven;
};
std::string belief_table(const Response& response) {
  static constexpr std::array<BeliefColumn, 3> kBeliefColumns{
      {{"F_off mN", kFriction, 1e3, 1, false},
       {"F_on mN", kFrictionOn, 1e3, 1, true},
       {"modulation", kModulation, 1, 3, true}}};
  std::string out = fmt::format("{:>6}", "RH");
  for (const BeliefColumn& c : kBeliefColumns) {
    if (response.driven || !c.driven)
      out += fmt::format(" {:>12} {:>12} {:>30}", c.head, "± numerical", "± model; median [95 %]");
  }
  out += '\n';
  const auto row = [&](const std::string& name, auto&& value, auto&& members) {
    out += name;
    for (const BeliefColumn& c : kBeliefColumns) {
      if (!response.driven && c.driven) continue;
      // Of what has no number, that of the members is none either.
      const auto v = value(c);
      const auto over = v ? members(c) : std::nullopt;
      const auto text = [&](double x) { return fixed(x * c.scale, c.digits); };
      out += fmt::format(
          " {:>12} {:>12} {:>30}", v ? text(v->first) : "-", v ? text(v->second) : "-",
          over ? fmt::format("{}; {} [{}, {}]", text(over->deviation()), text(over->quantile(0.5)),
                             text(over->quantile(0.025)), text(over->quantile(0.975)))
               : "-");
    }
    out += '\n';
  };
  using Shown = std::optional<std::pair<double, double>>;
  for (std::size_t i = 0; i < response.points.size(); ++i) {
    const ResponsePoint& p = response.points[i];
    row(
        fmt::format("{:>5}%", humidity_text(p, response)),
        [&](const BeliefColumn& c) -> Shown {
          if (!is_known(c.metric, p)) return std::nullopt;
          const Measured& m = p.*c.metric.quantity;
          return std::pair(m.value, m.parts.numerical());
        },
        [&](const BeliefColumn& c) { return belief_values_at(i, c.metric, response); });
  }
  row(
      fmt::format("{:>6}", "mean"),
      [&](const BeliefColumn& c) -> Shown {
        if (!is_known(c.metric, response)) return std::nullopt;
        const auto v = summarise(Summary::Mean, c.metric, response);
        return v ? Shown(std::pair(v->value, v->parts.numerical())) : std::nullopt;
      },
      [&](const BeliefColumn& c) { return belief_values(Summary::Mean, c.metric, response); });
  return out;
}

// "one balance .62, uniform .38": the weights of the hypotheses, in the order of the file.
std::string hypotheses_text(const BeliefRuns& belief) {
  std::vector<std::pair<std::string, double>> shares;
  for (const BeliefRun& m : belief.members) {
    const auto same = std::find_if(shares.begin(), shares.end(),
                                   [&](const auto& s) { return s.first == m.hypothesis; });
    if (same == shares.end())
      shares.emplace_back(m.hypothesis, m.weight);
    else
      same->second += m.weight;
  }
  std::vector<std::string> out;
  for (const auto& [name, weight] : shares)
    out.push_back(fmt::format("{} {:.0f} %", name.empty() ? "one hypothesis" : name, 100 * weight));
  return join_names(out);
}

std::string belief_lines(const Response& response) {
  const BeliefRuns& b = response.belief;
  if (b.members.empty())
    return b.absent.empty() ? "" : "model: in no ± here, as " + b.absent + "\n";
  return belief_table(response) +
         fmt::format(
             "± model: standard deviation over {} members of belief (as good as {:.1f} equal "
             "ones; {}) about their own mean, {} skins, {} pixels; behind it their median and, in "
             "brackets, 95 % of their weight; the value is by the numbers of the fit and may lie "
             "off that median; common to all designs, in a difference its own part counts{}\n",
             b.members.size(), b.effective(), hypotheses_text(b), b.skins, b.grid,
             b.troubles.empty() ? "" : "; a member is not sound: " + text(b.troubles));
}

std::string parameter_line(const ParameterSteps& p) {
  return fmt::format(
      "parameters: {} directions of the finger's covariance, one standard deviation up and down, "
      "{} skins, {} pixels{}\n",
      p.steps.size(), p.skins, p.grid,
      p.troubles.empty() ? "" : "; a step is not sound: " + text(p.troubles));
}

}  // namespace

std::string response_svg(const Response& response, const std::string& title) {
  // Where a point has no number the curve has none: NaN is not drawn.
  const auto curve = [&](const char* name, const char* colour, double scale, auto member,
                         bool (ResponsePoint::*known)() const) {
    SvgSeries s{.name = name, .colour = colour, .x = {}, .y = {}, .ex = {}, .ey = {}};
    s.line = s.band = true;
    for (const ResponsePoint& p : response.points) {
      s.x.push_back(100 * p.relative_humidity);
      s.y.push_back((p.*known)() ? scale * (p.*member).value : std::nan(""));
      s.ey.push_back(2 * scale * (p.*member).se());
    }
    return s;
  };
  SvgPlot force{.title = title,
                .x = "relative humidity [%]",
                .y = "friction [mN]",
                .series = {curve("drive off", "#1f6f9f", 1e3, &ResponsePoint::friction_off,
                                 &ResponsePoint::knows_undriven)},
                .from_zero = true};
  if (!response.driven) return svg_picture({force});
  force.series.push_back(
      curve("drive on", "#c2571a", 1e3, &ResponsePoint::friction_on, &ResponsePoint::knows_driven));
  return svg_picture({force,
                      {.title = "",
                       .x = "relative humidity [%]",
                       .y = "modulation (F_on - F_off)/F_off",
                       .series = {curve("", "#3a7d44", 1, &ResponsePoint::modulation,
                                        &ResponsePoint::knows_driven)},
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

std::vector<std::string> caveats(const Response& response) {
  std::string out;
  if (response.driven) {
    if (knows_driven(response)) out += choices_line(response);
    out += capillary_gain_line(response) + field_lines(response);
  }
  for (const std::string& said : response.plan.warnings) out += "warning: " + said + "\n";
  std::vector<std::string> lines = split(out, '\n');
  lines.pop_back();  // what stands behind the last line's end
  return lines;
}

std::string response_table(const Response& response) {
  std::string out = humidity_table(response);
  out += response.driven ? modulation_lines(response) + source_line(response)
                         : undriven_lines(response);
  if (response.appearance) out += appearance_line(*response.appearance);
  out += voltage_lines(response);
  if (response.accuracy.target > 0) out += target_lines(response);
  if (!response.parameters.steps.empty()) out += parameter_line(response.parameters);
  out += belief_lines(response);
  for (const std::string& line : caveats(response)) out += line + "\n";
  if (const auto said = response.said(); !said.empty()) out += "note: " + text(said) + "\n";
  return out;
}

}  // namespace papilla::report
