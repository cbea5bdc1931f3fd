// The folder of a run: tables, one folder per design of the front, the best, a summary.
#pragma once

#include <string>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

class FolderWriter : public ResultWriter {
 public:
  std::string text(const Response& response) const override;
  void write(const ResultFiles& files) const override;
};

// Searches, and writes the folder of results.
OptimiseResult optimise_to_folder(const Study& study, OptimiseOptions options);

// What the run of a folder recommends, in a sentence; empty where it is not finished.
std::string recommendation_of(const std::string& folder);

// Of the folder of a run: whether the numbers of its best/build.toml were rounded to the grid of
// the fab, for who takes them.
std::string build_sheet_text(const std::string& folder);

// All files of the folder but its page.
void write_results(const ResultFiles& files);

}  // namespace papilla::report
