// papilla report RESULT_DIR: one self-contained HTML page.
#include "study/report.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "base/files.h"
#include "cli/commands.h"
#include "study/pick.h"

namespace papilla {
namespace {

struct ReportOptions {
  std::string folder, out, pick;
};

int report(const ReportOptions& options) {
  const std::string path = options.out.empty() ? options.folder + "/report.html" : options.out;
  const std::filesystem::path picked = picked_design_file(options.folder, options.pick);
  write_bytes(path, report_page(options.folder,
                                picked.parent_path().lexically_relative(options.folder).string()));
  std::cout << path << '\n';
  return kSuccess;
}

}  // namespace

void add_report(CLI::App& app, Context& context) {
  CLI::App* command =
      app.add_subcommand("report", "One HTML page of a finished run: charts, pictures, files");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("folder", options->folder, "Folder that `papilla optimize` wrote")
      ->required()
      ->type_name("RESULT_DIR");
  command->add_option("--out", options->out, "Default: RESULT_DIR/report.html")->type_name("FILE");
  add_pick_option(*command, options->pick);
  command->callback(
      [&context, options] { context.action = [options] { return report(*options); }; });
}

}  // namespace papilla
