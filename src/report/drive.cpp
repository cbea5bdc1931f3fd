#include "report/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/units.h"
#include "report/json.h"
#include "report/markup.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// In the order of DriveLimit.
struct LimitText {
  const char* name;
  const char* unit;
};
constexpr std::array<LimitText, 4> kLimits{
    {{"body current", "mA"}, {"source voltage", "V"}, {"gap voltage", "V"}, {"film voltage", "V"}}};

const LimitText& text_of(DriveLimit limit) { return kLimits[static_cast<std::size_t>(limit)]; }

double value_of(DriveLimit limit, const DriveResponse& r) {
  switch (limit) {
    case DriveLimit::BodyCurrent:
      return r.current;
    case DriveLimit::SourceVoltage:
      return r.source_voltage;
    case DriveLimit::GapVoltage:
      return r.gap_voltage;
    case DriveLimit::FilmVoltage:
      return r.film_voltage;
  }
  return 0;
}

Json sine_json(const DriveResponse& r) {
  return {{"gap_voltage", r.gap_voltage},
          {"source_voltage", json_number(r.source_voltage)},
          {"current", r.current},
          {"mean_force", r.mean_force},
          {"ripple", r.ripple}};
}

// Null of a layer of thickness 0, which has no capacitance.
Json layer_json(const ImpedanceLayer& layer) {
  if (!layer.present()) return nullptr;
  return {{"resistance", json_number(layer.resistance)},
          {"capacitance", layer.capacitance},
          {"corner_frequency", layer.corner_frequency()}};
}

std::string layer_line(const char* name, const ImpedanceLayer& layer) {
  if (!layer.present()) return fmt::format("{:<11} {:>14}\n", name, "none");
  const std::string resistance = std::isfinite(layer.resistance)
                                     ? fmt::format("{:.4g} Mohm", 1e-6 * layer.resistance)
                                     : std::string("insulator");
  return fmt::format("{:<11} {:>14} {:>12.4g} pF   corner {:.4g} Hz\n", name, resistance,
                     1e12 * layer.capacitance, layer.corner_frequency());
}

// Which limits a plain sine would pass: "  source beyond 150 V, gap beyond 327 V".
std::string beyond(const DriveResponse& p, const std::vector<DriveCheck>& checks) {
  std::string out;
  for (const DriveCheck& check : checks) {
    if (value_of(check.what, p) <= check.limit) continue;
    const LimitText& text = text_of(check.what);
    out += fmt::format("{}{} beyond {:.4g} {}", out.empty() ? "  " : ", ", text.name,
                       check.limit / find_unit(text.unit)->to_si, text.unit);
  }
  return out;
}

std::string checks_text(const std::vector<DriveCheck>& checks) {
  std::string out;
  for (const DriveCheck& check : checks) {
    const LimitText& text = text_of(check.what);
    const double scale = find_unit(text.unit)->to_si;
    out += fmt::format("{:<15} {:.4g} {} of {:.4g}: {}\n", text.name, check.value / scale,
                       text.unit, check.limit / scale, check.passes() ? "ok" : "TOO MUCH");
  }
  return out;
}

// The strongest lines of the friction, by frequency.
std::string lines_text(const std::vector<SpectrumLine>& lines) {
  std::vector<SpectrumLine> strongest = lines;
  std::stable_sort(
      strongest.begin(), strongest.end(),
      [](const SpectrumLine& a, const SpectrumLine& b) { return a.amplitude > b.amplitude; });
  constexpr std::size_t kShown = 24;
  if (strongest.size() > kShown) strongest.resize(kShown);
  std::sort(strongest.begin(), strongest.end(),
            [](const SpectrumLine& a, const SpectrumLine& b) { return a.frequency < b.frequency; });
  std::string out = "\nfriction, lines\n          Hz           mN\n";
  for (const SpectrumLine& line : strongest)
    out += fmt::format("{:>12.6g} {:>12.5g}\n", line.frequency, 1e3 * line.amplitude);
  if (lines.size() > kShown) out += fmt::format("and {} weaker ones\n", lines.size() - kShown);
  return out;
}

