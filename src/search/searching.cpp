// The first stage of a run: the search itself.
#include <algorithm>
#include <memory>

#include "search/levels.h"
#include "search/stages.h"

namespace papilla {
namespace {

class Searching {
 public:
  explicit Searching(Run& run)
      : run_(run),
        searcher_(make_searcher(run.method, run.search)),
        budget_(static_cast<std::size_t>(run.search.evaluations)) {}

  bool run() {
    while (evaluated_ < budget_ && run_.history.size() < 10 * budget_ && run_.replay.searching()) {
      const std::vector<Point> asked = searcher_->ask();
      if (asked.empty()) break;
      const End end = searcher_->asks_drafts() ? draft(asked) : evaluate(asked);
      if (end != End::Told) return end == End::OutOfTime;
    }
    return true;
  }

 private:
  enum class End { Told, Interrupted, OutOfTime };

  // Cheap outcomes that steer. Few at a time, so that a kill loses little and Ctrl-C is heard.
  End draft(const std::vector<Point>& units) {
    std::vector<Evaluation> batch;
    while (batch.size() < units.size()) {
      if (run_.stopped_before_next()) return End::Interrupted;
      const auto begin = units.begin() + static_cast<std::ptrdiff_t>(batch.size());
      const std::size_t count = std::min(units.size() - batch.size(), 4 * run_.replay.workers());
      const std::vector<Point> some(begin, begin + static_cast<std::ptrdiff_t>(count));
      for (Evaluation& e : run_.replay.judged(some, Stage::Draft).evaluations)
        batch.push_back(std::move(e));
      drafts_ += static_cast<int>(count);
      run_.progress("draft", drafts_, run_.search.drafts, -1);
    }
    searcher_->tell(batch);
    return End::Told;
  }

  End evaluate(const std::vector<Point>& asked) {
    std::vector<Evaluation> batch;
    while (batch.size() < asked.size() && evaluated_ < budget_ && run_.replay.searching()) {
      if (run_.stopped_before_next()) return End::Interrupted;
      if (!run_.replay.replaying() && evaluated_ > 0 && out_of_time()) return End::OutOfTime;
      const std::vector<Point> units = next_of(asked, batch.size());
      const std::vector<Judgement> judgements = run_.replay.searched(units);
      for (std::size_t i = 0; i < units.size(); ++i) {
        evaluated_ += run_.add_to_history(units[i], judgements[i]);
        batch.push_back(run_.history.evaluations.back());
      }
      run_.progress("search", static_cast<int>(evaluated_), run_.search.evaluations,
                    seconds_left());
    }
    searcher_->tell(batch);
    return End::Told;
  }

  // Those to evaluate together. One at a time from the journal, which may end or change stage
  // within the batch.
  std::vector<Point> next_of(const std::vector<Point>& asked, std::size_t from) const {
    std::vector<Point> out;
    std::size_t counted = evaluated_;
    const std::size_t most = run_.replay.replaying() ? 1 : run_.replay.designs();
    for (std::size_t i = from; i < asked.size() && out.size() < most && counted < budget_; ++i) {
      out.push_back(asked[i]);
      counted += run_.search.feasible_before_evaluation(asked[i]);
    }
    return out;
  }

  double seconds_after_search() const {
    return run_.seconds_of(narrowings(run_.search), Stage::Narrow) + run_.seconds_to_confirm();
  }
  bool out_of_time() const {
    const double limit = run_.study.search.time;
    return limit > 0 && run_.seconds() + seconds_after_search() > limit;
  }
  double seconds_left() const {
    const Replay& replay = run_.replay;
    if (replay.fresh() == 0) return -1;
    // Clock over evaluation time: what the searcher itself takes.
    const double overhead =
        replay.seconds() > 0 ? std::max(1.0, run_.seconds() / replay.seconds()) : 1;
    return static_cast<double>(budget_ - evaluated_) * replay.seconds_each() * overhead +
           seconds_after_search();
  }

  Run& run_;
  std::unique_ptr<Searcher> searcher_;
  std::size_t budget_, evaluated_ = 0;
  int drafts_ = 0;
};

}  // namespace

bool search_designs(Run& run) {
  if (!run.replay.finished(Stage::Search)) return Searching(run).run();
  const JudgedDesigns before = run.replay.searched_before();
  for (std::size_t i = 0; i < before.size(); ++i)
    run.add_to_history(before.evaluations[i].unit,
                       {before.evaluations[i].outcome, before.worst[i]});
  return true;
}

}  // namespace papilla
