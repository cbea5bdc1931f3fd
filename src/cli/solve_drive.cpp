// papilla solve drive: from the source to the force over time and its spectrum.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "base/units.h"
#include "cases/drive_case.h"
#include "cli/commands.h"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;

struct DriveCommand {
  DesignOptions file;
  std::string out, swipe;
};

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json response_json(const DriveResponse& r) {
  return {{"gap_voltage", r.gap_voltage},
          {"source_voltage", number(r.source_voltage)},
          {"current", r.current},
          {"mean_force", r.mean_force},
          {"ripple", r.ripple}};
}

Json layer_json(const ImpedanceLayer& layer) {
  return {{"resistance", number(layer.resistance)},
          {"capacitance", layer.capacitance},
          {"corner_frequency", layer.corner_frequency()}};
}

void print_json(const DriveCase& c, const DriveResult& r) {
  Json gap = layer_json(r.network.gap.layer);
  gap["distance"] = r.network.gap.distance;
  gap["force_factor"] = r.network.gap.force_factor;
  Json lines = Json::array(), sweep = Json::array(), checks = Json::array();
  for (const SpectrumLine& line : r.lines) {
    lines.push_back({{"frequency", line.frequency}, {"amplitude", line.amplitude}});
  }
  for (std::size_t i = 0; i < r.response.size(); ++i) {
    Json row = response_json(r.response[i]);
    row["frequency"] = c.sweep.frequency[i];
    sweep.push_back(row);
  }
  for (const DriveCheck& check : r.checks) {
    checks.push_back({{"name", check.name},
                      {"value", number(check.value)},
                      {"limit", check.limit},
                      {"passes", check.passes()}});
  }
  const Json out{{"schema", 1},
                 {"title", c.title},
                 {"area", r.area},
                 {"dielectric", layer_json(r.network.dielectric)},
                 {"gap", gap},
                 {"skin", layer_json(r.network.skin)},
                 {"carrier", response_json(r.carrier)},
                 {"period", r.friction.period},
                 {"mean_pull", r.series.mean_force},
                 {"peak_current", r.series.peak_current},
                 {"peak_source_voltage", number(r.series.peak_source_voltage)},
                 {"peak_gap_voltage", r.series.peak_gap_voltage},
                 {"distortion", r.distortion},
                 {"friction_lines", lines},
                 {"over_frequency", sweep},
                 {"onset_off", r.onset_off},
                 {"onset_on", r.onset_on},
                 {"onset_static", r.onset_static},
                 {"checks", checks}};
  std::cout << out.dump(2) << '\n';
}

std::string layer_line(const char* name, const ImpedanceLayer& layer) {
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
    const double value = check.name == "source voltage" ? p.source_voltage
                         : check.name == "gap voltage"  ? p.gap_voltage
                                                        : p.current;
    if (value <= check.limit) continue;
    out += fmt::format("{}{} beyond {:.4g} {}", out.empty() ? "  " : ", ", check.name,
                       check.limit / find_unit(check.unit)->to_si, check.unit);
  }
  return out;
}

