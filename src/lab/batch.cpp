#include "lab/batch.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/check.h"
#include "base/constants.h"
#include "base/parallel.h"

namespace papilla::lab {
namespace {

// Less than this share of what there is to gain is the noise of the draws.
constexpr double kNothing = 1e-9;

// What is mounted, set and prepared already in a batch.
class SetUps {
 public:
  explicit SetUps(const Costs& costs) : costs_(costs) {}

  double seconds(const Experiment& e) const {
    double out = costs_.reading;
    if (!humidities_.count(e.at.relative_humidity)) out += costs_.humidity;
    if (!designs_.count(e.design)) out += costs_.design;
    if (!states_.count(e.at.state)) out += costs_.state;
    return out;
  }
  void take(const Experiment& e) {
    humidities_.insert(e.at.relative_humidity);
    designs_.insert(e.design);
    states_.insert(e.at.state);
  }

 private:
  const Costs& costs_;
  std::set<double> humidities_;
  std::set<std::size_t> designs_;
  std::set<FingerState> states_;
};

}  // namespace

const std::vector<std::string>& aim_names() {
  static const std::vector<std::string> names{"decision", "hypotheses", "parameters"};
  return names;
}

const std::vector<std::string>& batch_end_names() {
  static const std::vector<std::string> names{"count", "time", "nothing"};
  return names;
}

void fields(FieldVisitor& v, Costs& s) {
  const auto time = [&](const char* key, const char* doc, double& value) {
    v.number({key, "min", 0, 1e5, doc, Source::Estimate, "a bench with a climate box"}, value);
  };
  time("reading", "one touch, off and on", s.reading);
  time("humidity", "to reach a humidity and wait, once in a batch", s.humidity);
  time("design", "to mount a design, once in a batch", s.design);
  time("state", "to prepare the finger, once in a batch", s.state);
}

Batch choose_batch(const std::vector<Candidate>& candidates, Gain& gain,
                   const BatchOptions& options) {
  Batch out;
  SetUps set_up(options.costs);
  double spent = 0;
  while (static_cast<int>(out.chosen.size()) < options.count) {
    std::vector<double> gains(candidates.size(), 0);
    parallel_for(
        static_cast<int>(candidates.size()),
        [&](int i) {
          gains[static_cast<std::size_t>(i)] = gain.of(candidates[static_cast<std::size_t>(i)]);
        },
        options.threads);
    std::optional<Chosen> best;
    double too_long = kInfinity;  // the shortest that does not fit
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double seconds = set_up.seconds(candidates[i].experiment);
      if (!(gains[i] > kNothing)) continue;
      if (options.seconds > 0 && spent + seconds > options.seconds) {
        too_long = std::min(too_long, seconds);
        continue;
      }
      // Eq. lab.9; where nothing costs anything, by the gain.
      const double worth = gains[i] / std::max(seconds, kNothing);
      if (!best || worth > best->gain / std::max(best->seconds, kNothing))
        best = Chosen{i, gains[i], seconds};
    }
    if (!best) {
      out.end = std::isinf(too_long) ? BatchEnd::Nothing : BatchEnd::Time;
      if (out.end == BatchEnd::Time) out.shortest = too_long;
      break;
    }
    spent += best->seconds;
    set_up.take(candidates[best->candidate].experiment);
    gain.take(candidates[best->candidate]);
    out.chosen.push_back(*best);
  }
  return out;
}

double seconds_of(const std::vector<Candidate>& candidates, const std::vector<std::size_t>& batch,
                  const Costs& costs) {
  SetUps set_up(costs);
  double out = 0;
  for (const std::size_t i : batch) {
    out += set_up.seconds(candidates[i].experiment);
    set_up.take(candidates[i].experiment);
  }
  return out;
}

}  // namespace papilla::lab
