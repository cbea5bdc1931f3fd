// papilla COMMAND ...: reads the command line, runs one subcommand, turns errors into exit codes:
// 0 success, 1 the work failed, 2 wrong input. Results go to standard output, the rest to standard
// error.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "cli/commands.h"

namespace papilla {
namespace {

void print_error(const Context& context, const std::string& text) {
  std::cout.flush();
  std::cerr << (context.color ? "\033[1;31merror:\033[0m " : "error: ") << text << std::endl;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

// A word in the place of a command that is none (papilla foo, papilla solve foo): CLI11 would only
// say that it was not expected.
bool knows_command(const CLI::App& app, int argc, char** argv, const Context& context) {
  const CLI::App* level = &app;
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
    const std::vector<std::string> names = command_names(*level);
    if (names.empty()) return true;
    if (std::find(names.begin(), names.end(), argv[i]) != names.end()) {
      level = level->get_subcommand(argv[i]);
      continue;
    }
    const std::string near = nearest_name(argv[i], names);
    const std::string above = i > 1 ? level->get_name() + " " : "";
    print_error(context, near.empty() ? fmt::format("unknown command `{}{}`; known: {}", above,
                                                    argv[i], join_names(names))
                                      : fmt::format("unknown command `{}{}`, did you mean `{}{}`?",
                                                    above, argv[i], above, near));
    return false;
  }
  return true;
}

int run(int argc, char** argv) {
  Context context;
  const char* plain = std::getenv("NO_COLOR");  // no-color.org: set and not empty
  const bool colors = plain == nullptr || *plain == '\0';
  context.color = colors && isatty(STDERR_FILENO) != 0;
  context.color_results = colors && isatty(STDOUT_FILENO) != 0;

  CLI::App app{"Papilla: inverse design of surface textures for touch", "papilla"};
  app.set_version_flag("--version", "papilla " PAPILLA_VERSION);
  app.add_flag("-q,--quiet", context.quiet, "No progress messages");
  app.fallthrough();
  app.require_subcommand(1);
  for (const auto& add : kCommands) add(app, context);

  if (!knows_command(app, argc, argv, context)) return kWrongInput;
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {  // --help, --version
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    print_error(context, e.what());
    std::string chosen;
    for (auto level = app.get_subcommands(); !level.empty();
         level = level.front()->get_subcommands())
      chosen += level.front()->get_name() + " ";
    std::cerr << "try: papilla " << chosen << "--help" << std::endl;
    return kWrongInput;
  }

  try {
    const int status = context.action();
    std::cout.flush();
    if (!std::cout) {
      print_error(context, "cannot write to standard output");
      return kWorkFailed;
    }
    return status;
  } catch (const InputError& e) {
    for (const Problem& problem : e.problems()) print_error(context, problem.text());
    return kWrongInput;
  } catch (const std::bad_alloc&) {
    print_error(context, "not enough memory");
  } catch (const std::exception& e) {
    print_error(context, e.what());
  }
  return kWorkFailed;
}

}  // namespace
}  // namespace papilla

int main(int argc, char** argv) {
  papilla::keep_freed_memory();
  return papilla::run(argc, argv);
}
