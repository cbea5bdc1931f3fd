// What every subcommand shares: where messages go and what to run after the command line is read.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "cli/options.h"
#include "design/study.h"

namespace papilla::cli {

// Exit status of the program; ended by a signal: that much more than it (130: Ctrl-C), as shells
// have it.
enum ExitStatus { kSuccess = 0, kWorkFailed = 1, kWrongInput = 2, kSignalled = 128 };

struct Context {
  bool quiet = false;
  bool color = false;           // standard error is a terminal and NO_COLOR is not set
  bool color_results = false;   // the same of standard output
  std::function<int()> action;  // set by the chosen subcommand: does the work, returns ExitStatus

  // A line of progress on standard error, unless --quiet.
  void note(const std::string& text) const;
  // A result for people on standard output: tables of Markdown aligned, headings and bars coloured
  // where that is wanted.
  void print(const std::string& text) const;
};

// Makes a folder that results go to, and sees that files can be written into it: before the work,
// not after. Throws InputError.
void make_folder(const std::string& path);

// What a command that reads one design takes.
struct DesignOptions {
  std::string file, base;  // base: a design that `file`, a scan, is the texture of; "": none
  std::vector<std::string> overrides;
  bool json = false;

  // As it is read; its title says what --set made of it. Throws InputError.
  Study study(DesignUse use = DesignUse::Simulated) const;
};
void add_design_options(Command command, DesignOptions& options);

// --set KEY=VALUE, for every command that reads a design.
Option add_set_option(Command command, std::vector<std::string>& overrides);

// --pick RULE, for every command that shows one design of a front.
void add_pick_option(Command command, std::string& rule);

}  // namespace papilla::cli
