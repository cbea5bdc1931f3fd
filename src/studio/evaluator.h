// Answers while the hand moves: the newest wish at once, then finer while nothing moves.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "forward/kept_patches.h"
#include "forward/response.h"
#include "studio/first_answer.h"

namespace papilla::studio {

struct Wish {
  std::uint64_t revision = 0;
  Design design;
  std::map<int, Design> pinned;  // by their numbers
};

// Finer and finer; the last is the accuracy that the design states (its [accuracy]), which its pins
// are answered at too; with a target, the accuracy that the target chose for the design.
enum class Step { First, Draft, Design };
const char* name_of(Step step);  // "first", "draft", "design"

// Why no simulation settles a design that can be drawn; "": one does.
std::string why_unanswered(const Design& design);

// A pinned design beside the one at hand: common skins, a paired error.
struct Comparison {
  int pin = 0;
  std::string metric;  // "mean(modulation)"
  double difference = 0;
  std::optional<double> error;  // numerical, one standard error
  // What belief leaves of the difference, one standard deviation over members that both have (Eq.
  // accuracy.15); none where it is not known: of first answers, and of fingers with other members.
  std::optional<double> model;
};

// What a number of the design does to the answer: drafts a step below and above it, common skins.
struct Slope {
  struct Change {
    std::string metric;  // "mean(modulation)"
    double value = 0, error = 0;
  };
  std::string path, unit;              // the unit for people
  double value = 0, down = 0, up = 0;  // SI
  std::vector<Change> changes;         // from `down` to `up`
};

struct Answer {
  std::uint64_t revision = 0;
  Step step = Step::First;
  Response response;
  double seconds = 0;                   // from the wish on
  std::vector<Comparison> comparisons;  // with pins of the same step
  std::map<int, Response> pinned;       // the finest known of each
  std::vector<std::string> unfitted;    // model options that the finger was not fitted with
};

struct Listener {
  std::function<void(const Answer&)> answer;
  // shape: where the texture is another one than before.
  std::function<void(std::uint64_t revision, const Design&)> shape, look;
  std::function<void(std::uint64_t revision, const std::string& what, double share)> refining;
  // Those that are known of a design so far, where slopes are wanted.
  std::function<void(std::uint64_t revision, const std::vector<Slope>&)> slopes;
  // In the place of an answer, as of what no simulation settles; or of what comes after one.
  std::function<void(std::uint64_t revision, const std::string& why)> failed;
};

// Two threads: one for first answers, one that refines (its priority is lower, and it ends within a
// patch when a wish comes). A first answer is never broken off: it is what the hand waits for, and
// the page sends the next position when it is there.
class Evaluator {
 public:
  explicit Evaluator(Listener listener);  // called from both threads, one call at a time each
  ~Evaluator();
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  void wish(const Wish& wish);
  // Slopes are found too, after all else: two drafts a number.
  void want_slopes(bool wanted);

 private:
  // A design with the state of its maps when it was wished for: one that was written anew under its
  // name since makes another subject.
  struct Subject {
    Design design;
    std::string maps;

    bool operator==(const Subject&) const = default;
  };
  struct Question {  // a wish
    std::uint64_t number = 0, revision = 0;
    Subject at_hand;
    std::map<int, Subject> pinned;
  };
  struct Known {  // of one subject
    Subject subject;
    std::optional<Response> quick;     // by the anchor at hand where that carries the design
    std::map<Step, Response> refined;  // Draft, Design
    std::optional<Response> beside;    // pinned: at the chosen_accuracy of the last comparison
    std::vector<Slope> slopes;
  };

  void answer_first();
  static Subject subject_of(const Design& design);
  void answer(const Question& wish);
  Response first_answer_of(const Subject& subject, KeptPatches* kept);
  void refine_while_idle();
  void refine(const Question& wish);
  bool refine_to(const Question& wish, const Subject& subject, Step step, const std::string& what);
  void find_slopes(const Question& wish);
  void tell(const Question& wish, Step step, Response shown);
  void hold_on(const Subject& subject, const Response& refined);  // as the anchor
  std::vector<Comparison> comparisons(const Question& wish, Step step);
  // With the lock held.
  Known& known(const Subject& subject);
  std::shared_ptr<const Anchor> carrying(const Subject& subject) const;  // null: none does
  // What a pinned design is answered at where a target chose the accuracy of the one at hand: the
  // pixels, skins and estimator that it chose there. A choice of its own would meet other skins.
  // None: at the accuracy that both state, or what is chosen is not known yet.
  std::optional<Fidelity> chosen_accuracy(const Question& wish, const Subject& subject, Step step);
  std::optional<Response> response_at(const Question& wish, const Subject& subject, Step step);
  bool outdated(const Question& wish) const;

  Listener listener_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Question> wanted_, answered_;  // the newest; the newest that has its first answer
  std::vector<Known> known_;                   // subjects used last, at the end
  std::shared_ptr<const Anchor> anchor_;
  std::string anchor_maps_;
  std::optional<Subject> shaped_;                   // whose texture's shape was told last
  std::map<std::uint64_t, std::int64_t> asked_at_;  // by revision [ns]
  std::uint64_t wishes_ = 0, refined_ = 0;
  bool closing_ = false;
  std::atomic<bool> stop_refining_{false}, slopes_wanted_{false};
  KeptPatches kept_;
  std::thread first_, finer_;
};

}  // namespace papilla::studio
