// papilla rank: candidates in order, with intervals and the probability of being best.
#include "rank/rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <system_error>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/scan_options.h"
#include "design/scans.h"
#include "design/title.h"
#include "estimate/evaluation.h"
#include "geometry/io/files.h"
#include "rank/conditions.h"
#include "report/ranking.h"

namespace papilla::cli {
namespace {

struct RankCommand {
  std::vector<std::string> files, overrides;
  std::string base, by, weights, states, out;
  int max_skins = 96, jobs = 0;
  bool json = false, parameters = false, no_parameters = false, any_conditions = false,
       force = false;
};

std::vector<FingerState> parse_states(const std::string& text) {
  std::vector<FingerState> out;
  for (const std::string& word : split(text, ',')) {
    const auto& names = finger_state_names();
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end())
      throw InputError("\"" + word + "\" is no finger state; use " + join_names(names));
    out.push_back(static_cast<FingerState>(found - names.begin()));
  }
  return out;
}

std::vector<double> parse_weights(const std::string& text) {
  std::vector<double> out;
  for (const std::string& word : split(text, ',')) out.push_back(parse_si(word, ""));
  return out;
}

bool is_design(const std::string& file) {
  return std::filesystem::path(file).extension() == ".toml";
}

// A+B are regions of one candidate, where no file has that name.
std::vector<std::string> regions_named(const std::string& name) {
  std::error_code missing;
  if (std::filesystem::exists(own_or_shipped(map_name(name).file), missing)) return {name};
  return split(name, '+');
}

// Throws InputError for options that nothing here would obey.
void check(const RankCommand& command) {
  if (command.files.size() < 2) throw InputError("name two designs at least");
  if (command.parameters && command.no_parameters)
    throw InputError("--parameters and --no-parameters: give one of them");
  if (command.base.empty()) return;
  for (const std::string& file : command.files) {
    for (const std::string& region : regions_named(file)) {
      if (!is_design(region)) return;
    }
  }
  throw InputError("--base is for scans, and every candidate is a design (.toml) of its own");
}

// A region by its file: a design, or a scan that becomes the texture of the base.
Design read_region(const std::string& file, const RankCommand& command) {
  const bool design = is_design(file);
  if (!design && command.base.empty()) {
    throw InputError("\"" + file +
                     "\" is no design (.toml); scans are put into one: --base COMMON.toml, with "
                     "the coating, the finger and its air");
  }
  Design out = design ? read_design(file, command.overrides)
                      : read_design(command.base, scan_as_texture(file, command.overrides));
  out.title = title_as_set(out, command.overrides);
  return out;
}

// File stems, of the first region and how many more there are; with the folder where stems repeat.
std::vector<std::string> short_names(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const std::vector<std::string> regions = regions_named(file);
    names.push_back(std::filesystem::path(regions.front()).stem().string());
    if (regions.size() > 1) names.back() += fmt::format(" and {} more", regions.size() - 1);
  }
  const std::vector<std::string> stems = names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::count(stems.begin(), stems.end(), stems[i]) > 1) names[i] = files[i];
  }
  return names;
}

