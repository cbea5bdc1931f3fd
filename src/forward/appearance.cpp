#include "forward/appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/cache.h"
#include "base/check.h"
#include "base/constants.h"
#include "geometry/measured_map.h"
#include "geometry/roughness.h"
#include "physics/optics/lattice/look.h"

namespace papilla::forward {
namespace {

constexpr double kRandomPatch = 100e-6;  // orders 0.3 deg apart
constexpr int kPeriodPixels = 96, kRandomPixels = 1024;
constexpr double kTrusted = 2e-6;  // narrower features: compare with a rigorous method
// Sparkle of a patch is known where this many subpixels have room along it.
constexpr double kSubpixels = 6;
constexpr double kTrustedSlope = 20 * kPi / 180;  // of a thin screen (docs/theory/optics.md)

constexpr std::size_t kMostLooks = 32;
// The Fourier modal method takes seconds: of discs up to this period, of lines, which are cheap, up
// to the other.
constexpr double kLargestDiscs = 2e-6, kLargestLines = 6e-6;

// A shorter patch has no order that parts what leaves within the cone from haze.
double least_patch(double cone) { return 2 * visible_wavelengths().back() / std::sin(cone); }

// What a look depends on.
struct Seen {
  Texture texture;
  OpticalMedia media;
  Meters meters;
  View view;
  std::vector<MapVersion> maps;

