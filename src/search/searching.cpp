// The first stage of a run: the search itself.
#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "search/levels.h"
#include "search/stages.h"

namespace papilla::search {
namespace {

// So many times the budget of refused designs, or of known ones one after another, end a search.
constexpr std::size_t kInVain = 10;

class Searching {
 public:
  explicit Searching(Run& run)
      : run_(run),
        searcher_(make_searcher(run.method, run.search)),
        budget_(static_cast<std::size_t>(run.search.evaluations)),
        begun_(run.clock.seconds()),
        judges_again_(run.replay.repeats()) {}

  void run() {
    SearchEnd& end = run_.result.end;
    end = SearchEnd::Budget;
    while (evaluated_ < budget_ && run_.replay.searching()) {
      if (run_.history.size() >= kInVain * budget_) {
        end = SearchEnd::Refusals;
        break;
      }
      const std::vector<Point> asked = searcher_->ask();
      if (asked.empty() || known_in_row_ >= kInVain * budget_) {
        end = SearchEnd::Exhausted;
        break;
      }
      if (searcher_->asks_drafts()) {
        draft(asked);
      } else if (!evaluate(asked)) {
        end = run_.options.finish ? SearchEnd::Asked : SearchEnd::Clock;
        break;
      }
    }
  }

 private:
  // Cheap outcomes that steer. Few at a time, so that a kill loses little and Ctrl-C is heard; some
  // of each round, however short the time.
  void draft(std::vector<Point> units) {
    // A round that began with what the last one was cut at, as it may of few choices, would be read
    // from the journal as that one going on.
    if (units.front() == cut_at_) {
      if (units.size() > 1)
        std::swap(units[0], units[1]);
      else
        units.clear();
    }
    std::vector<Evaluation> batch;
    while (batch.size() < units.size() && (batch.empty() || next_is_draft(units[batch.size()]))) {
      const auto begin = units.begin() + static_cast<std::ptrdiff_t>(batch.size());
      const std::size_t most = run_.replay.replaying() ? 1 : 4 * run_.replay.workers();
      const std::size_t count = std::min(units.size() - batch.size(), most);
      const std::vector<Point> some(begin, begin + static_cast<std::ptrdiff_t>(count));
      for (Evaluation& e : run_.replay.judged(some, Stage::Draft).evaluations)
        batch.push_back(std::move(e));
      drafts_ += static_cast<int>(count);
      const int left = std::max(0, run_.search.drafts - drafts_);
      run_.progress(
          "draft", drafts_, run_.search.drafts,
          run_.seconds_of_designs(static_cast<std::size_t>(left), Stage::Draft) + seconds_left());
    }
    cut_at_ = batch.size() < units.size() ? units[batch.size()] : Point{};
    searcher_->tell(batch);
  }

  // What was judged before is not judged again: a method that asks of it is told what is known.
  // False where the time is over.
  bool evaluate(const std::vector<Point>& asked) {
    const std::vector<Point> fresh = not_known(asked);
    known_in_row_ = fresh.empty() ? known_in_row_ + asked.size() : 0;
    std::size_t done = 0;
    while (done < fresh.size() && evaluated_ < budget_ && run_.replay.searching()) {
      const std::vector<Point> units = next_of(fresh, done);
      if (units.empty()) return false;
      const std::vector<Judgement> judgements = run_.replay.searched(units);
      for (std::size_t i = 0; i < units.size(); ++i) {
        evaluated_ += run_.add_to_history(units[i], judgements[i]);
        known_[units[i]] = run_.history.size() - 1;
      }
      done += units.size();
      run_.progress("search", static_cast<int>(evaluated_), run_.search.evaluations,
                    seconds_left());
    }
    std::vector<Evaluation> batch;
    for (const Point& unit : asked) {
      const auto at = known_.find(unit);
      if (at == known_.end()) break;  // the budget ended before it
      batch.push_back(run_.history.evaluations[at->second]);
    }
    searcher_->tell(batch);
    return true;
  }

  // Each once. All of them where a run is continued whose version judged again what it knew.
  std::vector<Point> not_known(const std::vector<Point>& asked) const {
    if (judges_again_) return asked;
    std::vector<Point> out;
    std::set<Point> here;
    std::copy_if(asked.begin(), asked.end(), std::back_inserter(out),
                 [&](const Point& u) { return !known_.contains(u) && here.insert(u).second; });
    return out;
  }

