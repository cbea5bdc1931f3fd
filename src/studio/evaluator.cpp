#include "studio/evaluator.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>

#include "base/watch.h"
#include "config/describe.h"
#include "estimate/difference.h"
#include "estimate/evaluation.h"
#include "forward/forward.h"
#include "metrics/metrics.h"

namespace papilla::studio {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kStill{350};  // without a wish, before refining begins
constexpr std::size_t kMostKnown = 24;            // designs whose answers are kept
constexpr int kRefiningNiceness = 2;

// On the skins of the design.
Fidelity draft_fidelity(const Design& design) {
  Fidelity out = fidelity_level("draft");
  out.seed = static_cast<std::uint64_t>(design.accuracy.seed);
  return out;
}

// Of Draft and Design, each with what its own members of belief say: they are run on its pixels and
// skins. The last is at the accuracy that the design states, as `papilla evaluate` answers it.
EvaluationOptions options_of_step(const Design& design, Step step) {
  EvaluationOptions out;
  if (step == Step::Draft) out.fidelity = draft_fidelity(design);
  return out;
}

// Whether the design's own accuracy is that of a draft, which needs no second run.
bool asks_for_a_draft(const Design& design) {
  return design.accuracy.target == 0 && fidelity_of(design) == draft_fidelity(design);
}

constexpr double kSlopeStep = 0.05;  // of a number, either way

// What a slope is told of: by what is changed here.
std::vector<std::string> sloping_numbers(const Design& design) {
  std::vector<std::string> out = texture_numbers(design);
  for (std::size_t i = 0; i < design.surface.dielectric.size(); ++i)
    out.push_back("surface.dielectric." + std::to_string(i) + ".thickness");
  if (design.drive.driven() && design.drive.control == DriveControl::Voltage)
    out.emplace_back("drive.amplitude");
  return out;
}

std::vector<MetricExpression> sloping_metrics(const Design& design) {
  if (!design.drive.driven()) return {{Summary::Mean, kFriction}, {Summary::Variation, kFriction}};
  return {{Summary::Mean, kModulation}, {Summary::Variation, kModulation}};
}

}  // namespace

std::string why_unanswered(const Design& design) {
  const std::vector<DesignProblem> problems = design_problems(design);
  return problems.empty() ? "" : problems.front().path + ": " + problems.front().message;
}

const char* name_of(Step step) {
  switch (step) {
    case Step::First:
      return "first";
    case Step::Draft:
      return "draft";
    case Step::Design:
      return "design";
  }
  return "";
}

Evaluator::Evaluator(Listener listener) : listener_(std::move(listener)) {
  first_ = std::thread([this] { answer_first(); });
  finer_ = std::thread([this] { refine_while_idle(); });
}

Evaluator::~Evaluator() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    stop_refining_ = true;
  }
  changed_.notify_all();
  first_.join();
  finer_.join();
}

// Without its title, which says nothing about the answer.
Evaluator::Subject Evaluator::subject_of(const Design& design) {
  Subject out{design, maps_state(design)};
  out.design.title.clear();
  return out;
}

void Evaluator::wish(const Wish& wish) {
  Question question{0, wish.revision, subject_of(wish.design), {}};
  for (const auto& [number, design] : wish.pinned) {
    if (!why_unanswered(design).empty()) continue;
    Subject pinned = subject_of(design);
    // One accuracy for all, or they would meet other skins and not be compared by them; what a
    // target chooses of it is that of the design at hand (chosen_accuracy).
    pinned.design.accuracy = wish.design.accuracy;
    question.pinned.emplace(number, std::move(pinned));
  }
  {
    const std::lock_guard lock(mutex_);
    question.number = ++wishes_;
    asked_at_[question.revision] = Clock::now().time_since_epoch().count();
    wanted_ = std::move(question);
    stop_refining_ = true;
  }
  changed_.notify_all();
}

