// Which experiments to make next: a batch chosen one by one, each the one that gains most for what
// it costs beside those chosen before. Equations lab.6-9: docs/theory/lab.md.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/fields.h"
#include "lab/evidence.h"
#include "lab/experiment.h"

namespace papilla::lab {

// What a batch is for.
enum class Aim {
  Decision,    // the least expected regret of the design that is chosen after it
  Hypotheses,  // to tell hypotheses apart
  Parameters,  // to shrink all that the members differ in
};
const std::vector<std::string>& aim_names();  // "decision", "hypotheses", "parameters"

// Seconds; what is set up once is paid once in a batch.
struct Costs {
  double reading = 300;    // of one touch, off and on
  double humidity = 1800;  // to reach a humidity and wait
  double design = 300;     // to mount a design
  double state = 1200;     // to prepare the finger

  bool operator==(const Costs&) const = default;
};
void fields(FieldVisitor& v, Costs& s);

// A candidate: an experiment and the readings that one touch of it gives, off and on.
struct Candidate {
  Experiment experiment;
  std::vector<Observation> readings;
};

// Of a decision: which designs may be chosen, and how surely they keep their limits.
struct DecisionLimits {
  std::vector<std::vector<bool>> kept;  // [design][member], every limit; empty: there are none
  double wanted = 0;                    // probability
};

// How good a batch is for an aim, as it grows.
class Gain {
 public:
  virtual ~Gain() = default;
  // What a candidate adds, 0 or more; in shares of what there is to gain.
  virtual double of(const Candidate& candidate) const = 0;
  virtual void take(const Candidate& candidate) = 0;
};

struct Chosen {
  std::size_t candidate = 0;
  double gain = 0, seconds = 0;
};

struct BatchOptions {
  int count = 10;      // experiments, one touch each
  double seconds = 0;  // at most; 0: no limit
  Costs costs;
  int threads = 0;
};

// Why a batch holds no more.
enum class BatchEnd {
  Count,    // as many as were asked for
  Time,     // what still gains takes longer than is left
  Nothing,  // nothing gains
};
const std::vector<std::string>& batch_end_names();  // "count", "time", "nothing"

struct Batch {
  std::vector<Chosen> chosen;
  BatchEnd end = BatchEnd::Count;
  double shortest = 0;  // of what takes too long for the time that is left [s]
};

// Greedy. The same for any number of threads. Eq. lab.9
Batch choose_batch(const std::vector<Candidate>& candidates, Gain& gain,
                   const BatchOptions& options);
// What a batch costs, its set-ups once each.
double seconds_of(const std::vector<Candidate>& candidates, const std::vector<std::size_t>& batch,
                  const Costs& costs);

// By an Evidence of the readings so far, which is copied. Eq. lab.7, lab.8
std::unique_ptr<Gain> hypotheses_gain(const Ensemble& ensemble, const Evidence& sofar,
                                      const Instrument& instrument);
std::unique_ptr<Gain> parameters_gain(const Ensemble& ensemble, const Evidence& sofar,
                                      const Instrument& instrument);

}  // namespace papilla::lab
