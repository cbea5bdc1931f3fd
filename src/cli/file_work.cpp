#include "cli/file_work.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <utility>

#include "base/text.h"

namespace papilla::cli {

FileWork::FileWork(const Context& context, std::string doing)
    : ticker_([this, &context, doing = std::move(doing)] { tick(context, doing); }) {}

FileWork::~FileWork() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  ticker_.join();
}

FileProgress FileWork::progress() {
  return [this](const std::string& file, double share) {
    const std::lock_guard lock(mutex_);
    file_ = file;
    share_ = share;
  };
}

void FileWork::tick(const Context& context, const std::string& doing) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  bool shown = false;
  std::string last;
  std::unique_lock lock(mutex_);
  for (int second = 1;; ++second) {
    if (changed_.wait_for(lock, std::chrono::seconds(1), [this] { return ended_; })) break;
    // On a terminal each second; in a file or a pipe each ten, the same again each minute.
    if (context.quiet || file_.empty() || (!terminal && second % 10 != 0)) continue;
    std::string line = fmt::format("{} {}", doing, visible(file_));
    if (share_ > 0) line += fmt::format(": {:.0f} %", 100 * share_);
    if (!terminal && line == last && second % 60 != 0) continue;
    last = line;
    if (terminal) {
      std::cerr << "\r\033[K" << line << std::flush;
    } else {
      std::cerr << line << std::endl;
    }
    shown = true;
  }
  if (shown && terminal) std::cerr << "\r\033[K" << std::flush;
}

int verdict_status(const ExportVerdict& verdict) {
  for (const std::string& fault : fault_lines(verdict))
    std::cerr << "not sound: " << visible(fault) << '\n';
  if (!verdict.readable()) return kWrongInput;
  return verdict.sound() ? kSuccess : kWorkFailed;
}

}  // namespace papilla::cli
