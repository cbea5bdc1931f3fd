// How a texture looks on glass: haze, transmittance, gloss, distinctness of image, sparkle and
// colour; one textured face, films, a plate. docs/theory/optics.md.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"
#include "geometry/heightmap.h"
#include "physics/optics/colour.h"
#include "physics/optics/column.h"
#include "physics/optics/meters.h"
#include "physics/optics/regime.h"

namespace papilla::optics {

// What the texture is looked at with: every wavelength from every direction.
struct Light {
  std::vector<double> wavelengths = visible_wavelengths();  // [m], in vacuum
  std::vector<double> angles{0};  // between the light in air and the normal [rad], below 80 deg
  Meters meters{};

  // The same with each wavelength by those that stand for its row. Eq. optics.20
  Light followed(double path) const;
};

struct SpectrumPoint {
  double wavelength = 0;   // [m], in vacuum
  double angle = 0;        // [rad], in air
  double specular = 1;     // share of the transmitted light in the undeviated order
  double haze = 0;         // share of the transmitted light beyond the cone
  double transmitted = 1;  // undeviated share of the incident light, both faces of the plate
  double total = 1;        // all of the transmitted light over the incident
  double mirror = 1;       // undeviated reflection of the face at 60 deg over that of flat glass
};

// Photopic means, over the angles. Gloss in gloss units, all else shares.
struct Look {
  double haze = 0, transmittance = 1, gloss = 0;
  double colour_shift = 0;  // CIE 1976 u'v' distance of the undeviated light from the source
  double total_transmittance = 1;
  double gloss_20 = 0, gloss_85 = 0;
  double distinctness = 1;  // of image, at 20 deg
  double sparkle = 0;       // 0 without a panel

  bool operator==(const Look&) const = default;
};
inline constexpr std::array kLookNumbers{
    &Look::haze,         &Look::transmittance,       &Look::gloss,
    &Look::colour_shift, &Look::total_transmittance, &Look::gloss_20,
    &Look::gloss_85,     &Look::distinctness,        &Look::sparkle};

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
  double resolved = 0;      // 0: features finer than the wavelength, 1: far wider ones
};

// Thin phase screen of one period (or a patch of 100 um and more for random textures).
// Eq. optics.1-4, 8. Oblique light: mean over the planes of incidence x and y. Cost: a transform of
// the pixels for each wavelength and angle.
Optics phase_screen(const Heightmap& h, const OpticalMedia& media, const Light& light = {});

// The same of an array by the closed forms of its discs and lines, terrace by terrace: no pixels.
// The outlines must not reach those of their neighbours (`has_closed_form`). Cost: terraces x
// orders inside the cones x wavelengths x angles; some milliseconds.
bool has_closed_form(const FeatureArray& array);
Optics array_screen(const FeatureArray& array, const OpticalMedia& media, const Light& light = {});

// The same of Gaussian heights, by their statistics alone. Eq. optics.12. Milliseconds.
Optics rough_look(const std::vector<RoughScale>& scales, const OpticalMedia& media,
                  const Light& light = {});

// A layer finer than the wavelength: a share `open` of it is the fill, the rest glass. Eq.
// optics.5. Lines: grooves (mean over polarisations and planes of incidence), else round holes or
// pillars: a share `open` or 1 - `open`. A perfect array scatters nothing; haze comes from
// disorder, Eq. optics.7, independent from feature to feature, single scattering.
enum class Features { Holes, Pillars, Lines };
Optics effective_medium(double open, double depth, Features features, const OpticalMedia& media,
                        const Disorder& disorder = {}, const Light& light = {});

// The rows of this light, each the mean over what stands for it in the spectrum of `followed`.
void gather_rows(Optics& o, const Light& light);

// Photopic means of the spectrum of an answer: its haze, transmittances and colour. Eq. optics.6
void photopic_means(Optics& o, const Light& light);

}  // namespace papilla::optics
