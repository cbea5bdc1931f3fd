// papilla next: which measurement settles a decision, and when none does any more.
#include <iostream>
#include <memory>
#include <vector>

#include "base/text.h"
#include "base/units.h"
#include "base/watch.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "report/lab_folder.h"

namespace papilla::cli {
namespace {

struct NextCommand {
  NextRun run;
  std::string aim, time;
  bool json = false, show = false;
  std::vector<Option> of_plan;  // that --show does not obey
};

int plan_next(const Context& context, NextCommand command) {
  NextRun& run = command.run;
  const auto note = [&](const std::string& text) { context.note(text); };
  if (command.show) {
    if (run.source.paths.size() != 1) throw InputError("--show: name one lab");
    for (const Option& option : command.of_plan) {
      if (option.given())
        throw InputError(option.name() + " is of a plan, and --show makes none: leave one out");
    }
    const NextReport state = lab_state(run.source.paths.front(), run.threads);
    if (command.json)
      std::cout << state.json << '\n';
    else
      context.print(state.markdown);
    return kSuccess;
  }
  for (std::size_t k = 0; k < aim_names().size(); ++k) {
    if (aim_names()[k] == command.aim) run.options.aim = static_cast<Aim>(k);
  }
  if (!command.time.empty()) {
    run.options.seconds = parse_si(command.time, "min");
    if (!(run.options.seconds > 0))
      throw InputError("--time: \"" + command.time + "\": expected more than 0 min");
  }
  if (run.options.date.empty()) run.options.date = today();
  run.note = note;
  const Interruptible interrupt;
  const Watch watch({}, &interrupt.asked());
  try {
    const NextReport report = next_in_lab(run);
    if (command.json)
      std::cout << report.json << '\n';
    else
      context.print(report.markdown);
    context.note("lab: " + report.folder);
  } catch (const WorkStopped&) {
    context.note("interrupted; what the model has answered is kept, the same command goes on");
    return interrupt.status();
  }
  return kSuccess;
}

}  // namespace

void add_next(Command app, Context& context) {
  Command command = app.add_command(
      "next", "Which measurement settles a decision: a batch to make, why, and when to stop");
  auto options = std::make_shared<NextCommand>();
  LabSource& source = options->run.source;
  command
      .add_option("source", source.paths,
                  "A folder of results, a wafer's manifest.csv, designs, a calibration, or a lab")
      .required()
      .type_name("RESULTS|CALIBRATION|FOLDER");
  options->of_plan = {
      command.add_option("--lab", options->run.folder, "Folder of a new lab; else below labs/")
          .type_name("DIR"),
      command
          .add_option("--for", options->aim, "What the batch is for; else what there is to settle")
          .one_of(aim_names()),
      command.add_option("--count", options->run.options.count, "Touches, at most")
          .range(1, 1000)
          .show_default(),
      command.add_option("--time", options->time, "Work that the batch may take, \"240 min\""),
      command.add_option("--belief", source.belief, "Belief file; else that of the designs' finger")
          .type_name("FILE"),
      command.add_option("--worth", source.worth, "Metric that designs are compared by"),
      command.add_option("--load", source.load, "Loads that can be set, \"0.1 N,0.3 N\""),
      command.add_option("--humidity", source.humidity,
                         "Humidities that can be set, \"15 %,75 %\""),
      command.add_option("--voltage", source.voltage, "Peak voltages, \"0 V,100 V\""),
      command.add_option("--frequency", source.frequency,
                         "Frequencies of the carrier that can be set, \"5 kHz\""),
      command.add_option("--state", source.states, "States of the finger, \"clean,natural\""),
      command
          .add_option("--set", source.values,
                      "Value of a new lab.toml, \"instrument.repeatability=2 %\"")
          .type_name("KEY=VALUE")
          .repeatable(),
      command.add_option("--finger", options->run.options.finger, "Whose finger will be measured")
          .show_default(),
      command.add_option("--day", options->run.options.day,
                         "Day of the measurements; else the date"),
      command.add_option("--date", options->run.options.date,
                         "Date that the journal says; else today")};
  command.add_option("--jobs", options->run.threads, "Threads; 0: all processors").range(0, 4096);
  command.add_flag("--show", options->show, "Where a lab stands, without planning");
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.document(
      {"Plans the few measurements that settle a decision: designs at loads, humidities, voltages "
       "and "
       "states of the finger, chosen by how far they lower the expected regret of the choice, tell "
       "hypotheses apart or shrink parameters, by the members of a belief. Says why, what each "
       "outcome would change and when to stop. A lab is one folder that remembers everything.",
       {{"papilla next results/study",
         "open a lab for the finalists of a run, with its first batch"},
        {"papilla next m3_samples/a3h600.toml m3_samples/a4h600.toml m3_samples/flat.toml --belief "
         "fingers/belief.toml",
         "of designs without a run"},
        {"papilla next labs/study --count 6", "the next batch of a lab"}},
       {{"LAB/lab.toml", "what can be set at the bench, how the instrument scatters: change it"},
        {"LAB/plan_NN.csv", "a batch as a table to fill in"},
        {"LAB/lab.md, lab.json, decisions.svg", "where the decision stands"},
        {"LAB/belief.toml", "the members with their weights now"},
        {"LAB/lab.journal", "what counts; the other files are made from it again"},
        {"LAB/unfinished-*.journal",
         "what the model has answered; without it it is asked again"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return plan_next(context, *options); };
  });
}

}  // namespace papilla::cli
