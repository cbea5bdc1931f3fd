#include "papilla/files.h"

#include <algorithm>
#include <utility>

#include "api/inside.h"
#include "fabricate/export.h"
#include "fabricate/formats.h"
#include "fabricate/verify.h"
#include "report/export.h"
#include "report/verdict.h"

namespace papilla::api {

namespace {

Verdict verdict_of(const Verification& v) {
  return {v.pixels.min_hole, v.pixels.min_wall, v.design, v.file, v.loss, v.faults};
}

}  // namespace

Exported export_files(const Design& design, const std::string& folder,
                      const ExportOptions& options) {
  return across([&] {
    rooms::ExportOptions inside;
    inside.formats = options.formats;
    if (!(options.size >= 0)) throw wrong("size", "expected a width, or 0 for about 12 um");
    inside.size = options.size;
    inside.pixels = options.pixels;
    if (options.polarity == "white-high" || options.polarity == "white-deep") {
      inside.polarity =
          options.polarity == "white-high" ? Polarity::WhiteHigh : Polarity::WhiteDeep;
    } else if (!options.polarity.empty()) {
      throw wrong("polarity", "expected white-high or white-deep, got " + options.polarity);
    }
    const rooms::Study& study = design.inside().study;
    if (inside.polarity) {
      const std::string why =
          without_effect(chosen_formats(study.design.texture, inside), "polarity", "formats",
                         [](const ExportFormat& format) { return format.needs_polarity; });
      if (!why.empty()) throw rooms::InputError(why);
    }
    const Export done = export_with_record(study, inside, folder);
    Exported out;
    for (const ExportedFile& file : done.files) out.files.push_back(file.path);
    out.warnings = done.warnings;
    const ExportVerdict verdict{verify_files(record_of(study, inside, done), done), {}};
    for (const std::string& fault : fault_lines(verdict)) out.warnings.push_back(fault);
    out.heights = heights_of(done.heightmap);
    return out;
  });
}

Verdict verify(const Design& design, const std::string& file, double tolerance) {
  return across([&] { return verdict_of(verify_export(design.inside().study, file, tolerance)); });
}

bool FolderVerdict::sound() const {
  return std::all_of(files.begin(), files.end(),
                     [](const FileVerdict& file) { return file.sound; }) &&
         (!felt || verdict.faults.empty());
}

std::vector<FolderVerdict> verify(const std::string& path, const VerifyOptions& options) {
  return across([&] {
    std::vector<FolderVerdict> out;
    for (const ExportPlace& place : export_places(path)) {
      const ExportVerdict judged = judge_export(place, {options.geometry, options.tolerance});
      FolderVerdict folder;
      folder.folder = place.folder;
      for (const rooms::FileVerdict& file : judged.files)
        folder.files.push_back({file.path, file.state == FileState::Sound, file.faults});
      folder.felt = judged.felt.has_value();
      if (judged.felt) folder.verdict = verdict_of(*judged.felt);
      out.push_back(std::move(folder));
    }
    return out;
  });
}

}  // namespace papilla::api
