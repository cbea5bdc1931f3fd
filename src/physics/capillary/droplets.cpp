#include "physics/capillary/droplets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "base/check.h"
#include "base/constants.h"
#include "base/random.h"
#include "physics/capillary/bridge_table.h"
#include "physics/capillary/film.h"
#include "physics/capillary/gap_table.h"
#include "physics/capillary/threshold.h"

namespace papilla {
namespace {

constexpr std::array<std::array<double, 2>, 8> kDirections = {
    {{1, 0},
     {0.7071067811865476, 0.7071067811865476},
     {0, 1},
     {-0.7071067811865476, 0.7071067811865476},
     {-1, 0},
     {-0.7071067811865476, -0.7071067811865476},
     {0, -1},
     {0.7071067811865476, -0.7071067811865476}}};

// Slopes of the gap beyond this are walls, not bowls: they are taken as this [rad].
constexpr double kLargestTilt = kPi / 4;
constexpr double kFlatTilt = kPi / 12;

// From disc to film between these times the limit (Eq. capillary.22).
constexpr double kFilmFrom = 0.8, kFilmTo = 1.25;

// Changes of the integration rule in one solve for a footprint, after which only finer ones count.
constexpr int kMostRules = 8;

double into_period(double x, double period) {
  x -= period * std::floor(x / period);
  return x < period ? x : 0;
}

// Of a difference between two places inside the period.
double nearest_image(double d, double period) {
  if (d > 0.5 * period) return d - period;
  return d < -0.5 * period ? d + period : d;
}

struct Drop {
  double x = 0, y = 0, volume = 0;
  double radius = 0;  // footprint; a cap: its widest, which is what overlaps
  double edge_gap = 0, edge_slope = 0;
  double energy = 0;
  double film = 0;  // share, once settled
  bool bridge = false;
  bool alive = true;
};

// All droplets of a patch, hashed by their centres.
class Ensemble {
 public:
  Ensemble(const Gap& gap, const WaterProperties& water, const DropletOptions& options)
      : gap_(gap),
        table_(gap, options.gap_floor),
        options_(options),
        water_(water),
        gain_(wetting_gain(water.theta_skin, water.theta_substrate)),
        cos_skin_(std::cos(water.theta_skin)),
        exact_(bridge_table(water.theta_skin, water.theta_substrate)),
        cap_(cap_shape(std::min(water.theta_skin, water.theta_substrate))),
        cap_state_(water.theta_skin < water.theta_substrate ? DropletState::OnSkin
                                                            : DropletState::OnSubstrate),
        lx_(gap.grid.lx),
        ly_(gap.grid.ly) {
    // The meniscus factor over the slope angle, a polynomial through five angles.
    const auto tilted = [&](double share) {
      return meniscus_factor(water.theta_substrate,
                             std::clamp(water.theta_skin + share * kLargestTilt, 0.0, kPi));
    };
    meniscus_ = tilted(0);
    const double odd_half = 0.5 * (tilted(0.5) - tilted(-0.5)),
                 odd = 0.5 * (tilted(1) - tilted(-1));
    const double even_half = 0.5 * (tilted(0.5) + tilted(-0.5)) - meniscus_;
    const double even = 0.5 * (tilted(1) + tilted(-1)) - meniscus_;
    const double cubic = (odd - 2 * odd_half) * 4 / 3, quartic = (even - 4 * even_half) * 4 / 3;
    tilt_terms_ = {odd - cubic, even - quartic, cubic, quartic};
    // A drop whose centre sees a gap (per volume^(1/3)) well beyond the largest at which a flat
    // bridge has the lower energy is not worth trying as a bridge.
    rupture_ = exact_->valid() ? exact_->limits().rupture : 2;
    const double favoured = exact_->valid() ? exact_->limits().switching : 1;
    reach_ = std::max(1.3 * favoured, cap_.height);
  }

  void start(const std::vector<DropletSeed>& droplets) {
    drops_.reserve(droplets.size());
    for (const DropletSeed& d : droplets) drops_.push_back(placed(d.x, d.y, d.volume, 0, false));
    build_hash();
    report_.initial_droplets = static_cast<int>(drops_.size());
    merge_overlaps();
    if (options_.rims && options_.corner_wicking) wick();
    report_.initial_energy = energy();
  }

  void restore(const Wetting& wetting) {
    wicked_ = wetting.wicked_volume;
    metastable_ = true;  // a bridge that exists stays until it ruptures
    for (const Droplet& d : wetting.droplets) {
      Drop drop;
      drop.x = d.x;
      drop.y = d.y;
      drop.volume = d.volume;
      if (d.state == DropletState::Bridge || d.height >= table_.at(d.x, d.y)) {
        drop = placed(d.x, d.y, d.volume, d.radius, true);
      } else {  // floats: keeps its shape
        drop.radius = d.radius;
        drop.energy = d.energy;
      }
      drop.film = d.film;
      drops_.push_back(drop);
    }
    metastable_ = false;
    build_hash();
    merge_overlaps();
  }

