// papilla evaluate DESIGN.toml: the forward model over humidity.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/units.h"
#include "base/watch.h"
#include "cli/commands.h"
#include "cli/scan_options.h"
#include "config/describe.h"
#include "config/writer.h"
#include "design/study.h"
#include "estimate/belief.h"
#include "estimate/evaluation.h"
#include "estimate/parameters.h"
#include "estimate/voltage.h"
#include "measure/field_accuracy.h"
#include "report/fields.h"
#include "report/response.h"
#include "report/sweep.h"

namespace papilla::cli {
namespace {

struct EvaluateOptions {
  DesignOptions design;
  std::string sweep, out, accuracy;
  int jobs = 0;
  std::vector<double> voltage_for;  // modulations
  bool force = false, appearance = false, pull_in = false, check_field = false, parameters = false,
       no_model = false;
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
    const char* end = high.data() + high.size();
    const auto [last, error] = std::from_chars(high.data() + colon + 1, end, count);
    const bool whole = error == std::errc{} && last == end;
    high.erase(colon);
    if (!whole || count < 2 || count > 10000) {
      throw InputError({Problem{"--sweep " + text, 0, 0, "", "expected a count of 2 to 10000"}});
    }
  }
  const double from = sweep_limit(text.substr(equals + 1, dots - equals - 1), field);
  const double to = sweep_limit(high, field);
  if (from == to)
    throw InputError(
        {Problem{"--sweep " + text, 0, 0, "", "expected another end than the beginning"}});
  Sweep sweep{field.path, field.unit, {}};
  const double scale = find_unit(field.unit)->to_si;
  for (int i = 0; i < count; ++i) {
    const double si = from + (to - from) * i / (count - 1);
    // 500 nm, not 500.0000000000001 nm.
    sweep.values.push_back(parse_si(fmt::format("{:.12g} {}", si / scale, field.unit), field.unit));
  }
  return sweep;
}

// Throws InputError for each value that makes no design.
void check(const Sweep& sweep, const Design& design) {
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
}

// A voltage or a load that no state exists under has no answer.
int status_of(const Response& response) {
  const bool known =
      std::all_of(response.points.begin(), response.points.end(), [&](const ResponsePoint& p) {
        return response.driven ? p.knows_driven() : p.knows_undriven();
      });
  return known ? kSuccess : kWorkFailed;
}

// What a sweep would leave out.
void require_sweepable(const EvaluateOptions& options) {
  std::vector<std::string> given;
  if (!options.out.empty()) given.push_back("--out");
  if (!options.voltage_for.empty()) given.push_back("--voltage-for");
  if (options.pull_in) given.push_back("--pull-in");
  if (!options.accuracy.empty()) given.push_back("--accuracy");
  if (options.check_field) given.push_back("--check-field");
  if (!given.empty())
    throw InputError("--sweep goes without " + join_names(given) +
                     ": evaluate one value with it, --set PATH=VALUE");
}

int evaluate_sweep(const Context& context, const Sweep& sweep, const Design& design,
                   const Fidelity& fidelity, bool json, bool look, bool model, bool parameters) {
  check(sweep, design);
  std::vector<SweepRun> runs;
  std::optional<Response> first;  // without belief, whose members round in their own way
  bool moved = false;
  int status = kSuccess;
  if (!json) std::cout << sweep_head(sweep.path, look);
  for (const double value : sweep.values) {
    Design changed = design;
    set_number(changed, sweep.path, value);
    Response response = evaluate(scene_of(changed), changed.texture, fidelity);
    set_bridged_margins(response, scene_of(changed), changed.texture);
    if (look) response.appearance = appearance_of(changed);
    if (!first) first = response;
    moved = moved || response.points != first->points ||
            (look && Look(*response.appearance) != Look(*first->appearance));
    status = std::max(status, status_of(response));
    if (model) add_belief(response, scene_of(changed), changed.texture, fidelity);
    if (parameters && response.belief.members.empty())
      add_parameter_errors(response, scene_of(changed), changed.texture, fidelity);
    const std::string shown = format_quantity(value, sweep.unit);
    if (json) {
      context.note(fmt::format("{} = {}", sweep.path, shown));
      runs.push_back({value, std::move(response)});
    } else {
      std::cout << sweep_line(shown, response) << std::flush;
    }
  }
  if (json) std::cout << sweep_json(sweep.path, runs) << '\n';
  if (!moved)
    context.note("warning: " + sweep.path +
                 " moves nothing here: it is the same answer at every value, as where another key "
                 "goes before it (`papilla explain`)");
  return status;
}

// The field rules against the 3-D potential on the first skin, on the pixels of the accuracy level.
std::vector<FieldAccuracyRow> field_check(const Design& design, const Fidelity& fidelity) {
  FieldAccuracyOptions options;
  options.pixels = fidelity.grid;
  options.skin = fidelity.first_skin;
  options.refinements = {1};
  std::vector<FieldAccuracyRow> out = field_accuracy("", design, options);
  std::erase_if(out, [](const FieldAccuracyRow& row) {
    return row.method != "spread" && row.method != "screened";
  });
  return out;
}

std::string field_check_text(const std::vector<FieldAccuracyRow>& rows) {
  std::string out;
  for (const FieldAccuracyRow& row : rows)
    out += fmt::format(
        "pull at {:.4g} % RH {}: {:+.1f} % of the 3-D field's\n", 100 * row.relative_humidity,
        row.method == "spread" ? "with spreading flux" : "by local columns", 100 * row.error);
  return out;
}

// The response with the field check in it.
std::string with_field_check(const std::string& json, const std::vector<FieldAccuracyRow>& rows) {
  auto out = nlohmann::ordered_json::parse(json);
  auto& list = out["field_check"] = nlohmann::ordered_json::array();
  for (const FieldAccuracyRow& row : rows)
    list.push_back({{"relative_humidity", row.relative_humidity},
                    {"rule", row.method == "spread" ? "spread" : "local"},
                    {"error", row.error}});
  return out.dump(2);
}

// What was asked for of a drive that is at 0.
std::string undriven_text(const EvaluateOptions& options) {
  std::vector<std::string> asked;
  if (options.pull_in) asked.emplace_back("--pull-in");
  if (options.check_field) asked.emplace_back("--check-field");
  return asked.empty() ? "" : join_names(asked, " and ") + ": the drive is at 0\n";
}

constexpr double kSecondsBetweenNotes = 10;

// What a Watch of a long evaluation calls after each patch: says now and then how far it is.
class LongEvaluation {
 public:
  explicit LongEvaluation(const Context& context) : context_(context) {}

