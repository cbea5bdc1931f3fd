#include "base/convolution.h"

#include <cmath>
#include <map>
#include <mutex>
#include <type_traits>
#include <utility>

#include "base/check.h"
#include "base/constants.h"

namespace papilla {
namespace {

// As many numbers as a vector register holds: compilers split longer vectors through memory.
#if defined(__AVX512F__)
constexpr int kLanes = 8;
#elif defined(__AVX__)
constexpr int kLanes = 4;
#else
constexpr int kLanes = 2;
#endif
using Vector = double __attribute__((vector_size(kLanes * sizeof(double))));
// A complex number per lane; an array of them is a transform of kLanes lanes side by side.
struct Complex {
  Vector re, im;
};

Complex operator+(const Complex& a, const Complex& b) { return {a.re + b.re, a.im + b.im}; }
Complex operator-(const Complex& a, const Complex& b) { return {a.re - b.re, a.im - b.im}; }
Complex times(const Complex& a, const double* w) {
  return {a.re * w[0] - a.im * w[1], a.re * w[1] + a.im * w[0]};
}
Complex times_conjugate(const Complex& a, const double* w) {
  return {a.re * w[0] + a.im * w[1], a.im * w[0] - a.re * w[1]};
}
Complex times_i(const Complex& a) { return {-a.im, a.re}; }

// P numbers as the sums of a transform of length P, and back; unscaled. For odd P by the sums and
// differences of the numbers at k and P - k.
template <int P>
struct Roots {
  double cosine[P], sine[P];  // of 2 pi k/P
  Roots() {
    for (int k = 0; k < P; ++k) {
      cosine[k] = std::cos(2 * kPi * k / P);
      sine[k] = std::sin(2 * kPi * k / P);
    }
  }
};
template <int P>
const Roots<P> kRoots;
template <int P, int kSign>
void odd_transform(Complex (&a)[P]) {
  constexpr int kPairs = P / 2;
  Complex sum[kPairs], difference[kPairs];
  const Complex first = a[0];
  for (int k = 0; k < kPairs; ++k) {
    sum[k] = a[k + 1] + a[P - 1 - k];
    difference[k] = times_i(a[k + 1] - a[P - 1 - k]);
    a[0] = a[0] + sum[k];
  }
  for (int m = 1; m <= kPairs; ++m) {
    Complex even = first, odd{};
    for (int k = 0; k < kPairs; ++k) {
      const double c = kRoots<P>.cosine[m * (k + 1) % P],
                   s = kSign * kRoots<P>.sine[m * (k + 1) % P];
      even.re += c * sum[k].re;
      even.im += c * sum[k].im;
      odd.re += s * difference[k].re;
      odd.im += s * difference[k].im;
    }
    a[m] = even + odd;
    a[P - m] = even - odd;
  }
}
template <int P>
void split(Complex (&a)[P]) {
  odd_transform<P, -1>(a);
}
template <int P>
void join(Complex (&a)[P]) {
  odd_transform<P, 1>(a);
}
template <>
void split<4>(Complex (&a)[4]) {
  const Complex s0 = a[0] + a[2], d0 = a[0] - a[2], s1 = a[1] + a[3], d1 = times_i(a[1] - a[3]);
  a[0] = s0 + s1;
  a[1] = d0 - d1;
  a[2] = s0 - s1;
  a[3] = d0 + d1;
}
template <>
void join<4>(Complex (&a)[4]) {
  const Complex s0 = a[0] + a[2], d0 = a[0] - a[2], s1 = a[1] + a[3], d1 = times_i(a[1] - a[3]);
  a[0] = s0 + s1;
  a[1] = d0 + d1;
  a[2] = s0 - s1;
  a[3] = d0 - d1;
}

// Decimation in frequency: a stage of P works on blocks of `length` and leaves P blocks of a P-th
// of it, turned by the powers of its root of one. In place, from what load gives.
template <int P, class Load>
void forward_stage(const Load& load, Complex* z, int n, int length, const double* twiddle) {
  const int part = length / P;
  for (int block = 0; block < n; block += length) {
    const double* w = twiddle;
    for (int j = block; j < block + part; ++j, w += 2 * (P - 1)) {
      Complex a[P];
      for (int k = 0; k < P; ++k) a[k] = load(j + k * part);
      split(a);
      z[j] = a[0];
      for (int k = 1; k < P; ++k) z[j + k * part] = times(a[k], w + 2 * k - 2);
    }
  }
}
// The same undone; the results go to store.
template <int P, class Store>
void inverse_stage(Complex* z, int n, int length, const double* twiddle, const Store& store) {
  const int part = length / P;
  for (int block = 0; block < n; block += length) {
    const double* w = twiddle;
    for (int j = block; j < block + part; ++j, w += 2 * (P - 1)) {
      Complex a[P];
      a[0] = z[j];
      for (int k = 1; k < P; ++k) a[k] = times_conjugate(z[j + k * part], w + 2 * k - 2);
      join(a);
      for (int k = 0; k < P; ++k) store(j + k * part, a[k]);
    }
  }
}

template <class Stage>
void with_radix(int radix, const Stage& stage) {
  switch (radix) {
    case 3:
      return stage(std::integral_constant<int, 3>());
    case 5:
      return stage(std::integral_constant<int, 5>());
    case 7:
      return stage(std::integral_constant<int, 7>());
    case 11:
      return stage(std::integral_constant<int, 11>());
    case 13:
      return stage(std::integral_constant<int, 13>());
    default:
      return stage(std::integral_constant<int, 4>());
  }
}

// All stages but the last, which has no twiddles and is finish_forward(), or part of what is done
// to the spectrum. The first stage reads what load gives.
template <class Load>
void forward(const Load& load, Complex* z, int n, const std::vector<int>& radices,
             const double* twiddle) {
  int length = n;
  for (std::size_t i = 0; i + 1 < radices.size(); ++i) {
    with_radix(radices[i], [&](auto radix) {
      if (i == 0) {
        forward_stage<radix>(load, z, n, length, twiddle);
      } else {
        forward_stage<radix>([&](int at) { return z[at]; }, z, n, length, twiddle);
      }
      length /= radix;
      twiddle += 2 * (radix - 1) * length;
    });
  }
}

void halves(Complex* p) {
  const Complex a = p[0], b = p[1];
  p[0] = a + b;
  p[1] = a - b;
}

void finish_forward(Complex* z, int n, int last) {
  if (last == 2) {
    for (Complex* p = z; p < z + n; p += 2) halves(p);
    return;
  }
  for (Complex* p = z; p < z + n; p += 4) {
    Complex a[4] = {p[0], p[1], p[2], p[3]};
    split(a);
    for (int k = 0; k < 4; ++k) p[k] = a[k];
  }
}

// The steps of the forward transform undone in the opposite order; the last hands its results to
// store.
void start_inverse(Complex* z, int n, int last) {
  if (last == 2) {
    for (Complex* p = z; p < z + n; p += 2) halves(p);
    return;
  }
  for (Complex* p = z; p < z + n; p += 4) {
    Complex a[4] = {p[0], p[1], p[2], p[3]};
    join(a);
    for (int k = 0; k < 4; ++k) p[k] = a[k];
  }
}

template <class Store>
void inverse(Complex* z, int n, const std::vector<int>& radices, const double* twiddle_end,
             const Store& store) {
  const double* twiddle = twiddle_end;
  int length = radices.back();
  for (std::size_t i = radices.size() - 1; i-- > 0;) {
    with_radix(radices[i], [&](auto radix) {
      twiddle -= 2 * (radix - 1) * length;
      length *= radix;
      if (i == 0) {
        inverse_stage<radix>(z, n, length, twiddle, store);
      } else {
        inverse_stage<radix>(z, n, length, twiddle,
                             [&](int at, const Complex& value) { z[at] = value; });
      }
    });
  }
}

// End of the forward transform, multiplication by real factors, begin of the inverse one.
void scale_spectrum(Complex* z, int n, int last, const Vector* factor) {
  if (last == 2) {
    for (int i = 0; i < n; i += 2) {
      halves(z + i);
      for (int k = i; k < i + 2; ++k) z[k] = {z[k].re * factor[k], z[k].im * factor[k]};
      halves(z + i);
    }
    return;
  }
  for (int i = 0; i < n; i += 4) {
    Complex a[4] = {z[i], z[i + 1], z[i + 2], z[i + 3]};
    split(a);
    for (int k = 0; k < 4; ++k) a[k] = {a[k].re * factor[i + k], a[k].im * factor[i + k]};
    join(a);
    for (int k = 0; k < 4; ++k) z[i + k] = a[k];
  }
}

// Vectors as the columns of as many others.
void transpose(const Vector (&a)[kLanes], Vector (&t)[kLanes]) {
#if defined(__AVX512F__)
  Vector b[kLanes], c[kLanes];
  for (int i = 0; i < kLanes; i += 2) {
    b[i] = __builtin_shufflevector(a[i], a[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    b[i + 1] = __builtin_shufflevector(a[i], a[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int i = 0; i < kLanes; i += 4) {
    for (int j = 0; j < 2; ++j) {
      c[i + j] = __builtin_shufflevector(b[i + j], b[i + j + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      c[i + j + 2] = __builtin_shufflevector(b[i + j], b[i + j + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int j = 0; j < 4; ++j) {
    t[j] = __builtin_shufflevector(c[j], c[j + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    t[j + 4] = __builtin_shufflevector(c[j], c[j + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
#elif defined(__AVX__)
  Vector b[kLanes];
  for (int i = 0; i < kLanes; i += 2) {
    b[i] = __builtin_shufflevector(a[i], a[i + 1], 0, 4, 2, 6);
    b[i + 1] = __builtin_shufflevector(a[i], a[i + 1], 1, 5, 3, 7);
  }
  for (int j = 0; j < 2; ++j) {
    t[j] = __builtin_shufflevector(b[j], b[j + 2], 0, 1, 4, 5);
    t[j + 2] = __builtin_shufflevector(b[j], b[j + 2], 2, 3, 6, 7);
  }
#else
  t[0] = __builtin_shufflevector(a[0], a[1], 0, 2);
  t[1] = __builtin_shufflevector(a[0], a[1], 1, 3);
#endif
}

// A block of frequencies of 2 kLanes real columns, from the transform of their strip: the columns
// of the real parts, then those of the imaginary parts, lanes: ky.
inline void take_apart(const Complex* strip, const int* slot, int ny, int block, Complex* to) {
  Vector a_re[kLanes], a_im[kLanes], b_re[kLanes], b_im[kLanes], t[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const int ky = block * kLanes + lane;
    if (ky == 0) {
      const Complex low = strip[0], high = strip[slot[ny / 2]];
      a_re[0] = low.re;
      a_im[0] = high.re;
      b_re[0] = low.im;
      b_im[0] = high.im;
      continue;
    }
    const Complex z = strip[slot[ky]], y = strip[slot[ny - ky]];
    a_re[lane] = z.re + y.re;
    a_im[lane] = z.im - y.im;
    b_re[lane] = z.im + y.im;
    b_im[lane] = y.re - z.re;
  }
  transpose(a_re, t);
  for (int x = 0; x < kLanes; ++x) to[x].re = t[x];
  transpose(a_im, t);
  for (int x = 0; x < kLanes; ++x) to[x].im = t[x];
  transpose(b_re, t);
  for (int x = 0; x < kLanes; ++x) to[kLanes + x].re = t[x];
  transpose(b_im, t);
  for (int x = 0; x < kLanes; ++x) to[kLanes + x].im = t[x];
}

// The same undone.
inline void put_together(const Complex* from, const int* slot, int ny, int block, Complex* strip) {
  Vector a_re[kLanes], a_im[kLanes], b_re[kLanes], b_im[kLanes], t[kLanes];
  for (int x = 0; x < kLanes; ++x) t[x] = from[x].re;
  transpose(t, a_re);
  for (int x = 0; x < kLanes; ++x) t[x] = from[x].im;
  transpose(t, a_im);
  for (int x = 0; x < kLanes; ++x) t[x] = from[kLanes + x].re;
  transpose(t, b_re);
  for (int x = 0; x < kLanes; ++x) t[x] = from[kLanes + x].im;
  transpose(t, b_im);
  for (int lane = 0; lane < kLanes; ++lane) {
    const int ky = block * kLanes + lane;
    if (ky == 0) {
      strip[0] = {a_re[0], b_re[0]};
      strip[slot[ny / 2]] = {a_im[0], b_im[0]};
      continue;
    }
    strip[slot[ky]] = {a_re[lane] - b_im[lane], a_im[lane] + b_re[lane]};
    strip[slot[ny - ky]] = {a_re[lane] + b_im[lane], b_re[lane] - a_im[lane]};
  }
}

// The block whose first lane holds two rows, ky = 0 and ny/2: they come apart by a share of the
// conjugate at -kx.
inline void scale_first_block(Complex* z, const int* slot, int nx, const Vector* factor,
                              const double* difference) {
  for (int kx = 0; kx <= nx / 2; ++kx) {
    const int i = slot[kx], j = slot[(nx - kx) % nx];
    const double i_re = z[i].re[0], i_im = z[i].im[0], j_re = z[j].re[0], j_im = z[j].im[0];
    const double d = difference[i], mean = factor[i][0];  // equal at i and j
    z[i].re = z[i].re * factor[i];
    z[i].im = z[i].im * factor[i];
    z[i].re[0] = mean * i_re + d * j_re;
    z[i].im[0] = mean * i_im - d * j_im;
    if (i == j) continue;
    z[j].re = z[j].re * factor[j];
    z[j].im = z[j].im * factor[j];
    z[j].re[0] = mean * j_re + d * i_re;
    z[j].im[0] = mean * j_im - d * i_im;
  }
}

}  // namespace

Convolution::Butterflies::Butterflies(int length) : n(length), slot(length) {
  int rest = n;
  for (int p : {3, 5, 7, 11, 13}) {
    for (; rest % p == 0; rest /= p) radices.push_back(p);
  }
  for (; rest % 4 == 0; rest /= 4) radices.push_back(4);
  if (rest == 2) radices.push_back(2);
  int l = n;
  for (std::size_t i = 0; i + 1 < radices.size(); l /= radices[i++]) {
    for (int j = 0; j < l / radices[i]; ++j) {
      for (int power = 1; power < radices[i]; ++power) {
        twiddle.push_back(std::cos(2 * kPi * j * power / l));
        twiddle.push_back(-std::sin(2 * kPi * j * power / l));
      }
    }
  }
  for (int s = 0; s < n; ++s) {
    int frequency = 0, step = 1, at = s, part = n;
    for (int radix : radices) {
      part /= radix;
      frequency += step * (at / part);
      at %= part;
      step *= radix;
    }
    slot[frequency] = s;
  }
}

bool Convolution::suits(int nx, int ny) {
  const auto good = [](int n) {
    if (n < 32 || n % 16 != 0) return false;
    for (int p : {2, 3, 5, 7, 11, 13}) {
      while (n % p == 0) n /= p;
    }
    return n == 1;
  };
  return good(nx) && good(ny);
}

Convolution::Convolution(int nx, int ny) : nx_(nx), ny_(ny), along_x_(nx), along_y_(ny) {
  PAPILLA_CHECK(suits(nx, ny), "multiples of 16 with small factors");
}

std::shared_ptr<const Convolution> Convolution::shared(int nx, int ny) {
  static std::mutex mutex;
  static std::map<std::pair<int, int>, std::shared_ptr<const Convolution>> made;
  std::lock_guard lock(mutex);
  auto& one = made[{nx, ny}];
  if (!one) one = std::make_shared<const Convolution>(nx, ny);
  return one;
}

// Blocks of kLanes ky from 0 to ny/2 - 1, in each the slots of kx, at each kLanes values, halved
// (see apply). The first lane holds ky = 0 and ny/2 at once, as real and imaginary part in x: the
// mean of their values there, half their difference after all blocks.
RealArray Convolution::arrange(std::span<const double> symbol) const {
  const int half = nx_ / 2 + 1, blocks = ny_ / 2 / kLanes;
  const auto value = [&](int kx, int ky) {
    return symbol[static_cast<std::size_t>(ky) * half + (kx < half ? kx : nx_ - kx)];
  };
  RealArray out(static_cast<std::size_t>(nx_) * (ny_ / 2 + 1));
  for (int kx = 0; kx < nx_; ++kx) {
    const int slot = along_x_.slot[kx];
    for (int block = 0; block < blocks; ++block) {
      for (int lane = 0; lane < kLanes; ++lane) {
        out[(static_cast<std::size_t>(block) * nx_ + slot) * kLanes + lane] =
            0.5 * value(kx, block * kLanes + lane);
      }
    }
    const double low = value(kx, 0), high = value(kx, ny_ / 2);
    out[static_cast<std::size_t>(slot) * kLanes] = 0.5 * (low + high);
    out[static_cast<std::size_t>(nx_) * (ny_ / 2) + slot] = 0.5 * (low - high);
  }
  return out;
}

void Convolution::apply(const double* in, const RealArray& symbol, std::complex<double>* scratch,
                        double* out) const {
  transform_columns(in, scratch);
  multiply_rows(symbol, scratch);
  restore_columns(scratch, out);
}

// The scratch holds the spectrum, [block of ky][x] with lanes of ky, and after it one strip of
// columns, [y] with lanes of x. Along y 2 kLanes columns go together, as the real and imaginary
// parts of kLanes, told apart by the symmetry of a real column's transform, without the half in it.
void Convolution::transform_columns(const double* in, std::complex<double>* scratch) const {
  const int blocks = ny_ / 2 / kLanes, strips = nx_ / (2 * kLanes);
  auto* spectrum = reinterpret_cast<Complex*>(scratch);
  Complex* strip = spectrum + static_cast<std::size_t>(blocks) * nx_;
  const std::size_t row = static_cast<std::size_t>(nx_) / kLanes;
  for (int s = 0; s < strips; ++s) {
    const auto* column = reinterpret_cast<const Vector*>(in) + 2 * s;
    forward(
        [&](int y) {
          const Vector* at = column + static_cast<std::size_t>(y) * row;
          return Complex{at[0], at[1]};
        },
        strip, ny_, along_y_.radices, along_y_.twiddle.data());
    finish_forward(strip, ny_, along_y_.radices.back());
    for (int block = 0; block < blocks; ++block) {
      take_apart(strip, along_y_.slot.data(), ny_, block,
                 spectrum + static_cast<std::size_t>(block) * nx_ + 2 * kLanes * s);
    }
  }
}

// Along x, the symbol, and back.
void Convolution::multiply_rows(const RealArray& symbol, std::complex<double>* scratch) const {
  const int blocks = ny_ / 2 / kLanes, last = along_x_.radices.back();
  const double* difference = symbol.data() + static_cast<std::size_t>(nx_) * (ny_ / 2);
  for (int block = 0; block < blocks; ++block) {
    Complex* z = reinterpret_cast<Complex*>(scratch) + static_cast<std::size_t>(block) * nx_;
    forward([&](int x) { return z[x]; }, z, nx_, along_x_.radices, along_x_.twiddle.data());
    const auto* factor =
        reinterpret_cast<const Vector*>(symbol.data()) + static_cast<std::size_t>(block) * nx_;
    if (block > 0) {
      scale_spectrum(z, nx_, last, factor);
    } else {
      finish_forward(z, nx_, last);
      scale_first_block(z, along_x_.slot.data(), nx_, factor, difference);
      start_inverse(z, nx_, last);
    }
    inverse(z, nx_, along_x_.radices, along_x_.twiddle.data() + along_x_.twiddle.size(),
            [&](int x, const Complex& value) { z[x] = value; });
  }
}

// Back along y.
void Convolution::restore_columns(std::complex<double>* scratch, double* out) const {
  const int blocks = ny_ / 2 / kLanes, strips = nx_ / (2 * kLanes);
  auto* spectrum = reinterpret_cast<Complex*>(scratch);
  Complex* strip = spectrum + static_cast<std::size_t>(blocks) * nx_;
  const std::size_t row = static_cast<std::size_t>(nx_) / kLanes;
  for (int s = 0; s < strips; ++s) {
    for (int block = 0; block < blocks; ++block) {
      put_together(spectrum + static_cast<std::size_t>(block) * nx_ + 2 * kLanes * s,
                   along_y_.slot.data(), ny_, block, strip);
    }
    start_inverse(strip, ny_, along_y_.radices.back());
    auto* column = reinterpret_cast<Vector*>(out) + 2 * s;
    inverse(strip, ny_, along_y_.radices, along_y_.twiddle.data() + along_y_.twiddle.size(),
            [&](int y, const Complex& value) {
              Vector* at = column + static_cast<std::size_t>(y) * row;
              at[0] = value.re;
              at[1] = value.im;
            });
  }
}

}  // namespace papilla
