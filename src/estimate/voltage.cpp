#include "estimate/voltage.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "forward/electric_path.h"
#include "numerics/statistics.h"
#include "physics/electrostatics/breakdown.h"

namespace papilla::estimate {
namespace {

constexpr double kLargestAmplitude = 1e5;     // [V] of the key drive.amplitude
constexpr double kAmplitudeTolerance = 1e-3;  // of the amplitude
constexpr double kNextToNone = 1e-3;          // [V]
constexpr int kMaxEvaluations = 40;

// No equilibrium at that voltage, or none that friction is known for.
bool beyond(const ResponsePoint& point) {
  return point.status.pull_in() || point.status.trouble == Trouble::FullContact ||
         point.status.trouble == Trouble::PassesUsedUp;
}

// Searches one target at one humidity.
class VoltageSearch {
 public:
  VoltageSearch(const UndrivenPatches& patches, double target, double limit, VoltageEnd limited_by)
      : patches_(patches), limit_(limit), limited_by_(limited_by) {
    answer_.target = target;
    answer_.limit = limit;
  }

  VoltageAnswer run(double guess, bool areas) {
    if (limit_ <= 0) {
      answer_.end = VoltageEnd::NoDielectric;
      return answer_;
    }
    double found = root(Estimator::Load, std::min(guess, limit_));
    // Where the load law ends, by its own full contact or pull-in, solved areas may go on.
    if (areas && answer_.reached())
      found = root(Estimator::Area, found > 0 ? found : answer_.limit);
    if (!answer_.reached()) return answer_;
    if (found > 0) {
      take(found);
    } else {
      answer_.end = blocked_.sound() ? limited_by_ : VoltageEnd::ModelEnds;
      answer_.model = blocked_;
    }
    return answer_;
  }

 private:
  struct Sample {
    double amplitude, modulation;
  };

  // 0: below the target up to the limit of the answer, which is that of film or source, or where
  // the model ends.
  double root(Estimator estimator, double guess) {
    low_ = {0, 0};
    high_ = {};
    blocked_ = {};
    double ceiling = limit_, v = guess;
    answer_.limit = limit_;
    answer_.modulation = 0;
    for (;;) {
      if (++answer_.evaluations > kMaxEvaluations) {
        answer_.end = VoltageEnd::NotConverged;
        return 0;
      }
      last_ = patches_.drive(v, estimator);
      const ResponsePoint& point = last_.points.front();
      const double m = point.modulation.value;
      if (point.status.trouble == Trouble::ContactUnsolved ||
          point.status.trouble == Trouble::FieldUnsolved || point.status.pull_in_undriven()) {
        answer_.end = VoltageEnd::Unsound;
        answer_.model = point.status;
        return 0;
      }
      if (beyond(point)) {
        blocked_ = point.status;
        ceiling = v;
        if (ceiling - low_.amplitude < 5 * kAmplitudeTolerance * ceiling) {
          answer_.limit = ceiling;
          return 0;
        }
        v = low_.amplitude > 0 ? std::sqrt(low_.amplitude * ceiling) : 0.5 * ceiling;
        continue;
      }
      answer_.modulation = std::max(answer_.modulation, std::min(m, answer_.target));
      const bool above = m >= answer_.target;
      const Sample sample{v, m};
      const Sample previous = above ? high_ : low_;
      (above ? high_ : low_) = sample;
      if (!above && (v >= ceiling ||
                     (!blocked_.sound() && ceiling - v < 5 * kAmplitudeTolerance * ceiling))) {
        answer_.limit = ceiling;
        return 0;
      }
      if (above && v < kNextToNone) return v;
      const double next = propose(above, previous, ceiling);
      if (std::abs(next - v) < kAmplitudeTolerance * v && (high_.amplitude > 0 || next < ceiling)) {
        return v;
      }
      v = next;
    }
  }

  // Modulation goes about with the square of the voltage.
  double propose(bool above, const Sample& previous, double ceiling) const {
    const Sample& here = above ? high_ : low_;
    double power = 2;
    const Sample other =
        low_.amplitude > 0 && high_.amplitude > 0 ? (above ? low_ : high_) : previous;
    if (other.amplitude > 0 && other.modulation > 0 && here.modulation > 0 &&
        other.amplitude != here.amplitude) {
      power = std::clamp(
          std::log(here.modulation / other.modulation) / std::log(here.amplitude / other.amplitude),
          0.25, 8.0);
    }
    double next = here.modulation > 0
                      ? here.amplitude * std::pow(answer_.target / here.modulation, 1 / power)
                      : 4 * here.amplitude;
    next = std::clamp(next, 0.05 * here.amplitude, 20 * here.amplitude);
    if (low_.amplitude > 0 && high_.amplitude > 0) {
      // Keeps the bracket shrinking from both sides.
      const double width = high_.amplitude - low_.amplitude;
      next = std::clamp(next, low_.amplitude + 0.02 * width, high_.amplitude - 0.02 * width);
    }
    return std::min(next, blocked_.sound() ? ceiling : 0.5 * (ceiling + here.amplitude));
  }

