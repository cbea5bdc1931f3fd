#include "search/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string_view>

#include "base/check.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "config/describe.h"
#include "config/writer.h"
#include "design/families.h"
#include "estimate/parameters.h"
#include "estimate/target.h"
#include "estimate/voltage.h"
#include "report/response.h"

namespace papilla {
namespace {

// What the numbers of a journal's records mean: raised when their order changes.
constexpr int kRecords = 3;

// Steps of the parameters of confirmed designs: skins over all fingers, pixels.
constexpr int kStepSkins = 12, kStepGrid = 64;

// Shallower relief is none: polished glass is as rough, and no process holds such a depth [m].
// Else a search finds textures of a nanometre whose patch has the luckier skins.
constexpr double kLeastDepth = 2e-9;

constexpr std::array kSampleLists{&ErrorSamples::sampling, &ErrorSamples::grid,
                                  &ErrorSamples::method};

// Bounded by -1 and 11, yet larger for more: the least of large violations stays the least.
double bounded(double violation) {
  constexpr double kLarge = 10;
  if (violation > kLarge) return kLarge + 1 - kLarge / violation;
  return std::max(violation, -1.0);
}

// <= 0 when kept, relative to the limit.
double relative_violation(double value, double limit, bool at_least) {
  if (limit <= 0) return at_least ? -1 : bounded(value);
  if (!at_least) return bounded(value / limit - 1);
  return bounded(value <= 0 ? kInfinity : limit / value - 1);
}

// What a constraint of look limits.
double look_value(const std::string& name, const Optics& optics) {
  if (name == "haze") return optics.haze;
  if (name == "transmittance") return optics.transmittance;
  if (name == "gloss") return optics.gloss;
  return optics.colour_shift;
}

// What a constraint of shape limits.
double shape_value(const std::string& name, const Design& d) {
  const FabricationMargins m = facts(d.texture).margins;
  if (name == "min_hole") return m.min_hole;
  if (name == "min_wall") return m.min_wall;
  return m.aspect_ratio;
}

bool of_appearance(const Constraint& c) {
  const MetricInfo* info = find_metric(c.name);
  return info && info->appearance;
}

bool on_metric(const Constraint& c) { return c.name.find('(') != std::string::npos; }

// For people, and how many of it are one in SI.
std::pair<std::string, double> unit_of(const Constraint& c) {
  for (const ConstraintKind& k : constraint_kinds()) {
    if (k.name == c.name) return {k.unit, k.unit == "um" ? 1e6 : k.unit == "%" ? 100 : 1};
  }
  return {"", 1};
}

// "min_wall (at least 5.5 um)"
std::string constraint_text(const Constraint& c) {
  const auto [unit, scale] = unit_of(c);
  return fmt::format("{} (at {} {:.3g}{}{})", c.name, c.at_least ? "least" : "most",
                     c.limit * scale, unit.empty() ? "" : " ", unit);
}

std::string look_refusal(const Design& d) {
  return optics_refusal(d.texture, d.surface.refractive_index, d.view);
}

// Root mean square distance from the target over humidity. Eq. search.11
double distance(const StudyObjective& o, const Response& response) {
  double sum = 0, total = 0;
  for (const ResponsePoint& p : response.points) {
    sum += p.weight * square(metric_at(o.expression.metric, p)->value - o.target);
    total += p.weight;
  }
  return std::sqrt(sum / total);
}

// Of the objective over the steps of the response; empty: not defined.
StepSamples steps_of(const StudyObjective& o, const Response& response) {
  Response there;
  there.driven = response.driven;
  there.appearance = response.appearance;
  const auto value = [&](const std::vector<ResponsePoint>& points) -> std::optional<double> {
    there.points = points;
    const auto v = summarise(o.expression.summary, o.expression.metric, there);
    if (!v || !std::isfinite(v->value)) return std::nullopt;
    return o.aimed ? distance(o, there) : v->value;
  };
  return step_samples(response.parameters.steps, value).value_or(StepSamples{});
}

double parse_number(const std::string& text, const std::string& whole) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    throw InputError("objective.risk: \"" + whole +
                     "\": expected \"mean\", \"mean - 2 std\", \"cvar 20 %\" or \"worst\"");
  }
  return value;
}

}  // namespace

double difference_error(const Score& score, const Score& other, std::size_t objective) {
  if (objective < score.samples.size() && objective < other.samples.size()) {
    if (const auto error = difference_error(score.samples[objective], other.samples[objective]))
      return *error;
  }
  return std::max(score.errors[objective], other.errors[objective]);
}

bool no_better(const std::vector<StudyObjective>& objectives, const Score& design,
               const Score& other) {
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    const double gain = (objectives[k].maximise ? 1 : -1) * (design.values[k] - other.values[k]);
    if (gain > difference_error(design, other, k)) return false;
  }
  return true;
}

std::string frequency_not_felt(const Design& design) {
  if (design.drive.waveform == Waveform::Dc) return "the drive is a direct voltage";
  if (design.finger.electrical.corner_frequency > 0) return "";
  return "the dielectric has no loss, and the finger's skin layer never conducts "
         "(finger.electrical.corner_frequency is 0)";
}

