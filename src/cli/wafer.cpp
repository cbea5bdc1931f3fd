// papilla wafer LIST.toml|STUDY.toml|RESULTS: a test wafer with its masks and its manifest.
#include "report/wafer.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/file_work.h"
#include "report/limits.h"

namespace papilla::cli {
namespace {

struct WaferCommand {
  std::string path, out = "results/wafer";
  std::vector<std::string> overrides;
  bool no_expected = false, no_model = false, json = false;
};

// A wafer is drawn whatever the model; what is expected of it is another matter.
std::vector<std::string> unfitted_lines(const WaferPlan& plan) {
  std::vector<std::string> out;
  for (const Treatment& t : plan.treatments) {
    for (const std::string& line : calibration_mismatch(t.design)) {
      const std::string said = "warning: what is expected is off by tens of percent: " + line;
      if (std::find(out.begin(), out.end(), said) == out.end()) out.push_back(said);
    }
  }
  return out;
}

int make_wafer(const Context& context, const WaferCommand& command) {
  const DesignUse use = command.no_expected ? DesignUse::Drawn : DesignUse::Simulated;
  WaferPlan plan = plan_wafer(command.path, command.overrides, use);
  if (const std::string none = none_keeps_text(command.path); !none.empty())
    plan.notes.push_back("warning: " + none);
  if (!command.no_expected) {
    for (std::string& line : unfitted_lines(plan)) plan.notes.push_back(std::move(line));
  }
  check_conditions(plan, use);
  const WaferDrawing drawing = draw_wafer(plan);
  std::vector<std::string> files;
  std::vector<WaferMade> made;
  {
    FileWork work(context, "working out");
    const Expectations expected =
        command.no_expected ? Expectations{} : expect(plan, !command.no_model, work.progress());
    for (const std::string& line : breakdown_lines(plan, expected))
      plan.notes.push_back("warning: " + line);
    files = write_wafer(plan, drawing, expected, command.out);
    files.push_back(command.out + "/wafer.svg");
    write_bytes(files.back(), wafer_svg(plan));
    work.progress()("what the process makes of " + command.out, 0);
    made = made_of_wafer(drawing, drawing.layout, plan.list.process);
  }
  for (const std::string& left : left_lines(made))
    std::cerr << "warning: " << visible(left) << '\n';
  std::cout << (command.json ? wafer_json(plan, drawing, files, made) + '\n'
                             : visible(wafer_text(plan, drawing, files, made)));
  return kSuccess;
}

}  // namespace

void add_wafer(Command app, Context& context) {
  Command command = app.add_command(
      "wafer", "A test wafer: fields of designs, controls, labels, masks, what to measure where");
  auto options = std::make_shared<WaferCommand>();
  command
      .add_option("path", options->path,
                  "List of designs, a study (its design and its variables at their ends), or a "
                  "folder of results (its front)")
      .required()
      .type_name("LIST|STUDY|RESULTS");
  add_set_option(command, options->overrides);
  command.add_option("--out", options->out, "Folder of the wafer").show_default().type_name("DIR");
  command.add_flag("--no-expected", options->no_expected,
                   "Evaluate no design: the manifest does not say what is expected");
  command.add_flag("--no-model", options->no_model,
                   "Errors of what is expected without what is not known of the finger");
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.document(
      {"Draws a test wafer or die: fields of designs with labels for a microscope, flat and "
       "repeated "
       "controls, repeats in randomised blocks, marks; one mask for each depth, drawn so that the "
       "process of [process] makes the wanted surface. The manifest says which design stands "
       "where, "
       "what is to be measured on it and what is expected.",
       {{"papilla wafer m3_glass/study.toml --set wafer.repeats=3 --no-expected",
         "the study's design and each end of its design space"},
        {"papilla wafer results/study --out results/wafer", "the front that a search found"}},
       {{"DIR/wafer.gds, wafer.oas", "the same polygons, by hierarchy"},
        {"DIR/manifest.csv, designs/*.toml", "fields, conditions to measure, what is expected"},
        {"DIR/wafer.svg, wafer.toml", "a map; the file that makes the folder again"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return make_wafer(context, *options); };
  });
}

}  // namespace papilla::cli
