#include "search/reanswer.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "base/error.h"
#include "optim/worker.h"
#include "search/levels.h"
#include "search/records.h"

namespace papilla::search {
namespace {

// In the order in which they are answered where time is short: what the most numbers rest on first.
struct NamedStage {
  Stage stage;
  const char* name;
};
constexpr std::array kAfterSearch{
    NamedStage{Stage::Confirm, "confirm"},     NamedStage{Stage::Rounding, "rounding"},
    NamedStage{Stage::Belief, "belief"},       NamedStage{Stage::Steps, "steps"},
    NamedStage{Stage::Stability, "stability"}, NamedStage{Stage::Sensitivity, "sensitivity"}};

bool same_numbers(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_number);
}

bool same_objectives(const std::vector<TaskObjective>& a, const std::vector<TaskObjective>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const TaskObjective& x, const TaskObjective& y) {
                      return same_number(x.value, y.value) && same_number(x.error, y.error) &&
                             same_numbers(x.points, y.points);
                    });
}

bool same_answer(const TaskAnswer& a, const TaskAnswer& b) {
  if (a.status.kind != b.status.kind) return false;
  if (!a.status.ok()) return true;
  return same_objectives(a.objectives, b.objectives) && same_number(a.worst, b.worst) &&
         same_number(a.oxide_margin, b.oxide_margin) && same_numbers(a.limited, b.limited) &&
         std::equal(a.members.begin(), a.members.end(), b.members.begin(), b.members.end(),
                    same_answer);
}

// The new answer in place of the old one; whether both say the same.
bool replace(JournalRecord& record, const TaskAnswer& answer) {
  const auto before = decode_answer(record.payload);
  record.payload = encode(answer);
  return before && same_answer(*before, answer);
}

std::vector<JournalRecord> records_of(const StudyProblem& problem, const Folder& folder) {
  return JournalReader(journal_key(problem)).more(folder, kJournalName);
}

std::vector<TaskRequest> requests_of(const StudyProblem& problem, const Folder& folder,
                                     const std::vector<JournalRecord>& records) {
  const SearchProblem search = search_problem(problem);
  std::vector<TaskRequest> out;
  for (const JournalRecord& record : records) {
    const auto request = checked_request(problem, search, record);
    if (!request)
      throw InputError(folder.path(kJournalName) + ": a record that cannot be of this study");
    out.push_back(*request);
  }
  return out;
}

}  // namespace

bool same_number(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return true;
  return std::abs(a - b) <= kSameNumber * std::max(std::abs(a), std::abs(b));
}

std::string stage_name(Stage stage) {
  for (const NamedStage& known : kAfterSearch) {
    if (known.stage == stage) return known.name;
  }
  return "search";
}

std::optional<Stage> stage_named(const std::string& name) {
  for (const NamedStage& known : kAfterSearch) {
    if (known.name == name) return known.stage;
  }
  return std::nullopt;
}

AskedQuestions::AskedQuestions(const StudyProblem& problem, const Folder& folder)
    : study_(journal_key(problem)) {
  if (folder.has(kJournalName))
    requests_ = requests_of(problem, folder, records_of(problem, folder));
}

std::string AskedQuestions::of(const std::vector<Stage>& stages) const {
  std::string out = study_ + "\n";
  for (const TaskRequest& r : requests_) {
    if (std::find(stages.begin(), stages.end(), r.stage) != stages.end()) out += encode(r) + "\n";
  }
  return out;
}

AnsweredAgain answer_again(const StudyProblem& problem, const Folder& folder,
                           const AskingAgain& how) {
  AnsweredAgain out;
  out.records = records_of(problem, folder);
  const std::vector<TaskRequest> requests = requests_of(problem, folder, out.records);
  if (requests.empty() || requests.back().stage != Stage::Done)
    throw InputError(folder.path(kJournalName) +
                     ": does not come to the end of a run; `papilla optimize STUDY --resume` does");
  std::vector<std::size_t> order;
  for (const NamedStage& known : kAfterSearch) {
    const bool wanted = how.stages.empty() || std::find(how.stages.begin(), how.stages.end(),
                                                        known.stage) != how.stages.end();
    for (std::size_t i = 0; i < requests.size(); ++i) {
      if (requests[i].stage != known.stage) continue;
      ++out.asked[static_cast<std::size_t>(known.stage)];
      if (wanted) order.push_back(i);
    }
  }
  const int jobs = how.jobs > 0 ? how.jobs : omp_get_num_procs();
  const auto workers = std::min<std::size_t>(static_cast<std::size_t>(jobs), order.size());
  if (workers == 0) return out;
  const auto team = make_local_team(workers, work_function(problem, 1, how.text), WorkerLimits{});
  const auto from = std::chrono::steady_clock::now();
  std::map<Stage, double> prices;  // of a task
  double priced = 0;               // what is answered
  for (std::size_t done = 0; done < order.size();) {
    const double spent =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
    std::vector<Bytes> some;
    // The first ones say what the others take: no more of them than are answered at a time.
    const std::size_t end = std::min(order.size(), done + (done == 0 ? 1 : 2) * workers);
    double price = 0;
    for (std::size_t i = done; i < end; ++i) {
      const Stage stage = requests[order[i]].stage;
      if (!prices.count(stage)) prices[stage] = over_price(stage) * task_price(problem, stage);
      price += prices[stage];
      some.push_back(encode(requests[order[i]]));
    }
    // What would end after the time is not begun, but for the first ones.
    const bool late = done > 0 && how.seconds > 0 && spent + price * spent / priced > how.seconds;
    if ((how.stop && *how.stop) || late) break;
    priced += price;
    for (const WorkAnswer& answer : team->answer(some, how.stop)) {
      const std::size_t i = order[done++];
      const Stage stage = requests[i].stage;
      const int number = ++out.answered[static_cast<std::size_t>(stage)];
      if (!replace(out.records[i], task_answer(answer)))
        out.otherwise.push_back(fmt::format("{}, question {}", stage_name(stage), number));
    }
    if (how.progress) how.progress(static_cast<int>(done), static_cast<int>(order.size()));
  }
  return out;
}

}  // namespace papilla::search
