#include "forward/balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "forward/equilibrium.h"
#include "forward/scene_terms.h"
#include "physics/persson/patches.h"

namespace papilla::forward {
namespace {

constexpr std::array kForces{&OpenGapForces::pull, &OpenGapForces::capillary,
                             &OpenGapForces::retention, &OpenGapForces::capillary_on,
                             &OpenGapForces::retention_on};

// The forces of the open gaps over the pressure: through those of the table, continuous with their
// slopes and without overshoot (Fritsch and Carlson 1980) in the logarithm of the pressure.
class ForcesOverPressure {
 public:
  ForcesOverPressure(const RidgeGaps& gaps, std::vector<OpenGapForces> forces)
      : forces_(std::move(forces)) {
    for (const double pressure : gaps.pressure) x_.push_back(std::log(pressure));
    slope_.resize(x_.size());
    for (const auto member : kForces) {
      for (std::size_t i = 0; i < x_.size(); ++i) slope_[i].*member = slope(i, member);
    }
  }

  double lowest() const { return std::exp(x_.front()); }
  double highest() const { return std::exp(x_.back()); }

  OpenGapForces at(double pressure) const {
    const double x = std::clamp(std::log(pressure), x_.front(), x_.back());
    std::size_t i = 0;
    while (i + 2 < x_.size() && x > x_[i + 1]) ++i;
    const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, s = 1 - t;
    OpenGapForces out;
    for (const auto member : kForces) {
      out.*member = s * s * (1 + 2 * t) * forces_[i].*member +
                    t * t * (1 + 2 * s) * forces_[i + 1].*member +
                    h * s * t * (s * slope_[i].*member - t * slope_[i + 1].*member);
    }
    return out;
  }

 private:
  double secant(std::size_t i, double OpenGapForces::*member) const {
    return (forces_[i + 1].*member - forces_[i].*member) / (x_[i + 1] - x_[i]);
  }
  double slope(std::size_t i, double OpenGapForces::*member) const {
    if (i == 0) return secant(0, member);
    if (i + 1 == x_.size()) return secant(i - 1, member);
    const double a = secant(i - 1, member), b = secant(i, member);
    if (!(a * b > 0)) return 0;
    const double most = 3 * std::min(std::abs(a), std::abs(b));
    return std::clamp(0.5 * (a + b), -most, most);
  }

  std::vector<double> x_;  // ln of the pressure
  std::vector<OpenGapForces> forces_, slope_;
};

struct Rest {
  double pressure = 0, stability = 1;
  bool found = false;
  // By how much the attraction may grow until it is lost at a fold; below 1: lost already, this one
  // lies beyond.
  double to_fold = kInfinity;
};

// The least pressure p = nominal + attraction(p) [Pa]. Eq. coupling.10
template <class Attraction>
Rest at_rest(double nominal, double lowest, double highest, const Attraction& attraction) {
  constexpr int kSteps = 400;
  const auto excess = [&](double p) { return nominal + attraction(p) - p; };
  Rest out{.pressure = nominal};
  double low = nominal, high = nominal;
  const double first = excess(nominal);
  if (first == 0) {
    out.found = true;
  } else if (first < 0) {  // water that pushes
    low = std::min(lowest, nominal);
    out.found = true;
  } else {
    // `grown` is the attraction, in its own units, that has its rest at a pressure: it rises along
    // the branch that begins without attraction, to the fold.
    const double ratio = std::pow(highest / nominal, 1.0 / kSteps);
    double grown = 0;
    for (double p = nominal * ratio; p <= highest * (1 + 1e-12); p *= ratio) {
      const double pulls = attraction(p), here = pulls > 0 ? (p - nominal) / pulls : kInfinity;
      if (!out.found) {
        low = high;
        high = p;
        out.found = here >= 1;
      }
      if (here < grown && out.to_fold == kInfinity) out.to_fold = grown;
      grown = here;
    }
  }
  if (!out.found) return out;
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) > 0 ? low : high) = middle;
  }
  out.pressure = 0.5 * (low + high);
  const double step = 1e-4 * out.pressure;
  out.stability = (excess(out.pressure - step) - excess(out.pressure + step)) / (2 * step);
  return out;
}

FarWater far_water(const Scene& scene, double relative_humidity) {
  const SkinWater& water = scene.finger.water;
  return {water.volume_per_area(relative_humidity), water.drops_per_um3 * 1e18,
          water_properties(scene, scene.surface.contact_angle),
          water_properties(scene, driven_contact_angle(scene, relative_humidity))};
}

// Share of the area that touches in a patch that just touches.
constexpr double kJustTouches = 2e-4;