int run(const Context& context, const RankCommand& command) {
  check(command);
  std::vector<Regions> candidates;
  std::vector<Design> designs;
  std::vector<std::vector<std::string>> seen;
  Mistakes mistakes;
  for (const std::string& file : command.files) {
    Regions regions;
    seen.emplace_back();
    for (const std::string& region : regions_named(file)) {
      if (region.empty()) {
        throw InputError("\"" + file +
                         "\": A.toml+B.toml joins the regions of one design, and a name is missing "
                         "beside a +");
      }
      mistakes.of([&] { regions.push_back(read_region(region, command)); });
      seen.back().push_back(std::filesystem::weakly_canonical(region).string());
    }
    if (std::count(seen.begin(), seen.end(), seen.back()) > 1)
      throw InputError("\"" + file + "\" is named twice: it cannot be better than itself");
    designs.insert(designs.end(), regions.begin(), regions.end());
    candidates.push_back(std::move(regions));
  }
  mistakes.tell();
  say_scans(designs);
  RankOptions options;
  const bool driven =
      std::all_of(designs.begin(), designs.end(), [](const Design& d) { return d.drive.driven(); });
  options.criteria = parse_criteria(!command.by.empty() ? command.by
                                    : driven            ? "modulation:high"
                                                        : "friction:low,adhesion:low");
  options.states = command.states.empty() ? std::vector<FingerState>{common_state(candidates)}
                                          : parse_states(command.states);
  if (options.felt() && !command.force) require_fitted_model(designs, "", "run with --force");
  options.max_skins = command.max_skins;
  options.threads = command.jobs;
  if (!command.weights.empty()) options.weights = parse_weights(command.weights);
  const std::string unknown = parameters_unknown(candidates);
  const bool asked =
      command.parameters || std::any_of(designs.begin(), designs.end(),
                                        [](const Design& d) { return d.accuracy.parameters; });
  options.parameters = !command.no_parameters && (asked || unknown.empty());
  if (options.felt() && !options.parameters && !unknown.empty())
    context.note("what the fit of the finger leaves open is in no probability: " + unknown);
  options.note = [&](const std::string& text) { context.note(text); };
  options.any_conditions = command.any_conditions;
  const std::vector<std::string> names = options.names = short_names(command.files);
  const Ranking ranking = ranking_of(candidates, options);
  if (!command.out.empty()) {
    write_ranking(command.out, candidates, names, options, ranking);
    context.note("wrote " + command.out);
  }
  if (command.json)
    std::cout << ranking_json(names, options, ranking) << '\n';
  else
    context.print(ranking_table(names, options, ranking));
  return kSuccess;
}

}  // namespace

void add_rank(Command app, Context& context) {
  Command command = app.add_command(
      "rank", "Designs in order, by paired differences, with the probability of being best");
  auto options = std::make_shared<RankCommand>();
  command
      .add_option("designs", options->files,
                  "DESIGN.toml of each candidate, or with --base a scan; A+B: regions of one")
      .required();
  command
      .add_option("--base", options->base,
                  "DESIGN.toml that candidates which are scans are put into, as its texture")
      .type_name("FILE");
  command
      .add_option("--by", options->by,
                  "Criteria, e.g. friction:low,variation(modulation):low; default modulation:high, "
                  "or friction:low,adhesion:low without a drive")
      .type_name("METRIC[:low|:high],...");
  command
      .add_option(
          "--weights", options->weights,
          "What each criterion counts in one score, e.g. 2,1; without them several criteria "
          "have no single order: who is beaten in all, and who is best in each")
      .type_name("NUMBER,...");
  command.add_option("--state", options->states, "Finger states: clean,natural,wet")
      .type_name("STATE,...");
  command.add_option("--max-skins", options->max_skins, "Most skins per candidate and state")
      .range(RankOptions{}.batch, kMostSkins);
  command.add_flag("--parameters", options->parameters,
                   "Insist on what the finger's fitted numbers (its [[uncertainty]]) leave of each "
                   "value and difference: in every interval and probability where it is known");
  command.add_flag("--no-parameters", options->no_parameters, "Leave that out");
  command.add_flag("--any-conditions", options->any_conditions,
                   "Also designs of different finger, air, drive or accuracy: the order is then "
                   "not of the surfaces alone");
  command.add_flag("--force", options->force,
                   "Rank with model options that the finger was not fitted with");
  command.add_option("--out", options->out, "Also write table, CSV, JSON, designs and report.html")
      .type_name("DIR");
  command.add_option("--jobs", options->jobs, "Threads; 0: all processors").range(0, 4096);
  add_set_option(command, options->overrides);
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.document(
      {"Evaluates candidates on common skins and orders them by paired differences, until the "
       "order "
       "is told apart or the largest number of skins is reached. Says the probability of being "
       "best, "
       "ties as ties, and of several criteria without weights which designs no other beats in all.",
       {{"papilla rank coatings/hdpe_small_1.toml coatings/hdpe_large_1.toml --by friction:low "
         "--state clean,natural",
         "two coatings, two states of the finger"},
        {"papilla rank m3_samples/a3h350.toml m3_samples/a3h600.toml --weights 1 --by "
         "modulation:high",
         "one score"}},
       {{"DIR/ranking.csv, ranking.json, report.html", "with --out"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return run(context, *options); };
  });
}

}  // namespace papilla::cli
