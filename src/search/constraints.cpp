#include "search/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "base/text.h"
#include "design/families.h"
#include "estimate/voltage.h"

namespace papilla::search {
namespace {

// What a design is in each scenario that counts.
std::vector<Design> in_scenarios(const Study& study, const Design& design) {
  if (study.scenarios.empty()) return {design};
  std::vector<Design> out;
  for (const Scenario& scenario : study.scenarios) {
    if (scenario.weight > 0) out.push_back(with_settings(design, scenario.set));
  }
  return out;
}

// The one that a limit is about; nothing where there is none. Which is the worst depends on the
// limit: gloss falls as haze rises.
std::optional<double> worst_look(const LookLimit& l, bool at_least,
                                 const std::vector<Look>& looks) {
  std::optional<double> out;
  for (const Look& look : looks) {
    const double value = look.*l.number;
    if (!out || (at_least ? value < *out : value > *out)) out = value;
  }
  return out;
}

// A look that is not calculated in a millisecond, of some kind of texture.
bool slow_look(const Study& study) {
  if (!facts(study.design.texture).quick_look) return true;
  for (const Variable& v : study.variables) {
    if (!v.is_kind()) continue;
    for (double kind : v.choices) {
      if (!facts(default_texture(static_cast<std::size_t>(kind))).quick_look) return true;
    }
  }
  return false;
}

// The number that judges a limit; nothing where none of them does.
std::optional<double> number_of(const Constraint& limit, const Judged& judged,
                                const std::vector<double>& numbers) {
  const auto found = std::find(judged.begin(), judged.end(), &limit);
  const auto place = static_cast<std::size_t>(found - judged.begin());
  return place < numbers.size() && found != judged.end() ? std::optional(numbers[place])
                                                         : std::nullopt;
}

// The most that a shape is beyond one of these limits.
double most_beyond(const std::vector<double>& geometry, const Judged& judged,
                   const Judged& limits) {
  double most = -kInfinity;
  for (const Constraint* limit : limits)
    most = std::max(most, *number_of(*limit, judged, geometry));
  return most;
}

LimitedNumbers numbers_of(const Score& score) {
  return {score.oxide_margin, score.looks, score.limited, {}};
}

// When the value of a limit is known.
struct Known {
  bool with_shape = false, with_look = false, with_evaluation = false;
};
struct KnownWhen {
  bool slow_look;

