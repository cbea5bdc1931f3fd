#include "search/records.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "search/stability.h"

namespace papilla::search {
namespace {

bool finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool possible(const StudyProblem& problem, const SearchProblem& search, const TaskRequest& r) {
  if (r.unit.size() != search.space.size()) return false;
  for (std::size_t i = 0; i < r.unit.size(); ++i) {
    constexpr double kLastDigits = 1e-9;
    const bool inside = r.unit[i] >= -kLastDigits && r.unit[i] <= 1 + kLastDigits;
    if (!inside && !(r.unit[i] == DesignSpace::kBeside && problem.space().own_is_beside(i)))
      return false;
  }
  if (!std::isfinite(r.most_seconds) || r.most_seconds < 0) return false;
  if (r.stage == Stage::Done) return r.task <= kSearchExhausted;
  const std::size_t tasks =
      r.stage == Stage::Stability ? stability_variants(problem).size() : problem.tasks().size();
  return r.task < tasks;
}

bool possible(const SearchProblem& search, const Judgement& judgement) {
  const Outcome& o = judgement.outcome;
  // Of a refused design only the constraints of its shape and look are known.
  if (!o.ok) return o.objectives.empty() && finite(o.constraints);
  return o.objectives.size() == search.objectives && finite(o.objectives) &&
         o.constraints.size() == search.constraints && finite(o.constraints) &&
         (search.residuals == 0 || o.residuals.size() == search.residuals) && finite(o.residuals);
}

bool of_same_skins(const MemberReadings& readings) {
  return readings.weights.size() == readings.members.size() &&
         std::all_of(readings.members.begin(), readings.members.end(),
                     [&](const RunReading& member) {
                       return member.without.size() == readings.own.without.size();
                     });
}

// Each objective with its numbers, in the order of the humidities.
bool possible(const StudyProblem& problem, Stage stage, const TaskAnswer& a) {
  const StudyGoals& goals = problem.goals();
  const std::size_t count = goals.objectives.size();
  const std::size_t humidities = problem.study().design.environment.relative_humidity.size();
  if (!a.status.ok()) return true;
  if (!a.model.empty() && a.model.size() != count) return false;
  if (!std::all_of(a.model.begin(), a.model.end(),
                   [](const ModelReadings& m) { return of_same_skins(m.belief); }))
    return false;
  if (stage == Stage::Steps || stage == Stage::Belief) {
    const auto sound = [&](const TaskAnswer& m) { return possible(problem, Stage::Search, m); };
    return std::all_of(a.members.begin(), a.members.end(), sound);
  }
  if (a.objectives.size() != count) return false;
  if (a.limited_errors.size() != goals.limited.size()) return false;
  if (a.limited.size() != goals.limited.size() || (goals.looks && !a.look)) return false;
  if (!a.samples.empty() && a.samples.size() != count) return false;
  for (std::size_t k = 0; k < count; ++k) {
    if (a.objectives[k].points.size() != humidities) return false;
    // Checks of the order compare the summaries themselves.
    const bool by_points = stage != Stage::Stability && goals.by_points(k);
    const std::size_t numbers = by_points ? humidities : 1;
    if (!a.samples.empty() && a.samples[k].size() != numbers) return false;
  }
  return true;
}

// By its run.json: a run keeps its journal after it has ended.
bool has_ended(const Folder& folder) {
  if (!folder.has("run.json")) return false;
  const auto run = nlohmann::json::parse(folder.read("run.json"), nullptr, false);
  return run.is_object() && run.contains("interrupted") && run["interrupted"] == false;
}

}  // namespace

std::string unfinished_hint(const Folder& folder) {
  if (!folder.has(kJournalName) || has_ended(folder)) return {};
  return "; its run was interrupted: `papilla optimize STUDY --out " + folder.path() +
         " --resume` goes on with it, with --finish to the results of what it has";
}

std::string journal_key(const StudyProblem& problem) { return text_hash(problem.identity()); }

std::optional<TaskRequest> checked_request(const StudyProblem& problem, const SearchProblem& search,
                                           const JournalRecord& record) {
  const auto request = decode_request(record.key);
  if (!request || !possible(problem, search, *request)) return std::nullopt;
  bool sound = false;
  switch (request->stage) {
    case Stage::Done:
      sound = record.payload.empty();
      break;
    case Stage::Search: {
      const auto judgement = decode_judgement(record.payload);
      sound = judgement && possible(search, *judgement);
      break;
    }
    case Stage::Draft:
    case Stage::Narrow:
    case Stage::Confirm:
    case Stage::Belief:
    case Stage::Stability:
    case Stage::Rounding:
    case Stage::Sensitivity:
    case Stage::Steps: {
      const auto answer = decode_answer(record.payload);
      sound = answer && possible(problem, request->stage, *answer);
      break;
    }
  }
  return sound ? request : std::nullopt;
}

}  // namespace papilla::search
