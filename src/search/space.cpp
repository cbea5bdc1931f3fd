#include "search/space.h"

#include <algorithm>
#include <cmath>

#include "design/families.h"

namespace papilla::search {
namespace {

constexpr double kUnitsRound = 1e-9;  // values that differ by less are one, written in two units

}  // namespace

DesignSpace::DesignSpace(const Study& study) : study_(study) {
  for (const Variable& v : study.variables) {
    const std::string section = v.path.substr(0, v.path.find('.'));
    if (std::find(sections_.begin(), sections_.end(), section) == sections_.end())
      sections_.push_back(section);
    Dimension d{v.low, v.high, v.choices, !v.is_kind(), v.excluded};
    std::sort(d.choices.begin(), d.choices.end());
    cube_.dimensions.push_back(d);
  }
  own_value_ = cube_.value(unit_of_study());
  own_beside_.assign(cube_.size(), false);
  const std::vector<double> said = values_of_study();
  for (std::size_t i = 0; i < said.size(); ++i) {
    const Variable& v = study.variables[i];
    const double scale = std::max({std::abs(said[i]), std::abs(own_value_[i]), v.high - v.low});
    const bool fixed = v.choices.empty() ? v.high <= v.low : v.choices.size() == 1;
    if (fixed || std::abs(said[i] - own_value_[i]) <= kUnitsRound * scale) continue;
    own_value_[i] = said[i];
    own_beside_[i] = true;
  }
  cube_.collapse = [this](const Point& u) { return collapsed(u); };
}

std::vector<double> DesignSpace::value(const Point& unit) const {
  std::vector<double> out = cube_.value(unit);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (unit[i] == kBeside) out[i] = own_value_[i];
  }
  return out;
}

Point DesignSpace::with_own_finish(Point unit) const {
  const Point own = unit_of_study();
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (!study_.variables[i].path.starts_with("texture."))
      unit[i] = own_beside_[i] ? kBeside : own[i];
  }
  return unit;
}

bool DesignSpace::is_beside(const Point& unit) {
  return std::find(unit.begin(), unit.end(), kBeside) != unit.end();
}

bool DesignSpace::acts(const std::vector<NumberField>& known, std::size_t variable) const {
  const std::string& own = study_.variables[variable].path;
  const std::string path = path_in(known, own);
  return !path.empty() &&
         (path == own || std::none_of(study_.variables.begin(), study_.variables.end(),
                                      [&](const Variable& v) { return v.path == path; }));
}

bool DesignSpace::acts(const Design& design, std::size_t variable) const {
  const Variable& v = study_.variables[variable];
  if (v.is_kind() || v.is_levels()) return true;
  Design copy = design;
  return acts(number_fields_in(copy, sections_), variable);
}

Design DesignSpace::design_of(const std::vector<double>& v) const {
  Design out = study_.design;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (study_.variables[i].is_kind())
      out.texture = of_kind(out.texture, texture_kinds()[static_cast<std::size_t>(v[i])]);
    if (study_.variables[i].is_levels())
      out.texture = with_levels(std::move(out.texture), static_cast<int>(v[i]));
  }
  const std::vector<NumberField> known = number_fields_in(out, sections_);
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Variable& variable = study_.variables[i];
    if (!variable.is_kind() && !variable.is_levels() && acts(known, i))
      *find_number_field(known, path_in(known, variable.path)).value = v[i];
  }
  return out;
}

Point DesignSpace::unit_of_study() const { return cube_.unit(values_of_study()); }

std::vector<double> DesignSpace::values_of_study() const {
  std::vector<double> value;
  Design copy = study_.design;
  const std::vector<NumberField> known = number_fields_in(copy, sections_);
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
  return value;
}

bool DesignSpace::has_features() const {
  const auto varies = [&](Measure measure) {
    return std::any_of(study_.variables.begin(), study_.variables.end(), [&](const Variable& v) {
      return std::count(v.path.begin(), v.path.end(), '.') == 1 && measure_of(v.path) == measure;
    });
  };
  return varies(Measure::Period) && varies(Measure::Width);
}

std::vector<double> DesignSpace::features(const Point& unit) const {
  return {std::sqrt(facts(design(unit).texture).open_share.value_or(0))};
}

Point DesignSpace::collapsed(const Point& unit) const {
  const bool textured =
      std::any_of(study_.variables.begin(), study_.variables.end(),
                  [](const Variable& v) { return v.path.starts_with("texture."); });
  if (!textured) return unit;
  const auto is_depth = [](const Variable& v) { return measure_of(v.path) == Measure::Depth; };
  Point value = cube_.value(unit);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Variable& v = study_.variables[i];
    if (is_depth(v) && v.choices.empty() && v.low <= 0 && value[i] < kLeastDepth) value[i] = v.low;
  }
  Design d = design(cube_.unit(value));
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
  const std::vector<NumberField> known = number_fields_in(d, sections_);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Variable& v = study_.variables[i];
    if (!v.path.starts_with("texture.") || v.is_kind() || v.is_levels()) continue;
    if (!acts(known, i) || (!decides_relief(v.path) && !has_relief(path_in(known, v.path))))
      value[i] = own_value_[i];
  }
  return cube_.unit(value);
}

std::vector<Point> DesignSpace::starts() const {
  std::vector<Point> out{unit_of_study()};
  const auto add = [&](const Point& u) {
    const Point p = cube_.snapped(u);
    if (std::find(out.begin(), out.end(), p) == out.end()) out.push_back(p);
  };
  for (std::size_t i = 0; i < cube_.size(); ++i) {
    if (study_.variables[i].is_kind()) {  // each kind once
      for (double kind : study_.variables[i].choices) {
        Point value = cube_.value(out.front());
        value[i] = kind;
        add(cube_.unit(value));
      }
      continue;
    }
    if (const auto flat = flat_by(i, out.front())) add(*flat);
  }
  return out;
}

std::optional<Point> DesignSpace::flat_by(std::size_t variable, const Point& unit) const {
  Point flat = unit;
  flat[variable] = 0;
  if (study_.variables[variable].is_kind()) {
    Point value = cube_.value(unit);
    value[variable] =
        study_.variables[variable].low;  // flat, where it is offered: the first of all kinds
    flat = cube_.unit(value);
  }
  const auto has_relief = [this](const Point& p) {
    return facts(design(p).texture).relief.present;
  };
  if (!has_relief(unit) || has_relief(flat)) return std::nullopt;
  return cube_.snapped(flat);
}

std::vector<Point> DesignSpace::corners_and_places(RandomStream& random) const {
  constexpr int kPlaces = 1000;
  constexpr std::size_t kMostCorners = 8;
  const int corners = 1 << std::min(size(), kMostCorners);
  std::vector<Point> out;
  for (int k = 0; k < corners + kPlaces; ++k) {
    Point& unit = out.emplace_back(size());
    for (std::size_t v = 0; v < size(); ++v) {
      const bool at_corner = k < corners && v < kMostCorners;
      unit[v] = at_corner ? static_cast<double>((k >> v) & 1) : random.uniform();
    }
  }
  return out;
}

std::optional<Point> DesignSpace::flattened(const Point& unit) const {
  for (std::size_t i = 0; i < cube_.size(); ++i) {
    if (auto flat = flat_by(i, unit)) return flat;
  }
  return std::nullopt;
}

}  // namespace papilla::search
