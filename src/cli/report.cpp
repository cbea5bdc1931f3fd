// papilla report RESULT_DIR: one self-contained HTML page.
#include "study/report.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "base/files.h"
#include "cli/commands.h"

namespace papilla {
namespace {

struct ReportOptions {
  std::string folder, out, pick;
};

int report(const ReportOptions& options) {
  const std::string path = options.out.empty() ? options.folder + "/report.html" : options.out;
  write_bytes(path, report_page(options.folder, options.pick));
  std::cout << path << '\n';
  return kSuccess;
}

}  // namespace

void add_report(CLI::App& app, Context& context) {
  CLI::App* command =
      app.add_subcommand("report", "One HTML page of a finished run: charts, pictures, files");
  auto options = std::make_shared<ReportOptions>();
  command
      ->add_option("folder", options->folder,
                   "Folder that `papilla optimize`, `rank --out` or `calibrate` wrote")
      ->required()
      ->type_name("RESULT_DIR");
  command->add_option("--out", options->out, "Default: RESULT_DIR/report.html")->type_name("FILE");
  add_pick_option(*command, options->pick);
  command->callback(
      [&context, options] { context.action = [options] { return report(*options); }; });
}

}  // namespace papilla