std::string sweep_text(const DriveCase& c, const DriveResult& r) {
  std::string out =
      "\na plain sine\n          Hz     source V        gap V   current mA      mean mN    "
      "ripple mN\n";
  for (std::size_t i = 0; i < r.response.size(); ++i) {
    const DriveResponse& p = r.response[i];
    out += fmt::format("{:>12.6g} {:>12.5g} {:>12.5g} {:>12.5g} {:>12.5g} {:>12.5g}{}\n",
                       c.sweep.frequency[i], p.source_voltage, p.gap_voltage, 1e3 * p.current,
                       1e3 * p.mean_force, 1e3 * p.ripple, beyond(p, r.checks));
  }
  return out;
}

const char* text_of(SlipState state) {
  switch (state) {
    case SlipState::Idle:
      return "idle";
    case SlipState::Stuck:
      return "stuck";
    case SlipState::Partial:
      return "partial slip";
    case SlipState::Full:
      return "full slip";
  }
  return "";
}

// The panels of the picture [px].
constexpr double kTraceLeft = 70, kTraceWidth = 680, kTraceHeight = 200, kTraceTop = 40,
                 kTraceGap = 70;

std::string label(double x, double y, const std::string& text, const char* anchor = "middle") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     text);
}

std::string frame(double top) {
  return fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888\"/>\n",
      kTraceLeft, top, kTraceWidth, kTraceHeight);
}

// Friction over one period: least and largest value of each column.
std::string period_panel(const Signal& friction) {
  const std::vector<double>& y = friction.value;
  const auto [least, most] = std::minmax_element(y.begin(), y.end());
  const double low = *least, span = std::max(*most - low, 1e-12 * std::abs(*most) + 1e-300);
  std::string points;
  const auto columns = static_cast<std::size_t>(kTraceWidth);
  for (std::size_t k = 0; k < columns; ++k) {
    const std::size_t begin = k * y.size() / columns;
    const std::size_t end = std::max(begin + 1, (k + 1) * y.size() / columns);
    const auto [a, b] = std::minmax_element(y.begin() + static_cast<std::ptrdiff_t>(begin),
                                            y.begin() + static_cast<std::ptrdiff_t>(end));
    for (double v : {*a, *b}) {
      points += fmt::format("{:.1f},{:.1f} ", kTraceLeft + static_cast<double>(k),
                            kTraceTop + kTraceHeight * (1 - (v - low) / span));
    }
  }
  return frame(kTraceTop) +
         fmt::format(
             "<polyline fill=\"none\" stroke=\"#1f6fb4\" stroke-width=\"1\" points=\"{}\"/>\n",
             points) +
         label(kTraceLeft - 6, kTraceTop + 10, fmt::format("{:.3g} mN", 1e3 * *most), "end") +
         label(kTraceLeft - 6, kTraceTop + kTraceHeight, fmt::format("{:.3g}", 1e3 * low), "end") +
         label(kTraceLeft + kTraceWidth / 2, kTraceTop + kTraceHeight + 16,
               fmt::format("friction over {:.4g} ms", 1e3 * friction.period));
}

