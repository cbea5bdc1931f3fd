// What the forward model answers: one point per humidity, each number with its error by origin.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "forward/patch_result.h"
#include "forward/plan.h"
#include "forward/status.h"
#include "physics/optics/optics.h"

namespace papilla::forward {

// Per-skin quantities of one humidity, kept for paired differences between designs.
struct PatchSamples {
  std::vector<double> load_off, load_on;  // [N] on the patch: preload + capillary (+ pull)
  std::vector<double> area_off, area_on;  // contact fractions of the patch
  // Preload of the mean patch [N]; the same plus the attraction of the open gaps between patches,
  // with the drive off and on. The number of patches in contact is proportional to the last two.
  double preload = 0, pressed_off = 0, pressed_on = 0;

  bool operator==(const PatchSamples&) const = default;
};

// The amplitude at which the modulation of a humidity reaches a target: `voltage_for`.
struct VoltageAnswer {
  double target = 0;      // modulation
  Measured amplitude;     // [V] peak; 0 when it is not reached
  double limit = 0;       // [V] largest amplitude allowed: breakdown, source, pull-in
  double modulation = 0;  // at the amplitude, or the highest reached
  int evaluations = 0;    // of the driven patches
  VoltageEnd end = VoltageEnd::Reached;
  ModelStatus model;  // of ModelEnds and Unsound: what the model said
  // [skin left out] The amplitude without each skin [V], to first order; empty: one skin, or not
  // reached. Eq. metrics.6
  std::vector<double> without{};
  // Of the field at the amplitude, as ResponsePoint has them of its own.
  double field_correction = 1;
  std::optional<double> field_error{};

  bool reached() const { return end == VoltageEnd::Reached; }
  bool operator==(const VoltageAnswer&) const = default;
};
// What came first, of an answer that is not reached: "the dielectric breaks down at 500 V".
std::string text(const VoltageAnswer& answer);

// `pull_in` follows the branch of equilibria until its voltage has a maximum (the fold), until that
// voltage is kFarthestPullIn times the drive's, or until the attraction is kClosingLoad times the
// nominal load.
inline constexpr double kFarthestPullIn = 4;
inline constexpr double kClosingLoad = 40;

// How far the drive is from the voltage at which the gap jumps shut: `pull_in_margin`.
struct PullIn {
  // Pull-in voltage over the voltage of the drive, at most kFarthestPullIn. The pull-in voltage is
  // that of the fold; if there is no fold, the one at which the attraction is kClosingLoad times
  // the nominal load. 0: water closes the gap without a voltage.
  Measured margin{kFarthestPullIn, {}};
  double folds = 0;  // share of the patches that have a fold

  bool operator==(const PullIn&) const = default;
};

struct ResponsePoint : PointQuantities {
  double relative_humidity = 0;
  double weight = 1;
  double patch_pressure = 0;        // [Pa] on the load-carrying patches
  double over_limit_area = 0;       // share of the patch where air is beyond its breakdown field
  double over_limit_share = 0;      // of the pull from there
  double peak_oxide_field = 0;      // [V/m] mean over the layers
  double oxide_margin = kInfinity;  // least strength over field of a layer of the dielectric
  // That where a bridge or a contact puts all of the voltage on the thinnest place of the film:
  // below 1 the film is at risk there, though it holds the field that was solved. Infinite where a
  // layer leaks. Eq. electrostatics.9
  double bridged_margin = kInfinity;
  double peak_air_field = 0;  // [V/m]
  double source_voltage = 0;  // [V] peak: under current control what the current needs
  double retention_gain = 0;  // [N] retention force with the drive on minus that with it off
  // [N] The same of the capillary force on the finger: load that friction under the drive has
  // beside the pull. Eq. friction.3
  double capillary_gain = 0;
  // Shear strength times load-carrying area [N]: contact's part of the friction is this times the
  // contact fraction (but for a friction coefficient, Eq. friction.4).
  double strength = 0;
  double field_correction = 1;        // factor on the pull of the field rule. Eq. electrostatics.17
  std::optional<double> field_error;  // relative, of the pull; none: not measured
  double bridge_water_share = 0;      // share of the water that sits in bridges
  // Of F_on/F_off, relative: what `felt` takes for the error of a run on few skins, that of the
  // response which the run is moved from. None: the point's own error. Eq. metrics.7
  std::optional<double> felt_error{};
  ModelStatus status;
  // That the water volume is continued beyond its fit, which `status` says only where no other
  // trouble came first. Sound where it is not.
  ModelStatus water_fit;
  PatchSamples samples;
  std::vector<VoltageAnswer> voltages;  // one per target asked for
  std::optional<PullIn> pull_in;        // where it was asked for