  void settle() {
    double last = energy();
    double step = options_.first_step;
    for (int level = 0; level <= options_.halvings; ++level, step *= 0.5) {
      for (int i = 0; i < static_cast<int>(drops_.size()); ++i) {
        if (drops_[i].alive) walk(i, level, step);
      }
      const double now = energy();
      if (now > last + 1e-12 * std::abs(last)) report_.energy_rose = true;
      last = now;
    }
    report_.final_energy = last;
  }

  // What there is now, as discs; wide bridges (or all, above the wetted area's limit) as film.
  Wetting result(double total_volume) {
    const double side = std::min(lx_, ly_);
    double area = 0;
    for (const Drop& d : drops_) {
      if (d.alive && d.bridge) area += kPi * square(d.radius);
    }
    const double all = film_share(area / gap_.grid.area(), options_.film_area, 1);
    bool film = false;
    for (Drop& d : drops_) {
      if (!d.alive) continue;
      d.film = d.bridge ? std::max(all, film_share(2 * d.radius, options_.film_width, side))
                        : static_cast<double>(2 * d.radius > side);
      film = film || d.film > 0;
    }
    Wetting out;
    out.grid = gap_.grid;
    out.volume = total_volume;
    out.wicked_volume = wicked_;
    out.status = WettingStatus::Discs;
    out.bridged.assign(gap_.grid.size(), 0);
    if (film) add_film(out);
    double wet = out.wetted_fraction * gap_.grid.area();
    for (const Drop& d : drops_) {
      if (!d.alive) continue;
      out.droplets.push_back(reported(d));
      if (!d.bridge || d.film > 0) continue;
      const Droplet& bridge = out.droplets.back();
      ++out.bridges;
      out.capillary_force += bridge.force;
      out.bridge_volume += d.volume;
      out.retention += disc_retention(d);
      wet += kPi * square(d.radius);
      for_pixels(gap_.grid, bridge, [&](std::size_t k) { out.bridged[k] = 1; });
    }
    out.wetted_fraction = std::min(1.0, wet / gap_.grid.area());
    return out;
  }

  const SettleReport& report() const { return report_; }

  // Pixels whose centres lie inside a disc.
  template <class Visit>
  static void for_pixels(const Grid& g, const Droplet& d, Visit&& visit) {
    const double dx = g.dx(), dy = g.dy();
    const double ry = std::min(d.radius, 0.5 * g.ly);
    const int first = static_cast<int>(std::ceil((d.y - ry) / dy - 0.5));
    const int last = static_cast<int>(std::floor((d.y + ry) / dy - 0.5));
    for (int iy = first; iy <= last; ++iy) {
      const double y = (iy + 0.5) * dy - d.y;
      const double w = std::min(std::sqrt(std::max(0.0, square(d.radius) - square(y))), 0.5 * g.lx);
      const int from = static_cast<int>(std::ceil((d.x - w) / dx - 0.5));
      const int to = static_cast<int>(std::floor((d.x + w) / dx - 0.5));
      const int row = wrap(iy, g.ny);
      for (int ix = from; ix <= to; ++ix) visit(g.index(wrap(ix, g.nx), row));
    }
  }

 private:
  // Eq. capillary.22: how much of a bridge is film, by its width or the wetted area.
  static double film_share(double size, double limit, double most) {
    const double from = kFilmFrom * std::min(limit, most);
    const double to = std::min(kFilmTo * std::min(limit, most), most);
    const double t = std::clamp((size - from) / (to - from), 0.0, 1.0);
    return square(t) * (3 - 2 * t);
  }

  // Eq. capillary.14
  double disc_retention(const Drop& d) const {
    return kPi / 4 * water_.surface_tension * 2 * d.radius * water_.hysteresis;
  }

  double meniscus_at(const GapTable::Rim& rim, double& tilt) const {
    tilt = std::clamp(std::atan(rim.slope), -kLargestTilt, kLargestTilt);
    const double x = tilt / kLargestTilt;
    const auto& [a1, a2, a3, a4] = tilt_terms_;
    return meniscus_ + x * (a1 + x * (a2 + x * (a3 + x * a4)));
  }

  // Eq. capillary.4, per tension: wetting and meniscus, with the slope of the gap at the rim.
  double slab_energy(double radius, const GapTable::Rim& rim) const {
    double tilt;
    const double factor = meniscus_at(rim, tilt);
    const double bowl = square(std::tan(0.5 * tilt));  // wet area of a sphere over its base, less 1
    return -(gain_ + cos_skin_ * bowl) * kPi * square(radius) + 2 * kPi * radius * factor * rim.gap;
  }