Risk parse_risk(const std::string& text) {
  std::string compact;
  for (char c : text) {
    if (c != ' ') compact += c;
  }
  if (compact.empty() || compact == "mean") return {};
  if (compact == "worst") return {Risk::Kind::Worst, 0};
  if (compact.starts_with("mean-") && compact.ends_with("std")) {
    const std::string factor = compact.substr(5, compact.size() - 8);
    const double k = factor.empty() ? 1 : parse_number(factor, text);
    if (k < 0) throw InputError("objective.risk: \"" + text + "\": a factor below 0 seeks risk");
    return {Risk::Kind::MeanStd, k};
  }
  if (compact.starts_with("cvar") && compact.ends_with("%")) {
    const double share = 0.01 * parse_number(compact.substr(4, compact.size() - 5), text);
    if (share > 0 && share <= 1) return {Risk::Kind::Cvar, share};
  }
  parse_number("", text);
  return {};
}

double apply_risk(const Risk& risk, bool higher_is_better, const std::vector<double>& values,
                  const std::vector<double>& weights) {
  PAPILLA_CHECK(!values.empty() && values.size() == weights.size(), "one weight a value");
  const double sign = higher_is_better ? 1 : -1;  // from here on, low is bad
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  double mean = 0;
  for (std::size_t i = 0; i < values.size(); ++i) mean += sign * values[i] * weights[i] / total;
  switch (risk.kind) {
    case Risk::Kind::Mean:
      return sign * mean;
    case Risk::Kind::MeanStd: {
      double variance = 0;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double d = sign * values[i] - mean;
        variance += d * d * weights[i] / total;
      }
      // Eq. search.4
      return sign * (mean - risk.parameter * std::sqrt(variance));
    }
    case Risk::Kind::Worst: {
      double worst = kInfinity;  // Eq. search.6
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (weights[i] > 0) worst = std::min(worst, sign * values[i]);
      }
      return sign * worst;
    }
    case Risk::Kind::Cvar: {
      // Eq. search.5: mean over the worst share.
      std::vector<std::size_t> order(values.size());
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return sign * values[a] < sign * values[b];
      });
      double left = risk.parameter, sum = 0;
      for (std::size_t i : order) {
        const double share = std::min(left, weights[i] / total);
        sum += share * sign * values[i];
        left -= share;
      }
      return sign * sum / (risk.parameter - left);
    }
  }
  return sign * mean;
}

std::vector<double> scattered_values(const Risk& risk, bool higher_is_better, double nominal,
                                     const std::vector<double>& lower,
                                     const std::vector<double>& upper) {
  PAPILLA_CHECK(lower.size() == upper.size(), "both ends of each scatter");
  if (lower.empty()) return {nominal};
  // nominal + sum of a u + b u^2, u uniform in [-1, 1].
  std::vector<double> a, b;
  double mean = nominal, variance = 0, worst = nominal;
  for (std::size_t k = 0; k < lower.size(); ++k) {
    a.push_back(0.5 * (upper[k] - lower[k]));
    b.push_back(0.5 * (upper[k] + lower[k]) - nominal);
    mean += b[k] / 3;
    variance += square(a[k]) / 3 + 4 * square(b[k]) / 45;
    double least = 0;
    for (double u : {-1.0, 1.0, b[k] != 0 ? std::clamp(-0.5 * a[k] / b[k], -1.0, 1.0) : 0.0}) {
      const double change = a[k] * u + b[k] * u * u;
      least = higher_is_better ? std::min(least, change) : std::max(least, change);
    }
    worst += least;
  }
  switch (risk.kind) {
    case Risk::Kind::Mean:
      return {mean};
    case Risk::Kind::Worst:
      return {worst};
    case Risk::Kind::MeanStd:
      return {mean - std::sqrt(variance), mean + std::sqrt(variance)};
    case Risk::Kind::Cvar:
      break;
  }
  constexpr int kSample = 128;
  std::vector<double> out(kSample, nominal);
  for (int i = 0; i < kSample; ++i) {
    const Point u = low_discrepancy(a.size(), 1, static_cast<std::uint64_t>(i));
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double x = 2 * u[k] - 1;
      out[static_cast<std::size_t>(i)] += a[k] * x + b[k] * x * x;
    }
  }
  return out;
}

