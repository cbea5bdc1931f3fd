// Light contact: the few pixels that may touch as one small dense problem with an exact active set.
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/contact/active_set.h"
#include "physics/contact/solvers.h"

namespace papilla {
namespace {

class CandidateSolver {
 public:
  CandidateSolver(const StandardProblem& problem, double tolerance, StandardState& state)
      : problem_(problem),
        grid_(problem.kernel.grid()),
        n_(grid_.size()),
        // One factorisation of this many pixels costs about one transform pair.
        limit_(static_cast<std::size_t>(std::cbrt(100.0 * static_cast<double>(n_)))),
        tolerance_(tolerance),
        state_(state),
        set_(problem.kernel) {}

  bool run(const ContactSolution* start, bool demand) {
    if (start ? !choose_near(*start, demand) : !choose_cold(demand)) return false;
    state_.p.assign(n_, 0.0);
    state_.w.resize(n_);
    SpectrumArray scratch(problem_.kernel.scratch_size());
    for (int round = 0; round < 6; ++round) {
      if (!set_.balance(problem_.load, 1e-13 * problem_.spread, limit_)) return false;
      for (int i : under_pressure_) state_.p[i] = 0;
      under_pressure_.clear();
      for (std::size_t k = 0; k < set_.size(); ++k) {
        if (!set_.touches(k)) continue;
        state_.p[set_.pixel(k)] = set_.pressure(k);
        under_pressure_.push_back(set_.pixel(k));
      }
      problem_.kernel.displace(state_.p, state_.w, scratch);
      ++state_.pairs;
      ++state_.iterations;
      const std::vector<int> penetrating = inspect();
      if (state_.certificate <= tolerance_) {
        state_.certified = true;
        return true;
      }
      if (penetrating.empty() || penetrating.size() > limit_ || !extend(penetrating)) return false;
    }
    return false;
  }

 private:
  // First watch set: the lowest gaps, four times the contact that Persson's and Bush's theories
  // expect, 2 p / (E* rms slope).
  bool choose_cold(bool demand) {
    double slopes = 0;
    const int last = grid_.nx - 1;
    for (int iy = 0; iy < grid_.ny; ++iy) {
      const double* row = problem_.g0.data() + grid_.index(0, iy);
      const double* next = problem_.g0.data() + grid_.index(0, iy + 1 < grid_.ny ? iy + 1 : 0);
      double along = 0, across = 0;
#pragma omp simd reduction(+ : along, across)
      for (int ix = 0; ix < last; ++ix) {
        along += (row[ix + 1] - row[ix]) * (row[ix + 1] - row[ix]);
        across += (next[ix] - row[ix]) * (next[ix] - row[ix]);
      }
      slopes += along / (grid_.dx() * grid_.dx()) + across / (grid_.dy() * grid_.dy());
    }
    const double slope = std::sqrt(slopes / static_cast<double>(n_));
    const double expected = 2 * problem_.load / (problem_.kernel.contact_modulus() * slope);
    return choose(problem_.g0, 4 * expected, demand, {});
  }

  bool choose_near(const ContactSolution& start, bool demand) {
    double load = 0, contact = 0;
    const std::vector<double>& p = start.pressure;
#pragma omp simd reduction(+ : load, contact)
    for (std::size_t i = 0; i < p.size(); ++i) {
      load += p[i];
      contact += p[i] > 0 ? 1.0 : 0.0;
    }
    return choose(start.gap, 3 * contact * std::max(1.0, problem_.load / load), demand,
                  start.pressure);
  }

