// A textured face as a thin screen: where it sends light, for any amplitude by height.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"
#include "geometry/heightmap.h"
#include "physics/optics/column.h"
#include "physics/optics/meters.h"

namespace papilla::optics {

// Shares of the light on the face.
struct Sent {
  double undeviated = 0;  // in the direction that a flat face would send it
  double cone = 0;        // within the cone around that direction, the undeviated in it
  double total = 0;
};

class Screen {
 public:
  virtual ~Screen() = default;

  // Through the face, mean over the planes of incidence x and y. Eq. optics.2, 8
  virtual Sent through(const Column& column, double wavelength, double sine, double cone) const = 0;
  // Reflected into receptors at one angle. Eq. optics.3, 11
  virtual std::vector<double> received(const Column& column, double wavelength,
                                       const std::vector<Receptor>& receptors) const = 0;
  double received(const Column& column, double wavelength, const Receptor& receptor) const {
    return received(column, wavelength, std::vector<Receptor>{receptor}).front();
  }
  // Share of the light that passes the face twice, to and from a mirror behind it, that a receptor
  // takes.
  virtual double received_twice(const Column& column, double wavelength,
                                const Receptor& receptor) const = 0;
  // Reflected in the mirror direction alone. Eq. optics.3
  virtual double mirrored(const Column& column, double wavelength) const = 0;
  // Difference between its two levels, whose light interferes; 0 where heights are gradual, of
  // which it averages out. [m]
  virtual double step() const = 0;
  // Spread of the power that subpixels send into the pupil, over its mean; `step`: difference of
  // the indices on both sides. Eq. optics.14-16
  virtual double sparkle(double step, const Panel& panel) const = 0;
};

// Of any heightmap. Cost: a transform of its pixels each time.
std::unique_ptr<Screen> map_screen(const Heightmap& map);

// Of an array by the closed forms of its discs and lines, terrace by terrace: no pixels. Eq.
// optics.9. The array must outlive it.
std::unique_ptr<Screen> array_screen_of(const FeatureArray& array);

// Of Gaussian heights of Gaussian autocorrelations: no sample of them. Eq. optics.12
std::unique_ptr<Screen> rough_screen(const std::vector<RoughScale>& scales);

}  // namespace papilla::optics
