// papilla COMMAND ...: reads the command line, runs one subcommand, turns errors into exit codes:
// 0 success, 1 the work failed, 2 wrong input. Results go to standard output, the rest to standard
// error.
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/licences.h"

namespace papilla::cli {
namespace {

void print_error(const Context& context, const std::string& text) {
  std::cout.flush();
  std::cerr << (context.color ? "\033[1;31merror:\033[0m " : "error: ") << visible(text)
            << std::endl;
}

std::vector<std::string> names_of(const std::vector<Command>& commands) {
  std::vector<std::string> names;
  for (const Command command : commands) names.push_back(command.name());
  return names;
}

// The words of a command line, `help` in the place of a command as --help behind them: "papilla
// help solve contact" is "papilla solve contact --help".
std::vector<const char*> with_help(Command level, int argc, char** argv) {
  std::vector<const char*> words(argv, argv + argc);
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string word = words[i];
    if (word.starts_with('-')) continue;
    const std::vector<Command> commands = level.commands();
    const auto found = std::find_if(commands.begin(), commands.end(),
                                    [&](Command command) { return command.name() == word; });
    if (found != commands.end()) {
      level = *found;
      continue;
    }
    if (!commands.empty() && word == "help") {
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(i));
      words.push_back("--help");
    }
    break;
  }
  return words;
}

// A word in the place of a command that is none (papilla foo, papilla solve foo): the parser would
// only say that it was not expected.
bool knows_command(Command level, const std::vector<const char*>& words, const Context& context) {
  for (std::size_t i = 1; i < words.size() && words[i][0] != '-'; ++i) {
    const std::vector<Command> commands = level.commands();
    if (commands.empty()) return true;
    const std::vector<std::string> names = names_of(commands);
    const auto found = std::find(names.begin(), names.end(), words[i]);
    if (found != names.end()) {
      level = commands[static_cast<std::size_t>(found - names.begin())];
      continue;
    }
    const std::string near = nearest_name(words[i], names);
    const std::string above = i > 1 ? level.name() + " " : "";
    print_error(context, near.empty() ? fmt::format("unknown command `{}{}`; known: {}", above,
                                                    words[i], join_names(names))
                                      : fmt::format("unknown command `{}{}`, did you mean `{}{}`?",
                                                    above, words[i], above, near));
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

  const CommandLine line("papilla", "papilla " PAPILLA_VERSION, licences,
                         "Papilla: inverse design of surface textures for touch");
  const Command program = line.program();
  program.add_flag("-q,--quiet", context.quiet, "No progress messages");
  for (const auto& add : kCommands) add(program, context);

  for (int i = 1; i < argc; ++i) {
    // Else it would be found by what writes it down, after the work.
    if (is_utf8(argv[i])) continue;
    print_error(context, std::string("\"") + argv[i] +
                             "\" is no UTF-8, which every name in a result is; rename the file or "
                             "the folder");
    return kWrongInput;
  }
  const std::vector<const char*> words = with_help(program, argc, argv);
  if (!knows_command(program, words, context)) return kWrongInput;
  try {
    if (!line.parse(static_cast<int>(words.size()), words.data())) return kSuccess;
  } catch (const CommandLineError& e) {
    print_error(context, e.what());
    std::cerr << "try: papilla " << e.commands() << "--help" << std::endl;
    return kWrongInput;
  } catch (const std::exception& e) {  // --licences without the module of images
    print_error(context, e.what());
    return kWorkFailed;
  }

  try {
    const int status = context.action();
    std::cout.flush();
    if (!std::cout) {
      // A reader that has seen enough ("papilla describe | head") is no failure.
      if (errno == EPIPE) return kSuccess;
      print_error(context, "cannot write to standard output");
      return kWorkFailed;
    }
    return status;
  } catch (const FailedWrite& e) {
    print_error(context, e.what());
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

// An error where nothing can be caught: before there is a command, or in a function of a library
// that may not throw (destructors of JSON need memory). The end is told all the same, with no more
// memory; what is not an error is a fault of the program, whose core tells where.
void end_uncaught() {
  bool told = std::uncaught_exceptions() > 0;  // thrown, and no handler begun
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    told = true;
  } catch (...) {
    told = false;
  }
  constexpr std::string_view kWords =
      "error: not enough memory; a file under way may be left as .NAME.part, the next run removes "
      "it\n";
  if (!told || ::write(STDERR_FILENO, kWords.data(), kWords.size()) < 0) std::abort();
  ::_exit(kWorkFailed);
}

}  // namespace
}  // namespace papilla::cli

int main(int argc, char** argv) {
  // A file that may not grow is told as any other that cannot be written.
  ::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(papilla::cli::end_uncaught);
  papilla::base::keep_freed_memory();
  const int status = papilla::cli::run(argc, argv);
  if (status == papilla::cli::kSuccess) return status;
  // What ends libraries' static objects takes for granted that all their work succeeded.
  std::cout.flush();
  ::_exit(status);
}
