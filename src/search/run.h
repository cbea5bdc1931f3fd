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
  Budget,     // all evaluations that were asked for are done
  Exhausted,  // the method had nothing more to try
  Refusals,   // evaluated plus refused designs (limits of the shape): ten times the budget
  Clock,      // the time limit
  Asked,      // OptimiseOptions::finish
  Before,     // it had ended in the run that is resumed, for a reason that its journal does not say
};

// A part of the run that the clock cut: evaluations, designs, or 0 of 1 where it was left out.
struct ClockCut {
  RunPart part = RunPart::Search;
  std::size_t done = 0, of = 0;
};

struct ScoreBySkin {
  Score score;
  std::vector<Score> by_skin;  // [skin] the score, moved by that skin's share of its standard error
};

struct FinalDesign {
  Point unit;
  bool flat = false;  // the surface without its texture, which `unit` still has
  Design design;
  Score searched, confirmed;
  std::vector<TaskAnswer> answers;  // behind the confirmed score, without their reports
  std::vector<Score> members;       // at each member of belief; empty: not asked for or unjudged
  // Why a task that was asked for its members has none, for people; "": none is missing.
  std::string unjudged;
  // All are empty where `members` is. confirmed_by_skin: [skin] `confirmed`, moved by that skin's
  // share of its standard error. few: the scores on few skins alone, one per member and last the
  // finger as it is; `members` are `confirmed` moved by the differences between these.
  std::vector<Score> confirmed_by_skin;
  // `confirmed`, moved by a standard error of what few skins say of its correction to the 3-D
  // field.
  Score confirmed_by_field;
  std::vector<ScoreBySkin> few;
  bool feasible = false, on_front = false;
  // "front/01"; "best" for the least-violating one where none keeps every constraint; empty for the
  // rest.
  std::string folder;
};

// The design to build: the recommended one with its dimensions rounded to the grid of the fab.
struct BuiltDesign {
  FinalDesign made;      // `confirmed` is ok if it was evaluated, at the confirmation's accuracy
  bool widened = false;  // rounded designs that are nearer to the recommended one break a limit
  // True too where nothing is rounded: without a grid, and of the study's own surface.
  // False: every rounded design breaks a limit, by its shape or as it was evaluated, so `made` is
  // not rounded.
  bool on_grid = true;
  std::size_t judged = 0;  // how many rounded designs were evaluated
  // The nearest rounded design that keeps the limits of the shape, if it was evaluated.
  std::optional<FinalDesign> nearest{};
};

struct OptimiseResult {
  std::string method, why;
  int evaluations = 0, failures = 0, refused = 0;  // refused: by geometry, without an evaluation
  int lost = 0;           // damaged records in the journal of the resumed run; computed again
  std::string kept_copy;  // if lost > 0: where the damaged journal is kept
  int asked = 0;          // the budget: how many evaluations were asked for
  SearchEnd end = SearchEnd::Budget;
  std::vector<ClockCut> cuts;  // by the time limit, in the order of the run
  std::vector<OneValue> one_value;
  std::vector<AtBound> at_bound;  // of the best design
  Fidelity confirmed_with;        // of the finalists
  bool interrupted = false;
  bool any_feasible = false;
  std::vector<std::string> never_kept;  // constraints that no design of the search keeps
  std::vector<FinalDesign> finalists;   // by first objective, best first
  // Index in `finalists`: the design that was picked by number; else the choice over the belief
  // where there is one; else by the pick rule.
  std::size_t best = 0;
  std::optional<Score> flat;  // the best surface without its texture, confirmed
  // Where the best has another finish or drive than the study: its surface without its texture, on
  // the same patch and skins, with the study's own.
  std::optional<Score> flat_before;
  // `flat` or `flat_before` if it was evaluated and has no answer, for example because of pull-in.
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
  bool finish = false;  // search no further (but for one design if the journal has none); confirm
  double spent = 0;     // of the study's time, on preparing it [s]
};

// Throws InputError for a folder that belongs to another study or is in use, for one without a run
// to resume, and for a rule of `pick` that no front could meet; the folder is then as before.
// Launched by mpirun as several processes, rank 0 does this and the others evaluate for it and
// return an empty result.
OptimiseResult optimise(const Study& study, const OptimiseOptions& options);

}  // namespace papilla::search
