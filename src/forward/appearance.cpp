#include "forward/appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/cache.h"
#include "base/constants.h"
#include "geometry/roughness.h"

namespace papilla::forward {
namespace {

constexpr double kRandomPatch = 100e-6;  // orders 0.3 deg apart
constexpr int kPeriodPixels = 96, kRandomPixels = 1024;
constexpr double kTrusted = 2e-6;  // narrower features: compare with a rigorous method
// A shorter patch has no order that parts what leaves within 2.5 deg from haze.
const double kLeastPatch = 2 * visible_wavelengths().back() / std::sin(kHazeAngle);
constexpr double kTrustedSlope = 20 * kPi / 180;  // of a thin screen (docs/theory/optics.md)

constexpr std::size_t kMostLooks = 32;

// What a look depends on.
struct Seen {
  Texture texture;
  double index;
  View view;

  bool operator==(const Seen&) const = default;
};

void warn(Optics& o, const std::string& text) {
  o.warning += (o.warning.empty() ? "" : "; ") + text;
}

// A layer of features finer than the wavelength.
Optics layer(const FeatureArray& array, const TextureFacts& known, const OpticalMedia& media,
             const View& view) {
  const bool lines = array.shape == FeatureArray::Shape::Line;
  const Features features = lines        ? Features::Lines
                            : array.deep ? Features::Holes
                                         : Features::Pillars;
  return effective_medium(known.open_share.value(), known.relief.height().value(), features, media,
                          {array.width, view.displacement, view.diameter_scatter},
                          {visible_wavelengths(), view.angles});
}

// Below this period no order but the undeviated one leaves the layer.
double finest_period(double index, const View& view) {
  const double steepest = *std::max_element(view.angles.begin(), view.angles.end());
  return visible_wavelengths().front() / (index + std::sin(steepest));
}

// Walls and rims that reach those of their neighbours: slopes everywhere.
Heightmap one_period(const Texture& texture, double period) {
  Grid grid = patch_grid(texture, 2 * kPeriodPixels, 2 * period);
  grid.nx /= 2, grid.lx /= 2;
  return generate(texture, grid);
}

Optics screen(const Texture& texture, const OpticalMedia& media, const Light& light) {
  const TextureFacts known = facts(texture);
  if (const auto* array = std::get_if<FeatureArray>(&known.outline)) {
    Optics out = has_closed_form(*array)
                     ? array_screen(*array, media, light)
                     : phase_screen(one_period(texture, known.period()), media, light);
    const double feature = known.margins.smallest();
    if (feature < kTrusted) {
      warn(out, fmt::format("features of {:.2g} um are few wavelengths: scalar theory is rough",
                            1e6 * feature));
    } else if (known.relief.height() > 0.5 * feature) {
      warn(out, "deep against its width: a thin screen is rough");
    }
    return out;
  }
  const Grid grid = patch_grid(texture, kRandomPixels, kRandomPatch);
  const Heightmap h = generate(texture, grid);
  Optics out = phase_screen(h, media, light);
  if (const double slope = std::atan(roughness_parameters(h).sdq); slope > kTrustedSlope) {
    warn(out, fmt::format("slopes of {:.0f} deg (root mean square) are too steep for a thin screen",
                          slope * 180 / kPi));
  }
  if (const double side = std::min(grid.lx, grid.ly); side < kLeastPatch) {
    warn(out, fmt::format(
                  "a patch of {:.3g} um is short: what leaves within 2.5 deg counts as "
                  "haze; use a patch of {:.3g} um or more to exclude light scattered below 2.5 deg",
                  1e6 * side, 1e6 * kLeastPatch));
  }
  return out;
}

Optics computed(const Texture& texture, double index, const View& view) {
  const OpticalMedia media{index, view.fill_index};
  const Light light{visible_wavelengths(), view.angles};
  const TextureFacts known = facts(texture);
  const auto* array = std::get_if<FeatureArray>(&known.outline);
  Optics out;
  if (!known.relief.present) {
    const Heightmap flat{{8, 8, 1e-6, 1e-6}, std::vector<double>(64, 0.0)};
    out = phase_screen(flat, media, light);
    out.regime = OpticsRegime::Flat;
  } else if (const std::string why = optics_refusal(texture, index, view); !why.empty()) {
    out.regime = OpticsRegime::Refused;
    out.warning = why;
    return out;
  } else if (array && array->period < finest_period(index, view)) {
    out = layer(*array, known, media, view);
  } else {
    out = screen(texture, media, light);
  }
  if (view.fill_index > 1) {
    warn(out, "seen with the texture filled; the finger feels it open");
  }
  return out;
}

}  // namespace

std::string optics_refusal(const Texture& texture, double index, const View& view) {
  const TextureFacts known = facts(texture);
  const auto* array = std::get_if<FeatureArray>(&known.outline);
  if (!array || !known.relief.present) return {};
  const double period = array->period;
  const double finest = finest_period(index, view), red = visible_wavelengths().back();
  if (period < finest || period >= 2 * red) return {};
  return fmt::format(
      "period {:.0f} nm is neither below {:.0f} nm (effective medium) nor above {:.0f} nm (phase "
      "screen)",
      1e9 * period, 1e9 * finest, 1e9 * 2 * red);
}

Optics appearance(const Texture& texture, double index, const View& view) {
  // Fingers, scenarios and variants of the model ask for the look of the same texture, which of
  // rough glass takes longer than an evaluation of a search.
  static Cache<Seen, Optics> kept(kMostLooks, kInfinity);
  return *kept.get({texture, index, view}, 0,
                   [&] { return std::make_shared<const Optics>(computed(texture, index, view)); });
}

}  // namespace papilla::forward
