// papilla evaluate DESIGN.toml: the forward model over humidity.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>

#include "base/error.h"
#include "base/files.h"
#include "base/units.h"
#include "cli/commands.h"
#include "config/describe.h"
#include "config/writer.h"
#include "design/study.h"
#include "estimate/evaluation.h"
#include "estimate/parameters.h"
#include "estimate/voltage.h"
#include "geometry/io/files.h"
#include "measure/field_accuracy.h"
#include "metrics/metrics.h"
#include "report/response.h"

namespace papilla {
namespace {

struct EvaluateOptions {
  DesignOptions design;
  std::string sweep, out, accuracy;
  int jobs = 0;
  std::vector<double> voltage_for;  // modulations
  bool force = false, appearance = false, check_field = false, parameters = false;
};

// "drive.amplitude=50..200" or "texture.depth=0 nm..1 um:5": a number of the design and its values.
struct Sweep {
  std::string path, unit;
  std::vector<double> values;  // SI
};

double sweep_limit(const std::string& text, const NumberField& field) {
  const auto quantity = parse_quantity(text);  // 50..200: in the unit of the key
  const bool bare = quantity && quantity->unit.empty();
  const double si = parse_si(bare ? text + " " + field.unit : text, field.unit);
  const double scaled = si / find_unit(field.unit)->to_si;
  if (scaled < field.low * (1 - 1e-12) || scaled > field.high * (1 + 1e-12)) {
    throw InputError(
        {Problem{"--sweep", 0, 0, field.path,
                 fmt::format("{} is outside {} to {} {}", text, format_number(field.low),
                             format_number(field.high), field.unit)}});
  }
  return si;
}

Sweep parse_sweep(const std::string& text, const Design& design) {
  const std::size_t equals = text.find('='), dots = text.find("..");
  if (equals == std::string::npos || dots == std::string::npos || dots < equals) {
    throw InputError({Problem{"--sweep " + text, 0, 0, "",
                              "expected PATH=LOW..HIGH or PATH=LOW..HIGH:COUNT, e.g. "
                              "drive.amplitude=50..200:4"}});
  }
  Design copy = design;
  const NumberField field = find_number(copy, text.substr(0, equals));
  std::string high = text.substr(dots + 2);
  int count = 5;
  if (const std::size_t colon = high.find(':'); colon != std::string::npos) {
    count = std::atoi(high.c_str() + colon + 1);
    high.erase(colon);
    if (count < 2 || count > 10000) {
      throw InputError({Problem{"--sweep " + text, 0, 0, "", "expected a count of 2 to 10000"}});
    }
  }
  const double from = sweep_limit(text.substr(equals + 1, dots - equals - 1), field);
  const double to = sweep_limit(high, field);
  Sweep sweep{field.path, field.unit, {}};
  const double scale = find_unit(field.unit)->to_si;
  for (int i = 0; i < count; ++i) {
    const double si = from + (to - from) * i / (count - 1);
    // 500 nm, not 500.0000000000001 nm.
    sweep.values.push_back(parse_si(fmt::format("{:.12g} {}", si / scale, field.unit), field.unit));
  }
  return sweep;
}

const char* breakdown(const Response& response) {
  for (const ResponsePoint& p : response.points) {
    if (response.driven && p.oxide_margin < 1) return "  the dielectric breaks down";
  }
  return "";
}

std::string haze_column(const Optics& look) {
  return look.refused() ? fmt::format(" {:>8}", "refused")
                        : fmt::format(" {:>8.2f}", 100 * look.haze);
}

int evaluate_sweep(const Context& context, const Sweep& sweep, const Design& design,
                   const Fidelity& fidelity, bool json, bool look, bool parameters) {
  std::string documents;
  std::vector<Problem> problems;
  for (const double value : sweep.values) {
    Design changed = design;
    set_number(changed, sweep.path, value);
    for (const DesignProblem& p : design_problems(changed)) {
      problems.push_back({"--sweep", 0, 0, p.path,
                          fmt::format("at {}: {}", format_quantity(value, sweep.unit), p.message)});
    }
  }
  if (!problems.empty()) throw InputError(problems);
  if (!json) {
    std::cout << fmt::format("{:>16} {:>12} {:>18} {:>14} {:>14}{}\n", sweep.path, "F_off mN",
                             "mean modulation", "variation", "worst", look ? "   haze %" : "");
  }
  for (const double value : sweep.values) {
    Design changed = design;
    set_number(changed, sweep.path, value);
    Response response = evaluate(scene_of(changed), changed.texture, fidelity);
    if (parameters) add_parameter_errors(response, scene_of(changed), changed.texture, fidelity);
    if (look) response.appearance = appearance_of(changed);
    if (json) {
      documents +=
          fmt::format("{}{{\"value\": {}, \"response\": {}}}", documents.empty() ? "" : ",\n",
                      format_number(value), response_json(response));
      context.note(fmt::format("{} = {}", sweep.path, format_quantity(value, sweep.unit)));
      continue;
    }
    const auto column = [&](Summary summary, const char* metric, double scale) {
      const auto v = summarise(summary, metric, response);
      return v ? fmt::format("{:.3f} ±{:.3f}", v->value * scale, v->se * scale) : std::string("-");
    };
    std::cout << fmt::format(
                     "{:>16} {:>12} {:>18} {:>14} {:>14}", format_quantity(value, sweep.unit),
                     column(Summary::Mean, "friction", 1e3), column(Summary::Mean, "modulation", 1),
                     response.points.size() > 1 ? column(Summary::Variation, "modulation", 1) : "-",
                     column(Summary::Worst, "modulation", 1))
              << (look ? haze_column(*response.appearance) : "") << breakdown(response)
              << std::endl;
  }
  if (json) {
    std::cout << fmt::format("{{\"schema\": 1, \"sweep\": \"{}\", \"runs\": [\n{}\n]}}\n",
                             sweep.path, documents);
  }
  return kSuccess;
}

// The field rule against the 3-D potential on the first skin, on the pixels of the accuracy level.
void print_field_check(const Context& context, const Design& design, const Fidelity& fidelity) {
  FieldAccuracyOptions options;
  options.pixels = fidelity.grid;
  options.skin = fidelity.first_skin;
  options.refinements = {1};
  for (const FieldAccuracyRow& row : field_accuracy("", design, options)) {
    if (row.method == "spread" || row.method == "screened") {
      context.note(fmt::format(
          "pull at {:.0f} % RH {}: {:+.1f} % of the 3-D field's", 100 * row.relative_humidity,
          row.method == "spread" ? "with spreading flux" : "by local columns", 100 * row.error));
    }
  }
}

constexpr const char* kPictures[] = {"gap", "pressure_off", "pressure_on", "pull", "water"};

// Those of an earlier run, at humidities or of a drive that this one may not have.
void remove_pictures(const std::string& folder) {
  if (!std::filesystem::exists(folder + "/response.json")) return;  // not a folder of results
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string extension = entry.path().extension(), stem = entry.path().stem();
    const std::size_t bar = stem.rfind('_');
    if ((extension != ".png" && extension != ".npy") || bar == std::string::npos) continue;
    const bool numbered =
        bar + 1 < stem.size() && stem.find_first_not_of("0123456789", bar + 1) == std::string::npos;
    if (numbered && std::find(std::begin(kPictures), std::end(kPictures), stem.substr(0, bar)) !=
                        std::end(kPictures))
      old.push_back(entry.path());
  }
  for (const auto& path : old) std::filesystem::remove(path);
}

// Gap, pressure, water and pull of the first skin at each humidity, as pictures and arrays.
void write_pictures(const std::string& folder, const Design& design, const Fidelity& fidelity) {
  for (const double humidity : design.environment.relative_humidity) {
    const PatchPicture picture =
        picture_patch(scene_of(design), design.texture, fidelity, humidity);
    const Grid& grid = picture.texture.grid;
    const auto write = [&](const char* name, const std::vector<double>& values) {
      if (values.size() != grid.size()) return;
      const std::string path = fmt::format("{}/{}_{:.0f}", folder, name, 100 * humidity);
      int width = 0, height = 0;
      const auto rgb = render_field(grid, values, width, height);
      write_png_rgb(path + ".png", width, height, rgb);
      write_npy(path + ".npy", Heightmap{grid, values});
    };
    write("gap", picture.fields.off.gap);
    write("pressure_off", picture.fields.off.pressure);
    write("pressure_on", picture.fields.on.pressure);
    write("pull", picture.fields.pull.value);
    const auto& bridged = picture.fields.wetting_off.bridged;
    write("water", std::vector<double>(bridged.begin(), bridged.end()));
  }
}

// "5%" or "5 %": a relative standard error.
double wanted_accuracy(const std::string& text) {
  if (const auto q = parse_quantity(text); q && q->unit.empty() && q->value >= 1)
    throw InputError(fmt::format("--accuracy: {0} has no unit; write {0}%", text));
  const double target = parse_si(text, "%");
  if (!(target > 0 && target < 1))
    throw InputError(
        fmt::format("--accuracy: expected more than 0 % and less than 100 %, got {}", text));
  return target;
}

int evaluate_file(const Context& context, const EvaluateOptions& options) {
  const Study study = read_study(options.design.file, options.design.overrides);
  const Design& design = study.design;
  if (!options.force) require_fitted_model(design, options.design.file, "run with --force");
  Fidelity fidelity = fidelity_of(design);
  fidelity.threads = options.jobs;
  const bool parameters = options.parameters || design.accuracy.parameters;
  if (!options.sweep.empty()) {
    return evaluate_sweep(context, parse_sweep(options.sweep, design), design, fidelity,
                          options.design.json, options.appearance, parameters);
  }

  if (!options.out.empty()) make_folder(options.out);
  const Response response = evaluate_design(
      design, {.target = options.accuracy.empty() ? 0 : wanted_accuracy(options.accuracy),
               .parameters = options.parameters,
               .appearance = options.appearance,
               .voltage_for = options.voltage_for,
               .threads = options.jobs});
  for (const std::string& step : response.accuracy.steps) context.note(step);
  if (!options.out.empty()) {
    remove_pictures(options.out);
    write_bytes(options.out + "/resolved.toml", resolved_toml(study));
    write_bytes(options.out + "/response.json", response_json(response, false) + "\n");
    write_bytes(options.out + "/response.txt", response_table(response));
    write_bytes(options.out + "/humidity.svg",
                response_svg(response, design.title.empty() ? study.name : design.title));
    write_pictures(options.out, design, fidelity);
    context.note("wrote " + options.out);
  }
  if (options.design.json)
    std::cout << response_json(response) << '\n';
  else
    context.print(response_table(response));
  if (options.check_field && design.drive.driven()) print_field_check(context, design, fidelity);
  return kSuccess;
}

}  // namespace

