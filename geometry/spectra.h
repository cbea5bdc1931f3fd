// What several maps of one surface say of its spectrum together: the mean, how far the maps
// scatter, and which wavelengths each of them can know.
#pragma once

#include <cstddef>
#include <vector>

#include "base/rooms.h"
#include "geometry/areal.h"

namespace papilla::geometry {

// Along one direction: h_rms^2 is the integral of C over q from 0, over pi (the convention of
// contact.engineering and of the Surface-Topography Challenge). [m, m^3]. Eq. geometry.11
struct LineRing {
  double wavelength = 0, density = 0;
};
// Of all rows and all columns, in rings a tenth of a decade wide whose centres are the same for
// every map; each line tapered by a Hann window, its loss made good.
std::vector<LineRing> line_spectrum(const Heightmap& h);

struct MapSpectrum {
  std::vector<LineRing> rings;
  KnownBand band;
};

// Of the maps that know a wavelength. Eq. geometry.12
struct JointRing {
  double wavelength = 0;
  double density = 0;  // geometric mean [m^3]
  double scatter = 1;  // factor of one standard deviation between maps; 1 of a single one
  std::size_t maps = 0;
};
std::vector<JointRing> joint_spectrum(const std::vector<MapSpectrum>& maps);
// rms height of the wavelengths from the first ring to the last [m].
double joint_rms(const std::vector<JointRing>& rings);

// Medians of what 64 groups measured of two surfaces: 12 points of each curve of Figure 9 in
// Pradhan et al., "The Surface-Topography Challenge", Tribology Letters 73, 41 (2025), CC-BY 4.0,
// as contact.engineering digitised them; between them by powers of the wave number.
struct Consensus {
  double smoother = 0, rougher = 0;  // [m^3]; 0: beyond the consensus
};
Consensus consensus_at(double wavelength);

}  // namespace papilla::geometry
