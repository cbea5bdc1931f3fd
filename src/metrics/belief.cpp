// Numbers over the members of a belief. Eq. accuracy.15
#include <algorithm>
#include <cmath>
#include <utility>

#include "metrics/metrics.h"
#include "numerics/statistics.h"

namespace papilla::metrics {
namespace {

std::optional<RunReading> reading(const Resampled& run, const Number& number) {
  RunReading out;
  const auto all = number(run.points);
  if (!all || !std::isfinite(*all)) return std::nullopt;
  out.all = *all;
  for (const auto& points : run.without) {
    const auto one = number(points);
    if (!one || !std::isfinite(*one)) return std::nullopt;
    out.without.push_back(*one);
  }
  return out;
}

// The values less what of their distance from their mean is scatter of the skins. Eq. accuracy.18
std::vector<double> meant(const BeliefValues& belief) {
  const double mean = weighted_mean(belief.values, belief.weights);
  const double part = meant_part(belief.moves);
  std::vector<double> out = belief.values;
  for (double& v : out) v = mean + part * (v - mean);
  return out;
}

}  // namespace

// Of a quantity that is a size, and of every spread. The capillary force may push or pull.
bool keeps_sign(Summary summary, const Metric& metric) {
  const auto* quantity = std::get_if<QuantityMetric>(&metric);
  return is_spread(summary) ||
         (quantity && quantity->quantity != &PointQuantities::capillary_force);
}

double moved(double value, double own, double there, bool keeps_sign) {
  if (!std::isfinite(own) || !std::isfinite(there)) return there;  // no field, no film
  constexpr double kMost = 2;
  // Two readings of 0 agree: the number is the member's.
  const bool in_proportion = keeps_sign && value >= 0 && own >= 0 && (value > 0 || own > 0);
  return value + (in_proportion ? std::min(value / own, kMost) : 1) * (there - own);
}

double BeliefValues::quantile(double p) const {
  return weighted_quantile(meant(*this), weights, p);
}

std::optional<MemberReadings> member_readings(const BeliefRuns& runs, const Number& number) {
  if (runs.members.empty()) return std::nullopt;
  auto own = reading(runs.own, number);
  if (!own) return std::nullopt;
  MemberReadings out{{}, {}, *std::move(own)};
  for (const BeliefRun& m : runs.members) {
    auto there = reading(m.run, number);
    if (!there || there->without.size() != out.own.without.size()) return std::nullopt;
    out.weights.push_back(m.weight);
    out.members.push_back(*std::move(there));
  }
  return out;
}

BeliefValues belief_values(const MemberReadings& readings, double value, bool keeps_sign) {
  const RunReading& own = readings.own;
  BeliefValues out{readings.weights, {}, {}};
  StepSamples samples;
  for (const RunReading& there : readings.members) {
    std::vector<double> without;
    for (std::size_t k = 0; k < own.without.size(); ++k)
      without.push_back(moved(value, own.without[k], there.without[k], keeps_sign));
    out.values.push_back(moved(value, own.all, there.all, keeps_sign));
    samples.push_back(jackknife_samples(out.values.back(), without));
  }
  out.moves = moves_from_mean(out.weights, std::move(samples));
  return out;
}

std::optional<BeliefValues> belief_values(const BeliefRuns& runs, const Number& number,
                                          std::optional<double> value, bool keeps_sign) {
  const auto readings = member_readings(runs, number);
  if (!readings) return std::nullopt;
  return belief_values(*readings, value.value_or(readings->own.all), keeps_sign);
}

std::optional<BeliefValues> belief_values(Summary summary, const Metric& metric,
                                          const Response& response) {
  const auto value = summary_of_points(summary, metric, response.points);
  if (!value) return std::nullopt;
  return belief_values(
      response.belief,
      [&](const std::vector<ResponsePoint>& points) {
        return summary_of_points(summary, metric, points);
      },
      value, keeps_sign(summary, metric));
}

std::optional<BeliefValues> belief_values_at(std::size_t point, const Metric& metric,
                                             const Response& response) {
  const Number number = [&](const std::vector<ResponsePoint>& points) -> std::optional<double> {
    const auto m = metric_at(metric, points.at(point));
    return m ? std::optional(m->value) : std::nullopt;
  };
  const auto value = number(response.points);
  if (!value) return std::nullopt;
  return belief_values(response.belief, number, value, keeps_sign(Summary::Mean, metric));
}

std::optional<BeliefDifference> belief_difference(const BeliefValues& first,
                                                  const BeliefValues& second) {
  if (first.weights != second.weights || first.moves.front().size() != second.moves.front().size())
    return std::nullopt;
  BeliefValues both = first;
  for (std::size_t m = 0; m < both.values.size(); ++m) {
    for (std::size_t k = 0; k < both.moves[m].size(); ++k) both.moves[m][k] -= second.moves[m][k];
    both.values[m] -= second.values[m];
  }
  BeliefDifference out{both.deviation(), 0, 0, 0};
  both.values = meant(both);
  double all = 0;  // the weights sum to 1 but for their last digits
  for (std::size_t m = 0; m < both.values.size(); ++m) {
    out.above += first.weights[m] * (both.values[m] > 0 ? 1 : both.values[m] < 0 ? 0 : 0.5);
    all += first.weights[m];
  }
  out.above /= all;
  out.low = weighted_quantile(both.values, first.weights, 0.025);
  out.high = weighted_quantile(both.values, first.weights, 0.975);
  return out;
}

StepSamples ModelReadings::moves(double value, bool keeps_sign) const {
  return belief.members.empty() ? steps : belief_values(belief, value, keeps_sign).moves;
}

ModelReadings model_readings(const Response& response, const Number& number) {
  if (response.belief.members.empty())
    return {step_samples(response.parameters.steps, number).value_or(StepSamples{}), {}};
  return {{}, member_readings(response.belief, number).value_or(MemberReadings{})};
}

}  // namespace papilla::metrics
