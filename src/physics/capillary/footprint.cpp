#include "physics/capillary/footprint.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla::capillary {
namespace {

// Changes of the sampling rule in one solve, after which only finer ones count.
constexpr int kMostRules = 8;
// Steps with a new rule each while the guess is far off.
constexpr int kMostResamplings = 40;

int points(const GapTable::Rule& rule) { return rule.chords + rule.rim_points; }

// A miss, by the volume, from which one step leads to the radius.
constexpr double kNearly = 1e-8;

// What one solve knows of the gap: the table at one place, and the volume wanted.
class FootprintSolver {
 public:
  FootprintSolver(const GapTable& table, double x, double y, double volume)
      : table_(table), x_(x), y_(y), volume_(volume) {}

  // A step by the mean gap, then secants, inside a bracket.
  Footprint solve(double guess) {
    double r = guess > 0 ? guess : first_guess();
    GapTable::Rule rule = table_.rule(r), earlier{};
    bool seen = false, last_pass = false;
    int rules = 0;
    for (int resampled = 0;; ++resampled) {
      double miss = missing(r, rule);
      // As if the rim's gap were the mean: within a factor 2, which the secants soon know better.
      const double linear = 2 * (miss + volume_) / r;
      double next = r - miss / linear;
      const bool far = !(next > 0.75 * r && next < 1.3 * r);
      if (far && resampled < kMostResamplings) {  // a new size, a new rule
        r = std::clamp(next, 0.5 * r, 2 * r);
        rule = table_.rule(r);
        continue;
      }
      // Pockets in a nearly closed gap: the volume jumps with the radius, Newton goes astray.
      next = std::clamp(next, 0.5 * r, 2 * r);
      const GapTable::Rule ahead = table_.rule(next);
      if (ahead != rule && !seen) {
        rule = ahead;
        miss = missing(r, rule);
      }
      r = secants(rule, r, miss, next, linear);
      const GapTable::Rule proper = table_.rule(r);  // of the result, whatever the guess was
      if (proper == rule || last_pass) break;
      if (seen && proper == earlier) {  // each asks for the other: the finer one
        if (points(proper) < points(rule)) break;
        last_pass = true;
      }
      // Longer circles of rules end at their finest too.
      if (++rules > kMostRules && points(proper) <= points(rule)) break;
      seen = true;
      earlier = rule;
      rule = proper;
    }
    return {r, table_.rim(x_, y_, r, rule)};
  }

 private:
  // From the centre's gap, then from what lies around it.
  double first_guess() const {
    double r = std::sqrt(volume_ / (kPi * table_.at(x_, y_)));
    r = std::min(r, std::cbrt(volume_) * 4);
    const double around = table_.rim(x_, y_, 0.7 * r, table_.rule(0.7 * r)).gap;
    return std::sqrt(volume_ / (kPi * around));
  }

  double missing(double r, const GapTable::Rule& rule) const {
    return table_.disc_volume(x_, y_, r, rule) - volume_;
  }

  // Secants inside a bracket, from one miss [m^3] and a step of known slope.
  double secants(const GapTable::Rule& rule, double last, double last_miss, double r,
                 double slope) const {
    double low = 0, high = 0;  // bracket; high = 0: none yet
    (last_miss < 0 ? low : high) = last;
    for (int k = 0; k < 60; ++k) {
      const double miss = missing(r, rule);
      if (std::abs(miss) <= 1e-13 * volume_) break;
      (miss < 0 ? low : high) = r;
      const double secant = (miss - last_miss) / (r - last);
      if (secant > 0.2 * slope && secant < 5 * slope) slope = secant;
      last = r;
      last_miss = miss;
      double next = r - miss / slope;
      if (next <= low || (high > 0 && next >= high)) next = high > 0 ? 0.5 * (low + high) : 2 * r;
      if (std::abs(next - r) <= 1e-15 * r) break;
      r = next;
      // The slope is known to a thousandth here: what the last step leaves is below 1e-10.
      if (std::abs(miss) <= kNearly * volume_) break;
    }
    return r;
  }

  const GapTable& table_;
  double x_, y_, volume_;
};

}  // namespace

Footprint solve_footprint(const GapTable& table, double x, double y, double volume, double guess) {
  return FootprintSolver(table, x, y, volume).solve(guess);
}

}  // namespace papilla::capillary
