#include "metrics/metric.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "numerics/statistics.h"

namespace papilla::metrics {
namespace {

struct Row {
  Metric metric;  // of two families whichever modulation
  MetricInfo info;
};

// A quantity of the response under the name that studies use; unit, meaning and state are its own.
Row row(const char* name, Better better, Measured PointQuantities::*quantity) {
  for (const auto& q : api::kQuantities<Measured>) {
    if (q.value != quantity) continue;
    const bool driven = q.drive == api::FingerDrive::On || q.drive == api::FingerDrive::OnElseZero;
    return {QuantityMetric{quantity}, {name, q.unit, q.doc, better, driven}};
  }
  PAPILLA_CHECK(false, "every quantity is in the list");
  return {};
}

// A share of the patch: a few per cent.
Row share(const char* name, Better better, Measured PointQuantities::*quantity) {
  Row out = row(name, better, quantity);
  out.info.in_per_cent = true;
  return out;
}

// Gloss meters show .1 units (ISO 2813).
Row look(const char* name, Better better, double Look::*number, const char* doc,
         double resolution = 0.1) {
  return {LookMetric{number},
          {.name = name,
           .unit = "",
           .doc = doc,
           .better = better,
           .appearance = true,
           .resolution = resolution}};
}

// Haze meters show .1 % (ASTM D1003).
Row light(const char* name, Better better, double Look::*number, const char* doc) {
  Row out = look(name, better, number, doc, 0.001);
  out.info.in_per_cent = true;
  return out;
}

const std::vector<Row>& rows() {
  using Q = PointQuantities;
  static const std::vector<Row> list{
      row("modulation", Better::Higher, &Q::modulation),
      row("friction", Better::Lower, &Q::friction_off),
      row("friction_on", Better::Higher, &Q::friction_on),
      row("capillary_force", Better::Lower, &Q::capillary_force),
      row("electrostatic_force", Better::Higher, &Q::electrostatic_force),
      row("retention_force", Better::Lower, &Q::retention_force),
      share("contact_area", Better::Neither, &Q::area_fraction_off),
      row("bridges", Better::Neither, &Q::bridges),
      share("wetted_fraction", Better::Neither, &Q::wetted_fraction),
      row("mean_gap", Better::Neither, &Q::mean_gap),
      {Adhesion{},
       {.name = "adhesion",
        .unit = "N",
        .doc = "capillary force on the finger, drive off; never below 0",
        .better = Better::Lower,
        .resolution = 1e-4}},  // a choice: below what force sensors resolve
      {Compliance{},
       {"compliance", "m/Pa", "indentation since first touch over patch pressure",
        Better::Neither}},
      light("haze", Better::Lower, &Look::haze,
            "share of the transmitted light beyond the cone of the view, 2.5 deg (ASTM D1003, ISO "
            "14782)"),
      light("transmittance", Better::Higher, &Look::transmittance,
            "undeviated share of the light on the plate (regular transmittance)"),
      light("total_transmittance", Better::Higher, &Look::total_transmittance,
            "all of the light through the plate over that on it (ISO 13468)"),
      look("gloss", Better::Higher, &Look::gloss, "gloss units at 60 deg (ISO 2813)"),
      look("gloss_20", Better::Higher, &Look::gloss_20, "gloss units at 20 deg (ISO 2813)"),
      look("gloss_85", Better::Higher, &Look::gloss_85, "gloss units at 85 deg (ISO 2813)"),
      light(
          "distinctness", Better::Higher, &Look::distinctness,
          "distinctness of the reflected image: 1 less the light 0.3 deg off the mirror direction "
          "over that in it, at 20 deg (after ASTM D5767)"),
      light(
          "sparkle", Better::Lower, &Look::sparkle,
          "standard deviation over mean of the light of equal subpixels of view.panel (pixel power "
          "deviation)"),
      look("colour_shift", Better::Lower, &Look::colour_shift,
           "CIE 1976 u'v' distance of the undeviated light from the source", 0.001),  // a choice
      {SourceAmplitude{},
       {"drive.amplitude", "V",
        "amplitude of the source: the design's; under current control what the "
        "current needs at that humidity",
        Better::Lower, true}},
      {VoltageFor{},
       {.name = "voltage_for",
        .unit = "V",
        .doc = "voltage_for(modulation = 0.5): amplitude at which the modulation reaches that "
               "value; whatever the design's own amplitude",
        .better = Better::Lower,
        .takes_modulation = true}},
      {Felt{},
       {.name = "felt",
        .unit = "",
        .doc = "felt(modulation = 0.2): probability that the modulation is above that Weber "
               "fraction; its mean over humidities and fingers is the share of people and "
               "weathers that feel the effect",
        .better = Better::Higher,
        .needs_drive = true,
        .takes_modulation = true,
        .resolution = 0.01}},  // a choice: one of a hundred people
      {PullInMargin{},
       {"pull_in_margin", "",
        "voltage at which the gap jumps shut over that of the drive; 4 where it is farther",
        Better::Higher, true}},
  };
  return list;
}

// Null of a metric that takes none.
template <class Any>
auto* modulation_in(Any& metric) {
  decltype(&std::get<Felt>(metric).modulation) out = nullptr;
  if (auto* v = std::get_if<VoltageFor>(&metric)) out = &v->modulation;
  if (auto* f = std::get_if<Felt>(&metric)) out = &f->modulation;
  return out;
}

std::string without_blanks(const std::string& text) {
  std::string out;
  std::copy_if(text.begin(), text.end(), std::back_inserter(out), [](char c) { return c != ' '; });
  return out;
}

// X of "NAME(modulation = X)".
double modulation_of(const std::string& text, const std::string& name) {
  const std::string compact = without_blanks(text), head = name + "(modulation=";
  if (compact.starts_with(head) && compact.back() == ')') {
    const char *from = compact.data() + head.size(), *to = compact.data() + compact.size() - 1;
    double value = 0;
    const auto [end, error] = std::from_chars(from, to, value);
    if (error == std::errc{} && end == to && value > 0 && value < 1e6) return value;
  }
  throw InputError(fmt::format("\"{}\": expected {}(modulation = X), X above 0", text, name));
}

Measured adhesion(const ResponsePoint& point) {
  Measured a = point.capillary_force;
  a.value = std::max(a.value, 0.0);
  return a;
}

// Eq. metrics.7, Eq. metrics.8: whether the effect is felt there is yes or no, and known as well as
// the modulation is; each part of its error has its share in that. of_ratio: the relative error of
// F_on/F_off of a run on few skins, which is not its own.
Measured felt(const Measured& modulation, std::optional<double> of_ratio, double threshold) {
  const double above = modulation.value - threshold,
               se = of_ratio ? *of_ratio * (1 + modulation.value) : modulation.se();
  if (se <= 0) return {above > 0 ? 1.0 : 0.0, {}};
  const double p = normal_cdf(above / se), spread = std::sqrt(p * (1 - p));
  Measured out{p, {.sampling = spread * modulation.parts.sampling / se}};
  for (const ErrorOrigin& origin : kErrorOrigins) {
    const auto& part = modulation.parts.*origin.part;
    if (part && origin.in_total) out.parts.*origin.part = spread * *part / se;
  }
  return out;
}

Measured compliance(const ResponsePoint& point) {
  Measured c = point.indentation;
  c.value /= point.patch_pressure;
  c.parts.sampling /= point.patch_pressure;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (auto& part = c.parts.*origin.part) *part /= point.patch_pressure;
  }
  return c;
}

// One alternative at one humidity.
struct AtPoint {
  const ResponsePoint& point;

