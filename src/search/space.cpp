#include "search/space.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "design/families.h"

namespace papilla {
namespace {

// Shallower relief is none: polished glass is as rough, and no process holds such a depth [m].
// Else a search finds textures of a nanometre whose patch has the luckier skins.
constexpr double kLeastDepth = 2e-9;

}  // namespace

DesignSpace::DesignSpace(const Study& study) : study_(study) {
  for (const Variable& v : study.variables) {
    Dimension d{v.low, v.high, v.choices, !v.is_kind()};
    std::sort(d.choices.begin(), d.choices.end());
    cube_.dimensions.push_back(d);
  }
  own_value_ = cube_.value(unit_of_study());
  cube_.collapse = [this](const Point& u) { return collapsed(u); };
}

bool DesignSpace::acts(const std::vector<NumberField>& known, std::size_t variable) const {
  const std::string& own = study_.variables[variable].path;
  const std::string path = path_in(known, own);
  return !path.empty() &&
         (path == own || std::none_of(study_.variables.begin(), study_.variables.end(),
                                      [&](const Variable& v) { return v.path == path; }));
}

Design DesignSpace::design(const Point& unit) const {
  const std::vector<double> v = cube_.value(unit);
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

Point DesignSpace::unit_of_study() const {
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
  return cube_.unit(value);
}

bool DesignSpace::has_features() const {
  const auto varies = [&](const char* path) {
    return std::any_of(study_.variables.begin(), study_.variables.end(),
                       [&](const Variable& v) { return v.path == path; });
  };
  return varies("texture.period") && (varies("texture.diameter") || varies("texture.width"));
}

std::vector<double> DesignSpace::features(const Point& unit) const {
  return {std::sqrt(open_fraction(design(unit).texture))};
}

Point DesignSpace::collapsed(const Point& unit) const {
  const bool textured =
      std::any_of(study_.variables.begin(), study_.variables.end(),
                  [](const Variable& v) { return v.path.starts_with("texture."); });
  if (!textured) return unit;
  const auto is_depth = [](const Variable& v) {
    return v.path.starts_with("texture.") &&
           (v.path.ends_with(".depth") || v.path.ends_with(".height"));
  };
  Point value = cube_.value(unit);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Variable& v = study_.variables[i];
    if (is_depth(v) && v.choices.empty() && v.low <= 0 && value[i] < kLeastDepth) value[i] = v.low;
  }
  Design d = design(cube_.unit(value));
  const Point& own = own_value_;
  const auto offered = [](const Variable& v, double choice) {
    return std::find(v.choices.begin(), v.choices.end(), choice) != v.choices.end();
  };
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Variable& v = study_.variables[i];
    if (v.is_levels()) {  // a last part of no depth is one level less
      while (const auto* stack = std::get_if<Stack>(&d.texture.kind)) {
        const int levels = static_cast<int>(stack->parts.size());
        if (levels < 2 || texture_depth(stack->parts.back()) > 0 || !offered(v, levels - 1)) break;
        d.texture = with_levels(d.texture, levels - 1);
        value[i] = levels - 1;
      }
    }
    if (v.is_kind() && texture_depth(d.texture) <= 0) {
      value[i] = v.low;  // "flat" is the first of all kinds
      d.texture = of_kind(d.texture, texture_kinds()[static_cast<std::size_t>(v.low)]);
    }
  }
  const auto texture_of = [&](const std::string& path) -> const Texture& {
    constexpr std::string_view kPart = "texture.parts.";
    const auto* stack = std::get_if<Stack>(&d.texture.kind);
    if (!stack || !path.starts_with(kPart)) return d.texture;
    const auto part = static_cast<std::size_t>(std::atoi(path.c_str() + kPart.size()));
    return part < stack->parts.size() ? stack->parts[part] : d.texture;
  };
  const std::vector<NumberField> known = number_fields(d);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Variable& v = study_.variables[i];
    if (!v.path.starts_with("texture.") || v.is_kind() || v.is_levels()) continue;
    if (!acts(known, i) || (!is_depth(v) && texture_depth(texture_of(path_in(known, v.path))) <= 0))
      value[i] = own[i];
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
    value[variable] = study_.variables[variable].low;  // "flat" is the first of all kinds
    flat = cube_.unit(value);
  }
  if (texture_depth(design(unit).texture) <= 0 || texture_depth(design(flat).texture) > 0)
    return std::nullopt;
  return cube_.snapped(flat);
}

std::optional<Point> DesignSpace::flattened(const Point& unit) const {
  for (std::size_t i = 0; i < cube_.size(); ++i) {
    if (auto flat = flat_by(i, unit)) return flat;
  }
  return std::nullopt;
}

}  // namespace papilla
