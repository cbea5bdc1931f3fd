#include "lab/gauge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/constants.h"

namespace papilla::lab {
namespace {

constexpr int kEnough = 10;  // differences: a deviation is then known to a quarter

struct Mean {
  double sum = 0, squares = 0;
  double stated = 0;  // variances that the values state of themselves, summed
  int count = 0;

  void add(double x, double own = 0) {
    sum += x;
    squares += square(x);
    stated += own;
    ++count;
  }
  double mean() const { return sum / count; }
  double scatter() const { return std::max(0.0, squares - sum * sum / count); }
};

using Days = std::map<std::string, Mean>;     // of a finger: its readings
using Fingers = std::map<std::string, Days>;  // of a design, conditions, off or on

// The means of the days of a finger, and the variances that they have by their readings, summed.
// of_reading: that of each beside what it states itself.
struct DayMeans {
  Mean of;
  double within = 0;

  DayMeans(const Days& days, double of_reading) {
    for (const auto& [day, readings] : days) {
      of.add(readings.mean());
      within += (of_reading + readings.stated / readings.count) / readings.count;
    }
  }
};

// Days or fingers that stand in common cells. All cells of a day share what that day does (Eq.
// lab.1), so two that ten cells compare differ once: so many differences are independent as joins
// are new.
class Joined {
 public:
  void join(const std::string& a, const std::string& b) {
    const std::string of_a = root(a), of_b = root(b);
    if (of_a == of_b) return;
    to_[of_b] = of_a;
    ++count_;
  }
  int differences() const { return count_; }

 private:
  std::string root(std::string name) const {
    for (auto next = to_.find(name); next != to_.end(); next = to_.find(name)) name = next->second;
    return name;
  }

  std::map<std::string, std::string> to_;
  int count_ = 0;
};

// Squares about the means of groups.
struct Pooled {
  double sum = 0;
  int freedom = 0;

  // within: variances that the values of a group have by what scatters within each, summed. Of k
  // values with such variances the squares about their mean hold (1 - 1/k) of that sum.
  void add(const Mean& group, double within) {
    sum += group.scatter() - within * (1 - 1.0 / group.count);
    freedom += group.count - 1;
  }
  // differences: those of `freedom` that are independent.
  GaugeSpread spread(int differences) const {
    if (freedom == 0) return {};
    return {std::sqrt(std::max(0.0, sum / freedom)), differences};
  }
};

std::string day_of(const std::string& finger, const std::string& day) {
  return finger + "\n" + day;
}

std::string cell_of(const FrictionReading& r, bool on) {
  return std::to_string(r.experiment.design) + " " + text(r.experiment.at) + (on ? " on" : " off");
}

}  // namespace

// Eq. lab.14
Gauge gauge_of(const std::vector<FrictionReading>& readings) {
  std::map<std::string, Fingers> cells;
  for (const FrictionReading& r : readings) {
    for (const bool on : {false, true}) {
      const double force = on ? r.on : r.off, sd = on ? r.on_sd : r.off_sd;
      if (force > 0)
        cells[cell_of(r, on)][r.finger][r.day].add(std::log(force), square(sd / force));
    }
  }
  Gauge out;
  Pooled repeats, days, fingers;
  Joined joined_days, joined_fingers;
  for (const auto& [cell, of_cell] : cells) {
    for (const auto& [finger, of_finger] : of_cell) {
      for (const auto& [day, of_day] : of_finger) repeats.add(of_day, of_day.stated);
    }
  }
  out.repeatability = repeats.spread(repeats.freedom);
  const double of_reading = square(out.repeatability.deviation);
  for (const auto& [cell, of_cell] : cells) {
    for (const auto& [finger, of_finger] : of_cell) {
      const DayMeans means(of_finger, of_reading);
      days.add(means.of, means.within);
      for (const auto& [day, of_day] : of_finger)
        joined_days.join(day_of(finger, of_finger.begin()->first), day_of(finger, day));
    }
  }
  out.day_to_day = days.spread(joined_days.differences());
  const double of_day = square(out.day_to_day.deviation);
  for (const auto& [cell, of_cell] : cells) {
    Mean means_of_fingers;
    double within = 0;
    for (const auto& [finger, of_finger] : of_cell) {
      joined_fingers.join(of_cell.begin()->first, finger);
      const DayMeans means(of_finger, of_reading);
      means_of_fingers.add(means.of.mean());
      within += (of_day + means.within / means.of.count) / means.of.count;
    }
    fingers.add(means_of_fingers, within);
  }
  out.finger_to_finger = fingers.spread(joined_fingers.differences());
  return out;
}

Instrument after_gauge(const Instrument& stated, const Gauge& gauge) {
  Instrument out = stated;
  const auto believe = [](double& value, const GaugeSpread& found) {
    if (found.freedom >= kEnough) value = std::max(value, found.deviation);
  };
  believe(out.repeatability, gauge.repeatability);
  believe(out.day_to_day, gauge.day_to_day);
  believe(out.finger_to_finger, gauge.finger_to_finger);
  return out;
}

}  // namespace papilla::lab
