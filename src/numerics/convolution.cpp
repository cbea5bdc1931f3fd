#include "numerics/convolution.h"

#include <cmath>
#include <map>
#include <mutex>
#include <type_traits>
#include <utility>

#include "base/check.h"
#include "base/constants.h"
#include "numerics/vector.h"

namespace papilla::numerics {
namespace {

// A register's: compilers split longer vectors through memory, and no number here depends on how
// many stand side by side.
template <class Real>
constexpr int kLanes = kRegisterBytes / sizeof(Real);
template <class Real>
using Side = typename Packed<Real, kLanes<Real>>::Type;
// A complex number per lane; an array of them is a transform of kLanes lanes side by side.
template <class Real>
struct Complex {
  Side<Real> re, im;
};

template <class Real>
Complex<Real> operator+(const Complex<Real>& a, const Complex<Real>& b) {
  return {a.re + b.re, a.im + b.im};
}
template <class Real>
Complex<Real> operator-(const Complex<Real>& a, const Complex<Real>& b) {
  return {a.re - b.re, a.im - b.im};
}
template <class Real>
Complex<Real> times(const Complex<Real>& a, const Real* w) {
  return {a.re * w[0] - a.im * w[1], a.re * w[1] + a.im * w[0]};
}
template <class Real>
Complex<Real> times_conjugate(const Complex<Real>& a, const Real* w) {
  return {a.re * w[0] + a.im * w[1], a.im * w[0] - a.re * w[1]};
}
template <class Real>
Complex<Real> times_i(const Complex<Real>& a) {
  return {-a.im, a.re};
}

// P numbers as the sums of a transform of length P, and back; unscaled. For odd P by the sums and
// differences of the numbers at k and P - k.
template <class Real, int P>
struct Roots {
  Real cosine[P], sine[P];  // of 2 pi k/P
  Roots() {
    for (int k = 0; k < P; ++k) {
      cosine[k] = static_cast<Real>(std::cos(2 * kPi * k / P));
      sine[k] = static_cast<Real>(std::sin(2 * kPi * k / P));
    }
  }
};
template <class Real, int P>
const Roots<Real, P> kRoots;
template <int kSign, class Real, int P>
void odd_transform(Complex<Real> (&a)[P]) {
  constexpr int kPairs = P / 2;
  Complex<Real> sum[kPairs], difference[kPairs];
  const Complex<Real> first = a[0];
  for (int k = 0; k < kPairs; ++k) {
    sum[k] = a[k + 1] + a[P - 1 - k];
    difference[k] = times_i(a[k + 1] - a[P - 1 - k]);
    a[0] = a[0] + sum[k];
  }
  for (int m = 1; m <= kPairs; ++m) {
    Complex<Real> even = first, odd{};
    for (int k = 0; k < kPairs; ++k) {
      const Real c = kRoots<Real, P>.cosine[m * (k + 1) % P],
                 s = kSign * kRoots<Real, P>.sine[m * (k + 1) % P];
      even.re += c * sum[k].re;
      even.im += c * sum[k].im;
      odd.re += s * difference[k].re;
      odd.im += s * difference[k].im;
    }
    a[m] = even + odd;
    a[P - m] = even - odd;
  }
}
template <int kSign, class Real>
void four_transform(Complex<Real> (&a)[4]) {
  const Complex<Real> s0 = a[0] + a[2], d0 = a[0] - a[2], s1 = a[1] + a[3];
  const Complex<Real> d1 = times_i(kSign > 0 ? a[1] - a[3] : a[3] - a[1]);
  a[0] = s0 + s1;
  a[1] = d0 + d1;
  a[2] = s0 - s1;
  a[3] = d0 - d1;
}
template <int kSign, class Real, int P>
void transform(Complex<Real> (&a)[P]) {
  if constexpr (P == 4) {
    four_transform<kSign>(a);
  } else {
    odd_transform<kSign>(a);
  }
}
template <class Real, int P>
void split(Complex<Real> (&a)[P]) {
  transform<-1>(a);
}
template <class Real, int P>
void join(Complex<Real> (&a)[P]) {
  transform<1>(a);
}

// Decimation in frequency: a stage of P works on blocks of `length` and leaves P blocks of a P-th
// of it, turned by the powers of its root of one. In place, from what load gives.
template <int P, class Load, class Real>
void forward_stage(const Load& load, Complex<Real>* z, int n, int length, const Real* twiddle) {
  const int part = length / P;
  for (int block = 0; block < n; block += length) {
    const Real* w = twiddle;
    for (int j = block; j < block + part; ++j, w += 2 * (P - 1)) {
      Complex<Real> a[P];
      for (int k = 0; k < P; ++k) a[k] = load(j + k * part);
      split(a);
      z[j] = a[0];
      for (int k = 1; k < P; ++k) z[j + k * part] = times(a[k], w + 2 * k - 2);
    }
  }
}
// The same undone; the results go to store.
template <int P, class Store, class Real>
void inverse_stage(Complex<Real>* z, int n, int length, const Real* twiddle, const Store& store) {
  const int part = length / P;
  for (int block = 0; block < n; block += length) {
    const Real* w = twiddle;
    for (int j = block; j < block + part; ++j, w += 2 * (P - 1)) {
      Complex<Real> a[P];
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
template <class Load, class Real>
void forward(const Load& load, Complex<Real>* z, int n, const std::vector<int>& radices,
             const Real* twiddle) {
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

template <class Real>
void halves(Complex<Real>* p) {
  const Complex<Real> a = p[0], b = p[1];
  p[0] = a + b;
  p[1] = a - b;
}

template <class Real>
void finish_forward(Complex<Real>* z, int n, int last) {
  if (last == 2) {
    for (Complex<Real>* p = z; p < z + n; p += 2) halves(p);
    return;
  }
  for (Complex<Real>* p = z; p < z + n; p += 4) {
    Complex<Real> a[4] = {p[0], p[1], p[2], p[3]};
    split(a);
    for (int k = 0; k < 4; ++k) p[k] = a[k];
  }
}

// The steps of the forward transform undone in the opposite order; the last hands its results to
// store.
template <class Real>
void start_inverse(Complex<Real>* z, int n, int last) {
  if (last == 2) {
    for (Complex<Real>* p = z; p < z + n; p += 2) halves(p);
    return;
  }
  for (Complex<Real>* p = z; p < z + n; p += 4) {
    Complex<Real> a[4] = {p[0], p[1], p[2], p[3]};
    join(a);
    for (int k = 0; k < 4; ++k) p[k] = a[k];
  }
}

template <class Store, class Real>
void inverse(Complex<Real>* z, int n, const std::vector<int>& radices, const Real* twiddle_end,
             const Store& store) {
  const Real* twiddle = twiddle_end;
  int length = radices.back();
  for (std::size_t i = radices.size() - 1; i-- > 0;) {
    with_radix(radices[i], [&](auto radix) {
      twiddle -= 2 * (radix - 1) * length;
      length *= radix;
      if (i == 0) {
        inverse_stage<radix>(z, n, length, twiddle, store);
      } else {
        inverse_stage<radix>(z, n, length, twiddle,
                             [&](int at, const Complex<Real>& value) { z[at] = value; });
      }
    });
  }
}

// End of the forward transform, multiplication by real factors, begin of the inverse one.
template <class Real>
void scale_spectrum(Complex<Real>* z, int n, int last, const Side<Real>* factor) {
  if (last == 2) {
    for (int i = 0; i < n; i += 2) {
      halves(z + i);
      for (int k = i; k < i + 2; ++k) z[k] = {z[k].re * factor[k], z[k].im * factor[k]};
      halves(z + i);
    }
    return;
  }
  for (int i = 0; i < n; i += 4) {
    Complex<Real> a[4] = {z[i], z[i + 1], z[i + 2], z[i + 3]};
    split(a);
    for (int k = 0; k < 4; ++k) a[k] = {a[k].re * factor[i + k], a[k].im * factor[i + k]};
    join(a);
    for (int k = 0; k < 4; ++k) z[i + k] = a[k];
  }
}

// Of two vectors a square of blocks of kStep lanes, its off-diagonal blocks swapped.
template <int kStep, class V, int... kLane>
void swap_blocks(V& a, V& b, std::integer_sequence<int, kLane...>) {
  constexpr int n = sizeof...(kLane);
  const V low = __builtin_shufflevector(a, b, ((kLane & kStep) ? kLane - kStep + n : kLane)...);
  b = __builtin_shufflevector(a, b, ((kLane & kStep) ? kLane + n : kLane + kStep)...);
  a = low;
}

// Vectors as the columns of as many others.
template <class V, int kCount, int kStep = 1>
inline void transpose(V (&a)[kCount]) {
  if constexpr (kStep < kCount) {
    for (int i = 0; i < kCount; ++i) {
      if ((i & kStep) == 0)
        swap_blocks<kStep>(a[i], a[i + kStep], std::make_integer_sequence<int, kCount>());
    }
    transpose<V, kCount, 2 * kStep>(a);
  }
}

// A block of frequencies of 2 kLanes real columns, from the transform of their strip: the columns
// of the real parts, then those of the imaginary parts, lanes: ky.
template <class Real>
inline void take_apart(const Complex<Real>* strip, const int* slot, int ny, int block,
                       Complex<Real>* to) {
  constexpr int n = kLanes<Real>;
  Side<Real> a_re[n], a_im[n], b_re[n], b_im[n];
  for (int lane = 0; lane < n; ++lane) {
    const int ky = block * n + lane;
    if (ky == 0) {
      const Complex<Real> low = strip[0], high = strip[slot[ny / 2]];
      a_re[0] = low.re;
      a_im[0] = high.re;
      b_re[0] = low.im;
      b_im[0] = high.im;
      continue;
    }
    const Complex<Real> z = strip[slot[ky]], y = strip[slot[ny - ky]];
    a_re[lane] = z.re + y.re;
    a_im[lane] = z.im - y.im;
    b_re[lane] = z.im + y.im;
    b_im[lane] = y.re - z.re;
  }
  transpose(a_re);
  for (int x = 0; x < n; ++x) to[x].re = a_re[x];
  transpose(a_im);
  for (int x = 0; x < n; ++x) to[x].im = a_im[x];
  transpose(b_re);
  for (int x = 0; x < n; ++x) to[n + x].re = b_re[x];
  transpose(b_im);
  for (int x = 0; x < n; ++x) to[n + x].im = b_im[x];
}

// The same undone.
template <class Real>
inline void put_together(const Complex<Real>* from, const int* slot, int ny, int block,
                         Complex<Real>* strip) {
  constexpr int n = kLanes<Real>;
  Side<Real> a_re[n], a_im[n], b_re[n], b_im[n];
  for (int x = 0; x < n; ++x) a_re[x] = from[x].re;
  transpose(a_re);
  for (int x = 0; x < n; ++x) a_im[x] = from[x].im;
  transpose(a_im);
  for (int x = 0; x < n; ++x) b_re[x] = from[n + x].re;
  transpose(b_re);
  for (int x = 0; x < n; ++x) b_im[x] = from[n + x].im;
  transpose(b_im);
  for (int lane = 0; lane < n; ++lane) {
    const int ky = block * n + lane;
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
template <class Real>
inline void scale_first_block(Complex<Real>* z, const int* slot, int nx, const Side<Real>* factor,
                              const Real* difference) {
  for (int kx = 0; kx <= nx / 2; ++kx) {
    const int i = slot[kx], j = slot[(nx - kx) % nx];
    const Real i_re = z[i].re[0], i_im = z[i].im[0], j_re = z[j].re[0], j_im = z[j].im[0];
    const Real d = difference[i], mean = factor[i][0];  // equal at i and j
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

template <class Real>
BasicConvolution<Real>::Butterflies::Butterflies(int length) : n(length), slot(length) {
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
        twiddle.push_back(static_cast<Real>(std::cos(2 * kPi * j * power / l)));
        twiddle.push_back(static_cast<Real>(-std::sin(2 * kPi * j * power / l)));
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

template <class Real>
bool BasicConvolution<Real>::suits(int nx, int ny) {
  const auto good = [](int n) {
    if (n < 32 || n % static_cast<int>(2 * kMostBytes / sizeof(Real)) != 0) return false;
    for (int p : {2, 3, 5, 7, 11, 13}) {
      while (n % p == 0) n /= p;
    }
    return n == 1;
  };
  return good(nx) && good(ny);
}

template <class Real>
BasicConvolution<Real>::BasicConvolution(int nx, int ny)
    : nx_(nx), ny_(ny), along_x_(nx), along_y_(ny) {
  PAPILLA_CHECK(suits(nx, ny), "multiples of two registers with small factors");
}

template <class Real>
std::shared_ptr<const BasicConvolution<Real>> BasicConvolution<Real>::shared(int nx, int ny) {
  static std::mutex mutex;
  static std::map<std::pair<int, int>, std::shared_ptr<const BasicConvolution>> made;
  std::lock_guard lock(mutex);
  auto& one = made[{nx, ny}];
  if (!one) one = std::make_shared<const BasicConvolution>(nx, ny);
  return one;
}

// Blocks of kLanes ky from 0 to ny/2 - 1, in each the slots of kx, at each kLanes values, halved
// (see apply). The first lane holds ky = 0 and ny/2 at once, as real and imaginary part in x: the
// mean of their values there, half their difference after all blocks.
template <class Real>
AlignedArray<Real> BasicConvolution<Real>::arrange(std::span<const double> symbol) const {
  constexpr int n = kLanes<Real>;
  const int half = nx_ / 2 + 1, blocks = ny_ / 2 / n;
  const auto value = [&](int kx, int ky) {
    return symbol[static_cast<std::size_t>(ky) * half + (kx < half ? kx : nx_ - kx)];
  };
  AlignedArray<Real> out(static_cast<std::size_t>(nx_) * (ny_ / 2 + 1));
  for (int kx = 0; kx < nx_; ++kx) {
    const int slot = along_x_.slot[kx];
    for (int block = 0; block < blocks; ++block) {
      for (int lane = 0; lane < n; ++lane) {
        out[(static_cast<std::size_t>(block) * nx_ + slot) * n + lane] =
            static_cast<Real>(0.5 * value(kx, block * n + lane));
      }
    }
    const double low = value(kx, 0), high = value(kx, ny_ / 2);
    out[static_cast<std::size_t>(slot) * n] = static_cast<Real>(0.5 * (low + high));
    out[static_cast<std::size_t>(nx_) * (ny_ / 2) + slot] = static_cast<Real>(0.5 * (low - high));
  }
  return out;
}

template <class Real>
void BasicConvolution<Real>::apply(const Real* in, const AlignedArray<Real>& symbol,
                                   std::complex<Real>* scratch, Real* out) const {
  transform_columns(in, scratch);
  multiply_rows(symbol, scratch);
  restore_columns(scratch, out);
}

// The scratch holds the spectrum, [block of ky][x] with lanes of ky, and after it one strip of
// columns, [y] with lanes of x. Along y 2 kLanes columns go together, as the real and imaginary
// parts of kLanes, told apart by the symmetry of a real column's transform, without the half in it.
template <class Real>
void BasicConvolution<Real>::transform_columns(const Real* in, std::complex<Real>* scratch) const {
  const int blocks = ny_ / 2 / kLanes<Real>, strips = nx_ / (2 * kLanes<Real>);
  auto* spectrum = reinterpret_cast<Complex<Real>*>(scratch);
  Complex<Real>* strip = spectrum + static_cast<std::size_t>(blocks) * nx_;
  const std::size_t row = static_cast<std::size_t>(nx_) / kLanes<Real>;
  for (int s = 0; s < strips; ++s) {
    const auto* column = reinterpret_cast<const Side<Real>*>(in) + 2 * s;
    forward(
        [&](int y) {
          const Side<Real>* at = column + static_cast<std::size_t>(y) * row;
          return Complex<Real>{at[0], at[1]};
        },
        strip, ny_, along_y_.radices, along_y_.twiddle.data());
    finish_forward(strip, ny_, along_y_.radices.back());
    for (int block = 0; block < blocks; ++block) {
      take_apart(strip, along_y_.slot.data(), ny_, block,
                 spectrum + static_cast<std::size_t>(block) * nx_ + 2 * kLanes<Real> * s);
    }
  }
}

// Along x, the symbol, and back.
template <class Real>
void BasicConvolution<Real>::multiply_rows(const AlignedArray<Real>& symbol,
                                           std::complex<Real>* scratch) const {
  const int blocks = ny_ / 2 / kLanes<Real>, last = along_x_.radices.back();
  const Real* difference = symbol.data() + static_cast<std::size_t>(nx_) * (ny_ / 2);
  for (int block = 0; block < blocks; ++block) {
    Complex<Real>* z =
        reinterpret_cast<Complex<Real>*>(scratch) + static_cast<std::size_t>(block) * nx_;
    forward([&](int x) { return z[x]; }, z, nx_, along_x_.radices, along_x_.twiddle.data());
    const auto* factor =
        reinterpret_cast<const Side<Real>*>(symbol.data()) + static_cast<std::size_t>(block) * nx_;
    if (block > 0) {
      scale_spectrum(z, nx_, last, factor);
    } else {
      finish_forward(z, nx_, last);
      scale_first_block(z, along_x_.slot.data(), nx_, factor, difference);
      start_inverse(z, nx_, last);
    }
    inverse(z, nx_, along_x_.radices, along_x_.twiddle.data() + along_x_.twiddle.size(),
            [&](int x, const Complex<Real>& value) { z[x] = value; });
  }
}

// Back along y.
template <class Real>
void BasicConvolution<Real>::restore_columns(std::complex<Real>* scratch, Real* out) const {
  const int blocks = ny_ / 2 / kLanes<Real>, strips = nx_ / (2 * kLanes<Real>);
  auto* spectrum = reinterpret_cast<Complex<Real>*>(scratch);
  Complex<Real>* strip = spectrum + static_cast<std::size_t>(blocks) * nx_;
  const std::size_t row = static_cast<std::size_t>(nx_) / kLanes<Real>;
  for (int s = 0; s < strips; ++s) {
    for (int block = 0; block < blocks; ++block) {
      put_together(spectrum + static_cast<std::size_t>(block) * nx_ + 2 * kLanes<Real> * s,
                   along_y_.slot.data(), ny_, block, strip);
    }
    start_inverse(strip, ny_, along_y_.radices.back());
    auto* column = reinterpret_cast<Side<Real>*>(out) + 2 * s;
    inverse(strip, ny_, along_y_.radices, along_y_.twiddle.data() + along_y_.twiddle.size(),
            [&](int y, const Complex<Real>& value) {
              Side<Real>* at = column + static_cast<std::size_t>(y) * row;
              at[0] = value.re;
              at[1] = value.im;
            });
  }
}

template class BasicConvolution<double>;
template class BasicConvolution<float>;

}  // namespace papilla::numerics
