#include "search/replay.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <set>

#include "base/error.h"
#include "base/watch.h"
#include "search/differing.h"
#include "search/records.h"

namespace papilla::search {
namespace {

TaskRequest search_key(const Point& unit) { return {Stage::Search, 0, false, unit}; }

// The place of a stage in the course of a run: drafts are part of the search, and the surface
// without its relief comes after the order under other models.
int place(Stage stage, bool flat) {
  switch (stage) {
    case Stage::Search:
    case Stage::Draft:
      return 0;
    case Stage::Narrow:
      return 1;
    case Stage::Confirm:
      return flat ? 5 : 2;
    case Stage::Belief:
      return 3;
    case Stage::Stability:
      return 4;
    case Stage::Rounding:
      return 6;
    case Stage::Sensitivity:
      return 7;
    case Stage::Steps:
      return 8;
    case Stage::Done:
      break;
  }
  return 9;
}

Journal open_journal(const StudyProblem& problem, const Folder& folder, bool resume) {
  try {
    return Journal(folder, kJournalName, journal_key(problem), resume);
  } catch (const InputError& e) {
    const char* file = "resolved.toml";
    if (!resume || !folder.has(file)) throw;
    const std::string differ = differing_keys(folder.read(file), resolved_toml(problem.study()));
    if (differ.empty()) throw;
    throw InputError(std::string(e.what()) + "; there and here: " + differ);
  }
}

}  // namespace

Replay::Replay(const StudyProblem& problem, const SearchProblem& search, const Folder& folder,
               bool resume, std::unique_ptr<Team> team, const std::atomic<bool>* stop)
    : problem_(problem),
      search_(search),
      path_(folder.path(kJournalName)),
      journal_(open_journal(problem, folder, resume)),
      team_(std::move(team)),
      stop_(stop) {
  for (const JournalRecord& record : journal_.records())
    requests_.push_back(sound(checked_request(problem, search, record)));
}

void Replay::refuse() const {
  throw InputError(path_ +
                   ": the earlier run took another path (other budget or another "
                   "version of Papilla); start again with another --out folder");
}

int Replay::evaluated() const {
  int count = 0;
  for (std::size_t i = 0; i < requests_.size(); ++i) {
    if (requests_[i].stage != Stage::Search) continue;
    const Outcome o = sound(decode_judgement(journal_.records()[i].payload)).outcome;
    count += o.ok || o.constraints.empty();
  }
  return count;
}

bool Replay::searching() const {
  return !replaying() || requests_[next_].stage == Stage::Search ||
         requests_[next_].stage == Stage::Draft;
}

std::optional<TaskRequest> Replay::next() const {
  return replaying() ? std::optional(requests_[next_]) : std::nullopt;
}

std::optional<Point> Replay::next_unit(Stage stage) const {
  if (!replaying() || requests_[next_].stage != stage) return std::nullopt;
  return requests_[next_].unit;
}

bool Replay::finished(Stage stage, bool flat) const {
  return !requests_.empty() &&
         place(requests_.back().stage, requests_.back().flat) > place(stage, flat);
}

bool Replay::has(Stage stage, bool flat) const {
  return std::any_of(requests_.begin(), requests_.end(),
                     [&](const TaskRequest& r) { return r.stage == stage && r.flat == flat; });
}

bool Replay::repeats() const {
  std::set<Point> units;
  return std::any_of(requests_.begin(), requests_.end(), [&](const TaskRequest& r) {
    return r.stage == Stage::Search && !units.insert(r.unit).second;
  });
}

const Bytes& Replay::replayed(const TaskRequest& request) {
  if (requests_[next_] != request) refuse();
  return journal_.records()[next_++].payload;
}

void Replay::record(const TaskRequest& request, const Bytes& payload) {
  journal_.append({encode(request), payload});
  requests_.push_back(request);
  ++next_;
}

void Replay::end(bool exhausted) {
  const TaskRequest done{Stage::Done, exhausted ? kSearchExhausted : 0, false,
                         Point(search_.space.size(), 0.0)};
  if (!beside_journal_ && !replaying()) record(done, {});
}

bool Replay::exhausted() const {
  return !requests_.empty() && requests_.back().stage == Stage::Done &&
         requests_.back().task == kSearchExhausted;
}

std::size_t Replay::designs() const {
  const std::size_t tasks = problem_.tasks().size();
  return (team_->size() + tasks - 1) / tasks + 1;
}

std::vector<TaskRequest> Replay::requests_of(const std::vector<Point>& units, Stage stage,
                                             bool flat, double most_seconds) const {
  std::vector<TaskRequest> out;
  for (const Point& u : units) {
    for (std::size_t t = 0; t < problem_.tasks().size(); ++t)
      out.push_back({stage, t, flat, u, most_seconds});
  }
  return out;
}

std::vector<TaskAnswer> Replay::ask(const std::vector<TaskRequest>& requests) {
  if (requests.empty()) return {};
  std::vector<Bytes> bytes;
  for (const TaskRequest& r : requests) bytes.push_back(encode(r));
  std::vector<TaskAnswer> out;
  const auto from = std::chrono::steady_clock::now();
  for (const WorkAnswer& answer : team_->answer(bytes, stop_)) out.push_back(task_answer(answer));
  Spent& spent = spent_[static_cast<std::size_t>(requests.front().stage)];
  spent.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  spent.tasks += static_cast<int>(out.size());
  return out;
}

std::vector<Score> Replay::scores_of(const std::vector<Point>& units, bool flat,
                                     const std::vector<TaskAnswer>& answers) const {
  const auto tasks = static_cast<std::ptrdiff_t>(problem_.tasks().size());
  std::vector<Score> out;
  auto first = answers.begin();
  for (const Point& unit : units) {
    Design design = problem_.space().design(unit);
    if (flat) design.texture = Texture{};
    out.push_back(problem_.score(design, {first, first + tasks}));
    first += tasks;
  }
  return out;
}

Judgement Replay::judgement(const Score& score) const {
  return {guarded(problem_.outcome(score), search_.objectives, search_.constraints), score.worst};
}

// By the limits of the shape and its look, without an evaluation.
Judgement Replay::refusal(const Point& unit) const {
  const StudyConstraints& constraints = problem_.constraints();
  Judgement out;
  out.outcome.reason = constraints.geometry_reason(unit);
  out.outcome.constraints = constraints.before_evaluation(problem_.space().design(unit));
  return out;
}

std::vector<Judgement> Replay::searched(const std::vector<Point>& units) {
  std::vector<Judgement> out;
  while (out.size() < units.size() && replaying())
    out.push_back(sound(decode_judgement(replayed(search_key(units[out.size()])))));
  const std::vector<Point> remaining(units.begin() + static_cast<std::ptrdiff_t>(out.size()),
                                     units.end());
  std::vector<Point> fresh;
  std::copy_if(remaining.begin(), remaining.end(), std::back_inserter(fresh),
               [&](const Point& u) { return search_.feasible_before_evaluation(u); });
  const std::vector<TaskAnswer> answers = ask(requests_of(fresh, Stage::Search, false, 0));
  fresh.resize(answers.size() / problem_.tasks().size());  // those of which all was answered
  const std::vector<Score> scores = scores_of(fresh, false, answers);
  std::size_t next = 0;
  for (const Point& unit : remaining) {
    const bool asked = search_.feasible_before_evaluation(unit);
    if (asked && next == scores.size()) throw WorkStopped();
    out.push_back(asked ? judgement(scores[next++]) : refusal(unit));
    record(search_key(unit), encode(out.back()));
  }
  return out;
}

JudgedDesigns Replay::searched_before() {
  JudgedDesigns out;
  for (; replaying() && searching(); ++next_) {
    if (requests_[next_].stage == Stage::Draft) continue;
    out.add(requests_[next_].unit, sound(decode_judgement(journal_.records()[next_].payload)));
  }
  return out;
}

std::vector<TaskAnswer> Replay::answers(const std::vector<TaskRequest>& requests) {
  for (std::size_t i = 0; picked_ && i < requests.size() && next_ + i < requests_.size(); ++i)
    beside_journal_ = beside_journal_ || requests_[next_ + i] != requests[i];
  if (beside_journal_) return answers_beside(requests);
  std::vector<TaskAnswer> out;
  while (out.size() < requests.size() && replaying())
    out.push_back(sound(decode_answer(replayed(requests[out.size()]))));
  const std::vector<TaskRequest> remaining(
      requests.begin() + static_cast<std::ptrdiff_t>(out.size()), requests.end());
  for (TaskAnswer& fresh : ask(remaining)) {
    record(requests[out.size()], encode(fresh));
    out.push_back(std::move(fresh));
  }
  if (out.size() < requests.size()) throw WorkStopped();
  return out;
}

std::vector<TaskAnswer> Replay::answers_beside(const std::vector<TaskRequest>& requests) {
  std::vector<std::optional<TaskAnswer>> known;
  std::vector<TaskRequest> missing;
  for (const TaskRequest& request : requests) {
    const auto place = static_cast<std::size_t>(
        std::find(requests_.begin(), requests_.end(), request) - requests_.begin());
    known.emplace_back();
    if (place < journal_.records().size())
      known.back() = sound(decode_answer(journal_.records()[place].payload));
    else
      missing.push_back(request);
  }
  std::vector<TaskAnswer> fresh = ask(missing);
  if (fresh.size() < missing.size()) throw WorkStopped();
  auto next = fresh.begin();
  std::vector<TaskAnswer> out;
  for (std::optional<TaskAnswer>& answer : known)
    out.push_back(answer ? *std::move(answer) : std::move(*next++));
  return out;
}

std::vector<Score> Replay::scores(const std::vector<Point>& units, Stage stage, bool flat,
                                  double most_seconds) {
  return scores_of(units, flat, answers(requests_of(units, stage, flat, most_seconds)));
}

JudgedDesigns Replay::judged(const std::vector<Point>& units, Stage stage) {
  JudgedDesigns out;
  const std::vector<Score> all = scores(units, stage);
  for (std::size_t i = 0; i < units.size(); ++i) out.add(units[i], judgement(all[i]));
  return out;
}

}  // namespace papilla::search
