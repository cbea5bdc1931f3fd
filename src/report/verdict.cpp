#include "report/verdict.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "fabricate/formats.h"
#include "fabricate/record.h"

namespace papilla::report {
namespace {

namespace fs = std::filesystem;

bool there(const FileVerdict& file) {
  return file.state == FileState::Sound || file.state == FileState::Differs;
}

bool holds_heights(const ExportRecord& record) {
  return std::any_of(record.files.begin(), record.files.end(), [](const ExportedFile& file) {
    return file.format != kDesignFormat && find_export_format(file.format).judged > 0;
  });
}

}  // namespace

std::vector<ExportPlace> export_places(const std::string& path) {
  if (!fs::exists(path)) throw InputError("no such file or folder: " + path);
  if (!fs::is_directory(path)) {
    const fs::path file(path);
    return {{file.has_parent_path() ? file.parent_path().string() : ".", file.filename().string()}};
  }
  std::string folder = path;
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  std::vector<ExportPlace> out;
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
            [](const ExportPlace& a, const ExportPlace& b) { return a.folder < b.folder; });
  return out;
}

ExportVerdict judge_export(const ExportPlace& place, const JudgeOptions& options,
                           const FileProgress& progress) {
  ExportVerdict verdict;
  verdict.files = verify_folder(place.folder, place.file, progress);
  if (options.geometry) return verdict;
  ExportRecord record = read_record(place.folder);
  std::erase_if(record.files, [&](const ExportedFile& file) {
    return std::none_of(verdict.files.begin(), verdict.files.end(), [&](const FileVerdict& judged) {
      return judged.path == file.path && there(judged);
    });
  });
  if (!holds_heights(record)) return verdict;
  if (progress) progress("how the heights of " + place.folder + " feel", 0);
  verdict.felt = verify_export(record, options.tolerance);
  return verdict;
}

}  // namespace papilla::report
