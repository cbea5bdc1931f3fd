// The area of a light contact on the points near contact of a finer grid.
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "physics/contact/active_set.h"
#include "physics/contact/area_of_pixels.h"
#include "physics/contact/cubic.h"

namespace papilla {
namespace {

// More fine contact pixels than this are cheaper on the whole fine grid.
constexpr std::size_t kMostContacts = 2048;
constexpr int kMostRounds = 8;
constexpr char kTooMuch[] = "too much contact: solve the whole fine grid";

class Refinement {
 public:
  Refinement(const CoarseContact& coarse, const ContactKernel& fine,
             std::span<const double> fine_height)
      : coarse_(coarse),
        grid_(coarse.kernel.grid()),
        fine_(fine),
        target_(fine.grid()),
        height_(fine_height),
        ratio_(target_.nx / grid_.nx),
        set_(fine) {
    PAPILLA_CHECK(ratio_ * grid_.nx == target_.nx && ratio_ * grid_.ny == target_.ny,
                  "grids do not nest");
    PAPILLA_CHECK(coarse.height.size() == grid_.size() && fine_height.size() == target_.size(),
                  "heights");
  }

  RefinedContact run() {
    const ContactSolution& solution = coarse_.solution;
    if (!solution.converged() || solution.pressure.size() != grid_.size()) {
      out_.reason = "no coarse solution";
      return out_;
    }
    double load = coarse_.mean_pressure * static_cast<double>(target_.size()), touching = 0;
    for (double t : coarse_.traction) load += t * ratio_ * ratio_;
    for (double p : solution.pressure) touching += p > 0;
    if (load <= 0 || touching == 0) {
      out_.ok = true;
      return out_;
    }
    const double expected = touching * ratio_ * ratio_;
    if (expected > static_cast<double>(kMostContacts)) {
      out_.reason = kTooMuch;
      return out_;
    }
    pull_by_tractions();
    find_low_points();
    const std::size_t watched = std::min(low_.size(), static_cast<std::size_t>(3 * expected) + 64);
    out_.ok = settle(load, watched);
    if (out_.ok) measure();
    return out_;
  }

 private:
  // The rise by the tractions alone, and the interpolation that takes coarse fields to fine points.
  void pull_by_tractions() {
    if (!coarse_.traction.empty()) {
      const RealArray t(coarse_.traction.begin(), coarse_.traction.end());
      RealArray u(grid_.size());
      SpectrumArray scratch(coarse_.kernel.scratch_size());
      coarse_.kernel.displace(t, u, scratch);
      pulled_.assign(u.begin(), u.end());
    }
    for (int ix = 0; ix < target_.nx; ++ix) across_.push_back(cubic(ix, ratio_, grid_.nx));
    for (int iy = 0; iy < target_.ny; ++iy) along_.push_back(cubic(iy, ratio_, grid_.ny));
  }

  double at_point(std::span<const double> field, std::size_t i) const {
    return interpolate(field, grid_, across_[i % target_.nx], along_[i / target_.nx]);
  }
  double initial_gap(int i) const {
    const auto at = static_cast<std::size_t>(i);
    return pulled_.empty() ? -height_[at] : -height_[at] - at_point(pulled_, at);
  }

  // Fine points of the pixels that the slope between two pixels may close, by their expected gap.
  void find_low_points() {
    // Displacements by pressure and tractions, smooth on the scale of the coarse pixels.
    std::vector<double> displaced(grid_.size());
    const ContactSolution& solution = coarse_.solution;
    const std::span<const double> height = coarse_.height;
    double slopes = 0;
    for (int iy = 0; iy < grid_.ny; ++iy) {
      for (int ix = 0; ix < grid_.nx; ++ix) {
        const std::size_t i = grid_.index(ix, iy);
        displaced[i] = solution.gap[i] + solution.shift + height[i];
        slopes += square(height[grid_.index(wrap(ix + 1, grid_.nx), iy)] - height[i]);
      }
    }
    reach_ = 3 * std::sqrt(slopes / static_cast<double>(grid_.size()));
    for (int iy = 0; iy < grid_.ny; ++iy) {
      for (int ix = 0; ix < grid_.nx; ++ix) {
        if (solution.gap[grid_.index(ix, iy)] > reach_) continue;
        for (int y = ratio_ * iy; y < ratio_ * (iy + 1); ++y) {
          for (int x = ratio_ * ix; x < ratio_ * (ix + 1); ++x) {
            const std::size_t i = target_.index(x, y);
            low_.emplace_back(at_point(displaced, i) - height_[i] - solution.shift,
                              static_cast<int>(i));
          }
        }
      }
    }
    std::sort(low_.begin(), low_.end());
  }