  // What the exact flat bridge of this volume and mean gap has beyond the slab, per tension.
  BridgeTable::Value beyond_slab(double volume, double radius) const {
    if (!exact_->valid()) return {0, 0};
    const double size = std::cbrt(volume);
    const double h = volume / (kPi * square(radius)) / size;
    if (h >= rupture_) return {0, 0};
    const BridgeTable::Value exact = (*exact_)(h);
    const double root = std::sqrt(kPi * h);
    return {square(size) * (exact.energy + gain_ / h - 2 * meniscus_ * root),
            size * (exact.force - gain_ / square(h) - meniscus_ * root / h)};
  }

  // Under a bowl that remainder fades (fitted on sphere and plate).
  static double flatness(const GapTable::Rim& rim) {
    return 1 / (1 + square(std::atan(rim.slope) / kFlatTilt));
  }

  double bridge_energy(double volume, double radius, const GapTable::Rim& rim) const {
    return water_.surface_tension *
           (slab_energy(radius, rim) + flatness(rim) * beyond_slab(volume, radius).energy);
  }

  // Eq. capillary.6: dE/dh of that energy when the whole gap opens, at fixed volume and place. The
  // footprint shrinks by dr/dh = -r / (2 h_edge).
  double bridge_force(const Drop& d) const {
    const double r = d.radius;
    const GapTable::Rule rule = table_.rule(r);
    const GapTable::Rim rim{d.edge_gap, d.edge_slope};
    double tilt;
    const double fixed = 2 * kPi * r * meniscus_at(rim, tilt);
    // Over about a pixel: the slope of a bilinear gap jumps from cell to cell.
    const double step = std::min(0.2 * r, std::max(0.02 * r, 0.5 * gap_.grid.dx()));
    const GapTable::Rim out = table_.rim(d.x, d.y, r + step, rule);
    const GapTable::Rim in = table_.rim(d.x, d.y, r - step, rule);
    const BridgeTable::Value beyond = beyond_slab(d.volume, r);
    const double by_radius = (slab_energy(r + step, out) - slab_energy(r - step, in) +
                              beyond.energy * (flatness(out) - flatness(in))) /
                             (2 * step);
    const double mean_gap = d.volume / (kPi * square(r));
    return water_.surface_tension * (fixed - r / (2 * d.edge_gap) * by_radius +
                                     flatness(rim) * beyond.force * mean_gap / d.edge_gap);
  }

  double cap_energy(double volume) const {
    return water_.surface_tension * cap_.energy * square(std::cbrt(volume));
  }

  // Solves the footprint for the volume, Eq. capillary.5: a step by the rim's gap and slope
  // (second order), then secants, inside a bracket.
  void solve_bridge(Drop& d, double guess) {
    ++report_.evaluations;
    double r = guess;
    if (r <= 0) {  // from the centre's gap, then from what lies around it
      r = std::sqrt(d.volume / (kPi * table_.at(d.x, d.y)));
      r = std::min(r, std::cbrt(d.volume) * 4);
      const double around = table_.rim(d.x, d.y, 0.7 * r, table_.rule(0.7 * r)).gap;
      r = std::sqrt(d.volume / (kPi * around));
    }
    GapTable::Rule rule = table_.rule(r), earlier{};
    GapTable::Rim rim;
    bool seen = false, last_pass = false;
    int rules = 0;
    for (int resampled = 0;; ++resampled) {
      rim = table_.rim(d.x, d.y, r, rule);
      double miss = table_.disc_volume(d.x, d.y, r, rule) - d.volume;
      const double linear = 2 * kPi * r * rim.gap, quadratic = kPi * (rim.gap + r * rim.slope);
      const double first = -miss / linear;
      double next = r + first - quadratic * square(first) / linear;
      if (!(next > 0.75 * r && next < 1.3 * r) && resampled < 40) {  // far: a new size, a new rule
        r = std::clamp(r + first, 0.5 * r, 2 * r);
        rule = table_.rule(r);
        continue;
      }
      // Pockets in a nearly closed gap: the volume jumps with the radius, Newton goes astray.
      next = next > 0.5 * r && next < 2 * r ? next : std::clamp(r + first, 0.5 * r, 2 * r);
      const GapTable::Rule ahead = table_.rule(next);
      if (ahead != rule && !seen) {
        rule = ahead;
        miss = table_.disc_volume(d.x, d.y, r, rule) - d.volume;
      }
      r = refine_radius(d, rule, r, miss, next, linear);
      const GapTable::Rule proper = table_.rule(r);  // of the result, whatever the guess was
      if (proper == rule || last_pass) break;
      if (seen &&
          proper == earlier) {  // each asks for the other: the finer one, whatever the guess
        if (proper.chords + proper.rim_points < rule.chords + rule.rim_points) break;
        last_pass = true;
      }
      // Longer circles of rules end at their finest too.
      if (++rules > kMostRules &&
          proper.chords + proper.rim_points <= rule.chords + rule.rim_points) {
        break;
      }
      seen = true;
      earlier = rule;
      rule = proper;
    }
    rim = table_.rim(d.x, d.y, r, rule);
    d.radius = r;
    d.edge_gap = rim.gap;
    d.edge_slope = rim.slope;
    d.energy = bridge_energy(d.volume, r, rim);
    d.bridge = true;
  }

