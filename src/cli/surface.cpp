// papilla surface FILE: a measured map as every command takes it.
#include "report/surface.h"

#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/scan_options.h"
#include "design/design.h"
#include "geometry/io/files.h"

namespace papilla::cli {
namespace {

struct SurfaceCommand {
  ScanOptions scan;
  std::vector<std::string> files;
  std::string tip, out;
  bool json = false;
};

// Several maps of one surface; every mistake of theirs at once.
int show_together(const Context& context, const SurfaceCommand& command, double tip) {
  if (!command.out.empty()) throw InputError("--out: of one map alone; several are named");
  const ScanSource how = command.scan.source();
  std::vector<SurfaceView> maps;
  Mistakes mistakes;
  for (const std::string& file : command.files) {
    mistakes.of([&] {
      ScanSource source = how;
      source.file = own_or_shipped(file);
      maps.push_back(view_of(source, tip));
    });
  }
  mistakes.tell();
  const SurfacesView view = joint_view(std::move(maps));
  if (command.json) {
    std::cout << surfaces_json(view) << '\n';
  } else {
    context.print(surfaces_text(view));
  }
  return kSuccess;
}

int show(const Context& context, const SurfaceCommand& command) {
  const double tip = command.tip.empty() ? 0 : parse_si(command.tip, "nm");
  if (tip < 0) throw InputError("--tip must be positive, got \"" + command.tip + "\"");
  if (!command.out.empty() && !command.out.ends_with(".gsf") && !command.out.ends_with(".npy"))
    throw InputError("--out: expected a name that ends with .gsf or .npy, got " + command.out);
  if (command.files.size() > 1) return show_together(context, command, tip);
  ScanSource source = command.scan.source();
  source.file = own_or_shipped(command.files.front());
  const SurfaceView view = view_of(source, tip);
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
      "surface", "A measured map, or several: what is changed, ISO 25178, spectrum, a section");
  auto options = std::make_shared<SurfaceCommand>();
  command
      .add_option("file", options->files,
                  "Heightmap: .npy .gsf .exr .tif .x3p .gwy .sur .sdf, other instruments' where "
                  "Gwyddion is installed; several of one surface: their spectrum together")
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
