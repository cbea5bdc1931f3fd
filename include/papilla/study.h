// A study: a design, what of it may change, and what is wanted. Run to its end, or searched step by
// step with evaluations of the caller's own.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "papilla/design.h"

namespace papilla::api {

// A number that the search may change; of "texture.type" the place in the list of kinds.
struct Variable {
  std::string path, unit;          // the unit for people
  double low = 0, high = 0;        // SI
  std::vector<double> choices;     // SI; not empty: one of these
  std::vector<std::string> names;  // of the choices, where they are words: the kinds
};

struct Objective {
  std::string name;  // "mean(modulation)"
  bool maximise = true;
  std::string unit;  // of its values, SI; "" of a share
};

// A design as the study sees it.
struct Judgement {
  bool ok = false;
  std::string reason;                  // not ok: why, for people
  std::vector<double> values, errors;  // one per objective, larger is better where it is maximised
  std::vector<double> violations;      // one per constraint that needs an evaluation; <= 0: kept
};

struct RunProgress {
  std::string stage;  // for people: "draft", "search", "narrow", "confirm", "belief", "check"
  int done = 0, total = 0;
  double seconds_left = 0;  // < 0: not known yet
};

struct RunOptions {
  bool resume = false;  // go on with a run of the same study in the same folder
  bool finish = false;  // no more designs: those of the run that is resumed are confirmed
  bool force = false;   // with model options that the finger was not fitted with
  std::string pick;     // which design of the front is the best, as `papilla optimize --pick`
  std::function<void(const RunProgress&)> progress;  // may be empty
  const std::atomic<bool>* stop = nullptr;           // set: ends after the running evaluation
};

struct FoundDesign {
  std::vector<double> values;  // of the variables, SI
  Judgement searched, confirmed;
  // Of design.toml, below the run's: "front/03", "best" where no design keeps every limit; empty:
  // its values alone are kept.
  std::string folder;
};

struct RunResult {
  bool interrupted = false;   // to be resumed
  bool any_feasible = false;  // a design keeps every constraint
  int evaluations = 0;
  std::vector<FoundDesign> finalists;  // by the first objective, best first
  std::size_t best = 0;                // of the finalists
  std::string table;                   // for people, Markdown
};

// Immutable, cheap to copy.
class Study {
 public:
  // As Design::read and Design::parse; throw InputError for what cannot be searched, too.
  static Study read(const std::string& file, const Design::Values& values = {});
  static Study parse(const std::string& toml, const Design::Values& values = {});

  const std::vector<Variable>& variables() const;
  const std::vector<Objective>& objectives() const;
  std::size_t violations() const;  // of a Judgement

  // The design that these values of the variables make, and the values of the study's own, inside
  // its space or not: design() and judge() take those besides what lies inside.
  Design design(const std::vector<double>& values) const;
  std::vector<double> own_values() const;

  // Values of the variables, SI, in their order. judge() runs the model on every finger and
  // scenario, as accurately as a search does; a shape that breaks a limit is refused at once. stop,
  // force: as of evaluate().
  Judgement judge(const std::vector<double>& values, int threads = 0,
                  const std::atomic<bool>* stop = nullptr, bool force = false) const;

  // Searches, confirms and checks, and writes the folder of results, as `papilla optimize`. Works
  // in processes forked from this one: call it before other threads are started.
  RunResult run(const std::string& folder, const RunOptions& options = {}) const;

  struct Inside;  // not for callers
  const Inside& inside() const { return *inside_; }

 private:
  explicit Study(std::shared_ptr<const Inside> inside) : inside_(std::move(inside)) {}
  std::shared_ptr<const Inside> inside_;
};

// The searcher of a study: asks for designs, is told what they are worth. The designs depend on the
// study (method, seed) and on what was told, never on time.
class Search {
 public:
  explicit Search(const Study& study);  // throws InputError
  Search(Search&&) noexcept;
  Search& operator=(Search&&) noexcept;
  ~Search();

  // Values of the variables of the next designs; empty: nothing more to try, or as many were told
  // as search.evaluations says. Throws InputError before the last ones were told.
  std::vector<std::vector<double>> ask();
  // One judgement per design of the last ask, in its order; of those that are ok every value and
  // violation is a finite number. Throws InputError for others.
  void tell(const std::vector<Judgement>& judgements);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace papilla::api
