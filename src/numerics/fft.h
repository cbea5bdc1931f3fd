// Real two-dimensional FFT of a periodic row-major field (x fastest), and wave numbers.
#pragma once

#include <complex>
#include <memory>

#include "base/rooms.h"
#include "numerics/arrays.h"

namespace papilla::numerics {

// Plans for one size: made once (the same bytes every run), executable from many threads at a time.
// Unnormalised both ways: inverse(forward(x)) = nx ny x. By FFTW.
class Fft2d {
 public:
  Fft2d(int nx, int ny);
  ~Fft2d();
  Fft2d(const Fft2d&) = delete;
  Fft2d& operator=(const Fft2d&) = delete;

  int half() const { return nx_ / 2 + 1; }  // spectrum columns kept (the rest is conjugate)
  std::size_t real_size() const { return static_cast<std::size_t>(nx_) * ny_; }
  std::size_t spectrum_size() const { return static_cast<std::size_t>(half()) * ny_; }

  // Arrays must be 64-byte aligned (RealArray, SpectrumArray). O(n log n).
  void forward(const double* real, std::complex<double>* spectrum) const;
  void inverse(std::complex<double>* spectrum /* destroyed */, double* real) const;

  // Shared plans by size (thread safe).
  static std::shared_ptr<const Fft2d> shared(int nx, int ny);

 private:
  struct Plans;
  int nx_, ny_;
  std::unique_ptr<Plans> plans_;
};

// Signed integer mode of index i in a transform of length n: 0, 1, ..., -1.
constexpr int signed_mode(int i, int n) { return i <= n / 2 ? i : i - n; }

}  // namespace papilla::numerics