  // The lowest `wanted` values of score, found from a sample, as watch set; touching at first:
  // those under pressure, or half of them.
  bool choose(std::span<const double> score, double wanted, bool demand,
              std::span<const double> pressure) {
    if (!(wanted <= 2 * static_cast<double>(limit_))) {
      if (!demand) return false;
      wanted = 2 * static_cast<double>(limit_);
    }
    const std::size_t count = std::max<std::size_t>(16, static_cast<std::size_t>(wanted));
    const std::size_t stride = std::max<std::size_t>(1, n_ / 8192) | 1;
    std::vector<double> sample;
    for (std::size_t i = 0; i < n_; i += stride) sample.push_back(score[i]);
    const std::size_t rank = std::min(sample.size() - 1, 2 * count / stride + 12);
    std::nth_element(sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(rank),
                     sample.end());
    const double below = sample[rank];
    std::vector<std::pair<double, int>> low;
    constexpr std::size_t kBlock = 64;
    for (std::size_t begin = 0; begin < n_; begin += kBlock) {
      const std::size_t end = std::min(begin + kBlock, n_);
      double found = 0;
#pragma omp simd reduction(+ : found)
      for (std::size_t i = begin; i < end; ++i) found += score[i] <= below ? 1.0 : 0.0;
      if (found == 0) continue;
      for (std::size_t i = begin; i < end; ++i) {
        if (score[i] <= below) low.emplace_back(score[i], static_cast<int>(i));
      }
    }
    if (low.size() > count) {
      std::nth_element(low.begin(), low.begin() + static_cast<std::ptrdiff_t>(count), low.end());
      low.resize(count);
    }
    std::sort(low.begin(), low.end());
    std::vector<std::pair<int, bool>> members;
    for (std::size_t k = 0; k < low.size(); ++k) {
      const int i = low[k].second;
      members.emplace_back(i, pressure.empty() ? 2 * k <= low.size() : pressure[i] > 0);
    }
    watch(members);
    return true;
  }

  void watch(std::vector<std::pair<int, bool>>& members) {
    set_.watch(members, [this](int i) { return problem_.g0[i]; });
  }

  // Pixels that penetrate and their neighbours join the watch set.
  bool extend(const std::vector<int>& penetrating) {
    std::vector<std::pair<int, bool>> members;
    for (std::size_t k = 0; k < set_.size(); ++k) {
      members.emplace_back(set_.pixel(k), set_.touches(k));
    }
    for (int i : penetrating) {
      const int ix = i % grid_.nx, iy = i / grid_.nx;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const std::size_t j = grid_.index(wrap(ix + dx, grid_.nx), wrap(iy + dy, grid_.ny));
          members.emplace_back(static_cast<int>(j), dx == 0 && dy == 0);
        }
      }
    }
    watch(members);
    return set_.size() <= 12 * limit_;
  }

  // Gap function from the displacement, certificate (Eq. contact.4), pixels that penetrate.
  std::vector<int> inspect() {
    const double shift = set_.shift();
    double low = kInfinity;
    std::vector<int> penetrating;
    constexpr std::size_t kBlock = 64;
    for (std::size_t begin = 0; begin < n_; begin += kBlock) {
      const std::size_t end = std::min(begin + kBlock, n_);
      double lowest = kInfinity;
#pragma omp simd reduction(min : lowest)
      for (std::size_t i = begin; i < end; ++i) {
        const double w = state_.w[i] + problem_.g0[i];
        state_.w[i] = w;
        lowest = lowest < w ? lowest : w;
      }
      low = std::min(low, lowest);
      if (lowest >= shift) continue;
      for (std::size_t i = begin; i < end; ++i) {
        if (state_.w[i] < shift && state_.p[i] == 0) penetrating.push_back(static_cast<int>(i));
      }
    }
    double work = 0;
    for (int i : under_pressure_) work += state_.p[i] * state_.w[i];
    state_.shift = shift;
    state_.certificate =
        std::max(0.0, work - low * problem_.load) / (problem_.load * problem_.spread);
    return penetrating;
  }

  const StandardProblem& problem_;
  const Grid& grid_;
  std::size_t n_, limit_;
  double tolerance_;
  StandardState& state_;
  ActiveSet set_;
  std::vector<int> under_pressure_;  // pixels
};

}  // namespace

bool solve_sparse(const StandardProblem& problem, double tolerance, const ContactSolution* start,
                  bool demand, StandardState& state) {
  return CandidateSolver(problem, tolerance, state).run(start, demand);
}

}  // namespace papilla
