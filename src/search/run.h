// Runs a study: searches cheaply, confirms the finalists at the study's accuracy on fresh skins,
// checks what is said of them. Resumable after a kill at any moment.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "forward/response.h"
#include "search/clock.h"
#include "search/decision.h"
#include "search/findings.h"
#include "search/problem.h"
#include "search/protocol.h"
#include "search/sensitivity.h"
#include "search/stability.h"

namespace papilla::search {

struct Progress {
  std::string stage;  // "draft", "search", "narrow", "confirm", "belief", "check"
  int done = 0, total = 0;
  std::string best;         // best values so far, for people
  double seconds_left = 0;  // to the end of the run; < 0: not known yet
  double share = 0;         // of the whole run that is done, by the clock
};

// In the folder of a run that works: the last Progress, as JSON.
inline constexpr const char* kProgressFile = ".progress.json";

// Why the search ended.
enum class SearchEnd {
  Budget,     // as many evaluations as were asked for
  Exhausted,  // the method had nothing more to try
  Refusals,   // the limits of the shape refused ten times the budget
  Clock,
  Asked,   // OptimiseOptions::finish
  Before,  // in the run that is resumed, which went on to its confirmation
};

// A part of the run that the clock cut: evaluations, designs, or 0 of 1 where it was left out.
struct ClockCut {
  RunPart part = RunPart::Search;
  std::size_t done = 0, of = 0;
};

struct SkinnedScore {
  Score score;
  std::vector<Score> by_skin;  // as each of the skins moves it by a standard error
};

struct FinalDesign {
  Point unit;         // empty: the study's own surface, where that lies outside the space
  bool flat = false;  // the surface without its texture, which `unit` still has
  Design design;
  Score searched, confirmed;
  std::vector<TaskAnswer> answers;  // behind the confirmed score, without their reports
  std::vector<Score> members;       // at each member of belief; empty: not asked for
  // Where `members` are. [skin]: as each of the skins behind the answers moves `confirmed` by a
  // standard error. few: the members on few skins by themselves, last the finger as it is.
  std::vector<Score> confirmed_by_skin;
  std::vector<SkinnedScore> few;
  bool feasible = false, on_front = false;
  // "front/01"; "best" for the least-violating one where none keeps every constraint; empty for the
  // rest.
  std::string folder;
};

// What is made: the recommended design with its numbers on the grid of the fab.
struct BuiltDesign {
  FinalDesign made;      // confirmed: ok where it was judged, at the level of the confirmation
  bool widened = false;  // nearer designs of the grid break a limit
  bool on_grid = true;   // no: it is as searched, for those of the grid that were judged break one
  std::size_t judged = 0;                // designs of the grid
  std::optional<FinalDesign> nearest{};  // of the grid that keeps the limits of the shape, judged
};

struct OptimiseResult {
  std::string method, why;
  int evaluations = 0, failures = 0, refused = 0;  // refused: by geometry, without an evaluation
  int lost = 0;           // damaged records of the resumed run, computed anew
  std::string kept_copy;  // of its journal as it was, where there are some
  int asked = 0;          // evaluations
  SearchEnd end = SearchEnd::Budget;
  std::vector<ClockCut> cuts;  // by the time limit, in the order of the run
  std::vector<OneValue> one_value;
  std::vector<AtBound> at_bound;  // of the best design
  Fidelity confirmed_with;        // of the finalists
  bool interrupted = false;
  bool any_feasible = false;
  std::vector<std::string> never_kept;  // constraints that no design of the search keeps
  std::vector<FinalDesign> finalists;   // by first objective, best first
  std::size_t best = 0;                 // of the finalists: highest worst modulation, or as picked
  std::optional<Score> flat;            // the best surface without its texture, confirmed
  std::optional<Score> flat_before;  // the study's own, where the best has another finish or drive
  // Either, where it was asked and has no answer, as of a surface that is pulled in.
  std::optional<Score> flat_unanswered, flat_before_unanswered;
  std::optional<BuiltDesign> build;
  Decision decision;           // by belief
  std::optional<Yield> yield;  // of what is built, where it was judged and numbers scatter
  Stability stability;         // of the order of the finalists on the front, in their order
  std::vector<VariableSensitivity> sensitivity;  // of what is built
  std::vector<double> hypervolumes;              // after each evaluation (two objectives or more)

  bool has_best() const { return !finalists.empty() && finalists[best].confirmed.ok; }
};

// A run as its folder shows it.
struct ResultFiles {
  const std::string& folder;
  const Study& study;
  const StudyProblem& problem;
  const JudgedDesigns& history;  // of the search
  const OptimiseResult& result;
  const std::string& pick;  // rule that chose the best design
};

// Makes files of values, for the folder of a run.
class ResultWriter {
 public:
  virtual ~ResultWriter() = default;
  // The response of a confirmed task; called in workers.
  virtual std::string text(const Response& response) const = 0;
  // Tables, designs and pages, once the run has ended.
  virtual void write(const ResultFiles& files) const = 0;
};

struct OptimiseOptions {
  std::string folder;
  bool resume = false;
  std::function<void(const Progress&)> progress;  // may be empty
  const std::atomic<bool>* stop = nullptr;        // set by Ctrl-C: ends after what runs
  std::string pick{};  // which design of the front is the best: a rule of pick_design
  const ResultWriter* writer =
      nullptr;          // none: the folder has the journal, the plan and no results
  bool finish = false;  // no new design but a first: those of the journal are judged and confirmed
};

// Throws InputError for a folder that belongs to another study or is in use, for one without a run
// to resume, and for a rule of `pick` that no front could meet; the folder is then as before.
// Launched by mpirun as several processes, rank 0 does this and the others evaluate for it and
// return an empty result.
OptimiseResult optimise(const Study& study, const OptimiseOptions& options);

}  // namespace papilla::search
