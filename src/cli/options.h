// Commands, their options and the command line, in plain types. Only options.cpp knows the parser
// behind them (CLI11).
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/rooms.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace papilla::cli {

// An option or an argument of a command; each call adds to what it asks for.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required() const;
  Option type_name(const std::string& name) const;  // of its value in the help: FILE
  Option show_default() const;                      // the variable's value now, in the help
  Option repeatable() const;                        // one value each time that it is named
  Option separator(char character) const;           // of several values in one argument
  Option one_of(const std::vector<std::string>& values) const;
  // What is wrong with a text; empty: nothing.
  Option check(const std::function<std::string(const std::string&)>& mistake) const;
  // Both ends are allowed. int, long or double.
  template <typename T>
  Option range(T low, T high) const;

  std::string name() const;  // "--out"
  bool given() const;        // on the command line, once it is read

 private:
  CLI::Option* option_;
};

// Throws InputError where one of them was named: nothing here would obey it, it "is of" that.
void refuse(const std::vector<Option>& options, const std::string& whose);

// What is wrong with a share as a value, "5 %": above 0 and below 100 %; "": nothing.
std::string share_mistake(const std::string& text);

// What people are told of a command beside its options: in its manual, the examples also by --help.
struct Manual {
  struct Line {
    std::string what, meaning;
  };
  std::string description;       // sentences
  std::vector<Line> examples;    // command lines, below the folder `designs` of the sources
  std::vector<Line> files = {};  // read or written: names, what they hold
};

// A handle of one (sub)command, copied freely; it lives as long as its CommandLine.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  Command add_command(const std::string& name, const std::string& meaning) const;
  // "file" is an argument by place, "--file" an option. Variables: std::string, int, double,
  // std::uint64_t, std::vector of std::string or double; they outlive the parsing.
  template <typename T>
  Option add_option(const std::string& name, T& variable, const std::string& meaning) const;
  Option add_flag(const std::string& name, bool& variable, const std::string& meaning) const;
  // Exactly one of the options that are added to it must be given.
  Command add_alternatives(const std::string& name) const;
  void require_command() const;
  Command document(Manual manual) const;
  const Manual& manual() const;  // throws std::logic_error for a command without one
  // Called after the command line is read, where this command was chosen.
  void on_chosen(const std::function<void()>& callback) const;

  // A line of a manual: "--out DIR", what it does.
  struct OptionRow {
    std::vector<std::string> names;  // "-q", "--quiet"; empty: an argument by place
    std::string value;               // "DIR"; "" of a flag; of an argument by place its name
    std::string meaning;
    bool required = false, repeatable = false;
  };
  std::vector<OptionRow> options() const;

  std::string name() const;
  std::string meaning() const;
  std::vector<Command> commands() const;

 private:
  CLI::App* app_;
};

// A mistake on the command line.
class CommandLineError : public std::runtime_error {
 public:
  CommandLineError(const std::string& mistake, std::string commands)
      : std::runtime_error(mistake), commands_(std::move(commands)) {}
  // As far as they were understood: "solve contact ".
  const std::string& commands() const { return commands_; }

 private:
  std::string commands_;
};

// The whole command line of a program.
class CommandLine {
 public:
  // licences: the text of --licences.
  CommandLine(const std::string& name, const std::string& version,
              const std::function<std::string()>& licences, const std::string& meaning);
  ~CommandLine();

  Command program() const;
  // False: it asked for help, the version or licences, which are printed. Throws CommandLineError.
  bool parse(int argc, const char* const* argv) const;

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace papilla::cli
