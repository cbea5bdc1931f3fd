// papilla completion SHELL: a completion script made from the commands themselves.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "base/text.h"
#include "cli/commands.h"

namespace papilla {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// Works in bash, and in zsh through bashcompinit.
std::string script(const CLI::App& app) {
  std::vector<std::string> names;
  std::string cases;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
    std::vector<std::string> words = option_names(*command);
    for (const CLI::App* piece : command->get_subcommands([](const CLI::App*) { return true; })) {
      words.push_back(piece->get_name());
    }
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), join_names(words, " "));
  }
  return fmt::format(
      "_papilla() {{\n"
      "  local words current=\"${{COMP_WORDS[COMP_CWORD]}}\"\n"
      "  case \"${{COMP_WORDS[1]}}\" in\n"
      "{}"
      "    *) words=\"\" ;;\n"
      "  esac\n"
      "  [ \"$COMP_CWORD\" -eq 1 ] && words=\"{}\"\n"
      "  COMPREPLY=($(compgen -W \"$words --quiet\" -- \"$current\"))\n"
      "  [ \"$COMP_CWORD\" -gt 1 ] && COMPREPLY+=($(compgen -f -- \"$current\"))\n"
      "}}\n"
      "complete -o filenames -F _papilla papilla\n",
      cases, join_names(names, " "));
}

}  // namespace

void add_completion(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("completion", "Print a script for shell completion");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "bash or zsh: source <(papilla completion bash)")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  command->callback([&app, &context, shell] {
    context.action = [&app, shell] {
      if (*shell == "zsh") std::cout << "autoload -U +X bashcompinit && bashcompinit\n";
      std::cout << script(app);
      return kSuccess;
    };
  });
}

}  // namespace papilla
