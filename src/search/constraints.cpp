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

template <class Look>
double look_value(const std::string& name, const Look& look) {
  if (name == "haze") return look.haze;
  if (name == "transmittance") return look.transmittance;
  if (name == "gloss") return look.gloss;
  return look.colour_shift;
}

double shape_value(const std::string& name, const Design& d) {
  const FabricationMargins m = facts(d.texture).margins;
  if (name == "min_hole") return m.min_hole;
  if (name == "min_wall") return m.min_wall;
  return m.aspect_ratio;
}

std::string look_refusal(const Design& d) {
  return optics_refusal(d.texture, d.surface.refractive_index, d.view);
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

// Of all but the shape itself, the most that one of these is beyond its limit.
double most_beyond(const std::vector<double>& geometry, const std::vector<std::size_t>& limits) {
  double most = -kInfinity;
  for (std::size_t k : limits) most = std::max(most, geometry[1 + k]);
  return most;
}

}  // namespace

StudyConstraints::StudyConstraints(const Study& study, const DesignSpace& space,
                                   const std::vector<StudyTask>& tasks, const StudyGoals& goals)
    : study_(study), space_(space), tasks_(tasks), goals_(goals) {
  const bool slow = slow_look(study);
  for (std::size_t place = 0; place < study.constraints.size(); ++place) {
    switch (limit_on(at(place))) {
      case LimitOn::Shape:
        shape_.push_back(place);
        break;
      case LimitOn::Film:
        film_.push_back(place);
        evaluated_.push_back(place);
        break;
      case LimitOn::Look:
        (slow ? evaluated_ : look_).push_back(place);
        break;
      case LimitOn::Metric:
        evaluated_.push_back(place);
        break;
    }
  }
}

std::vector<Constraint> StudyConstraints::listed(const Places& places) const {
  std::vector<Constraint> out;
  for (std::size_t place : places) out.push_back(at(place));
  return out;
}

StudyConstraints::Places StudyConstraints::cheap() const {
  Places out = shape_;
  out.insert(out.end(), film_.begin(), film_.end());
  return out;
}

std::vector<Constraint> StudyConstraints::judged_by_geometry() const { return listed(cheap()); }
std::vector<Constraint> StudyConstraints::judged_by_evaluation() const {
  return listed(evaluated_);
}

// Why a design cannot be judged at all; "" where it can.
std::string StudyConstraints::refusal(const Design& design) const {
  const std::string trouble = shape_trouble(study_, tasks_, design);
  return trouble.empty() && goals_.looks ? look_refusal(design) : trouble;
}

double StudyConstraints::film_margin(const Design& design) const {
  if (!goals_.own_amplitude || design.drive.control != DriveControl::Voltage) return kInfinity;
  double out = bridged_margin(design.surface, design.texture, design.drive, design.drive.amplitude);
  for (const Scenario& scenario : study_.scenarios) {
    const Design d = with_settings(design, scenario.set);
    out = std::min(out, bridged_margin(d.surface, d.texture, d.drive, d.drive.amplitude));
  }
  return out;
}

double StudyConstraints::cheap_value(std::size_t place, const Design& design) const {
  return limit_on(at(place)) == LimitOn::Film ? film_margin(design)
                                              : shape_value(at(place).name, design);
}

std::vector<double> StudyConstraints::geometry(const Design& d) const {
  std::vector<double> out{refusal(d).empty() ? -1.0 : 1.0};
  for (std::size_t place : cheap()) out.push_back(violation(at(place), cheap_value(place, d)));
  return out;
}

std::vector<double> StudyConstraints::look(const Design& d) const {
  std::vector<double> out;
  if (look_.empty()) return out;
  // A shape that cannot be judged has no numbers to compare.
  const bool judged = refusal(d).empty();
  const Optics optics = judged ? appearance_of(d) : Optics{};
  for (std::size_t place : look_)
    out.push_back(judged ? violation(at(place), look_value(at(place).name, optics)) : 1.0);
  return out;
}

std::string StudyConstraints::geometry_reason(const Point& unit) const {
  const Design d = space_.design(unit);
  if (const std::string wrong = refusal(d); !wrong.empty()) return wrong;
  Places known = cheap();
  known.insert(known.end(), look_.begin(), look_.end());
  for (std::size_t place : known) {
    const Constraint& c = at(place);
    const double value =
        limit_on(c) == LimitOn::Look ? look_value(c.name, appearance_of(d)) : cheap_value(place, d);
    if (!keeps(c, value))
      return fmt::format("{} {} is {} {}", c.name, limit_value_text(c, value),
                         c.at_least ? "below" : "above", limit_value_text(c, c.limit));
  }
  return {};
}

