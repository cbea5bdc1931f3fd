// Friction of a finger on a design over humidity, drive off and on, with error bars.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "papilla/design.h"
#include "papilla/quantities.h"

namespace papilla::api {

// Standard errors by origin, in the unit of the value; nothing where one was not measured.
// docs/theory/accuracy.md
struct ErrorParts {
  double sampling = 0;
  std::optional<double> grid, solver, humidity, method, field, parameters;
  std::optional<double> model;  // over the finger's belief, no part of the total
  std::optional<double> water;  // a band common to all designs, no part of the total
};

struct Quantity {
  double value = 0;
  double error = 0;  // one standard error: all parts in squares
  ErrorParts parts;
  // The two parts of what is not known: what skins, grids and methods leave, and what is not known
  // of finger and model (its belief, else the fit's `parameters`); nothing: not stated.
  double numerical = 0;
  std::optional<double> model{};
};

// One humidity: friction_off, modulation, ... of papilla/quantities.h, and whether to trust them. A
// quantity of a state that does not exist (under a voltage that breaks the dielectric down, beyond
// full contact or pull-in) is NaN, and `status` says why.
struct Point : Quantities<Quantity> {
  double relative_humidity = 0;  // share
  bool sound = true;
  std::string status;  // for people: "ok", or what went wrong
};

// Immutable, cheap to copy.
class Response {
 public:
  const std::vector<Point>& points() const;  // one per humidity
  bool driven() const;
  std::string trouble() const;  // empty: every point is sound
  // The text of `papilla evaluate --json`, byte for byte; without the clock where it must be
  // reproducible. And its table for people, Markdown.
  std::string json(bool with_time = true) const;
  std::string table() const;
  std::string svg(const std::string& title = "") const;  // friction and modulation with bands

  struct Inside;  // not for callers
  explicit Response(std::shared_ptr<const Inside> inside);
  const Inside& inside() const { return *inside_; }

 private:
  std::shared_ptr<const Inside> inside_;
};

struct EvaluateOptions {
  std::string level;  // "draft", "design", "reference"; empty: the design's own
  double target = 0;  // relative standard error of the modulation; 0: none. Not beside a level
  int threads = 0;    // 0: all processors. The result is the same for any number
  // What is not known of finger and model, where the finger names a belief; else
  bool model = true;
  bool parameters = false;          // also the error that the finger's fitted numbers leave
  bool look = false;                // also haze, transmittance, gloss and colour
  std::vector<double> voltage_for;  // also the amplitudes that reach these modulations, above 0
  bool force = false;               // with model options that the finger was not fitted with

  // Called after each skin patch with the number of those that are done; from any thread, one call
  // at a time. May be empty. What it throws ends the work after the running patches and comes out
  // of evaluate().
  std::function<void(int done)> progress;
  // Set by another thread: evaluate() ends after the running patches and throws Stopped.
  const std::atomic<bool>* stop = nullptr;
};

// Throws InputError, Stopped. On the stop the pieces of physics that iterate end at once.
Response evaluate(const Design& design, const EvaluateOptions& options = {});

}  // namespace papilla::api
