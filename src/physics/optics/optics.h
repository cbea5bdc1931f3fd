// How a texture looks on glass: haze, transmittance, gloss and colour, scalar theory, one textured
// interface. docs/theory/optics.md.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"
#include "geometry/heightmap.h"
#include "physics/optics/regime.h"

namespace papilla::optics {

inline constexpr double kHazeAngle = 0.04363323129985824;  // 2.5 deg: light beyond it is haze

struct OpticalMedia {
  double index = 1.46;  // of the glass
  double fill = 1;      // of what fills the texture: 1 air, up to `index` for a matched over-coat
};

// 400 to 720 nm in steps of 20 nm.
const std::vector<double>& visible_wavelengths();

// What the texture is looked at with: every wavelength from every direction.
struct Light {
  std::vector<double> wavelengths = visible_wavelengths();  // [m], in vacuum
  std::vector<double> angles{0};  // between the light in air and the normal [rad], below 80 deg
};

struct SpectrumPoint {
  double wavelength = 0;   // [m], in vacuum
  double angle = 0;        // [rad], in air
  double specular = 1;     // share of the transmitted light in the undeviated order
  double haze = 0;         // share of the transmitted light beyond 2.5 deg
  double transmitted = 1;  // undeviated share of the incident light, both faces of the plate
  double gloss = 1;        // specular reflection at 60 deg over that of the flat glass
};

// Photopic means, over the angles.
struct Look {
  double haze = 0, transmittance = 1, gloss = 1;
  double colour_shift = 0;  // CIE 1976 u'v' distance of the undeviated light from the source

  bool operator==(const Look&) const = default;
};

struct Optics : Look {
  std::vector<SpectrumPoint> spectrum;
  OpticsRegime regime = OpticsRegime::Flat;
  std::string warning;  // for people; empty: inside the validity

  bool refused() const { return regime == OpticsRegime::Refused; }
};

// What a perfect array lacks: each feature displaced at random, each diameter (or groove width)
// another.
struct Disorder {
  double width = 0;         // mean diameter or groove width [m]; 0: none is asked for
  double displacement = 0;  // standard deviation of each coordinate [m]
  double scatter = 0;       // standard deviation / mean of the width
};

// Thin phase screen of one period (or a patch of 100 um and more for random textures).
// Eq. optics.1-4, 8. Oblique light: mean over the planes of incidence x and y. Cost: pixels x
// wavelengths x angles x orders inside the cone.
Optics phase_screen(const Heightmap& h, const OpticalMedia& media, const Light& light = {});

// The same of an array by the closed forms of its discs and lines, terrace by terrace: no pixels.
// The outlines must not reach those of their neighbours (`has_closed_form`). Cost: terraces x
// orders inside the cone x (1 + wavelengths x angles / 10); a millisecond.
bool has_closed_form(const FeatureArray& array);
Optics array_screen(const FeatureArray& array, const OpticalMedia& media, const Light& light = {});

// A layer finer than the wavelength: a share `open` of it is the fill, the rest glass. Eq.
// optics.5. Lines: grooves (mean over polarisations and planes of incidence), else round holes or
// pillars: a share `open` or 1 - `open`. A perfect array scatters nothing; haze comes from
// disorder, Eq. optics.7, independent from feature to feature, single scattering.
enum class Features { Holes, Pillars, Lines };
Optics effective_medium(double open, double depth, Features features, const OpticalMedia& media,
                        const Disorder& disorder = {}, const Light& light = {});

}  // namespace papilla::optics
