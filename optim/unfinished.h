// What long work has answered, on disk: work that was interrupted asks the same again and is
// answered from the file.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "base/rooms.h"
#include "optim/journal.h"

namespace papilla::optim {

class Unfinished {
 public:
  Unfinished() = default;  // keeps nothing
  // The folder must exist. `problem`: all that an answer depends on but its key; answers to another
  // problem lie in another file. Throws InputError where the file cannot be written.
  Unfinished(const std::string& folder, const std::string& problem);

  int known() const { return static_cast<int>(payloads_.size()); }
  const std::string& file() const { return path_; }
  // nullptr: not kept. Anybody can have written the file: whoever asks checks what it says.
  const std::string* find(const std::string& key) const;
  void keep(const std::string& key, const std::string& payload);
  void remove();  // the work has ended

 private:
  std::string path_;
  std::unique_ptr<Journal> journal_;
  std::map<std::string, std::string> payloads_;
};

}  // namespace papilla::optim
