// papilla completion SHELL: a completion script made from the commands themselves.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "base/text.h"
#include "cli/commands.h"

namespace papilla::cli {
namespace {

// As one word of a fish script.
std::string fish_word(const std::string& text) {
  std::string out = "'";
  for (char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

// One line a command, a piece and an option.
std::string fish_script(Command program) {
  std::string out = "# papilla completion fish\n";
  const auto options = [&out](const std::string& when, const Command& command) {
    for (const Command::OptionRow& row : command.options()) {
      if (row.names.empty()) continue;
      out += "complete -c papilla" + when;
      for (const std::string& name : row.names)
        out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      out += (row.value.empty() ? "" : " -r") + std::string(" -d ") + fish_word(row.meaning) + "\n";
    }
  };
  options("", program);
  for (const Command command : program.commands()) {
    out += fmt::format("complete -c papilla -n __fish_use_subcommand -f -a {} -d {}\n",
                       command.name(), fish_word(command.meaning()));
    const std::string seen = fmt::format(" -n '__fish_seen_subcommand_from {}'", command.name());
    options(seen, command);
    for (const Command piece : command.commands()) {
      out += fmt::format("complete -c papilla{} -f -a {} -d {}\n", seen, piece.name(),
                         fish_word(piece.meaning()));
    }
  }
  return out;
}

// Works in bash, and in zsh through bashcompinit.
std::string script(Command program) {
  std::vector<std::string> names;
  std::string cases;
  for (const Command command : program.commands()) {
    names.push_back(command.name());
    std::vector<std::string> words;
    for (const Command::OptionRow& row : command.options()) {
      for (const std::string& name : row.names) {
        if (name.starts_with("--")) words.push_back(name);
      }
    }
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
  command.add_option("shell", *shell, "bash, zsh or fish: source <(papilla completion bash)")
      .required()
      .one_of({"bash", "zsh", "fish"});
  command.document({"Prints the script that completes commands and options in a shell.",
                    {{"papilla completion bash", "to source: source <(papilla completion bash)"}}});
  command.on_chosen([app, &context, shell] {
    context.action = [app, shell] {
      if (*shell == "zsh") std::cout << "autoload -U +X bashcompinit && bashcompinit\n";
      std::cout << (*shell == "fish" ? fish_script(app) : script(app));
      return kSuccess;
    };
  });
}

}  // namespace papilla::cli
