#include "report/page_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include "base/digest.h"
#include "base/text.h"
#include "config/describe.h"
#include "forward/forward.h"
#include "geometry/io/files.h"
#include "geometry/texture.h"
#include "report/sums.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    unsigned v = 0;
    for (std::size_t k = 0; k < 3; ++k) v = v << 8 | (k < left ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= left ? kDigits[v >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

// Values as bytes between the lowest and the highest.
Json bytes_json(const Grid& grid, const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double span = *high - *low;
  std::vector<std::uint8_t> bytes;
  for (double v : values) {
    bytes.push_back(span > 0 ? static_cast<std::uint8_t>(std::lround(255 * (v - *low) / span)) : 0);
  }
  return {{"nx", grid.nx}, {"ny", grid.ny}, {"lx", grid.lx},         {"ly", grid.ly},
          {"low", *low},   {"high", *high}, {"bytes", base64(bytes)}};
}

// Heights along the middle of a row of features, on pixels that draw their walls as they are; null
// for a texture that is not drawn of shapes on a lattice. "at": the row's share of the way up.
Json section_json(const Texture& texture, int pixels) {
  // Of a feature's width: a row is off its middle by 1/32 of that at most, where it is .2 %
  // narrower.
  constexpr double kRowsAcross = 16;
  constexpr int kFewest = 16, kMost = 256;
  const TextureFacts of = facts(texture);
  const auto* features = std::get_if<FeatureArray>(&of.outline);
  if (!of.cell || !features) return nullptr;
  const Grid cell = patch_grid(texture, pixels);
  const int rows = static_cast<int>(
      std::clamp(kRowsAcross * cell.ly / features->width, 1.0 * kFewest, 1.0 * kMost));
  const Heightmap h = generate(texture, {pixels, rows, cell.lx, cell.ly});
  // The row that the features cover most: through their middle.
  const auto row_mean = [&](int y) {
    const auto begin = h.z.begin() + static_cast<std::ptrdiff_t>(h.grid.index(0, y));
    return std::accumulate(begin, begin + pixels, 0.0);
  };
  // Rows through like features are equal but for rounding: the first of them, so that the section
  // stays where it is as the design moves.
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const double alike = 1e-6 * pixels * (*high - *low);
  int middle = 0;
  double most = row_mean(0);
  for (int y = 1; y < rows; ++y) {
    const double mean = row_mean(y);
    if ((features->deep ? most - mean : mean - most) > alike)
      std::tie(middle, most) = std::pair(y, mean);
  }
  const auto begin = h.z.begin() + static_cast<std::ptrdiff_t>(h.grid.index(0, middle));
  Json out = bytes_json({pixels, 1, cell.lx, h.grid.dy()}, {begin, begin + pixels});
  out["at"] = (middle + 0.5) / rows;
  return out;
}

// The measures that a section shows, by the names of their keys; null for a kind without a period.
Json measures_json(Texture texture) {
  const Roles role = roles(texture);
  const TextureFacts of = facts(texture);
  if (!role.period || !of.relief.present) return nullptr;
  const auto* features = std::get_if<FeatureArray>(&of.outline);
  Json out{{"raised", features && !features->deep}};
  for (const NumberField& field : number_fields(texture, "texture")) {
    const auto add = [&](const char* measure, const double* value) {
      if (field.value == value)
        out[measure] = {{"name", field.path.substr(field.path.rfind('.') + 1)}, {"value", *value}};
    };
    add("period", role.period);
    add("width", role.width);
    add("depth", role.depth);
  }
  return out;
}

// pixels: along it.
void add_section(const Texture& texture, int pixels, Json& out) {
  if (Json section = section_json(texture, pixels); !section.is_null())
    out["section"] = std::move(section);
  if (Json measures = measures_json(texture); !measures.is_null())
    out["measures"] = std::move(measures);
}

// What the charts need of a response.
Json trimmed(const Json& response) {
  Json points = Json::array();
  for (const Json& p : response.at("points")) {
    Json point;
    for (const char* key : {"relative_humidity", "weight", "F_off", "F_on", "modulation",
                            "capillary_force", "electrostatic_force", "status"}) {
      point[key] = p.at(key);
    }
    points.push_back(std::move(point));
  }
  return points;
}

}  // namespace

Json picture_json(const Grid& grid, const std::vector<double>& values) {
  const int step = std::max(1, (std::max(grid.nx, grid.ny) + kPicturePixels - 1) / kPicturePixels);
  const int nx = grid.nx / step, ny = grid.ny / step;
  std::vector<double> mean;
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      double sum = 0;
      for (int k = 0; k < step * step; ++k)
        sum += values[grid.index(x * step + k % step, y * step + k / step)];
      mean.push_back(sum / (step * step));
    }
  }
  return bytes_json({nx, ny, nx * step * grid.dx(), ny * step * grid.dy()}, mean);
}