StudyProblem::StudyProblem(const Study& study) : study_(study) {
  for (const Variable& v : study.variables) {
    Dimension d{v.low, v.high, v.choices, !v.is_kind()};
    std::sort(d.choices.begin(), d.choices.end());
    space_.dimensions.push_back(d);
  }
  slow_look_ = !facts(study.design.texture).quick_look;
  for (const Variable& v : study.variables) {
    for (double kind : v.choices) {
      slow_look_ =
          slow_look_ ||
          (v.is_kind() && !facts(default_texture(static_cast<std::size_t>(kind))).quick_look);
    }
  }
  own_value_ = space_.value(unit_of_study());
  space_.collapse = [this](const Point& u) { return collapsed(u); };
  const std::vector<Finger> fingers =
      study.population.empty() ? std::vector<Finger>{study.design.finger} : study.population;
  const std::vector<Scenario> scenarios =
      study.scenarios.empty() ? std::vector<Scenario>{Scenario{}} : study.scenarios;
  for (const Scenario& scenario : scenarios) {
    for (const Finger& finger : fingers) {
      tasks_.push_back({scenario.name.empty() ? finger.name : finger.name + ", " + scenario.name,
                        scenario.weight, finger, scenario.set});
    }
  }
  nominal_ = tasks_.size();
  for (std::size_t t = 0; t < nominal_; ++t) {
    for (std::size_t k = 0; k < study.scatter.size(); ++k) {
      for (int sign : {-1, 1}) {
        StudyTask task = tasks_[t];
        task.name += fmt::format(", {} {}", study.scatter[k].path, sign < 0 ? "low" : "high");
        task.scattered = static_cast<int>(k);
        task.sign = sign;
        tasks_.push_back(std::move(task));
      }
    }
  }
  if (std::none_of(tasks_.begin(), tasks_.end(), [](const StudyTask& t) { return t.weight > 0; }))
    throw InputError("scenarios: at least one weight above 0 is needed");
  const auto searches = [&](const std::string& beginning) {
    return std::any_of(study.variables.begin(), study.variables.end(),
                       [&](const Variable& v) { return v.path.starts_with(beginning); });
  };
  if (searches("drive.frequency") && !searches("finger.electrical.")) {
    const auto deaf = [&](const StudyTask& t) {
      return !frequency_not_felt(task_design(study.design, t)).empty();
    };
    if (std::all_of(tasks_.begin(), tasks_.end(), deaf)) {
      throw InputError("design_space: drive.frequency has no effect: " +
                       frequency_not_felt(task_design(study.design, tasks_.front())) +
                       "; leave the variable out, or give a finger its corner frequency");
    }
  }
  const auto add = [&](std::vector<StudyObjective>& list, const MetricExpression& expression,
                       bool maximise, const Target* target) {
    list.push_back({expression, maximise, metric_text(expression)});
    if (target) {
      list.back().name = fmt::format("distance({}, {:g})", target->metric, target->value);
      list.back().aimed = true;
      list.back().target = target->value;
    }
    if (const auto modulation = voltage_target(expression.metric)) {
      if (std::find(voltage_targets_.begin(), voltage_targets_.end(), *modulation) ==
          voltage_targets_.end())
        voltage_targets_.push_back(*modulation);
    }
    const bool driven = std::all_of(tasks_.begin(), tasks_.end(), [&](const StudyTask& t) {
      return with_settings(study.design, t.settings).drive.driven();
    });
    const bool searched =
        std::any_of(study.variables.begin(), study.variables.end(),
                    [](const Variable& v) { return v.path == "drive.amplitude" && v.low > 0; });
    if (find_metric(expression.metric)->needs_drive && !driven && !searched) {
      throw InputError(fmt::format("objective: {} needs a driven design; drive.amplitude is 0 V",
                                   list.back().name));
    }
  };
  for (const std::string& text : study.objective.maximise)
    add(objectives_, parse_metric(text), true, nullptr);
  for (const std::string& text : study.objective.minimise)
    add(objectives_, parse_metric(text), false, nullptr);
  for (const Target& target : study.objective.targets)
    add(objectives_, {Summary::Mean, target.metric}, false, &target);
  for (const Constraint& c : study.constraints) {
    if (on_metric(c)) add(limited_, parse_metric(c.name), c.at_least, nullptr);
  }
  if (objectives_.empty() || objectives_.size() > 3) {
    throw InputError(
        fmt::format("objective: one to three objectives are possible, got {}", objectives_.size()));
  }
  risk_ = parse_risk(study.objective.risk);
}

// The variable has an effect on a design with these numbers: it names one of them, or another
// kind's word for one that no other variable names.
bool StudyProblem::acts(const std::vector<NumberField>& known, std::size_t variable) const {
  const std::string& own = study_.variables[variable].path;
  const std::string path = path_in(known, own);
  return !path.empty() &&
         (path == own || std::none_of(study_.variables.begin(), study_.variables.end(),
                                      [&](const Variable& v) { return v.path == path; }));
}

Design StudyProblem::design(const Point& unit) const {
  const std::vector<double> v = space_.value(unit);
  Design out = study_.design;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (study_.variables[i].is_kind())
      out.texture = of_kind(out.texture, texture_kinds()[static_cast<std::size_t>(v[i])]);
    if (study_.variables[i].is_levels())
      out.texture = with_levels(std::move(out.texture), static_cast<int>(v[i]));
  }
  const std::vector<NumberField> known = number_fields(out);
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Variable& variable = study_.variables[i];
    if (!variable.is_kind() && !variable.is_levels() && acts(known, i))
      *find_number_field(known, path_in(known, variable.path)).value = v[i];
  }
  return out;
}

Point StudyProblem::unit_of_study() const {
  Point value;
  Design copy = study_.design;
  const std::vector<NumberField> known = number_fields(copy);
  for (const Variable& v : study_.variables) {
    if (v.is_kind()) {
      value.push_back(static_cast<double>(study_.design.texture.kind.index()));
    } else if (v.is_levels()) {
      value.push_back(texture_levels(study_.design.texture));
    } else {
      const std::string path = path_in(known, v.path);
      value.push_back(path.empty() ? 0.5 * (v.low + v.high)
                                   : *find_number_field(known, path).value);
    }
  }
  return space_.unit(value);
}

bool StudyProblem::has_features() const {
  const auto varies = [&](Measure measure) {
    return std::any_of(study_.variables.begin(), study_.variables.end(), [&](const Variable& v) {
      return std::count(v.path.begin(), v.path.end(), '.') == 1 && measure_of(v.path) == measure;
    });
  };
  return varies(Measure::Period) && varies(Measure::Width);
}

std::vector<double> StudyProblem::features(const Point& unit) const {
  return {std::sqrt(facts(design(unit).texture).open_share.value_or(0))};
}