  std::optional<Measured> operator()(const QuantityMetric& m) const { return point.*m.quantity; }
  std::optional<Measured> operator()(const Adhesion&) const { return adhesion(point); }
  std::optional<Measured> operator()(const Compliance&) const { return compliance(point); }
  std::optional<Measured> operator()(const LookMetric&) const { return std::nullopt; }
  std::optional<Measured> operator()(const SourceAmplitude&) const {
    return Measured{point.source_voltage, {}};
  }
  std::optional<Measured> operator()(const VoltageFor& m) const {
    const VoltageAnswer* answer = voltage_answer(m, point);
    return answer ? std::optional(answer->amplitude) : std::nullopt;
  }
  std::optional<Measured> operator()(const Felt& m) const {
    return felt(point.modulation, point.felt_error, m.modulation);
  }
  std::optional<Measured> operator()(const PullInMargin&) const {
    return point.pull_in ? std::optional(point.pull_in->margin) : std::nullopt;
  }
};

struct CarryingQuantity {
  using Found = std::optional<Measured PointQuantities::*>;

  Found operator()(const QuantityMetric& m) const { return m.quantity; }
  Found operator()(const Adhesion&) const { return &PointQuantities::capillary_force; }
  Found operator()(const Compliance&) const { return &PointQuantities::indentation; }
  Found operator()(const LookMetric&) const { return std::nullopt; }
  Found operator()(const SourceAmplitude&) const { return std::nullopt; }
  Found operator()(const VoltageFor&) const { return std::nullopt; }
  Found operator()(const Felt&) const { return std::nullopt; }
  Found operator()(const PullInMargin&) const { return std::nullopt; }
};

}  // namespace