  Known operator()(const ShapeLimit&) const { return {.with_shape = true}; }
  Known operator()(const FilmLimit&) const { return {.with_shape = true, .with_evaluation = true}; }
  Known operator()(const LookLimit&) const {
    return slow_look ? Known{.with_evaluation = true} : Known{.with_look = true};
  }
  Known operator()(const MetricLimit&) const { return {.with_evaluation = true}; }
  Known operator()(const YieldLimit&) const { return {.with_evaluation = true}; }
};

}  // namespace

StudyConstraints::StudyConstraints(const Study& study, const DesignSpace& space,
                                   const std::vector<StudyTask>& tasks, const StudyGoals& goals)
    : study_(study), space_(space), tasks_(tasks), goals_(goals), geometry_{nullptr} {
  const KnownWhen known_when{slow_look(study)};
  for (const Constraint& limit : study.constraints) {
    const Known known = std::visit(known_when, limit.on);
    if (known.with_shape) geometry_.push_back(&limit);
    if (known.with_look) look_.push_back(&limit);
    if (known.with_evaluation) evaluated_.push_back(&limit);
  }
  // The film comes after the shape.
  std::stable_partition(geometry_.begin() + 1, geometry_.end(), [](const Constraint* limit) {
    return std::holds_alternative<ShapeLimit>(limit->on);
  });
}

Judged StudyConstraints::in_before_evaluation() const {
  Judged out = geometry_;
  out.insert(out.end(), look_.begin(), look_.end());
  return out;
}

// Why a design cannot be judged at all; "" where it can.
std::string StudyConstraints::refusal(const Design& design) const {
  const std::string trouble = shape_trouble(study_, tasks_, design);
  if (!trouble.empty() || !goals_.looks) return trouble;
  for (const Design& d : looked_at(design)) {
    if (std::string refused = optics_refusal(d.texture, d.surface, d.view); !refused.empty())
      return refused;
  }
  return {};
}

std::vector<Design> StudyConstraints::looked_at(const Design& design) const {
  std::vector<Design> out;
  for (Design& d : in_scenarios(study_, design)) {
    const bool known = std::any_of(out.begin(), out.end(), [&](const Design& other) {
      return other.texture == d.texture && other.surface == d.surface && other.view == d.view;
    });
    if (!known) out.push_back(std::move(d));
  }
  return out;
}

std::vector<Look> StudyConstraints::looks(const Design& design) const {
  std::vector<Look> out;
  for (const Design& d : looked_at(design)) out.push_back(appearance_of(d));
  return out;
}

double StudyConstraints::film_margin(const Design& design) const {
  if (!goals_.own_amplitude || design.drive.control != DriveControl::Voltage) return kInfinity;
  double out = kInfinity;
  for (const Design& d : in_scenarios(study_, design))
    out = std::min(out, bridged_margin(d.surface, d.texture, d.drive, d.drive.amplitude));
  return out;
}

// Nothing of what an evaluation alone says.
std::optional<double> StudyConstraints::value_before(const Constraint& limit,
                                                     const Design& design) const {
  struct Of {
    const StudyConstraints& all;
    const Design& design;
    bool at_least;

    std::optional<double> operator()(const ShapeLimit& l) const {
      return margin_of(l.margin, facts(design.texture).margins);
    }
    std::optional<double> operator()(const FilmLimit&) const { return all.film_margin(design); }
    std::optional<double> operator()(const LookLimit& l) const {
      return worst_look(l, at_least, all.looks(design));
    }
    std::optional<double> operator()(const MetricLimit&) const { return std::nullopt; }
    std::optional<double> operator()(const YieldLimit&) const { return std::nullopt; }
  };
  return std::visit(Of{*this, design, limit.at_least}, limit.on);
}

// Nothing of what an evaluation does not say: of a look, where it was not asked for one.
std::optional<double> StudyConstraints::value_with(const Constraint& limit,
                                                   const LimitedNumbers& numbers) const {
  struct Of {
    const StudyGoals& goals;
    const LimitedNumbers& numbers;
    bool at_least;

    std::optional<double> operator()(const ShapeLimit&) const { return std::nullopt; }
    std::optional<double> operator()(const FilmLimit&) const { return numbers.oxide_margin; }
    std::optional<double> operator()(const LookLimit& l) const {
      return worst_look(l, at_least, numbers.looks);
    }
    std::optional<double> operator()(const MetricLimit& l) const {
      return numbers.limited.at(goals.place_of(l));
    }
    std::optional<double> operator()(const YieldLimit&) const { return std::nullopt; }
  };
  return std::visit(Of{goals_, numbers, limit.at_least}, limit.on);
}

double StudyConstraints::value(const Constraint& limit, const Design& design,
                               const LimitedNumbers& numbers) const {
  std::optional<double> out = value_with(limit, numbers);
  if (!out) out = value_before(limit, design);
  // Of a film the evaluation knows the field, the design what a bridge leaves.
  if (std::holds_alternative<FilmLimit>(limit.on)) out = std::min(*out, film_margin(design));
  return out.value();
}

std::vector<double> StudyConstraints::geometry(const Design& d) const {
  std::vector<double> out;
  for (const Constraint* limit : geometry_)
    out.push_back(limit ? violation(*limit, value_before(*limit, d).value())
                        : (possible(d) ? -1.0 : 1.0));
  return out;
}

std::vector<double> StudyConstraints::look(const Design& d) const {
  if (look_.empty()) return {};
  // A shape that cannot be judged has no numbers to compare.
  if (!possible(d)) return std::vector<double>(look_.size(), 1.0);
  const std::vector<Look> all = looks(d);
  std::vector<double> out;
  for (const Constraint* limit : look_) {
    const auto& on = std::get<LookLimit>(limit->on);
    out.push_back(violation(*limit, worst_look(on, limit->at_least, all).value()));
  }
  return out;
}

std::vector<double> StudyConstraints::before_evaluation(const Design& d) const {
  std::vector<double> out = geometry(d);
  for (const double v : look(d)) out.push_back(v);
  return out;
}

std::string StudyConstraints::geometry_reason(const Design& d) const {
  if (const std::string wrong = refusal(d); !wrong.empty()) return wrong;
  for (const Constraint* limit : in_before_evaluation()) {
    if (!limit) continue;
    const double value = value_before(*limit, d).value();
    if (!keeps(*limit, value))
      return fmt::format("{} {} is {} {}", limit_name(limit->on), limit_value_text(*limit, value),
                         limit->at_least ? "below" : "above",
                         limit_value_text(*limit, limit->limit));
  }
  return {};
}

std::vector<LimitValue> StudyConstraints::evaluated(const Score& score) const {
  const LimitedNumbers numbers = numbers_of(score);
  std::vector<LimitValue> out;
  for (const Constraint* limit : evaluated_) {
    const bool of_yield = std::holds_alternative<YieldLimit>(limit->on);
    out.push_back(
        {*limit, of_yield ? score.yield.value().share : value_with(*limit, numbers).value()});
  }
  return out;
}

std::vector<double> StudyConstraints::violations(const Score& score) const {
  std::vector<double> out;
  for (const LimitValue& v : evaluated(score)) out.push_back(violation(v.limit, v.value));
  return out;
}

std::vector<LimitValue> StudyConstraints::values(const Design& design, const Score& score) const {
  const LimitedNumbers numbers = numbers_of(score);
  std::vector<LimitValue> out;
  for (const Constraint& limit : study_.constraints) {
    if (!std::holds_alternative<YieldLimit>(limit.on)) {
      out.push_back({limit, value(limit, design, numbers)});
    } else if (score.yield) {
      out.push_back({limit, score.yield->share});
    }
  }
  return out;
}

bool StudyConstraints::kept(const Design& design, const Score& score) const {
  const std::vector<LimitValue> all = values(design, score);
  return refusal(design).empty() &&
         std::all_of(all.begin(), all.end(), [](const LimitValue& v) { return v.kept(); });
}

std::vector<std::string> StudyConstraints::never_kept(const std::vector<Evaluation>& tried) const {
  const Judged refused = in_before_evaluation();
  std::vector<std::string> out;
  for (const Constraint& limit : study_.constraints) {
    int known = 0, kept = 0;
    for (const Evaluation& e : tried) {
      const auto beyond =
          number_of(limit, e.outcome.ok ? evaluated_ : refused, e.outcome.constraints);
      if (!beyond && !e.outcome.ok) continue;
      ++known;
      kept += !beyond || *beyond <= 0;  // what was evaluated keeps every limit of the shape
    }
    if (known > 0 && kept == 0)
      out.push_back(fmt::format("{} ({})", limit_name(limit.on), limit_text(limit)));
  }
  return out;
}

std::optional<Contradiction> StudyConstraints::contradiction() const {
  constexpr int kSteps = 600;
  constexpr double kSure = 1e-3;  // the nearest design is farther beyond a limit than this
  const Judged limits(geometry_.begin() + 1, geometry_.end());
  const std::size_t n = space_.size();
  if (limits.empty() || n == 0) return std::nullopt;
  RandomStream random(1, "contradiction");
  struct Tried {
    Point unit;
    std::vector<double> geometry;
  };
  // A flat surface keeps every limit of a shape: it is no answer to whether they go together.
  bool flat_keeps = false;
  const auto judged = [&](const Point& raw) -> std::optional<Tried> {
    const Point unit = space_.snapped(raw);
    const Design design = space_.design(unit);
    std::vector<double> g = geometry(design);
    if (facts(design.texture).relief.present)
      return g.front() <= 0 ? std::optional(Tried{unit, std::move(g)}) : std::nullopt;
    flat_keeps = flat_keeps || std::all_of(g.begin(), g.end(), [](double v) { return v <= 0; });
    return std::nullopt;
  };
  std::vector<Tried> tried;
  const auto consider = [&](const Point& raw) {
    if (auto one = judged(raw)) tried.push_back(*std::move(one));
  };
  for (const Point& start : space_.starts()) consider(start);
  for (const Point& unit : space_.corners_and_places(random)) consider(unit);
  if (tried.empty()) return std::nullopt;  // no such shape: the evaluations say why
  const auto beyond = [&](const Tried& one, const Judged& of) {
    return most_beyond(one.geometry, geometry_, of);
  };
  // The design that is least beyond these limits: the best of all, then smaller and smaller steps.
  const auto nearest = [&](const Judged& of) {
    Tried best = *std::min_element(tried.begin(), tried.end(), [&](const Tried& a, const Tried& b) {
      return beyond(a, of) < beyond(b, of);
    });
    for (int k = 0; k < kSteps && beyond(best, of) > 0; ++k) {
      Point unit = best.unit;
      const double reach = 0.3 * std::pow(1e-4, k / static_cast<double>(kSteps));
      for (double& u : unit) u = std::clamp(u + reach * random.normal(), 0.0, 1.0);
      auto next = judged(unit);
      if (next && beyond(*next, of) < beyond(best, of)) best = *std::move(next);
    }
    return best;
  };
  const auto impossible = [&](const Judged& of) -> std::optional<Contradiction> {
    const Tried best = nearest(of);
    if (beyond(best, of) <= kSure) return std::nullopt;
    const Design d = space_.design(best.unit);
    std::vector<std::string> wanted, had;
    for (const Constraint* limit : of) {
      const std::string name = limit_name(limit->on);
      wanted.push_back(fmt::format("{} ({})", name, limit_text(*limit)));
      had.push_back(
          fmt::format("{} {}", name, limit_value_text(*limit, value_before(*limit, d).value())));
    }
    const std::vector<double> values = space_.value(best.unit);
    std::vector<std::string> where;
    for (std::size_t v = 0; v < n; ++v)
      where.push_back(fmt::format("{} {}", study_.variables[v].path,
                                  variable_text(study_.variables[v], values[v])));
    return Contradiction{
        fmt::format("constraints: no texture of [design_space] keeps {}: the nearest has {} (at "
                    "{}); loosen {} or widen the space",
                    join_names(wanted, " and "), join_names(had), join_names(where),
                    of.size() > 1 ? "one of them" : "it"),
        flat_keeps};
  };
  const auto together = impossible(limits);
  if (!together) return std::nullopt;
  // The fewest that contradict each other: one by itself, two, else all of them.
  for (const Constraint* limit : limits) {
    if (auto one = impossible({limit})) return one;
  }
  for (auto first = limits.begin(); first != limits.end(); ++first) {
    for (auto second = first + 1; second != limits.end(); ++second) {
      if (auto two = impossible({*first, *second})) return two;
    }
  }
  return together;
}

}  // namespace papilla::search
