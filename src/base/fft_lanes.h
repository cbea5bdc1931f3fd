// One-dimensional Fourier transforms of several sequences at once: the transform of builds without
// FFTW.
#pragma once

#include <memory>
#include <vector>

#include "base/rooms.h"

namespace papilla::base {

inline constexpr int kLanes = 8;  // sequences that go side by side through the processor

// One number of each sequence: GCC and Clang compute with it as with one number.
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

// kLanes complex numbers, one of each sequence.
struct LaneValue {
  Lanes re, im;
};

// X_k = sum_j x_j exp(-2 pi i j k / n), unnormalised, of kLanes sequences of length n. Lengths of
// factors up to kLargestFactor by a self-sorting (Stockham) decomposition into them; others by
// Bluestein's convolution with a power of two. The same bytes every run. O(n log n).
class LaneFft {
 public:
  explicit LaneFft(int n);
  ~LaneFft();
  LaneFft(const LaneFft&) = delete;
  LaneFft& operator=(const LaneFft&) = delete;

  int length() const { return n_; }
  // In place; `scratch` has scratch_length() values.
  void forward(LaneValue* x, LaneValue* scratch) const;
  int scratch_length() const;

 private:
  struct Stage {
    int radix = 1, rest = 1, stride = 1;  // n = radix * rest * stride
    std::vector<double> twiddle;          // cos and sin of exp(-2 pi i p j / (radix rest)), [p][j]
    std::vector<double> root;             // of the radix itself, [j]
  };
  struct Bluestein;

  void make_stages();
  static void run(const Stage& stage, const LaneValue* in, LaneValue* out);
  // kRadix: of the stage; 0: any. turn: its transform of one group.
  template <int kRadix, class Butterfly>
  static void run(const Stage& stage, const LaneValue* in, LaneValue* out, Butterfly turn);

  int n_;
  std::vector<Stage> stages_;
  std::unique_ptr<Bluestein> bluestein_;  // null: factors are small
};

}  // namespace papilla::base