Point StudyProblem::collapsed(const Point& unit) const {
  const bool textured =
      std::any_of(study_.variables.begin(), study_.variables.end(),
                  [](const Variable& v) { return v.path.starts_with("texture."); });
  if (!textured) return unit;
  const auto is_depth = [](const Variable& v) { return measure_of(v.path) == Measure::Depth; };
  Point value = space_.value(unit);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Variable& v = study_.variables[i];
    if (is_depth(v) && v.choices.empty() && v.low <= 0 && value[i] < kLeastDepth) value[i] = v.low;
  }
  Design d = design(space_.unit(value));
  const Point& own = own_value_;
  const auto offered = [](const Variable& v, double choice) {
    return std::find(v.choices.begin(), v.choices.end(), choice) != v.choices.end();
  };
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Variable& v = study_.variables[i];
    if (v.is_levels()) {  // a last part of no depth is one level less
      for (int levels = texture_levels(d.texture);
           levels >= 2 && !last_level_has_relief(d.texture) && offered(v, levels - 1);
           levels = texture_levels(d.texture)) {
        d.texture = with_levels(d.texture, levels - 1);
        value[i] = levels - 1;
      }
    }
    if (v.is_kind() && !facts(d.texture).relief.present) {  // all flat textures are one
      const Texture first = of_kind(d.texture, texture_kinds()[static_cast<std::size_t>(v.low)]);
      if (facts(first).relief.present) continue;  // none of its measures is this one's
      value[i] = v.low;
      d.texture = first;
    }
  }
  const auto has_relief = [&](const std::string& path) {
    return facts(part_at(d.texture, path)).relief.present;
  };
  const std::vector<NumberField> known = number_fields(d);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Variable& v = study_.variables[i];
    if (!v.path.starts_with("texture.") || v.is_kind() || v.is_levels()) continue;
    if (!acts(known, i) || (!decides_relief(v.path) && !has_relief(path_in(known, v.path))))
      value[i] = own[i];
  }
  return space_.unit(value);
}

std::vector<Point> StudyProblem::starts() const {
  std::vector<Point> out{unit_of_study()};
  const auto add = [&](const Point& u) {
    const Point p = space_.snapped(u);
    if (std::find(out.begin(), out.end(), p) == out.end()) out.push_back(p);
  };
  for (std::size_t i = 0; i < space_.size(); ++i) {
    if (study_.variables[i].is_kind()) {  // each kind once
      for (double kind : study_.variables[i].choices) {
        Point value = space_.value(out.front());
        value[i] = kind;
        add(space_.unit(value));
      }
      continue;
    }
    if (const auto flat = flat_by(i, out.front())) add(*flat);
  }
  return out;
}

std::optional<Point> StudyProblem::flat_by(std::size_t variable, const Point& unit) const {
  Point flat = unit;
  flat[variable] = 0;
  if (study_.variables[variable].is_kind()) {
    Point value = space_.value(unit);
    value[variable] =
        study_.variables[variable].low;  // flat, where it is offered: the first of all kinds
    flat = space_.unit(value);
  }
  const auto has_relief = [this](const Point& p) {
    return facts(design(p).texture).relief.present;
  };
  if (!has_relief(unit) || has_relief(flat)) return std::nullopt;
  return space_.snapped(flat);
}

std::optional<Point> StudyProblem::flattened(const Point& unit) const {
  for (std::size_t i = 0; i < space_.size(); ++i) {
    if (auto flat = flat_by(i, unit)) return flat;
  }
  return std::nullopt;
}

// Finger, scenario, then the end of the scatter, within the range that the number may have at all.
Design StudyProblem::task_design(Design d, const StudyTask& task) const {
  d.finger = task.finger;
  d = with_settings(std::move(d), task.settings);  // a scenario may change the finger too
  if (task.scattered < 0) return d;
  const Scatter& scatter = study_.scatter[static_cast<std::size_t>(task.scattered)];
  const std::vector<NumberField> known = number_fields(d);
  const std::string path = path_in(known, scatter.path);
  if (path.empty()) return d;  // this kind of texture does not have it
  const NumberField field = find_number_field(known, path);
  const double unit = find_unit(field.unit)->to_si;
  *field.value =
      std::clamp(*field.value + task.sign * scatter.tolerance, field.low * unit, field.high * unit);
  return d;
}

// What is wrong with the shape, as designed or within its scatter; empty: nothing.
std::string StudyProblem::problem_of(const Design& design) const {
  if (const auto wrong = design_problems(design); !wrong.empty())
    return wrong.front().path + ": " + wrong.front().message;
  for (const StudyTask& task : tasks_) {
    if (task.scattered < 0) continue;
    const auto wrong = design_problems(task_design(design, task));
    if (!wrong.empty())
      return wrong.front().path + ": within the scatter, " + wrong.front().message;
    if (task.scattered + 1 == static_cast<int>(study_.scatter.size()) && task.sign > 0)
      break;  // shapes are the same for every finger
  }
  return {};
}

std::vector<double> StudyProblem::geometry(const Point& unit) const {
  const Design d = design(unit);
  std::vector<double> out{problem_of(d).empty() ? -1.0 : 1.0};
  if (out.front() <= 0 && needs_appearance() && !look_refusal(d).empty()) out.front() = 1;
  for (const Constraint& c : study_.constraints) {
    if (needs_evaluation(c) || of_appearance(c)) continue;
    out.push_back(relative_violation(shape_value(c.name, d), c.limit, c.at_least));
  }
  return out;
}

bool StudyProblem::limits_look() const {
  return std::any_of(study_.constraints.begin(), study_.constraints.end(),
                     [&](const Constraint& c) { return !needs_evaluation(c) && of_appearance(c); });
}

std::vector<double> StudyProblem::look(const Point& unit) const {
  std::vector<double> out;
  if (!limits_look()) return out;
  const Design d = design(unit);
  // A shape that cannot be judged has no numbers to compare.
  const bool judged = problem_of(d).empty() && look_refusal(d).empty();
  const Optics optics = judged ? appearance_of(d) : Optics{};
  for (const Constraint& c : study_.constraints) {
    if (needs_evaluation(c) || !of_appearance(c)) continue;
    out.push_back(judged ? relative_violation(look_value(c.name, optics), c.limit, c.at_least)
                         : 1.0);
  }
  return out;
}