  // Whether a round of drafts goes on with this one: as the journal has it, where the clock may
  // have cut the round, else as the clock allows. Half of the search's time is for others.
  bool next_is_draft(const Point& unit) const {
    if (run_.replay.replaying()) return run_.replay.next_unit(Stage::Draft) == unit;
    if (run_.options.finish) return false;
    return run_.fits(2 * run_.seconds_of_designs(run_.search.evaluations, Stage::Search));
  }

  // Those to evaluate together; none: the search is over. One at a time from the journal, which may
  // end or change stage within the batch.
  std::vector<Point> next_of(const std::vector<Point>& asked, std::size_t from) const {
    std::vector<Point> out;
    std::size_t counted = evaluated_;
    const std::size_t most = run_.replay.replaying() ? 1 : affordable();
    for (std::size_t i = from; i < asked.size() && out.size() < most && counted < budget_; ++i) {
      out.push_back(asked[i]);
      counted += run_.search.feasible_before_evaluation(asked[i]);
    }
    return out;
  }

  // Designs that the time is enough for, at most as many as keep everyone busy. The first one is
  // evaluated alone where there is a limit: what it takes is not known.
  std::size_t affordable() const {
    const std::size_t busy = run_.replay.designs();
    if (run_.options.finish) return evaluated_ == 0;
    if (!run_.clock.limited()) return busy;
    if (evaluated_ == 0) return 1;
    std::size_t count = busy;
    while (count > 0 && !run_.fits(run_.seconds_of_designs(count, Stage::Search))) --count;
    return count;
  }

  double seconds_left() const {
    const std::size_t left = budget_ - evaluated_;
    const Replay::Spent &full = run_.replay.spent(Stage::Search),
                        &drafts = run_.replay.spent(Stage::Draft);
    // What the searcher itself takes for each design that is asked of.
    const double own = run_.clock.seconds() - begun_ - full.seconds - drafts.seconds;
    const auto asked = static_cast<double>(full.tasks + drafts.tasks) /
                       static_cast<double>(run_.problem.tasks().size());
    if (!(asked > 0)) return -1;  // nothing was timed yet
    const double each = std::max(0.0, own) / asked;
    return run_.seconds_of_designs(left, Stage::Search) + each * static_cast<double>(left) +
           run_.seconds_from(RunPart::Narrow);
  }

  Run& run_;
  std::unique_ptr<Searcher> searcher_;
  std::size_t budget_, evaluated_ = 0;
  double begun_;  // [s] since the run began
  int drafts_ = 0;
  Point cut_at_;  // the first design of a round of drafts that the clock left; empty: it left none
  std::map<Point, std::size_t> known_;  // place of a design in the history
  std::size_t known_in_row_ = 0;        // asked of since the last design that was not known
  bool judges_again_;
};

}  // namespace

namespace {

// A search that went on to its confirmation is over; of why the journal knows one reason alone.
void take_from_journal(Run& run) {
  const JudgedDesigns before = run.replay.searched_before();
  for (std::size_t i = 0; i < before.size(); ++i)
    run.add_to_history(before.evaluations[i].unit,
                       {before.evaluations[i].outcome, before.worst[i]});
  const bool all = run.result.evaluations >= run.search.evaluations;
  const bool refused =
      run.history.size() >= kInVain * static_cast<std::size_t>(run.search.evaluations);
  run.result.end = all                      ? SearchEnd::Budget
                   : refused                ? SearchEnd::Refusals
                   : run.replay.exhausted() ? SearchEnd::Exhausted
                   : run.options.finish     ? SearchEnd::Asked
                   : run.clock.limited()    ? SearchEnd::Clock
                                            : SearchEnd::Before;
}

}  // namespace

void search_designs(Run& run) {
  run.clock.enter(RunPart::Search);
  if (run.replay.finished(Stage::Search)) {
    take_from_journal(run);
  } else {
    Searching(run).run();
  }
  if (run.result.end == SearchEnd::Clock)
    run.cut(RunPart::Search, static_cast<std::size_t>(run.result.evaluations),
            static_cast<std::size_t>(run.search.evaluations));
  run.result.one_value = one_value_variables(run.problem, run.history.evaluations);
}

}  // namespace papilla::search
