// Which measurement settles a decision, and what measurements change: a lab's folder, as `papilla
// next` and `papilla tell` keep it. docs/how_to/measuring.md
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "papilla/design.h"
#include "papilla/error.h"

namespace papilla::api {

struct NextExperimentOptions {
  std::string folder;   // of a new lab; empty: below labs/
  std::string purpose;  // "decision", "hypotheses", "parameters"; empty: what there is to settle
  int count = 10;       // touches, at most
  double seconds = 0;   // of work, at most; 0: no limit
  std::string belief;   // a file; empty: that of the designs' finger
  std::string worth;    // a metric that designs are compared by; empty: as `papilla next`
  std::string load, humidity, voltage, frequency,
      states;                           // lists, "0 V,100 V"; empty: the designs'
  Design::Values values;                // of a new lab.toml: {"instrument.repeatability", "2 %"}
  std::string finger = "1", day, date;  // day, date: empty: today
  int threads = 0;                      // 0: all processors
  std::function<void(const std::string&)> progress;  // for people; may be empty
  const std::atomic<bool>* stop =
      nullptr;  // set by another thread: next_experiments() throws Stopped
};

struct NextExperiments {
  std::string folder;       // of the lab
  bool stop = false;        // no more experiments are worth it
  std::string table, json;  // of the command
};

// sources: a folder of results, a wafer's manifest.csv, designs, a calibration; or a lab, which
// goes on. Throws InputError, Stopped.
NextExperiments next_experiments(const std::vector<std::string>& sources,
                                 const NextExperimentOptions& options = {});

struct TellOptions {
  // Of the files as a whole, where they do not say it themselves; date: empty: today.
  std::string experiment, field, design, finger, day, date;
  // Readings take the place of those that they contradict, and of what the same file was told as
  // before; else another value is refused, and a file that is told again is counted once.
  bool replace = false;
  int threads = 0;
  std::function<void(const std::string&)> progress;  // for people; may be empty
  const std::atomic<bool>* stop = nullptr;  // set by another thread: tell_lab() throws Stopped
};

struct TellResult {
  std::vector<Problem> refused;  // files of which nothing was kept, and why
  std::string table, json;       // of the command
};

// Tables of friction, and records of a tribometer. A file that is refused keeps none of the others
// back. Throws InputError where the folder is no lab, Stopped.
TellResult tell_lab(const std::string& folder, const std::vector<std::string>& files,
                    const TellOptions& options = {});

struct LabState {
  std::string page, json;  // lab.md, lab.json
};
LabState lab_state(const std::string& folder, int threads = 0);

}  // namespace papilla::api
