#include "lab/sliding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "numerics/statistics.h"

namespace papilla::lab {
namespace {

// Of the largest normal force: the finger touches.
constexpr double kTouches = 0.2;
// Of the usual speed: the slide moves. Of the plateau: sliding has begun; the force is steady.
constexpr double kMoves = 0.5, kOnset = 0.9, kSteady = 0.15;
// Of a stroke: what follows the onset and precedes the end, and is not steady yet or any more.
constexpr double kAfterOnset = 0.1, kBeforeEnd = 0.05;
// Of a stroke: a state of the drive that lasts less may be its run-up alone.
constexpr double kShortState = 2 * kAfterOnset;
// Samples of a stroke; less do not show a plateau.
constexpr std::size_t kFewestOfStroke = 40;
// Samples that a median is taken over, as many as are wanted for three digits.
constexpr std::size_t kMedianSamples = 4001;
// The mean that tells whether the drive is on is over the record's length by this many samples.
constexpr std::size_t kDriveWindows = 2000;
// Share of its peak voltage at which the drive is on.
constexpr double kOn = 0.4;
// A slip: a fall by this share of the plateau, or so many times the noise, in 1/200 of a stroke.
constexpr double kSlipShare = 0.05, kSlipNoise = 8, kSlipTime = 1.0 / 200;
// Steps of time that differ by more than this factor from the usual one are a gap.
constexpr double kGap = 1.5;

double thinned_quantile(const std::vector<double>& values, Span span, double p) {
  std::vector<double> some;
  const std::size_t step = std::max<std::size_t>(1, span.size() / kMedianSamples);
  for (std::size_t i = span.begin; i < span.end; i += step) some.push_back(values[i]);
  return some.empty() ? 0 : quantile(std::move(some), p);
}

// Of all values: those that repeat with their sampling, as a carrier does, are not thinned.
double ranked(std::vector<double> values, double p) {
  const auto at = values.begin() + static_cast<long>(p * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Running mean over 2 half + 1 samples.
std::vector<double> smoothed(const std::vector<double>& values, std::size_t half) {
  std::vector<double> sums(values.size() + 1, 0), out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t from = i > half ? i - half : 0, to = std::min(values.size(), i + half + 1);
    out[i] = (sums[to] - sums[from]) / static_cast<double>(to - from);
  }
  return out;
}

class Finder {
 public:
  explicit Finder(const Trace& trace) : trace_(trace) {}

  Sliding find() {
    sampling();
    drive();
    strokes();
    find_directions();
    for (Stroke& s : out_.strokes) judge(s);
    tell();
    return std::move(out_);
  }

 private:
  Span whole() const { return {0, trace_.size()}; }

  void sampling() {
    std::vector<double> steps(trace_.size() - 1);
    for (std::size_t i = 0; i + 1 < trace_.size(); ++i)
      steps[i] = trace_.time[i + 1] - trace_.time[i];
    const double usual = thinned_quantile(steps, {0, steps.size()}, 0.5);
    out_.rate = 1 / usual;
    std::size_t gaps = 0;
    double longest = 0;
    for (const double s : steps) {
      gaps += s > kGap * usual;
      longest = std::max(longest, s);
    }
    if (gaps > 0)
      out_.notes.push_back(fmt::format(
          "{} in the sampling of {} Hz, the longest of {} s: means are over samples, not over time",
          counted(static_cast<long long>(gaps), "gap"), significant(out_.rate, 3),
          significant(longest, 2)));
  }

  // The drive is on where the root mean square of the voltage over a short while is near that of
  // its highest; a carrier that the sampling does not resolve keeps that mean.
  void drive() {
    if (trace_.voltage.empty()) return;
    std::vector<double> squares(trace_.size());
    for (std::size_t i = 0; i < squares.size(); ++i)
      squares[i] = trace_.voltage[i] * trace_.voltage[i];
    const std::size_t half = std::max<std::size_t>(5, trace_.size() / kDriveWindows);
    const std::vector<double> power = smoothed(squares, half);
    const double high = thinned_quantile(power, whole(), 0.99);
    if (!(high > 0)) return;
    out_.on.resize(trace_.size());
    std::vector<double> while_on;
    for (std::size_t i = 0; i < power.size(); ++i) {
      out_.on[i] = power[i] > kOn * kOn * high;
      if (out_.on[i]) while_on.push_back(std::abs(trace_.voltage[i]));
    }
    close_gaps(half);
    out_.voltage = ranked(std::move(while_on), 0.98);
  }

  // Off for less than the mean is taken over: a carrier that passes through 0.
  void close_gaps(std::size_t half) {
    out_.edge = half;
    std::size_t last = trace_.size();  // at which it was on
    for (std::size_t i = 0; i < out_.on.size(); ++i) {
      if (!out_.on[i]) continue;
      if (last < i && i - last <= 2 * half + 1)
        std::fill(out_.on.begin() + static_cast<long>(last), out_.on.begin() + static_cast<long>(i),
                  true);
      last = i;
    }
  }

  // What moves: the position's own direction, else the sign of the tangential force.
  std::vector<double> motion() const {
    const std::size_t half = std::max<std::size_t>(2, trace_.size() / 5000);
    if (trace_.position.empty()) return smoothed(trace_.tangential, half);
    const std::vector<double> x = smoothed(trace_.position, half);
    std::vector<double> speed(x.size(), 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::size_t a = i > half ? i - half : 0, b = std::min(x.size() - 1, i + half);
      speed[i] = (x[b] - x[a]) / (trace_.time[b] - trace_.time[a]);
    }
    return speed;
  }

  void strokes() {
    const double load = thinned_quantile(trace_.normal, whole(), 0.9);
    const std::vector<double> moves = motion();
    std::vector<double> size(moves.size());
    std::transform(moves.begin(), moves.end(), size.begin(), [](double v) { return std::abs(v); });
    const double usual = thinned_quantile(size, whole(), 0.8);
    std::size_t dropped = 0;
    int now = 0;
    Stroke stroke;
    const auto end_at = [&](std::size_t i) {
      if (now == 0) return;
      stroke.all.end = i;
      if (stroke.all.size() >= kFewestOfStroke)
        out_.strokes.push_back(stroke);
      else
        ++dropped;
    };
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const bool slides = trace_.normal[i] > kTouches * load && size[i] > kMoves * usual;
      const int sign = !slides ? 0 : moves[i] > 0 ? 1 : -1;
      if (sign == now) continue;
      end_at(i);
      now = sign;
      stroke = {};
      stroke.direction = sign;  // of the motion
      stroke.all.begin = i;
    }
    end_at(moves.size());
    if (dropped > 0)
      out_.notes.push_back(fmt::format("{} of less than {} samples left out",
                                       counted(static_cast<long long>(dropped), "movement"),
                                       kFewestOfStroke));
  }

  static Span second_half(const Stroke& s) { return {s.all.begin + s.all.size() / 2, s.all.end}; }

  // From those of the motion to those of the force, which may point the other way: of the finger or
  // of the plate. Motions to and fro say so whatever the sensor's zero is; a zero beyond the
  // friction, by which the force itself does not turn, is found between both.
  void find_directions() {
    std::vector<double> plateaus;
    double sum[2] = {0, 0}, count[2] = {0, 0};  // back, forth
    for (const Stroke& s : out_.strokes) {
      plateaus.push_back(thinned_quantile(trace_.tangential, second_half(s), 0.5));
      sum[s.direction > 0] += plateaus.back();
      ++count[s.direction > 0];
    }
    const bool both = count[0] > 0 && count[1] > 0;
    const bool opposed = both ? sum[1] / count[1] < sum[0] / count[0] : sum[1] < sum[0];
    bool turns = true;
    for (std::size_t k = 0; k < plateaus.size(); ++k) {
      if (opposed) out_.strokes[k].direction = -out_.strokes[k].direction;
      turns &= out_.strokes[k].direction * plateaus[k] >= 0;
    }
    if (both && !turns) zero_ = (sum[0] / count[0] + sum[1] / count[1]) / 2;
  }

  double along(const Stroke& s, std::size_t i) const {
    return s.direction * (trace_.tangential[i] - zero_);
  }

  // The force of the plateau along the slide; where the drive is switched in the stroke, of the
  // state in which it is lower: the finger slides in it as well, whichever comes first.
  double plateau(const Stroke& s) const {
    std::vector<double> of_state[2];
    if (!out_.on.empty()) {
      for (std::size_t i = s.all.begin; i < s.all.end; ++i)
        of_state[out_.on[i]].push_back(along(s, i));
    }
    const double fewest = kShortState * static_cast<double>(s.all.size());
    const auto is_short = [&](const auto& of) { return static_cast<double>(of.size()) < fewest; };
    if (is_short(of_state[0]) || is_short(of_state[1]))
      return s.direction * (thinned_quantile(trace_.tangential, second_half(s), 0.5) - zero_);
    return std::min(ranked(std::move(of_state[0]), 0.5), ranked(std::move(of_state[1]), 0.5));
  }

  // Onset, plateau and slips of a stroke. Eq. lab.11, lab.12
  void judge(Stroke& s) const {
    const Span last = second_half(s);
    const double level = plateau(s);
    s.onset = s.all.begin;
    while (s.onset < last.begin && along(s, s.onset) < kOnset * level) ++s.onset;
    const auto after = static_cast<std::size_t>(kAfterOnset * static_cast<double>(s.all.size()));
    const auto before = static_cast<std::size_t>(kBeforeEnd * static_cast<double>(s.all.size()));
    for (std::size_t i = s.onset; i < std::min(s.all.end, s.onset + after); ++i)
      s.peak = std::max(s.peak, along(s, i));
    s.steady = {std::min(s.all.end, s.onset + after), s.all.end};
    if (s.steady.size() > before) s.steady.end -= before;
    find_slips(s, level);
  }

  void find_slips(Stroke& s, double level) const {
    const auto over = std::max<std::size_t>(
        2, static_cast<std::size_t>(kSlipTime * static_cast<double>(s.all.size())));
    if (s.steady.size() < 4 * over) return;
    std::vector<double> steps;
    for (std::size_t i = s.steady.begin + 1; i < s.steady.end; ++i)
      steps.push_back(std::abs(trace_.tangential[i] - trace_.tangential[i - 1]));
    // Of white noise the median of a step's size is 0.954 standard deviations.
    const double noise = thinned_quantile(steps, {0, steps.size()}, 0.5) / 0.954;
    const double least = std::max(kSlipShare * std::abs(level), kSlipNoise * noise);
    std::vector<double> falls;
    for (std::size_t i = s.steady.begin; i + over < s.steady.end; ++i) {
      if (switches(i, i + over)) continue;
      const double fall = s.direction * (trace_.tangential[i] - trace_.tangential[i + over]);
      if (fall < least) continue;
      s.slips.push_back(i);
      falls.push_back(fall);
      i += 2 * over;  // the same slip
    }
    if (!falls.empty()) s.slip = quantile(std::move(falls), 0.5);
  }

  // The force changes as the drive does: no slip.
  bool switches(std::size_t from, std::size_t to) const {
    if (out_.on.empty()) return false;
    const std::size_t margin = 3 * (to - from);
    const std::size_t a = from > margin ? from - margin : 0;
    const std::size_t b = std::min(out_.on.size() - 1, to + margin);
    return out_.on[a] != out_.on[b] || out_.on[from] != out_.on[to];
  }

  void tell() {
    const auto count = [&](auto&& is) {
      return std::count_if(out_.strokes.begin(), out_.strokes.end(), is);
    };
    const auto sticks = count([](const Stroke& s) { return s.sticks(); });
    if (sticks == 0) return;
    double largest = 0;
    for (const Stroke& s : out_.strokes) largest = std::max(largest, s.sticks() ? s.slip : 0);
    out_.notes.push_back(
        fmt::format("stick-slip in {} of {} strokes, with falls of up to {} mN: the mean over the "
                    "slips is taken",
                    sticks, out_.strokes.size(), significant(1e3 * largest, 2)));
  }

  const Trace& trace_;
  Sliding out_;
  double zero_ = 0;  // of the sensor [N], where it is beyond the friction
};

}  // namespace

Sliding find_sliding(const Trace& trace) { return Finder(trace).find(); }

}  // namespace papilla::lab
