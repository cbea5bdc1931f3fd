// papilla reproduce: every published claim beside the model's number.
#include "claims/reproduce.h"

#include <fmt/format.h>
#include <omp.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/watch.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "design/design.h"
#include "report/claims.h"
#include "report/figures.h"

namespace papilla::cli {
namespace {

struct ReproduceCommand {
  std::vector<std::string> claims;
  std::string finger, out;
  int jobs = 0;
  bool json = false, figures = false;
};

// Of what is left, at the speed so far; at first that of a usual machine.
class TimeLeft {
 public:
  explicit TimeLeft(int threads) : threads_(threads > 0 ? threads : omp_get_max_threads()) {}

  std::string said(double usual) {
    const auto now = std::chrono::steady_clock::now();
    if (!begun_) {
      begun_ = now;
      all_ = usual;
      return fmt::format("about {} on {}", duration(usual / threads_), counted(threads_, "thread"));
    }
    const double taken = std::chrono::duration<double>(now - *begun_).count();
    return "about " + duration(taken * usual / (all_ - usual));
  }

 private:
  int threads_;
  std::optional<std::chrono::steady_clock::time_point> begun_;
  double all_ = 0;
};

void write_figures(const Context& context, const ReproduceCommand& command, const Finger& finger) {
  FigureOptions options;
  options.finger = finger;
  options.threads = command.jobs;
  options.claims = command.claims;
  options.started = [&](const std::string& sample) { context.note("figures: " + sample + " ..."); };
  const FigureTables tables = figure_tables(options);
  write_bytes(command.out + "/figures.csv", figures_csv(tables));
  write_bytes(command.out + "/figures.md", figures_markdown(tables, finger.name));
}

int run(const Context& context, const ReproduceCommand& command) {
  if (command.figures && command.out.empty())
    throw InputError("--figures needs --out DIR, the folder of figures.csv and figures.md");
  if (!command.out.empty()) make_folder(command.out);
  ReproduceOptions options;
  options.ids = command.claims;
  options.finger =
      read_finger(command.finger.empty() ? find_design("fingers/reference.toml") : command.finger);
  options.threads = command.jobs;
  options.folder = command.out;
  TimeLeft left(command.jobs);
  options.begun = [&](const Claim& claim, double usual) {
    if (usual_seconds(claim) == 0) return;
    context.note(fmt::format("{}: {} left", claim.id, left.said(usual)));
  };
  options.done = [&](const ClaimResult& r) {
    if (usual_seconds(*r.claim) > 0)
      context.note(r.claim->id + ": " + verdict_name(r.papilla.verdict));
  };
  const Interruptible interrupt;
  const Watch watch({}, &interrupt.asked());
  std::vector<ClaimResult> results;
  try {
    results = reproduce(options);
  } catch (const WorkStopped&) {
    context.note(command.out.empty()
                     ? std::string("interrupted; with --out what has been judged would be kept")
                     : "interrupted; what has been judged is kept in " + command.out +
                           ", the same command goes on");
    return interrupt.status();
  }
  if (!command.out.empty()) {
    write_bytes(command.out + "/claims.csv", claims_csv(results));
    write_bytes(command.out + "/claims.md", claims_markdown(results, options.finger.name));
    context.note("wrote " + command.out);
  }
  if (command.json)
    std::cout << claims_json(results) << '\n' << std::flush;
  else
    context.print(claims_text(results));
  if (!command.figures) return kSuccess;
  try {
    write_figures(context, command, options.finger);
  } catch (const WorkStopped&) {
    context.note("interrupted; the claims are judged, the same command goes on with the figures");
    return interrupt.status();
  }
  return kSuccess;
}

}  // namespace

void add_reproduce(Command app, Context& context) {
  Command command =
      app.add_command("reproduce", "Every published claim beside the model, with a verdict");
  auto options = std::make_shared<ReproduceCommand>();
  command.add_option("--claim", options->claims, "Only this claim, e.g. M13; may be repeated")
      .type_name("ID")
      .repeatable();
  command.add_option("--finger", options->finger, "Finger file; default: fingers/reference.toml")
      .type_name("FILE");
  command
      .add_option("--out", options->out,
                  "Also write claims.csv and claims.md; what an interrupted run has judged is kept "
                  "there")
      .type_name("DIR");
  command.add_flag(
      "--figures", options->figures,
      "Also the M3 paper's figures as tables: figures.csv and figures.md in --out; with "
      "--claim the numbers that the paper prints for it alone");
  command.add_option("--jobs", options->jobs, "Threads; 0: all processors").range(0, 4096);
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.document(
      {"Judges every claim of the published papers beside the model, each with its number, error "
       "and "
       "verdict; which were fitted and which are identities is said. With --figures also the "
       "tables of the "
       "papers' figures, with the deviation and its uncertainty as ASME V&V 20 has them.",
       {{"papilla reproduce", "all claims: minutes"},
        {"papilla reproduce --claim M13 --claim M4", "two of them"},
        {"papilla reproduce --figures --out results/mine", "with the figures"}},
       {{"DIR/claims.csv, claims.md, figures.csv, figures.md", "with --out"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return run(context, *options); };
  });
}

}  // namespace papilla::cli