  // Secants inside a bracket, from one miss [m^3] and a step of known slope.
  double refine_radius(const Drop& d, const GapTable::Rule& rule, double last, double last_miss,
                       double r, double slope) const {
    double low = 0, high = 0;  // bracket; high = 0: none yet
    (last_miss < 0 ? low : high) = last;
    for (int k = 0; k < 60; ++k) {
      const double miss = table_.disc_volume(d.x, d.y, r, rule) - d.volume;
      if (std::abs(miss) <= 1e-13 * d.volume) break;
      (miss < 0 ? low : high) = r;
      const double secant = (miss - last_miss) / (r - last);
      if (secant > 0.2 * slope && secant < 5 * slope) slope = secant;
      last = r;
      last_miss = miss;
      double next = r - miss / slope;
      if (next <= low || (high > 0 && next >= high)) next = high > 0 ? 0.5 * (low + high) : 2 * r;
      if (std::abs(next - r) <= 1e-15 * r) break;
      r = next;
    }
    return r;
  }

  // Energy of the same bridge elsewhere, to first order in the change of its radius.
  double estimated_energy(const Drop& d, double x, double y) {
    ++report_.evaluations;
    const double r = d.radius;
    const GapTable::Rule rule = table_.rule(r);
    const GapTable::Rim rim = table_.rim(x, y, r, rule);
    const double change = (d.volume - table_.disc_volume(x, y, r, rule)) / (2 * kPi * r * rim.gap);
    if (std::abs(change) > 0.25 * r) {
      Drop trial = d;
      trial.x = x;
      trial.y = y;
      solve_bridge(trial, 0);
      return trial.energy;
    }
    return bridge_energy(d.volume, r, rim) +
           water_.surface_tension * 2 * kPi * change *
               (-gain_ * r + meniscus_ * (rim.gap + r * rim.slope));
  }

  // The state of lowest energy at a place; a cap taller than the gap must bridge (snap-in).
  Drop placed(double x, double y, double volume, double guess, bool was_bridge) {
    Drop d;
    d.x = into_period(x, lx_);
    d.y = into_period(y, ly_);
    d.volume = volume;
    const double size = std::cbrt(volume), centre = table_.at(d.x, d.y);
    const double cap = cap_energy(volume);
    if (was_bridge || centre < reach_ * size) {
      solve_bridge(d, guess);
      const bool whole = volume < rupture_ * size * kPi * square(d.radius);
      if ((whole && (d.energy < cap || metastable_)) || cap_.height * size >= centre) return d;
    }
    d.bridge = false;
    d.radius = cap_.widest * size;
    d.edge_gap = d.edge_slope = 0;
    d.energy = cap;
    return d;
  }

  void walk(int i, int level, double step) {
    int moves = 0;
    for (;;) {
      if (moves >= options_.max_moves) {
        report_.converged = false;
        return;
      }
      struct Candidate {
        double energy;
        int direction;
      };
      std::array<Candidate, 8> candidates;
      int n = 0;
      const double here = drops_[i].energy;
      const double margin = 1e-9 * std::abs(here);
      for (int k = 0; k < 8; ++k) {
        const double x = into_period(drops_[i].x + step * kDirections[k][0], lx_);
        const double y = into_period(drops_[i].y + step * kDirections[k][1], ly_);
        double e;
        if (drops_[i].bridge) {
          e = estimated_energy(drops_[i], x, y);
        } else {
          const Drop trial = placed(x, y, drops_[i].volume, 0, false);
          if (!trial.bridge) continue;
          e = trial.energy;
        }
        if (e >= here - margin) continue;
        int at = n++;  // lowest first
        for (; at > 0 && candidates[at - 1].energy > e; --at) candidates[at] = candidates[at - 1];
        candidates[at] = {e, k};
      }
      bool moved = false, merged = false;
      for (int c = 0; c < n && !moved; ++c) {
        // Onward the same way while it helps.
        const auto [ux, uy] = kDirections[candidates[c].direction];
        while (moves < options_.max_moves) {
          const Drop& d = drops_[i];
          const Drop trial =
              placed(d.x + step * ux, d.y + step * uy, d.volume, d.bridge ? d.radius : 0, d.bridge);
          if (trial.energy >= d.energy - 1e-9 * std::abs(d.energy)) break;
          const int merges = report_.merges;
          if (!commit(i, trial)) break;
          moved = true;
          ++moves;
          ++report_.moves;
          if (report_.merges != merges) {
            merged = true;
            break;
          }
        }
      }
      if (merged && level > 0) {  // a new, larger drop starts from the first step again
        double s = options_.first_step;
        for (int l = 0; l < level; ++l, s *= 0.5) walk(i, 0, s);
      }
      if (!moved) return;
    }
  }

