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
  int count = 0;

  void add(double x) {
    sum += x;
    squares += square(x);
    ++count;
  }
  double mean() const { return sum / count; }
  double scatter() const { return std::max(0.0, squares - sum * sum / count); }
};

std::string cell_of(const FrictionReading& r, bool on) {
  return std::to_string(r.experiment.design) + " " + text(r.experiment.at) + (on ? " on" : " off");
}

// GaugeSpread of the means of groups below a common key, less what scatters within them.
GaugeSpread between(const std::map<std::string, Mean>& groups,
                    const std::map<std::string, std::string>& above, double within) {
  std::map<std::string, Mean> common;
  double inverse = 0;
  for (const auto& [key, mean] : groups) {
    common[above.at(key)].add(mean.mean());
    inverse += 1.0 / mean.count;
  }
  GaugeSpread out;
  double sum = 0;
  for (const auto& [key, mean] : common) {
    sum += mean.scatter();
    out.freedom += mean.count - 1;
  }
  if (out.freedom == 0) return {};
  const double mean_of_few = square(within) * inverse / static_cast<double>(groups.size());
  out.deviation = std::sqrt(std::max(0.0, sum / out.freedom - mean_of_few));
  return out;
}

}  // namespace

Gauge gauge_of(const std::vector<FrictionReading>& readings) {
  std::map<std::string, Mean> days, fingers;
  std::map<std::string, std::string> finger_of, cell_of_finger;
  for (const FrictionReading& r : readings) {
    for (const bool on : {false, true}) {
      const double force = on ? r.on : r.off;
      if (!(force > 0)) continue;
      const std::string cell = cell_of(r, on), finger = cell + "\t" + r.finger,
                        day = finger + "\t" + r.day;
      days[day].add(std::log(force));
      finger_of[day] = finger;
      cell_of_finger[finger] = cell;
    }
  }
  Gauge out;
  double sum = 0;
  for (const auto& [key, mean] : days) {
    sum += mean.scatter();
    out.repeatability.freedom += mean.count - 1;
    fingers[finger_of[key]].add(mean.mean());
  }
  if (out.repeatability.freedom > 0)
    out.repeatability.deviation = std::sqrt(sum / out.repeatability.freedom);
  out.day_to_day = between(days, finger_of, out.repeatability.deviation);
  out.finger_to_finger = between(fingers, cell_of_finger, out.day_to_day.deviation);
  return out;  // Eq. lab.14
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