Json design_json(const Folder& folder, bool with_flat) {
  const Json metrics = Json::parse(folder.read("metrics.json"));
  Json out;
  for (const char* key : {"variables", "objectives", "worst_modulation", "oxide_breakdown_margin",
                          "feasible", "limits", "stability", "belief", "flat", "parameters"}) {
    if (metrics.contains(key)) out[key] = metrics[key];
  }
  out["tasks"] = Json::array();
  for (const Json& task : metrics.at("tasks")) {
    Json t{{"name", task.at("name")},
           {"weight", task.value("weight", 1.0)},
           {"points", trimmed(task.at("response"))}};
    if (with_flat && task.contains("flat")) t["flat"] = trimmed(task["flat"]);
    out["tasks"].push_back(std::move(t));
  }
  if (with_flat) {
    const Json& response = metrics["tasks"][0]["response"];
    out["plan"] = response.at("plan");
  }
  // What the maps are of: in best/ the design on the grid of the fab.
  const char* made = folder.has("build.toml") ? "build.toml" : "design.toml";
  out["toml"] = folder.read(made);
  const Heightmap h = read_heightmap(folder.file("heightmap.gsf"));
  out["heights"] = picture_json(h.grid, h.z);
  constexpr int kSectionPixels = 4096;
  add_section(read_design(folder.file(made)).texture, kSectionPixels, out);
  return out;
}

Json shape_json(const Texture& texture) {
  const Heightmap h = generate(texture, patch_grid(texture, kPicturePixels));
  Json out{{"heights", picture_json(h.grid, h.z)}};
  constexpr int kSectionPixels = 1024;  // as wide as it is drawn under the hand, a quarter the time
  add_section(texture, kSectionPixels, out);
  return out;
}

Json maps_json(const Design& design, const Fidelity& fidelity, double relative_humidity) {
  const PatchPicture patch =
      picture_patch(scene_of(design), design.texture, fidelity, relative_humidity);
  const Grid& grid = patch.texture.grid;
  Json maps = Json::array();
  const auto add = [&](const char* name, const char* unit, double scale,
                       std::vector<double> values) {
    if (values.size() != grid.size()) return;
    for (double& v : values) v *= scale;
    Json map = picture_json(grid, values);
    map["name"] = name;
    map["unit"] = unit;
    maps.push_back(std::move(map));
  };
  add("gap, drive off", "nm", 1e9, patch.fields.off.gap);
  add("contact pressure, drive off", "MPa", 1e-6, patch.fields.off.pressure);
  if (design.drive.driven()) {
    add("contact pressure, drive on", "MPa", 1e-6, patch.fields.on.pressure);
    add("pull of the field", "MPa", 1e-6, patch.fields.pull.value);
  }
  const auto& water = patch.fields.wetting_off.bridged;
  add("water that bridges the gap", "", 1, std::vector<double>(water.begin(), water.end()));
  return {{"relative_humidity", relative_humidity}, {"maps", maps}};
}

Json field_json(const Design& design) {
  Json out = Json::array();
  for (const double humidity : design.environment.relative_humidity)
    out.push_back(maps_json(design, fidelity_of(design), humidity));
  return out;
}

Json file_list(const Folder& folder) {
  Json out = Json::array();
  for (const std::string& name : lasting_files(folder)) {
    const std::string bytes = folder.read(name);
    out.push_back({{"name", visible(name)}, {"bytes", bytes.size()}, {"sha256", sha256(bytes)}});
  }
  return out;
}

}  // namespace papilla::report
