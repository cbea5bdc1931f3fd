#include "papilla/files.h"

#include <fmt/format.h>

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

// As `papilla export` takes them.
constexpr double kLargestSide = 1;  // [m]
constexpr int kFewestPixels = 8, kMostPixels = 65536;

void require_tolerance(double tolerance) {
  if (!(tolerance > 0 && tolerance < 1))
    throw wrong("tolerance", fmt::format("expected a share from 0 to 1, got {}", tolerance));
}

Verdict verdict_of(const Verification& v) {
  return {v.pixels.min_hole, v.pixels.min_wall, v.design, v.file, v.loss, v.faults};
}

}  // namespace

Exported export_files(const Design& design, const std::string& folder,
                      const ExportOptions& options) {
  return across([&] {
    rooms::ExportOptions inside;
    inside.formats = options.formats;
    if (!(options.size >= 0 && options.size <= kLargestSide))
      throw wrong("size", "expected a width of at most 1 m, or 0 for about 12 um");
    if (options.pixels < kFewestPixels || options.pixels > kMostPixels) {
      throw wrong("pixels", fmt::format("expected {} to {}, got {}", kFewestPixels, kMostPixels,
                                        options.pixels));
    }
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
    for (const std::string& warning : done.warnings) out.warnings.push_back(in_arguments(warning));
    const ExportVerdict verdict{verify_files(record_of(study, inside, done), done), {}};
    for (const std::string& fault : fault_lines(verdict))
      out.warnings.push_back(in_arguments(fault));
    out.heights = heights_of(done.heightmap);
    return out;
  });
}

Verdict verify(const Design& design, const std::string& file, double tolerance) {
  return across([&] {
    require_tolerance(tolerance);
    return verdict_of(verify_export(design.inside().study, file, tolerance));
  });
}

bool FolderVerdict::sound() const {
  return std::all_of(files.begin(), files.end(),
                     [](const FileVerdict& file) { return file.sound; }) &&
         (!felt || verdict.faults.empty());
}

std::vector<FolderVerdict> verify(const std::string& path, const VerifyOptions& options) {
  return across([&] {
    require_tolerance(options.tolerance);
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
