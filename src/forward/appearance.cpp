#include "forward/appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>

#include "base/constants.h"
#include "geometry/roughness.h"

namespace papilla {
namespace {

constexpr double kRandomPatch = 100e-6;  // orders 0.3 deg apart
constexpr int kPeriodPixels = 96, kRandomPixels = 1024;
constexpr double kTrusted = 2e-6;  // narrower features: compare with a rigorous method
constexpr double kTrustedSlope = 20 * kPi / 180;

void warn(Optics& o, const std::string& text) {
  o.warning += (o.warning.empty() ? "" : "; ") + text;
}

Optics layer(const Texture& texture, const OpticalMedia& media, const View& view) {
  Disorder disorder{0, view.displacement, view.diameter_scatter};
  Features features = Features::Holes;
  if (const auto* holes = std::get_if<HoleArray>(&texture.kind)) {
    disorder.width = holes->diameter;
  } else if (const auto* pillars = std::get_if<PillarArray>(&texture.kind)) {
    disorder.width = pillars->diameter;
    features = Features::Pillars;
  } else if (const auto* grooves = std::get_if<Grating>(&texture.kind)) {
    disorder.width = grooves->width;
    features = Features::Lines;
  }
  return effective_medium(open_fraction(texture), texture_depth(texture), features, media, disorder,
                          {visible_wavelengths(), view.angles});
}

// Below this period no order but the undeviated one leaves the layer.
double finest_period(double index, const View& view) {
  const double steepest = *std::max_element(view.angles.begin(), view.angles.end());
  return visible_wavelengths().front() / (index + std::sin(steepest));
}

Optics screen(const Texture& texture, const OpticalMedia& media, const Light& light) {
  const double period = texture_period(texture);
  const bool array = quick_appearance(texture);
  Grid grid = patch_grid(texture, kRandomPixels, kRandomPatch);
  if (array) {
    grid = patch_grid(texture, 2 * kPeriodPixels, 2 * period);
    grid.nx /= 2, grid.lx /= 2;  // one of the two periods
  }
  const double edge =
      std::max(rim_radius(texture) < kInfinity ? rim_radius(texture) : 0.0, 0.1 * grid.dx());
  const PixelEdges edges =
      array && edge < 0.1 * period ? PixelEdges::TwoLevels : PixelEdges::Sloped;
  const Heightmap h = generate(texture, grid);
  Optics out = phase_screen(h, edges, media, light);
  if (array) {
    const FabricationMargins margins = fabrication_margins(texture);
    const double feature = std::min(margins.min_hole, margins.min_wall);
    if (feature < kTrusted) {
      warn(out, fmt::format("features of {:.2g} um are few wavelengths: scalar theory is rough",
                            1e6 * feature));
    } else if (texture_depth(texture) > 0.5 * feature) {
      warn(out, "deep against its width: a thin screen is rough");
    }
  } else if (const double slope = std::atan(roughness_parameters(h).sdq); slope > kTrustedSlope) {
    warn(out, fmt::format("slopes of {:.0f} deg (root mean square) are too steep for a thin screen",
                          slope * 180 / kPi));
  }
  return out;
}

Optics computed(const Texture& texture, double index, const View& view) {
  const OpticalMedia media{index, view.fill_index};
  const Light light{visible_wavelengths(), view.angles};
  Optics out;
  if (texture_depth(texture) <= 0) {
    const Heightmap flat{{8, 8, 1e-6, 1e-6}, std::vector<double>(64, 0.0)};
    out = phase_screen(flat, PixelEdges::Sloped, media, light);
    out.regime = OpticsRegime::Flat;
  } else if (const std::string why = optics_refusal(texture, index, view); !why.empty()) {
    out.regime = OpticsRegime::Refused;
    out.warning = why;
    return out;
  } else if (quick_appearance(texture) && texture_period(texture) < finest_period(index, view)) {
    out = layer(texture, media, view);
  } else {
    out = screen(texture, media, light);
  }
  if (view.fill_index > 1) {
    warn(out, "seen with the texture filled; the finger feels it open");
  }
  return out;
}

}  // namespace

bool quick_appearance(const Texture& texture) {
  return std::holds_alternative<Flat>(texture.kind) ||
         std::holds_alternative<HoleArray>(texture.kind) ||
         std::holds_alternative<PillarArray>(texture.kind) ||
         std::holds_alternative<Grating>(texture.kind);
}

std::string optics_refusal(const Texture& texture, double index, const View& view) {
  const double period = texture_period(texture);
  const double finest = finest_period(index, view), red = visible_wavelengths().back();
  if (!quick_appearance(texture) || texture_depth(texture) <= 0 || period < finest ||
      period >= 2 * red) {
    return {};
  }
  return fmt::format(
      "period {:.0f} nm is neither below {:.0f} nm (effective medium) nor above {:.0f} nm (phase "
      "screen)",
      1e9 * period, 1e9 * finest, 1e9 * 2 * red);
}

Optics appearance(const Texture& texture, double index, const View& view) {
  struct Answer {
    Texture texture;
    double index;
    View view;
    Optics optics;
  };
  static std::mutex mutex;
  static std::deque<Answer> kept;  // newest first
  constexpr std::size_t kKept = 32;
  {
    const std::lock_guard lock(mutex);
    for (const Answer& a : kept) {
      if (a.texture == texture && a.index == index && a.view == view) return a.optics;
    }
  }
  Optics out = computed(texture, index, view);
  const std::lock_guard lock(mutex);
  kept.push_front({texture, index, view, out});
  if (kept.size() > kKept) kept.pop_back();
  return out;
}

}  // namespace papilla
