#include "metrics/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "numerics/statistics.h"

namespace papilla::metrics {
namespace {

struct Entry {
  MetricInfo info;
  Measured PointQuantities::*member;
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> list{
      {{"modulation", "", "(F_on - F_off) / F_off", Better::Higher, true},
       &PointQuantities::modulation},
      {{"friction", "N", "friction of the finger, drive off", Better::Lower, false},
       &PointQuantities::friction_off},
      {{"friction_on", "N", "friction of the finger, drive on", Better::Higher, true},
       &PointQuantities::friction_on},
      {{"capillary_force", "N", "capillary force on the finger, drive off; negative: it pushes off",
        Better::Lower, false},
       &PointQuantities::capillary_force},
      {{"electrostatic_force", "N", "pull of the field on the finger", Better::Higher, true},
       &PointQuantities::electrostatic_force},
      {{"retention_force", "N", "lateral force of contact-angle hysteresis", Better::Lower, false},
       &PointQuantities::retention_force},
      {{"contact_area", "", "contact fraction of the load-carrying patches, drive off",
        Better::Neither, false},
       &PointQuantities::area_fraction_off},
      {{"bridges", "", "capillary bridges per patch", Better::Neither, false},
       &PointQuantities::bridges},
      {{"wetted_fraction", "", "bridged share of the patch", Better::Neither, false},
       &PointQuantities::wetted_fraction},
      {{"mean_gap", "m", "mean gap of the patch", Better::Neither, false},
       &PointQuantities::mean_gap},
  };
  return list;
}

struct AppearanceEntry {
  MetricInfo info;
  double Optics::*member;
};

const std::vector<AppearanceEntry>& appearance_entries() {
  static const std::vector<AppearanceEntry> list{
      {{"haze", "", "share of the transmitted light beyond 2.5 deg", Better::Lower, false, true},
       &Optics::haze},
      {{"transmittance", "", "undeviated share of the light on the plate", Better::Higher, false,
        true},
       &Optics::transmittance},
      {{"gloss", "", "specular reflection at 60 deg over that of flat glass", Better::Higher, false,
        true},
       &Optics::gloss},
      {{"colour_shift", "", "CIE 1976 u'v' distance of the undeviated light from the source",
        Better::Lower, false, true},
       &Optics::colour_shift},
  };
  return list;
}

// What holds the finger: repulsion by drops on surfaces that repel water is no merit.
Measured adhesion(const ResponsePoint& point) {
  Measured a = point.capillary_force;
  a.value = std::max(a.value, 0.0);
  return a;
}

// Eq. metrics.7, Eq. metrics.8: whether the effect is felt there is yes or no, and known as well as
// the modulation is; each part of its error has its share in that.
Measured felt(const Measured& modulation, double threshold) {
  const double above = modulation.value - threshold, se = modulation.se();
  if (se <= 0) return {above > 0 ? 1.0 : 0.0, {}};
  const double p = normal_cdf(above / se), spread = std::sqrt(p * (1 - p));
  Measured out{p, {.sampling = spread * modulation.parts.sampling / se}};
  for (const ErrorOrigin& origin : kErrorOrigins) {
    const auto& part = modulation.parts.*origin.part;
    if (part && origin.in_total) out.parts.*origin.part = spread * *part / se;
  }
  return out;
}

// Indentation over pressure [m/Pa]: how far the finger sinks in.
Measured compliance(const ResponsePoint& point) {
  Measured c = point.indentation;
  c.value /= point.patch_pressure;
  c.parts.sampling /= point.patch_pressure;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (auto& part = c.parts.*origin.part) *part /= point.patch_pressure;
  }
  return c;
}

}  // namespace

const std::vector<MetricInfo>& metric_list() {
  static const std::vector<MetricInfo> list = [] {
    std::vector<MetricInfo> infos;
    for (const Entry& entry : entries()) infos.push_back(entry.info);
    infos.push_back({"adhesion", "N", "capillary force on the finger, drive off; never below 0",
                     Better::Lower, false});
    infos.push_back({"compliance", "m/Pa", "indentation since first touch over patch pressure",
                     Better::Neither, false});
    for (const AppearanceEntry& entry : appearance_entries()) infos.push_back(entry.info);
    infos.push_back({kAmplitude, "V",
                     "amplitude of the source: the design's; under current control what the "
                     "current needs at that humidity",
                     Better::Lower, true});
    infos.push_back(
        {kVoltageFor, "V",
         "voltage_for(modulation = 0.5): amplitude at which the modulation reaches that "
         "value; whatever the design's own amplitude",
         Better::Lower, false});
    infos.push_back({kFelt, "",
                     "felt(modulation = 0.2): probability that the modulation is above that Weber "
                     "fraction; its mean over humidities and fingers is the share of people and "
                     "weathers that feel the effect",
                     Better::Higher, true});
    return infos;
  }();
  return list;
}

const MetricInfo* find_metric(const std::string& name) {
  const std::string base = name.substr(0, name.find('('));
  for (const MetricInfo& info : metric_list()) {
    const bool of_modulation = base == kVoltageFor || base == kFelt;
    if (info.name == base && (base == name) != of_modulation) return &info;
  }
  return nullptr;
}

std::optional<Measured> metric_at(const std::string& name, const ResponsePoint& point) {
  if (name == "adhesion") return adhesion(point);
  if (name == "compliance") return compliance(point);
  if (const auto target = voltage_target(name)) {
    for (const VoltageAnswer& answer : point.voltages) {
      if (answer.target == *target && answer.reached()) return answer.amplitude;
    }
    return std::nullopt;
  }
  if (const auto threshold = felt_threshold(name)) return felt(point.modulation, *threshold);
  if (name == kAmplitude) return Measured{point.source_voltage, {}};
  for (const Entry& entry : entries()) {
    if (entry.info.name == name) return point.*entry.member;
  }
  return std::nullopt;
}

std::optional<Measured PointQuantities::*> metric_quantity(const std::string& metric) {
  if (metric == "adhesion") return &PointQuantities::capillary_force;
  if (metric == "compliance") return &PointQuantities::indentation;
  for (const Entry& entry : entries()) {
    if (entry.info.name == metric) return entry.member;
  }
  return std::nullopt;
}

double appearance_value(const std::string& metric, const Optics& look) {
  for (const AppearanceEntry& entry : appearance_entries()) {
    if (entry.info.name == metric) return look.*entry.member;
  }
  PAPILLA_CHECK(false, "a metric of the look: " + metric);
  return 0;
}

std::string why_undefined(const std::string& metric, const Response& response) {
  const auto target = voltage_target(metric);
  if (!target)
    return find_metric(metric)->needs_drive && !response.driven ? "not driven (0 V)" : "";
  for (const ResponsePoint& point : response.points) {
    for (const VoltageAnswer& answer : point.voltages) {
      if (answer.target != *target || answer.reached()) continue;
      return fmt::format("{:.0f} % RH: {} (modulation {:.3g})", 100 * point.relative_humidity,
                         text(answer), answer.modulation);
    }
  }
  return "";
}

}  // namespace papilla::metrics
