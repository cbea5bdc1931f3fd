#include "lab/trace_reading.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/text.h"

namespace papilla::lab {
namespace {

// Blocks of a state of the drive; below that every stroke is parted, so that there are some.
constexpr int kBlocksOfState = 8;
constexpr std::size_t kFewestOfBlock = 20;  // samples
// After a switch of the drive: left out, beside the lag of the friction.
constexpr double kSwitch = 0.01;
// The longest lag that is looked for [s], and how many are.
constexpr double kLongestLag = 0.3;
constexpr int kLags = 60;
constexpr std::size_t kLagSamples = 20000;  // of a record, that a lag is looked for in
// Of the record's usual normal force: blocks beyond are another load.
constexpr double kUsualLoadBand = 0.2;
// Of the largest normal force: below it nothing touches.
constexpr double kFree = 0.05;
// A drift that people are told of: a share of the friction.
constexpr double kToldDrift = 0.02;
// Of the largest pivot of columns that are of the order of 1: below it they depend on each other.
constexpr double kIndependent = 1e-9;
// With the drive on in one direction alone, what it adds and the zero are one column.
constexpr const char* kNotParted =
    "its strokes do not part friction from the zero of the force, as where the drive is on in one "
    "direction alone: record strokes of both directions with the drive on and with it off, or a "
    "part without touch";

struct Block {
  double force = 0, load = 0, time = 0, humidity = 0;  // means
  int direction = 1;
  bool on = false;
};

double mean_of(const std::vector<double>& values, Span s) {
  double sum = 0;
  for (std::size_t i = s.begin; i < s.end; ++i) sum += values[i];
  return sum / static_cast<double>(s.size());
}

class Reader {
 public:
  Reader(const Trace& trace, const Sliding& sliding, const std::string& file)
      : trace_(trace), sliding_(sliding), file_(file) {}

  TraceReading read() {
    out_.notes = trace_.notes;
    out_.notes.insert(out_.notes.end(), sliding_.notes.begin(), sliding_.notes.end());
    find_lag();
    make_blocks();
    leave_out_other_loads();
    fit();
    describe();
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError({Problem{file_, 0, 0, "", why}});
  }

  bool is_on(std::size_t i) const { return !sliding_.on.empty() && sliding_.on[i]; }
  bool ever_off() const {
    for (const Stroke& s : sliding_.strokes) {
      for (std::size_t i = s.all.begin; i < s.all.end; ++i) {
        if (!is_on(i)) return true;
      }
    }
    return false;
  }

  // The shift of the drive at which friction follows it best: the largest difference of the mean
  // force on and off.
  void find_lag() {
    if (sliding_.on.empty()) return;
    // Less the mean of each stroke: the zero of the force is none of the drive's.
    std::vector<double> means;
    for (const Stroke& s : sliding_.strokes)
      means.push_back(s.steady.size() > 0 ? mean_of(trace_.tangential, s.steady) : 0);
    double best = -kInfinity;
    for (int k = 0; k < kLags; ++k) {
      const double lag = kLongestLag * k / kLags;
      const auto shift = static_cast<std::size_t>(lag * sliding_.rate);
      double sum[2] = {0, 0}, count[2] = {0, 0};
      for (std::size_t j = 0; j < means.size(); ++j) {
        const Stroke& s = sliding_.strokes[j];
        const std::size_t step = std::max<std::size_t>(1, trace_.size() / kLagSamples);
        for (std::size_t i = s.steady.begin + shift; i < s.steady.end; i += step) {
          const bool on = is_on(i - shift);
          sum[on] += s.direction * (trace_.tangential[i] - means[j]);
          ++count[on];
        }
      }
      if (count[0] < 10 || count[1] < 10) continue;
      const double contrast = std::abs(sum[1] / count[1] - sum[0] / count[0]);
      if (contrast <= best * (1 + 1e-6)) continue;
      best = contrast;
      out_.lag = lag;
    }
  }