  // Solves the points watched; those that penetrate join, until none does.
  bool settle(double load, std::size_t watched) {
    std::vector<std::pair<int, bool>> members;
    for (std::size_t k = 0; k < watched; ++k) {
      members.emplace_back(low_[k].second, low_[k].first <= 0);
    }
    if (!low_.empty() && low_[0].first > 0) members[0].second = true;
    for (int round = 0; round < kMostRounds; ++round) {
      set_.watch(members, [this](int i) { return initial_gap(i); });
      if (!set_.balance(load, 1e-13 * reach_, kMostContacts)) {
        out_.reason = kTooMuch;
        return false;
      }
      members.clear();
      for (std::size_t k = 0; k < set_.size(); ++k) {
        members.emplace_back(set_.pixel(k), set_.touches(k));
      }
      if (!add_penetrating(watched, members)) return true;
    }
    out_.reason = "the contact did not settle";
    return false;
  }

  // Penetrating neighbours of the contact, and as many points again above those watched. False:
  // there are none.
  bool add_penetrating(std::size_t watched, std::vector<std::pair<int, bool>>& members) const {
    const std::size_t before = members.size();
    const auto inspect = [&](int i) {
      if (set_.find(i) == set_.size() && set_.gap(i, initial_gap(i)) < 0) {
        members.emplace_back(i, true);
      }
    };
    for (std::size_t k : set_.touching()) {
      const int ix = set_.pixel(k) % target_.nx, iy = set_.pixel(k) / target_.nx;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          inspect(static_cast<int>(
              target_.index(wrap(ix + dx, target_.nx), wrap(iy + dy, target_.ny))));
        }
      }
    }
    for (std::size_t k = watched; k < std::min(low_.size(), 2 * watched); ++k) {
      inspect(low_[k].second);
    }
    return members.size() > before;
  }

  void measure() {
    std::vector<int> contact;
    for (std::size_t k : set_.touching()) contact.push_back(set_.pixel(k));
    const auto pressure = [this](std::size_t i) {
      const std::size_t k = set_.find(static_cast<int>(i));
      return k < set_.size() ? set_.pressure(k) : 0;
    };
    const auto gap = [this](std::size_t i) {
      return std::max(0.0, set_.gap(static_cast<int>(i), initial_gap(static_cast<int>(i))));
    };
    out_.area = AreaOfPixels(fine_, pressure, gap, 0).measure(contact);
    out_.contacts = static_cast<int>(contact.size());
    out_.points = static_cast<int>(set_.size());
  }

  const CoarseContact& coarse_;
  const Grid& grid_;
  const ContactKernel& fine_;
  const Grid& target_;
  std::span<const double> height_;  // fine [m]
  int ratio_;
  std::vector<double> pulled_;               // coarse rise by the tractions [m], or empty
  std::vector<Cubic> across_, along_;        // of the fine columns and rows
  double reach_ = 0;                         // gap that the slope between two pixels may close [m]
  std::vector<std::pair<double, int>> low_;  // expected gap and fine point, ascending
  ActiveSet set_;
  RefinedContact out_;
};

}  // namespace

RefinedContact refine_contact(const CoarseContact& coarse, const ContactKernel& fine,
                              std::span<const double> fine_height) {
  return Refinement(coarse, fine, fine_height).run();
}

}  // namespace papilla