  void operator()(int patches) {
    const double elapsed = seconds_since(begin_);
    if (elapsed < next_) return;
    next_ = elapsed + kSecondsBetweenNotes;
    context_.note(
        fmt::format("evaluating: {} patches solved in {:.0f} s; papilla explain says how long it "
                    "takes, Ctrl-C ends it without a result",
                    patches, elapsed));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }

  const Context& context_;
  Clock::time_point begin_ = Clock::now();
  double next_ = kSecondsBetweenNotes;
};

int evaluate_file(const Context& context, const EvaluateOptions& options) {
  if (!options.sweep.empty()) require_sweepable(options);
  const Watch watch(LongEvaluation(context), nullptr);
  const Study study = options.design.study();
  const Design& design = study.design;
  if (!options.force) require_fitted_model(design, options.design.file, "run with --force");
  Fidelity fidelity = fidelity_of(design);
  fidelity.threads = options.jobs;
  say_scans({design});
  const bool parameters = options.parameters || design.accuracy.parameters;
  if (!options.sweep.empty()) {
    return evaluate_sweep(context, parse_sweep(options.sweep, design), design, fidelity,
                          options.design.json, options.appearance, !options.no_model, parameters);
  }

  if (!options.out.empty()) make_folder(options.out);
  const Response response = evaluate_design(
      design, {.target = options.accuracy.empty() ? 0 : parse_si(options.accuracy, "%"),
               .model = !options.no_model,
               .parameters = options.parameters,
               .appearance = options.appearance,
               .pull_in = options.pull_in,
               .voltage_for = options.voltage_for,
               .threads = options.jobs});
  for (const std::string& step : response.accuracy.steps) context.note(step);
  if (!options.out.empty()) {
    remove_field_pictures(options.out);
    write_bytes(options.out + "/resolved.toml", resolved_toml(study));
    write_bytes(options.out + "/response.json", response_json(response, false) + "\n");
    write_bytes(options.out + "/response.txt", response_table(response));
    write_bytes(options.out + "/humidity.svg",
                response_svg(response, design.title.empty() ? study.name : design.title));
    write_field_pictures(options.out, design, fidelity);
    context.note("wrote " + options.out);
  }
  const bool check_field = options.check_field && response.driven;
  const auto checked =
      check_field ? field_check(design, fidelity) : std::vector<FieldAccuracyRow>{};
  const std::string undriven = response.driven ? "" : undriven_text(options);
  if (options.design.json) {
    const std::string json = response_json(response);
    std::cout << (options.check_field ? with_field_check(json, checked) : json) << '\n';
    std::cerr << undriven;
  } else {
    context.print(response_table(response));
    std::cout << field_check_text(checked) << undriven;
  }
  return status_of(response);
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
                  "Also the amplitude at which the modulation reaches this value; named again: of "
                  "several")
      .type_name("MODULATION")
      .repeatable()
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
  command.add_flag("--pull-in", options->pull_in,
                   "Also the voltage at which the gap jumps shut, over that of the drive");
  command
      .add_option("--accuracy", options->accuracy,
                  "Wanted standard error of the modulation: grid, samples and estimator follow")
      .type_name("SHARE")
      .check(share_mistake);
  command.add_flag(
      "--model,--parameters", options->parameters,
      "What is not known of the finger: its belief, which is always evaluated where it "
      "names one, else what its fitted numbers (its [[uncertainty]]) leave open");
  command.add_flag("--no-model", options->no_model, "Leave the finger's belief out");
  command.add_option("--jobs", options->jobs, "Threads; 0: all processors").range(0, 4096);
  command.add_flag("--force", options->force,
                   "Run with model options that the finger was not fitted with");
  command.document(
      {"Computes how a finger rubs on a design at each humidity: contact of the layered, rough "
       "skin, "
       "bridges of sweat, the field and its pull, in equilibrium, averaged over patches of skin. "
       "Each "
       "number has a standard error of skins, grids and methods and, where the finger names a "
       "belief, "
       "one of what is not known of finger and model. Points that cannot be trusted say why and "
       "end "
       "with status 1.",
       {{"papilla evaluate m3_samples/a3h600.toml",
         "friction and modulation of a published sample"},
        {"papilla evaluate m3_samples/flat.toml --set drive.amplitude=150V --accuracy \"3 %\"",
         "another voltage, as accurate as asked"},
        {"papilla evaluate m3_samples/a3h600.toml --sweep texture.depth=100nm..600nm:6",
         "over a number of the design"},
        {"papilla evaluate m3_samples/flat.toml --voltage-for 0.5",
         "the voltage that a modulation takes"}},
       {{"DIR/response.json, response.txt, humidity.svg",
         "with --out: the numbers, and friction and modulation over humidity"},
        {"DIR/gap_50.png, gap_50.npy, ...",
         "with --out: gap, pressure, water and pull of one patch at each humidity"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return evaluate_file(context, *options); };
  });
}

}  // namespace papilla::cli