std::string StudyProblem::geometry_reason(const Point& unit) const {
  const Design d = design(unit);
  if (const std::string wrong = problem_of(d); !wrong.empty()) return wrong;
  if (needs_appearance()) {
    if (const std::string why = look_refusal(d); !why.empty()) return why;
  }
  for (const Constraint& c : study_.constraints) {
    if (needs_evaluation(c)) continue;
    const double value =
        of_appearance(c) ? look_value(c.name, appearance_of(d)) : shape_value(c.name, d);
    if (relative_violation(value, c.limit, c.at_least) <= 0) continue;
    const auto [u, scale] = unit_of(c);
    return fmt::format("{} {:.3g} {} is {} {:.3g} {}", c.name, value * scale, u,
                       c.at_least ? "below" : "above", c.limit * scale, u);
  }
  return {};
}

// info of a task: a summary and its error an objective, worst modulation, oxide margin, the metric
// of each objective at each humidity, then haze, transmittance, gloss and colour where asked for,
// then the summary of each constraint on a metric; of confirmed designs also the steps of the
// parameters.
Outcome StudyProblem::evaluate_task(const Design& base, std::size_t index, const Fidelity& fidelity,
                                    bool report) const {
  const StudyTask& task = tasks_.at(index);
  const Design d = task_design(base, task);
  Outcome out;
  if (const auto wrong = design_problems(d); !wrong.empty()) {
    out.reason = wrong.front().path + ": " + wrong.front().message;
    return out;
  }
  // Finalists are worth the target of the study; the search is not.
  const Scene scene = scene_of(d);
  Response response = report && d.accuracy.target > 0
                          ? evaluate_to_target(scene, d.texture,
                                               {.target = d.accuracy.target,
                                                .first_skin = fidelity.first_skin,
                                                .seed = fidelity.seed,
                                                .threads = fidelity.threads})
                          : evaluate(scene, d.texture, fidelity);
  if (needs_appearance()) {
    response.appearance = appearance_of(d);
    if (response.appearance->refused()) {
      out.reason = response.appearance->warning;
      return out;
    }
  }
  // No equilibrium: no friction to judge.
  const std::vector<PointTrouble> troubles = response.troubles();
  if (std::any_of(troubles.begin(), troubles.end(),
                  [](const PointTrouble& t) { return t.status.pull_in(); })) {
    out.reason = task.name + ", " + text(troubles);
    return out;
  }
  if (!voltage_targets_.empty())
    add_voltages(response, scene_of(d), d.texture, fidelity, voltage_targets_);
  if (report && index < nominal_ && d.accuracy.parameters && !scene.finger.uncertainty.empty())
    add_parameter_errors(response, scene, d.texture, steps_fidelity(fidelity));
  std::vector<double> limited;
  for (const auto* list : {&objectives_, &limited_}) {
    for (const StudyObjective& o : *list) {
      const auto value = summarise(o.expression.summary, o.expression.metric, response);
      if (!value || !std::isfinite(value->value)) {
        const std::string why = why_undefined(o.expression.metric, response);
        out.info.clear();
        out.reason = o.name + " is not defined for " + task.name + (why.empty() ? "" : ": " + why);
        return out;
      }
      if (list == &limited_) {
        limited.push_back(value->value);
      } else {
        out.info.push_back(o.aimed ? distance(o, response) : value->value);
        ErrorParts own = value->parts;
        own.parameters.reset();
        out.info.push_back(own.total());
      }
    }
  }
  double worst = 0, margin = kInfinity;
  if (const auto w = summarise(Summary::Worst, "modulation", response)) worst = w->value;
  for (const ResponsePoint& p : response.points) margin = std::min(margin, p.oxide_margin);
  out.info.push_back(worst);
  out.info.push_back(margin);
  for (const StudyObjective& o : objectives_) {
    for (const ResponsePoint& p : response.points) {
      const auto value = metric_at(o.expression.metric, p);
      const auto same = summarise(Summary::Mean, o.expression.metric, response);
      out.info.push_back(value ? value->value : same ? same->value : 0);
    }
  }
  if (const auto& look = response.appearance)
    for (const double v : {look->haze, look->transmittance, look->gloss, look->colour_shift})
      out.info.push_back(v);
  out.info.insert(out.info.end(), limited.begin(), limited.end());
  if (report) {
    const std::vector<double> samples = sample_numbers(response);
    out.info.insert(out.info.end(), samples.begin(), samples.end());
  }
  if (!response.parameters.steps.empty()) {
    const std::vector<double> steps = step_numbers(response);
    out.info.insert(out.info.end(), steps.begin(), steps.end());
  }
  out.ok = true;
  if (report) out.reason = response_json(response, false);
  return out;
}

// Skins are shared out over the population, as in the search.
Fidelity StudyProblem::steps_fidelity(Fidelity fidelity) const {
  fidelity.skins = std::max(2, kStepSkins / static_cast<int>(nominal_));
  fidelity.grid = kStepGrid;
  return fidelity;
}

// Of each number of a task that an objective is made of: of each list of samples the count and
// they.
std::vector<double> StudyProblem::sample_numbers(const Response& response) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < objectives_.size(); ++k) {
    const MetricExpression& e = objectives_[k].expression;
    for (std::size_t i = 0; i < entries(k).size(); ++i) {
      const ErrorSamples samples = by_points(k) ? error_samples_at(i, e.metric, response)
                                                : error_samples(e.summary, e.metric, response);
      for (const auto list : kSampleLists) {
        out.push_back(static_cast<double>((samples.*list).size()));
        out.insert(out.end(), (samples.*list).begin(), (samples.*list).end());
      }
    }
  }
  return out;
}

