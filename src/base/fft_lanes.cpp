#include "base/fft_lanes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace papilla::base {
namespace {

constexpr int kLargestFactor = 31;

// 4 first: the fewest operations.
std::vector<int> factors_of(int n) {
  std::vector<int> out;
  for (int p : {4, 2, 3, 5}) {
    while (n % p == 0) {
      out.push_back(p);
      n /= p;
    }
  }
  for (int p = 7; p <= kLargestFactor; p += 2) {
    while (n % p == 0) {
      out.push_back(p);
      n /= p;
    }
  }
  if (n > 1) out.push_back(n);  // larger than kLargestFactor
  return out;
}

// exp(-2 pi i k / n)
std::pair<double, double> root(long long k, long long n) {
  const double angle = -2 * kPi * static_cast<double>(k % n) / static_cast<double>(n);
  return {std::cos(angle), std::sin(angle)};
}

inline LaneValue operator+(const LaneValue& a, const LaneValue& b) {
  return {a.re + b.re, a.im + b.im};
}
inline LaneValue operator-(const LaneValue& a, const LaneValue& b) {
  return {a.re - b.re, a.im - b.im};
}
inline LaneValue operator*(double s, const LaneValue& a) { return {s * a.re, s * a.im}; }
// -i a
inline LaneValue turned(const LaneValue& a) { return {a.im, -a.re}; }
inline LaneValue times(const LaneValue& a, double re, double im) {
  return {a.re * re - a.im * im, a.re * im + a.im * re};
}

inline void butterfly2(const LaneValue* x, LaneValue* y) {
  y[0] = x[0] + x[1];
  y[1] = x[0] - x[1];
}
inline void butterfly3(const LaneValue* x, LaneValue* y) {
  constexpr double kSin = 0.86602540378443864676;  // of 60 deg
  const LaneValue sum = x[1] + x[2], turn = kSin * turned(x[1] - x[2]);
  const LaneValue middle = x[0] - 0.5 * sum;
  y[0] = x[0] + sum;
  y[1] = middle + turn;
  y[2] = middle - turn;
}
inline void butterfly4(const LaneValue* x, LaneValue* y) {
  const LaneValue a = x[0] + x[2], b = x[0] - x[2], c = x[1] + x[3], d = turned(x[1] - x[3]);
  y[0] = a + c;
  y[1] = b + d;
  y[2] = a - c;
  y[3] = b - d;
}
inline void butterfly5(const LaneValue* x, LaneValue* y) {
  constexpr double kCos1 = 0.30901699437494742410, kCos2 = -0.80901699437494742410;
  constexpr double kSin1 = 0.95105651629515357212, kSin2 = 0.58778525229247312917;
  const LaneValue a = x[1] + x[4], b = x[2] + x[3], c = turned(x[1] - x[4]),
                  d = turned(x[2] - x[3]);
  const LaneValue e = x[0] + kCos1 * a + kCos2 * b, f = x[0] + kCos2 * a + kCos1 * b;
  const LaneValue g = kSin1 * c + kSin2 * d, h = kSin2 * c - kSin1 * d;
  y[0] = x[0] + a + b;
  y[1] = e + g;
  y[2] = f + h;
  y[3] = f - h;
  y[4] = e - g;
}
void butterfly(int radix, const std::vector<double>& roots, const LaneValue* x, LaneValue* y) {
  for (int j = 0; j < radix; ++j) {
    LaneValue sum = x[0];
    for (int k = 1; k < radix; ++k) {
      const auto at = static_cast<std::size_t>(2 * (j * k % radix));
      sum = sum + times(x[k], roots[at], roots[at + 1]);
    }
    y[j] = sum;
  }
}

}  // namespace

// x_k w_k convolved with conj w, w_k = exp(-pi i k^2 / n).
struct LaneFft::Bluestein {
  explicit Bluestein(int n) : length(power_above(2 * n - 1)), inner(length) {
    for (long long k = 0; k < n; ++k) {
      const auto [re, im] = root(k * k % (2LL * n), 2LL * n);
      chirp.push_back(re);
      chirp.push_back(im);
    }
    kernel.resize(static_cast<std::size_t>(length));
    for (int k = 0; k < n; ++k) {
      for (int at : {k, (length - k) % length}) {
        const auto from = static_cast<std::size_t>(2 * k);
        kernel[static_cast<std::size_t>(at)] = {Lanes{} + chirp[from], Lanes{} - chirp[from + 1]};
      }
    }
    std::vector<LaneValue> scratch(static_cast<std::size_t>(inner.scratch_length()));
    inner.forward(kernel.data(), scratch.data());
  }
  static int power_above(int least) {
    int n = 1;
    while (n < least) n *= 2;
    return n;
  }

