#include "cli/context.h"

#include <CLI/CLI.hpp>
#include <iostream>

namespace papilla {

void Context::note(const std::string& text) const {
  if (!quiet) std::cerr << text << std::endl;
}

void add_design_options(CLI::App& command, DesignOptions& options) {
  command.add_option("file", options.file, "Design or study file")->required()->type_name("FILE");
  add_set_option(command, options.overrides);
  command.add_flag("--json", options.json, "One JSON object on standard output");
}

void add_set_option(CLI::App& command, std::vector<std::string>& overrides) {
  command
      .add_option("--set", overrides,
                  "Override a value of the file, e.g. --set drive.amplitude=150V")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_pick_option(CLI::App& command, std::string& rule) {
  command
      .add_option("--pick", rule,
                  "Which design of the front: worst (highest worst modulation; default), knee, an "
                  "objective (its best), or a number")
      ->type_name("RULE");
}

}  // namespace papilla
