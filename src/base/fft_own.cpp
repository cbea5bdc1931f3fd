// Fft2d without a library: rows, then columns, kLanes of them at a time.
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/fft.h"
#include "base/fft_lanes.h"

namespace papilla::base {
namespace {

using Complex = std::complex<double>;

// Rows of even length are transformed as half as many complex numbers.
bool halved(int nx) { return nx % 2 == 0; }

LaneValue* scratch_of(std::size_t length) {
  static thread_local std::vector<LaneValue> scratch;
  if (scratch.size() < length) scratch.resize(length);
  return scratch.data();
}

void put(LaneValue& value, int lane, Complex z) {
  value.re[lane] = z.real();
  value.im[lane] = z.imag();
}
Complex at(const LaneValue& value, int lane) { return {value.re[lane], value.im[lane]}; }

}  // namespace

struct Fft2d::Plans {
  Plans(int nx_in, int ny_in)
      : nx(nx_in), ny(ny_in), half(nx / 2 + 1), row(halved(nx) ? nx / 2 : nx), column(ny) {
    for (int k = 0; k < half; ++k) twist.push_back(std::polar(1.0, -2 * kPi * k / nx));
  }

  // Room for a group of sequences, and what their transform needs.
  LaneValue* work() const {
    const auto most = std::max(row.length() + 1 + row.scratch_length(),
                               column.length() + column.scratch_length());
    return scratch_of(static_cast<std::size_t>(most));
  }

  void rows_forward(const double* real, Complex* spectrum) const {
    LaneValue* z = work();
    for (int y = 0; y < ny; y += kLanes) {
      const int lanes = std::min(kLanes, ny - y);
      load_rows(real + static_cast<std::ptrdiff_t>(y) * nx, lanes, z);
      row.forward(z, z + row.length() + 1);
      for (int l = 0; l < lanes; ++l)
        store_spectrum(z, l, spectrum + static_cast<std::ptrdiff_t>(y + l) * half);
    }
  }

  void rows_inverse(const Complex* spectrum, double* real) const {
    LaneValue* z = work();
    for (int y = 0; y < ny; y += kLanes) {
      const int lanes = std::min(kLanes, ny - y);
      for (int l = 0; l < lanes; ++l)
        load_spectrum(spectrum + static_cast<std::ptrdiff_t>(y + l) * half, l, z);
      row.forward(z, z + row.length() + 1);
      store_rows(z, lanes, real + static_cast<std::ptrdiff_t>(y) * nx);
    }
  }

  // inverse: by the forward transform of numbers with both parts exchanged.
  void columns(Complex* spectrum, bool inverse) const {
    LaneValue* z = work();
    for (int x = 0; x < half; x += kLanes) {
      const int lanes = std::min(kLanes, half - x);
      for (int y = 0; y < ny; ++y) {
        const Complex* from = spectrum + static_cast<std::ptrdiff_t>(y) * half + x;
        for (int l = 0; l < lanes; ++l) {
          z[y].re[l] = inverse ? from[l].imag() : from[l].real();
          z[y].im[l] = inverse ? from[l].real() : from[l].imag();
        }
      }
      column.forward(z, z + ny);
      for (int y = 0; y < ny; ++y) {
        Complex* to = spectrum + static_cast<std::ptrdiff_t>(y) * half + x;
        for (int l = 0; l < lanes; ++l)
          to[l] = inverse ? Complex(z[y].im[l], z[y].re[l]) : Complex(z[y].re[l], z[y].im[l]);
      }
    }
  }

  void load_rows(const double* real, int lanes, LaneValue* z) const {
    for (int l = 0; l < lanes; ++l) {
      const double* from = real + static_cast<std::ptrdiff_t>(l) * nx;
      for (int k = 0; k < row.length(); ++k)
        put(z[k], l, halved(nx) ? Complex(from[2 * k], from[2 * k + 1]) : Complex(from[k], 0));
    }
  }

  // X_k = E + w^k O, of Z = E + i O: the even and the odd numbers of the row.
  void store_spectrum(const LaneValue* z, int l, Complex* to) const {
    if (!halved(nx)) {
      for (int k = 0; k < half; ++k) to[k] = at(z[k], l);
      return;
    }
    const int h = row.length();
    for (int k = 0; k < half; ++k) {
      const Complex a = at(z[k % h], l), b = std::conj(at(z[(h - k) % h], l));
      const Complex even = 0.5 * (a + b), odd = Complex(0, -0.5) * (a - b);
      to[k] = even + times(twist[static_cast<std::size_t>(k)], odd);
    }
  }

  // The other way, with both parts exchanged: the transform that follows is the inverse.
  void load_spectrum(const Complex* from, int l, LaneValue* z) const {
    const auto exchanged = [](Complex v) { return Complex(v.imag(), v.real()); };
    if (!halved(nx)) {
      put(z[0], l, Complex(0, from[0].real()));
      for (int k = 1; k < half; ++k) {
        put(z[k], l, exchanged(from[k]));
        put(z[nx - k], l, exchanged(std::conj(from[k])));
      }
      return;
    }
    const int h = row.length();
    for (int k = 0; k < h; ++k) {
      Complex a = from[k], b = std::conj(from[h - k]);
      if (k == 0) a = a.real(), b = b.real();  // of a real row
      const Complex odd = times(std::conj(twist[static_cast<std::size_t>(k)]), a - b);
      put(z[k], l, exchanged(a + b + Complex(-odd.imag(), odd.real())));
    }
  }

  void store_rows(const LaneValue* z, int lanes, double* real) const {
    for (int l = 0; l < lanes; ++l) {
      double* to = real + static_cast<std::ptrdiff_t>(l) * nx;
      for (int k = 0; k < row.length(); ++k) {
        if (halved(nx)) {
          to[2 * k] = z[k].im[l];
          to[2 * k + 1] = z[k].re[l];
        } else {
          to[k] = z[k].im[l];
        }
      }
    }
  }

  // Without the checks for infinities that the operator has.
  static Complex times(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
  }

  int nx, ny, half;
  LaneFft row, column;
  std::vector<Complex> twist;  // exp(-2 pi i k / nx)
};

Fft2d::Fft2d(int nx, int ny) : nx_(nx), ny_(ny), plans_(new Plans(nx, ny)) {}

Fft2d::~Fft2d() = default;

void Fft2d::forward(const double* real, std::complex<double>* spectrum) const {
  plans_->rows_forward(real, spectrum);
  plans_->columns(spectrum, false);
}

void Fft2d::inverse(std::complex<double>* spectrum, double* real) const {
  plans_->columns(spectrum, true);
  plans_->rows_inverse(spectrum, real);
}

}  // namespace papilla::base