  // The answer at what was driven last. What moves the modulation there, an error or a skin that is
  // left out, moves the amplitude by that over the slope of the last two samples. Eq. metrics.6
  void take(double v) {
    const ResponsePoint& point = last_.points.front();
    double power = 2;
    if (low_.amplitude > 0 && low_.modulation > 0 && high_.amplitude > low_.amplitude &&
        high_.modulation > low_.modulation) {
      power =
          std::log(high_.modulation / low_.modulation) / std::log(high_.amplitude / low_.amplitude);
    }
    const double scale = v / (std::max(power, 0.25) * answer_.target);  // dV/dm [V]
    ErrorParts e = point.modulation.parts;
    e.sampling *= scale;
    for (const ErrorOrigin& origin : kErrorOrigins) {
      if (auto& part = e.*origin.part) *part *= scale;
    }
    e.solver = std::hypot(e.solver.value_or(0), kAmplitudeTolerance * v);
    // A skin without which there is more modulation lowers the amplitude.
    for (const auto& others : last_.without)
      answer_.without.push_back(v -
                                scale * (others.front().modulation.value - point.modulation.value));
    if (answer_.without.size() > 1)
      e.sampling = mean_estimate(jackknife_samples(v, answer_.without)).se;
    answer_.amplitude = {v, e};
    answer_.modulation = point.modulation.value;
    answer_.field_correction = point.field_correction;
    answer_.field_error = point.field_error;
  }

  const UndrivenPatches& patches_;
  double limit_;           // of film or source [V]
  VoltageEnd limited_by_;  // which of them
  VoltageAnswer answer_;
  Resampled last_;  // one humidity
  Sample low_{}, high_{};
  ModelStatus blocked_;  // what the model said above the ceiling
};

// The correction of the field falls with the voltage, by 10 to 25 % from 1 to 200 V: an answer that
// was found with that of another amplitude is sought again with its own.
VoltageAnswer voltage_with_its_field(UndrivenPatches& patches, double target, double limit,
                                     VoltageEnd limited_by, double guess, bool areas) {
  constexpr int kMostTimes = 4;
  constexpr double kSameField = 0.05;  // of the amplitude: a percent of the pull
  int evaluations = 0;
  for (int times = 1;; ++times) {
    VoltageAnswer answer = VoltageSearch(patches, target, limit, limited_by).run(guess, areas);
    answer.evaluations = evaluations += answer.evaluations;
    const double at = answer.reached() ? answer.amplitude.value : answer.limit;
    const double corrected_at = patches.corrected_at();
    if (times == kMostTimes || !(at > 0) || corrected_at == 0 ||
        std::abs(at - corrected_at) < kSameField * at) {
      return answer;
    }
    patches.correct_at(at);
    guess = at;
  }
}

}  // namespace

double breakdown_voltage(const Surface& surface, const Texture& texture, const Drive& drive) {
  const double radius = surface.electrode_edge_radius;
  const TextureFacts known = facts(texture);
  const Relief& relief = known.relief;
  // Below a planar layer the electrode is flat: it has no edges.
  const bool edges = radius > 0 && relief.present && surface.carrying_layer() < 0;
  const FilmGround ground{.deepest = relief.planes ? std::max(0.0, -relief.planes->low) : 0,
                          .height = relief.height().value_or(kInfinity),
                          .steepest = known.steepest.value_or(0)};
  return dielectric_margin(surface.thinnest_layers(ground), 1, edges ? radius : kInfinity,
                           film_divider(surface, drive));  // 1 V
}

double bridged_margin(const Surface& surface, const Texture& texture, const Drive& drive,
                      double amplitude) {
  constexpr double kInsulates = 0.01;  // corner frequency over the drive's
  const bool leaks = drive.waveform == Waveform::Dc ||
                     std::any_of(surface.dielectric.begin(), surface.dielectric.end(),
                                 [&](const FilmDielectric& layer) {
                                   return layer.corner_frequency() > kInsulates * drive.frequency;
                                 });
  if (leaks || amplitude <= 0) return kInfinity;
  return breakdown_voltage(surface, texture, drive) / amplitude;
}

void set_bridged_margins(Response& response, const Scene& scene, const Texture& texture) {
  for (ResponsePoint& p : response.points)
    p.bridged_margin = bridged_margin(scene.surface, texture, scene.drive, p.source_voltage);
}

double amplitude_limit(const Scene& scene, const Texture& texture) {
  const double source = scene.drive.source_compliance;
  return std::min({breakdown_voltage(scene.surface, texture, scene.drive),
                   source > 0 ? source : kInfinity, kLargestAmplitude});
}

void add_voltages(Response& response, const Scene& scene, const Texture& texture,
                  const Fidelity& fidelity, std::span<const double> targets) {
  const double limit = amplitude_limit(scene, texture);
  const bool source = limit == scene.drive.source_compliance;
  for (ResponsePoint& point : response.points) {
    if (!scene.touch.conducts) {
      for (double target : targets) {
        VoltageAnswer none;
        none.target = target;
        none.end = VoltageEnd::NoField;
        point.voltages.push_back(none);
      }
      continue;
    }
    Scene one = scene;
    one.environment.relative_humidity = {point.relative_humidity};
    one.environment.weights.clear();
    UndrivenPatches patches(one, texture, fidelity);
    double guess = scene.drive.amplitude > 0 ? scene.drive.amplitude : 100;
    for (double target : targets) {
      PAPILLA_CHECK(target > 0, "a modulation above 0");
      point.voltages.push_back(voltage_with_its_field(
          patches, target, limit, source ? VoltageEnd::SourceEnds : VoltageEnd::Breakdown, guess,
          fidelity.estimator == Estimator::Area));
      if (point.voltages.back().reached()) guess = point.voltages.back().amplitude.value;
    }
  }
}

}  // namespace papilla::estimate