  // Steady sliding in one state of the drive, away from its switches.
  void make_blocks() {
    const auto guard =
        static_cast<std::size_t>(std::ceil((2 * out_.lag + kSwitch) * sliding_.rate)) +
        sliding_.edge;
    std::vector<std::pair<const Stroke*, Span>> parts;
    int states[2] = {0, 0};
    for (const Stroke& s : sliding_.strokes) {
      std::size_t begin = s.steady.begin;
      for (std::size_t i = begin + 1; i <= s.steady.end; ++i) {
        if (i < s.steady.end && is_on(i) == is_on(i - 1)) continue;
        const std::size_t from = begin == s.steady.begin ? begin : begin + guard;
        const std::size_t to = i == s.steady.end || i < sliding_.edge ? i : i - sliding_.edge;
        if (to > from + kFewestOfBlock) {
          parts.emplace_back(&s, Span{from, to});
          ++states[is_on(from)];
        }
        begin = i;
      }
    }
    for (const auto& [stroke, span] : parts) {
      const int pieces = 1 + (kBlocksOfState - 1) / std::max(1, states[is_on(span.begin)]);
      const std::size_t size =
          std::max(kFewestOfBlock, span.size() / static_cast<std::size_t>(pieces));
      for (std::size_t at = span.begin; at + size <= span.end; at += size)
        blocks_.push_back(block(*stroke, {at, at + size}));
    }
    if (blocks_.empty())
      refuse(
          fmt::format("nothing slides steadily: {} found at {} samples a second, none with a "
                      "plateau of {} samples; sample faster, or make longer strokes",
                      counted(static_cast<long long>(sliding_.strokes.size()), "stroke"),
                      significant(sliding_.rate, 3), kFewestOfBlock));
  }

  Block block(const Stroke& stroke, Span s) const {
    Block b{mean_of(trace_.tangential, s),
            mean_of(trace_.normal, s),
            mean_of(trace_.time, s),
            0,
            stroke.direction,
            is_on(s.begin)};
    if (!trace_.humidity.empty()) b.humidity = mean_of(trace_.humidity, s);
    return b;
  }

  void leave_out_other_loads() {
    std::vector<double> loads;
    for (const Block& b : blocks_) loads.push_back(b.load);
    std::nth_element(loads.begin(), loads.begin() + static_cast<long>(loads.size() / 2),
                     loads.end());
    const double usual = loads[loads.size() / 2];
    const auto other = std::erase_if(
        blocks_, [&](const Block& b) { return std::abs(b.load - usual) > kUsualLoadBand * usual; });
    if (other > 0)
      out_.notes.push_back(
          fmt::format("{} left out, whose normal force is more than {:.0f} % off "
                      "{} N",
                      counted(static_cast<long long>(other), "block"), 100 * kUsualLoadBand,
                      significant(usual, 3)));
  }

  // The zero of the sensor at a time, from where nothing touches: of a slide in one direction.
  std::optional<double> free_zero() const {
    const double load = *std::max_element(trace_.normal.begin(), trace_.normal.end());
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < trace_.size(); ++i) {
      if (trace_.normal[i] > kFree * load) continue;
      sum += trace_.tangential[i];
      ++count;
    }
    if (count < kFewestOfBlock) return std::nullopt;
    return sum / static_cast<double>(count);
  }

  // The zero that is taken off where the strokes do not part it from the friction.
  double zero_without_touch(bool both) {
    const std::optional<double> free = free_zero();
    if (!free && both) refuse(kNotParted);
    const char* why =
        both ? "the strokes do not part it from friction" : "strokes are in one direction";
    out_.notes.push_back(
        free
            ? fmt::format("the zero of the force, {} mN, is that before and after the touch: {}",
                          significant(1e3 * *free, 2), why)
            : fmt::format(
                  "the zero of the force is taken as it is: {} and no part is without touch", why));
    return free.value_or(0);
  }

  // Of each block what multiplies the friction, its drift, with `two` what the drive adds, and with
  // `zero` the zero of the sensor and its drift. Eq. lab.13
  Eigen::MatrixXd columns(bool two, bool zero) const {
    const double begin = trace_.time.front(), end = trace_.time.back();
    const Eigen::Index count = 2 + two + (zero ? 2 : 0);
    Eigen::MatrixXd a(static_cast<Eigen::Index>(blocks_.size()), count);
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const Block& b = blocks_[static_cast<std::size_t>(i)];
      const double late = (b.time - begin) / (end - begin) - 0.5;
      a(i, 0) = b.direction;
      a(i, 1) = b.direction * late;
      if (two) a(i, 2) = b.on ? b.direction : 0;
      if (!zero) continue;
      a(i, count - 2) = 1;
      a(i, count - 1) = late;
    }
    return a;
  }

