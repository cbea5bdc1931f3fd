// papilla export DESIGN.toml: heightmap and mask files.
#include "study/export.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "base/error.h"
#include "base/units.h"
#include "cli/commands.h"
#include "study/pick.h"

namespace papilla {
namespace {

struct ExportCommand {
  DesignOptions design;
  std::vector<std::string> formats;
  std::string size, polarity, out, pick;
  int pixels = 1024;
};

int export_files(const ExportCommand& command) {
  std::string source = command.design.file;
  if (std::filesystem::is_directory(source)) {
    source = picked_design_file(source, command.pick);
  } else if (!command.pick.empty()) {
    throw InputError("--pick chooses from a folder of results; " + source + " is a file");
  }
  const Study study = read_study(source, command.design.overrides);
  ExportOptions options;
  options.formats = command.formats;
  options.pixels = command.pixels;
  if (!command.size.empty()) options.size = parse_si(command.size, "um");
  if (!(options.size > 0 && options.size <= 1)) {
    throw InputError("--size: expected a length above 0 and up to 1 m");
  }
  if (!command.polarity.empty()) {
    options.polarity = command.polarity == "white-high" ? Polarity::WhiteHigh : Polarity::WhiteDeep;
  }
  const std::string folder =
      command.out.empty() ? "results/" + study.name + "/export" : command.out;
  const Export result = export_design(study.design, options, folder);
  for (const ExportedFile& file : result.files) std::cout << file.path << '\n';
  std::cout << folder << "/export.json\n";
  return kSuccess;
}

}  // namespace

void add_export(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("export", "Heightmap and mask files of a design");
  auto options = std::make_shared<ExportCommand>();
  command->add_option("file", options->design.file, "Design or study file, or a folder of results")
      ->required()
      ->type_name("FILE");
  add_set_option(*command, options->design.overrides);
  command
      ->add_option("--format", options->formats,
                   "exr, tiff, mask, gsf, npy, png, gds, stl; default: what the texture allows")
      ->delimiter(',');
  command->add_option("--size", options->size, "Side, rounded to whole periods, e.g. \"1 mm\"");
  command->add_option("--pixels", options->pixels, "Pixels along x")
      ->check(CLI::Range(8, 65536))
      ->capture_default_str();
  command
      ->add_option("--polarity", options->polarity,
                   "white-high (bright is high) or white-deep; needed for tiff and mask")
      ->check(CLI::IsMember({"white-high", "white-deep"}));
  command->add_option("--out", options->out, "Folder; default results/NAME/export")
      ->type_name("DIR");
  add_pick_option(*command, options->pick);
  command->callback(
      [&context, options] { context.action = [options] { return export_files(*options); }; });
}

}  // namespace papilla
