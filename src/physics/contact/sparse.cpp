// Light contact: the few pixels that may touch as one small dense problem with an exact active set.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/constants.h"
#include "base/watch.h"
#include "numerics/loops.h"
#include "physics/contact/active_set.h"
#include "physics/contact/candidates.h"
#include "physics/contact/cubic.h"
#include "physics/contact/solvers.h"

namespace papilla::contact {
namespace {

// Share of the height spread up to which the field of a small change of pressure is left out far
// away.
constexpr double kBlur = 3e-4;
// Watch sets solved, and transforms among them, before the dense solver is the better way.
constexpr int kMostPasses = 12, kMostTransforms = 6;

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
    if (start) {
      if (!take(watch_near(problem_, *start, {limit_, demand}))) return false;
      state_.p.assign(n_, 0.0);
      if (!predict(*start)) return false;
      displace();
    } else {
      state_.pairs += problem_.rise_unpressed(rise_, scratch_);
      if (!choose_cold(demand)) return false;
      state_.p.assign(n_, 0.0);
    }
    for (int transforms = 0; state_.iterations < kMostPasses; ++state_.iterations) {
      Watch::look();
      // What the pressures' own influence leaves of the gap function at the pixels watched.
      set_.watch(members_, [this](int i) { return gap_function(i) - pressed(i); });
      if (!balance()) return false;
      const double blur = problem_.kernel.influence_beyond() * find_change();
      if (blur > kBlur * problem_.spread) {
        if (++transforms > kMostTransforms) return false;
        take_pressures();
        displace();
        continue;
      }
      displace_closely();
      const std::vector<int> open = inspect(blur);
      if (open.empty()) {
        take_pressures();
        state_.certified = state_.certificate <= tolerance_;
        return state_.certified;
      }
      if (open.size() > limit_) return false;
      for (std::size_t k = 0; k < set_.size(); ++k) rise_[set_.pixel(k)] = before_[k];
      displace_nearby(-1);
      extend(open);
      if (members_.size() > 12 * limit_) return false;
    }
    return false;
  }

 private:
  // change_: pressures found less those taken. Returns the sum of their sizes.
  double find_change() {
    double moved = 0;
    change_.clear();
    for (std::size_t k = 0; k < set_.size(); ++k) {
      const double d = set_.pressure(k) - state_.p[set_.pixel(k)];
      if (d != 0) change_.emplace_back(set_.pixel(k), d);
      moved += std::abs(d);
    }
    return moved;
  }

  // The change is added nearby, and exactly at the pixels watched: so every gap is known to within
  // the blur. before_: what to put back at those.
  void displace_closely() {
    displace_nearby(1);
    before_.resize(set_.size());
    for (std::size_t k = 0; k < set_.size(); ++k) {
      double& rise = rise_[set_.pixel(k)];
      before_[k] = rise;
      rise = -problem_.height[set_.pixel(k)] - (set_.gap(k) + set_.shift());
    }
  }

  // First watch set, from the gaps without pressure.
  bool choose_cold(bool demand) {
    std::vector<double> g0(n_);
    for (std::size_t i = 0; i < n_; ++i) g0[i] = gap_function(i);
    return take(watch_lowest(problem_, g0, {limit_, demand}));
  }
  bool take(std::optional<Watched> members) {
    if (members) members_ = std::move(*members);
    return members.has_value();
  }

  // Pressures of the pixels watched by what half the pixels say of the tractions: with their
  // transform, the exact pressures are a small change away.
  bool predict(const ContactSolution& start) {
    const ContactKernel* coarse = problem_.kernel.coarse();
    const std::span<const double> traction = problem_.traction, height = problem_.height;
    if (traction.empty() || !coarse) {
      if (!traction.empty()) {
        for (const auto& [i, touches] : members_) take(i, start.pressure[i]);
        return true;
      }
      set_.watch(members_, [&](int i) { return -height[i]; });
    } else {
      const Grid& half = coarse->grid();
      RealArray pulled(half.size());
      rise_.reserve(n_);
      for (int iy = 0; iy < half.ny; ++iy) {
        const double* row = traction.data() + grid_.index(0, 2 * iy);
        const double* next = row + grid_.nx;
        rise_.insert(rise_.end(), row, next + grid_.nx);  // for the full transform that follows
        double* to = pulled.data() + half.index(0, iy);
        for (int ix = 0; ix < half.nx; ++ix) {
          to[ix] = 0.25 * (row[2 * ix] + row[2 * ix + 1] + next[2 * ix] + next[2 * ix + 1]);
        }
      }
      copied_ = true;
      scratch_.resize(problem_.kernel.scratch_size());  // of both
      coarse->displace(pulled, pulled, scratch_);
      state_.pairs += 0.25;
      set_.watch(members_, [&](int i) {
        return -height[i] - interpolate(pulled, half, cubic(i % grid_.nx, 2, half.nx),
                                        cubic(i / grid_.nx, 2, half.ny));
      });
    }
    if (!balance()) return false;
    take_pressures();
    return true;
  }

