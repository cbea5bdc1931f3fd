// One piece of physics alone (`papilla solve`) for people, and for programs: JSON, schema 1, SI.
// seconds: what the solution took.
#pragma once

#include <string>

#include "base/rooms.h"
#include "geometry/heightmap.h"
#include "physics/capillary/bridge.h"
#include "physics/contact/contact.h"
#include "physics/electrostatics/field.h"
#include "physics/optics/optics.h"

namespace papilla::report {

// h: the surface that was pressed.
std::string contact_text(const ContactSolution& s, const ContactArea& area, const Heightmap& h,
                         double seconds);
std::string contact_json(const ContactSolution& s, const ContactArea& area, const Heightmap& h,
                         double seconds);

// limits: per cube root of the volume, as `size` [m] is.
std::string bridge_text(const Bridge& bridge, const BridgeLimits& limits, double size);
std::string bridge_json(const Bridge& bridge, const BridgeLimits& limits, double size);

// What a field was solved by and between.
struct FieldRun {
  std::string method;   // "local", "spread", "full"
  double area = 0;      // of the patch [m^2]
  double strength = 0;  // of the dielectric [V/m]
  double seconds = 0;

  bool iterates() const { return method != "local"; }
};
std::string field_text(const FieldSolution& s, const FieldRun& run);
std::string field_json(const FieldSolution& s, const FieldRun& run);

std::string optics_text(const Optics& look);
std::string optics_json(const Optics& look);

}  // namespace papilla::report
