// A run whose tasks are answered by a formula: which designs it asks of at each stage, and what it
// says meanwhile. No contact is solved.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "search/stages.h"
#include "tests/search/small_study.h"

namespace papilla::tests {

using TaskFormula = std::function<TaskAnswer(const TaskRequest&)>;

// As one level says of a design.
inline search::Judgement judged_at(Stage stage, const search::Run& run, const TaskFormula& formula,
                                   const Point& unit) {
  const Score score =
      run.problem.score(run.problem.space().design(unit), {formula({stage, 0, false, unit})});
  return {run.problem.outcome(score), score.worst};
}

class FormulaWorker : public Team {
 public:
  FormulaWorker(TaskFormula formula, std::vector<TaskRequest>& asked, std::size_t workers = 1)
      : formula_(std::move(formula)), asked_(asked), workers_(workers) {}
  std::size_t size() const override { return workers_; }
  std::vector<WorkAnswer> answer(const std::vector<Bytes>& requests,
                                 const std::atomic<bool>* stop) override {
    std::vector<WorkAnswer> out;
    for (const Bytes& bytes : requests) {
      if (stop && *stop) break;
      asked_.push_back(*decode_request(bytes));
      out.push_back({encode(formula_(asked_.back())), {}});
    }
    return out;
  }

 private:
  TaskFormula formula_;
  std::vector<TaskRequest>& asked_;
  std::size_t workers_;
};

struct FormulaRun {
  FormulaRun(const Study& of, const std::string& folder, const TaskFormula& formula,
             std::function<void(const Progress&)> progress = {})
      : study(of),
        options{folder, false, std::move(progress), nullptr},
        run(study, options, mpi, std::make_unique<FormulaWorker>(formula, asked)) {}
  FormulaRun(const FormulaRun&) = delete;
  FormulaRun& operator=(const FormulaRun&) = delete;

  // Of a stage, in the order in which they were asked of.
  std::vector<Point> units(Stage stage) const {
    std::vector<Point> out;
    for (const TaskRequest& r : asked) {
      if (r.stage == stage && !r.flat) out.push_back(r.unit);
    }
    return out;
  }

  const Study study;
  const OptimiseOptions options;
  const MpiSession mpi;
  std::vector<TaskRequest> asked;
  search::Run run;
};

}  // namespace papilla::tests
