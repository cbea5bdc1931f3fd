#include "report/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "geometry/io/files.h"
#include "geometry/io/legend.h"

namespace papilla::report {
namespace {

constexpr const char* kPictures[] = {"gap", "pressure_off", "pressure_on", "pull", "water"};

// In percent, with as many digits as tell them apart.
std::vector<std::string> humidity_names(const std::vector<double>& humidities) {
  for (int digits = 0;; ++digits) {
    std::vector<std::string> out;
    for (const double humidity : humidities)
      out.push_back(fmt::format("{:.{}f}", 100 * humidity, digits));
    constexpr int kMost = 15;  // digits of a double
    const bool apart = std::set<std::string>(out.begin(), out.end()).size() == out.size();
    if (apart || digits == kMost) return out;
  }
}

}  // namespace

void write_field_pictures(const std::string& folder, const Design& design,
                          const Fidelity& fidelity) {
  const std::vector<double>& humidities = design.environment.relative_humidity;
  const std::vector<std::string> names = humidity_names(humidities);
  for (std::size_t i = 0; i < humidities.size(); ++i) {
    const PatchPicture picture =
        picture_patch(scene_of(design), design.texture, fidelity, humidities[i]);
    const Grid& grid = picture.texture.grid;
    const auto write = [&](const char* name, const std::vector<double>& values,
                           const FieldScale& shown) {
      if (values.size() != grid.size()) return;
      const std::string path = fmt::format("{}/{}_{}", folder, name, names[i]);
      const FieldPicture drawn = picture_with_legend(grid, values, shown);
      write_png_rgb(path + ".png", drawn.width, drawn.height, drawn.rgb);
      write_npy(path + ".npy", Heightmap{grid, values});
    };
    const FieldScale nm{1e9, "nm"}, kpa{1e-3, "kPa"}, pressure{1e-6, "MPa", true};
    write("gap", picture.fields.off.gap, nm);
    write("pressure_off", picture.fields.off.pressure, pressure);
    write("pressure_on", picture.fields.on.pressure, pressure);
    write("pull", picture.fields.pull.value, kpa);
    const auto& bridged = picture.fields.wetting_off.bridged;
    write("water", std::vector<double>(bridged.begin(), bridged.end()), {});
  }
}

void remove_field_pictures(const std::string& folder) {
  if (!std::filesystem::exists(folder + "/response.json")) return;  // not a folder of results
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string extension = entry.path().extension(), stem = entry.path().stem();
    const std::size_t bar = stem.rfind('_');
    if ((extension != ".png" && extension != ".npy") || bar == std::string::npos) continue;
    const bool numbered = bar + 1 < stem.size() &&
                          stem.find_first_not_of("0123456789.", bar + 1) == std::string::npos;
    if (numbered && std::find(std::begin(kPictures), std::end(kPictures), stem.substr(0, bar)) !=
                        std::end(kPictures))
      old.push_back(entry.path());
  }
  for (const auto& path : old) std::filesystem::remove(path);
}

}  // namespace papilla::report
