// Nested, stencil-preconditioned conjugate gradients on the full grid: one transform pair an
// iteration, everything else on the list of pixels that may carry pressure.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/watch.h"
#include "physics/contact/dense_fields.h"
#include "physics/contact/dense_listed.h"
#include "physics/contact/dense_whole.h"

namespace papilla::contact {
namespace {

// Shares of the pixels that may carry pressure, one in so many: above the first whole fields are
// cheaper than lists, below the second lists are; between them nothing changes, so that a share at
// the border does not swing. contact_bench, rough p/E* = 0.2: docs/theory/contact.md, "Method".
constexpr std::size_t kWholeAbove = 3, kListsBelow = 4;

// An iteration counts as progress where it lowers the best certificate by 2 %; without any for this
// many the solve ends: rounding is reached, or the problem is beyond it. No state of the benches
// waits that long: 20 to 400 iterations and 0 to 10 % give the same pairs (contact_steps_bench).
constexpr double kProgress = 0.98;
constexpr int kPatience = 100;

// How far a step goes along its direction, and what follows from where the energy's minimum lies on
// it (t, the step's end being 1).
class StepLength {
 public:
  double alpha() const { return alpha_; }        // the length expected
  bool conjugate() const { return conjugate_; }  // the next direction may lean on the last step
  bool plain() const { return plain_; }          // the next direction is the gradient itself

  // The share of the step to take. clipped: it ran into the bounds. room(): how many times it fits.
  template <class Room>
  double take(const StepSlopes& s, bool clipped, const Room& room) {
    double t = s.curvature > 0 ? -s.slope / s.curvature : 0;
    // A direction far from any length expected lost its meaning: a share of the last step that
    // cancels it, for one, where only two pixels are free.
    const bool sound = t > kShortest && t < kLongest;
    if (t > 0) alpha_ = sound ? std::clamp(alpha_ * t, kLeastAlpha, kMostAlpha) : kFirst;
    if (clipped) {
      // Kept unless it went too far: its end tells which pixels are free.
      t = t > kKeepWhole ? 1 : std::max(t, 0.0);
    } else {
      t = t > 1 ? std::min(t, room()) : std::max(t, 0.0);
    }
    conjugate_ = t > 0 && sound;
    restart_where_stuck(t);
    return t;
  }

 private:
  // Cut at many bounds a preconditioned direction may climb; the gradient never does.
  void restart_where_stuck(double t) {
    if (t == 0) {
      alpha_ = plain_ ? std::max(kLeastPlain, kAgain * alpha_) : kAgain;
      plain_ = true;
    } else if (plain_) {
      alpha_ = kAgain;
      plain_ = false;
    }
  }

  // Measured by the transform pairs of contact_steps_bench, 2459 for its 216 states. The first
  // length: 0.3 costs 1.5 % more pairs, 1 costs 0.7 %, 0.8 saves 0.7 %.
  static constexpr double kFirst = 0.6;
  // A clipped step whose minimum lies beyond this is kept whole: 0.7 costs 3 % more pairs, 1 costs
  // 1.5 %, 0.95 saves 1 %.
  static constexpr double kKeepWhole = 0.85;
  // Guards against lost directions. Within 1e-6 to 1e-2 and 30 to 1e6, and as bounds of the length
  // within 1e-6 to 1e-2 and 5 to 100, no choice moves the pairs by more than 0.05 %.
  static constexpr double kShortest = 1e-3, kLongest = 1e3;
  static constexpr double kLeastAlpha = 1e-4, kMostAlpha = 20;
  // After a direction without descent, and shorter each time, down to the least: no state of the
  // benches needs it.
  static constexpr double kAgain = 0.3, kLeastPlain = 1e-6;

  double alpha_ = kFirst;
  bool conjugate_ = false, plain_ = false;
};

class DenseSolver {
 public:
  DenseSolver(const StandardProblem& problem, double tolerance, int max_iterations,
              StandardState& state)
      : fields_(problem, state),
        listed_(fields_),
        whole_(fields_),
        state_(state),
        tolerance_(tolerance),
        max_iterations_(max_iterations) {}

  // From the pressure of the state, with any mean and beyond the cap where the start is that of a
  // coarser grid or another cap. without: the gap function without pressure, or empty. Every step's
  // transform is added to the gap function, which so stays that of the pressure to rounding, and
  // the certificate is that of the pressure returned.
  void solve(RealArray without) {
    if (fields_.problem.approach) {
      for (double& v : fields_.p) v = std::min(v, fields_.cap);
    } else {
      fields_.scale_to_load();
    }
    fields_.start(std::move(without));
    listed_.begin();
    choose_lists_or_fields();
    state_.certified = iterate();
    state_.exhausted = state_.iterations >= max_iterations_;
    fields_.settle_shift();
    state_.shift = fields_.shift;
    fields_.close_gaps();
  }

 private:
  bool iterate() {
    double best = kInfinity;
    int since_best = 0;
    for (;; ++state_.iterations) {
      Watch::look();
      state_.certificate = fields_.certificate();
      if (state_.certificate <= tolerance_) return true;
      if (state_.certificate < kProgress * best) {
        best = state_.certificate;
        since_best = 0;
      } else if (++since_best > kPatience) {
        return false;
      }
      if (state_.iterations >= max_iterations_) return false;
      if (on_fields_) {
        step(whole_);
      } else {
        step(listed_);
      }
      choose_lists_or_fields();
    }
  }

  // One iteration on lists or on whole fields.
  template <class Pixels>
  void step(Pixels& pixels) {
    if (length_.plain()) {
      pixels.precondition_plainly();
    } else {
      pixels.precondition();
    }
    const bool clipped = pixels.move(length_.alpha(), length_.conjugate());
    fields_.displace_step();
    pixels.advance(length_.take(pixels.slopes(), clipped, [&] { return pixels.room(); }));
  }

  void choose_lists_or_fields() {
    const std::size_t n = fields_.grid.size();
    if (on_fields_ && kListsBelow * whole_.free_count() < n) {
      listed_.take_over(whole_);
      on_fields_ = false;
    } else if (!on_fields_ && kWholeAbove * listed_.free_count() > n) {
      whole_.take_over(listed_);
      on_fields_ = true;
    }
  }

  DenseFields fields_;
  ListedPixels listed_;
  WholePixels whole_;
  bool on_fields_ = false;
  StepLength length_;
  StandardState& state_;
  double tolerance_;
  int max_iterations_;
};

}  // namespace

StandardState solve_dense(const StandardProblem& problem, double tolerance, int max_iterations,
                          std::span<const double> start) {
  StandardState state;
  RealArray without;
  if (!start.empty()) {
    state.p.assign(start.begin(), start.end());
  } else {
    SpectrumArray scratch;
    state.pairs += problem.rise_unpressed(without, scratch);
    for (std::size_t i = 0; i < without.size(); ++i) without[i] = -problem.height[i] - without[i];
    if (problem.kernel.coarse()) {
      state.p = nested_start(problem, without, tolerance, state.pairs);
    } else {
      const auto n = static_cast<double>(problem.height.size());
      state.p.assign(problem.height.size(), problem.load / n);
    }
  }
  DenseSolver(problem, tolerance, max_iterations, state).solve(std::move(without));
  return state;
}

}  // namespace papilla::contact
