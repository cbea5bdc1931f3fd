#include "design/scatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.h"
#include "base/error.h"
#include "numerics/statistics.h"
#include "optim/problem.h"

namespace papilla::design {
namespace {

using Kind = Scatter::Kind;
using Matrix = std::vector<std::vector<double>>;

// Of the normal numbers behind two scatters, so that these have the correlation asked for. Eq.
// search.19
double behind(double correlation, Kind a, Kind b) {
  if (a != b) return correlation * std::sqrt(std::numbers::pi / 3);
  return a == Kind::Normal ? correlation : 2 * std::sin(std::numbers::pi / 6 * correlation);
}

std::size_t place_of(const std::vector<Scatter>& scatter, const std::string& path) {
  const auto found = std::find_if(scatter.begin(), scatter.end(),
                                  [&](const Scatter& s) { return s.path == path; });
  if (found == scatter.end())
    throw InputError(
        fmt::format("scatter.correlation: {} has no tolerance under [scatter]; give it one", path));
  return static_cast<std::size_t>(found - scatter.begin());
}

// Cholesky's lower triangle.
Matrix factor_of(Matrix m) {
  constexpr double kSingular = 1e-9;  // beside variances of 1
  for (std::size_t i = 0; i < m.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = m[i][j];
      for (std::size_t k = 0; k < j; ++k) rest -= m[i][k] * m[j][k];
      if (i == j && !(rest > kSingular))
        throw InputError(
            "scatter.correlation: no plates have all of these correlations together; bring them "
            "nearer to 0");
      m[i][j] = i == j ? std::sqrt(rest) : rest / m[j][j];
    }
  }
  return m;
}

}  // namespace

double Scatter::end() const {
  return kind == Kind::Normal ? std::sqrt(3.0) * tolerance : tolerance;
}

ScatterLaw::ScatterLaw(const std::vector<Scatter>& scatter,
                       const std::vector<ScatterCorrelation>& correlations) {
  for (const Scatter& s : scatter) kinds_.push_back(s.kind);
  if (correlations.empty()) return;
  Matrix all(size(), std::vector<double>(size(), 0));
  for (std::size_t k = 0; k < size(); ++k) all[k][k] = 1;
  for (const ScatterCorrelation& c : correlations) {
    const std::size_t a = place_of(scatter, c.first), b = place_of(scatter, c.second);
    if (a == b)
      throw InputError("scatter.correlation: " + c.first +
                       " stands twice in `between`; name two numbers");
    all[a][b] = all[b][a] = behind(c.value, kinds_[a], kinds_[b]);
  }
  factor_ = factor_of(std::move(all));
}

double ScatterLaw::variance_of_square(std::size_t number) const {
  return kinds_[number] == Kind::Normal ? 2.0 / 9 : 4.0 / 45;
}

std::vector<double> ScatterLaw::plate(std::uint64_t seed, std::uint64_t i) const {
  constexpr double kLeast = 1e-12;  // of a probability whose normal number is finite
  std::vector<double> out = optim::low_discrepancy(size(), seed, i);
  if (correlated()) {
    std::vector<double> normal;
    for (const double p : out) normal.push_back(normal_quantile(std::clamp(p, kLeast, 1 - kLeast)));
    for (std::size_t k = 0; k < out.size(); ++k) {
      double z = 0;
      for (std::size_t j = 0; j <= k; ++j) z += factor_[k][j] * normal[j];
      out[k] = normal_cdf(z);
    }
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double p = std::clamp(out[k], kLeast, 1 - kLeast);
    out[k] = kinds_[k] == Kind::Normal ? normal_quantile(p) / std::sqrt(3.0) : 2 * out[k] - 1;
  }
  return out;
}

}  // namespace papilla::design