void add_evaluate(Command app, Context& context) {
  Command command =
      app.add_command("evaluate", "Friction over humidity, drive off and on, with error bars");
  auto options = std::make_shared<EvaluateOptions>();
  add_design_options(command, options->design);
  command.add_option("--sweep", options->sweep, "Evaluate over a number of the design")
      .type_name("PATH=LOW..HIGH[:COUNT]");
  command
      .add_option("--voltage-for", options->voltage_for,
                  "Also the amplitude at which the modulation reaches this value")
      .type_name("MODULATION")
      .check([](const std::string& text) {
        double value = 0;
        const char* end = text.data() + text.size();
        const auto [last, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc{} && last == end && value >= 1e-3 && value <= 1e6)
          return std::string();
        return "expected a modulation (F_on - F_off)/F_off from 0.001 to 1e6 as a plain number, "
               "0.5 "
               "for 50 %, got " +
               text;
      });
  command.add_flag(
      "--check-field", options->check_field,
      "Also solve the 3-D field on one skin and say how far the cheaper rules are off");
  command.add_option("--out", options->out, "Also write the numbers and pictures of the fields")
      .type_name("DIR");
  command.add_flag("--appearance", options->appearance,
                   "Also haze, transmittance, gloss and colour");
  command
      .add_option("--accuracy", options->accuracy,
                  "Wanted standard error of the modulation: grid, samples and estimator follow")
      .type_name("SHARE")
      .check([](const std::string& text) { return text.empty() ? "expected a share: 5%" : ""; });
  command.add_flag("--parameters", options->parameters,
                   "Also the error that the finger's fitted numbers leave (its [[uncertainty]])");
  command.add_option("--jobs", options->jobs, "Threads; 0: all processors").range(0, 4096);
  command.add_flag("--force", options->force,
                   "Run with model options that the finger was not fitted with");
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return evaluate_file(context, *options); };
  });
}

}  // namespace papilla
