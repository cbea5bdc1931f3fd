// Files of instruments that no reader of ours knows, by Gwyddion's converter in a child process: it
// reads some 170 formats, and what it does with a damaged one stays in the child.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>

#include "base/bounded_child.h"
#include "base/error.h"
#include "base/files.h"
#include "base/folder.h"
#include "base/scratch_folder.h"
#include "geometry/io/gwy.h"

namespace papilla::geometry {
namespace {

namespace fs = std::filesystem;

constexpr ChildLimits kLimits{.seconds = 60,  // of one conversion
                              .memory = std::size_t{4} << 30,
                              .written = std::size_t{1} << 31};
constexpr std::size_t kMostRead = (std::size_t{1} << 31) - 1;

ChildEnd convert(const std::string& program, const ScratchFolder& scratch, const std::string& from,
                 const std::string& to) {
  // Its numbers follow the locale, and its settings the home: neither is the user's here.
  return run_bounded(
      {program, "--convert-to-gwy=" + to, from},
      {"LC_ALL=C", "HOME=" + scratch.file(""), "PATH=/usr/bin:/bin", "TMPDIR=" + scratch.file("")},
      kLimits);
}

}  // namespace

std::unique_ptr<HeightRows> open_by_gwyddion(const std::string& path, const std::string& channel) {
  const RegularFile file(path);  // throws where that is what is wrong
  const auto fail = [&](const std::string& why) -> InputError {
    return InputError("cannot read " + path + ": " + why);
  };
  const std::string program = program_on_path({"gwyddion"});
  if (program.empty()) {
    throw fail(
        "use .npy, .gsf, .exr, .tif, .x3p, .gwy, .sur or .sdf; other instruments' files are read "
        "by Gwyddion, which is not installed here (apt install gwyddion)");
  }
  const ScratchFolder scratch("gwyddion");
  const std::string first = scratch.file("first.gwy"), second = scratch.file("second.gwy");
  const ChildEnd end = convert(program, scratch, fs::absolute(path).string(), first);
  if (end == ChildEnd::TooLong)
    throw fail(fmt::format("Gwyddion took longer than {:.0f} s and was ended", kLimits.seconds));
  std::error_code missing;
  if (end == ChildEnd::Failed || !fs::exists(first, missing)) {
    throw fail(
        "Gwyddion finds no map in it; save it in the instrument's program as .gwy, .x3p or .sur, a "
        "table of numbers as .npy (in metres) or .gsf");
  }
  std::string bytes = read_bytes(first, kMostRead);
  const std::size_t maps = count_of_gwy_maps(path, bytes);
  if (maps == 0) throw fail("Gwyddion finds no map in it (curves and volumes are not read)");
  if (convert(program, scratch, first, second) != ChildEnd::Done)
    throw fail("Gwyddion does not read again what it made of it");
  const std::size_t again = count_of_gwy_maps(path, read_bytes(second, kMostRead));
  if (again != maps) {
    throw fail(
        fmt::format("Gwyddion lost channels of it: {} of {} are left after a second "
                    "conversion; save it in the instrument's program as .gwy, .x3p or .sur",
                    again, maps));
  }
  return converted_gwy_rows(path, std::move(bytes), channel);
}

}  // namespace papilla::geometry
