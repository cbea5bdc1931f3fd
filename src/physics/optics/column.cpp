#include "physics/optics/column.h"

#include <algorithm>
#include <cmath>

namespace papilla::optics {

bool OpticalMedia::absorbs() const {
  const auto lossy = [](const Film& f) { return f.extinction > 0; };
  return extinction > 0 || std::any_of(coats.begin(), coats.end(), lossy) ||
         std::any_of(films.begin(), films.end(), lossy);
}

double OpticalMedia::path() const {
  // Of light that goes this far times k and back exp(-8 pi 0.3 um/wavelength) is left: 1e-6.
  constexpr double kReach = 0.3e-6;
  const auto of = [](const Film& f) {
    const double seen =
        f.extinction > 0 ? std::min(f.thickness, kReach / f.extinction) : f.thickness;
    return 2 * f.index * seen;
  };
  double out = cut_into_film() ? of({index, extinction, thickness}) : 0;
  for (const Film& f : coats) out += of(f);
  for (const Film& f : films) out += of(f);
  return out;
}

std::vector<PhotopicNode> gloss_nodes(const OpticalMedia& media, double of_relief) {
  constexpr double kThereTwice = 1.5;
  return photopic_nodes(
      std::min(kThereTwice * media.path() + of_relief, kThereTwice * kLongestPath));
}

Column::Column(const OpticalMedia& media, Polarisation p, double sine, double wavelength)
    : media_(media), polarisation_(p), sine_(sine), wavelength_(wavelength) {
  const double k = 2 * kPi / wavelength;
  const double fill = normal_wave(plain(media.fill), Polarisation::S, sine).real();
  through_ = k * (normal_wave(plain(media.index), Polarisation::S, sine).real() - fill);
  back_ = -2 * k * fill;
  at_land_ = flat(0);
}

Amplitudes Column::flat(double height) const {
  std::vector<Sheet> sheets = sheets_of(media_.coats);
  if (media_.cut_into_film()) {
    sheets.push_back(
        {plain({media_.index, media_.extinction}), std::max(0.0, media_.thickness + height)});
  }
  for (const Sheet& s : sheets_of(media_.films)) sheets.push_back(s);
  return stack_amplitudes(plain(media_.fill), sheets, plain(media_.glass()), polarisation_, sine_,
                          wavelength_);
}

Complex Column::through(double height) const {
  if (even()) return at_land_.transmitted * std::polar(1.0, through_ * height);
  return flat(height).transmitted * std::polar(1.0, 0.5 * back_ * height);
}

Complex Column::back(double height) const {
  return (even() ? at_land_.reflected : flat(height).reflected) * std::polar(1.0, back_ * height);
}

Complex Column::top() const {
  return stack_amplitudes(plain(media_.fill), sheets_of(media_.coats),
                          plain({media_.index, media_.extinction}), polarisation_, sine_,
                          wavelength_)
      .reflected;
}

double Column::from_inside() const {
  if (!media_.absorbs()) return 1 - std::norm(at_land_.transmitted);
  std::vector<Sheet> sheets = sheets_of(media_.films);
  std::reverse(sheets.begin(), sheets.end());
  if (media_.cut_into_film())
    sheets.push_back({plain({media_.index, media_.extinction}), media_.thickness});
  std::vector<Sheet> coats = sheets_of(media_.coats);
  sheets.insert(sheets.end(), coats.rbegin(), coats.rend());
  return std::norm(stack_amplitudes(plain(media_.glass()), sheets, plain(media_.fill),
                                    polarisation_, sine_, wavelength_)
                       .reflected);
}

double Column::into_fill(double back) const {
  const double passed = std::norm(at_land_.transmitted);
  return std::norm(at_land_.reflected) + passed * passed * back / (1 - from_inside() * back);
}

}  // namespace papilla::optics
