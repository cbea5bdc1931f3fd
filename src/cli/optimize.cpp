// papilla optimize STUDY.toml: searches the design space, writes a folder of results.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/look_time.h"
#include "cli/scan_options.h"
#include "optim/mpi.h"
#include "optim/search.h"
#include "report/limits.h"
#include "report/remarks.h"
#include "report/results.h"
#include "report/summary.h"
#include "search/levels.h"

namespace papilla::cli {
namespace {

struct OptimizeOptions {
  std::string study, out, time, method, pick;
  std::vector<std::string> overrides;
  bool resume = false, finish = false, force = false, json = false;
  int jobs = 0, evaluations = 0, seed = -1;
};

// A bar and a text in the columns of a terminal line.
std::string terminal_line(double share, const std::string& text) {
  constexpr int kBar = 12;
  constexpr std::size_t kColumns = 79;  // the last one would wrap
  const int full = static_cast<int>(share * kBar);
  std::string line;
  for (int i = 0; i < kBar; ++i) line += i < full ? "█" : "░";
  line += ' ';
  for (const std::string& word : split(text, ' ')) {
    if (text_width(line) + text_width(word) + 2 > kColumns) return line + "…";
    line += word.empty() ? "" : word + ' ';
  }
  return line;
}

// A bar on a terminal, one line per tenth of the way otherwise.
class ProgressPrinter {
 public:
  explicit ProgressPrinter(const Context& context)
      : context_(context), terminal_(::isatty(STDERR_FILENO) != 0) {}

  void show(const Progress& p) {
    if (context_.quiet) return;
    const double part = p.total > 0 ? static_cast<double>(p.done) / p.total : 0;
    std::string text = fmt::format("{:<7} {:>3}/{}", p.stage, p.done, p.total);
    // Before what may be cut off.
    if (p.seconds_left >= 0) text += "  " + duration(p.seconds_left) + " left";
    if (!p.best.empty()) text += "  " + p.best;
    if (terminal_) {
      std::cerr << "\r\033[K" << terminal_line(p.seconds_left >= 0 ? p.share : 0, text)
                << std::flush;
      open_line_ = true;
      return;
    }
    const int tenth = static_cast<int>(10 * part);
    if (p.stage == stage_ && tenth == tenth_) return;
    stage_ = p.stage;
    tenth_ = tenth;
    std::cerr << text << std::endl;
  }

  void finish() {
    if (open_line_) std::cerr << std::endl;
    open_line_ = false;
  }