bool Evaluator::outdated(const Question& wish) const {
  return closing_ || !wanted_ || wanted_->number != wish.number;
}

Evaluator::Known& Evaluator::known(const Subject& subject) {
  const auto at = std::find_if(known_.begin(), known_.end(),
                               [&](const Known& k) { return k.subject == subject; });
  if (at != known_.end()) {
    std::rotate(at, at + 1, known_.end());
  } else {
    if (known_.size() >= kMostKnown) known_.erase(known_.begin());
    known_.push_back({subject, {}, {}, {}, {}});
  }
  return known_.back();
}

void Evaluator::answer_first() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] {
      return closing_ || (wanted_ && (!answered_ || answered_->number != wanted_->number));
    });
    if (closing_) return;
    const Question wish = *wanted_;
    lock.unlock();
    try {
      if (const std::string why = why_unanswered(wish.at_hand.design); !why.empty())
        listener_.failed(wish.revision, why);
      else
        answer(wish);
      const Subject& now = wish.at_hand;
      if (!shaped_ || now.design.texture != shaped_->design.texture || now.maps != shaped_->maps) {
        listener_.shape(wish.revision, now.design);
        shaped_ = now;
      }
    } catch (const std::exception& error) {
      listener_.failed(wish.revision, error.what());
    }
    lock.lock();
    answered_ = wish;
    changed_.notify_all();
  }
}

void Evaluator::answer(const Question& wish) {
  std::unique_lock lock(mutex_);
  const std::map<Step, Response> refined = known(wish.at_hand).refined;
  lock.unlock();
  if (!refined.empty())  // an undo, a pin: the finest that is known
    return tell(wish, refined.rbegin()->first, refined.rbegin()->second);
  tell(wish, Step::First, first_answer_of(wish.at_hand, &kept_));
}

Response Evaluator::first_answer_of(const Subject& subject, KeptPatches* kept) {
  std::unique_lock lock(mutex_);
  const std::shared_ptr<const Anchor> held = anchor_, anchor = carrying(subject);
  std::optional<Response> quick = known(subject).quick;
  lock.unlock();
  if (!quick) {
    quick = quick_answer(subject.design, anchor.get(), kept);
    lock.lock();
    if (anchor_ == held) known(subject).quick = quick;
    lock.unlock();
  }
  return first_answer(*quick, subject.design, anchor.get());
}

std::shared_ptr<const Anchor> Evaluator::carrying(const Subject& subject) const {
  const bool does = anchor_ && anchor_maps_ == subject.maps && carries(*anchor_, subject.design);
  return does ? anchor_ : nullptr;
}

void Evaluator::hold_on(const Subject& subject, const Response& refined) {
  std::unique_lock lock(mutex_);
  const std::shared_ptr<const Anchor> before = anchor_;
  const bool same = before && Subject{before->design, anchor_maps_} == subject;
  lock.unlock();
  Anchor anchor = same ? *before : anchor_of(subject.design, refined);
  anchor.refined = refined;
  lock.lock();
  if (!same) {  // their quick answers are by other load laws
    for (Known& k : known_) k.quick.reset();
    known(subject).quick = anchor.quick;
  }
  anchor_ = std::make_shared<const Anchor>(std::move(anchor));
  anchor_maps_ = subject.maps;
}

void Evaluator::refine_while_idle() {
  // What is refined waits for what is under the hand; its helpers inherit this.
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kRefiningNiceness);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] {
      return closing_ || (answered_ && !outdated(*answered_) && refined_ != answered_->number);
    });
    if (closing_) return;
    const Question wish = *answered_;
    if (changed_.wait_for(lock, kStill, [&] { return outdated(wish); })) continue;
    stop_refining_ = false;
    lock.unlock();
    bool whole = true;
    try {
      const Watch watch({}, &stop_refining_);
      refine(wish);
    } catch (const WorkStopped&) {
      whole = false;
    } catch (const std::exception& error) {
      listener_.failed(wish.revision, error.what());
    }
    lock.lock();
    if (whole) refined_ = wish.number;
  }
}

