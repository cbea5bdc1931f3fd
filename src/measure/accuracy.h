// Speed against error: every choice of fidelity swept on one scene, levels beside the reference,
// error bars against held-out scenes. Tables as CSV; the page docs/accuracy.md is made from them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "design/design.h"
#include "forward/forward.h"

namespace papilla {

// What the tables follow, each a mean over humidity but for the variation.
const std::vector<std::string>& accuracy_quantities();  // "modulation", "variation", ...

struct AccuracyRow {
  std::string sweep, setting;
  Fidelity fidelity;
  std::vector<double> value;   // one a quantity; NaN where undefined
  std::vector<double> stated;  // its standard error
  std::vector<double> error;  // relative, against the last row of the sweep (the seeds: their mean)
  double seconds = 0, fft_pairs = 0, work = 0;  // work: FFT pairs in units of one at 256 x 256
  std::string status;
};

struct AccuracyOptions {
  int grid = 128, skins = 16;  // of the base that one choice at a time departs from
  int finest = 512;            // of the grid sweep
  bool levels = true;          // draft, design, 5 % target and reference too: minutes
  int threads = 0;
  std::function<void(const std::string&)> note;  // progress; may be empty
};

// Sweeps "grid", "skins", "seed", "tolerance", "field", "estimator", "model" and, where asked for,
// "level".
std::vector<AccuracyRow> accuracy_sweeps(const Design& design, const AccuracyOptions& options);

// One quantity of a random scene judged at a small fidelity, and by a finer one on fresh skins.
struct CoverageRow {
  int scene = 0;
  std::string texture, fidelity, quantity;
  double value = 0, half_width = 0;           // 95 %: 1.96 standard errors
  double reference = 0, reference_error = 0;  // its own standard error from sampling
  ErrorParts parts = {};                      // of value

  bool inside() const;
};
struct CoverageOptions {
  int scenes = 50;
  int first = 0;                           // of the random scenes; those of the reports are 0 to 49
  bool tight = false;                      // the level design and a target of 2 % instead
  int grid = 64, skins = 12;               // of both estimators beside the loose levels
  int finer_grid = 256, finer_skins = 48;  // of the reference; tight: of the level of that name
  int threads = 0;
  std::function<void(const std::string&)> note;
};
// A driven scene drawn from the range of the designs: texture, skin, sweat, angle, voltage.
Scene random_scene(int index, Texture& texture);
// The error bars of both estimators on a small grid, of the levels of searches and drafts and of a
// target of 5 %; or of what is tight.
std::vector<CoverageRow> coverage(const CoverageOptions& options);
Fidelity coverage_reference(const CoverageOptions& options);

// Share of the scenes whose reference lies inside the 95 % interval, the same with the reference's
// own standard error added to the interval in squares, median half-width over the
// 95 % quantile of the errors, and the root mean square of error over stated standard error (1 for
// bars that fit, whatever the spread of sizes among scenes); by fidelity and quantity.
struct CoverageSummary {
  std::string fidelity, quantity;
  int scenes = 0;
  double inside = 0, inside_both = 0, median_half_width = 0, error_quantile = 0, rms_ratio = 0;
};
std::vector<CoverageSummary> coverage_summary(const std::vector<CoverageRow>& rows);

std::string accuracy_csv(const std::vector<AccuracyRow>& rows, const std::string& provenance);
std::string coverage_csv(const std::vector<CoverageRow>& rows, const std::string& provenance);
// A table of coverage_csv, without the parts. Throws InputError.
std::vector<CoverageRow> read_coverage(const std::string& path);
// {"schema": 1, "sweeps": [...]} and {"schema": 1, "coverage": [...]}; null never NaN.
std::string accuracy_json(const std::vector<AccuracyRow>& rows);
std::string coverage_json(const std::vector<CoverageRow>& rows);
// Error of one sweep against work, log-log, a line a quantity.
std::string accuracy_svg(const std::vector<AccuracyRow>& rows, const std::string& sweep);
// The page of the tables sweeps.csv, coverage.csv and coverage_tight.csv in a folder. Throws
// InputError.
std::string accuracy_page(const std::string& folder);

}  // namespace papilla
