#include "rank/scores.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/constants.h"
#include "base/random.h"
#include "numerics/statistics.h"

namespace papilla::rank {
namespace {

constexpr int kDraws = 4000;  // of the orders

// Over the skins that both have.
std::vector<double> minus(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d(std::min(a.size(), b.size()));
  for (std::size_t k = 0; k < d.size(); ++k) d[k] = a[k] - b[k];
  return d;
}

// Adds what the first `count` samples move their mean by.
void add_moves(const std::vector<double>& samples, std::size_t count, double sign,
               std::vector<double>& to) {
  const std::vector<double> moves = error_moves(std::span(samples).first(count));
  for (std::size_t k = 0; k < count; ++k) to[k] += sign * moves[k];
}

}  // namespace

Interval Interval::moved(double by) const { return {value + by, low + by, high + by, parameters}; }

Interval interval_of(const std::vector<double>& samples, const StepSamples& steps) {
  const Estimate e = mean_estimate(samples);
  double half = samples.size() > 1
                    ? student_t_quantile(0.975, static_cast<int>(samples.size()) - 1) * e.se
                    : kInfinity;
  Interval out{e.value, 0, 0, std::nullopt};
  if (!steps.empty()) {
    out.parameters = step_error(steps);
    half = std::hypot(half, normal_quantile(0.975) * *out.parameters);
  }
  out.low = out.value - half;
  out.high = out.value + half;
  return out;
}

double unmet(const std::vector<std::vector<double>>& samples, std::size_t i) {
  std::size_t most = 0;
  for (const auto& s : samples) most = std::max(most, s.size());
  const auto own = static_cast<std::ptrdiff_t>(samples[i].size());
  double sum = 0;
  int count = 0;
  for (const auto& s : samples) {
    if (s.size() != most) continue;
    sum += mean_estimate(s).value -
           mean_estimate(std::vector<double>(s.begin(), s.begin() + own)).value;
    ++count;
  }
  return sum / count;
}

double Scores::mean(std::size_t i) const { return mean_estimate(skins[i]).value + unmet(skins, i); }

std::vector<std::size_t> Scores::order() const {
  std::vector<std::size_t> order(skins.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> means;
  for (std::size_t i = 0; i < skins.size(); ++i) means.push_back(mean(i));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return means[a] > means[b]; });
  // Neighbours stand as their paired difference says; it may go in circles, so not for ever.
  for (std::size_t pass = 0; pass < order.size(); ++pass) {
    bool swapped = false;
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      if (difference(order[i], order[i + 1]).value >= 0) continue;
      std::swap(order[i], order[i + 1]);
      swapped = true;
    }
    if (!swapped) break;
  }
  return order;
}

Interval Scores::difference(std::size_t a, std::size_t b) const {
  return interval_of(minus(skins[a], skins[b]), step_difference(a, b));
}

bool Scores::decided(std::size_t a, std::size_t b) const {
  const Interval d = difference(a, b);
  return d.low > 0 || d.high < 0;
}

bool Scores::equal(std::size_t a, std::size_t b) const {
  const auto nothing = [](const std::vector<double>& samples) {
    return std::all_of(samples.begin(), samples.end(), [](double v) { return v == 0; });
  };
  const StepSamples moves = step_difference(a, b);
  return nothing(minus(skins[a], skins[b])) && std::all_of(moves.begin(), moves.end(), nothing);
}

// Member by member, each with what its own move adds to the lead. Eq. ranking.8
double Scores::probability_over_members(std::size_t a, std::size_t b) const {
  const std::vector<double> paired = minus(skins[a], skins[b]);
  const Estimate e = mean_estimate(paired);
  const StepSamples moves = step_difference(a, b);
  const double sure = meant_part(moves);
  const double freedom = static_cast<double>(paired.size()) - 1;
  double out = 0;
  for (std::size_t m = 0; m < moves.size(); ++m) {
    const double w = member_weights[m],
                 lead = e.value + sure * mean_estimate(moves[m]).value / std::sqrt(w);
    out += w * (e.se > 0 ? student_t_cdf(lead / e.se, freedom) : lead > 0 ? 1 : lead < 0 ? 0 : 0.5);
  }
  return out;
}

double Scores::probability_ahead(std::size_t a, std::size_t b) const {
  if (!member_weights.empty()) return probability_over_members(a, b);
  const std::vector<double> paired = minus(skins[a], skins[b]);
  const Estimate e = mean_estimate(paired);
  const double se = std::hypot(e.se, step_error(step_difference(a, b)));
  if (!(se > 0)) return e.value > 0 ? 1 : e.value < 0 ? 0 : 0.5;
  // Few skins know their own scatter badly; the finger's part is as good as normal.
  const double freedom = static_cast<double>(paired.size()) - 1;
  return e.se > 0 ? student_t_cdf(e.value / se, freedom * std::pow(se / e.se, 4))
                  : normal_cdf(e.value / se);
}

