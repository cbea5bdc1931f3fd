#include "lab/ensemble.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "base/constants.h"
#include "optim/posterior.h"

namespace papilla::lab {
namespace {

using Rows = std::vector<std::vector<double>>;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Deviations from the mean of each member's hypothesis.
std::vector<double> deviations(const Ensemble& e, const std::vector<double>& row) {
  std::vector<double> sum(e.hypotheses.size(), 0), weight(e.hypotheses.size(), 0);
  for (std::size_t m = 0; m < row.size(); ++m) {
    sum[e.hypothesis[m]] += e.weights[m] * row[m];
    weight[e.hypothesis[m]] += e.weights[m];
  }
  std::vector<double> out;
  for (std::size_t m = 0; m < row.size(); ++m)
    out.push_back(row[m] - sum[e.hypothesis[m]] / weight[e.hypothesis[m]]);
  return out;
}

Rows deviations(const Ensemble& e, const Rows& rows) {
  Rows out;
  for (const std::vector<double>& row : rows) out.push_back(deviations(e, row));
  return out;
}

Rows rooted(const Ensemble& e, Rows rows) {
  for (std::vector<double>& row : rows) {
    for (std::size_t m = 0; m < row.size(); ++m) row[m] *= std::sqrt(e.weights[m]);
  }
  return rows;
}

Rows drawn_in(const Rows& rows, const Rows& deviations, double shrink) {
  Rows out = rows;
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t m = 0; m < out[i].size(); ++m) out[i][m] -= (1 - shrink) * deviations[i][m];
  }
  return out;
}

// Independent directions that the responses vary in: (trace)^2 / trace of the square.
double dimensions(const Rows& moves) {
  if (moves.empty()) return 1;
  double trace = 0, squares = 0;
  // By the members, as there are fewer of them than rows.
  const std::size_t members = moves.front().size();
  std::vector<double> gram(members * members, 0);
  for (const std::vector<double>& row : moves) {
    for (std::size_t a = 0; a < members; ++a) {
      for (std::size_t b = 0; b <= a; ++b) gram[a * members + b] += row[a] * row[b];
    }
  }
  for (std::size_t a = 0; a < members; ++a) {
    trace += gram[a * members + a];
    for (std::size_t b = 0; b <= a; ++b)
      squares += (a == b ? 1 : 2) * square(gram[a * members + b]);
  }
  return squares > 0 ? square(trace) / squares : 1;
}

// [of a][of b]; share: of the moves that is a kernel's own.
Rows covariances(const Rows& a_moves, const std::vector<Sampling>& a, const Rows& b_moves,
                 const std::vector<Sampling>& b, double share) {
  Rows out(a.size(), std::vector<double>(b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j)
      out[i][j] = share * dot(a_moves[i], b_moves[j]) + covariance(a[i], b[j]);
  }
  return out;
}

}  // namespace

double covariance(const Sampling& a, const Sampling& b) {
  const bool common = a.skins == b.skins && a.deviations.size() == b.deviations.size();
  return common ? dot(a.deviations, b.deviations) : 0;
}

std::vector<double> weights_by_hypothesis(const Ensemble& e, const std::vector<double>& weights) {
  std::vector<double> out(e.hypotheses.size(), 0);
  for (std::size_t m = 0; m < weights.size(); ++m) out[e.hypothesis[m]] += weights[m];
  return out;
}

Kernels kernels_of(const Ensemble& e) {
  PAPILLA_CHECK(!e.weights.empty() && e.hypothesis.size() == e.weights.size(), "members");
  PAPILLA_CHECK(
      e.response_sampling.size() == e.responses.size() && e.worth_sampling.size() == e.worth.size(),
      "what skins leave open of every number");
  const Rows responses = deviations(e, e.responses), worth = deviations(e, e.worth);
  Kernels out;
  out.response_moves = rooted(e, responses);
  out.worth_moves = rooted(e, worth);
  // Silverman 1986, Eq. 4.14, of the effective number of members.
  const double d = dimensions(out.response_moves);
  const double width = std::pow(4 / ((d + 2) * effective_number(e.weights)), 1 / (d + 4));
  out.width = std::min(width, 1.0);
  out.shrink = std::sqrt(1 - square(out.width));  // Eq. lab.3 (West 1993)
  out.responses = drawn_in(e.responses, responses, out.shrink);
  out.worth = drawn_in(e.worth, worth, out.shrink);
  const double share = square(out.width);
  out.of_responses = covariances(out.response_moves, e.response_sampling, out.response_moves,
                                 e.response_sampling, share);
  out.of_worth_and_responses = covariances(out.worth_moves, e.worth_sampling, out.response_moves,
                                           e.response_sampling, share);
  out.of_worth =
      covariances(out.worth_moves, e.worth_sampling, out.worth_moves, e.worth_sampling, share);
  return out;
}

}  // namespace papilla::lab