void print(const DriveCase& c, const DriveResult& r) {
  if (!c.title.empty()) std::cout << c.title << '\n';
  std::cout << layer_line("dielectric", r.network.dielectric)
            << layer_line("gap", r.network.gap.layer) << layer_line("skin", r.network.skin)
            << fmt::format(
                   "gap          {:.4g} um on {:.4g} mm2; {:.4g} mN at 100 V\n"
                   "carrier      {:.4g} V at the source, {:.4g} V in the gap, {:.4g} mA\n"
                   "pull         mean {:.4g} mN, ripple at twice the frequency {:.4g} mN "
                   "(unmodulated)\n"
                   "pull         mean {:.4g} mN over the signal\n",
                   1e6 * r.network.gap.distance, 1e6 * r.area,
                   1e3 * r.network.gap.force_factor * 1e4, r.carrier.source_voltage,
                   r.carrier.gap_voltage, 1e3 * r.carrier.current, 1e3 * r.carrier.mean_force,
                   1e3 * r.carrier.ripple, 1e3 * r.series.mean_force);
  if (c.drive.waveform == Waveform::Am) {
    std::cout << fmt::format("distortion   {:.3g} % below half the carrier's frequency\n",
                             100 * r.distortion);
  }
  if (c.touch.real_area > 0) {
    std::cout << fmt::format(
        "onset        {:.4g} mN without voltage, {:.4g} mN with it; {:.4g} mN from a patch all in "
        "static contact\n",
        1e3 * r.onset_off, 1e3 * r.onset_on, 1e3 * r.onset_static);
  }
  for (const DriveCheck& check : r.checks) {
    const double scale = find_unit(check.unit)->to_si;
    std::cout << fmt::format("{:<15} {:.4g} {} of {:.4g}: {}\n", check.name, check.value / scale,
                             check.unit, check.limit / scale, check.passes() ? "ok" : "TOO MUCH");
  }
  std::vector<SpectrumLine> strongest(r.lines.begin(), r.lines.end());
  std::stable_sort(
      strongest.begin(), strongest.end(),
      [](const SpectrumLine& a, const SpectrumLine& b) { return a.amplitude > b.amplitude; });
  constexpr std::size_t kShown = 24;
  if (strongest.size() > kShown) strongest.resize(kShown);
  std::sort(strongest.begin(), strongest.end(),
            [](const SpectrumLine& a, const SpectrumLine& b) { return a.frequency < b.frequency; });
  std::cout << "\nfriction, lines\n          Hz           mN\n";
  for (const SpectrumLine& line : strongest) {
    std::cout << fmt::format("{:>12.6g} {:>12.5g}\n", line.frequency, 1e3 * line.amplitude);
  }
  if (r.lines.size() > kShown) {
    std::cout << fmt::format("and {} weaker ones\n", r.lines.size() - kShown);
  }
  if (!r.response.empty()) {
    std::cout
        << "\na plain sine\n          Hz     source V        gap V   current mA      mean mN    "
           "ripple mN\n";
    for (std::size_t i = 0; i < r.response.size(); ++i) {
      const DriveResponse& p = r.response[i];
      std::cout << fmt::format("{:>12.6g} {:>12.5g} {:>12.5g} {:>12.5g} {:>12.5g} {:>12.5g}{}\n",
                               c.sweep.frequency[i], p.source_voltage, p.gap_voltage,
                               1e3 * p.current, 1e3 * p.mean_force, 1e3 * p.ripple,
                               beyond(p, r.checks));
    }
  }
}

void print_swipe(const DriveCase& c, const std::string& file) {
  StictionOptions options;
  options.stuck_current = options.partial_current = c.drive.current;
  const Swipe swipe = run_swipe(read_bytes(file), file, options);
  std::cout << "\nswipe\n         s  state           current mA\n";
  for (const SwipeStep& step : swipe.steps) {
    std::cout << fmt::format("{:>10.3f}  {:<14} {:>11.4g}\n", step.time,
                             slip_state_name(step.state), 1e3 * step.current);
  }
  std::cout << fmt::format("driven for {:.3g} s of {:.3g} s\n", swipe.driven, swipe.duration);
}

int solve(const Context& context, const DriveCommand& command) {
  const DriveCase c = read_drive_case(command.file.file, command.file.overrides);
  if (!command.out.empty()) make_folder(command.out);
  const DriveResult r = solve_drive(c);
  if (!command.out.empty()) {
    write_bytes(command.out + "/series.csv", drive_series_csv(r));
    write_bytes(command.out + "/lines.csv", drive_lines_csv(r));
    write_bytes(command.out + "/drive.svg", drive_svg(c, r));
    context.note("wrote " + command.out);
  }
  if (command.file.json) {
    print_json(c, r);
  } else {
    print(c, r);
    if (!command.swipe.empty()) print_swipe(c, command.swipe);
  }
  return kSuccess;
}

}  // namespace

void add_solve_drive(Command solve_command, Context& context) {
  Command command = solve_command.add_command(
      "drive", "From the source to the force: impedances, modulation, spectrum, limits");
  auto options = std::make_shared<DriveCommand>();
  command.add_option("file", options->file.file, "Case, e.g. designs/physics/fingertip_drive.toml")
      .required()
      .type_name("FILE");
  add_set_option(command, options->file.overrides);
  command.add_flag("--json", options->file.json, "One JSON object, SI units");
  command
      .add_option("--swipe", options->swipe,
                  "Forces \"lateral,normal\" [N] at 1 kHz: when stickiness would drive the finger")
      .type_name("FORCES.csv");
  command.add_option("--out", options->out, "Also write series.csv, lines.csv and drive.svg")
      .type_name("DIR");
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return solve(context, *options); };
  });
}

}  // namespace papilla
