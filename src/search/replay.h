// Answers to what a run asks: from its journal while there are records, else from a team of
// workers, and then recorded.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "optim/journal.h"
#include "optim/worker.h"
#include "search/problem.h"
#include "search/protocol.h"

namespace papilla::search {

// The search has one record per design, under the request of its first task: its judgement. Every
// other stage has one per task: its answer.
class Replay {
 public:
  // Opens or starts the folder's journal. Throws InputError for one of another study, by the keys
  // in which the studies differ, and for records that cannot be of this one. Refers to both
  // problems. stop: once it is set the team begins nothing more, and who asked of it meets
  // WorkStopped; null: never.
  Replay(const StudyProblem& problem, const SearchProblem& search, const Folder& folder,
         bool resume, std::unique_ptr<Team> team, const std::atomic<bool>* stop);

  int lost() const { return journal_.lost(); }
  const std::string& kept_copy() const { return journal_.kept_copy(); }
  // The earlier run's searched designs, without those that the shape's limits refused.
  int evaluated() const;
  bool replaying() const { return next_ < requests_.size(); }
  // The next record is one of the search, or there is none: a resumed search stops where its
  // confirmation began.
  bool searching() const;
  // What the next record answers.
  std::optional<TaskRequest> next() const;
  // The design of the next record where it is of this stage.
  std::optional<Point> next_unit(Stage stage) const;
  // Whether the journal goes beyond a stage: nothing of it is left to ask. flat: of the surfaces
  // without their relief.
  bool finished(Stage stage, bool flat = false) const;
  bool has(Stage stage, bool flat = false) const;  // a record of it
  // The search of the earlier run judged a design as often as it was asked of, as versions did that
  // kept no memory of it.
  bool repeats() const;

  // Judgements of the search.
  std::vector<Judgement> searched(const std::vector<Point>& units);
  // Those of an earlier run that went on beyond its search; its drafts are passed over.
  JudgedDesigns searched_before();

  std::vector<TaskAnswer> answers(const std::vector<TaskRequest>& requests);
  // Every task of every design, of another stage than the search's own. most_seconds: of a task.
  std::vector<Score> scores(const std::vector<Point>& units, Stage stage, bool flat = false,
                            double most_seconds = 0);
  JudgedDesigns judged(const std::vector<Point>& units, Stage stage);
  // From now on answers depend on the picked design: where the earlier run picked another, or its
  // version asked otherwise, what the journal does not have is asked beside it.
  void picked() { picked_ = true; }
  bool beside_journal() const { return beside_journal_; }
  // The run is at its end: continued, it asks nothing more. exhausted: the search ended since its
  // method had nothing more to try.
  void end(bool exhausted);
  // Whether the earlier run came to its end and said so of its search.
  bool exhausted() const;

  // Designs at a time that keep everyone busy; no more, so that a kill loses little.
  std::size_t designs() const;
  std::size_t workers() const { return team_->size(); }
  // Clock and number of a stage's tasks that were not replayed.
  struct Spent {
    double seconds = 0;
    int tasks = 0;

    double each() const { return tasks > 0 ? seconds / tasks : 0; }
  };
  const Spent& spent(Stage stage) const { return spent_[static_cast<std::size_t>(stage)]; }

 private:
  std::vector<TaskRequest> requests_of(const std::vector<Point>& units, Stage stage, bool flat,
                                       double most_seconds) const;
  // From the journal wherever they stand in it; the others are asked and not recorded.
  std::vector<TaskAnswer> answers_beside(const std::vector<TaskRequest>& requests);
  // Of the first ones alone where the run is stopped.
  std::vector<TaskAnswer> ask(const std::vector<TaskRequest>& requests);
  std::vector<Score> scores_of(const std::vector<Point>& units, bool flat,
                               const std::vector<TaskAnswer>& answers) const;
  Judgement judgement(const Score& score) const;
  Judgement refusal(const Point& unit) const;
  // The earlier run's payload for a question; refused where it asked another.
  const Bytes& replayed(const TaskRequest& request);
  void record(const TaskRequest& request, const Bytes& payload);
  [[noreturn]] void refuse() const;
  template <class T>
  T sound(std::optional<T> decoded) const {
    if (!decoded) refuse();
    return *std::move(decoded);
  }

  const StudyProblem& problem_;
  const SearchProblem& search_;
  std::string path_;
  Journal journal_;
  std::unique_ptr<Team> team_;
  const std::atomic<bool>* stop_;
  std::vector<TaskRequest> requests_;  // of the journal's records
  std::size_t next_ = 0;
  bool picked_ = false, beside_journal_ = false;
  std::array<Spent, kStages> spent_{};
};

}  // namespace papilla::search