void Evaluator::refine(const Question& wish) {
  listener_.look(wish.revision, wish.at_hand.design);
  if (!why_unanswered(wish.at_hand.design).empty()) {
    if (slopes_wanted_) listener_.slopes(wish.revision, {});  // those of a design before go
    return listener_.refining(wish.revision, "", 1);
  }
  for (const Step step : {Step::Draft, Step::Design}) {
    refine_to(wish, wish.at_hand, step, name_of(step));
    for (const auto& [number, subject] : wish.pinned)
      refine_to(wish, subject, step, "pinned design, " + std::string(name_of(step)));
  }
  listener_.refining(wish.revision, "", 1);
  if (slopes_wanted_) find_slopes(wish);
}

void Evaluator::want_slopes(bool wanted) {
  {
    const std::lock_guard lock(mutex_);
    if (slopes_wanted_ == wanted) return;
    slopes_wanted_ = wanted;
    if (wanted) refined_ = 0;  // of what is at hand
  }
  changed_.notify_all();
}

void Evaluator::find_slopes(const Question& wish) {
  const Design& at_hand = wish.at_hand.design;
  std::unique_lock lock(mutex_);
  std::vector<Slope> out = known(wish.at_hand).slopes;
  lock.unlock();
  listener_.slopes(wish.revision, out);
  const Fidelity fidelity = draft_fidelity(at_hand);
  const auto moved = [&](const std::string& path, double value) {
    Design design = at_hand;
    set_number(design, path, value);
    return evaluate(scene_of(design), design.texture, fidelity);
  };
  for (const std::string& path : sloping_numbers(at_hand)) {
    if (!slopes_wanted_) return;
    if (std::any_of(out.begin(), out.end(), [&](const Slope& s) { return s.path == path; }))
      continue;
    const DesignStep step = design_step(at_hand, path, kSlopeStep);
    if (!step.moves()) continue;
    const Response down = moved(path, step.down), up = moved(path, step.up);
    Slope slope{path, step.unit, step.value, step.down, step.up, {}};
    for (const MetricExpression& e : sloping_metrics(at_hand)) {
      const ResponseDifference change = difference_of(e, down, up);
      if (!std::isfinite(change.value)) continue;  // of a state that does not exist
      slope.changes.push_back({metric_text(e), change.value, change.error});
    }
    out.push_back(std::move(slope));
    lock.lock();
    known(wish.at_hand).slopes = out;
    lock.unlock();
    listener_.slopes(wish.revision, out);
  }
}

// Whether anything had to be done.
bool Evaluator::refine_to(const Question& wish, const Subject& subject, Step step,
                          const std::string& what) {
  const Design& design = subject.design;
  std::unique_lock lock(mutex_);
  const std::map<Step, Response> before = known(subject).refined;
  const bool compared = subject != wish.at_hand && carrying(subject);
  const bool there = response_at(wish, subject, step).has_value();
  const std::optional<Fidelity> chosen = chosen_accuracy(wish, subject, step);
  lock.unlock();
  if (compared) first_answer_of(subject, nullptr);  // beside what moves next
  if (there) return false;
  const auto draft = before.find(Step::Draft);
  const bool drafted = step == Step::Design && draft != before.end() && asks_for_a_draft(design);
  if (!drafted) listener_.refining(wish.revision, what, 0);
  EvaluationOptions options = options_of_step(design, step);
  if (chosen) options.fidelity = chosen;
  const Response response = drafted ? draft->second : evaluate_design(design, options);
  if (subject == wish.at_hand) hold_on(subject, response);
  lock.lock();
  if (chosen)
    known(subject).beside = response;
  else
    known(subject).refined[step] = response;
  const std::map<Step, Response> own = known(wish.at_hand).refined;
  lock.unlock();
  if (const auto at = own.find(step); at != own.end()) tell(wish, step, at->second);
  return true;
}