  // The status to report. If the voltage exceeds the strength of the dielectric, that is reported
  // in place of `status`: the film breaks down before full contact, pull-in or any other
  // consequence of that voltage can occur.
  ModelStatus said() const;
  // Whether the numbers without the drive, and under it, are those of a state that exists.
  bool knows_undriven() const;
  bool knows_driven() const;

  bool operator==(const ResponsePoint&) const = default;
};

// What was asked for by [accuracy] target, and what came of it.
struct TargetReport {
  double target = 0;   // relative standard error of the quantity; 0: none was asked for
  double reached = 0;  // total of the parts that were measured
  std::string quantity;
  TargetEnd end = TargetEnd::Reached;
  const char* largest_part = "";         // of LimitsReached: the origin of the largest part
  double largest_share = 0;              // that part, relative
  int largest_grid = 0, most_skins = 0;  // the limits
  std::vector<std::string> steps;        // what was run and why, one line each
};
// "reached", or what stopped it.
std::string text(const TargetReport& report);

// One point per humidity from all skins; and the same with each skin left out in turn, for the
// jackknife (`without` is empty if there is only one skin).
struct Resampled {
  std::vector<ResponsePoint> points;
  std::vector<std::vector<ResponsePoint>> without;  // [skin left out][humidity]; `samples` empty
};

// Results for the control skins, from which the error parts `grid` and `method` are measured. own:
// those of the response itself. areas: run again with solved contact areas, if the response used
// the load law (Estimator::Load). coarse: run again on half the pixels, with solved areas too where
// `areas` was run. Empty: not run.
struct ControlRuns {
  Resampled own, areas, coarse;
  double octaves = 0;  // of the skin's spectrum that the grid of `own` leaves out
  // Factor on the change from half the pixels to these: how much is still missing to the limit of
  // fine pixels because the texture's features are only few pixels wide. 0: they are resolved.
  double coarse_features = 0;
  bool friction_by_load = false;  // Eq. friction.4
};

// The finger moved one standard deviation up and down an independent direction of its fit's
// covariance; fewer skins than the response, the same for all steps.
struct ParameterStep {
  Resampled up, down;
};
struct ParameterSteps {
  std::vector<ParameterStep> steps;  // empty: not asked for
  int skins = 0, grid = 0;
  std::vector<PointTrouble> troubles;  // of the first step whose response is not sound
};

// The scene at one member of the finger's belief.
struct BeliefRun {
  double weight = 0;
  std::string hypothesis;
  Resampled run;
};
// Eq. accuracy.15: the members of a belief and the scene as it is, on the same few skins, offsets
// and droplets.
struct BeliefRuns {
  std::string file;
  std::vector<BeliefRun> members;  // empty: not asked for, or there is none
  Resampled own;
  int skins = 0, grid = 0;
  double seconds = 0;                  // wall time; in no file that must be reproducible
  std::vector<PointTrouble> troubles;  // of the first member whose response is not sound
  std::string absent;                  // why there are no members, for people; "": not asked for
  bool over_air_limits = false;        // members differ in what air withstands

  double effective() const;  // number of members: 1 / sum of the squared weights
};

struct Response : Resampled {
  ControlRuns controls;       // behind the parts of grid and method
  ParameterSteps parameters;  // behind the parts of that name
  BeliefRuns belief;          // behind the parts `model`
  Fidelity fidelity;          // as run
  TargetReport accuracy;
  Plan plan;
  bool driven = false;
  double seconds = 0;  // wall time; in no file that must be reproducible
  PieceSeconds piece_seconds;
  int contact_solves = 0;
  double fft_pairs = 0;
  std::optional<Optics> appearance;  // where a metric of the texture's look is asked for

  // The points that are not sound, and what people are told of each; also of water beyond its fit
  // where another trouble is said.
  std::vector<PointTrouble> troubles() const;
  std::vector<PointTrouble> said() const;
};

}  // namespace papilla::forward