// Lines of the spectrum over decades, down to 120 dB below the largest.
std::string spectrum_panel(const std::vector<SpectrumLine>& lines) {
  const double top = kTraceTop + kTraceHeight + kTraceGap;
  std::string out = frame(top);
  double first = kInfinity, last = 0, largest = 0;
  for (const SpectrumLine& line : lines) {
    if (line.frequency == 0) continue;
    first = std::min(first, line.frequency);
    last = std::max(last, line.frequency);
    largest = std::max(largest, line.amplitude);
  }
  if (last == 0) return out;
  const double from = std::floor(std::log10(first)), to = std::ceil(std::log10(last) + 1e-9);
  const double width = to - from;
  for (double decade = from; decade <= from + width; ++decade) {
    const double x = kTraceLeft + kTraceWidth * (decade - from) / width;
    out += label(x, top + kTraceHeight + 16, fmt::format("{:g} Hz", std::pow(10, decade)));
  }
  for (const SpectrumLine& line : lines) {
    if (line.frequency == 0) continue;
    const double x = kTraceLeft + kTraceWidth * (std::log10(line.frequency) - from) / width;
    const double height =
        kTraceHeight * std::max(0.0, 1 + std::log10(line.amplitude / largest) / 6);
    out += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#b4411f\"/>\n", x,
        top + kTraceHeight, x, top + kTraceHeight - height);
  }
  return out + label(kTraceLeft - 6, top + 10, fmt::format("{:.3g} mN", 1e3 * largest), "end") +
         label(kTraceLeft - 6, top + kTraceHeight, "-120 dB", "end");
}

}  // namespace

namespace {

Json swipe_json(const Swipe& swipe) {
  Json steps = Json::array();
  for (const SwipeStep& step : swipe.steps)
    steps.push_back(
        {{"time", step.time}, {"state", text_of(step.state)}, {"current", step.current}});
  return {{"duration", swipe.duration}, {"driven", swipe.driven}, {"steps", steps}};
}

}  // namespace

std::string drive_text(const DriveCase& c, const DriveResult& r) {
  std::string out = c.title.empty() ? "" : c.title + '\n';
  // Layers that leak at another time constant and those that relax have lines of their own.
  if (r.network.dielectric.present() || r.network.relaxing.empty())
    out += layer_line("dielectric", r.network.dielectric);
  for (const ImpedanceLayer& layer : r.network.apart) out += layer_line("dielectric", layer);
  for (const ImpedanceLayer& layer : r.network.relaxing) out += layer_line("relaxing", layer);
  out += layer_line("gap", r.network.gap.layer) + layer_line("skin", r.network.skin);
  out += fmt::format(
      "gap          {:.4g} um on {:.4g} mm2; {:.4g} mN at 100 V\n"
      "carrier      {:.4g} V at the source, {:.4g} V in the gap, {:.4g} mA\n"
      "pull         mean {:.4g} mN, ripple at twice the frequency {:.4g} mN (unmodulated)\n"
      "pull         mean {:.4g} mN over the signal\n",
      1e6 * r.network.gap.distance, 1e6 * r.area, 1e3 * r.network.gap.force_factor * 1e4,
      r.carrier.source_voltage, r.carrier.gap_voltage, 1e3 * r.carrier.current,
      1e3 * r.carrier.mean_force, 1e3 * r.carrier.ripple, 1e3 * r.series.mean_force);
  if (r.spots > 0) {
    out += fmt::format("spots        {:.4g} Mohm through the skin to its contact spots, {}\n",
                       1e-6 * r.spots,
                       c.gap.contact_spots ? "beside the gap" : "not counted (gap.contact_spots)");
  }
  if (c.modulated()) {
    out += fmt::format("distortion   {:.3g} % below half the carrier's frequency\n",
                       100 * r.distortion);
  }
  if (c.touch.real_area > 0) {
    out += fmt::format(
        "onset        {:.4g} mN without voltage, {:.4g} mN with it; {:.4g} mN from a patch all in "
        "static contact\n",
        1e3 * r.onset_off, 1e3 * r.onset_on, 1e3 * r.onset_static);
  }
  out += checks_text(r.checks) + lines_text(r.lines);
  return r.response.empty() ? out : out + sweep_text(c, r);
}

