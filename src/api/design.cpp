#include "papilla/design.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "api/inside.h"
#include "base/units.h"
#include "config/describe.h"
#include "config/node.h"
#include "config/reader.h"
#include "design/title.h"
#include "geometry/measured_map.h"

namespace papilla::api {
namespace {

// One that no simulation settles has its shape, its files and its look all the same.
void read_study_of(Design::Inside& inside) {
  const std::vector<std::string> changes = overrides(inside.values);
  inside.study = inside.file.empty()
                     ? parse_study(inside.text, "design.toml", changes, DesignUse::Drawn)
                     : read_study(inside.file, changes, DesignUse::Drawn);
}

std::shared_ptr<const Design::Inside> loaded(Design::Inside inside) {
  return across([&] {
    read_study_of(inside);
    return std::make_shared<const Design::Inside>(std::move(inside));
  });
}

std::string path_of(const std::pair<std::string, std::string>& value) {
  const std::string& path = value.first;
  return path.ends_with(':') ? path.substr(0, path.size() - 1) : path;
}

// A name with the blanks and quotes around it, as it may be given, taken away.
std::string bare(const std::string& name) {
  const std::size_t begin = name.find_first_not_of(" \"'"), end = name.find_last_not_of(" \"'");
  return begin == std::string::npos ? "" : name.substr(begin, end + 1 - begin);
}

// Whether a path is a key of the section's kind or lies within a list of it: the sections within
// outlive the kind, as the pen that a counterface has (config/reader.h).
bool goes_with_kind(const std::string& path, const std::string& section) {
  if (!path.starts_with(section) || path == section + "type") return false;
  const std::size_t dot = path.find('.', section.size());
  return dot == std::string::npos ||
         (dot + 1 < path.size() && path[dot + 1] >= '0' && path[dot + 1] <= '9');
}

// Takes away what was given for a kind that the new values put another in the place of. The kinds
// themselves stay: each clears what the file has for the one before.
void drop_of_other_kinds(const Design::Inside& before, const Design::Values& values,
                         Design::Inside& changed) {
  std::optional<Document> known;  // made where a kind is named at all
  for (const auto& value : values) {
    const std::string path = path_of(value);
    if (!path.ends_with(".type")) continue;
    if (!known) known.emplace(parse_toml(resolved_toml(before.study), "design.toml"));
    const Node* kind = known->take(path);
    if (!kind || !kind->is_text() || kind->text == bare(value.second)) continue;
    const std::string section = path.substr(0, path.size() - std::string_view("type").size());
    std::erase_if(changed.values,
                  [&](const auto& earlier) { return goes_with_kind(path_of(earlier), section); });
  }
  const auto names_map = [&](const auto& value) {
    return value.second.find(toml_string(changed.drawn->file())) != std::string::npos;
  };
  if (changed.drawn && std::none_of(changed.values.begin(), changed.values.end(), names_map))
    changed.drawn = nullptr;
}

// What is wrong with the sides of drawn heights is said of them, and once: the caller knows no
// texture.width, nor texture.patch where it gave none.
std::vector<Problem> told_of_size(const std::vector<Problem>& problems, const Design::Values& given,
                                  bool repeats) {
  std::vector<Problem> out;
  bool said = false;
  for (const Problem& p : problems) {
    const auto gave_it = [&](const auto& value) { return path_of(value) == p.key; };
    const bool of_size = (p.key == "texture.width" || p.key == "texture.patch") &&
                         std::none_of(given.begin(), given.end(), gave_it);
    if (!of_size) {
      out.push_back(p);
    } else if (!said) {
      out.push_back({"", 0, 0, "size",
                     (p.key == "texture.width" || repeats
                          ? "the width of the map: "
                          : "the patch that a map of this width leaves beside its seam: ") +
                         p.message});
      said = true;
    }
  }
  return out;
}

}  // namespace

std::vector<std::string> overrides(const Design::Values& values) {
  std::vector<std::string> out;
  for (const auto& [path, value] : values) out.push_back(path + "=" + value);
  return out;
}

Look look_of(const Optics& o) {
  return {.haze = o.haze,
          .transmittance = o.transmittance,
          .total_transmittance = o.total_transmittance,
          .gloss = o.gloss,
          .gloss_20 = o.gloss_20,
          .gloss_85 = o.gloss_85,
          .distinctness = o.distinctness,
          .sparkle = o.sparkle,
          .colour_shift = o.colour_shift,
          .regime = text(o.regime),
          .warning = o.warning};
}

Heights heights_of(const Heightmap& map) {
  return {map.grid.nx, map.grid.ny, map.grid.dx(), map.grid.dy(), map.z};
}

Heightmap heightmap_of(const Heights& h) {
  Heightmap map{{h.nx, h.ny, h.nx * h.dx, h.ny * h.dy}, h.z};
  if (h.nx < 1 || h.ny < 1 || !(h.dx > 0 && h.dy > 0) || h.z.size() != map.grid.size())
    throw rooms::InputError("heights: expected nx times ny values and pixels above 0 m");
  if (const std::string why = impossible(map); !why.empty())
    throw wrong("heights", why + " (expected m)");
  return map;
}

Design Design::read(const std::string& file, const Values& values) {
  return across([&] {
    if (file.empty()) throw wrong("file", "expected the name of a file, got an empty text");
    return Design(loaded({own_or_shipped(file), "", values, nullptr, {}}));
  });
}

Design Design::parse(const std::string& toml, const Values& values) {
  return Design(loaded({"", toml, values, nullptr, {}}));
}

Design Design::from_heights(const Heights& heights, const Values& values, bool repeats) {
  return across([&] {
    Inside inside;
    inside.text = "schema_version = 1\n";
    inside.drawn = std::make_shared<const DrawnMap>(heights);
    const double width = inside.drawn->width();
    // One that does not repeat gives room for the seam that makes it periodic. Eq. geometry.4
    const double patch =
        repeats ? width : largest_patch(changes_of_map({inside.drawn->file(), width}));
    inside.values = {{"texture.type", "measured"},
                     {"texture.file", toml_string(inside.drawn->file())},
                     {"texture.width:", format_number(width)},
                     {"texture.patch:", format_number(patch)},
                     {"texture.as_is", repeats ? "true" : "false"}};
    inside.values.insert(inside.values.end(), values.begin(), values.end());
    try {
      return Design(loaded(std::move(inside)));
    } catch (const InputError& error) {
      throw InputError(told_of_size(error.problems(), values, repeats));
    }
  });
}

Design Design::parse(const std::string& toml, const Heights& heights) {
  return across([&] {
    Inside inside;
    inside.text = toml;
    inside.drawn = std::make_shared<const DrawnMap>(heights);
    inside.values = {{"texture.file", toml_string(inside.drawn->file())}};
    return Design(loaded(std::move(inside)));
  });
}

Design Design::with(const Values& values) const {
  return across([&] {
    Inside changed{inside_->file, inside_->text, inside_->values, inside_->drawn, {}};
    drop_of_other_kinds(*inside_, values, changed);
    changed.values.insert(changed.values.end(), values.begin(), values.end());
    read_study_of(changed);
    const std::string title = title_as_set(changed.study.design, overrides(values));
    if (title != changed.study.design.title) {
      changed.values.emplace_back("title", toml_string(title));
      read_study_of(changed);
    }
    return Design(std::make_shared<const Inside>(std::move(changed)));
  });
}

Design Design::with(const std::string& path, const std::string& value) const {
  return with(Values{{path, value}});
}

void Design::require_simulated() const {
  across([&] {
    std::vector<rooms::Problem> problems;
    for (const DesignProblem& p : design_problems(inside_->design()))
      problems.push_back({inside_->file, 0, 0, p.path, p.message});
    if (!problems.empty()) throw rooms::InputError(std::move(problems));
  });
}

double Design::number(const std::string& path) const {
  return across([&] { return get_number(inside_->design(), path); });
}

std::vector<Number> Design::numbers() const {
  rooms::Design copy = inside_->design();
  std::vector<Number> out;
  for (const NumberField& field : number_fields(copy)) {
    const double to_si = find_unit(field.unit)->to_si;
    out.push_back(
        {field.path, field.unit, field.doc, *field.value, field.low * to_si, field.high * to_si});
  }
  return out;
}

const Heights* Design::drawn() const {
  return inside_->drawn ? &inside_->drawn->heights() : nullptr;
}

std::string Design::title() const { return inside_->design().title; }

std::string Design::toml() const { return resolved_toml(inside_->study); }

Heights Design::heights(int pixels) const {
  return across([&] {
    const Texture& texture = inside_->design().texture;
    if (pixels < 8 || pixels > 65536)
      throw rooms::InputError("heights: expected 8 to 65536 pixels");
    return heights_of(generate(texture, patch_grid(texture, pixels)));
  });
}

Look Design::look() const {
  return across([&] { return look_of(appearance_of(inside_->design())); });
}

}  // namespace papilla::api
