#include "design/families.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <utility>

#include "base/check.h"

namespace papilla::design {
namespace {

// In the order of Measure.
constexpr std::array<Stated<double*> Roles::*, 5> kMeasures{
    &Roles::period, &Roles::width, &Roles::depth, &Roles::wall_angle, &Roles::edge_radius};

// The numbers of all kinds, which of their keys stand for a measure, and of which a zero means
// flat.
struct Keys {
  std::set<std::string> numbers;
  std::set<std::pair<std::string, Measure>> measures;
  std::set<std::string> relief;
};

const Keys& keys() {
  static const Keys all = [] {
    Keys out;
    for (std::size_t kind = 0; kind < texture_kinds().size(); ++kind) {
      Texture texture = default_texture(kind);
      const Roles role = roles(texture);
      for (const NumberField& field : number_fields(texture)) {
        out.numbers.insert(field.path);
        if (field.value == role.relief) out.relief.insert(field.path);
        for (std::size_t m = 0; m < kMeasures.size(); ++m) {
          if (field.value == role.*kMeasures[m])
            out.measures.emplace(field.path, static_cast<Measure>(m));
        }
      }
    }
    return out;
  }();
  return all;
}

// "texture.parts.1." and "depth"; two empty texts where the path is no texture's.
std::pair<std::string, std::string> split(const std::string& path) {
  if (!path.starts_with("texture.")) return {};
  const std::size_t end = path.rfind('.') + 1;
  return {path.substr(0, end), path.substr(end)};
}

bool has(const std::vector<NumberField>& known, const std::string& path) {
  return std::any_of(known.begin(), known.end(),
                     [&](const NumberField& f) { return f.path == path; });
}

}  // namespace

Texture of_kind(const Texture& texture, const std::string& kind) {
  const auto& kinds = texture_kinds();
  const auto index =
      static_cast<std::size_t>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
  PAPILLA_CHECK(index < kinds.size(), "a texture kind");
  if (texture.kind.index() == index) return texture;
  Texture own = texture, out = default_texture(index);
  const Roles from = roles(own), to = roles(out);
  const bool wide = to.period && to.width;
  const double share = wide ? *to.width / *to.period : 0;
  for (const auto& measure : kMeasures) {
    if (from.*measure && to.*measure) *(to.*measure) = *(from.*measure);
  }
  if (from.lattice && to.lattice) *to.lattice = *from.lattice;
  // Waves have no width, that of sharp ridges is their period.
  if (wide && *to.width >= *to.period && !problems(out).empty()) *to.width = share * *to.period;
  return out;
}

int texture_levels(const Texture& texture) {
  Texture copy = texture;
  const std::vector<Texture>* parts = roles(copy).parts;
  return parts ? static_cast<int>(parts->size()) : 1;
}

Texture with_levels(Texture texture, int levels) {
  std::vector<Texture>* parts = roles(texture).parts;
  if (parts && static_cast<int>(parts->size()) > levels)
    parts->resize(static_cast<std::size_t>(levels));
  return texture;
}

bool last_level_has_relief(const Texture& texture) {
  Texture copy = texture;
  const std::vector<Texture>* parts = roles(copy).parts;
  return facts(parts && !parts->empty() ? parts->back() : texture).relief.present;
}

Texture part_at(const Texture& texture, const std::string& path) {
  const std::string part = "texture.parts.";
  Texture copy = texture;
  const std::vector<Texture>* parts = roles(copy).parts;
  if (!parts || !path.starts_with(part)) return texture;
  std::size_t index = 0;
  const auto [end, error] =
      std::from_chars(path.data() + part.size(), path.data() + path.size(), index);
  if (error != std::errc() || index >= parts->size()) return texture;
  return part_at((*parts)[index],
                 "texture" + path.substr(static_cast<std::size_t>(end - path.data())));
}

std::optional<Measure> measure_of(const std::string& path) {
  const std::string key = split(path).second;
  for (const auto& [name, measure] : keys().measures) {
    if (name == key) return measure;
  }
  return std::nullopt;
}

bool some_kind_has(const std::string& path) { return keys().numbers.contains(split(path).second); }

bool decides_relief(const std::string& path) { return keys().relief.contains(split(path).second); }

std::string path_in(const std::vector<NumberField>& known, const std::string& path) {
  if (has(known, path)) return path;
  const std::optional<Measure> wanted = measure_of(path);
  if (!wanted) return {};
  for (const auto& [key, measure] : keys().measures) {
    const std::string there = split(path).first + key;
    if (measure == *wanted && has(known, there)) return there;
  }
  return {};
}

}  // namespace papilla::design