std::vector<double> StudyConstraints::violations(const Score& score) const {
  std::vector<double> out;
  std::size_t metric = 0;
  for (std::size_t place : evaluated_) {
    const Constraint& c = at(place);
    const double value = limit_on(c) == LimitOn::Metric ? score.limited[metric++]
                         : limit_on(c) == LimitOn::Look ? look_value(c.name, *score.look)
                                                        : score.oxide_margin;
    out.push_back(violation(c, value));
  }
  return out;
}

std::vector<LimitValue> StudyConstraints::values(const Design& design, const Score& score) const {
  std::vector<LimitValue> out;
  std::size_t metric = 0;
  for (const Constraint& c : study_.constraints) {
    switch (limit_on(c)) {
      case LimitOn::Shape:
        out.push_back({c, shape_value(c.name, design)});
        break;
      case LimitOn::Film:
        out.push_back({c, std::min(film_margin(design), score.oxide_margin)});
        break;
      case LimitOn::Look:
        out.push_back({c, score.look ? look_value(c.name, *score.look)
                                     : look_value(c.name, appearance_of(design))});
        break;
      case LimitOn::Metric:
        out.push_back({c, score.limited.at(metric++)});
        break;
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
  // A refused design has the shape itself first, then these.
  Places refused = cheap();
  refused.insert(refused.end(), look_.begin(), look_.end());
  const auto place_in = [](const Places& list, std::size_t place) {
    const auto found = std::find(list.begin(), list.end(), place);
    return found == list.end() ? std::nullopt
                               : std::optional(static_cast<std::size_t>(found - list.begin()));
  };
  std::vector<std::string> out;
  for (std::size_t place = 0; place < study_.constraints.size(); ++place) {
    const auto before = place_in(refused, place), with = place_in(evaluated_, place);
    int known = 0, kept = 0;
    for (const Evaluation& e : tried) {
      const std::vector<double>& values = e.outcome.constraints;
      if (!e.outcome.ok && (!before || *before + 1 >= values.size())) continue;
      ++known;  // what was evaluated keeps every limit of the shape
      kept += e.outcome.ok ? !with || values[*with] <= 0 : values[*before + 1] <= 0;
    }
    if (known > 0 && kept == 0)
      out.push_back(fmt::format("{} ({})", at(place).name, limit_text(at(place))));
  }
  return out;
}

std::optional<Contradiction> StudyConstraints::contradiction() const {
  constexpr int kSteps = 600;
  constexpr double kSure = 1e-3;  // the nearest design is farther beyond a limit than this
  const Places limits = cheap();
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
  // The design that is least beyond these limits: the best of all, then smaller and smaller steps.
  const auto nearest = [&](const Places& of) {
    Tried best = *std::min_element(tried.begin(), tried.end(), [&](const Tried& a, const Tried& b) {
      return most_beyond(a.geometry, of) < most_beyond(b.geometry, of);
    });
    for (int k = 0; k < kSteps && most_beyond(best.geometry, of) > 0; ++k) {
      Point unit = best.unit;
      const double reach = 0.3 * std::pow(1e-4, k / static_cast<double>(kSteps));
      for (double& u : unit) u = std::clamp(u + reach * random.normal(), 0.0, 1.0);
      auto next = judged(unit);
      if (next && most_beyond(next->geometry, of) < most_beyond(best.geometry, of))
        best = *std::move(next);
    }
    return best;
  };
  const auto impossible = [&](const Places& of) -> std::optional<Contradiction> {
    const Tried best = nearest(of);
    if (most_beyond(best.geometry, of) <= kSure) return std::nullopt;
    const Design d = space_.design(best.unit);
    std::vector<std::string> wanted, had;
    for (std::size_t k : of) {
      const Constraint& c = at(limits[k]);
      wanted.push_back(fmt::format("{} ({})", c.name, limit_text(c)));
      had.push_back(fmt::format("{} {}", c.name, limit_value_text(c, cheap_value(limits[k], d))));
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
  Places all(limits.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  const auto together = impossible(all);
  if (!together) return std::nullopt;
  // The fewest that contradict each other: one by itself, two, else all of them.
  for (std::size_t k : all) {
    if (auto one = impossible({k})) return one;
  }
  for (std::size_t k : all) {
    for (std::size_t j = k + 1; j < all.size(); ++j) {
      if (auto two = impossible({k, j})) return two;
    }
  }
  return together;
}

}  // namespace papilla::search
