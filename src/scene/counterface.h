// What touches the surface: the finger, or a body of metal, polymer or rubber. Plain values, SI.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/fields.h"

namespace papilla::scene {

// Self-affine like that of a skin, over all wavelengths from the longest on.
struct PinRoughness {
  double rms = 0;           // of all of it [m]; 0: smooth
  double longest = 100e-6;  // wavelengths [m]
  double roll_off = 20e-6;  // C(q) is flat above it
  double hurst = 0.8;
  double cutoff = 100e-9;
  std::string map{};     // measured topography instead of the spectrum (a file), or ""
  double map_width = 0;  // its lateral size where the file does not say

  bool operator==(const PinRoughness&) const = default;
};
void fields(FieldVisitor& v, PinRoughness& s);

enum class PinFace { Sphere, Flat };

// A solid body. A number that is 0 where it has to be given is reported (`pin_problems`).
struct Pin {
  std::string name = "pin";
  double load = 0;     // normal force [N]
  double modulus = 0;  // Young's [Pa]
  double poisson = 0.35;
  double hardness = 0;  // cap on contact pressure [Pa]; 0: none
  PinFace face = PinFace::Sphere;
  double radius = 0;  // of a sphere [m]
  double area = 0;    // of a flat face [m^2]
  PinRoughness roughness{};
  // Its friction: one of the two.
  double shear_strength = 0;  // [Pa]
  double coefficient = 0;     // of the normal force
  bool conducting = true;
  double water = 0;                           // on a 12 x 12 um patch [m^3]
  double contact_angle = 1.2217304763960306;  // of it, 70 deg

  bool operator==(const Pin&) const = default;
};
void fields(FieldVisitor& v, Pin& s);

// What is missing or contradicts, by key.
struct PinProblem {
  std::string key, message;
};
std::vector<PinProblem> pin_problems(const Pin& pin);

enum class CounterfaceType { Finger, Pin, Pen };

// The finger of the design, this pin in its place, or the second one, which a study may ask for
// beside either ("mean(pen.friction)").
struct Counterface {
  CounterfaceType type = CounterfaceType::Finger;
  Pin pin, pen{.name = "pen"};

  bool has_pen() const { return pen != Counterface{}.pen; }
  // What touches in place of the finger; null: nothing does.
  const Pin* in_place() const;

  bool operator==(const Counterface&) const = default;
};
void fields(FieldVisitor& v, Counterface& s);

}  // namespace papilla::scene
