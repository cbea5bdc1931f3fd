// The amplitude of light at one place of a textured face, by its height: the texture, the films
// that follow it and those that lie flat below it. Eq. optics.1, 10
#pragma once

#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "physics/optics/colour.h"
#include "physics/optics/media.h"

namespace papilla::optics {

// What the texture is made of and lies in.
struct OpticalMedia {
  double index = 1.46;        // of what the texture is cut into
  double fill = 1;            // of what fills it: 1 air, up to `index` for a matched over-coat
  std::vector<Film> coats{};  // follow the texture, equally thick everywhere; the outermost first
  double thickness = kInfinity;  // of what the texture is cut into; infinite: the plate itself [m]
  double extinction = 0;         // of it, where it is a film
  std::vector<Film> films{};     // flat, below it, down to the plate
  double plate_index = 1.46;     // of the plate, where the texture is cut into a film
  double back = 1;               // behind the plate: 1 air, the plate's own: bonded to a panel

  bool cut_into_film() const { return thickness < kInfinity; }
  double glass() const { return cut_into_film() ? plate_index : index; }
  bool absorbs() const;
  // What light goes further that comes back from the plate than what comes back from the top, over
  // the normal: the fringes of its films follow each other at 1/path of 1/wavelength [m].
  double path() const;

  bool operator==(const OpticalMedia&) const = default;
};

// Wavelengths that gloss is read at: for the fringes of the films, half of their paths again for
// light that goes there twice, and for those of a texture whose relief makes a path of this length
// [m]. Eq. optics.20
std::vector<PhotopicNode> gloss_nodes(const OpticalMedia& media, double of_relief);

class Column {
 public:
  Column(const OpticalMedia& media, Polarisation p, double sine, double wavelength);

  // From the fill into the plate, at this height over the land [m]: |.|^2 is a share of the power.
  Complex through(double height) const;
  Complex back(double height) const;  // reflected into the fill
  // What a flat face reflects from inside, at the height of the land.
  double from_inside() const;
  // What that face and a back face of this reflection send into the fill of light from there.
  double into_fill(double back) const;

  // The amplitude has the same size at every height: a phase screen, of so much phase a metre.
  bool even() const { return !media_.cut_into_film(); }
  double phase_through() const { return through_; }
  double phase_back() const { return back_; }
  // Of what is cut into a film: what its top reflects at the height of the land, of phase_back() a
  // metre, and what comes from below, of phase_below(). Both are all that `back` has there.
  Complex top() const;
  double phase_below() const { return 2 * through_; }

 private:
  Amplitudes flat(double height) const;

  const OpticalMedia& media_;
  Polarisation polarisation_;
  double sine_, wavelength_, through_, back_;
  Amplitudes at_land_;
};

}  // namespace papilla::optics