  int length;
  LaneFft inner;
  std::vector<double> chirp;
  std::vector<LaneValue> kernel;  // transformed; alike in all lanes
};

LaneFft::LaneFft(int n) : n_(n) {
  const std::vector<int> factors = factors_of(n);
  if (!factors.empty() && factors.back() > kLargestFactor) {
    bluestein_ = std::make_unique<Bluestein>(n);
  } else {
    make_stages();
  }
}

LaneFft::~LaneFft() = default;

void LaneFft::make_stages() {
  int length = n_, stride = 1;
  for (int radix : factors_of(n_)) {
    Stage stage;
    stage.radix = radix;
    stage.rest = length / radix;
    stage.stride = stride;
    for (int p = 0; p < stage.rest; ++p) {
      for (int j = 0; j < radix; ++j) {
        const auto [re, im] = root(static_cast<long long>(p) * j, length);
        stage.twiddle.push_back(re);
        stage.twiddle.push_back(im);
      }
    }
    for (int j = 0; j < radix; ++j) {
      const auto [re, im] = root(j, radix);
      stage.root.push_back(re);
      stage.root.push_back(im);
    }
    stages_.push_back(std::move(stage));
    length /= radix;
    stride *= radix;
  }
}

template <int kRadix, class Butterfly>
void LaneFft::run(const Stage& stage, const LaneValue* in, LaneValue* out, Butterfly turn) {
  const int radix = kRadix > 0 ? kRadix : stage.radix, rest = stage.rest, stride = stage.stride;
  LaneValue x[kRadix > 0 ? kRadix : kLargestFactor], y[kRadix > 0 ? kRadix : kLargestFactor];
  for (int p = 0; p < rest; ++p) {
    const double* w = stage.twiddle.data() + static_cast<std::ptrdiff_t>(2) * p * radix;
    for (int q = 0; q < stride; ++q) {
      for (int k = 0; k < radix; ++k) x[k] = in[q + stride * (p + rest * k)];
      turn(x, y);
      LaneValue* to = out + q + static_cast<std::ptrdiff_t>(stride) * radix * p;
      to[0] = y[0];
      for (int j = 1; j < radix; ++j)
        to[static_cast<std::ptrdiff_t>(stride) * j] = times(y[j], w[2 * j], w[2 * j + 1]);
    }
  }
}

void LaneFft::run(const Stage& stage, const LaneValue* in, LaneValue* out) {
  switch (stage.radix) {
    case 2:
      return run<2>(stage, in, out, [](const LaneValue* x, LaneValue* y) { butterfly2(x, y); });
    case 3:
      return run<3>(stage, in, out, [](const LaneValue* x, LaneValue* y) { butterfly3(x, y); });
    case 4:
      return run<4>(stage, in, out, [](const LaneValue* x, LaneValue* y) { butterfly4(x, y); });
    case 5:
      return run<5>(stage, in, out, [](const LaneValue* x, LaneValue* y) { butterfly5(x, y); });
    default:
      return run<0>(stage, in, out, [&](const LaneValue* x, LaneValue* y) {
        butterfly(stage.radix, stage.root, x, y);
      });
  }
}

int LaneFft::scratch_length() const {
  return bluestein_ ? bluestein_->length + bluestein_->inner.scratch_length() : n_;
}

void LaneFft::forward(LaneValue* x, LaneValue* scratch) const {
  if (!bluestein_) {
    LaneValue *from = x, *to = scratch;
    for (const Stage& stage : stages_) {
      run(stage, from, to);
      std::swap(from, to);
    }
    if (from != x) std::copy(from, from + n_, x);
    return;
  }
  const Bluestein& b = *bluestein_;
  LaneValue *z = scratch, *more = scratch + b.length;
  const auto chirped = [&](const LaneValue& value, int k) {
    const auto at = static_cast<std::size_t>(2 * k);
    return times(value, b.chirp[at], b.chirp[at + 1]);
  };
  for (int k = 0; k < n_; ++k) z[k] = chirped(x[k], k);
  std::fill(z + n_, z + b.length, LaneValue{});
  b.inner.forward(z, more);
  // The product, conjugated: the forward transform of it is the conjugated inverse.
  for (int k = 0; k < b.length; ++k) {
    const LaneValue& h = b.kernel[static_cast<std::size_t>(k)];
    z[k] = times(z[k], h.re[0], h.im[0]);
    z[k].im = -z[k].im;
  }
  b.inner.forward(z, more);
  for (int k = 0; k < n_; ++k) {
    const LaneValue value = (1.0 / b.length) * z[k];
    x[k] = chirped({value.re, -value.im}, k);
  }
}

}  // namespace papilla::base
