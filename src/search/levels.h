// How accurate each stage of a run is, how many designs it judges and what that costs.
#pragma once

#include <string>

#include "base/rooms.h"
#include "search/problem.h"
#include "search/protocol.h"

namespace papilla::search {

inline constexpr std::size_t kFinalists = 8;
// Fewer than these are no level between: finalists then come from the search.
inline constexpr std::size_t kFewNarrowed = 4;

// most_seconds: of a task, as plans price it; fewer skins, then fewer pixels where it costs more;
// 0: anything.
Fidelity stage_fidelity(const StudyProblem& problem, Stage stage, double most_seconds = 0);
// Designs whose model part is stated at the end of a run: the best and its flat surface; with
// beliefs that are not common to the fingers all of the front, with a common one the flat surface:
// the others have theirs from the stage before.
std::size_t designs_with_model_part(const StudyProblem& problem, const SearchProblem& search);
// Steps of the parameters of confirmed designs, members of belief: fewer skins, shared out over the
// population.
Fidelity steps_fidelity(const StudyProblem& problem, Fidelity confirmed);

// How many designs the level between search and confirmation judges: where there is a model of the
// front.
std::size_t narrowings(const SearchProblem& search);

// How many designs the confirmation is priced as: those that the search evaluates, kFinalists at
// most, and one more. Where none of them keeps the limits it goes on up to kFinalists + 1
// (Eq. search.13).
std::size_t most_finalists(const SearchProblem& search);

// Processor time of one task at a stage, as plans price it [s].
double task_price(const StudyProblem& problem, Stage stage, double most_seconds = 0);
// What the tasks of a stage take over their price, beside those of the search: the designs that it
// finds and the other fingers take more than the study's own design, which prices are of. Medians
// of shipped studies (docs/theory/search.md).
double over_price(Stage stage);

// What shipped studies took of their price at the pace of the machine (docs/theory/search.md).
inline constexpr double kLeastOfPrice = 0.9, kMostOfPrice = 1.9;
// `machine_pace` at the search's level, of the study's own design under each of its tasks.
double search_pace(const StudyProblem& problem);
// How many processors of this machine a search keeps busy.
int processors_for(const Study& study);

// What a search takes, as plans price it.
struct StudyCost {
  int evaluations = 0, tasks = 0;  // of an evaluation
  std::size_t narrowed = 0, finalists = 0;
  double seconds = 0;
  std::size_t members = 0;                 // of belief, at each of which the finalists are judged
  double belief_seconds = 0;               // of them
  std::size_t looked_at = 0;               // designs whose look is computed; not in `seconds`
  std::size_t plates = 0;                  // of the yield of what is built; 0: it has none
  double bytes = 0;                        // of a worker, with what it keeps
  int pixels = 0;                          // of the search, along 12 um
  double feature = 0, feature_pixels = 0;  // the smallest of the space [m]; infinite: none
};
StudyCost study_cost(const StudyProblem& problem);

// Processor time that the looks of a design take on this machine, measured on the study's own
// design: lattices between the theories take seconds and more, all else next to nothing. The looks
// are kept, as those of every design. In all scenarios [s]; 0: no metric and no limit asks for a
// look.
double look_price(const StudyProblem& problem);
// The theory of that look, or why none has it; "": nothing asks for one. Free.
std::string look_theory(const StudyProblem& problem);

// What will run, for plan.txt and people.
std::string search_plan(const StudyProblem& problem);

}  // namespace papilla::search
