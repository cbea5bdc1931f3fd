// A surface in the words of ISO 25178-2: heights about the mean, slopes, how far it is alike, its
// direction, and how its material is shared out.
#pragma once

#include <optional>
#include <vector>

#include "base/rooms.h"
#include "geometry/heightmap.h"

namespace papilla::geometry {

struct ArealParameters {
  // Heights [m, m, m, m, m, -, -].
  double sa = 0, sq = 0, sz = 0, sp = 0, sv = 0, ssk = 0, sku = 0;
  // Slopes between neighbouring pixels; sampling_limited: walls steeper than a pixel can show.
  double sdq = 0, sdr = 0;
  bool sampling_limited = false;
  // The shortest way on which the autocorrelation falls to 0.2 [m], and its share of the longest;
  // none where it does not fall so far within half the map.
  std::optional<double> sal, str;
  // Where the spectrum is strongest, from the x axis toward y, 0 to pi: across the grooves.
  double std = 0;
  // Core, peaks above and valleys below it [m]; shares of material at both ends of the core.
  double sk = 0, spk = 0, svk = 0, smr1 = 0, smr2 = 0;
};

// Of a map that does not repeat: nothing is taken across its border. Cost: three FFTs of four times
// its pixels, one sort.
ArealParameters areal_parameters(const Heightmap& h);

// A ring of the spectrum. density: power of the heights per area of wave numbers [m^4], by which
// their variance is the sum over density times (2 pi)^2 / area (Eq. geometry.6).
struct SpectrumRing {
  double wavelength = 0;  // [m]
  double density = 0;
};
// Rings a tenth of a decade wide, from the length of the map to two pixels; of the map tapered by a
// Hann window, its loss made good.
std::vector<SpectrumRing> radial_spectrum(const Heightmap& h);

// The wavelengths that a map can know [m].
struct KnownBand {
  double longest = 0, shortest = 0;
  bool by_tip = false;  // the tip ends it before the pixels do
};
// From a quarter of the shorter side (fewer than four waves tell no power) to two pixels, or to
// where the curvature of all longer waves reaches half that of a tip of this radius [m] (0: none;
// Eq. geometry.7).
KnownBand known_band(const Heightmap& h, const std::vector<SpectrumRing>& spectrum, double tip);

// Shares of the heights in equal bins from the lowest to the highest.
std::vector<double> height_histogram(const Heightmap& h, int bins);

}  // namespace papilla::geometry
