// Heightmaps from files, by their endings.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/files.h"
#include "geometry/io/gwy.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/raw.h"

namespace papilla::geometry {

namespace fs = std::filesystem;

std::string lower_ending(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

std::unique_ptr<HeightRows> open_height_rows(const std::string& path, bool any_size,
                                             const std::string& channel) {
  const std::string ending = lower_ending(path);
  const bool picture =
      ending == ".exr" || ending == ".tif" || ending == ".tiff" || ending == ".png";
  const bool one_map =
      picture || ending == ".npy" || ending == ".gsf" || ending == ".x3p" || ending == ".sdf";
  if (one_map && !channel.empty()) {
    throw InputError(
        fmt::format("cannot read {}: files of its kind hold one map, and no channel "
                    "\"{}\"; leave ::{} out",
                    path, channel, channel));
  }
  if (ending == ".gwy") return open_gwy_rows(path, channel);
  if (ending == ".sur") return open_sur_rows(path, channel);
  if (ending == ".npy") return open_npy_rows(path);
  if (ending == ".gsf") return open_gsf_rows(path);
  if (ending == ".x3p") return open_x3p_rows(path);
  if (ending == ".sdf") return open_sdf_rows(path);
  if (picture) return open_image_rows(path, any_size);
  return open_by_gwyddion(path, channel);
}

Heightmap whole_map(HeightRows& rows, double width) {
  const MapHeader& said = rows.header();
  Heightmap h;
  h.grid = {said.nx, said.ny, said.lx > 0 ? said.lx : width,
            said.ly > 0 ? said.ly : width * said.ny / said.nx};
  h.z.resize(h.grid.size());
  for (int row = 0; row < said.ny; ++row)
    rows.next(&h.z[h.grid.index(0, said.top_first ? said.ny - 1 - row : row)]);
  return h;
}

MapName map_name(const std::string& name) {
  const std::size_t colons = name.rfind("::");
  std::error_code missing;
  if (colons == std::string::npos || colons == 0 || fs::exists(name, missing)) return {name, ""};
  return {name.substr(0, colons), name.substr(colons + 2)};
}

MapAnswer read_map(const std::string& name, double width, NotNumbers not_numbers) {
  const auto [path, channel] = map_name(name);
  const std::string ending = lower_ending(path);
  const auto rows = open_height_rows(path, false, channel);
  if (ending == ".npy" && !(width > 0)) {
    throw InputError("cannot read " + path +
                     ": the file holds no lateral size; give it (texture.width of a measured "
                     "texture, the size option of a command)");
  }
  const double said = rows->header().lx;
  if (!(said >= 0 && rows->header().ly >= 0)) {
    throw InputError(
        fmt::format("cannot read {}: the file says that it is {:.6g} um wide and {:.6g} um high, "
                    "and sides are not below 0; correct them in the file, or save it without",
                    path, 1e6 * said, 1e6 * rows->header().ly));
  }
  if (width > 0 && said > 0 && std::abs(width / said - 1) > 1e-6) {
    throw InputError(fmt::format(
        "cannot read {}: the file says that it is {:.6g} um wide, and {:.6g} um were given "
        "(texture.width, the size option of a command); leave that out, or save the file without "
        "a size",
        path, 1e6 * said, 1e6 * width));
  }
  if (not_numbers == NotNumbers::Kept) rows->leave_out_marked();
  MapAnswer out{whole_map(*rows, width), rows->header().made, rows->header().channel,
                rows->header().marked};
  const Heightmap& h = out.map;
  if (!(h.grid.lx > 0 && h.grid.ly > 0 && std::isfinite(h.grid.lx) && std::isfinite(h.grid.ly))) {
    throw InputError(
        "cannot read " + path +
        ": the file does not say its lateral size; give it: texture.width of a measured "
        "texture, --size of papilla surface");
  }
  if (std::min(h.grid.lx, h.grid.ly) < 1e-12 || std::max(h.grid.lx, h.grid.ly) > 1e3) {
    throw InputError(
        fmt::format("cannot read {}: a lateral size of {:.3g} x {:.3g} m; expected 1 pm to 1 km",
                    path, h.grid.lx, h.grid.ly));
  }
  if (not_numbers == NotNumbers::Kept) return out;
  const auto broken = [](double z) { return !std::isfinite(z); };
  if (const auto first = std::find_if(h.z.begin(), h.z.end(), broken); first != h.z.end()) {
    const auto at = static_cast<std::size_t>(first - h.z.begin());
    const auto nx = static_cast<std::size_t>(h.grid.nx);
    throw InputError(fmt::format(
        "cannot read {}: {} of {} heights are no finite numbers, the first in column {} of row {} "
        "(counted from 0, row 0 at y = 0); to fill them from their neighbours: fill = true of a "
        "measured texture, --fill of a command, or papilla surface FILE --fill --out FILLED.gsf",
        path, std::count_if(h.z.begin(), h.z.end(), broken), h.z.size(), at % nx, at / nx));
  }
  return out;
}

Heightmap read_heightmap(const std::string& path, double width, NotNumbers not_numbers) {
  return read_map(path, width, not_numbers).map;
}

}  // namespace papilla::geometry
