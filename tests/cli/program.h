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
#include "tests/temporary.h"

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

// A folder of its own for one test.
class Workplace {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path() / name).parent_path());
    std::ofstream(path() / name, std::ios::binary) << text;
    return name;
  }
  // papilla ARGUMENTS in this folder; output is captured outside it.
  Outcome run(const std::string& arguments) const {
    return shell("'" PAPILLA_PROGRAM "' " + arguments);
  }
  Outcome shell(const std::string& command) const {
    const std::string log = path().string() + ".log";
    const int code = std::system(("cd '" + path().string() + "' && ( " + command + " ) > '" + log +
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
         std::filesystem::recursive_directory_iterator(path())) {
      ++count;
    }
    return count;
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace papilla::tests
