// Periodic convolution of a real field with a real, even kernel, much cheaper than its transforms
// apart: as many columns or rows side by side as a register holds numbers, spectra left in the
// order in which the butterflies make them.
#pragma once

#include <complex>
#include <memory>
#include <span>
#include <vector>

#include "base/rooms.h"
#include "numerics/arrays.h"

namespace papilla::numerics {

// Real: double, or float where six digits of a field are enough (half the time).
template <class Real>
class BasicConvolution {
 public:
  // Sizes that it is made for: multiples of 128 bytes' numbers (16 doubles, 32 floats) from 32 on
  // without prime factors above 13, the same on every machine. Others go through Fft2d.
  static bool suits(int nx, int ny);
  BasicConvolution(int nx, int ny);
  // By size, each made once and kept; thread safe.
  static std::shared_ptr<const BasicConvolution> shared(int nx, int ny);

  // The kernel's transform as apply() wants it, from that on the half spectrum of Fft2d: value
  // (kx, ky) at ky * (nx/2 + 1) + kx, real and equal at (kx, ky) and (kx, -ky).
  AlignedArray<Real> arrange(std::span<const double> symbol) const;

  // out = inverse(arranged symbol * forward(in)), unnormalised as in Fft2d. in may be out; both
  // 64-byte aligned fields of nx ny values, scratch of scratch_size(). O(n log n).
  void apply(const Real* in, const AlignedArray<Real>& symbol, std::complex<Real>* scratch,
             Real* out) const;
  std::size_t scratch_size() const {
    return static_cast<std::size_t>(ny_) *
           (static_cast<std::size_t>(nx_ / 2) + kMostBytes / sizeof(Real));
  }

 private:
  static constexpr std::size_t kMostBytes = 64;  // of a register
  // Complex transform in stages: frequency k of the result is at slot[k].
  struct Butterflies {
    explicit Butterflies(int n);
    int n;
    std::vector<int> radices;   // of the stages: odd primes, then fours, a two where one is left
    std::vector<Real> twiddle;  // w^j, w^2j, ... of each stage but the last
    std::vector<int> slot;
  };

  void transform_columns(const Real* in, std::complex<Real>* scratch) const;
  void multiply_rows(const AlignedArray<Real>& symbol, std::complex<Real>* scratch) const;
  void restore_columns(std::complex<Real>* scratch, Real* out) const;

  int nx_, ny_;
  Butterflies along_x_, along_y_;
};

extern template class BasicConvolution<double>;
extern template class BasicConvolution<float>;
using Convolution = BasicConvolution<double>;

}  // namespace papilla::numerics