std::vector<OpenGapForces> forces_at(const Scene& scene, double relative_humidity, double nominal,
                                     const RidgeGaps& gaps, const SurfaceLevels& levels) {
  const FieldProblem field = field_problem(scene, relative_humidity);
  const double rms = scene.finger.skin.rms * scene.finger.skin.relief_factor();
  const MeanField& all = gaps.field;
  const double contact = all.area(nominal) / all.area(nominal, gaps.q_patch);
  const PowerSpectrum& spectrum = all.spectrum();
  const double slope = std::sqrt(spectrum.moment(2, gaps.q_patch, spectrum.highest()));
  const HungWater water(resting(levels, rms, kJustTouches), rms,
                        touching_gap(rms, slope, square(2 * kPi / gaps.q_patch)),
                        far_water(scene, relative_humidity));
  const SurfaceLevels at_rest = resting(levels, rms, contact);
  std::vector<OpenGapForces> out;
  for (std::size_t i = 0; i < gaps.pressure.size(); ++i) {
    OpenGapForces forces;
    forces.pull = open_gap_pull(gaps.open[i], at_rest, field);
    water.add(gaps.hangs[i], forces);
    if (!capillary_off_counts(scene)) forces.capillary = 0;
    for (const auto member : kForces) forces.*member *= scene.finger.macro.far_gaps;
    out.push_back(forces);
  }
  return out;
}

// Share of the ridges in patches in contact where the rings are pressed by so much [Pa]: T of Eq.
// coupling.10.
double share_touching(const std::vector<NominalPressure>& rings, const std::vector<double>& pressed,
                      double measure) {
  double out = 0;
  for (std::size_t i = 0; i < rings.size(); ++i)
    out += rings[i].share * std::erf(pressed[i] / std::sqrt(measure));
  return out;
}

// Shares of patches that carry the rings' pressures, and how much harder each presses: Persson's
// share touches, the rest of the load presses harder on it.
struct Carrying {
  std::vector<double> share;
  double press = 1, touching = 0;
};
Carrying carrying(const PatchPressures& patches, const std::vector<NominalPressure>& rings,
                  const std::vector<double>& pressed, double measure) {
  Carrying out{patches.share_at(pressed), 1, share_touching(rings, pressed, measure)};
  out.press = std::accumulate(out.share.begin(), out.share.end(), 0.0) / out.touching;
  for (double& share : out.share) share /= out.press;
  return out;
}

}  // namespace

Balance solve_balance(const Scene& scene, double q_patch, double relative_humidity, int nodes,
                      const SurfaceLevels& levels) {
  const Finger& finger = scene.finger;
  Balance out;
  out.nominal = ridge_load(finger.macro, finger.load, relative_humidity).mean_pressure;
  if (!(out.nominal > 0)) {
    out.pressures = {0};
    out.shares = {{1}, {1}, {1}};
    return out;
  }
  const auto gaps = ridge_gaps(finger, q_patch, relative_humidity, out.nominal);
  const double measure = gaps->field.stress_measure(q_patch);
  const ForcesOverPressure forces(*gaps,
                                  forces_at(scene, relative_humidity, out.nominal, *gaps, levels));

  std::vector<NominalPressure> rings;
  for (const PressureRing& ring : rings_of(scene.model, finger.macro))
    rings.push_back({ring.over_mean * out.nominal, ring.share});
  std::vector<double> loaded, off, on;
  bool lost = false;  // beyond the pressures of the table
  for (const NominalPressure& ring : rings) {
    const auto rest = [&](double (OpenGapForces::*attraction)() const) {
      return at_rest(ring.pressure, forces.lowest(), forces.highest(),
                     [&](double p) { return (forces.at(p).*attraction)(); });
    };
    const Rest before = rest(&OpenGapForces::off), under = rest(&OpenGapForces::on);
    lost = lost || !before.found || !under.found;
    out.to_fold = std::min(out.to_fold, std::sqrt(under.to_fold));
    out.pull_in_undriven = out.pull_in_undriven || !before.found || before.to_fold < 1;
    out.stability = std::min({out.stability, before.stability, under.stability});
    loaded.push_back(ring.pressure);
    off.push_back(before.pressure);
    on.push_back(under.pressure);
  }
  if (lost) {
    out.pull_in = true;
    for (std::size_t i = 0; i < rings.size(); ++i) off[i] = on[i] = rings[i].pressure;
    out.stability = out.to_fold = 0;
  }
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const double share = rings[i].share;
    out.pressed_off += share * off[i];
    out.pressed_on += share * on[i];
    if (lost) continue;
    const OpenGapForces before = forces.at(off[i]), under = forces.at(on[i]);
    out.far.capillary += share * before.capillary;
    out.far.retention += share * before.retention;
    out.far.pull += share * under.pull;
    out.far.capillary_on += share * under.capillary_on;
    out.far.retention_on += share * under.retention_on;
  }

  const PatchPressures patches(measure, rings, nodes);
  out.pressures = patches.pressure();
  const Carrying before = carrying(patches, rings, off, measure);
  const Carrying under = carrying(patches, rings, on, measure);
  out.shares = {patches.share(), before.share, under.share, before.press, under.press};
  out.touching_off = before.touching;
  out.touching_on = under.touching;
  // What the load alone brings into contact no attraction has closed.
  const double by_load = share_touching(rings, loaded, measure);
  out.pull_in = out.pull_in || out.to_fold < 1 || is_pulled_shut(1, by_load, out.touching_on);
  out.pull_in_undriven = out.pull_in_undriven || is_pulled_shut(1, by_load, out.touching_off);
  return out;
}

}  // namespace papilla::forward