// An objective: the number of its directions, and of each the number of its samples and they.
std::vector<double> StudyProblem::step_numbers(const Response& response) const {
  std::vector<double> out;
  for (const StudyObjective& o : objectives_) {
    const StepSamples steps = steps_of(o, response);
    out.push_back(static_cast<double>(steps.size()));
    for (const std::vector<double>& samples : steps) {
      out.push_back(static_cast<double>(samples.size()));
      out.insert(out.end(), samples.begin(), samples.end());
    }
  }
  return out;
}

Outcome StudyProblem::evaluate_steps(const Design& base, std::size_t task,
                                     const Fidelity& fidelity) const {
  const Design d = task_design(base, tasks_.at(task));
  const Scene scene = scene_of(d);
  Response response;
  response.driven = d.drive.driven();
  if (needs_appearance()) response.appearance = appearance_of(d);
  add_parameter_errors(response, scene, d.texture, steps_fidelity(fidelity));
  Outcome out;
  out.ok = true;
  out.info = step_numbers(response);
  return out;
}

Score StudyProblem::score(const std::vector<Outcome>& tasks) const {
  PAPILLA_CHECK(tasks.size() == tasks_.size(), "one outcome a task");
  Score score;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    if (!tasks[t].ok) {
      score.reason = tasks_[t].name + ": " + tasks[t].reason;
      return score;
    }
    if (t < nominal_) score.reports.push_back(tasks[t].reason);
  }
  const std::size_t m = objectives_.size();
  const std::size_t humidities = study_.design.environment.relative_humidity.size();
  std::vector<std::vector<double>> numbers, rest;  // of each task: the usual ones, what follows
  for (const Outcome& task : tasks) {
    PAPILLA_CHECK(task.info.size() >= task_numbers(), "numbers of a task");
    const auto end = task.info.begin() + static_cast<std::ptrdiff_t>(task_numbers());
    numbers.emplace_back(task.info.begin(), end);
    rest.emplace_back(end, task.info.end());
  }
  for (std::size_t k = 0; k < m; ++k) {
    double error = 0, total = 0;
    for (std::size_t t = 0; t < nominal_; ++t) {
      error += tasks_[t].weight * numbers[t][2 * k + 1];  // tasks share skins: they add linearly
      total += tasks_[t].weight;
    }
    score.values.push_back(combined(k, numbers, &score.residuals));
    score.errors.push_back(error / total);
  }
  score.worst = kInfinity;
  score.oxide_margin = kInfinity;
  for (const StudyObjective& o : limited_)
    score.limited.push_back(o.maximise ? kInfinity : -kInfinity);
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    if (tasks_[t].weight <= 0) continue;
    score.worst = std::min(score.worst, tasks[t].info[2 * m]);
    score.oxide_margin = std::min(score.oxide_margin, tasks[t].info[2 * m + 1]);
    for (std::size_t j = 0; j < limited_.size(); ++j) {
      const double value = tasks[t].info[task_numbers() - limited_.size() + j];
      double& bad = score.limited[j];
      bad = limited_[j].maximise ? std::min(bad, value) : std::max(bad, value);
    }
  }
  if (needs_appearance()) {  // the same for every finger; a scenario may look otherwise: the worst
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      if (tasks_[t].weight <= 0) continue;
      const double* v = &tasks[t].info[2 * m + 2 + m * humidities];
      if (!score.appearance || v[0] > score.appearance->haze) {
        score.appearance.emplace();
        score.appearance->haze = v[0], score.appearance->transmittance = v[1];
        score.appearance->gloss = v[2], score.appearance->colour_shift = v[3];
      }
    }
  }
  add_samples(score, numbers, rest);
  add_steps(score, rest);
  score.ok = true;
  return score;
}

std::size_t StudyProblem::task_numbers() const {
  const std::size_t m = objectives_.size();
  return 2 * m + 2 + m * study_.design.environment.relative_humidity.size() +
         (needs_appearance() ? 4 : 0) + limited_.size();
}

bool StudyProblem::by_points(std::size_t objective) const {
  const StudyObjective& o = objectives_[objective];
  return o.aimed || (risk_.kind != Risk::Kind::Mean && o.expression.summary == Summary::Mean);
}

std::vector<std::size_t> StudyProblem::entries(std::size_t objective) const {
  if (!by_points(objective)) return {2 * objective};
  const std::size_t n = study_.design.environment.relative_humidity.size();
  std::vector<std::size_t> out(n);
  std::iota(out.begin(), out.end(), 2 * objectives_.size() + 2 + objective * n);
  return out;
}

