// A lab of two designs and a belief of two hypotheses that is quick to ask.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "design/design.h"
#include "tests/temporary.h"

namespace papilla::tests {

// Six members about the reference finger: three of each hypothesis, apart in what holds back.
inline std::string small_belief() {
  std::string out =
      "schema_version = 1\n[calibrated_for]\ncoupling = \"equilibrium\"\nair_limit = "
      "\"ionisation\"\n";
  int k = 0;
  for (const char* hypothesis : {"air ionises", "air breaks down by field alone"}) {
    for (const double strength : {7.5, 9.0, 10.5}) {
      out += fmt::format(
          "[[member]]\nweight = {}\nhypothesis = \"{}\"\n[member.set]\n\"macro.shear_strength\" = "
          "\"{} MPa\"\n\"skin.rms\" = \"{} nm\"\n",
          1.0 / 6, hypothesis, strength, 190 + 10 * k);
      if (k >= 3) out += "\"model.air_limit\" = \"emission\"\n";
      ++k;
    }
  }
  return out;
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

// deep.toml, shallow.toml and belief.toml in a folder.
inline void write_small_lab(const std::filesystem::path& folder) {
  for (const auto& [name, depth] : {std::pair("deep", 600), std::pair("shallow", 200)}) {
    Design d = read_design(
        find_design("m3_samples/a3h600.toml"),
        {fmt::format("texture.depth={} nm", depth), "accuracy.level=draft", "accuracy.grid=48"});
    d.title = name;
    write_design((folder / (std::string(name) + ".toml")).string(), d);
  }
  write_text(folder / "belief.toml", small_belief());
}

}  // namespace papilla::tests
