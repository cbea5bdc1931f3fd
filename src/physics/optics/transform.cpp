#include "physics/optics/transform.h"

#include <complex>

#include "numerics/fft.h"

namespace papilla::optics {
namespace {

using Complex = std::complex<double>;

// Half spectrum of a real field.
SpectrumArray half_spectrum(const Grid& grid, const RealArray& real) {
  const auto fft = Fft2d::shared(grid.nx, grid.ny);
  SpectrumArray out(fft->spectrum_size());
  fft->forward(real.data(), out.data());
  return out;
}

std::size_t opposite(const Grid& grid, int ix, int iy) {
  return grid.index(wrap(-ix, grid.nx), wrap(-iy, grid.ny));
}

}  // namespace

SpectrumArray coefficients(const Grid& grid, const SpectrumArray& field) {
  RealArray re(grid.size()), im(grid.size());
  for (std::size_t i = 0; i < field.size(); ++i) re[i] = field[i].real(), im[i] = field[i].imag();
  const SpectrumArray a = half_spectrum(grid, re), b = half_spectrum(grid, im);
  const int half = grid.nx / 2 + 1;
  const double share = 1 / static_cast<double>(grid.size());
  const Complex i(0, 1);
  SpectrumArray out(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < half; ++ix) {
      const std::size_t k = static_cast<std::size_t>(iy) * half + ix;
      out[grid.index(ix, iy)] = share * (a[k] + i * b[k]);
      // Real fields: the opposite orders are conjugate.
      if (ix > 0 && 2 * ix < grid.nx)
        out[opposite(grid, ix, iy)] = share * (std::conj(a[k]) + i * std::conj(b[k]));
    }
  }
  return out;
}

SpectrumArray field_of(const Grid& grid, const SpectrumArray& c) {
  const auto fft = Fft2d::shared(grid.nx, grid.ny);
  SpectrumArray re(fft->spectrum_size()), im(fft->spectrum_size());
  const Complex i(0, 1);
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < fft->half(); ++ix) {
      const Complex here = c[grid.index(ix, iy)], there = std::conj(c[opposite(grid, ix, iy)]);
      const std::size_t k = static_cast<std::size_t>(iy) * fft->half() + ix;
      re[k] = 0.5 * (here + there);
      im[k] = -0.5 * i * (here - there);
    }
  }
  RealArray x(grid.size()), y(grid.size());
  fft->inverse(re.data(), x.data());
  fft->inverse(im.data(), y.data());
  SpectrumArray out(grid.size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = {x[k], y[k]};
  return out;
}

}  // namespace papilla::optics
