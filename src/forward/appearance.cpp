#include "forward/appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla {
namespace {

constexpr double kRandomPatch = 100e-6;  // orders 0.3 deg apart
constexpr int kPeriodPixels = 96, kRandomPixels = 1024;
constexpr double kTrusted = 2e-6;  // narrower features: compare with a rigorous method

}  // namespace

Optics appearance(const Texture& texture, const OpticalMedia& media) {
  const double depth = texture_depth(texture), period = texture_period(texture);
  const double blue = visible_wavelengths().front(), red = visible_wavelengths().back();
  if (depth <= 0) {
    const Heightmap flat{{8, 8, 1e-6, 1e-6}, std::vector<double>(64, 0.0)};
    Optics out = phase_screen(flat, PixelEdges::Sloped, media);
    out.regime = "flat";
    return out;
  }
  const bool lines = std::holds_alternative<Grating>(texture.kind);
  const bool array = lines || std::holds_alternative<HoleArray>(texture.kind) ||
                     std::holds_alternative<PillarArray>(texture.kind);
  const FabricationMargins margins = fabrication_margins(texture);
  const double feature = std::min(margins.min_hole, margins.min_wall);
  if (array && period < blue / media.index) {
    Optics out = effective_medium(open_fraction(texture), depth, lines, media);
    out.warning = "a perfect array scatters nothing; haze of its disorder is not modelled";
    return out;
  }
  if (array && period < 2 * red) {
    Optics out;
    out.regime = "refused";
    out.warning = fmt::format(
        "period {:.3g} nm is neither below {:.0f} nm (effective medium) nor above {:.0f} nm (phase "
        "screen)",
        1e9 * period, 1e9 * blue / media.index, 1e9 * 2 * red);
    return out;
  }
  const Grid grid = array ? patch_grid(texture, 2 * kPeriodPixels, 2 * period)
                          : patch_grid(texture, kRandomPixels, kRandomPatch);
  const double edge =
      std::max(rim_radius(texture) < kInfinity ? rim_radius(texture) : 0.0, 0.1 * grid.dx());
  Optics out = phase_screen(
      generate(texture, grid),
      array && edge < 0.1 * period ? PixelEdges::TwoLevels : PixelEdges::Sloped, media);
  if (array && feature < kTrusted) {
    out.warning = fmt::format("features of {:.2g} um are few wavelengths: scalar theory is rough",
                              1e6 * feature);
  } else if (array && depth > 0.5 * feature) {
    out.warning = "deep against its width: a thin screen is rough";
  }
  return out;
}

}  // namespace papilla
