#include "physics/optics/optics.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/optics/screen.h"

namespace papilla::optics {
namespace {

// What a plate lets through whose textured face lets through this share.
struct Faces {
  double straight = 0, all = 0;  // of the light on the plate
};
Faces both_faces(const Sent& sent, const Column& column, const OpticalMedia& media, Polarisation p,
                 double sine) {
  const double back = boundary_reflection(plain(media.back), plain(media.glass()), p, sine);
  const double inside =
      media.absorbs() || media.cut_into_film() ? column.from_inside() : 1 - sent.total;
  const double rest = (1 - back) / (1 - inside * back);
  return {sent.undeviated * rest, sent.total * rest};
}

SpectrumPoint seen_at(const Screen& screen, const OpticalMedia& media, double wavelength,
                      double angle, const Meters& meters) {
  SpectrumPoint out;
  out.wavelength = wavelength, out.angle = angle;
  out.specular = out.haze = out.transmitted = out.total = 0;
  const double sine = std::sin(angle), clear = 1 - meters.inner_haze;
  double cone = 0, straight = 0, total = 0;
  for (const Polarisation p : kPolarisations) {
    const Column column(media, p, sine, wavelength);
    const Sent sent = screen.through(column, wavelength, sine, meters.cone);
    const Faces faces = both_faces(sent, column, media, p, sine);
    out.transmitted += 0.5 * clear * faces.straight;
    out.total += 0.5 * faces.all;
    straight += sent.undeviated, cone += sent.cone, total += sent.total;
    if (sine == 0) break;  // both are alike
  }
  if (sine == 0) out.transmitted *= 2, out.total *= 2;
  out.specular = straight / total;
  constexpr double kRounding = 1e-12;  // a flat face scatters nothing
  const double scattered = 1 - cone / total;
  out.haze = 1 - clear * (scattered > kRounding ? 1 - scattered : 1);
  return out;
}

// Undeviated reflection at 60 deg over that of a flat face. Eq. optics.3
double mirror_share(const Screen& screen, const OpticalMedia& media, double wavelength) {
  constexpr double kSlit = 1e-9;  // takes the order 0 alone
  const Receptor narrow{kPi / 3, kSlit, kSlit, kSlit, kSlit};
  double here = 0, flat = 0;
  for (const Polarisation p : kPolarisations) {
    const Column column(media, p, std::sin(narrow.angle), wavelength);
    here += screen.received(column, wavelength, narrow);
    flat += std::norm(column.back(0));
  }
  return flat > 0 ? here / flat : 1;
}

// Of one receptor, over the light on the face, mean over the polarisations; photopic.
double read_by(const Screen& screen, const OpticalMedia& media, const Receptor& receptor,
               bool black_back) {
  double out = 0;
  const double sine = std::sin(receptor.angle);
  for (const PhotopicNode& node : photopic_nodes()) {
    for (const Polarisation p : kPolarisations) {
      const Column column(media, p, sine, node.wavelength);
      double taken = screen.received(column, node.wavelength, receptor);
      if (!black_back) {
        const double back = boundary_reflection(plain(media.back), plain(media.glass()), p, sine);
        const double inside = column.from_inside();
        taken +=
            back / (1 - inside * back) * screen.received_twice(column, node.wavelength, receptor);
      }
      out += 0.5 * node.weight * taken;
    }
  }
  return out;
}

// Eq. optics.11
double gloss_units(const Screen& screen, const OpticalMedia& media, int degrees, bool black_back) {
  const Receptor& receptor = gloss_meter(degrees);
  return 100 * read_by(screen, media, receptor, black_back) /
         face_reflection(kGlossStandard, std::sin(receptor.angle));
}

void read_meters(Optics& o, const Screen& screen, const OpticalMedia& media, const Meters& meters) {
  o.gloss_20 = gloss_units(screen, media, 20, meters.black_back);
  o.gloss = gloss_units(screen, media, 60, meters.black_back);
  o.gloss_85 = gloss_units(screen, media, 85, meters.black_back);
  const double mirror = read_by(screen, media, image_meter(false), true);
  // Nothing is reflected where the fill has the glass's index: no image to blur.
  if (mirror > 0) {
    o.distinctness = std::max(0.0, 1 - read_by(screen, media, image_meter(true), true) / mirror);
  }
  if (meters.panel) o.sparkle = screen.sparkle(media.index - media.fill, *meters.panel);
}

Optics seen_through(const Screen& screen, const OpticalMedia& media, const Light& light) {
  Optics out;
  out.regime = OpticsRegime::PhaseScreen;
  for (const double angle : light.angles) {
    for (const double wavelength : light.wavelengths) {
      out.spectrum.push_back(seen_at(screen, media, wavelength, angle, light.meters));
      out.spectrum.back().mirror = mirror_share(screen, media, wavelength);
    }
  }
  photopic_means(out, light);
  read_meters(out, screen, media, light.meters);
  return out;
}

}  // namespace

void photopic_means(Optics& o, const Light& light) {
  o.haze = o.transmittance = o.total_transmittance = o.colour_shift = 0;
  const double share = 1.0 / static_cast<double>(light.angles.size());
  auto point = o.spectrum.begin();
  for (std::size_t a = 0; a < light.angles.size(); ++a) {
    double sum = 0, haze = 0, transmittance = 0, total = 0;
    std::vector<double> seen, source;
    for (const double wavelength : light.wavelengths) {
      const SpectrumPoint& p = *point++;
      const double weight = observer(wavelength)[1];
      sum += weight;
      haze += weight * p.haze;
      transmittance += weight * p.transmitted;
      total += weight * p.total;
      seen.push_back(p.transmitted), source.push_back(1);
    }
    o.haze += share * haze / sum;
    o.transmittance += share * transmittance / sum;
    o.total_transmittance += share * total / sum;
    const auto through = chromaticity(light.wavelengths, seen),
               plain_light = chromaticity(light.wavelengths, source);
    o.colour_shift += share * std::hypot(through[0] - plain_light[0], through[1] - plain_light[1]);
  }
}

Optics phase_screen(const Heightmap& h, const OpticalMedia& media, const Light& light) {
  return seen_through(*map_screen(h), media, light);
}

bool has_closed_form(const FeatureArray& array) {
  if (array.terraces.empty()) return false;
  const double outermost = array.terraces.front().width, innermost = array.terraces.back().width;
  return outermost <= array.period && innermost >= 0;
}

Optics array_screen(const FeatureArray& array, const OpticalMedia& media, const Light& light) {
  return seen_through(*array_screen_of(array), media, light);
}

Optics rough_look(const std::vector<RoughScale>& scales, const OpticalMedia& media,
                  const Light& light) {
  return seen_through(*rough_screen(scales), media, light);
}

}  // namespace papilla::optics