  // Puts drop i where `trial` is. If it overlaps others there they become one drop, provided that
  // the energy falls; else nothing happens.
  bool commit(int i, const Drop& trial) {
    if (options_.rims && options_.rim_pinning && held(drops_[i], trial)) return false;
    members_.assign(1, i);
    collect_overlaps(trial);
    if (members_.size() == 1) {
      unlink(i);
      drops_[i] = trial;
      link(i);
      return true;
    }
    double before = 0;
    const Drop merged = merge(trial, before, true);
    if (merged.energy >= before) return false;
    adopt(i, merged);
    return true;
  }

  static Droplet disc_of(const Drop& d) {
    Droplet disc;
    disc.x = d.x;
    disc.y = d.y;
    disc.radius = d.radius;
    return disc;
  }

  // Eq. capillary.16: whether an edge of the texture that `from` has not reached keeps it from
  // moving to `to`. A drop on the skin has no line on the texture.
  bool held(const Drop& from, const Drop& to) const {
    const RimMap& rims = *options_.rims;
    if (!rims.valid() || (!from.bridge && cap_state_ == DropletState::OnSkin)) return false;
    const Grid& g = gap_.grid;
    bool found = false;
    for_pixels(g, disc_of(to), [&](std::size_t k) {
      if (found || !rims.edge(k)) return;
      const double ex = nearest_image(g.x(static_cast<int>(k % g.nx)) - from.x, lx_);
      const double ey = nearest_image(g.y(static_cast<int>(k / g.nx)) - from.y, ly_);
      if (square(ex) + square(ey) <= square(from.radius)) return;
      found = !passes_edge(water_.theta_skin, water_.theta_substrate, rims.turn(),
                           std::max(to.edge_gap, options_.gap_floor),
                           std::max(gap_.value[k], options_.gap_floor));
    });
    return found;
  }

  // Eqs. capillary.17, 18: drops on the texture that meet the foot of a wall give their water to
  // its corner, up to what that holds.
  void wick() {
    const RimMap& rims = *options_.rims;
    if (!rims.valid() || cap_state_ == DropletState::OnSkin) return;
    std::vector<double> room;
    for (const RimMap::Hole& hole : rims.holes()) {
      room.push_back(rims.capacity(hole, water_.theta_substrate));
    }
    for (int i = 0; i < static_cast<int>(drops_.size()); ++i) {
      const Drop d = drops_[i];
      const int hole = rims.hole_of(pixel_of(d.x, d.y));
      if (!d.alive || d.bridge || hole < 0 || room[hole] <= 0) continue;
      bool touches = false;
      for_pixels(gap_.grid, disc_of(d), [&](std::size_t k) { touches = touches || rims.edge(k); });
      if (!touches) continue;
      const double taken = std::min(d.volume, room[hole]);
      room[hole] -= taken;
      wicked_ += taken;
      unlink(i);
      if (taken < d.volume) {
        drops_[i] = placed(d.x, d.y, d.volume - taken, 0, false);
        link(i);
      } else {
        drops_[i].alive = false;
      }
    }
  }

  // members_ (closed under overlap) as one drop: at the centroid, or, when it must pay, at the best
  // of that, where the mover is, and the others' centres.
  Drop merge(const Drop& mover, double& before, bool best_place) {
    std::size_t known = 0;
    Drop best;
    double sum = 0;
    while (known != members_.size()) {
      known = members_.size();
      sum = 0;
      double volume = 0, cx = 0, cy = 0, guess = 0, largest = 0;
      for (std::size_t m = 0; m < members_.size(); ++m) {
        const Drop& d = drops_[members_[m]];
        sum += d.energy;
        volume += d.volume;
        if (d.bridge && d.volume > largest) {
          largest = d.volume;
          guess = d.radius;
        }
        if (m == 0) continue;  // the mover itself is the origin
        cx += d.volume * nearest_image(d.x - mover.x, lx_);
        cy += d.volume * nearest_image(d.y - mover.y, ly_);
      }
      const bool bridged = largest > 0;
      if (bridged) guess *= std::sqrt(volume / largest);
      best = placed(mover.x + cx / volume, mover.y + cy / volume, volume, guess, bridged);
      if (best_place) {
        const Drop there = placed(mover.x, mover.y, volume, guess, bridged);
        if (there.energy < best.energy) best = there;
        for (std::size_t m = 1; m < std::min<std::size_t>(members_.size(), 5); ++m) {
          const Drop& d = drops_[members_[m]];
          const Drop at = placed(d.x, d.y, volume, guess, bridged);
          if (at.energy < best.energy) best = at;
        }
      }
      collect_overlaps(best);
    }
    before = sum;
    return best;
  }