std::vector<double> Scores::probabilities(std::uint64_t index) const {
  const std::size_t m = skins.size();
  const std::vector<std::vector<double>> scatter = skin_moves(), moves = step_moves();
  std::vector<double> means, best(m, 0);
  for (std::size_t i = 0; i < m; ++i) means.push_back(mean(i));
  RandomStream random(1, "ranking", index);
  std::vector<double> z(scatter.front().size());
  std::vector<double> finger(moves.empty() ? 0 : moves.front().size());
  std::vector<std::size_t> winners;
  // As Student's distribution of the two in front: few skins know their own scatter badly.
  const std::vector<std::size_t> front = order();
  const int freedom =
      static_cast<int>(std::min(skins[front[0]].size(), skins[front[1 % m]].size())) - 1;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (double& v : z) v = random.normal();
    if (member_weights.empty()) {
      for (double& v : finger) v = random.normal();
    } else {  // one member a draw; its move is its step over the root of its weight
      std::fill(finger.begin(), finger.end(), 0.0);
      double left = random.uniform();
      std::size_t member = 0;
      while (member + 1 < finger.size() && left >= member_weights[member])
        left -= member_weights[member++];
      finger[member] = 1 / std::sqrt(member_weights[member]);
    }
    double squares = 0;
    for (int k = 0; k < freedom; ++k) squares += square(random.normal());
    const double wider = freedom > 0 ? std::sqrt(freedom / squares) : 1;
    double highest = -kInfinity;
    for (std::size_t i = 0; i < m; ++i) {
      double v = means[i];
      for (std::size_t k = 0; k < z.size(); ++k) v += wider * scatter[i][k] * z[k];
      for (std::size_t k = 0; k < finger.size(); ++k) v += moves[i][k] * finger[k];
      if (v < highest) continue;
      if (v > highest) winners.clear();
      highest = v;
      winners.push_back(i);
    }
    for (std::size_t i : winners)  // equal designs share the win
      best[i] += 1.0 / kDraws / static_cast<double>(winners.size());
  }
  return best;
}

StepSamples Scores::step_difference(std::size_t a, std::size_t b) const {
  StepSamples out;
  for (std::size_t k = 0; !steps.empty() && k < steps[a].size(); ++k)
    out.push_back(minus(steps[a][k], steps[b][k]));
  return out;
}

// [candidate][direction] What a step of the finger does to a score beyond the mean over candidates,
// scaled to what is left of all of them without the scatter of the skins.
std::vector<std::vector<double>> Scores::step_moves() const {
  std::vector<std::vector<double>> out;
  double sure = 0, all = 0;
  for (const StepSamples& own : steps) {
    StepSamples beyond = own;
    for (std::size_t k = 0; k < beyond.size(); ++k) {
      for (std::size_t s = 0; s < beyond[k].size(); ++s) {
        for (const StepSamples& other : steps)
          beyond[k][s] -= other[k][s] / static_cast<double>(steps.size());
      }
    }
    out.emplace_back();
    for (const std::vector<double>& direction : beyond) {
      out.back().push_back(mean_estimate(direction).value);
      all += square(out.back().back());
    }
    sure += square(step_error(beyond));
  }
  for (std::vector<double>& moves : out) {
    for (double& v : moves) v *= all > 0 ? std::sqrt(std::min(1.0, sure / all)) : 0;
  }
  return out;
}
// [candidate][skin] A draw of the means is a random combination of the centred samples, a number
// per skin: those that two scores have in common move both. Eq. ranking.3
std::vector<std::vector<double>> Scores::skin_moves() const {
  std::size_t n = 0;
  for (const auto& s : skins) n = std::max(n, s.size());
  // Values of those that met all skins: what carries the others to all, Eq. ranking.6.
  std::vector<double> carrier(n, 0);
  const auto met_all = static_cast<double>(
      std::count_if(skins.begin(), skins.end(), [&](const auto& s) { return s.size() == n; }));
  for (const auto& s : skins) {
    for (std::size_t k = 0; s.size() == n && k < n; ++k) carrier[k] += s[k] / met_all;
  }
  std::vector<std::vector<double>> out;
  for (const auto& s : skins) {
    std::vector<double>& centred = out.emplace_back(n, 0);
    add_moves(s, s.size(), 1, centred);
    if (s.size() == n) continue;
    add_moves(carrier, n, 1, centred);
    add_moves(carrier, s.size(), -1, centred);
  }
  return out;
}

}  // namespace papilla::rank
