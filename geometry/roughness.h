// Self-affine random surfaces and how rough a surface is.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"
#include "geometry/heightmap.h"

namespace papilla::geometry {

// Isotropic spectrum: flat from the patch size to the roll-off wavelength, C(q) ~ q^-2(1+H) down to
// the cut-off wavelength; rms over a square patch of reference_length. Eq. geometry.3
struct Spectrum {
  double rms = 0, roll_off = 1e-6, hurst = 0.8, cutoff = 1e-7;  // [m, m, -, m]
  double reference_length = 12e-6;

  bool operator==(const Spectrum&) const = default;
};

// A periodic surface. Amplitudes are those of the spectrum, phases random and keyed by the integer
// mode, so that the surface changes continuously with the patch size and is the same on every grid
// that resolves the cut-off. Modes beyond the grid's Nyquist wave number are dropped. The offset
// [m] moves the surface. Cost: one inverse FFT.
Heightmap random_surface(const Spectrum& spectrum, const Grid& grid, std::uint64_t seed,
                         std::uint64_t index, double offset_x = 0, double offset_y = 0);

// The scale of a surface whose rms height over squares of this side is known. Eq. geometry.10
RoughScale endless_scale(double rms, double correlation_length, double side);

// A periodic surface of such scales, as above: amplitudes are those of their spectra, phases random
// and keyed by the integer mode; waves longer than the grid have no place on it.
Heightmap random_surface(const std::vector<RoughScale>& scales, const Grid& grid,
                         std::uint64_t seed);

// A periodic surface of a spectrum C(q) [m^4], <h^2> the integral of it over the plane of wave
// vectors; as above.
Heightmap random_surface(const std::function<double(double q)>& spectrum, const Grid& grid,
                         std::uint64_t seed);

// ISO 25178-2 height and slope parameters; heights about the mean. Slopes by forward differences.
struct RoughnessParameters {
  double sa, sq, ssk, sku, sp, sv, sz;  // [m, m, -, -, m, m, m]
  double sdq, sdr;                      // [-]
  bool slopes_sampling_limited;  // walls steeper than a pixel can show: sdq, sdr grow with it
};
RoughnessParameters roughness_parameters(const Heightmap& heightmap);

}  // namespace papilla::geometry