  void adopt(int i, const Drop& merged) {
    for (int m : members_) {
      unlink(m);
      drops_[m].alive = false;
    }
    report_.merges += static_cast<int>(members_.size()) - 1;
    drops_[i] = merged;
    link(i);
  }

  void merge_overlaps() {
    for (int i = 0; i < static_cast<int>(drops_.size()); ++i) {
      while (drops_[i].alive && drops_[i].film < 1) {
        members_.assign(1, i);
        collect_overlaps(drops_[i]);
        if (members_.size() == 1) break;
        double before = 0;
        const Drop mover = drops_[i];
        adopt(i, merge(mover, before, false));
      }
    }
  }

  // Adds to members_ every drop that the disc of d overlaps.
  void collect_overlaps(const Drop& d) {
    const auto consider = [&](int j) {
      if (std::find(members_.begin(), members_.end(), j) != members_.end()) return;
      const double ex = nearest_image(drops_[j].x - d.x, lx_);
      const double ey = nearest_image(drops_[j].y - d.y, ly_);
      if (square(ex) + square(ey) < square(d.radius + drops_[j].radius)) members_.push_back(j);
    };
    for (int j : large_) consider(j);
    const double reach = d.radius + small_radius_;
    const int x0 = static_cast<int>(std::floor((d.x - reach) / cell_x_));
    const int x1 =
        std::min(static_cast<int>(std::floor((d.x + reach) / cell_x_)), x0 + cells_x_ - 1);
    const int y0 = static_cast<int>(std::floor((d.y - reach) / cell_y_));
    const int y1 =
        std::min(static_cast<int>(std::floor((d.y + reach) / cell_y_)), y0 + cells_y_ - 1);
    for (int cy = y0; cy <= y1; ++cy) {
      for (int cx = x0; cx <= x1; ++cx) {
        for (int j = head_[wrap(cy, cells_y_) * cells_x_ + wrap(cx, cells_x_)]; j >= 0;
             j = next_[j]) {
          consider(j);
        }
      }
    }
  }

  void build_hash() {
    // Cells hold about one drop, and are wide enough for all but a few drops of the end to count as
    // small: the others are one list that every search goes through.
    double typical = 0;
    for (const Drop& d : drops_) typical += d.radius / static_cast<double>(drops_.size());
    small_radius_ = 6 * typical;
    const double cell =
        std::max(std::sqrt(lx_ * ly_ / static_cast<double>(drops_.size() + 1)), small_radius_);
    cells_x_ = std::max(1, static_cast<int>(lx_ / cell));
    cells_y_ = std::max(1, static_cast<int>(ly_ / cell));
    cell_x_ = lx_ / cells_x_;
    cell_y_ = ly_ / cells_y_;
    head_.assign(static_cast<std::size_t>(cells_x_) * cells_y_, -1);
    next_.assign(drops_.size(), -1);
    for (int i = 0; i < static_cast<int>(drops_.size()); ++i) {
      if (drops_[i].film < 1) link(i);  // film is no disc that others meet
    }
  }

  int cell_of(const Drop& d) const {
    return std::min(static_cast<int>(d.y / cell_y_), cells_y_ - 1) * cells_x_ +
           std::min(static_cast<int>(d.x / cell_x_), cells_x_ - 1);
  }

  void link(int i) {
    if (drops_[i].radius > small_radius_) {
      large_.push_back(i);
      return;
    }
    int& head = head_[cell_of(drops_[i])];
    next_[i] = head;
    head = i;
  }

  void unlink(int i) {
    if (drops_[i].radius > small_radius_) {
      large_.erase(std::find(large_.begin(), large_.end(), i));
      return;
    }
    int* at = &head_[cell_of(drops_[i])];
    while (*at != i) at = &next_[*at];
    *at = next_[i];
  }

  double energy() const {
    double sum = 0;
    for (const Drop& d : drops_) sum += d.alive ? d.energy : 0;
    return sum;
  }