  bool operator==(const Seen&) const = default;
};

void warn(Optics& o, const std::string& text) {
  o.warning += (o.warning.empty() ? "" : "; ") + text;
}

// A layer of features finer than the wavelength; `resolved`: as in Disorder.
Optics layer(const FeatureArray& array, const TextureFacts& known, const OpticalMedia& media,
             const View& view, const Light& light, double resolved = 0) {
  const bool lines = array.shape == FeatureArray::Shape::Line;
  const Features features = lines        ? Features::Lines
                            : array.deep ? Features::Holes
                                         : Features::Pillars;
  return effective_medium(known.open_share.value(), known.relief.height().value(), features, media,
                          {array.width, view.displacement, view.diameter_scatter, resolved}, light);
}

double red() { return visible_wavelengths().back(); }

// Below this period no order but the undeviated one leaves the layer.
double finest_period(double index, const View& view) {
  const double steepest = *std::max_element(view.angles.begin(), view.angles.end());
  return visible_wavelengths().front() / (index + std::sin(steepest));
}

bool along_normal(const View& view) {
  return std::all_of(view.angles.begin(), view.angles.end(), [](double a) { return a == 0; });
}

double largest_rigorous(const FeatureArray& array) {
  return array.shape == FeatureArray::Shape::Line ? kLargestLines : kLargestDiscs;
}

// The theory of a texture that repeats. Gradual walls have no layer of one index: below the
// wavelength too they are sliced.
OpticsRegime regime_of(const Texture& texture, double index, const View& view) {
  const TextureFacts known = facts(texture);
  if (!known.relief.present) return OpticsRegime::Flat;
  if (!known.cell) return OpticsRegime::PhaseScreen;
  const std::optional<FeatureArray> array = sections(texture);
  const bool layered = std::holds_alternative<FeatureArray>(known.outline);
  const double period = known.period();
  const bool rigorous = array && along_normal(view) && view.lattices != LatticeTheory::Scalar;
  if (rigorous && view.lattices == LatticeTheory::Rigorous && period <= largest_rigorous(*array))
    return OpticsRegime::Rigorous;
  if (period < finest_period(index, view) && layered) return OpticsRegime::EffectiveMedium;
  if (period >= 2 * red()) return OpticsRegime::PhaseScreen;
  return rigorous ? OpticsRegime::Rigorous : OpticsRegime::Refused;
}

// Walls and rims that reach those of their neighbours: slopes everywhere.
Heightmap one_period(const Texture& texture, double period) {
  Grid grid = patch_grid(texture, 2 * kPeriodPixels, 2 * period);
  grid.nx /= 2, grid.lx /= 2;
  return generate(texture, grid);
}

// Where it is not counted: what the defaults make is little, and a perfect array is what is shown.
void warn_of_disorder(Optics& out, const View& view, const std::string& where) {
  const View usual;
  if (view.displacement > usual.displacement || view.diameter_scatter > usual.diameter_scatter)
    warn(out, fmt::format("view.displacement and view.diameter_scatter are not counted {}: the "
                          "haze is that of the perfect array",
                          where));
}

void warn_of_features(Optics& out, const TextureFacts& known) {
  const double feature = known.margins.smallest();
  if (feature < kTrusted) {
    warn(out, fmt::format("features of {:.2g} um are few wavelengths: scalar theory is rough",
                          1e6 * feature));
  } else if (known.relief.height() > 0.5 * feature) {
    warn(out, "deep against its width: a thin screen is rough");
  }
}

void warn_of_slope(Optics& out, double slope) {
  if (const double angle = std::atan(slope); angle > kTrustedSlope) {
    warn(out, fmt::format("slopes of {:.0f} deg (root mean square) are too steep for a thin screen",
                          angle * 180 / kPi));
  }
}

// By its statistics. The mean square slope of exp(-r^2/l^2) is 4 rms^2/l^2.
Optics of_rough(const std::vector<RoughScale>& scales, const OpticalMedia& media,
                const Light& light) {
  Optics out = rough_look(scales, media, light);
  double slope2 = 0;
  for (const RoughScale& s : scales) slope2 += square(2 * s.rms / s.correlation_length);
  warn_of_slope(out, std::sqrt(slope2));
  return out;
}

Optics screen(const Texture& texture, const OpticalMedia& media, const Light& light) {
  const TextureFacts known = facts(texture);
  if (!known.rough.empty()) return of_rough(known.rough, media, light);
  if (const std::optional<FeatureArray> array = sections(texture)) {
    Optics out = has_closed_form(*array)
                     ? array_screen(*array, media, light)
                     : phase_screen(one_period(texture, known.period()), media, light);
    warn_of_features(out, known);
    return out;
  }
  const Grid grid = patch_grid(texture, kRandomPixels, kRandomPatch);
  const Heightmap h = generate(texture, grid);
  Optics out = phase_screen(h, media, light);
  warn_of_slope(out, roughness_parameters(h).sdq);
  const double side = std::min(grid.lx, grid.ly);
  const double cone = light.meters.cone, least = least_patch(cone);
  if (side < least) {
    warn(out,
         fmt::format("a patch of {0:.3g} um is short: what leaves within {1:.3g} deg counts as "
                     "haze; use a patch of {2:.3g} um or more to exclude light scattered below "
                     "{1:.3g} deg",
                     1e6 * side, cone * 180 / kPi, 1e6 * least));
  }
  if (const std::optional<Panel>& panel = light.meters.panel;
      !known.cell && panel && side < kSubpixels * std::max(panel->width, panel->height)) {
    warn(out, fmt::format("sparkle of a patch of {:.3g} um holds few subpixels: it is rough",
                          1e6 * side));
  }
  return out;
}

Optics rigorous(const FeatureArray& array, const TextureFacts& known, const OpticalMedia& media,
                const View& view, const Light& light) {
  Optics out = lattice_look(array, media, light.meters);
  // Disorder comes from the layer, without what the plate scatters: the lattice's look has that.
  // Up to the periods of screens features are resolved more and more. Eq. optics.7
  if (known.open_share) {
    const double fine = finest_period(media.index, view), coarse = 2 * red();
    const double resolved = std::clamp((known.period() - fine) / (coarse - fine), 0.0, 1.0);
    Light along{.wavelengths = light.wavelengths, .meters = light.meters};
    along.meters.inner_haze = 0;
    const Optics disordered = layer(array, known, media, view, along, resolved);
    for (std::size_t k = 0; k < out.spectrum.size(); ++k) {
      SpectrumPoint& p = out.spectrum[k];
      const double kept = 1 - disordered.spectrum[k].haze;
      p.haze = 1 - (1 - p.haze) * kept;
      p.specular *= kept;
      p.transmitted *= kept;
    }
    photopic_means(out, along);
  } else {
    warn_of_disorder(out, view, "of a stack");
  }
  return out;
}

Optics computed(const Seen& seen) {
  const auto& [texture, media, meters, view, maps] = seen;
  const Light light{visible_wavelengths(), view.angles, meters};
  const TextureFacts known = facts(texture);
  Optics out;
  switch (regime_of(texture, media.index, view)) {
    case OpticsRegime::Flat: {
      const Heightmap flat{{8, 8, 1e-6, 1e-6}, std::vector<double>(64, 0.0)};
      out = phase_screen(flat, media, light);
      out.regime = OpticsRegime::Flat;
      break;
    }
    case OpticsRegime::EffectiveMedium:
      out = layer(std::get<FeatureArray>(known.outline), known, media, view, light);
      break;
    case OpticsRegime::PhaseScreen:
      out = screen(texture, media, light);
      break;
    case OpticsRegime::Rigorous:
      out = rigorous(*sections(texture), known, media, view, light);
      break;
    case OpticsRegime::Refused:
      PAPILLA_CHECK(false, "what is refused is not computed");
  }
  if (view.lattices == LatticeTheory::Rigorous && known.cell &&
      out.regime != OpticsRegime::Rigorous && out.regime != OpticsRegime::Flat)
    warn(out, fmt::format("view.lattices = \"rigorous\" is not followed: the Fourier modal method "
                          "takes holes and pillars up to {:.0f} um and lines up to {:.0f} um, seen "
                          "along the normal",
                          1e6 * kLargestDiscs, 1e6 * kLargestLines));
  if (out.regime == OpticsRegime::PhaseScreen && known.cell)
    warn_of_disorder(out, view, fmt::format("above periods of {:.0f} nm", 1e9 * 2 * red()));
  if (const double path = media.path(); path > kLongestPath) {
    warn(out, fmt::format("films make a path of {:.3g} um (2 n d, all of them), whose fringes are "
                          "not followed beyond {:.0f} um: gloss is known to ten units and "
                          "transmittance to half a per cent; make the films thinner, or give one "
                          "as thick as a plate the index of the glass",
                          1e6 * path, 1e6 * kLongestPath));
  }
  if (view.fill_index > 1) {
    warn(out, "seen with the texture filled; the finger feels it open");
  }
  return out;
}

// Boundaries between equal indices are none.
bool matched(const OpticalMedia& m) {
  const auto like_glass = [&](const Film& f) { return f.index == m.glass() && f.extinction == 0; };
  return (!m.cut_into_film() || (m.index == m.plate_index && m.extinction == 0)) &&
         std::all_of(m.films.begin(), m.films.end(), like_glass) &&
         std::all_of(m.coats.begin(), m.coats.end(), like_glass);
}

std::string why_not(const Texture& texture, const OpticalMedia& media, const View& view) {
  const TextureFacts known = facts(texture);
  const OpticsRegime regime = regime_of(texture, media.index, view);
  if (regime == OpticsRegime::Rigorous && !media.coats.empty()) {
    return fmt::format(
        "period {:.0f} nm with films that follow the texture (surface.process): the Fourier modal "
        "method takes flat films alone (planar)",
        1e9 * known.period());
  }
  if (regime == OpticsRegime::Rigorous && view.gloss_backing == GlossBacking::None) {
    return "view.gloss_backing = \"none\": of lattices between the theories gloss is known on a "
           "black backing alone";
  }
  if (regime != OpticsRegime::Refused) return {};
  const double period = known.period(), fine = finest_period(media.index, view);
  const bool lines = sections(texture).has_value();
  if (period < fine) {
    const std::string below = fmt::format(
        "period {:.0f} nm is below {:.0f} nm, where holes, pillars and gratings alone are layers "
        "(effective medium): gradual heights have no index of one layer",
        1e9 * period, 1e9 * fine);
    if (!lines)
      return below + fmt::format("; take {:.0f} nm or more (phase screen)", 1e9 * 2 * red());
    return below + (view.lattices == LatticeTheory::Scalar
                        ? "; the Fourier modal method takes these lines: view.lattices = "
                          "\"by_period\""
                        : "; the Fourier modal method takes these lines, seen along the normal "
                          "alone (view.angles = [\"0 deg\"])");
  }
  const std::string band = fmt::format(
      "period {:.0f} nm is neither below {:.0f} nm (effective medium) nor above {:.0f} nm (phase "
      "screen)",
      1e9 * period, 1e9 * fine, 1e9 * 2 * red());
  if (view.lattices == LatticeTheory::Scalar) return band + ", and view.lattices is \"scalar\"";
  return band + (lines ? "; between, lattices are seen along the normal alone "
                         "(view.angles = [\"0 deg\"])"
                       : "; between, holes, pillars and lines alone are known");
}

}  // namespace

OpticalMedia media_of(const Surface& surface, const View& view) {
  const double own = surface.refractive_index;
  const auto film = [&](const FilmDielectric& d) {
    return Film{d.refractive_index > 0 ? d.refractive_index : own, d.extinction, d.thickness};
  };
  OpticalMedia out;
  out.fill = view.fill_index, out.back = view.back_index;
  out.plate_index = view.glass_index > 0 ? view.glass_index : own;
  out.index = out.plate_index;
  const int carrying = surface.carrying_layer();
  // From the finger down; what lies above the layer that is cut, or all of them, follows it.
  std::vector<Film>* into = &out.coats;
  for (int k = static_cast<int>(surface.dielectric.size()) - 1; k >= 0; --k) {
    const Film f = film(surface.dielectric[static_cast<std::size_t>(k)]);
    if (k == carrying) {
      out.index = f.index, out.extinction = f.extinction, out.thickness = f.thickness;
      into = &out.films;
    } else {
      into->push_back(f);
    }
  }
  for (std::size_t k = view.films.size(); k-- > 0;) {
    const ViewFilm& f = view.films[k];
    into->push_back({f.refractive_index, f.extinction, f.thickness});
  }
  if (matched(out)) {
    const double plate = out.glass();
    out.coats.clear(), out.films.clear();
    out.index = out.plate_index = plate;
    out.thickness = kInfinity;
  }
  return out;
}

Meters meters_of(const Surface& surface, const View& view) {
  Meters out;
  out.cone = view.cone, out.inner_haze = view.inner_haze;
  out.black_back = view.gloss_backing == GlossBacking::Black;
  if (const ViewPanel& p = view.panel; p.present()) {
    const double glass = view.glass_index > 0 ? view.glass_index : surface.refractive_index;
    out.panel = Panel{p.subpixel_width, p.subpixel_height, p.glass / glass + p.gap / p.gap_index,
                      std::atan(0.5 * p.pupil / p.distance), p.wavelength};
  }
  return out;
}

namespace {

// Heights that depend on the place along x alone: of a stack no part may have any along y.
bool one_section(const Texture& texture) {
  if (const auto* stack = std::get_if<Stack>(&texture.kind)) {
    return std::all_of(stack->parts.begin(), stack->parts.end(), [](const Texture& part) {
      return !facts(part).relief.present || one_section(part);
    });
  }
  return facts(texture).directional;
}

}  // namespace

std::optional<FeatureArray> sections(const Texture& texture) {
  const TextureFacts known = facts(texture);
  if (const auto* array = std::get_if<FeatureArray>(&known.outline)) {
    return known.relief.present ? std::optional(*array) : std::nullopt;
  }
  if (!known.cell || !one_section(texture) || !known.relief.planes) return std::nullopt;
  constexpr int kPixels = 2048, kSteps = 64;
  const double period = known.period();
  const Heightmap row = generate(texture, {kPixels, 2, period, period});
  // From the land in the corner of the cell down to its middle.
  const int half = kPixels / 2;
  const double rounding = 1e-9 * (known.relief.planes->high - known.relief.planes->low);
  for (int ix = 1; ix < half; ++ix) {
    const double rise =
        std::max(row(ix, 0) - row(ix - 1, 0), row(kPixels - 1 - ix, 0) - row(kPixels - ix, 0));
    if (rise > rounding) return std::nullopt;
  }
  FeatureArray out{.shape = FeatureArray::Shape::Line,
                   .deep = true,
                   .lattice = Lattice::Square,
                   .period = period,
                   .width = 0,
                   .drawn = "grooves"};
  const double low = known.relief.planes->low, high = known.relief.planes->high;
  int ix = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double middle = high - (high - low) * (k + 0.5) / kSteps;
    while (ix < half - 1 && row(ix, 0) > middle) ++ix;
    double place = row.grid.x(ix);
    if (ix > 0) {
      const double above = row(ix - 1, 0), below = row(ix, 0);
      if (above > below)
        place = row.grid.x(ix - 1) +
                row.grid.dx() * std::clamp((above - middle) / (above - below), 0.0, 1.0);
    }
    out.terraces.push_back({period - 2 * place, high - (high - low) * (k + 1) / kSteps});
  }
  out.width = out.terraces.front().width;
  return out;
}

std::string optics_refusal(const Texture& texture, const Surface& surface, const View& view) {
  return why_not(texture, media_of(surface, view), view);
}

std::string optics_theory(const Texture& texture, const Surface& surface, const View& view) {
  const OpticalMedia media = media_of(surface, view);
  const std::string why = why_not(texture, media, view);
  return why.empty() ? text(regime_of(texture, media.index, view)) : why;
}

Optics appearance(const Texture& texture, const Surface& surface, const View& view) {
  const Seen seen{texture, media_of(surface, view), meters_of(surface, view), view,
                  map_versions(texture)};
  if (const std::string why = why_not(texture, seen.media, view); !why.empty()) {
    Optics out;
    out.regime = OpticsRegime::Refused;
    out.warning = why;
    return out;
  }
  // Fingers, scenarios and variants of the model ask for the look of the same texture, which of
  // lattices takes longer than an evaluation of a search.
  static Cache<Seen, Optics> kept(kMostLooks, kInfinity);
  return *kept.get(seen, 0, [&] { return std::make_shared<const Optics>(computed(seen)); });
}

}  // namespace papilla::forward