double StudyProblem::combined(std::size_t k, const std::vector<std::vector<double>>& numbers,
                              std::vector<double>* residuals) const {
  const StudyObjective& o = objectives_[k];
  Risk risk = risk_;
  if (!o.aimed && o.expression.summary == Summary::Worst) risk.kind = Risk::Kind::Worst;
  const std::vector<double>& humidity_weights = study_.design.environment.weights;
  const std::vector<std::size_t> own = entries(k);
  std::vector<double> values, weights, nominal;
  for (std::size_t t = 0; t < nominal_; ++t) {
    for (std::size_t i = 0; i < own.size(); ++i) {
      const auto value = [&](const std::vector<double>& info) {
        return o.aimed ? square(info[own[i]] - o.target) : info[own[i]];
      };
      std::vector<double> lower, upper;
      for (std::size_t s = 0; s < study_.scatter.size(); ++s) {
        const std::size_t low = nominal_ + 2 * (t * study_.scatter.size() + s);
        lower.push_back(value(numbers[low]));
        upper.push_back(value(numbers[low + 1]));
      }
      const double weight =
          tasks_[t].weight * (by_points(k) && !humidity_weights.empty() ? humidity_weights[i] : 1);
      const std::vector<double> all =
          scattered_values(risk, o.maximise, value(numbers[t]), lower, upper);
      for (double v : all) {
        values.push_back(v);
        weights.push_back(weight / static_cast<double>(all.size()));
      }
      nominal.push_back(numbers[t][own[i]]);
    }
  }
  if (o.aimed && risk.kind == Risk::Kind::Mean && residuals) {
    // Scatter is in the squares alone: each residual keeps the sign of its nominal distance.
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t i = 0; i < nominal.size(); ++i) {
      residuals->push_back(std::copysign(std::sqrt(std::max(0.0, values[i]) * weights[i] / sum),
                                         nominal[i] - o.target));
    }
  }
  const double value = apply_risk(risk, o.maximise, values, weights);
  return o.aimed ? std::sqrt(std::max(0.0, value)) : value;  // Eq. search.11
}

// Takes the samples off the front of what the tasks have left, and follows the objectives through
// them: all numbers of all tasks without one skin, with the change of grid or method. Eq.
// accuracy.14
void StudyProblem::add_samples(Score& score, const std::vector<std::vector<double>>& numbers,
                               std::vector<std::vector<double>>& rest) const {
  for (const auto& task : rest) {
    if (task.empty()) return;  // not confirmed
  }
  score.samples.resize(objectives_.size());
  std::vector<std::size_t> at(rest.size(), 0);
  for (std::size_t k = 0; k < objectives_.size(); ++k) {
    const std::vector<std::size_t> own = entries(k);
    std::vector<std::vector<ErrorSamples>> of(rest.size());  // [task][entry]
    for (std::size_t t = 0; t < rest.size(); ++t) {
      for (std::size_t i = 0; i < own.size(); ++i) {
        ErrorSamples& samples = of[t].emplace_back();
        for (const auto list : kSampleLists) {
          (samples.*list).resize(static_cast<std::size_t>(rest[t].at(at[t]++)));
          for (double& v : samples.*list) v = rest[t].at(at[t]++);
        }
      }
    }
    for (const auto list : kSampleLists) {
      const std::size_t n = (of[0][0].*list).size();
      bool common = n > 1;
      for (const auto& task : of) {
        for (const ErrorSamples& samples : task) common = common && (samples.*list).size() == n;
      }
      if (!common) continue;
      const bool changes = list != &ErrorSamples::sampling;
      // Of all skins, or without one: the samples of a jackknife the other way round.
      const auto objective = [&](std::optional<std::size_t> skin) {
        std::vector<std::vector<double>> there = numbers;
        for (std::size_t t = 0; t < there.size(); ++t) {
          for (std::size_t i = 0; i < own.size(); ++i) {
            const std::vector<double>& samples = of[t][i].*list;
            const double mean = mean_estimate(samples).value;
            const double rest_of =
                skin ? mean - (samples[*skin] - mean) / static_cast<double>(n - 1) : mean;
            there[t][own[i]] = (changes ? there[t][own[i]] : 0) + rest_of;
          }
        }
        return combined(k, there, nullptr) - (changes ? score.values[k] : 0);
      };
      std::vector<double> without;
      for (std::size_t skin = 0; skin < n; ++skin) without.push_back(objective(skin));
      score.samples[k].*list = jackknife_samples(objective(std::nullopt), without);
    }
    // The tasks state the error of their own summaries, not that of a risk over them.
    const ErrorSamples& samples = score.samples[k];
    if ((by_points(k) || risk_.kind != Risk::Kind::Mean) && samples.sampling.size() > 1) {
      score.errors[k] =
          std::sqrt(square(mean_estimate(samples.sampling).se) + square(grid_error(samples.grid)) +
                    square(method_error(samples.method)));
    }
  }
  for (std::size_t t = 0; t < rest.size(); ++t)
    rest[t].erase(rest[t].begin(), rest[t].begin() + static_cast<std::ptrdiff_t>(at[t]));
}

// Fingers of one uncertainty move together, others on their own; all share their skins.
void StudyProblem::add_steps(Score& score, const std::vector<std::vector<double>>& tasks) const {
  double total = 0;
  for (std::size_t t = 0; t < nominal_; ++t) {
    total += tasks_[t].weight;
    if (tasks.at(t).empty()) return;  // not asked for or not known
  }
  score.parameter_steps.resize(objectives_.size());
  std::vector<std::size_t> at(nominal_, 0);
  for (StepSamples& sums : score.parameter_steps) {
    std::vector<std::size_t> first(nominal_);  // direction of each finger
    bool known = true;
    for (std::size_t t = 0; t < nominal_; ++t) {
      const auto next = [&] { return tasks[t].at(at[t]++); };
      const auto count = static_cast<std::size_t>(next());
      std::size_t same = 0;
      while (tasks_[same].finger.uncertainty != tasks_[t].finger.uncertainty) ++same;
      first[t] = same < t ? first[same] : sums.size();
      known = known && count > 0;
      if (sums.size() < first[t] + count) sums.resize(first[t] + count);
      for (std::size_t k = 0; k < count; ++k) {
        std::vector<double>& sum = sums[first[t] + k];
        const auto skins = static_cast<std::size_t>(next());
        sum.resize(skins, 0);
        for (double& s : sum) s += tasks_[t].weight / total * next();
      }
    }
    if (!known) sums.clear();
  }
}

