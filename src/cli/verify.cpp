// papilla verify FOLDER|FILE: exported files held against the design that they were made from.
#include "fabricate/verify.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/file_work.h"
#include "fabricate/formats.h"
#include "fabricate/record.h"

namespace papilla::cli {
namespace {

namespace fs = std::filesystem;

struct VerifyCommand {
  std::string path, tolerance = "5 %";
  bool geometry = false, json = false;
};

// A folder with a record, and one file of it or all.
struct Place {
  std::string folder, file;
};

// The folder itself, or those of a run: best/ and the front.
std::vector<Place> places_of(const std::string& path) {
  if (!fs::exists(path)) throw InputError("no such file or folder: " + path);
  if (!fs::is_directory(path)) {
    const fs::path file(path);
    return {{file.has_parent_path() ? file.parent_path().string() : ".", file.filename().string()}};
  }
  std::string folder = path;
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  std::vector<Place> out;
  if (fs::exists(folder + "/" + kRecordName)) return {{folder, ""}};
  for (const char* part : {"best", "front"}) {
    const std::string below = folder + "/" + part;
    if (fs::exists(below + "/" + kRecordName)) out.push_back({below, ""});
    if (!fs::is_directory(below)) continue;
    for (const auto& entry : fs::directory_iterator(below)) {
      if (fs::exists(entry.path() / kRecordName)) out.push_back({entry.path().string(), ""});
    }
  }
  if (out.empty()) return {{folder, ""}};  // says what is missing
  std::sort(out.begin(), out.end(),
            [](const Place& a, const Place& b) { return a.folder < b.folder; });
  return out;
}

bool there(const FileVerdict& file) {
  return file.state == FileState::Sound || file.state == FileState::Differs;
}

bool holds_heights(const ExportRecord& record) {
  return std::any_of(record.files.begin(), record.files.end(), [](const ExportedFile& file) {
    return file.format != kDesignFormat && find_export_format(file.format).judged > 0;
  });
}

ExportVerdict judge(const Context& context, const VerifyCommand& command, const Place& place) {
  FileWork work(context, "checking");
  ExportVerdict verdict;
  verdict.files = verify_folder(place.folder, place.file, work.progress());
  if (command.geometry) return verdict;
  ExportRecord record = read_record(place.folder);
  std::erase_if(record.files, [&](const ExportedFile& file) {
    return std::none_of(verdict.files.begin(), verdict.files.end(), [&](const FileVerdict& judged) {
      return judged.path == file.path && there(judged);
    });
  });
  if (!holds_heights(record)) return verdict;
  work.progress()("how the heights of " + place.folder + " feel", 0);
  verdict.felt = verify_export(record, parse_si(command.tolerance, "%"));
  return verdict;
}

int verify_path(const Context& context, const VerifyCommand& command) {
  std::vector<std::pair<std::string, ExportVerdict>> verdicts;
  int status = kSuccess;
  for (const Place& place : places_of(command.path)) {
    verdicts.emplace_back(place.folder, judge(context, command, place));
    if (!command.json) std::cout << verdict_text(verdicts.back().second) << std::flush;
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
                  "Folder that `papilla export` or `optimize` wrote, or one file of it")
      .required()
      .type_name("FOLDER|FILE");
  command.add_flag("--geometry", options->geometry,
                   "What the files hold alone: the heights are not simulated");
  command.add_option("--tolerance", options->tolerance, "Largest loss of merit of the heights")
      .show_default();
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return verify_path(context, *options); };
  });
}

}  // namespace papilla::cli