  static Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposed(
      const Eigen::MatrixXd& a) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> out;
    out.setThreshold(kIndependent);
    out.compute(a);
    return out;
  }

  // Least squares of the blocks. Eq. lab.13
  void fit() {
    bool both = false, driven = false, undriven = false;
    for (const Block& b : blocks_) {
      both |= b.direction != blocks_.front().direction;
      (b.on ? driven : undriven) = true;
    }
    const bool two = driven && undriven;
    Eigen::MatrixXd a = columns(two, both);
    const Eigen::Index rows = a.rows();
    if (rows < a.cols() + 2)
      refuse(
          fmt::format("{} of steady sliding: too few for an error, {} are needed; make more "
                      "strokes",
                      counted(rows, "block"), a.cols() + 2));
    auto solver = decomposed(a);
    const bool parted = both && solver.rank() == a.cols();
    const double zero = parted ? 0 : zero_without_touch(both);
    if (both && !parted) {
      a = columns(two, false);
      solver = decomposed(a);
    }
    if (solver.rank() < a.cols()) refuse(kNotParted);
    Eigen::VectorXd y(rows);
    for (Eigen::Index i = 0; i < rows; ++i)
      y(i) = blocks_[static_cast<std::size_t>(i)].force - zero;
    const Eigen::MatrixXd inverse = solver.pseudoInverse();
    const Eigen::VectorXd x = inverse * y;
    const double sd = std::sqrt((y - a * x).squaredNorm() / static_cast<double>(rows - a.cols()));
    if (!std::isfinite(sd))
      refuse("its tangential force is too large to be one: check its unit in the header");
    const double first = x(0), first_sd = sd * inverse.row(0).norm();
    if (undriven) {
      out_.off = first;
      out_.off_sd = first_sd;
    }
    if (two) {
      out_.on = x(0) + x(2);
      out_.on_sd = sd * (inverse.row(0) + inverse.row(2)).norm();
    } else if (driven) {
      out_.on = first;
      out_.on_sd = first_sd;
    }
    // The drift is common to both states: of their mean.
    out_.drift = x(1) / (two ? x(0) + x(2) / 2 : first);
    out_.zero = parted ? x(a.cols() - 2) : zero;
    if (parted) out_.zero_drift = x(a.cols() - 1);
    if (!(first > 0)) refuse("the tangential force has no direction: its mean over strokes is 0");
  }

  void describe() {
    double humidity = 0;
    for (const Block& b : blocks_) {
      out_.load += b.load / static_cast<double>(blocks_.size());
      humidity += b.humidity / static_cast<double>(blocks_.size());
    }
    if (!trace_.humidity.empty()) out_.relative_humidity = humidity;
    out_.voltage = sliding_.voltage;
    out_.blocks = static_cast<int>(blocks_.size());
    for (const Stroke& s : sliding_.strokes) {
      out_.strokes += s.steady.size() >= kFewestOfBlock;
      out_.peak += s.peak / static_cast<double>(sliding_.strokes.size());
    }
    if (std::abs(out_.drift) > kToldDrift)
      out_.notes.push_back(
          fmt::format("friction drifts by {:+.0f} % over the record: it is that "
                      "of its middle",
                      100 * out_.drift));
    if (std::abs(out_.zero_drift) > kToldDrift * std::max(out_.off, out_.on))
      out_.notes.push_back(
          fmt::format("the zero of the force drifts by {} mN: taken out by strokes "
                      "to and fro",
                      significant(1e3 * out_.zero_drift, 2)));
    if (out_.off_sd == 0 && out_.on_sd > 0)
      out_.notes.push_back(
          ever_off() ? "no steady sliding without the drive, which is off for too short a part of "
                       "the strokes: there is no modulation"
                     : "never without the drive: there is no modulation");
  }

  const Trace& trace_;
  const Sliding& sliding_;
  std::string file_;
  std::vector<Block> blocks_;
  TraceReading out_;
};

}  // namespace

TraceReading read_friction_of(const Trace& trace, const Sliding& sliding, const std::string& file) {
  return Reader(trace, sliding, file).read();
}

}  // namespace papilla::lab