  // Solves the pixels watched; they stay so, touching as found.
  bool balance() {
    if (!set_.balance(problem_.load, 1e-13 * problem_.spread, limit_)) return false;
    members_.clear();
    for (std::size_t k = 0; k < set_.size(); ++k) {
      members_.emplace_back(set_.pixel(k), set_.touches(k));
    }
    return true;
  }

  double gap_function(std::size_t i) const { return -problem_.height[i] - rise_[i]; }

  // The rise by the tractions and the pressures taken.
  void displace() {
    const std::span<const double> t = problem_.traction;
    if (t.empty()) {
      rise_.assign(n_, 0.0);
    } else if (!copied_) {
      rise_.assign(t.begin(), t.end());
    }
    copied_ = false;
    for (int i : under_pressure_) rise_[i] -= state_.p[i];
    scratch_.resize(problem_.kernel.scratch_size());
    problem_.kernel.displace(rise_, rise_, scratch_);
    ++state_.pairs;
  }

  void take(int i, double p) {
    state_.p[i] = p;
    if (p > 0) under_pressure_.push_back(i);
  }
  void take_pressures() {
    for (int i : under_pressure_) state_.p[i] = 0;
    under_pressure_.clear();
    for (std::size_t k = 0; k < set_.size(); ++k) take(set_.pixel(k), set_.pressure(k));
  }

  // Displacement of pixel i by the pressures taken.
  double pressed(int i) const {
    const int x = i % grid_.nx, y = i / grid_.nx;
    double u = 0;
    for (int j : under_pressure_) {
      u += problem_.kernel.influence(wrap(x - j % grid_.nx, grid_.nx),
                                     wrap(y - j / grid_.nx, grid_.ny)) *
           state_.p[j];
    }
    return u;
  }

  // The pixels that penetrate, and their neighbours, are watched too.
  void extend(const std::vector<int>& penetrating) {
    for (int i : penetrating) {
      const int ix = i % grid_.nx, iy = i / grid_.nx;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const std::size_t j = grid_.index(wrap(ix + dx, grid_.nx), wrap(iy + dy, grid_.ny));
          members_.emplace_back(static_cast<int>(j), dx == 0 && dy == 0);
        }
      }
    }
  }

  // The change of pressure in the gap function, times sign, within near() pixels.
  void displace_nearby(double sign) {
    const int reach_x = ContactKernel::near(grid_.nx), reach_y = ContactKernel::near(grid_.ny);
    for (const auto& [i, d] : change_) {
      const int ix = i % grid_.nx, iy = i / grid_.nx;
      for (int dy = -reach_y; dy <= reach_y; ++dy) {
        const int row = wrap(dy, grid_.ny);
        const std::size_t to = grid_.index(0, wrap(iy + dy, grid_.ny));
        for (int dx = -reach_x; dx <= reach_x; ++dx) {
          rise_[to + wrap(ix + dx, grid_.nx)] -=
              sign * d * problem_.kernel.influence(wrap(dx, grid_.nx), row);
        }
      }
    }
  }

  // Certificate (Eq. contact.4) of the set's pressures in a gap function known to within blur [m],
  // the pixels watched exactly; those not watched that may penetrate. The gaps and the work of the
  // state in the same pass: it is the only one over all pixels that follows the transform.
  std::vector<int> inspect(double blur) {
    const double shift = set_.shift(), bound = shift + blur;
    const std::span<const double> height = problem_.height, traction = problem_.traction;
    state_.gap.resize(n_);
    const auto [low, pulled] = reduce(n_, [&](auto at) {
      const auto rise = at(rise_), w = -at(height) - rise;
      at.store(state_.gap, larger(w - shift, 0.0));
      return std::tuple(Least(w), at(traction, 0) * rise);
    });
    std::vector<int> open;
    if (low < bound) {
      for_each_where(
          n_, [&](auto at) { return -at(height) - at(rise_) < bound; },
          [&](std::size_t i) {
            if (set_.find(static_cast<int>(i)) == set_.size()) open.push_back(static_cast<int>(i));
          });
    }
    double pressed = 0, risen = 0;
    for (std::size_t k : set_.touching()) {
      const int i = set_.pixel(k);
      pressed += set_.pressure(k) * gap_function(i);
      risen += set_.pressure(k) * rise_[i];
      state_.gap[i] = 0;
    }
    state_.work = pulled - risen;
    state_.shift = shift;
    state_.certificate =
        std::max(0.0, pressed - low * problem_.load) / (problem_.load * problem_.spread);
    return open;
  }

  const StandardProblem& problem_;
  const Grid& grid_;
  std::size_t n_, limit_;
  double tolerance_;
  StandardState& state_;
  RealArray rise_;       // by the tractions less the pressures taken; before, the tractions
  bool copied_ = false;  // it holds the tractions
  ActiveSet set_;
  Watched members_;
  std::vector<int> under_pressure_;             // pixels of the pressures taken
  std::vector<std::pair<int, double>> change_;  // pressures found less those taken
  std::vector<double> before_;
  SpectrumArray scratch_;
};

}  // namespace

bool solve_sparse(const StandardProblem& problem, double tolerance, const ContactSolution* start,
                  bool demand, StandardState& state) {
  return CandidateSolver(problem, tolerance, state).run(start, demand);
}

}  // namespace papilla::contact