std::string drive_json(const DriveCase& c, const DriveResult& r, const std::vector<Swipe>& swipes) {
  Json gap = layer_json(r.network.gap.layer);
  gap["distance"] = r.network.gap.distance;
  gap["force_factor"] = r.network.gap.force_factor;
  Json lines = Json::array(), sweep = Json::array(), checks = Json::array();
  for (const SpectrumLine& line : r.lines) {
    lines.push_back({{"frequency", line.frequency}, {"amplitude", line.amplitude}});
  }
  for (std::size_t i = 0; i < r.response.size(); ++i) {
    Json row = sine_json(r.response[i]);
    row["frequency"] = c.sweep.frequency[i];
    sweep.push_back(row);
  }
  for (const DriveCheck& check : r.checks) {
    checks.push_back({{"name", text_of(check.what).name},
                      {"value", json_number(check.value)},
                      {"limit", check.limit},
                      {"passes", check.passes()}});
  }
  Json out{{"schema", 1},
           {"title", c.title},
           {"area", r.area},
           {"dielectric", layer_json(r.network.dielectric)},
           {"gap", gap},
           {"skin", layer_json(r.network.skin)},
           {"carrier", sine_json(r.carrier)},
           {"period", r.friction.period},
           {"mean_pull", r.series.mean_force},
           {"peak_current", r.series.peak_current},
           {"peak_source_voltage", json_number(r.series.peak_source_voltage)},
           {"peak_gap_voltage", r.series.peak_gap_voltage},
           {"distortion", r.distortion},
           {"friction_lines", lines},
           {"over_frequency", sweep},
           {"onset_off", r.onset_off},
           {"onset_on", r.onset_on},
           {"onset_static", r.onset_static},
           {"checks", checks}};
  if (r.spots > 0) out["contact_spots"] = r.spots;
  for (const ImpedanceLayer& layer : r.network.apart)
    out["dielectric_apart"].push_back(layer_json(layer));
  for (const ImpedanceLayer& layer : r.network.relaxing)
    out["relaxing"].push_back(layer_json(layer));
  for (const Swipe& swipe : swipes) out["swipes"].push_back(swipe_json(swipe));
  return out.dump(2);
}

std::string swipe_text(const Swipe& swipe) {
  std::string out = "\nswipe\n";
  if (swipe.without_tones)
    out += "the current is the carrier's amplitude, in the place of what the tones make of it\n";
  out += "         s  state           current mA\n";
  for (const SwipeStep& step : swipe.steps)
    out += fmt::format("{:>10.3f}  {:<14} {:>11.4g}\n", step.time, text_of(step.state),
                       1e3 * step.current);
  return out + fmt::format("driven for {:.3g} s of {:.3g} s\n", swipe.driven, swipe.duration);
}

std::string swipe_csv(const Swipe& swipe) {
  std::string out = "t [s],place [m],lateral [N],state,current [A]\n";
  for (const RubbingSample& at : swipe.samples)
    out += fmt::format("{:.4f},{:.6g},{:.6g},{},{:.6g}\n", at.time, at.place, at.lateral,
                       text_of(at.state), at.current);
  return out;
}

std::string drive_series_csv(const DriveResult& r) {
  std::string out = "t [s],source voltage [V],current [A],gap voltage [V],pull [N],friction [N]\n";
  for (std::size_t i = 0; i < r.friction.value.size(); ++i) {
    out += fmt::format("{:.9g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n",
                       static_cast<double>(i) * r.friction.step(), r.series.source_voltage.value[i],
                       r.series.current.value[i], r.series.gap_voltage.value[i],
                       r.series.force.value[i], r.friction.value[i]);
  }
  return out;
}

std::string drive_lines_csv(const DriveResult& r) {
  std::string out = "frequency [Hz],friction amplitude [N]\n";
  for (const SpectrumLine& line : r.lines) {
    out += fmt::format("{:.9g},{:.6g}\n", line.frequency, line.amplitude);
  }
  return out;
}

std::string drive_svg(const DriveCase& c, const DriveResult& r) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"800\" height=\"{:.0f}\" "
             "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
             "fill=\"white\"/>\n",
             kTraceTop + 2 * kTraceHeight + kTraceGap + 50) +
         label(400, 20, markup_text(c.title)) + period_panel(r.friction) + spectrum_panel(r.lines) +
         "</svg>\n";
}

}  // namespace papilla::report
