// papilla surface FILE: a measured map as every command takes it.
#include "report/surface.h"

#include <iostream>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/scan_options.h"
#include "geometry/io/files.h"

namespace papilla::cli {
namespace {

struct SurfaceCommand {
  ScanOptions scan;
  std::string tip, out;
  bool json = false;
};

int show(const Context& context, const SurfaceCommand& command) {
  const double tip = command.tip.empty() ? 0 : parse_si(command.tip, "nm");
  if (tip < 0) throw InputError("--tip must be positive, got \"" + command.tip + "\"");
  if (!command.out.empty() && !command.out.ends_with(".gsf") && !command.out.ends_with(".npy"))
    throw InputError("--out: expected a name that ends with .gsf or .npy, got " + command.out);
  const SurfaceView view = view_of(command.scan.source(), tip);
  if (command.out.ends_with(".gsf")) write_gsf(command.out, view.scan.map, {});
  if (command.out.ends_with(".npy")) write_npy(command.out, view.scan.map);
  if (command.json) {
    std::cout << surface_json(view) << '\n';
  } else {
    context.print(surface_text(view));
  }
  if (!command.out.empty()) context.note("wrote " + command.out);
  return kSuccess;
}

}  // namespace

void add_surface(Command app, Context& context) {
  Command command = app.add_command(
      "surface", "A measured map: what is changed of it, ISO 25178, spectrum, heights, a section");
  auto options = std::make_shared<SurfaceCommand>();
  command.add_option("file", options->scan.file, "Heightmap: .npy .gsf .exr .tif .x3p")
      .required()
      .type_name("FILE");
  add_scan_options(command, options->scan);
  command.add_option("--tip", options->tip,
                     "Radius of the instrument's tip: what it cannot reach is marked");
  command
      .add_option("--out", options->out,
                  "The map as it is taken, levelled and mended: .gsf or .npy")
      .type_name("FILE");
  command.add_flag("--json", options->json, "One JSON object, SI units");
  command.document(
      {"Shows a measured map as every command takes it: the plane that is taken away, the pixels "
       "that "
       "are replaced or filled, parameters of ISO 25178, the spectrum with the band that the "
       "instrument "
       "can know, heights, a section. Nothing is changed in silence.",
       {{"papilla surface measured_surface/scan.gsf --tip \"10 nm\"", "a scan by a tip of 10 nm"},
        {"papilla surface heights.npy --size \"50 um\" --as-is --json", "a map as it is, as JSON"}},
       {{"FILE.gsf, FILE.npy", "with --out: the map as it is taken"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return show(context, *options); };
  });
}

}  // namespace papilla::cli