  Droplet reported(const Drop& d) const {
    Droplet out;
    out.x = d.x;
    out.y = d.y;
    out.volume = d.volume;
    out.energy = d.energy;
    out.film = d.film;
    if (d.bridge) {
      const double area = kPi * square(d.radius);
      out.state = DropletState::Bridge;
      out.radius = d.radius;
      out.height = d.volume / area;
      out.edge_gap = d.edge_gap;
      out.force = d.film < 1 ? (1 - d.film) * bridge_force(d) : 0;
    } else {
      const double size = std::cbrt(d.volume);
      out.state = d.film > 0 ? DropletState::Bridge : cap_state_;
      out.radius = cap_.footprint * size;
      out.height = cap_.height * size;
    }
    return out;
  }

  std::size_t pixel_of(double x, double y) const {
    const Grid& g = gap_.grid;
    return g.index(std::min(static_cast<int>(x / g.dx()), g.nx - 1),
                   std::min(static_cast<int>(y / g.dy()), g.ny - 1));
  }

  // Where the region of a source starts: its lowest level inside the disc.
  std::size_t seed_of(const FilmSource& source, const Drop& d) const {
    const Grid& g = gap_.grid;
    std::size_t best = pixel_of(d.x, d.y);
    const auto level = [&](std::size_t k) {
      const double ex = nearest_image(g.x(static_cast<int>(k % g.nx)) - d.x, lx_);
      const double ey = nearest_image(g.y(static_cast<int>(k / g.nx)) - d.y, ly_);
      return film_level(source, square(ex) + square(ey), gap_.value[k]);
    };
    double lowest = level(best);
    for_pixels(g, disc_of(d), [&](std::size_t k) {
      const double here = level(k);
      if (here < lowest) {
        lowest = here;
        best = k;
      }
    });
    return best;
  }

  // The film takes in every bridge whose disc and every cap whose centre it reaches.
  void add_film(Wetting& out) {
    std::vector<FilmSource> sources;
    std::vector<std::size_t> seeds;
    std::vector<int> owner(gap_.grid.size(), -1), of_source;
    for (int i = 0; i < static_cast<int>(drops_.size()); ++i) {
      const Drop& d = drops_[i];
      if (!d.alive) continue;
      if (d.film > 0) {
        sources.push_back({d.x, d.y, d.radius, d.edge_gap, d.volume, d.film});
        seeds.push_back(seed_of(sources.back(), d));
        of_source.push_back(i);
        continue;
      }
      owner[pixel_of(d.x, d.y)] = i;
      if (!d.bridge) continue;
      for_pixels(gap_.grid, disc_of(d), [&](std::size_t k) { owner[k] = i; });
    }
    struct Joined {
      int drop, source;
    };
    std::vector<Joined> joined;
    const FilmRegions films =
        grow_films(gap_, sources, seeds, water_, [&](std::size_t k, int source) {
          const int i = owner[k];
          if (i < 0 || drops_[i].film > 0) return 0.0;
          drops_[i].film = 1;
          joined.push_back({i, source});
          return drops_[i].volume;
        });
    out.status = WettingStatus::Film;
    double area = 0;
    for (const FilmRegion& region : films.regions) {
      if (region.full) out.status = WettingStatus::Flooded;
      ++out.bridges;
      out.bridge_volume += region.volume;
      out.capillary_force += region.share * region.force;
      out.retention += region.share * region.retention;
      area += region.share * region.area;
    }
    const auto add_disc = [&](const Drop& d, double share) {
      if (!d.bridge || share <= 0) return;
      out.capillary_force += share * bridge_force(d);
      out.retention += share * disc_retention(d);
      area += share * kPi * square(d.radius);
    };
    for (std::size_t s = 0; s < sources.size(); ++s) {
      add_disc(drops_[of_source[s]], 1 - sources[s].share);
    }
    for (const Joined& j : joined) {
      add_disc(drops_[j.drop], 1 - films.regions[films.of_source[j.source]].share);
    }
    out.wetted_fraction = area / gap_.grid.area();
    out.film.assign(owner.size(), FilmPixel::None);
    for (std::size_t k = 0; k < owner.size(); ++k) {
      if (films.source[k] == 0) continue;
      const FilmRegion& region = films.regions[films.of_source[films.source[k] - 1]];
      out.bridged[k] = 1;
      out.film[k] = region.share < 1 ? FilmPixel::OnItsWay : FilmPixel::Film;
    }
  }