std::string StudyProblem::parameters_unknown() const {
  for (std::size_t t = 0; t < nominal_; ++t) {
    if (tasks_[t].finger.uncertainty.empty()) return unknown_parameters(tasks_[t].finger);
  }
  return {};
}

std::optional<double> parameter_error(const Score& score, std::size_t objective) {
  if (objective >= score.parameter_steps.size() || score.parameter_steps[objective].empty())
    return std::nullopt;
  return step_error(score.parameter_steps[objective]);
}

std::optional<double> parameter_error(const Score& score, const Score& other,
                                      std::size_t objective) {
  if (!parameter_error(score, objective) || !parameter_error(other, objective)) return std::nullopt;
  StepSamples difference = score.parameter_steps[objective];
  for (std::size_t k = 0; k < difference.size(); ++k) {
    for (std::size_t s = 0; s < difference[k].size(); ++s)
      difference[k][s] -= other.parameter_steps[objective].at(k).at(s);
  }
  return step_error(difference);
}

// Looks of arrays cost about a millisecond and steer the search itself; of others they are known
// with the evaluation.
bool StudyProblem::needs_evaluation(const Constraint& c) const {
  return c.name == "oxide_breakdown_margin" || on_metric(c) || (of_appearance(c) && slow_look_);
}

std::vector<std::string> StudyProblem::never_kept(const std::vector<Evaluation>& tried) const {
  std::vector<std::string> out;
  std::size_t shape = 1, evaluated = 0;  // places in the constraints of a refused, a judged design
  for (const Constraint& c : study_.constraints) {
    const bool judged = needs_evaluation(c);
    const std::size_t place = judged ? evaluated++ : shape++;
    int known = 0, kept = 0;
    for (const Evaluation& e : tried) {
      if (!e.outcome.ok && (judged || place >= e.outcome.constraints.size())) continue;
      ++known;  // what was evaluated keeps every limit of the shape
      kept += (e.outcome.ok && !judged) || e.outcome.constraints[place] <= 0;
    }
    if (known > 0 && kept == 0) out.push_back(constraint_text(c));
  }
  return out;
}

std::size_t StudyProblem::constraints() const {
  return static_cast<std::size_t>(
      std::count_if(study_.constraints.begin(), study_.constraints.end(),
                    [&](const Constraint& c) { return needs_evaluation(c); }));
}

std::size_t StudyProblem::residuals() const {
  const bool squares =
      objectives_.size() == 1 && objectives_[0].aimed && risk_.kind == Risk::Kind::Mean;
  return squares ? nominal_ * study_.design.environment.relative_humidity.size() : 0;
}

Outcome StudyProblem::outcome(const Score& score) const {
  Outcome out;
  out.ok = score.ok;
  if (!score.ok) {
    out.reason = score.reason;
    return out;
  }
  for (std::size_t k = 0; k < objectives_.size(); ++k)
    out.objectives.push_back(objectives_[k].maximise ? -score.values[k] : score.values[k]);
  std::size_t metric = 0;
  for (const Constraint& c : study_.constraints) {
    if (!needs_evaluation(c)) continue;
    const double value = on_metric(c)                ? score.limited[metric++]
                         : c.name == "haze"          ? score.appearance->haze
                         : c.name == "transmittance" ? score.appearance->transmittance
                         : c.name == "gloss"         ? score.appearance->gloss
                         : c.name == "colour_shift"  ? score.appearance->colour_shift
                                                     : score.oxide_margin;
    out.constraints.push_back(relative_violation(value, c.limit, c.at_least));
  }
  out.info = score.residuals;
  out.info.insert(out.info.end(), score.errors.begin(), score.errors.end());
  out.info.push_back(score.worst);
  return out;
}

bool StudyProblem::needs_appearance() const {
  const auto looks = [](const StudyObjective& o) {
    return find_metric(o.expression.metric)->appearance;
  };
  return std::any_of(study_.constraints.begin(), study_.constraints.end(), of_appearance) ||
         std::any_of(objectives_.begin(), objectives_.end(), looks) ||
         std::any_of(limited_.begin(), limited_.end(), looks);
}

bool StudyProblem::feasible(const Score& score, const Point& unit) const {
  const auto kept = [](const std::vector<double>& c) {
    return std::all_of(c.begin(), c.end(), [](double v) { return v <= 0; });
  };
  return outcome(score).feasible() && kept(geometry(unit)) && kept(look(unit));
}

std::string StudyProblem::identity() const {
  std::string out =
      fmt::format("papilla {}, records {}\n", PAPILLA_VERSION, kRecords) + to_toml(study_.design);
  for (const Variable& v : study_.variables) {
    out += fmt::format("{} {:a} {:a}", v.path, v.low, v.high);
    for (double c : v.choices) out += fmt::format(" {:a}", c);
    out += '\n';
  }
  for (const StudyObjective& o : objectives_) out += (o.maximise ? "max " : "min ") + o.name + "\n";
  for (const Scatter& s : study_.scatter) out += fmt::format("{} +- {:a}\n", s.path, s.tolerance);
  out += study_.objective.risk + "\n";
  for (const Constraint& c : study_.constraints) out += fmt::format("{} {:a}\n", c.name, c.limit);
  for (const StudyTask& t : tasks_) {
    out += fmt::format("{} {:a}\n", t.name, t.weight) + to_toml(t.finger);
    for (const Setting& s : t.settings) out += fmt::format("{} {:a}\n", s.path, s.value);
  }
  return out +
         fmt::format("{} {} {}\n", study_.search.method, study_.search.seed, study_.search.drafts);
}

}  // namespace papilla
