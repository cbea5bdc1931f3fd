#include "cli/context.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string_view>

#include "base/error.h"
#include "base/folder.h"
#include "base/text.h"
#include "design/scans.h"
#include "design/title.h"

namespace papilla::cli {
namespace {

// The first line of each block is its heading.
std::string painted(const std::string& text) {
  constexpr std::string_view kBars[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  std::string out;
  bool heading = true;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    const bool bold = heading && !line.empty();
    heading = line.empty();
    std::size_t first = std::string::npos, last = 0;
    for (const std::string_view bar : kBars) {
      const std::size_t at = line.find(bar);
      if (at == std::string::npos) continue;
      first = std::min(first, at);
      last = std::max(last, line.rfind(bar) + bar.size());
    }
    if (first != std::string::npos) {
      line.insert(last, "\033[0m");
      line.insert(first, "\033[36m");
    }
    out += bold ? "\033[1m" + line + "\033[0m" : line;
    if (end < text.size()) out += '\n';
    begin = end + 1;
  }
  return out;
}

}  // namespace

void Context::print(const std::string& text) const {
  const std::string aligned = aligned_markdown(visible(text));
  std::cout << (color_results ? painted(aligned) : aligned) << std::flush;
}

void Context::note(const std::string& text) const {
  if (!quiet) std::cerr << visible(text) << std::endl;
}

void make_folder(const std::string& path) {
  Folder::made(path);
  if (access(path.c_str(), W_OK | X_OK) != 0)
    throw InputError({Problem{path, 0, 0, "", "the folder cannot be written to"}});
}

void add_design_options(Command command, DesignOptions& options) {
  command.add_option("file", options.file, "Design or study file, or with --base a scan")
      .required()
      .type_name("FILE");
  command
      .add_option("--base", options.base, "DESIGN.toml that the scan is put into, as its texture")
      .type_name("FILE");
  add_set_option(command, options.overrides);
  command.add_flag("--json", options.json, "One JSON object on standard output");
}

Study DesignOptions::study(DesignUse use) const {
  if (!base.empty() && file.ends_with(".toml"))
    throw InputError("--base: " + file + " is no scan; a design names its base, base = \"" + base +
                     "\"");
  Study out = base.empty() ? read_study(file, overrides, use)
                           : read_study(base, scan_as_texture(file, overrides), use);
  const std::string title = title_as_set(out.design, overrides);
  if (title != out.design.title) out.origins["title"] = Place{"--set", 0, 0};
  out.design.title = title;
  return out;
}

Option add_set_option(Command command, std::vector<std::string>& overrides) {
  return command
      .add_option("--set", overrides,
                  "Override a value of the file, e.g. --set drive.amplitude=150V")
      .type_name("KEY=VALUE")
      .repeatable();
}

void add_pick_option(Command command, std::string& rule) {
  command
      .add_option(
          "--pick", rule,
          "Which design of the front: worst (highest worst modulation; default where what is asked "
          "for is at the drive's own amplitude), knee (default elsewhere), an objective (its "
          "best), or a number; judged over "
          "the belief that the fingers name (of a finished run that is by the rule which the run "
          "decided by, else by the fit)")
      .type_name("RULE");
}

}  // namespace papilla::cli
