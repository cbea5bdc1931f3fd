#include "cli/context.h"

#include <CLI/CLI.hpp>
#include <iostream>

namespace papilla {

void Context::note(const std::string& text) const {
  if (!quiet) std::cerr << text << std::endl;
}

void add_set_option(CLI::App& command, std::vector<std::string>& overrides) {
  command
      .add_option("--set", overrides,
                  "Override a value of the file, e.g. --set drive.amplitude=150V")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace papilla
