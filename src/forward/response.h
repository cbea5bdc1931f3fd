// What the forward model answers: one point a humidity, each number with its error by origin.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "forward/plan.h"
#include "physics/optics/optics.h"

namespace papilla {

// One standard error by origin, in the unit of the value. Independent: they add in squares.
struct ErrorParts {
  double sampling = 0;  // skins, offsets, droplets
  double grid = 0;      // discretisation
  double solver = 0;    // tolerance of the contact solve
  double humidity = 0;  // quadrature over humidity (zero at a point)
  double method = 0;    // estimator or field rule in place of the better one

  double total() const {
    return std::sqrt(sampling * sampling + grid * grid + solver * solver + humidity * humidity +
                     method * method);
  }
  bool operator==(const ErrorParts&) const = default;
};

struct Measured {
  double value = 0;
  ErrorParts parts;

  double se() const { return parts.total(); }
  bool operator==(const Measured&) const = default;
};

// Per-skin quantities of one humidity, kept for paired differences between designs.
struct PatchSamples {
  std::vector<double> load_off, load_on;  // [N] on the patch: preload + capillary (+ pull)
  std::vector<double> area_off, area_on;  // contact fractions of the patch

  bool operator==(const PatchSamples&) const = default;
};

// The amplitude at which the modulation of a humidity reaches a target: `voltage_for`.
struct VoltageAnswer {
  double target = 0;      // modulation
  Measured amplitude;     // [V] peak; 0 when it is not reached
  double limit = 0;       // [V] largest amplitude allowed: breakdown, source, pull-in
  double modulation = 0;  // at the amplitude, or the highest reached
  int evaluations = 0;    // of the driven patches
  std::string status;     // empty: reached; else what came first

  bool reached() const { return status.empty(); }
  bool operator==(const VoltageAnswer&) const = default;
};

struct ResponsePoint {
  double relative_humidity = 0;
  double weight = 1;
  double patch_pressure = 0;                     // [Pa] on the load-carrying patches
  Measured friction_off, friction_on;            // [N], whole finger
  Measured modulation;                           // (F_on - F_off) / F_off; 0 when undriven
  Measured area_fraction_off, area_fraction_on;  // of the load-carrying patches
  Measured capillary_force;                      // [N], whole finger, off
  Measured electrostatic_force;                  // [N], whole finger
  Measured retention_force;                      // [N], whole finger
  Measured bridges;                              // a patch
  Measured wetted_fraction;
  Measured mean_gap;                // [m]
  Measured indentation;             // approach since first touch [m]
  double over_limit_area = 0;       // share of the patch where air is beyond its breakdown field
  double over_limit_share = 0;      // of the pull from there
  double peak_oxide_field = 0;      // [V/m] mean over the layers
  double oxide_margin = kInfinity;  // least strength over field of a layer of the dielectric
  double peak_air_field = 0;        // [V/m]
  // Relative, of the pull by the field rule that was used; no part of the errors above, because the
  // finger is fitted with that rule. Eq. electrostatics.15
  double field_error = 0;
  double bridge_water_share = 0;  // share of the water that sits in bridges
  std::string status = "ok";      // else what went wrong: "flooded: ...", "pull-in: ..."
  PatchSamples samples;
  std::vector<VoltageAnswer> voltages;  // one a target asked for

  bool operator==(const ResponsePoint&) const = default;
};

// Processor time by piece of physics [s], summed over threads; in no reproducible file.
struct PieceSeconds {
  double contact = 0, water = 0, field = 0;
};

struct Response {
  std::vector<ResponsePoint> points;
  Plan plan;
  bool driven = false;
  double seconds = 0;  // wall time; in no file that must be reproducible
  PieceSeconds piece_seconds;
  int contact_solves = 0;
  double fft_pairs = 0;
  std::optional<Optics> appearance;  // where a metric of the texture's look is asked for

  // Empty when every point is sound, else the first trouble.
  std::string trouble() const;
};

}  // namespace papilla
