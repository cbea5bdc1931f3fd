// `papilla next` and `papilla tell`: a lab's folder with every file that is made of its journal.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/lab.h"
#include "report/lab_source.h"

namespace papilla::report {

struct NextRun {
  LabSource source;    // one path that is a lab: it goes on
  std::string folder;  // of a new lab; "": named after the source, below labs/
  NextOptions options;
  int threads = 0;
  std::function<void(const std::string&)> note;  // for people
};
struct NextReport {
  std::string folder, markdown, json;
  bool stop = false;
};
// Opens the lab where it is not one yet, plans, and writes the folder. Throws InputError.
NextReport next_in_lab(const NextRun& run);

struct TellRun {
  std::string folder;
  std::vector<std::string> files;
  TellOptions options;
  int threads = 0;
  std::function<void(const std::string&)> note;
};
struct TellReport {
  std::string markdown, json;
  std::vector<Problem> refused;  // files of which nothing was kept, and why
};
// Each file by itself: one that is refused keeps none of the others back.
TellReport tell_lab(const TellRun& run);

// Where a lab stands, without doing anything: text and JSON.
NextReport lab_state(const std::string& folder, int threads);

}  // namespace papilla::report
