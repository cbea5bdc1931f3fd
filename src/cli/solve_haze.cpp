// papilla solve haze: how a design or a heightmap looks on glass.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <optional>

#include "base/constants.h"
#include "base/error.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/file_work.h"
#include "cli/scan_options.h"
#include "design/study.h"
#include "forward/appearance.h"
#include "report/pieces.h"
#include "report/surface.h"

namespace papilla::cli {
namespace {

struct HazeOptions {
  DesignOptions design;
  ScanOptions scan;
  std::vector<std::string> angles;
  double index = 0, fill = 0;
  std::vector<Option> of_design, of_height;  // that only one of the two obeys
};

void expect_fill_below(const OpticalMedia& media) {
  if (media.fill > media.index)
    throw InputError(
        fmt::format("--fill-index: expected 1 to {:.4g}, the index of what the "
                    "texture is cut into",
                    media.index));
}

// Some theories take half a minute and more.
Optics looked_at(const Context& context, const Design& design, const std::string& file) {
  FileWork work(context, "working out");
  work.progress()("the look of " + file, 0);
  return appearance_of(design);
}

int solve(const Context& context, const HazeOptions& options) {
  if (options.design.file.empty() == options.scan.file.empty())
    throw InputError("expected a design FILE or --height FILE");
  if (options.scan.file.empty())
    refuse(options.of_height, "--height; a design has its own");
  else
    refuse(options.of_design, "a design FILE, and --height names a map");
  std::vector<double> angles;
  for (const std::string& angle : options.angles) {
    angles.push_back(parse_si(angle, "deg"));
    if (!(angles.back() >= 0 && angles.back() <= 70 * kPi / 180))
      throw InputError("--angle: expected 0 to 70 deg");
  }
  Optics o;
  std::optional<ScanChanges> changes;
  if (options.scan.file.empty()) {
    // No look has a droplet.
    Design design =
        read_study(options.design.file, options.design.overrides, DesignUse::Drawn).design;
    if (options.index > 0) design.surface.refractive_index = options.index;
    if (options.fill > 0) design.view.fill_index = options.fill;
    if (!angles.empty()) design.view.angles = angles;
    expect_fill_below(media_of(design.surface, design.view));
    say_scans({design});
    o = looked_at(context, design, options.design.file);
  } else {
    OpticalMedia media;
    if (options.index > 0) media.index = options.index;
    if (options.fill > 0) media.fill = options.fill;
    expect_fill_below(media);
    Light light;
    if (!angles.empty()) light.angles = angles;
    const Scan scan = read_scan(options.scan.source());
    changes = scan.changes;
    say_scan(options.scan.file, *changes);
    o = phase_screen(scan.map, media, light);
  }
  const auto json = [&] {
    return changes ? with_scan(optics_json(o), options.scan.file, *changes) : optics_json(o);
  };
  std::cout << (options.design.json ? json() + '\n' : optics_text(o));
  return o.refused() ? kWorkFailed : kSuccess;
}

}  // namespace

void add_solve_haze(Command solve_command, Context& context) {
  Command command = solve_command.add_command(
      "haze", "Haze, transmittance, gloss and colour of a texture on glass");
  auto options = std::make_shared<HazeOptions>();
  command.add_option("file", options->design.file, "Design or study file").type_name("FILE");
  options->of_design = {add_set_option(command, options->design.overrides)};
  command.add_option("--height", options->scan.file, "Heightmap instead: .npy .gsf .exr .tif .x3p")
      .type_name("FILE");
  options->of_height = add_scan_options(command, options->scan);
  command.add_option("--index", options->index, "Refractive index; default: the design's, or 1.46")
      .range(1.0, 5.0);
  command
      .add_option("--fill-index", options->fill,
                  "Index of what fills the texture; default: the design's, or 1, air")
      .range(1.0, 5.0);
  command
      .add_option(
          "--angle", options->angles,
          "From the normal, e.g. \"45 deg\"; named again: the mean of several; default: the "
          "design's, or 0")
      .repeatable();
  command.add_flag("--json", options->design.json, "One JSON object, SI units");
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return solve(context, *options); };
  });
}

}  // namespace papilla::cli
