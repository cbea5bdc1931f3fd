// Readings against the members of a belief, one after the other: what each member leaves of them,
// whitened. A reading that is yet to be made is added in the same way. Eq. lab.2-5
#pragma once

#include <functional>
#include <vector>

#include "base/rooms.h"
#include "lab/ensemble.h"
#include "lab/noise.h"

namespace papilla::lab {

// The Cholesky factor of a covariance that grows by a row at a time.
class GrowingFactor {
 public:
  // of: the covariance of the new one with each before it, and last its own variance.
  void add(const std::vector<double>& of);
  std::size_t size() const { return rows_.size(); }
  // The last row: the factors of those before it, and its own.
  const std::vector<double>& row(std::size_t i) const { return rows_[i]; }
  // The inverse of the factor times a vector.
  std::vector<double> solved(std::vector<double> right) const;

 private:
  std::vector<std::vector<double>> rows_;
};

// What belief expects of a reading that is yet to be made, after those that were: the logarithm of
// its friction [N], normal about what each member expects. Eq. lab.2
struct ExpectedReading {
  std::vector<double> means, weights;  // of the members
  double deviation = 0;  // common to them: kernels, skins and what the instrument scatters by

  // p: above 0, below 1
  double quantile(double p) const;
};

class Evidence {
 public:
  // Both outlive this.
  Evidence(const Ensemble& ensemble, const Kernels& kernels, const Instrument& instrument);

  // y: logarithm of the friction. Cost: readings x members. Eq. lab.2
  void add(const Observation& reading, double y);
  // One that is yet to be made. If member t is true, its residual at member m is
  // z + ahead(m) - ahead(t), z standard normal; returned as the residuals of a reading of 0.
  const std::vector<double>& add_ahead(const Observation& reading);
  ExpectedReading expected(const Observation& reading) const;

  std::size_t size() const { return observations_.size(); }
  const std::vector<Observation>& observations() const { return observations_; }
  // [member] of a reading, whitened: independent and of variance 1 at the true one.
  const std::vector<double>& residuals(std::size_t reading) const { return residuals_[reading]; }
  // How the worth of a design within a kernel follows the whitened residual of a reading. Eq. lab.5
  double gain(std::size_t design, std::size_t reading) const { return gains_[reading][design]; }

  // Of each member, up to a constant of all: of the readings that were made. Eq. lab.4
  std::vector<double> log_likelihoods() const;
  // The weights of the members after the readings. Eq. lab.4
  std::vector<double> weights() const;
  // The factor of all readings' covariance: for what is added to some of them.
  const GrowingFactor& factor() const { return factor_; }

 private:
  void add(const Observation& reading, double y, bool made);

  const Ensemble& ensemble_;
  const Kernels& kernels_;
  const Instrument& instrument_;
  std::vector<Observation> observations_;
  std::vector<bool> made_;
  GrowingFactor factor_;
  std::vector<std::vector<double>> residuals_, gains_;
};

// What is thought of the worth of designs after the readings: members that stand for their kernels,
// some draws each, all of them equally probable within a member. Eq. lab.5
struct WorthAfter {
  std::vector<double> weights;             // of the draws
  std::vector<std::vector<double>> worth;  // [design][draw]
  std::vector<std::size_t> member;         // of each draw
};
WorthAfter worth_after(const Ensemble& ensemble, const Kernels& kernels, const Evidence& evidence);

}  // namespace papilla::lab
