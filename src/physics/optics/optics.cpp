#include "physics/optics/optics.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/optics/screen.h"

namespace papilla::optics {
namespace {

// What a plate lets through whose textured face lets through this share. Eq. optics.4
struct Faces {
  double straight = 0, all = 0;  // of the light on the plate
};
Faces both_faces(const Sent& sent, const Column& column, const OpticalMedia& media, Polarisation p,
                 double sine) {
  const double back = boundary_reflection(plain(media.back), plain(media.glass()), p, sine);
  const double inside =
      media.absorbs() || media.cut_into_film() ? column.from_inside() : 1 - sent.total;
  const double rest = (1 - back) / (1 - inside * back) *
                      OuterFace(media.fill, p, sine).once(column.into_fill(back));
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
  const double sine = std::sin(kPi / 3);
  double mirrored = 0, flat = 0;
  for (const Polarisation p : kPolarisations) {
    const Column column(media, p, sine, wavelength);
    mirrored += screen.mirrored(column, wavelength);
    flat += std::norm(column.back(0));
  }
  return flat > 0 ? mirrored / flat : 1;
}

// Of receptors at one angle, over the light on the face, mean over the polarisations; photopic.
struct Readings {
  std::vector<double> face;   // on a black backing, receptor by receptor
  double from_back_face = 0;  // what the back face adds for the first of them
};
Readings read_by(const Screen& screen, const OpticalMedia& media,
                 const std::vector<PhotopicNode>& nodes, const std::vector<Receptor>& receptors,
                 bool black_back) {
  const Receptor& first = receptors.front();
  const double sine = std::sin(first.angle);
  Readings out{std::vector<double>(receptors.size(), 0.0)};
  for (const PhotopicNode& node : nodes) {
    for (const Polarisation p : kPolarisations) {
      const Column column(media, p, sine, node.wavelength);
      const OuterFace outer(media.fill, p, sine);
      const double weight = 0.5 * node.weight, comes_out = outer.twice(column.into_fill(0));
      const std::vector<double> taken = screen.received(column, node.wavelength, receptors);
      for (std::size_t k = 0; k < receptors.size(); ++k) {
        out.face[k] +=
            weight * (outer.reflected() * receptors[k].accepts(0, 0) + comes_out * taken[k]);
      }
      if (black_back) continue;
      const double back = boundary_reflection(plain(media.back), plain(media.glass()), p, sine);
      const double with_back = outer.twice(column.into_fill(back));
      out.from_back_face += weight * ((with_back - comes_out) * taken.front() +
                                      with_back * back / (1 - column.from_inside() * back) *
                                          screen.received_twice(column, node.wavelength, first));
    }
  }
  return out;
}

// Eq. optics.11
double gloss_units(const Readings& readings, int degrees) {
  return 100 * (readings.face.front() + readings.from_back_face) /
         face_reflection(kGlossStandard, std::sin(gloss_meter(degrees).angle));
}

void read_meters(Optics& o, const Screen& screen, const OpticalMedia& media, const Meters& meters) {
  const std::vector<PhotopicNode> nodes = gloss_nodes(media, 2 * media.fill * screen.step());
  const auto read = [&](const std::vector<Receptor>& receptors) {
    return read_by(screen, media, nodes, receptors, meters.black_back);
  };
  const Readings steep = read({gloss_meter(20), image_meter(false), image_meter(true)});
  o.gloss_20 = gloss_units(steep, 20);
  o.gloss = gloss_units(read({gloss_meter(60)}), 60);
  o.gloss_85 = gloss_units(read({gloss_meter(85)}), 85);
  // Nothing is reflected where all indices are alike: no image to blur.
  if (const double mirror = steep.face[1]; mirror > 0)
    o.distinctness = std::max(0.0, 1 - steep.face[2] / mirror);
  if (meters.panel) o.sparkle = screen.sparkle(media.index - media.fill, *meters.panel);
}

Optics seen_through(const Screen& screen, const OpticalMedia& media, const Light& light) {
  Optics out;
  out.regime = OpticsRegime::PhaseScreen;
  const Light followed = light.followed(media.path());
  for (const double angle : followed.angles) {
    for (const double wavelength : followed.wavelengths) {
      out.spectrum.push_back(seen_at(screen, media, wavelength, angle, light.meters));
      out.spectrum.back().mirror = mirror_share(screen, media, wavelength);
    }
  }
  photopic_means(out, followed);
  gather_rows(out, light);
  read_meters(out, screen, media, light.meters);
  return out;
}

}  // namespace

Light Light::followed(double path) const {
  Light out = *this;
  out.wavelengths.clear();
  for (const double wavelength : wavelengths) {
    for (const double here : within_row(wavelength, path)) out.wavelengths.push_back(here);
  }
  return out;
}

void gather_rows(Optics& o, const Light& light) {
  const std::size_t rows = light.angles.size() * light.wavelengths.size(),
                    count = o.spectrum.size() / rows;
  const auto mean = [&](auto point, double SpectrumPoint::*number) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += (*point++).*number;
    return sum / static_cast<double>(count);
  };
  std::vector<SpectrumPoint> out;
  for (std::size_t row = 0; row < rows; ++row) {
    const auto first = o.spectrum.begin() + static_cast<std::ptrdiff_t>(row * count);
    SpectrumPoint p = *first;
    p.wavelength = light.wavelengths[row % light.wavelengths.size()];
    for (const auto number :
         {&SpectrumPoint::specular, &SpectrumPoint::haze, &SpectrumPoint::transmitted,
          &SpectrumPoint::total, &SpectrumPoint::mirror})
      p.*number = mean(first, number);
    out.push_back(p);
  }
  o.spectrum = std::move(out);
}

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
