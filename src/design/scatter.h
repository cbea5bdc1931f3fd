// How fabrication misses the numbers of a design, and plates drawn so.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::design {

// How far fabrication misses a number of the design.
struct Scatter {
  enum class Kind { Uniform, Normal };
  std::string path;
  double tolerance = 0;  // SI; half the width of a uniform one, the standard deviation of a normal
  Kind kind = Kind::Uniform;

  // Where it is evaluated, either side of the nominal number [SI]: both kinds then have a variance
  // of a third of its square.
  double end() const;
  bool operator==(const Scatter&) const = default;
};

// Pearson's correlation of two of them.
struct ScatterCorrelation {
  std::string first, second;  // paths
  double value = 0;

  bool operator==(const ScatterCorrelation&) const = default;
};

// The distribution of all of them together: a Gaussian copula with the correlations asked for. Eq.
// search.19
class ScatterLaw {
 public:
  ScatterLaw() = default;  // nothing scatters
  // Throws InputError for correlations that no distribution has together, and for paths that do not
  // scatter.
  ScatterLaw(const std::vector<Scatter>& scatter,
             const std::vector<ScatterCorrelation>& correlations);

  std::size_t size() const { return kinds_.size(); }
  bool correlated() const { return !factor_.empty(); }
  // Of the square of a number's deviation in units of its end.
  double variance_of_square(std::size_t number) const;
  // Deviations of all numbers of a plate from the nominal ones, in units of their ends: the i-th of
  // a low-discrepancy sequence.
  std::vector<double> plate(std::uint64_t seed, std::uint64_t i) const;

 private:
  std::vector<Scatter::Kind> kinds_;
  std::vector<std::vector<double>> factor_;  // of the copula's correlations, lower triangle
};

}  // namespace papilla::design
