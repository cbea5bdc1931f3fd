// A finished run asked again: what its journal says was asked after the search, answered anew.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "optim/journal.h"
#include "search/problem.h"
#include "search/protocol.h"
#include "search/task.h"

namespace papilla::search {

// Numbers that differ by less than this share are the same: two machines round differently.
inline constexpr double kSameNumber = 1e-6;
bool same_number(double a, double b);

std::string stage_name(Stage stage);
std::optional<Stage> stage_named(const std::string& name);

// What a finished run asked, as far as it is in its journal.
class AskedQuestions {
 public:
  AskedQuestions(const StudyProblem& problem, const Folder& folder);

  // The study and the questions of some stages, as bytes that are the same wherever they are asked.
  std::string of(const std::vector<Stage>& stages) const;

 private:
  std::string study_;
  std::vector<TaskRequest> requests_;
};

struct AskingAgain {
  std::vector<Stage> stages;  // empty: all after the search
  // Of the clock; what would end later is not begun and keeps its answer. What is begun is waited
  // for, the first question of each worker in any case. 0: no limit.
  double seconds = 0;
  int jobs = 0;                                       // 0: all processors
  ResponseText text;                                  // as the run had it
  std::function<void(int done, int total)> progress;  // may be empty
  const std::atomic<bool>* stop = nullptr;
};

struct AnsweredAgain {
  std::vector<JournalRecord> records;  // the journal with new answers
  // Of each stage: questions, and those that were answered anew.
  std::array<int, kStages> asked{}, answered{};
  // What the journal says otherwise than the model, for people: "confirm, question 3".
  std::vector<std::string> otherwise;

  bool all(Stage stage) const {
    const auto k = static_cast<std::size_t>(stage);
    return answered[k] == asked[k];
  }
};
// Throws InputError for a journal of another study, or one that does not come to the run's end.
AnsweredAgain answer_again(const StudyProblem& problem, const Folder& folder,
                           const AskingAgain& how);

}  // namespace papilla::search
