// Files that are written or checked: a word of it each second once it takes longer than one, and
// what their verdict means for the exit status.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "base/rooms.h"
#include "cli/context.h"
#include "fabricate/export.h"
#include "report/export.h"

namespace papilla::cli {

// While one lives, a line of progress: on a terminal each second, else each ten.
class FileWork {
 public:
  FileWork(const Context& context, std::string doing);
  ~FileWork();
  FileWork(const FileWork&) = delete;
  FileWork& operator=(const FileWork&) = delete;

  FileProgress progress();

 private:
  void tick(const Context& context, const std::string& doing);

  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
  std::string file_;
  double share_ = 0;
  std::thread ticker_;
};

// Prints every fault; kSuccess, kWorkFailed for files that differ, kWrongInput for unreadable ones.
int verdict_status(const ExportVerdict& verdict);

}  // namespace papilla::cli
