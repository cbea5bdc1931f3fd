// What reads files of users, each with sound inputs to begin from: for the fuzz test and for
// libFuzzer. A target returns or throws InputError whatever the bytes, and gives no number that is
// not finite.
#pragma once

#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/rooms.h"
#include "config/node.h"
#include "geometry/io/drawing.h"
#include "geometry/io/files.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "geometry/texture.h"
#include "tests/io/instrument_bytes.h"

namespace papilla::tests {

struct FuzzTarget {
  std::string name;
  double share = 0;  // of the inputs of a campaign
  std::vector<std::string> seeds;
  std::function<void(const std::string&)> read;  // throws InputError, or NotFinite
};

// A reader took the bytes and gave a number that is none, or a record that is not what was written.
struct NotFinite {
  std::string what;
};

inline void require_finite(double v, const char* what) {
  if (!std::isfinite(v)) throw NotFinite{what};
}

// The reader of a path, fed from memory.
template <typename Reader>
std::function<void(const std::string&)> from_file(const std::string& path, Reader reader) {
  return [path, reader](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    reader(path);
  };
}

inline std::string design_text(const std::string& name) {
  return read_bytes(std::string(PAPILLA_SOURCE_DIR "/designs/") + name);
}

// Of config and geometry. Files are written into `folder`, the scratch of the targets.
inline std::vector<FuzzTarget> file_targets(const std::string& folder) {
  std::vector<FuzzTarget> out;
  out.push_back({"toml",
                 0.24,
                 {design_text("m3_glass/conformal.toml"), design_text("fingers/reference.toml")},
                 [](const std::string& bytes) { parse_toml(bytes, "fuzz.toml"); }});

  out.push_back({"dose",
                 0.05,
                 {"depth_nm,grey\n0,0\n100,20\n400,100\n900,255\n"},
                 from_file(folder + "/dose.csv", [](const std::string& path) {
                   const DoseCurve curve = read_dose_curve(path);
                   for (double v : curve.depth) require_finite(v, "a depth");
                   for (double v : curve.grey) require_finite(v, "a grey");
                 })});

  const Texture texture{HoleArray{}};
  const Heightmap h = generate(texture, patch_grid(texture, 16));
  write_npy(folder + "/good.npy", h);
  write_gsf(folder + "/good.gsf", h, {});
  write_exr(folder + "/good.exr", h, {});
  write_tiff16(folder + "/good.tif", h, Polarity::WhiteHigh, {});
  for (const auto& [ending, share] : {std::pair("npy", 0.09), std::pair("gsf", 0.09),
                                      std::pair("exr", 0.015), std::pair("tif", 0.015)}) {
    out.push_back({ending,
                   share,
                   {read_bytes(folder + "/good." + ending)},
                   from_file(folder + "/bad." + ending, [](const std::string& path) {
                     const Heightmap back = read_heightmap(path, 12e-6);
                     if (back.z.size() != back.grid.size()) throw NotFinite{"the size of the map"};
                     require_finite(1 / back.grid.area(), "the area");
                     for (double z : back.z) require_finite(z, "a height");
                   })});
  }
  const auto layout = draw_array(std::get<FeatureArray>(facts(texture).outline), 1e-4, 1e-4).layout;
  write_gds(folder + "/good.gds", layout);
  write_oasis(folder + "/good.oas", layout);
  write_x3p(folder + "/good.x3p", h);
  const std::vector<std::pair<std::string, std::function<void(const std::string&)>>> readers{
      {"gds", [](const std::string& path) { read_gds(path); }},
      {"oas", [](const std::string& path) { read_oasis(path); }},
      {"x3p", [](const std::string& path) { whole_map(*open_x3p_rows(path), 0); }}};
  for (const auto& [ending, read] : readers) {
    out.push_back({ending,
                   0.02,
                   {read_bytes(folder + "/good." + ending)},
                   from_file(folder + "/bad." + ending, read)});
  }
  const std::vector<std::pair<const char*, std::vector<std::string>>> instruments{
      {"gwy", {gwy_bytes({{"Height", "m", &h}, {"Phase", "deg", &h}})}},
      {"sur", {sur_bytes(h, {32, false}), sur_bytes(h, {32, true, true})}},
      {"sdf", {sdf_text(h), sdf_binary(h)}}};
  for (const auto& [ending, seeds] : instruments) {
    out.push_back(
        {ending, 0.02, seeds, from_file(folder + "/bad." + ending, [](const std::string& path) {
           const Heightmap back = read_heightmap(path);
           if (back.z.size() != back.grid.size()) throw NotFinite{"the size of the map"};
           for (double z : back.z) require_finite(z, "a height");
         })});
  }
  return out;
}

}  // namespace papilla::tests
