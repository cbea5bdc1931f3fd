#include "physics/contact/active_set.h"

#include <algorithm>

#include "numerics/reductions.h"

namespace papilla::contact {

void ActiveSet::sort(std::vector<std::pair<int, bool>>& members) {
  std::sort(members.begin(), members.end());
  pixel_.clear();
  touching_.clear();
  for (const auto& [i, touches] : members) {
    if (!pixel_.empty() && pixel_.back() == i) {
      touching_.back() = touching_.back() || touches;
      continue;
    }
    pixel_.push_back(i);
    touching_.push_back(touches);
  }
  pressure_.assign(pixel_.size(), 0);
  x_.clear();
  y_.clear();
  for (int i : pixel_) {
    x_.push_back(i % kernel_.grid().nx);
    y_.push_back(i / kernel_.grid().nx);
  }
}

double ActiveSet::influence(int x, int y, std::size_t k) const {
  const int dx = x - x_[k], dy = y - y_[k];
  return kernel_.influence(dx < 0 ? dx + kernel_.grid().nx : dx,
                           dy < 0 ? dy + kernel_.grid().ny : dy);
}

std::size_t ActiveSet::find(int pixel) const {
  const auto at = std::lower_bound(pixel_.begin(), pixel_.end(), pixel);
  return at != pixel_.end() && *at == pixel ? static_cast<std::size_t>(at - pixel_.begin())
                                            : pixel_.size();
}

double ActiveSet::gap(std::size_t k) const {
  double v = gap_[k] - shift_;
  for (std::size_t j : set_) v += influence(x_[k], y_[k], j) * pressure_[j];
  return v;
}

bool ActiveSet::balance(double load, double slack, std::size_t limit) {
  for (int pass = 0; pass < 40; ++pass) {
    set_.clear();
    for (std::size_t k = 0; k < pixel_.size(); ++k) {
      if (touching_[k]) set_.push_back(k);
    }
    const std::size_t m = set_.size();
    if (m == 0 || m > limit) return false;
    matrix_.resize(m * m);
    a_.resize(m);
    b_.assign(m, 1.0);
    for (std::size_t r = 0; r < m; ++r) {
      a_[r] = -gap_[set_[r]];
      for (std::size_t c = 0; c <= r; ++c) {
        matrix_[c * m + r] = influence(x_[set_[r]], y_[set_[r]], set_[c]);
      }
    }
    if (!cholesky_.factorise(matrix_, m)) return false;
    cholesky_.solve(a_);
    cholesky_.solve(b_);
    shift_ = (load - sum(a_)) / sum(b_);
    bool changed = false;
    for (std::size_t r = 0; r < m; ++r) {
      const double p = a_[r] + shift_ * b_[r];
      pressure_[set_[r]] = p;
      if (p <= 0) {
        pressure_[set_[r]] = 0;
        touching_[set_[r]] = false;
        changed = true;
      }
    }
    std::size_t next = 0;
    for (std::size_t k = 0; k < pixel_.size(); ++k) {
      if (next < m && set_[next] == k) {
        ++next;
      } else if (gap(k) < -slack) {
        touching_[k] = true;
        changed = true;
      }
    }
    if (!changed) return true;
  }
  return false;
}

}  // namespace papilla::contact
