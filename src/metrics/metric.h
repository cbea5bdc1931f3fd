// What judges a design at one humidity: a closed list of values, read from their text once.
// `papilla describe metrics` is this list.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/rooms.h"
#include "forward/response.h"

namespace papilla::metrics {

// A quantity of the humidity itself: friction, modulation, mean_gap, ...
struct QuantityMetric {
  Measured PointQuantities::*quantity = &PointQuantities::modulation;
  bool operator==(const QuantityMetric&) const = default;
};
// The capillary force that holds the finger: repulsion by drops on surfaces that repel water is no
// merit.
struct Adhesion {
  bool operator==(const Adhesion&) const = default;
};
// Indentation over pressure [m/Pa]: how far the finger sinks in.
struct Compliance {
  bool operator==(const Compliance&) const = default;
};
// How the texture looks: from Response::appearance, the same at every humidity.
struct LookMetric {
  double Look::*number = &Look::haze;
  bool operator==(const LookMetric&) const = default;
};
// What the source applies [V].
struct SourceAmplitude {
  bool operator==(const SourceAmplitude&) const = default;
};
// The amplitude at which the modulation reaches a value, whatever the design's own amplitude [V].
struct VoltageFor {
  double modulation = 0;
  bool operator==(const VoltageFor&) const = default;
};
// The share of people who would notice: the probability that the modulation of a humidity is above
// a Weber fraction, its errors in it.
struct Felt {
  double modulation = 0;
  bool operator==(const Felt&) const = default;
};
// How far the drive is from the voltage at which the gap jumps shut.
struct PullInMargin {
  bool operator==(const PullInMargin&) const = default;
};
using Metric = std::variant<QuantityMetric, Adhesion, Compliance, LookMetric, SourceAmplitude,
                            VoltageFor, Felt, PullInMargin>;

inline constexpr QuantityMetric kModulation{&PointQuantities::modulation},
    kFriction{&PointQuantities::friction_off}, kFrictionOn{&PointQuantities::friction_on};
// The least relative difference of friction that people notice: Fehlberg 2022.
inline constexpr double kNoticed = 0.2;

enum class Better { Higher, Lower, Neither };

struct MetricInfo {
  std::string name, unit, doc;
  Better better = Better::Neither;
  bool needs_drive = false;
  bool appearance = false;        // a LookMetric
  bool in_per_cent = false;       // a share that people read so
  bool takes_modulation = false;  // its text has a modulation in brackets
  double resolution =
      0;  // values closer than this are one to its instruments, `unit`; 0: not known
};
const std::vector<MetricInfo>& metric_list();
const MetricInfo& info_of(const Metric& metric);

// "friction", "voltage_for(modulation = 0.5)"; nothing where no metric is called so. Throws
// InputError where a modulation is no number above 0.
std::optional<Metric> find_metric(const std::string& text);
// Reads back to the same metric.
std::string metric_text(const Metric& metric);

// Value at one point; nothing when undefined there (a voltage that was not asked for or that does
// not reach its modulation, a look).
std::optional<Measured> metric_at(const Metric& metric, const ResponsePoint& point);

// Whether the state exists that the value at a point is of, or at every humidity of a response:
// none beyond full contact, nor under a voltage that breaks the dielectric down. Voltages, how far
// pull-in is and looks are of no such state.
bool is_known(const Metric& metric, const ResponsePoint& point);
bool is_known(const Metric& metric, const Response& response);

// The answer that a voltage_for metric is of; null for other metrics, and where it has no value.
const VoltageAnswer* voltage_answer(const Metric& metric, const ResponsePoint& point);

// The quantity that carries the errors of a metric; nothing for a voltage, which has its own.
std::optional<Measured PointQuantities::*> metric_quantity(const Metric& metric);

// Why a metric of a response has no value, for people; "" when nothing is known.
std::string why_undefined(const Metric& metric, const Response& response);

}  // namespace papilla::metrics
