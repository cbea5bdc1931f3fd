// papilla verify FOLDER|FILE: exported files held against the design that they were made from.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/file_work.h"
#include "report/verdict.h"
#include "report/wafer.h"

namespace papilla::cli {
namespace {

struct VerifyCommand {
  std::string path, tolerance = "5 %";
  bool geometry = false, json = false;
};

// One file of a wafer is judged with all of them.
std::string folder_of_wafer(const std::string& path) {
  const std::filesystem::path beside = std::filesystem::path(path).parent_path();
  const std::string folder =
      std::filesystem::is_regular_file(path) ? (beside.empty() ? "." : beside.string()) : path;
  return holds_wafer(folder) ? folder : "";
}

int verify_test_wafer(const Context& context, const VerifyCommand& command,
                      const std::string& folder) {
  FileWork work(context, "checking");
  const WaferVerdict verdict = verify_wafer(folder, work.progress());
  std::cout << (command.json ? wafer_verdict_json(folder, verdict) + '\n'
                             : visible(wafer_verdict_text(verdict)));
  const std::vector<std::string> left = left_lines(verdict.made);
  for (const std::string& line : left) std::cerr << "not as wanted: " << visible(line) << '\n';
  const int status = verdict_status({verdict.files, std::nullopt});
  return status == kSuccess && !left.empty() ? kWorkFailed : status;
}

int verify_path(const Context& context, const VerifyCommand& command) {
  if (const std::string wafer = folder_of_wafer(command.path); !wafer.empty())
    return verify_test_wafer(context, command, wafer);
  std::vector<std::pair<std::string, ExportVerdict>> verdicts;
  int status = kSuccess;
  const JudgeOptions how{command.geometry, parse_si(command.tolerance, "%")};
  for (const ExportPlace& place : export_places(command.path)) {
    FileWork work(context, "checking");
    verdicts.emplace_back(place.folder, judge_export(place, how, work.progress()));
    if (!command.json) std::cout << visible(verdict_text(verdicts.back().second)) << std::flush;
    status = std::max(status, verdict_status(verdicts.back().second));
  }
  if (command.json) std::cout << verdict_json(verdicts) << '\n';
  return status;
}

}  // namespace

void add_verify(Command app, Context& context) {
  Command command = app.add_command(
      "verify", "Exported files against their design: sizes, depth, widths, polygons, friction");
  auto options = std::make_shared<VerifyCommand>();
  command
      .add_option("path", options->path,
                  "Folder that `papilla export`, `wafer` or `optimize` wrote, or one file of it")
      .required()
      .type_name("FOLDER|FILE");
  command.add_flag("--geometry", options->geometry,
                   "What the files hold alone: the heights are not simulated");
  command.add_option("--tolerance", options->tolerance, "Largest loss of merit of the heights")
      .show_default();
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.document(
      {"Measures every exported file against its design: size, depth, widths of holes and walls, "
       "polarity, polygons, heights to the rounding of the format, and the friction of what was "
       "written. "
       "A file that differs is named, and the exit status is 1.",
       {{"papilla verify results/study/best", "all files of the design that a run recommends"},
        {"papilla verify results/study/best/heightmap.exr --geometry",
         "one file, without simulating it"}},
       {{"export.json", "beside the files: the design that each was made from"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return verify_path(context, *options); };
  });
}

}  // namespace papilla::cli
