// papilla completion SHELL: a completion script made from the commands themselves.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "base/text.h"
#include "cli/commands.h"

namespace papilla {
namespace {

// Works in bash, and in zsh through bashcompinit.
std::string script(Command program) {
  std::vector<std::string> names;
  std::string cases;
  for (const Command command : program.commands()) {
    names.push_back(command.name());
    std::vector<std::string> words = command.option_names();
    for (const Command piece : command.commands()) words.push_back(piece.name());
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command.name(), join_names(words, " "));
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

void add_completion(Command app, Context& context) {
  Command command = app.add_command("completion", "Print a script for shell completion");
  auto shell = std::make_shared<std::string>();
  command.add_option("shell", *shell, "bash or zsh: source <(papilla completion bash)")
      .required()
      .one_of({"bash", "zsh"});
  command.on_chosen([app, &context, shell] {
    context.action = [app, shell] {
      if (*shell == "zsh") std::cout << "autoload -U +X bashcompinit && bashcompinit\n";
      std::cout << script(app);
      return kSuccess;
    };
  });
}

}  // namespace papilla
