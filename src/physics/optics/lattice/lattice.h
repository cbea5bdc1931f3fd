// Light on a lattice of features by the Fourier modal method: Maxwell's equations, for any period.
// Proper factorisation of products of discontinuous fields (Li 1996; by normal vectors, Schuster
// 2007), mirror symmetry, stable recursion (Moharam 1995). Eq. optics.17-19
#pragma once

#include <complex>
#include <vector>

#include "base/rooms.h"
#include "physics/optics/media.h"

namespace papilla::optics {

// A rectangular cell with a feature in its middle; centred: another one in its corners, as in the
// rectangle of a hexagonal lattice.
struct LatticeCell {
  enum class Shape { Disc, Box };
  Shape shape = Shape::Disc;
  double lx = 1, ly = 1;  // [m]
  bool centred = false;

  bool operator==(const LatticeCell&) const = default;
};

// A layer of the lattice, or a flat one where both permittivities are equal. A box as wide as the
// cell is a line.
struct LatticeSlice {
  double thickness = 0;             // [m]
  double width_x = 0, width_y = 0;  // of the feature; of a disc both are its diameter [m]
  Complex inside = 1, outside = 1;  // permittivities

  bool flat() const { return inside == outside; }
};

struct LatticeStack {
  LatticeCell cell;
  std::vector<LatticeSlice> slices;  // from the side that light comes from
  double from = 1, to = 1;           // indices of both half spaces
};

// A plane wave in the plane of incidence x; sine: index times the sine of its angle, >= 0.
struct LatticeWave {
  double wavelength;  // [m]
  double sine = 0;
  Polarisation polarisation = Polarisation::P;
};

struct LatticeOrder {
  int m, n;
  double power;   // over the incident one
  double sx, sy;  // sines of its direction, times the index
};
struct Diffracted {
  std::vector<LatticeOrder> reflected, transmitted;  // those that propagate
  int waves = 0;                                     // unknowns of each field

  double reflection() const;                                        // of all orders
  double transmission() const;                                      // of all orders
  double balance() const { return reflection() + transmission(); }  // 1 without absorption
  double straight() const;                                          // transmitted undeviated
  double mirrored() const;                                          // reflected undeviated
};

// beyond: radius of the orders kept beyond those that propagate in the denser half space or slice.
// Cost: waves^3 a slice; a millisecond for lines, 10 ms to a second for discs.
Diffracted diffract(const LatticeStack& stack, const LatticeWave& wave, int beyond);

}  // namespace papilla::optics
