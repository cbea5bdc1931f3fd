// Runs the built program, as a user would.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "base/rooms.h"

namespace papilla::tests {

struct Outcome {
  int status = 0;
  std::string out, err;
};

inline std::string file_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream buffer;
  buffer << stream.rdbuf();
  return buffer.str();
}

// A folder of its own for one test, removed at the end.
class Workplace {
 public:
  Workplace() {
    std::string name =
        std::filesystem::temp_directory_path() / ("papilla-cli-" + std::string(6, 'X'));
    path_ = mkdtemp(name.data());
  }
  ~Workplace() { std::filesystem::remove_all(path_); }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return name;
  }
  // papilla ARGUMENTS in this folder; output is captured outside it.
  Outcome run(const std::string& arguments) const {
    return shell("'" PAPILLA_PROGRAM "' " + arguments);
  }
  Outcome shell(const std::string& command) const {
    const std::string log = path_.string() + ".log";
    const int code = std::system(("cd '" + path_.string() + "' && ( " + command + " ) > '" + log +
                                  ".out' 2> '" + log + ".err' < /dev/null")
                                     .c_str());
    Outcome result{WIFEXITED(code) ? WEXITSTATUS(code) : -1, file_text(log + ".out"),
                   file_text(log + ".err")};
    std::filesystem::remove(log + ".out");
    std::filesystem::remove(log + ".err");
    return result;
  }
  int entries() const {
    int count = 0;
    for ([[maybe_unused]] const auto& entry :
         std::filesystem::recursive_directory_iterator(path_)) {
      ++count;
    }
    return count;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace papilla::tests
