// What a run asks its workers, what they answer, and both as bytes: for pipes, MPI and the journal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "metrics/metrics.h"
#include "optim/problem.h"
#include "optim/worker.h"

namespace papilla::search {

// Raised when the meaning or the order of what is encoded changes: part of the journal's key.
constexpr int kProtocol = 11;

// What a design is asked for, each at its level (levels.h).
enum class Stage {
  Search,
  Draft,        // cheap, to steer the search
  Narrow,       // between search and confirmation
  Confirm,      // of the finalists, at the study's accuracy
  Belief,       // what belief about finger and model leaves open, of what keeps every limit
  Stability,    // one finger or another choice of the model
  Rounding,     // of the best design on the grid of the fab, as the confirmation
  Sensitivity,  // a small step of a variable
  Steps,        // what the fit of the fingers leaves open
  Done,         // asks nothing: the run came to its end, whatever a clock cut of it
};
// That the search of a run which is done had nothing more to try; 0: it ended otherwise, or a
// version that did not say it wrote the record.
inline constexpr std::size_t kSearchExhausted = 1;
inline constexpr std::size_t kStages = static_cast<std::size_t>(Stage::Done) + 1;

struct TaskRequest {
  Stage stage = Stage::Search;
  std::size_t task = 0;  // of the study; of Stability the variant; of Done kSearchExhausted or 0
  bool flat = false;     // the design without its relief
  Point unit;
  // What the task may cost, as plans price it [s]: fewer skins and pixels than the stage's where a
  // run is short of time; 0: anything.
  double most_seconds = 0;

  bool operator==(const TaskRequest&) const = default;
};

struct TaskStatus {
  enum class Kind {
    Ok,
    ShapeRefused,   // no such shape, or not within its scatter
    LookRefused,    // no theory of its look
    NoEquilibrium,  // pull-in, or a dielectric that breaks down: no friction to judge
    NotDefined,     // an objective or a limited metric has no value
    Crashed,
    TimedOut,
    OutOfMemory,
    Threw,
  };
  Kind kind = Kind::Ok;
  std::string text;  // for people: why it is not Ok

  bool ok() const { return kind == Kind::Ok; }
  bool operator==(const TaskStatus&) const = default;
};

// An objective on one task.
struct TaskObjective {
  double value = 0;  // over humidity: the summary; of a target the root mean square distance
  double error = 0;  // one standard error of it, without the parameters of the finger
  std::vector<double> points;  // the quantity at each humidity

  bool operator==(const TaskObjective&) const = default;
};

// A task's answer. How each member is combined over the tasks of a design: score.h.
struct TaskAnswer {
  TaskStatus status;  // the members below where it is Ok
  std::vector<TaskObjective> objectives;
  double worst = 0;                    // lowest modulation over humidity; 0: undriven
  double oxide_margin = kInfinity;     // smallest over humidity; infinite without a field
  std::optional<Look> look;            // where the study asks for it
  std::vector<double> limited;         // of each constraint on a metric
  std::vector<double> limited_errors;  // one standard error of each, without the parameters
  // [objective][number that it is made of], and of `worst`: their mean is the number; only of
  // confirmed tasks and of the members of a belief.
  std::vector<std::vector<ErrorSamples>> samples;
  ErrorSamples worst_samples;
  // [objective]; empty: not asked for. An objective's own is empty where it is not defined at a
  // step or a member.
  std::vector<ModelReadings> model;
  // At each member of the finger's belief, last as the finger is, on few skins; empty: not asked
  // for.
  std::vector<TaskAnswer> members;
  std::string report;  // the response as text, of confirmed tasks

  static TaskAnswer refused(TaskStatus::Kind kind, const std::string& text) {
    TaskAnswer out;
    out.status = {kind, text};
    return out;
  }
};

// A design at the level of the search: as a searcher sees it, and its lowest modulation.
struct Judgement {
  Outcome outcome;
  double worst = 0;
};

// Designs of one level, in their order.
struct JudgedDesigns {
  std::vector<Evaluation> evaluations;
  std::vector<double> worst;  // lowest modulation of each

  std::size_t size() const { return evaluations.size(); }
  void add(const Point& unit, const Judgement& judgement) {
    evaluations.push_back({unit, judgement.outcome});
    worst.push_back(judgement.worst);
  }
};

Bytes encode(const TaskRequest& request);
Bytes encode(const TaskAnswer& answer);
Bytes encode(const Judgement& judgement);
// Nothing where the bytes are not what encode() writes.
std::optional<TaskRequest> decode_request(const Bytes& bytes);
std::optional<TaskAnswer> decode_answer(const Bytes& bytes);
std::optional<Judgement> decode_judgement(const Bytes& bytes);

// The answer of a worker, or why there is none.
TaskAnswer task_answer(const WorkAnswer& answer);

}  // namespace papilla::search
