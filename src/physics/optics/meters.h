// What the instruments of the trade take in: the cone of a haze meter, the apertures of a gloss
// meter and of a meter of distinctness of image, a panel below the glass.
#pragma once

#include <array>
#include <optional>

#include "base/rooms.h"

namespace papilla::optics {

inline constexpr double kHazeAngle = 0.04363323129985824;  // 2.5 deg: ASTM D1003, ISO 14782

// Slits of a goniometer on the side of the mirror direction: widths along the plane of incidence,
// heights across it [rad].
struct Receptor {
  double angle;  // of incidence, from the normal
  double width, height;
  double source_width, source_height;
  double offset = 0;  // of its middle from the mirror direction, in the plane of incidence

  // Share of the source's image that falls in, where light leaves in a direction whose sines
  // differ from the mirror's by dx in the plane of incidence and dy across it. Eq. optics.11
  double accepts(double dx, double dy) const;
  // The same of angles from the mirror direction, along the plane of incidence and across it [rad].
  double along(double angle) const;
  double across(double angle) const;
  // No direction that differs by more is accepted.
  double reach_x() const;  // [rad]
  double reach_y() const;

  bool operator==(const Receptor&) const = default;
};

// ISO 2813 (ASTM D523): source and receptor of 20, 60 and 85 deg.
const Receptor& gloss_meter(int degrees);
inline constexpr std::array<int, 3> kGlossAngles{20, 60, 85};
// The black glass that reads 100 GU at every angle.
inline constexpr double kGlossStandard = 1.567;

// Distinctness of image at 20 deg after ASTM E430 and D5767: slits of 0.14 deg on the mirror
// direction and 0.3 deg off it.
const Receptor& image_meter(bool aside);

// A display below the textured face.
struct Panel {
  double width = 0, height = 0;  // of a subpixel [m]
  double depth = 0;            // thickness over index, summed from the subpixels to the texture [m]
  double pupil = 0;            // half angle of the eye's pupil, in air [rad]
  double wavelength = 550e-9;  // of the subpixel [m]

  bool operator==(const Panel&) const = default;
};

// How the instruments are set.
struct Meters {
  double cone = kHazeAngle;  // light beyond it is haze [rad]
  double inner_haze = 0;     // share that the plate itself scatters: a hard coat, a film
  bool black_back = true;    // gloss is read on a black backing: the back face sends nothing
  std::optional<Panel> panel;

  bool operator==(const Meters&) const = default;
};

}  // namespace papilla::optics
