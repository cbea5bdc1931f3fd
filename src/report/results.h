// The folder of a run: tables, one folder a design of the front, the best, a summary.
#pragma once

#include <string>
#include <vector>

#include "search/run.h"

namespace papilla {

// Refuses a second run in the same folder while this one lives (released by the system when the
// process ends, however it ends). Throws InputError.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

struct ResultFiles {
  const std::string& folder;
  const Study& study;
  const StudyProblem& problem;
  const std::vector<Evaluation>& history;
  OptimiseResult& result;   // hypervolumes are filled in
  const std::string& pick;  // rule that chose the best design
};
void write_results(const ResultFiles& files);

}  // namespace papilla
