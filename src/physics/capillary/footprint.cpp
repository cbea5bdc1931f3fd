#include "physics/capillary/footprint.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla::capillary {
namespace {

// Changes of the sampling rule in one solve, after which only finer ones count.
constexpr int kMostRules = 8;
// Of the volume with the area of the disc, as powers: the rim's gap by the mean one.
constexpr double kLeastGrowth = 0.7, kMostGrowth = 2.5;
// Steps with a new rule each while the guess is far off.
constexpr int kMostResamplings = 40;

// A miss, by the volume, from which one step leads to the radius.
constexpr double kNearly = 1e-8;

// What one solve knows of the gap: the table at one place, and the volume wanted.
class FootprintSolver {
 public:
  FootprintSolver(const GapTable& table, double x, double y, double volume)
      : table_(table), x_(x), y_(y), volume_(volume) {}

  // A step by the rim's gap, then parabolas, inside a bracket.
  Footprint solve(const BridgeGuess& guess) {
    double r = guess.radius, growth = 1;
    if (guess.radius > 0) {
      if (guess.edge_gap > 0) growth = kPi * square(r) * guess.edge_gap / volume_;
    } else {
      r = first_guess(growth);
    }
    growth = std::clamp(growth, kLeastGrowth, kMostGrowth);
    int chords = table_.rule(r).chords, earlier = 0;
    bool seen = false, last_pass = false;
    int rules = 0;
    for (int resampled = 0;; ++resampled) {
      double miss = missing(r, chords);
      // The rim's gap as that of the guess, by the mean; the misses soon know better.
      const double linear = growth * 2 * (miss + volume_) / r;
      double next = r - miss / linear;
      const bool far = !(next > 0.75 * r && next < 1.3 * r);
      if (far && resampled < kMostResamplings) {  // a new size, a new rule
        r = std::clamp(next, 0.5 * r, 2 * r);
        chords = table_.rule(r).chords;
        continue;
      }
      // Pockets in a nearly closed gap: the volume jumps with the radius, Newton goes astray.
      next = std::clamp(next, 0.5 * r, 2 * r);
      const int ahead = table_.rule(next).chords;
      if (ahead != chords && !seen) {
        chords = ahead;
        miss = missing(r, chords);
      }
      r = closed_in(chords, r, miss, next, growth * (miss + volume_) / square(r));
      const int proper = table_.rule(r).chords;  // of the result, whatever the guess was
      if (proper == chords || last_pass) break;
      if (seen && proper == earlier) {  // each asks for the other: the finer one
        if (proper < chords) break;
        last_pass = true;
      }
      // Longer circles of rules end at their finest too.
      if (++rules > kMostRules && proper <= chords) break;
      seen = true;
      earlier = chords;
      chords = proper;
    }
    return {r, table_.rim(x_, y_, r, table_.rule(r))};
  }

 private:
  // From the centre's gap, then as a bowl through what lies around it.
  double first_guess(double& growth) const {
    const double centre = table_.at(x_, y_);
    double r = std::sqrt(volume_ / (kPi * centre));
    constexpr double kWidest = 4;  // by the cube root of the volume
    if (cube(r) > cube(kWidest) * volume_) r = kWidest * std::cbrt(volume_);
    r *= 0.7;
    const double around = table_.rim(x_, y_, r, table_.rule(r)).gap;
    if (around <= centre) return std::sqrt(volume_ / (kPi * around));
    // The gap on the rim of the bowl's disc that holds the volume.
    const double rim =
        std::sqrt(square(centre) + 2 * (around - centre) / square(r) * volume_ / kPi);
    growth = 2 * rim / (centre + rim);
    return std::sqrt(2 * volume_ / (kPi * (centre + rim)));
  }

  double missing(double r, int chords) const {
    return table_.disc_volume(x_, y_, r, {.chords = chords, .rim_points = 0}) - volume_;
  }

  // Inside a bracket, from one miss [m^3] and a step of known slope: the parabola through the last
  // three misses, over the area of the disc, by which the volume grows almost evenly.
  double closed_in(int chords, double first, double last_miss, double r, double slope) const {
    double low = 0, high = 0;                       // bracket; high = 0: none yet
    double last = square(first), area = square(r);  // over pi
    double inverse = 1 / slope, bend = 0, before = last_miss;
    (last_miss < 0 ? low : high) = last;
    for (int k = 0; k < 60; ++k) {
      const double miss = missing(r, chords);
      if (std::abs(miss) <= 1e-13 * volume_) break;
      (miss < 0 ? low : high) = area;
      const double secant = (area - last) / (miss - last_miss);
      const bool usual = secant > 0.2 * inverse && secant < 5 * inverse;
      bend = usual && k > 0 ? last_miss * (secant - inverse) / (miss - before) : 0;
      if (usual) inverse = secant;
      if (!(std::abs(bend) < 0.5 * inverse)) bend = 0;
      double next = area - miss * (inverse - bend);
      before = last_miss;
      last = area;
      last_miss = miss;
      if (next <= low || (high > 0 && next >= high))
        next = high > 0 ? square(0.5 * (std::sqrt(low) + std::sqrt(high))) : 4 * area;
      if (std::abs(next - area) <= 2e-15 * area) break;
      area = next;
      r = std::sqrt(area);
      // The slope is known to a thousandth at least: what the last step leaves is below 1e-11.
      if (std::abs(miss) <= kNearly * volume_) break;
    }
    return r;
  }

  const GapTable& table_;
  double x_, y_, volume_;
};

}  // namespace

Footprint solve_footprint(const GapTable& table, double x, double y, double volume,
                          const BridgeGuess& guess) {
  return FootprintSolver(table, x, y, volume).solve(guess);
}

}  // namespace papilla::capillary
