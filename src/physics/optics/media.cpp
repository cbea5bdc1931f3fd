#include "physics/optics/media.h"

#include <cmath>

#include "base/constants.h"

namespace papilla::optics {

Medium plain(Complex index) { return {index * index, index * index, index * index}; }

Complex normal_wave(const Medium& m, Polarisation p, double sine) {
  return p == Polarisation::S ? std::sqrt(m.across - sine * sine)
                              : std::sqrt(m.along * (1.0 - sine * sine / m.normal));
}

Complex admittance(const Medium& m, Polarisation p, double sine) {
  const Complex w = normal_wave(m, p, sine);
  return p == Polarisation::S ? w : m.along / w;
}

double boundary_reflection(const Medium& from, const Medium& to, Polarisation p, double sine) {
  const Complex a = admittance(from, p, sine), b = admittance(to, p, sine);
  return std::norm((a - b) / (a + b));
}

double face_reflection(double index, double sine) {
  double out = 0;
  for (const Polarisation p : kPolarisations)
    out += 0.5 * boundary_reflection(plain(1), plain(index), p, sine);
  return out;
}

std::vector<Sheet> sheets_of(const std::vector<Film>& films) {
  std::vector<Sheet> out;
  for (const Film& f : films) out.push_back({plain({f.index, f.extinction}), f.thickness});
  return out;
}

Amplitudes stack_amplitudes(const Medium& from, const std::vector<Sheet>& sheets, const Medium& to,
                            Polarisation p, double sine, double wavelength) {
  const Complex i(0, 1), first = admittance(from, p, sine), last = admittance(to, p, sine);
  // Tangential electric and magnetic field over the transmitted one, from the last boundary up.
  Complex e = 1, h = last;
  for (std::size_t k = sheets.size(); k-- > 0;) {
    const Sheet& s = sheets[k];
    const Complex y = admittance(s.medium, p, sine);
    const Complex turn = 2 * kPi / wavelength * s.thickness * normal_wave(s.medium, p, sine);
    const Complex cosine = std::cos(turn), along = i * std::sin(turn);
    const Complex above = cosine * e - along / y * h;
    h = cosine * h - along * y * e;
    e = above;
  }
  const Complex sum = first * e + h;
  return {(first * e - h) / sum, 2.0 * first / sum * std::sqrt(last.real() / first.real())};
}

double plate(double reflected1, double reflected2) {
  return (1 - reflected1) * (1 - reflected2) / (1 - reflected1 * reflected2);
}

OuterFace::OuterFace(double fill, Polarisation p, double sine)
    : reflected_(boundary_reflection(plain(1), plain(fill), p, sine)) {}

}  // namespace papilla::optics
