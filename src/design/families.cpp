#include "design/families.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/check.h"

namespace papilla {
namespace {

template <std::size_t... I>
Texture make_kind(std::size_t index, std::index_sequence<I...>) {
  Texture out;
  ((I == index ? void(out.kind.emplace<I>()) : void()), ...);
  return out;
}

const Lattice* lattice_of(const Texture& t) {
  if (const auto* holes = std::get_if<HoleArray>(&t.kind)) return &holes->lattice;
  if (const auto* pillars = std::get_if<PillarArray>(&t.kind)) return &pillars->lattice;
  return nullptr;
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
  Texture out =
      make_kind(index, std::make_index_sequence<std::variant_size_v<decltype(Texture::kind)>>());
  Texture own = texture;
  const std::vector<NumberField> from = number_fields(own, "texture");
  const std::vector<NumberField> to = number_fields(out, "texture");
  for (const NumberField& field : from) {
    const std::string path = path_in(to, field.path);
    if (!path.empty()) *find_number_field(to, path).value = *field.value;
  }
  if (const Lattice* lattice = lattice_of(texture)) {
    if (auto* holes = std::get_if<HoleArray>(&out.kind)) holes->lattice = *lattice;
    if (auto* pillars = std::get_if<PillarArray>(&out.kind)) pillars->lattice = *lattice;
  }
  return out;
}

int texture_levels(const Texture& texture) {
  const auto* stack = std::get_if<Stack>(&texture.kind);
  return stack ? static_cast<int>(stack->parts.size()) : 1;
}

Texture with_levels(Texture texture, int levels) {
  auto* stack = std::get_if<Stack>(&texture.kind);
  if (stack && static_cast<int>(stack->parts.size()) > levels)
    stack->parts.resize(static_cast<std::size_t>(levels));
  return texture;
}

std::string path_in(const std::vector<NumberField>& known, const std::string& path) {
  if (has(known, path)) return path;
  constexpr std::array<std::pair<const char*, const char*>, 2> kSame{
      {{".depth", ".height"}, {".diameter", ".width"}}};
  if (!path.starts_with("texture.")) return {};
  for (const auto& [a, b] : kSame) {
    for (const auto& [mine, other] : {std::pair(a, b), std::pair(b, a)}) {
      if (!path.ends_with(mine)) continue;
      const std::string there = path.substr(0, path.size() - std::string(mine).size()) + other;
      if (has(known, there)) return there;
    }
  }
  return {};
}

}  // namespace papilla
