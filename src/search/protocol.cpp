#include "search/protocol.h"

#include "search/codec.h"

namespace papilla::search {
namespace {

// Enums end here.
constexpr Stage kLastStage = Stage::Done;
constexpr TaskStatus::Kind kLastKind = TaskStatus::Kind::Threw;

template <class E>
bool within(E value, E last) {
  return value >= E{} && value <= last;
}

}  // namespace

template <class Codec>
void members(Codec& c, TaskRequest& r) {
  code_all(c, r.stage, r.task, r.flat, r.unit, r.most_seconds);
}
template <class Codec>
void members(Codec& c, TaskStatus& s) {
  code_all(c, s.kind, s.text);
}
template <class Codec>
void members(Codec& c, TaskObjective& o) {
  code_all(c, o.value, o.error, o.points);
}
template <class Codec>
void members(Codec& c, Look& l) {
  code_all(c, l.haze, l.transmittance, l.gloss, l.colour_shift, l.total_transmittance, l.gloss_20,
           l.gloss_85, l.distinctness, l.sparkle);
}
template <class Codec>
void members(Codec& c, FieldPart& f) {
  code_all(c, f.common, f.own, f.corrections, f.of_skins);
}
template <class Codec>
void members(Codec& c, ErrorSamples& s) {
  code_all(c, s.sampling, s.grid, s.method, s.field);
}
template <class Codec>
void members(Codec& c, RunReading& r) {
  code_all(c, r.all, r.without);
}
template <class Codec>
void members(Codec& c, MemberReadings& r) {
  code_all(c, r.weights, r.members, r.own);
}
template <class Codec>
void members(Codec& c, ModelReadings& m) {
  code_all(c, m.steps, m.belief);
}
template <class Codec>
void members(Codec& c, TaskAnswer& a) {
  code_all(c, a.status, a.objectives, a.worst, a.oxide_margin, a.look, a.limited, a.limited_errors,
           a.samples, a.worst_samples, a.model, a.members, a.report);
}
template <class Codec>
void members(Codec& c, Outcome& o) {
  code_all(c, o.ok, o.reason, o.objectives, o.constraints, o.residuals);
}
template <class Codec>
void members(Codec& c, Judgement& j) {
  code_all(c, j.outcome, j.worst);
}

Bytes encode(const TaskRequest& request) { return encoded(request); }
Bytes encode(const TaskAnswer& answer) { return encoded(answer); }
Bytes encode(const Judgement& judgement) { return encoded(judgement); }

std::optional<TaskRequest> decode_request(const Bytes& bytes) {
  auto out = decoded<TaskRequest>(bytes);
  return out && within(out->stage, kLastStage) ? out : std::nullopt;
}

std::optional<TaskAnswer> decode_answer(const Bytes& bytes) {
  auto out = decoded<TaskAnswer>(bytes);
  return out && within(out->status.kind, kLastKind) ? out : std::nullopt;
}

std::optional<Judgement> decode_judgement(const Bytes& bytes) { return decoded<Judgement>(bytes); }

TaskAnswer task_answer(const WorkAnswer& answer) {
  using Reason = WorkFailure::Reason;
  using Kind = TaskStatus::Kind;
  if (!answer.failure) {
    return decode_answer(answer.bytes)
        .value_or(TaskAnswer::refused(Kind::Crashed, "a garbled answer"));
  }
  Kind kind = Kind::Crashed;
  switch (answer.failure->reason) {
    case Reason::Crashed:
      break;
    case Reason::TimedOut:
      kind = Kind::TimedOut;
      break;
    case Reason::OutOfMemory:
      kind = Kind::OutOfMemory;
      break;
    case Reason::Threw:
      kind = Kind::Threw;
      break;
  }
  return TaskAnswer::refused(kind, answer.failure->text);
}

}  // namespace papilla::search