 private:
  const Context& context_;
  bool terminal_, open_line_ = false;
  std::string stage_;
  int tenth_ = -1;
};

nlohmann::ordered_json result_json(const OptimiseResult& r, const StudyProblem& problem,
                                   const std::string& folder, const Study& study) {
  using Json = nlohmann::ordered_json;
  Json out{{"schema", 1},
           {"folder", folder},
           {"method", r.method},
           {"why", r.why},
           {"evaluations", r.evaluations},
           {"asked", r.asked},
           {"failures", r.failures},
           {"remarks", run_remarks(study, problem, r)},
           {"interrupted", r.interrupted},
           {"feasible", r.any_feasible}};
  const auto score = [&](const Score& s) {
    Json j = Json::object();
    for (std::size_t k = 0; k < s.values.size(); ++k) {
      const auto parameters = parameter_error(s, k);
      j[problem.objectives()[k].name] = {{"value", s.values[k]},
                                         {"se", s.errors[k]},
                                         {"parameters", parameters ? Json(*parameters) : Json()}};
    }
    j["worst_modulation"] = s.ok && problem.judged_at_amplitude() ? Json(s.worst) : Json(nullptr);
    return j;
  };
  out["designs"] = Json::array();
  for (const FinalDesign& d : r.finalists) {
    Json variables = Json::object();
    const std::vector<double> values = problem.space().value(d.unit);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Variable& v = study.variables[i];
      if (!is_shown(problem, d.design, i)) continue;
      variables[v.path] = v.is_kind() ? Json(variable_text(v, values[i])) : Json(values[i]);
    }
    out["designs"].push_back({{"folder", d.folder},
                              {"on_front", d.on_front},
                              {"feasible", d.feasible},
                              {"limits", limits_json(limit_values(problem, d))},
                              {"variables", variables},
                              {"objectives", score(d.confirmed)}});
  }
  if (r.flat) out["flat"] = score(*r.flat);
  if (r.flat_before) out["flat_before"] = score(*r.flat_before);
  out["best"] = r.finalists.empty() ? Json(nullptr) : Json(r.best);
  out["recommendation"] = recommendation_of(folder);
  return out;
}

// As a shell reads it back.
std::string shell_word(const std::string& word) {
  if (!word.empty() && word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                              "0123456789_./+-=,:%@") == std::string::npos)
    return word;
  std::string out = "'";
  for (char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// The command that goes on where this one stopped.
std::string resume_command(const OptimizeOptions& options, const std::string& folder) {
  std::string out = "papilla optimize " + shell_word(options.study) + " --out " +
                    shell_word(folder) + " --resume";
  const auto add = [&out](const char* name, const std::string& value) {
    if (!value.empty()) out += std::string(" ") + name + " " + shell_word(value);
  };
  if (options.finish) out += " --finish";
  if (options.force) out += " --force";
  if (options.jobs > 0) add("--jobs", std::to_string(options.jobs));
  if (options.evaluations > 0) add("--evaluations", std::to_string(options.evaluations));
  add("--time", options.time);
  if (options.seed >= 0) add("--seed", std::to_string(options.seed));
  add("--method", options.method);
  add("--pick", options.pick);
  for (const std::string& setting : options.overrides) add("--set", setting);
  return out;
}

// What the search will take: its price at the machine's pace, over as many tasks as are evaluated
// at a time.
std::string price_text(const Context& context, const StudyProblem& problem) {
  const Study& study = problem.study();
  const StudyCost cost = study_cost(problem);
  const int processors = processors_for(study);
  const double seconds = search_pace(problem) * cost.seconds / processors,
               looks =
                   timed_look(context, problem) * static_cast<double>(cost.looked_at) / processors;
  std::string out =
      fmt::format("expected: {} to {} on {}, for {}", duration(kLeastOfPrice * seconds + looks),
                  duration(kMostOfPrice * seconds + looks), counted(processors, "processor"),
                  counted(cost.evaluations, "evaluation"));
  if (study.search.time > 0)
    out += fmt::format("; the clock ends it after {}", duration(study.search.time));
  return out;
}

void check_time(const std::string& time) {
  if (time.empty()) return;
  double seconds = 0;
  try {
    seconds = parse_si(time, "min");
  } catch (const InputError& error) {
    throw InputError(std::string("--time: ") + error.what());
  }
  if (!(seconds > 0)) throw InputError("--time: expected more than 0 min, got " + time);
}

// What decides the result stands in resolved.toml, whichever option said it.
std::vector<std::string> all_overrides(const OptimizeOptions& options) {
  check_time(options.time);
  std::vector<std::string> out = options.overrides;
  if (options.evaluations > 0)
    out.push_back(fmt::format("search.evaluations={}", options.evaluations));
  if (options.seed >= 0) out.push_back(fmt::format("search.seed={}", options.seed));
  if (!options.time.empty()) out.push_back("search.time=" + options.time);
  if (!options.method.empty()) out.push_back("search.method=" + options.method);
  return out;
}

int optimize(const OptimizeOptions& options, const Context& context) {
  const auto begin = std::chrono::steady_clock::now();
  if (launched_rank() > 0) {  // of an MPI job: one voice is enough
    [[maybe_unused]] const auto* out = std::freopen("/dev/null", "w", stdout);
    [[maybe_unused]] const auto* err = std::freopen("/dev/null", "w", stderr);
  }
  if (options.finish && !options.resume)
    throw InputError("--finish goes on with a run that was interrupted: add --resume");
  Study study = read_study(options.study, all_overrides(options));
  say_scans({study.design});
  for (const std::string& said : unused_of(study)) context.note("warning: " + said);
  if (options.jobs > 0) study.search.jobs = options.jobs;  // decides nothing

  OptimiseOptions run;
  run.folder = options.out.empty() ? "results/" + study.name : options.out;
  run.resume = options.resume;
  run.finish = options.finish;
  const Interruptible interrupt;
  run.stop = &interrupt.asked();
  run.pick = options.pick;
  ProgressPrinter printer(context);
  run.progress = [&](const Progress& p) { printer.show(p); };

  const StudyProblem problem(study);
  if (!options.force) require_fitted_fingers(problem, options.study, "run with --force");
  context.note(
      "search: many designs quickly; narrow: the best and their neighbours again, more precisely; "
      "confirm: the finalists at the study's accuracy; belief: what is not known of finger and "
      "model; check: without texture, other models, tolerances");
  if (!run.resume) {
    for (const std::string& said : study_warnings(problem)) context.note("warning: " + said);
    if (!context.quiet) context.note(price_text(context, problem));
  }
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  run.spent = seconds();
  const OptimiseResult result = optimise_to_folder(study, run);
  if (launched_rank() > 0) return kSuccess;
  printer.finish();
  if (options.json) {
    std::cout << result_json(result, problem, run.folder, study).dump(2) << '\n';
  } else if (!result.interrupted) {
    std::string text = result_table(study, result);
    if (std::filesystem::exists(run.folder + "/best/mask.tif")) {
      text += fmt::format(
          "\nIn best/mask.tif white is deep; `papilla export {} --format mask --polarity "
          "white-high` "
          "writes the other.\n",
          shell_word(run.folder));
    }
    if (const std::string advice = recommendation_of(run.folder); !advice.empty())
      text += "\n" + advice + "\n";
    context.print(text);
  }
  if (result.lost > 0) {
    context.note(
        fmt::format("{} of {}/journal could not be read any more and was done again; {} is the "
                    "journal as it was",
                    counted(result.lost, "record"), run.folder, result.kept_copy));
  }
  if (!result.interrupted) {
    for (const std::string& remark : run_remarks(study, problem, result))
      context.note("warning: " + remark);
  }
  if (result.interrupted) {
    context.note("interrupted; continue with: " + resume_command(options, run.folder));
    return interrupt.status();
  }
  const std::string best =
      result.any_feasible ? "report.html, summary.md, pareto.csv, best/ is what to build"
      : result.has_best()
          ? "report.html, summary.md, pareto.csv, best/ is what comes nearest to the limits"
          : "summary.md, pareto.csv, history.csv";
  context.note(fmt::format("{} in {:.0f} s; results in {}/ ({})",
                           counted(result.evaluations, "evaluation"), seconds(), run.folder, best));
  if (!result.any_feasible) {
    context.note(result.finalists.empty()
                     ? "no design could be evaluated; history.csv says why for each"
                     : "no design keeps every constraint: " + infeasible_text(result) +
                           "; summary.md shows the one that comes nearest");
    return kWorkFailed;
  }
  return kSuccess;
}

}  // namespace

void add_optimize(Command app, Context& context) {
  Command command =
      app.add_command("optimize", "Search the design space of a study; write results/<study>/");
  auto options = std::make_shared<OptimizeOptions>();
  command.add_option("study", options->study, "STUDY.toml, a design with a [design_space]")
      .required();
  command.add_option("--out", options->out, "Folder of results; default results/<study>")
      .type_name("DIR");
  command.add_flag("--resume", options->resume, "Continue an interrupted run of the same study");
  command.add_flag("--finish", options->finish,
                   "With --resume: stop searching; confirm and report the designs found");
  command.add_option("--jobs", options->jobs, "Evaluations at a time; default: one per processor")
      .range(1, 4096);
  command.add_option("--evaluations", options->evaluations, "Largest number of evaluated designs")
      .range(1, 100000000);
  command.add_option("--time", options->time, "Largest wall-clock time, e.g. \"5 min\"");
  command.add_option("--seed", options->seed, "Seed of the search and of the skins")
      .range(0, 1 << 30);
  command.add_option("--method", options->method,
                     "auto, bayesian, nsga2, cmaes, bobyqa, sbplx, direct, least_squares");
  add_pick_option(command, options->pick);
  add_set_option(command, options->overrides);
  command.add_flag("--force", options->force,
                   "Search with model options that the finger was not fitted with");
  command.add_flag("--json", options->json, "The result as one JSON object on standard output");
  command.document(
      {"A study is a design with a section [design_space]: which numbers and kinds may "
       "change, what is wanted and what has to hold. The search evaluates designs, confirms the "
       "best "
       "on skins that it has not seen, checks whether their order holds under other fingers, airs "
       "and "
       "choices of the model, and recommends one, rounded to the grid of the fab. Ctrl-C keeps "
       "what "
       "is evaluated; --resume goes on. Under mpirun the ranks share the work.",
       {{"papilla optimize electroadhesive_glass/study.toml",
         "kind, slopes, film and finish of an electroadhesive screen"},
        {"papilla optimize m3_glass/study.toml --time \"2 min\" --seed 7",
         "another search, ended by the clock"},
        {"papilla optimize m3_glass/study.toml --resume --finish",
         "judge what an interrupted run found and report it"}},
       {{"results/STUDY/summary.md, report.html",
         "what to build, how sure that is, the front, what was checked"},
        {"results/STUDY/best, front/NN", "designs with numbers, heightmaps and masks"},
        {"results/STUDY/pareto.csv, history.csv, run.json",
         "every finalist, every evaluation, the recommendation"},
        {"results/STUDY/journal", "what a run that is resumed goes on from"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return optimize(*options, context); };
  });
}

}  // namespace papilla::cli
