#include "papilla/design.h"

#include "api/inside.h"
#include "config/describe.h"

namespace papilla::api {
namespace {

std::vector<std::string> overrides(const Design::Values& values) {
  std::vector<std::string> out;
  for (const auto& [path, value] : values) out.push_back(path + "=" + value);
  return out;
}

std::shared_ptr<const Design::Inside> loaded(Design::Inside inside) {
  return across([&] {
    const std::vector<std::string> changes = overrides(inside.values);
    inside.study = inside.file.empty() ? parse_study(inside.text, "design.toml", changes)
                                       : read_study(inside.file, changes);
    return std::make_shared<const Design::Inside>(std::move(inside));
  });
}

}  // namespace

Heights heights_of(const Heightmap& map) {
  return {map.grid.nx, map.grid.ny, map.grid.dx(), map.grid.dy(), map.z};
}

Heightmap heightmap_of(const Heights& h) {
  Heightmap map{{h.nx, h.ny, h.nx * h.dx, h.ny * h.dy}, h.z};
  if (h.nx < 1 || h.ny < 1 || !(h.dx > 0 && h.dy > 0) || h.z.size() != map.grid.size())
    throw papilla::InputError("heights: expected nx times ny values and pixels above 0 m");
  return map;
}

Design Design::read(const std::string& file, const Values& values) {
  return Design(loaded({file, "", values, {}}));
}

Design Design::parse(const std::string& toml, const Values& values) {
  return Design(loaded({"", toml, values, {}}));
}

Design Design::with(const Values& values) const {
  Inside changed{inside_->file, inside_->text, inside_->values, {}};
  changed.values.insert(changed.values.end(), values.begin(), values.end());
  return Design(loaded(std::move(changed)));
}

Design Design::with(const std::string& path, const std::string& value) const {
  return with(Values{{path, value}});
}

double Design::number(const std::string& path) const {
  return across([&] { return get_number(inside_->design(), path); });
}

std::string Design::title() const { return inside_->design().title; }

std::string Design::toml() const { return resolved_toml(inside_->study); }

Heights Design::heights(int pixels) const {
  return across([&] {
    const Texture& texture = inside_->design().texture;
    if (pixels < 8 || pixels > 65536)
      throw papilla::InputError("heights: expected 8 to 65536 pixels");
    return heights_of(generate(texture, patch_grid(texture, pixels)));
  });
}

Look Design::look() const {
  return across([&] {
    const Optics o = appearance_of(inside_->design());
    return Look{o.haze, o.transmittance, o.gloss, o.colour_shift, o.regime, o.warning};
  });
}

}  // namespace papilla::api
