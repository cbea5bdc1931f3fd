// papilla tell: what was measured, back into a lab.
#include <iostream>
#include <memory>

#include "base/text.h"
#include "cli/commands.h"
#include "report/lab_folder.h"

namespace papilla::cli {
namespace {

struct TellCommand {
  TellRun run;
  bool json = false;
};

int tell_files(const Context& context, TellCommand command) {
  TellRun& run = command.run;
  if (run.options.date.empty()) run.options.date = today();
  run.note = [&](const std::string& text) { context.note(text); };
  const TellReport report = tell_lab(run);
  if (command.json)
    std::cout << report.json << '\n';
  else
    context.print(report.markdown);
  if (!report.refused.empty()) throw InputError(report.refused);
  return kSuccess;
}

}  // namespace

void add_tell(Command app, Context& context) {
  Command command = app.add_command(
      "tell", "Tables of friction and records of a tribometer into a lab: what they change");
  auto options = std::make_shared<TellCommand>();
  TellOptions& said = options->run.options;
  command.add_option("lab", options->run.folder, "Folder that `papilla next` opened")
      .required()
      .type_name("LAB");
  command.add_option("files", options->run.files, "CSV: a table, or the record of one experiment")
      .required()
      .type_name("FILE");
  command.add_option("--experiment", said.experiment,
                     "Of the plan, where the file does not say it");
  command.add_option("--field", said.field, "Of the wafer, where the file does not say it");
  command.add_option("--design", said.design, "Where the file does not say it");
  command.add_option("--finger", said.finger, "Who was measured, where the file does not say it");
  command.add_option("--day", said.day, "When, where the file does not say it; else the date");
  command.add_option("--date", said.date, "Of today, for the journal");
  command.add_flag("--replace", said.replace,
                   "Readings take the place of those they contradict, and of what the same file "
                   "was told as before");
  command.add_option("--jobs", options->run.threads, "Threads; 0: all processors").range(0, 4096);
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.document(
      {"Takes measured frictions into a lab: tables, or the raw records of a tribometer, of which "
       "steady sliding is found, drift taken out, stick-slip and onsets marked. The belief is "
       "weighed "
       "anew; what no member explains is said with its place. A file counts whole or not at all, "
       "and "
       "the same file twice counts once.",
       {{"papilla tell labs/study plan_01.csv", "the plan, filled in"},
        {"papilla tell labs/study E01_run1.csv E01_run2.csv --finger Ada",
         "records of one experiment"}},
       {{"LAB/traces", "a picture of every record"},
        {"LAB/readings.csv", "all readings with the columns of `papilla calibrate`"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return tell_files(context, *options); };
  });
}

}  // namespace papilla::cli
