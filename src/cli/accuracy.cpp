// papilla accuracy [FILE]: speed against error.
#include "report/accuracy.h"

#include <fmt/format.h>

#include <functional>
#include <iostream>
#include <memory>

#include "base/error.h"
#include "base/files.h"
#include "cli/commands.h"
#include "design/study.h"

namespace papilla::cli {
namespace {

struct AccuracyCommand {
  std::string file, out, render;
  std::vector<std::string> overrides;
  int scenes = 0, first_scene = 0, jobs = 0, grid = 128, skins = 16, finest = 512;
  bool no_levels = false, json = false, tight = false;
};

// Error bars on random scenes.
int run_coverage(const AccuracyCommand& c, const std::function<void(const std::string&)>& note) {
  const CoverageOptions options{.scenes = c.scenes,
                                .first = c.first_scene,
                                .tight = c.tight,
                                .threads = c.jobs,
                                .note = note};
  const std::vector<CoverageRow> rows = coverage(options);
  if (!c.out.empty()) {
    make_folder(c.out);
    const Fidelity reference = coverage_reference(options);
    write_bytes(
        c.out + (c.tight ? "/coverage_tight.csv" : "/coverage.csv"),
        coverage_csv(
            rows,
            fmt::format("# papilla {} accuracy --scenes {}{}{}: random scenes; "
                        "reference of {} pixels and {} fresh skins\n",
                        PAPILLA_VERSION, c.scenes, c.tight ? " --tight" : "",
                        c.first_scene > 0 ? fmt::format(" --first-scene {}", c.first_scene) : "",
                        reference.grid, reference.skins)));
  }
  std::cout << (c.json ? coverage_json(rows) + '\n' : coverage_text(rows));
  return kSuccess;
}

// Sweeps on one design, error bars on random scenes, or a page: what another of them takes is no
// option of it.
void require_one_kind(const AccuracyCommand& c) {
  const AccuracyCommand unsaid;
  const bool sweeps = !c.file.empty() || !c.overrides.empty() || c.no_levels ||
                      c.grid != unsaid.grid || c.skins != unsaid.skins || c.finest != unsaid.finest;
  const bool scenes = c.tight || c.first_scene != unsaid.first_scene;
  if (!c.render.empty() && (sweeps || scenes || c.scenes > 0 || c.json || !c.out.empty()))
    throw InputError("--render is the page of tables that are there: it takes no other option");
  if (c.scenes > 0 && sweeps)
    throw InputError(
        "--scenes draws scenes of its own: FILE, --set, --grid, --skins, --finest and --no-levels "
        "are of the sweeps on one design");
  if (c.scenes == 0 && scenes) throw InputError("--tight and --first-scene are of --scenes");
}

int run(const Context& context, const AccuracyCommand& c) {
  require_one_kind(c);
  if (!c.render.empty()) {
    std::cout << accuracy_page(c.render);
    return kSuccess;
  }
  const auto note = [&](const std::string& text) { context.note(text); };
  if (c.scenes > 0) return run_coverage(c, note);
  const std::string file = c.file.empty() ? find_design("m3_samples/a3h350.toml") : c.file;
  const Study study = read_study(file, c.overrides);
  const std::vector<AccuracyRow> rows =
      accuracy_sweeps(study.design, {c.grid, c.skins, c.finest, !c.no_levels, c.jobs, note});
  if (!c.out.empty()) {
    make_folder(c.out);
    write_bytes(
        c.out + "/sweeps.csv",
        accuracy_csv(rows, fmt::format("# papilla {} accuracy {}: base {} pixels, {} skins, solved "
                                       "areas, tolerance 1e-4\n# processor seconds of all threads; "
                                       "pairs and work are the same on every machine\n",
                                       PAPILLA_VERSION, study.name, c.grid, c.skins)));
    std::string last;
    for (const AccuracyRow& row : rows) {
      if (row.sweep != last)
        write_bytes(c.out + "/" + row.sweep + ".svg", accuracy_svg(rows, row.sweep));
      last = row.sweep;
    }
    context.note("wrote " + c.out);
  }
  std::cout << (c.json ? accuracy_json(rows) + '\n' : accuracy_text(rows));
  return kSuccess;
}

}  // namespace

void add_accuracy(Command app, Context& context) {
  Command command = app.add_command(
      "accuracy", "Speed against error: every choice of fidelity swept on one design");
  auto c = std::make_shared<AccuracyCommand>();
  command.add_option("file", c->file, "Design; default: m3_samples/a3h350.toml").type_name("FILE");
  add_set_option(command, c->overrides);
  command.add_option("--out", c->out, "Also write the tables and plots").type_name("DIR");
  command.add_option("--grid", c->grid, "Pixels of the base").range(16, 4096);
  command.add_option("--skins", c->skins, "Skins of the base").range(2, 100000);
  command.add_option("--finest", c->finest, "Pixels of the finest grid").range(32, 4096);
  command.add_flag("--no-levels", c->no_levels, "Leave out the levels (reference takes minutes)");
  command
      .add_option("--scenes", c->scenes,
                  "Instead: error bars against a finer reference on that many random scenes")
      .range(1, 100000);
  command.add_flag("--tight", c->tight,
                   "Of --scenes: the level design and a target of 2 % against the level reference");
  command.add_option("--first-scene", c->first_scene, "Number of the first of them")
      .range(0, 1000000000);
  command.add_flag("--json", c->json, "One JSON object on standard output");
  command.add_option("--render", c->render, "Instead: the page of the tables in that folder")
      .type_name("DIR");
  command.add_option("--jobs", c->jobs, "Threads; 0: all processors").range(0, 4096);
  command.document(
      {"Sweeps each choice of fidelity on one design and tells error against processor time; with "
       "--scenes holds the stated error bars against finer references on random scenes.",
       {{"papilla accuracy --no-levels --out results/sweeps", "the sweeps without the slow level"},
        {"papilla accuracy --scenes 20 --first-scene 5000",
         "do bars hold on scenes that nobody has seen"}},
       {{"DIR/*.csv, *.svg", "with --out: tables and plots"}}});
  command.on_chosen([&context, c] { context.action = [&context, c] { return run(context, *c); }; });
}

}  // namespace papilla::cli
