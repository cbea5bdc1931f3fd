// The way of the current from the source to the skin: what leakage of film, gap and skin leaves to
// the gap, and the voltage that a current source needs. Equations drive.12 to drive.15, drive.19
// and drive.20.
#pragma once

#include <complex>
#include <vector>

#include "base/rooms.h"
#include "scene/scene.h"

namespace papilla::forward {

// Film and skin in series with the gap at the frequency of the drive, as the gap feels them: real
// and imaginary part of d/eps [m]. Eq. drive.12
struct SeriesLayers {
  // Of each layer of the film, as it is on the flat: its d/eps times this.
  std::vector<std::complex<double>> of_film;
  std::complex<double> skin = 0;  // h_SC [m]

  std::complex<double> film(const Surface& surface) const;  // their sum [m]
};
SeriesLayers series_layers(const Scene& scene, double relative_humidity);

// How the layers of the film divide a voltage that stands on all of it: by d/eps times these. 1 for
// the first layer; the others by what it conducts over what they do. Eq. drive.4
std::vector<std::complex<double>> film_divider(const Surface& surface, const Drive& drive);

// Of the voltage that electrode and body share, what stands on film and skin below water that
// leads, as a d/eps [m] that holds the same energy as all the voltage on it would. Eq. drive.13
double wetted_series(const Scene& scene, double relative_humidity);

// The skin's layer between water and body, as a d/eps beside that of a film as `dielectric` [m]:
// the divider of both has the magnitude of the water's potential, in which what conducts counts.
// Eq. drive.19
double water_skin_layer(const Scene& scene, double relative_humidity, double dielectric);

// What the source applies at a humidity. Under voltage control what it holds; under current control
// what the current needs through the ridges under the finger, far gaps included, water and texture
// left out, at most the compliance of the source. Eq. drive.14
struct SourceVoltage {
  double peak = 0, rms = 0;    // [V]
  bool at_compliance = false;  // the current is not reached
};
SourceVoltage source_voltage(const Scene& scene, double relative_humidity);

// Time constants of a direct voltage: how long the pull takes to become what it stays [s]: charge
// that leaks through the gap, for a plane gap [m]; infinite where nothing leaks. What disperses
// counts as its resistor and capacitor alone. Eq. drive.15
double relaxation_time(const Scene& scene, double relative_humidity, double gap);

}  // namespace papilla::forward
