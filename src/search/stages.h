// The stages of a run, one after another, and what they share.
#pragma once

#include <chrono>
#include <string>

#include "optim/mpi.h"
#include "search/folder.h"
#include "search/replay.h"
#include "search/run.h"

namespace papilla {

struct Run {
  // Refuses what can be refused before anything is written. Throws InputError.
  Run(const Study& study, const OptimiseOptions& options, const MpiSession& mpi);

  double seconds() const;  // since the run began
  bool stopped() const { return options.stop && options.stop->load(); }
  // Before a new evaluation: what the journal answers costs nothing.
  bool stopped_before_next() const { return !replay.replaying() && stopped(); }
  // left: expected seconds to the end; < 0: not known.
  void progress(const char* stage, int done, int total, double left) const;
  // Expected of so many designs at a stage, by what one of the search took.
  double seconds_of(std::size_t designs, Stage stage) const;
  double seconds_to_confirm() const;  // and check
  // Whether the design was evaluated, not refused before.
  bool add_to_history(const Point& unit, const Judgement& judgement);

  const std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  const Study& study;
  const OptimiseOptions& options;
  const StudyProblem problem;
  const SearchProblem search;
  const SearchMethod method;
  const std::string folder;
  FolderLock lock;
  Replay replay;

  JudgedDesigns history, narrowed;  // of the search; of the level between
  OptimiseResult result;
  std::string unmet_pick;  // why the rule of options.pick fits no design of the front
};

// Each returns false where the run was interrupted.

// Cheap evaluations that a searcher asks for, as many as the budget and the time allow.
bool search_designs(Run& run);

// The search's level is noisy and biased, and not everywhere alike. On other skins and a finer grid
// its best designs are judged again, then others where the front has most to gain, with the
// search's evaluations as drafts (Eq. search.7-8): the finalists come from these.
bool narrow(Run& run);

// The finalists at the study's accuracy: these numbers decide the front.
bool confirm(Run& run);

// What is said of the front and the best beside their numbers: whether the order holds under other
// models, what is the texture's, what the variables and the fit of the finger do.
bool check(Run& run);

}  // namespace papilla
