// The stages of a run, one after another, and what they share.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "base/rooms.h"
#include "optim/mpi.h"
#include "search/clock.h"
#include "search/replay.h"
#include "search/run.h"

namespace papilla::search {

struct Run {
  // Refuses what can be refused before anything is written. Without a team workers here answer, or
  // the ranks of the session. Throws InputError.
  Run(const Study& study, const OptimiseOptions& options, const MpiSession& mpi,
      std::unique_ptr<Team> team = nullptr);

  // left: expected seconds to the end; < 0: not known.
  void progress(const char* stage, int done, int total, double left) const;
  // Expected of so many tasks at a stage: by what those took that were done, else by what one of
  // the search took and what plans say of both; 0: nothing was timed yet.
  double seconds_of(std::size_t tasks, Stage stage) const;
  double seconds_of_designs(std::size_t designs, Stage stage) const;
  // Finalists that may keep every limit: of those that are confirmed the ones that do, and those to
  // come; before there are any, as many as there may be.
  std::size_t may_hold() const;
  PartSeconds wanted() const;             // of each part in full
  double seconds_from(RunPart on) const;  // wanted by this part and all that follow
  // Whether work of so many seconds still fits into the present part; true without a limit.
  bool fits(double seconds) const { return seconds <= clock.left(wanted()); }
  // Whether to begin a part that is done whole or not at all: as the journal says, else the clock.
  bool begin(RunPart part, Stage stage, bool flat, double seconds);
  // Whether to do one more of a part that has begun, so too.
  bool goes_on(Stage stage, bool flat, double seconds) const;
  // Where the clock cut a part.
  void cut(RunPart part, std::size_t done, std::size_t of);
  double price(Stage stage, double most_seconds) const;  // task_price, computed once
  // Of one task, in units that what was timed gives its seconds.
  double expected_seconds(Stage stage) const;
  // Whether the design was evaluated, not refused before.
  bool add_to_history(const Point& unit, const Judgement& judgement);

  RunClock clock;
  const Study& study;
  const OptimiseOptions& options;
  const StudyProblem problem;
  const SearchProblem search;
  const SearchMethod method;
  const Folder folder;
  FolderLock lock;
  Replay replay;

  JudgedDesigns history, narrowed;  // of the search; of the level between
  std::size_t chosen = 0;  // designs that the confirmation was to judge so far; 0: not known yet
  double confirm_seconds = 0;  // that a confirmed task may cost, as plans price it; 0: any
  OptimiseResult result;
  std::string unmet_pick;  // why the rule of options.pick fits no design of the front

 private:
  // Whether to ask what no record answers: not of a stage that the journal goes beyond, which the
  // clock cut, but of a design that the earlier run did not pick.
  bool may_ask(Stage stage, bool flat, double seconds) const;

  mutable std::map<std::pair<Stage, double>, double> prices_;
  mutable double told_ =
      0;  // when the folder was last told of the progress [s since the run began]
};

// Each throws WorkStopped where the run was interrupted before something that no journal answers.

// Cheap evaluations that a searcher asks for, as many as the budget and the time allow.
void search_designs(Run& run);

// The search's level is noisy and biased, and not everywhere alike. On other skins and a finer grid
// its best designs are judged again, then others where the front has most to gain, with the
// search's evaluations as drafts (Eq. search.7-8): the finalists come from these.
void narrow(Run& run);

// The finalists at the study's accuracy: these numbers decide the front.
void confirm(Run& run);

// Designs whose members of belief are evaluated: the finalists that may keep every limit.
std::size_t believed(const Run& run);
// The finalists at every member of belief: which are on the front, and which to build.
void judge_belief(Run& run);
// The front first, each of its designs with its folder, by the first objective.
void order_finalists(Run& run);

// What is said of the front and the best beside their numbers: whether the order holds under other
// models, what is the texture's, what the variables and the fit of the finger do.
void check(Run& run);

}  // namespace papilla::search
