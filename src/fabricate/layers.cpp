#include "fabricate/layers.h"

#include <fmt/format.h>

#include <cctype>
#include <string>

#include "base/units.h"

namespace papilla::fabricate {
namespace {

std::string capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

std::string length(double metres, const char* unit) {
  return fmt::format("{:.6g} {}", metres / find_unit(unit)->to_si, unit);
}

LayoutLayer layer_of(const FeatureArray& array, double depth) {
  const bool lines = array.shape == FeatureArray::Shape::Line;
  return {
      1, fmt::format("{}_{}", capitals(array.drawn), array.deep ? "DEEP" : "HIGH"),
      fmt::format(
          "tone: polygons are {}; kind: {}; depth {}; {} {} at the {}; pitch {}{}",
          array.deep ? "deep, what is around them is high" : "high, what is around them is deep",
          array.drawn, length(depth, "nm"), lines ? "width" : "diameter", length(array.width, "um"),
          array.deep ? "land" : "top", length(array.period, "um"),
          lines                              ? ""
          : array.lattice == Lattice::Square ? ", square"
                                             : ", hexagonal")};
}

}  // namespace

std::vector<LayoutLayer> layers_of(const ExportSource& source) {
  const TextureFacts known = facts(source.texture);
  const Planes planes = edge_planes(source.texture, source.heightmap);
  const double depth = planes.high - planes.low;
  if (const FeatureArray* array = array_of(known)) return {layer_of(*array, depth)};
  const int levels = source.options.levels;
  std::vector<LayoutLayer> out;
  for (int k = 1; k <= levels; ++k) {
    out.push_back({k, fmt::format("DEEPER_{}_OF_{}", k, levels),
                   fmt::format("tone: polygons are deep, what is around them is high; kind: {}; "
                               "edge {} of {} below the highest place{}",
                               texture_name(source.texture),
                               length((k - 0.5) / levels * depth, "nm"), length(depth, "nm"),
                               known.cell ? "; pitch " + length(known.cell->x, "um") : "")});
  }
  return out;
}

}  // namespace papilla::fabricate
