#include "lab/discrepancy.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "optim/posterior.h"

namespace papilla::lab {
namespace {

// Of the chance before the readings that the model is wrong somewhere, shared by the places.
constexpr double kSomewhere = 0.5;

// A shift of some readings under each member: what it adds to the logarithm of the likelihood, and
// the shift itself.
struct Shifted {
  std::vector<double> log_likelihood, shift;
  double variance = 0;
};

Shifted shifted(const Evidence& evidence, const Somewhere& place, double size,
                std::size_t members) {
  std::vector<double> where(evidence.size(), 0);
  for (const std::size_t k : place.readings) where[k] = 1;
  where = evidence.factor().solved(std::move(where));
  double norm = 0;
  for (const double x : where) norm += square(x);
  Shifted out;
  out.variance = square(size) / (1 + square(size) * norm);
  for (std::size_t m = 0; m < members; ++m) {
    double along = 0;
    for (std::size_t k = 0; k < where.size(); ++k) along += where[k] * evidence.residuals(k)[m];
    out.shift.push_back(out.variance * along);
    out.log_likelihood.push_back(out.variance * square(along) / 2 -
                                 std::log1p(square(size) * norm) / 2);
  }
  return out;  // Eq. lab.10
}

double misfit(const Ensemble& ensemble, const Evidence& evidence) {
  if (evidence.size() == 0) return 0;
  const std::vector<double> weights = evidence.weights();
  double sum = 0;
  for (std::size_t m = 0; m < ensemble.members(); ++m) {
    for (std::size_t k = 0; k < evidence.size(); ++k)
      sum += weights[m] * square(evidence.residuals(k)[m]);
  }
  return sum / static_cast<double>(evidence.size());
}

}  // namespace

double Discrepancy::change() const { return std::expm1(shift); }
double Discrepancy::change_deviation() const { return std::exp(shift) * deviation; }

Discrepancies discrepancies(const Ensemble& ensemble, const Evidence& evidence,
                            const std::vector<Somewhere>& places, double size) {
  Discrepancies out;
  out.misfit = misfit(ensemble, evidence);
  if (places.empty() || evidence.size() == 0) return out;
  std::vector<double> logs = evidence.log_likelihoods(), evidences;
  for (std::size_t m = 0; m < logs.size(); ++m) logs[m] += std::log(ensemble.weights[m]);
  evidences.push_back(log_sum(logs) + std::log(1 - kSomewhere));
  for (const Somewhere& place : places) {
    const Shifted there = shifted(evidence, place, size, ensemble.members());
    std::vector<double> with = logs;
    for (std::size_t m = 0; m < with.size(); ++m) with[m] += there.log_likelihood[m];
    evidences.push_back(log_sum(with) + std::log(kSomewhere / static_cast<double>(places.size())));
    const std::vector<double> weights = normalised(with);
    Discrepancy d{place.name, 0, 0, 0};
    double squares = 0;
    for (std::size_t m = 0; m < weights.size(); ++m) {
      d.shift += weights[m] * there.shift[m];
      squares += weights[m] * square(there.shift[m]);
    }
    d.deviation = std::sqrt(there.variance + std::max(0.0, squares - square(d.shift)));
    out.found.push_back(std::move(d));
  }
  const std::vector<double> p = normalised(evidences);
  out.none = p.front();
  for (std::size_t i = 0; i < out.found.size(); ++i) out.found[i].probability = p[i + 1];
  std::stable_sort(out.found.begin(), out.found.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return out;
}

}  // namespace papilla::lab
