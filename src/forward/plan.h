// What is modelled and what is skipped, why, at which cost and error: the one home of "model only
// what a scene needs". A pure function of the scene; `papilla explain` prints it.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "forward/fidelity.h"
#include "geometry/texture.h"
#include "scene/scene.h"

namespace papilla::forward {

// In the order of plans.
enum class Piece {
  Contact,
  Water,
  Field,
  Electrowetting,
  Tractions,
  Coupling,
  Retention,
  PatchPressures,
  VanDerWaals,
  Kelvin,
  Optics,
  Sampling,
  Errors
};

struct PlanStep {
  Piece piece = Piece::Contact;
  std::string method, reason;  // for people
  double seconds = 0;          // expected, on one core of a usual machine
  double error = 0;            // expected relative error of the modulation; 0: none beyond sampling

  const char* name() const;  // "contact", "scale bridge", ...
  bool operator==(const PlanStep&) const = default;
};

struct PlanSkip {
  Piece piece = Piece::Contact;
  std::string reason;    // for people
  double bound = 0;      // on the relative error of friction made by skipping; 0: none
  bool estimate = true;  // what other scenes had; false: a bound from patches of this scene

  const char* name() const;  // "water", "distribution of patch pressures", ...
  bool operator==(const PlanSkip&) const = default;
};

struct Plan {
  std::vector<PlanStep> steps;
  std::vector<PlanSkip> skipped;
  Grid grid;
  double skin_cutoff = 0;       // shortest wavelength of the finger's skin [m]
  double effective_cutoff = 0;  // shortest skin wavelength on this grid [m]
  double feature_pixels = 0;    // across the smallest feature of the texture; infinite: none
  // For people: why this is not the finger's skin, why not the texture. Empty: they are.
  std::vector<std::string> warnings;

  // The decisions as data, for the forward model.
  bool field = false;            // electrostatics and electrowetting
  bool water = false;            // capillary bridges
  bool retention = false;        // lateral hysteresis force
  bool traction_solves = false;  // contact solved again with tractions

  double seconds() const;
  std::string text() const;  // for people, one line per step
  bool operator==(const Plan&) const = default;
};

// "0.4 s", "100 s", "5 min": expected times for people.
std::string duration(double seconds);

Plan make_plan(const Scene& scene, const Texture& texture, const Fidelity& fidelity);
// The plan where a metric or a limit asks for the look: optics among what is modelled, by that
// theory.
Plan with_look(Plan plan, const std::string& theory);

}  // namespace papilla::forward
