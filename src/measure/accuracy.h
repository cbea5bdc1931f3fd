// Speed against error: every choice of fidelity swept on one scene, levels beside the reference.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "forward/forward.h"
#include "metrics/metrics.h"

namespace papilla::measure {

// What accuracy is judged by, each a mean over humidity but for the variation.
struct AccuracyQuantity {
  std::string name;  // "modulation", "variation", ...
  Summary summary;
  Metric metric;
};
const std::vector<AccuracyQuantity>& accuracy_quantities();

struct AccuracyRow {
  std::string sweep, setting;
  Fidelity fidelity;
  std::vector<double> value;   // one per quantity; NaN where undefined
  std::vector<double> stated;  // its standard error
  // Relative, against the last row of the sweep; of the seeds against their mean, of the costs
  // against the level reference, as the root mean square over seeds.
  std::vector<double> error;
  double seconds = 0;              // processor time of all threads
  double fft_pairs = 0, work = 0;  // work: FFT pairs in units of one at 256 x 256
  std::string status;
};

struct AccuracyOptions {
  int grid = 128, skins = 16;  // of the base that one choice at a time departs from
  int finest = 512;            // of the grid sweep
  bool levels = true;          // also the sweeps "level" and "cost", which take minutes
  int threads = 0;
  std::function<void(const std::string&)> note;  // progress; may be empty
};

// Sweeps "grid", "skins", "seed", "tolerance", "field", "estimator", "model" and, where asked for,
// "level" and "cost".
std::vector<AccuracyRow> accuracy_sweeps(const Design& design, const AccuracyOptions& options);

}  // namespace papilla::measure