  const Gap& gap_;
  GapTable table_;
  DropletOptions options_;
  WaterProperties water_;
  double gain_, cos_skin_;
  std::shared_ptr<const BridgeTable> exact_;
  double meniscus_ = 0;
  std::array<double, 4> tilt_terms_{};
  double rupture_ = 0;  // per volume^(1/3)
  bool metastable_ = false;
  CapShape cap_;
  DropletState cap_state_;
  double lx_, ly_;
  double reach_ = 0;
  std::vector<Drop> drops_;
  double wicked_ = 0;  // [m^3] in corners
  std::vector<int> members_;
  // Hash: drops up to small_radius_ by the cell of their centre, the others in one list.
  int cells_x_ = 1, cells_y_ = 1;
  double cell_x_ = 0, cell_y_ = 0, small_radius_ = 0;
  std::vector<int> head_, next_, large_;
  SettleReport report_;
};

}  // namespace

std::vector<DropletSeed> scatter_droplets(const Grid& grid, double volume,
                                          const DropletOptions& options, std::uint64_t seed,
                                          std::uint64_t index) {
  PAPILLA_CHECK(volume >= 0 && std::isfinite(volume), "water volume must be finite, not negative");
  if (volume == 0) return {};
  const int n =
      static_cast<int>(std::clamp(std::round(options.drops_per_volume * volume), 1.0, 1e6));
  RandomStream random(seed, "droplets", index);
  std::vector<DropletSeed> out(n);
  double sum = 0;
  for (DropletSeed& d : out) {
    d.x = random.uniform() * grid.lx;
    d.y = random.uniform() * grid.ly;
    d.volume = 1 - random.uniform();  // (0, 1]
    sum += d.volume;
  }
  for (DropletSeed& d : out) d.volume = volume * d.volume / sum;
  return out;
}

Wetting settle_droplets(const Gap& gap, const std::vector<DropletSeed>& droplets,
                        const WaterProperties& water, const DropletOptions& options,
                        SettleReport* report) {
  if (report) *report = {};
  double volume = 0, space = 0;
  for (const DropletSeed& d : droplets) volume += d.volume;
  if (volume == 0) {
    Wetting dry;
    dry.grid = gap.grid;
    return dry;
  }
  for (double h : gap.value) space += h;
  if (volume >= space * gap.grid.pixel_area()) return fill_threshold(gap, volume, water);
  Ensemble ensemble(gap, water, options);
  ensemble.start(droplets);
  ensemble.settle();
  if (report) *report = ensemble.report();
  return ensemble.result(volume);
}

Wetting settle_droplets(const Gap& gap, double volume, const WaterProperties& water,
                        const DropletOptions& options, std::uint64_t seed, std::uint64_t index,
                        SettleReport* report) {
  return settle_droplets(gap, scatter_droplets(gap.grid, volume, options, seed, index), water,
                         options, report);
}

Wetting rewet(const Wetting& wetting, const Gap& gap, const WaterProperties& water,
              const DropletOptions& options) {
  if (wetting.status == WettingStatus::Dry) return wetting;
  // Flooded, or threshold water.
  if (wetting.droplets.empty()) return fill_threshold(gap, wetting.volume, water);
  Ensemble ensemble(gap, water, options);
  ensemble.restore(wetting);
  return ensemble.result(wetting.volume);
}

DropletBand droplet_band(double water_per_area, double mean_gap, double bridge_share) {
  if (!(water_per_area > 0)) return {};
  DropletBand band;
  // Eq. capillary.19
  band.pull = 0.7 * square(1 - bridge_share) * -std::expm1(-water_per_area / 7e-9);
  // Eq. capillary.20
  band.capillary = mean_gap > 0 ? 1.5 / (1 + water_per_area / (0.01 * mean_gap)) : 0;
  return band;
}

Traction capillary_traction(const Wetting& wetting, const Gap& gap, const WaterProperties&) {
  const Grid& g = gap.grid;
  Traction out{g, std::vector<double>(g.size(), 0.0)};
  double rest = wetting.capillary_force;  // of the film
  for (const Droplet& d : wetting.droplets) {
    if (d.state != DropletState::Bridge || d.film > 0) continue;
    rest -= d.force;
    std::size_t count = 0;
    Ensemble::for_pixels(g, d, [&](std::size_t) { ++count; });
    if (count > 0) {
      const double pressure = d.force / (static_cast<double>(count) * g.pixel_area());
      Ensemble::for_pixels(g, d, [&](std::size_t k) { out.value[k] += pressure; });
    } else {
      const int ix = std::min(static_cast<int>(d.x / g.dx()), g.nx - 1);
      const int iy = std::min(static_cast<int>(d.y / g.dy()), g.ny - 1);
      out.value[g.index(ix, iy)] += d.force / g.pixel_area();
    }
  }
  double count = 0;
  for (FilmPixel pixel : wetting.film) count += pixel != FilmPixel::None;
  if (count > 0) {
    const double pressure = rest / (count * g.pixel_area());
    for (std::size_t k = 0; k < g.size(); ++k) {
      out.value[k] += wetting.film[k] != FilmPixel::None ? pressure : 0.0;
    }
  }
  return out;
}

}  // namespace papilla
