// Error bars against held-out scenes: how often what is stated holds.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "forward/forward.h"

namespace papilla::measure {

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
// A driven scene drawn from the range of the designs: texture (eight kinds in turn), film (four,
// each for eight scenes in turn), skin, sweat, angle, voltage; by the model of its finger.
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

}  // namespace papilla::measure
