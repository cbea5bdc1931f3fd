// The lab of a search: which measurement next, and what was measured, by the commands that a person
// would run. It is a folder beside the results of the search, and remembers everything.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::studio {

class LabDesk {
 public:
  // program: that runs `next` and `tell`. told: of every change, from the desk's own thread.
  LabDesk(std::filesystem::path folder, std::string program, std::function<void()> told);
  ~LabDesk();  // closes
  LabDesk(const LabDesk&) = delete;
  LabDesk& operator=(const LabDesk&) = delete;

  // results: the folder of a finished search, as SearchDesk::results() has it. Both throw
  // InputError where there is none, or where the desk is at work.
  void plan(const std::string& results, int touches);
  // files: kept before. replace: readings take the place of those that they contradict, and of what
  // the same file was told as before.
  void tell(const std::string& results, const std::vector<std::string>& files, bool replace);
  // A table or a record of a tribometer, kept under its name. Throws InputError.
  void keep(const std::string& results, const std::string& name, const std::string& bytes) const;
  void stop();
  // What works is ended, and nothing is told any more; a lab loses nothing that it had said. Before
  // what `told` asks goes.
  void close();

  nlohmann::ordered_json json(const std::string& results) const;  // all that the page draws

 private:
  void begin(const std::string& results, std::string doing, std::vector<std::string> words);
  void work(const std::string& results, const std::vector<std::string>& words);
  void ended(const std::string& results, bool done);

  Folder folder_;
  std::string program_;
  std::function<void()> told_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string doing_, trouble_, trouble_of_;  // what works; what went wrong, with which results
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace papilla::studio
