// papilla verify FOLDER|FILE: exported files held against the design that they were made from.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/file_work.h"
#include "cli/interrupt.h"
#include "report/run_verdict.h"
#include "report/verdict.h"
#include "report/wafer.h"

namespace papilla::cli {
namespace {

struct VerifyCommand {
  std::string path, tolerance = "5 %", time = "10 min";
  std::vector<std::string> receipts;
  int jobs = 0;
  bool geometry = false, json = false;
  std::vector<Option> not_of_wafer;
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
  refuse(command.not_of_wafer, "runs and exports, and " + folder + " is a wafer");
  FileWork work(context, "checking");
  const WaferVerdict verdict = verify_wafer(folder, work.progress());
  std::cout << (command.json ? wafer_verdict_json(folder, verdict) + '\n'
                             : visible(wafer_verdict_text(verdict)));
  const std::vector<std::string> left = left_lines(verdict.made);
  for (const std::string& line : left) std::cerr << "not as wanted: " << visible(line) << '\n';
  const int status = verdict_status({verdict.files, std::nullopt});
  return status == kSuccess && !left.empty() ? kWorkFailed : status;
}

// The numbers of a run; nothing where the folder is none, or has no receipts.
std::optional<RunVerdict> verify_numbers(const Context& context, const VerifyCommand& command,
                                         const Interruptible& interrupt) {
  if (command.geometry && command.receipts.empty()) return std::nullopt;
  if (const std::vector<std::string> missing = missing_of_run(command.path); !missing.empty()) {
    if (has_receipts(command.path))
      throw InputError(
          fmt::format("{} has receipts.json and no {}: taken away; its numbers cannot "
                      "be computed again",
                      command.path, join_names(missing)));
    if (!command.receipts.empty())
      throw InputError("--receipt is of a folder that `papilla optimize` wrote to its end");
    return std::nullopt;
  }
  if (!has_receipts(command.path)) {
    const std::string missing = command.path + " has no receipts.json";
    if (promises_receipts(command.path) || !command.receipts.empty())
      throw InputError(missing + ": it was taken away; `papilla optimize STUDY --out " +
                       command.path + " --resume` writes it anew");
    context.note(missing +
                 ": no design was found, or an earlier version wrote it (`papilla optimize STUDY "
                 "--out NEW` writes one); the exported files alone are checked");
    return std::nullopt;
  }
  FileWork work(context, "recomputing");
  const FileProgress tell = work.progress();
  RunChecking how{
      command.receipts, parse_si(command.time, "min"), command.jobs, {}, &interrupt.asked()};
  if (!(how.seconds > 0)) throw InputError("--time: expected more than 0 min, got " + command.time);
  how.progress = [&](int done, int total) {
    tell(fmt::format("{} of {} answers of the model", done, total),
         static_cast<double>(done) / total);
  };
  return verify_run(command.path, how);
}

int verify_files(const Context& context, const VerifyCommand& command,
                 std::vector<std::pair<std::string, ExportVerdict>>& verdicts) {
  int status = kSuccess;
  const JudgeOptions how{command.geometry, parse_si(command.tolerance, "%")};
  for (const ExportPlace& place : export_places(command.path)) {
    FileWork work(context, "checking");
    verdicts.emplace_back(place.folder, judge_export(place, how, work.progress()));
    if (!command.json) std::cout << visible(verdict_text(verdicts.back().second)) << std::flush;
    status = std::max(status, verdict_status(verdicts.back().second));
  }
  return status;
}

int verify_path(const Context& context, const VerifyCommand& command) {
  if (const std::string wafer = folder_of_wafer(command.path); !wafer.empty())
    return verify_test_wafer(context, command, wafer);
  const Interruptible interrupt;
  const std::optional<RunVerdict> numbers = verify_numbers(context, command, interrupt);
  if (interrupt.asked()) return interrupt.status();
  int status = numbers && !numbers->holds() ? kWorkFailed : kSuccess;
  if (numbers && !command.json) std::cout << visible(run_verdict_text(*numbers)) << std::flush;
  std::vector<std::pair<std::string, ExportVerdict>> verdicts;
  if (command.receipts.empty()) status = std::max(status, verify_files(context, command, verdicts));
  if (!command.json) return status;
  nlohmann::ordered_json out = nlohmann::ordered_json::parse(verdict_json(verdicts));
  if (numbers) out["run"] = run_verdict_json(command.path, *numbers);
  std::cout << out.dump(2) << '\n';
  return status;
}
}  // namespace

void add_verify(Command app, Context& context) {
  Command command = app.add_command("verify",
                                    "A run's numbers computed again; exported files against their "
                                    "design: sizes, depth, friction");
  auto options = std::make_shared<VerifyCommand>();
  command
      .add_option("path", options->path,
                  "Folder that `papilla export`, `wafer` or `optimize` wrote, or one file of it")
      .required()
      .type_name("FOLDER|FILE");
  options->not_of_wafer = {
      command.add_flag("--geometry", options->geometry,
                       "What the files hold alone: nothing is simulated"),
      command.add_option("--tolerance", options->tolerance, "Largest loss of merit of the heights")
          .check(share_mistake)
          .show_default(),
      command
          .add_option("--receipt", options->receipts,
                      "Of a run: this number of its receipts.json alone; named again: several")
          .type_name("ID")
          .repeatable(),
      command
          .add_option("--time", options->time,
                      "Of a run: no answer of the model is begun that would end later; one of each "
                      "processor is waited for in any case, and the files are judged besides")
          .show_default(),
      command
          .add_option("--jobs", options->jobs, "Of a run: evaluations at a time; 0: all processors")
          .range(0, 4096)};
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.document(
      {"Asks the model again what a run of `papilla optimize` asked after its search, makes every "
       "number of the report's first screen anew and says of each whether it holds or is violated, "
       "by receipts.json, report.html, run.json, summary.md and the tables; the search itself is "
       "not repeated. Then it measures every exported file against its design: size, depth, widths "
       "of holes and walls, "
       "polarity, polygons, heights to the rounding of the format, and the friction of what was "
       "written. "
       "A file that differs is named, and the exit status is 1.",
       {{"papilla verify results/study", "the numbers of a run, and all its files"},
        {"papilla verify results/study --receipt r07", "one number"},
        {"papilla verify results/study/best", "all files of the design that a run recommends"},
        {"papilla verify results/study/best/heightmap.exr --geometry",
         "one file, without simulating it"}},
       {{"receipts.json",
         "of a run: each number, its bars, what it rests on, how to compute it again"},
        {"export.json", "beside the files: the design that each was made from"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return verify_path(context, *options); };
  });
}

}  // namespace papilla::cli
