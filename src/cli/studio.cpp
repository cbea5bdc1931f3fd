// papilla studio [DESIGN|STUDY|RESULTS]: the page where a texture is designed.
#include "studio/studio.h"

#include <signal.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "base/error.h"
#include "cli/commands.h"

extern char** environ;

namespace papilla::cli {
namespace {

struct StudioCommand {
  std::string file, folder;
  int port = 0;
  bool no_open = false;
};

// In the browser that the desktop names; where there is none, the address is printed all the same.
void open_page(const Studio& studio) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
  char name[] = "xdg-open";
  std::string file = studio.opening_file();
  char* words[] = {name, file.data(), nullptr};
  pid_t child = 0;
  ::posix_spawnp(&child, name, nullptr, nullptr, words, environ);
}

int serve(const Context& context, const StudioCommand& command) {
  // Waited for below, in this thread; threads that start from here on inherit that.
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGINT);
  sigaddset(&ends, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &ends, nullptr);
  ::signal(SIGPIPE, SIG_IGN);

  StudioOptions options;
  options.file = command.file;
  options.folder = command.folder;
  options.port = command.port;
  options.program = std::filesystem::read_symlink("/proc/self/exe").string();
  const Studio studio(options);
  std::cout << studio.address() << std::endl;
  context.note("the studio serves this computer alone; Ctrl-C ends it, what was changed is kept");
  if (!command.no_open) open_page(studio);
  int signal = 0;
  ::sigwait(&ends, &signal);
  return signal == SIGINT ? kSuccess : kSignalled + signal;
}

}  // namespace

void add_studio(Command app, Context& context) {
  Command command = app.add_command(
      "studio", "The page where a texture is designed: sliders, curves, searches, masks");
  auto options = std::make_shared<StudioCommand>();
  command
      .add_option("file", options->file,
                  "Design, study, or folder of results; default: the shipped hole array")
      .type_name("FILE");
  command.add_option("--port", options->port, "Of the page on this computer; 0: any that is free")
      .range(0, 65535)
      .show_default();
  command
      .add_option("--folder", options->folder,
                  "The one folder that the page may read and write, made if it is not there; "
                  "default: that of the file, of a shipped design the working folder")
      .type_name("DIR");
  command.add_flag("--no-open", options->no_open, "Print the address and open no browser");
  command.document(
      {"Serves one page on this computer: sliders of a design, its friction over humidity with "
       "error "
       "bands while they move, pinned designs beside each other, a search to watch and to steer, "
       "masks. "
       "Nothing leaves the computer, and nothing outside the folder is read or written.",
       {{"papilla studio m3_samples/a3h600.toml", "begin with a published sample"},
        {"papilla studio electroadhesive_glass/study.toml --no-open --port 8080",
         "a study; print the address alone"}},
       {{"FOLDER/.studio", "the session: draft, pins, searches"},
        {"FOLDER/searches/NNN", "folders of results as of `papilla optimize`"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return serve(context, *options); };
  });
}

}  // namespace papilla::cli