std::optional<Fidelity> Evaluator::chosen_accuracy(const Question& wish, const Subject& subject,
                                                   Step step) {
  if (step != Step::Design || subject == wish.at_hand || wish.at_hand.design.accuracy.target == 0)
    return std::nullopt;
  const std::map<Step, Response>& own = known(wish.at_hand).refined;
  const auto at = own.find(step);
  return at == own.end() ? std::nullopt : std::optional(at->second.fidelity);
}

// First answers are compared as they are shown, and only where one anchor carries both.
std::optional<Response> Evaluator::response_at(const Question& wish, const Subject& subject,
                                               Step step) {
  const std::optional<Fidelity> chosen = chosen_accuracy(wish, subject, step);
  const Known& of = known(subject);
  if (step != Step::First) {
    const auto at = of.refined.find(step);
    const bool own = at != of.refined.end() && (!chosen || at->second.fidelity == *chosen);
    if (own) return at->second;
    return chosen && of.beside && of.beside->fidelity == *chosen ? of.beside : std::nullopt;
  }
  const std::shared_ptr<const Anchor> anchor = carrying(subject);
  if (!anchor || !of.quick) return std::nullopt;
  return first_answer(*of.quick, subject.design, anchor.get());
}

std::vector<Comparison> Evaluator::comparisons(const Question& wish, Step step) {
  const std::array<MetricExpression, 4> compared{{{Summary::Mean, kModulation},
                                                  {Summary::Worst, kModulation},
                                                  {Summary::Variation, kModulation},
                                                  {Summary::Mean, kFriction}}};
  if (wish.pinned.empty()) return {};
  const std::lock_guard lock(mutex_);
  const auto quick = [&](const Subject& s) -> Response { return *known(s).quick; };
  std::vector<Comparison> out;
  const std::optional<Response> ours = response_at(wish, wish.at_hand, step);
  for (const auto& [number, subject] : wish.pinned) {
    const std::optional<Response> theirs = response_at(wish, subject, step);
    if (!theirs || !ours) continue;
    const double drift =
        step == Step::First ? difference_drift(quick(subject), quick(wish.at_hand)) : 0;
    for (const MetricExpression& e : compared) {
      const auto value = summarise(e.summary, e.metric, *ours);
      if (!value || !summarise(e.summary, e.metric, *theirs)) continue;
      const ResponseDifference more = difference_of(e, *theirs, *ours);
      if (!std::isfinite(more.value)) continue;  // of a state that does not exist
      Comparison& c = out.emplace_back();
      c.pin = number, c.metric = metric_text(e), c.difference = more.value;
      if (more.paired) c.error = std::hypot(more.error, drift * value->value);
      if (more.model) c.model = more.model->deviation;
    }
  }
  return out;
}

void Evaluator::tell(const Question& wish, Step step, Response shown) {
  Answer answer{wish.revision,
                step,
                std::move(shown),
                0,
                comparisons(wish, step),
                {},
                calibration_mismatch(wish.at_hand.design)};
  {
    const std::lock_guard lock(mutex_);
    if (const auto at = asked_at_.find(wish.revision); at != asked_at_.end()) {
      answer.seconds =
          1e-9 * static_cast<double>(Clock::now().time_since_epoch().count() - at->second);
      asked_at_.erase(asked_at_.begin(), at);
    }
    for (const auto& [number, subject] : wish.pinned) {
      std::optional<Response> finest = response_at(wish, subject, Step::Design);
      if (!finest) finest = known(subject).beside;
      for (const Step coarser : {Step::Draft, Step::First}) {
        if (!finest) finest = response_at(wish, subject, coarser);
      }
      if (finest) answer.pinned[number] = *finest;
    }
  }
  listener_.answer(answer);
}

}  // namespace papilla::studio
