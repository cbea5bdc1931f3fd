// Plane waves in flat layers: wave numbers, admittances, amplitudes of a stack. Eq. optics.8, 10
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "base/rooms.h"

namespace papilla::optics {

using Complex = std::complex<double>;

// A flat film: what light meets besides the texture. Index n + i k.
struct Film {
  double index = 1.46, extinction = 0;
  double thickness = 0;  // [m]

  bool operator==(const Film&) const = default;
};

// A medium as light of a given sine in air meets it: permittivity along the plane of incidence,
// across it, and along the normal. Eq. optics.8
struct Medium {
  Complex along, across, normal;
};
Medium plain(Complex index);

enum class Polarisation { S, P };  // the field across the plane of incidence, or in it
inline constexpr std::array<Polarisation, 2> kPolarisations{Polarisation::S, Polarisation::P};

// Along the normal, over that of vacuum; light that decays has a positive imaginary part.
Complex normal_wave(const Medium& medium, Polarisation p, double sine);
Complex admittance(const Medium& medium, Polarisation p, double sine);

// Share of the power that a boundary sends back.
double boundary_reflection(const Medium& from, const Medium& to, Polarisation p, double sine);
// The same of a perfect face of glass in air, mean over the polarisations.
double face_reflection(double index, double sine);

struct Sheet {
  Medium medium;
  double thickness;  // [m]
};
std::vector<Sheet> sheets_of(const std::vector<Film>& films);

// What a stack between two half spaces sends back and lets through, amplitudes of the tangential
// field; |transmitted|^2 is the share of the power. Characteristic matrices, Eq. optics.10
struct Amplitudes {
  Complex reflected, transmitted;
};
Amplitudes stack_amplitudes(const Medium& from, const std::vector<Sheet>& sheets, const Medium& to,
                            Polarisation p, double sine, double wavelength);

// Both faces of a plate without interference. Eq. optics.4
double plate(double reflected1, double reflected2);

// The flat face towards air of what fills a texture; it does not interfere. Eq. optics.4
class OuterFace {
 public:
  OuterFace(double fill, Polarisation p, double sine);

  double reflected() const { return reflected_; }
  // Of light that crosses it once, share that leaves, where what lies below reflects so much.
  double once(double below) const { return (1 - reflected_) / (1 - reflected_ * below); }
  // Of what lies below, share of its reflection that comes out: in and out.
  double twice(double below) const { return (1 - reflected_) * once(below); }

 private:
  double reflected_;
};

}  // namespace papilla::optics