const std::vector<MetricInfo>& metric_list() {
  static const std::vector<MetricInfo> list = [] {
    std::vector<MetricInfo> infos;
    for (const Row& one : rows()) infos.push_back(one.info);
    return infos;
  }();
  return list;
}

const MetricInfo& info_of(const Metric& metric) {
  Metric any = metric;
  if (double* modulation = modulation_in(any)) *modulation = 0;
  const auto found =
      std::find_if(rows().begin(), rows().end(), [&](const Row& one) { return one.metric == any; });
  PAPILLA_CHECK(found != rows().end(), "every metric is in the list");
  return found->info;
}

std::optional<Metric> find_metric(const std::string& text) {
  const std::string compact = without_blanks(text);
  for (const Row& one : rows()) {
    const std::string& name = one.info.name;
    if (!(one.info.takes_modulation ? compact.starts_with(name + "(") : text == name)) continue;
    Metric out = one.metric;
    if (double* modulation = modulation_in(out)) *modulation = modulation_of(text, name);
    return out;
  }
  return std::nullopt;
}

std::string metric_text(const Metric& metric) {
  const double* modulation = modulation_in(metric);
  const std::string& name = info_of(metric).name;
  return modulation ? fmt::format("{}(modulation = {})", name, *modulation) : name;
}

std::optional<Measured> metric_at(const Metric& metric, const ResponsePoint& point) {
  return std::visit(AtPoint{point}, metric);
}

bool is_known(const Metric& metric, const ResponsePoint& point) {
  if (std::holds_alternative<Felt>(metric)) return point.knows_driven();
  const auto* metric_quantity = std::get_if<QuantityMetric>(&metric);
  if (!metric_quantity) return true;
  for (const auto& q : api::kQuantities<Measured>) {
    if (q.value != metric_quantity->quantity || q.drive == api::FingerDrive::Any) continue;
    return q.drive == api::FingerDrive::Off ? point.knows_undriven() : point.knows_driven();
  }
  return true;
}

bool is_known(const Metric& metric, const Response& response) {
  return std::all_of(response.points.begin(), response.points.end(),
                     [&](const ResponsePoint& point) { return is_known(metric, point); });
}

const VoltageAnswer* voltage_answer(const Metric& metric, const ResponsePoint& point) {
  const auto* voltage = std::get_if<VoltageFor>(&metric);
  if (!voltage) return nullptr;
  for (const VoltageAnswer& answer : point.voltages) {
    if (answer.target == voltage->modulation && answer.reached()) return &answer;
  }
  return nullptr;
}

std::optional<Measured PointQuantities::*> metric_quantity(const Metric& metric) {
  return std::visit(CarryingQuantity{}, metric);
}

std::string why_undefined(const Metric& metric, const Response& response) {
  const auto* voltage = std::get_if<VoltageFor>(&metric);
  if (!voltage) return info_of(metric).needs_drive && !response.driven ? "not driven (0 V)" : "";
  for (const ResponsePoint& point : response.points) {
    for (const VoltageAnswer& answer : point.voltages) {
      if (answer.target != voltage->modulation || answer.reached()) continue;
      // A limit of 0: nothing was driven, so that no modulation was reached.
      const std::string reached =
          answer.limit > 0 ? fmt::format(" (modulation {:.3g})", answer.modulation) : "";
      return fmt::format("{:.0f} % RH: {}{}", 100 * point.relative_humidity, text(answer), reached);
    }
  }
  return "";
}

}  // namespace papilla::metrics
