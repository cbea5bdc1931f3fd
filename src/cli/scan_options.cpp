#include "cli/scan_options.h"

#include <fmt/format.h>

#include <iostream>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "design/scans.h"

namespace papilla::cli {

ScanSource ScanOptions::source() const {
  const double width = size.empty() ? 0 : parse_si(size, "um");
  if (width < 0 || (!size.empty() && width == 0))
    throw InputError(fmt::format("--size must be positive, got \"{}\"", size));
  if (as_is && level)
    throw InputError("--as-is takes no plane away, and --level does: give one of them");
  return {file, width, fill, as_is, level};
}

std::vector<Option> add_scan_options(Command command, ScanOptions& options) {
  return {
      command.add_option("--size", options.size,
                         "Lateral size in x, where the file does not say: \"12 um\""),
      command.add_flag("--fill", options.fill,
                       "Heights that are no numbers get the mean of those around them"),
      command.add_flag(
          "--as-is", options.as_is,
          "Take no plane away and replace no pixel: a surface that is known, not measured"),
      command.add_flag("--level", options.level,
                       "Take the plane away of made maps (arrays, exports) and periodic ones too")};
}

void say_scan(const std::string& file, const ScanChanges& changes) {
  std::cerr << visible(text(file, changes)) << std::endl;
}

void say_scans(const std::vector<Design>& designs) {
  std::set<std::string> said;
  Mistakes mistakes;
  for (const Design& design : designs) {
    mistakes.of([&] {
      for (const DesignScan& scan : scans_of(design)) {
        if (const auto [line, is_new] = said.insert(text(scan)); is_new)
          std::cerr << visible(*line) << std::endl;
      }
    });
  }
  mistakes.tell();
}

}  // namespace papilla::cli
