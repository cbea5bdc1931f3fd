// The figures of the M3 paper as numbers: every sample at every humidity, and the numbers that its
// text prints. The curves themselves are not published as numbers.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "numerics/statistics.h"
#include "published/finger_model.h"

namespace papilla::claims {

// Mean of the simulated water volumes, each with six placements of the droplets, as in the paper.
struct FigureValue {
  Estimate value;            // se: over skins
  double low = 0, high = 0;  // the limits: least and largest over the volumes
};

// A surface at one humidity, by one preset.
struct FigureRow {
  std::string figures;        // that show it: "2d,e 3d-f"
  std::string sample, state;  // "a3h350", "a3h350 110°", "large film 1"; of the finger
  Preset preset = Preset::Papilla;
  double relative_humidity = 0;
  FigureValue friction_off, friction_on, effect;  // [N], of the finger; effect: on less off
  FigureValue modulation;
  FigureValue capillary, pull;  // [N] on a patch
  FigureValue contact_area;     // [m^2] of the finger, off
};

// A number that a paper prints, or the range that it gives, and the model's. Eq. accuracy.16
struct PrintedNumber {
  std::string claim, what;
  double low = 0, high = 0;
  double published_sd = 0;           // u_D: what its words leave
  Estimate papilla, m3;              // se: u_num, over skins
  std::optional<double> input_sd{};  // u_input of `papilla` by the finger's belief; nothing: none

  double deviation(const Estimate& model) const;  // from the nearest of the range, a share of it
  double error() const;                           // E of `papilla`, from the nearest of the range
  double validation_sd() const;                   // u_val; without belief its part is missing
};

// One set of parameters beside all printed numbers: the finger's own, or the member of a hypothesis
// whose largest miss is the least.
struct ParameterSet {
  std::string name;
  std::vector<double> values;  // of the printed numbers
  std::vector<double> misses;  // E over what sampling and words of the paper leave

  double largest() const;  // of the sizes of the misses
};
// Misses beyond this many standard deviations contradict the numbers that a set meets.
inline constexpr double kContradicts = 2;

struct FigureTables {
  std::vector<FigureRow> rows;
  std::vector<PrintedNumber> printed;
  std::vector<ParameterSet> sets;  // the finger, then one of each hypothesis of its belief
};

struct FigureOptions {
  Finger finger;
  int threads = 0;
  SkinSampling sampling{.skins = 8};
  std::vector<std::string> claims;  // only the printed numbers of these, and no curves; empty: all
  std::function<void(const std::string& sample)> started;
};

// Both presets, and the printed numbers at every member of the finger's belief (drafts). Cost:
// about three minutes on two cores without belief.
FigureTables figure_tables(const FigureOptions& options);

}  // namespace papilla::claims
