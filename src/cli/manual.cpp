#include "cli/manual.h"

#include <fmt/format.h>

namespace papilla::cli {
namespace {

// Text as a line of a manual: hyphens to copy, no line that is a request.
std::string man_text(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string head(const std::string& name, const std::string& version) {
  return fmt::format(".TH \"{}\" \"1\" \"\" \"papilla {}\" \"User Commands\"\n", man_text(name),
                     version);
}

std::string name_section(const std::string& name, const std::string& meaning) {
  return fmt::format(".SH NAME\n{} \\- {}\n", man_text(name), man_text(meaning));
}

std::string bold(const std::string& text) { return fmt::format("\\fB{}\\fR", man_text(text)); }
std::string italic(const std::string& text) { return fmt::format("\\fI{}\\fR", man_text(text)); }

// "papilla optimize study [OPTIONS]"
std::string synopsis(const std::string& called, const Command& command) {
  std::string out = bold(called);
  for (const Command::OptionRow& row : command.options()) {
    if (!row.names.empty()) continue;
    const std::string value = italic(row.value);
    out += row.required ? fmt::format(" {}", value) : fmt::format(" [{}]", value);
    if (row.repeatable) out += "...";
  }
  return out + (command.commands().empty() ? " [\\fIOPTIONS\\fR]\n" : " \\fIPIECE\\fR\n");
}

std::string option_list(const Command& command) {
  std::string out;
  for (const Command::OptionRow& row : command.options()) {
    out += ".TP\n";
    if (row.names.empty()) out += italic(row.value);
    for (std::size_t i = 0; i < row.names.size(); ++i)
      out.append(i > 0 ? ", " : "").append(bold(row.names[i]));
    if (!row.names.empty() && !row.value.empty()) out.append(" ").append(italic(row.value));
    out.append("\n").append(man_text(row.meaning)).append("\n");
  }
  return out;
}

// "DESCRIPTION", "EXAMPLES", "FILES": a line each, what it does below it.
std::string line_section(const std::string& title, const std::vector<Manual::Line>& lines) {
  std::string out = lines.empty() ? "" : ".SH " + title + "\n";
  for (const Manual::Line& line : lines)
    out += ".TP\n" + bold(line.what) + "\n" + man_text(line.meaning) + "\n";
  return out;
}

std::string ends() {
  return ".SH EXIT STATUS\n0: success; 1: the work failed; 2: wrong input; 128 + N: ended by "
         "signal "
         "N, 130 for Ctrl\\-C.\n"
         ".SH ENVIRONMENT\n.TP\n.B PAPILLA_DESIGNS\nThe folder where bases are looked for, and "
         "files that "
         "are not in the working folder.\n.TP\n.B "
         "NO_COLOR\nNo colours on a terminal.\n";
}

ManualPage command_page(const Command& command, const std::string& version) {
  const std::string name = fmt::format("papilla-{}", command.name()),
                    called = fmt::format("papilla {}", command.name());
  std::string text = head(name, version) + name_section(name, command.meaning()) +
                     ".SH SYNOPSIS\n" + synopsis(called, command) + ".SH DESCRIPTION\n" +
                     man_text(command.manual().description) + "\n.SH OPTIONS\n" +
                     option_list(command);
  for (const Command& piece : command.commands()) {
    text += fmt::format(".SH {}\n{}\n.PP\n", man_text(called + " " + piece.name()),
                        man_text(piece.meaning())) +
            synopsis(called + " " + piece.name(), piece) + option_list(piece);
  }
  text += line_section("EXAMPLES", command.manual().examples) +
          line_section("FILES", command.manual().files);
  return {name, text + ends() + ".SH SEE ALSO\n.BR papilla (1)\n"};
}

}  // namespace

std::vector<ManualPage> manual_pages(Command program, const std::string& version) {
  std::string text = head("papilla", version) + name_section("papilla", program.meaning()) +
                     ".SH SYNOPSIS\n" + bold("papilla") + " " + italic("COMMAND") +
                     " ...\n.SH COMMANDS\n";
  std::vector<ManualPage> out;
  for (const Command& command : program.commands()) {
    text += fmt::format(".TP\n.BR papilla\\-{} (1)\n{}\n", man_text(command.name()),
                        man_text(command.meaning()));
    out.push_back(command_page(command, version));
  }
  out.insert(out.begin(),
             ManualPage{"papilla", text + ".SH OPTIONS\n" + option_list(program) + ends()});
  return out;
}

}  // namespace papilla::cli
