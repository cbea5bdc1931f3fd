#include "papilla/files.h"

#include "api/inside.h"
#include "fabricate/export.h"
#include "fabricate/verify.h"
#include "report/export.h"

namespace papilla::api {

Exported export_files(const Design& design, const std::string& folder,
                      const ExportOptions& options) {
  return across([&] {
    rooms::ExportOptions inside;
    inside.formats = options.formats;
    inside.size = options.size;
    inside.pixels = options.pixels;
    if (options.polarity == "white-high" || options.polarity == "white-deep") {
      inside.polarity =
          options.polarity == "white-high" ? Polarity::WhiteHigh : Polarity::WhiteDeep;
    } else if (!options.polarity.empty()) {
      throw rooms::InputError("polarity: expected white-high or white-deep, got " +
                              options.polarity);
    }
    const rooms::Study& study = design.inside().study;
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
  return across([&] {
    const Verification v = verify_export(design.inside().study, file, tolerance);
    return Verdict{v.pixels.min_hole, v.pixels.min_wall, v.design, v.file, v.loss, v.faults};
  });
}

}  // namespace papilla::api
