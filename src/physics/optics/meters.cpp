#include "physics/optics/meters.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"

namespace papilla::optics {
namespace {

constexpr double kDegree = kPi / 180;

// Overlap of a slit with the image of the source, over the image.
double overlap(double distance, double slit, double source) {
  const double half = 0.5 * (slit + source);
  return std::clamp((half - std::abs(distance)) / std::min(slit, source), 0.0, 1.0) *
         std::min(1.0, slit / source);
}

constexpr Receptor made(double angle, double width, double height) {
  return {angle * kDegree, width * kDegree, height * kDegree, 0.75 * kDegree, 2.5 * kDegree};
}

}  // namespace

double Receptor::accepts(double dx, double dy) const {
  const double rest = std::sqrt(1 - std::min(1.0, dy * dy)), sine = std::sin(angle) + dx;
  if (rest <= 0 || std::abs(sine) >= rest) return 0;
  return along(std::asin(sine / rest) - angle) * across(std::asin(dy));
}

double Receptor::along(double off) const { return overlap(off - offset, width, source_width); }
double Receptor::across(double off) const { return overlap(off, height, source_height); }

double Receptor::reach_x() const { return 0.5 * (width + source_width); }
double Receptor::reach_y() const { return 0.5 * (height + source_height); }

const Receptor& gloss_meter(int degrees) {
  static constexpr Receptor k20 = made(20, 1.8, 3.6), k60 = made(60, 4.4, 11.7),
                            k85 = made(85, 4.0, 6.0);
  switch (degrees) {
    case 20:
      return k20;
    case 60:
      return k60;
    case 85:
      return k85;
    default:
      PAPILLA_CHECK(false, "a gloss meter has 20, 60 and 85 deg");
      return k60;
  }
}

const Receptor& image_meter(bool aside) {
  constexpr Receptor middle{20 * kDegree, 0.14 * kDegree, 3.6 * kDegree, 0.14 * kDegree,
                            2.5 * kDegree};
  static constexpr Receptor kMirror = middle, kAside = [=] {
    Receptor out = middle;
    out.offset = 0.3 * kDegree;
    return out;
  }();
  return aside ? kAside : kMirror;
}

}  // namespace papilla::optics
