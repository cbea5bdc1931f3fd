// `papilla verify RESULTS`: a run's answers made again, and everything that its folder says held
// against what follows from them.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "report/receipts.h"

namespace papilla::report {

// What a finished run of `papilla optimize` has and the folder has not; none: it is one. And
// whether it has receipts.
std::vector<std::string> missing_of_run(const std::string& folder);
bool has_receipts(const std::string& folder);
// run.json names them: without, they were taken away.
bool promises_receipts(const std::string& folder);

struct RunChecking {
  std::vector<std::string> receipts;                  // their ids; empty: all
  double seconds = 600;                               // for the answers, AskingAgain::seconds
  int jobs = 0;                                       // 0: all processors
  std::function<void(int done, int total)> progress;  // may be empty
  const std::atomic<bool>* stop = nullptr;
};

enum class ReceiptState {
  Holds,
  Violated,
  NotRecomputed,  // the time was too short for what it rests on
};
const char* receipt_state_name(ReceiptState state);  // "holds", "violated", "not recomputed"

struct ReceiptVerdict {
  Receipt receipt;  // as recomputed
  ReceiptState state = ReceiptState::Holds;
  std::vector<std::string> says;  // what the folder says otherwise, with its place
};

struct RunVerdict {
  std::vector<ReceiptVerdict> receipts;
  std::vector<std::string> others;  // what the folder says otherwise besides
  int answered = 0, asked = 0;      // of the model
  double seconds = 0;

  bool holds() const;  // every number, and nothing besides is otherwise
  std::size_t count(ReceiptState state) const;
};

// What follows from the study and the questions of a run, in a folder of its own that is removed at
// its end.
class RecomputedRun {
 public:
  // Throws InputError for a folder that is no finished run, is of another version, or whose journal
  // is of another study.
  RecomputedRun(const std::string& folder, const RunChecking& how);
  ~RecomputedRun();
  RecomputedRun(const RecomputedRun&) = delete;
  RecomputedRun& operator=(const RecomputedRun&) = delete;

  // What a folder of this run, or a copy of it, says.
  RunVerdict judge(const std::string& folder) const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

RunVerdict verify_run(const std::string& folder, const RunChecking& how);

// For people, a line a number; for programs.
std::string run_verdict_text(const RunVerdict& verdict);
nlohmann::ordered_json run_verdict_json(const std::string& folder, const RunVerdict& verdict);

}  // namespace papilla::report
