// Thirty-five designs of all kinds, under films of all processes: exported, and each map read back
// as any user would, its heights to the rounding of its format and its friction beside the
// design's. The table of results is printed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "fabricate/export.h"
#include "fabricate/formats.h"
#include "fabricate/verify.h"
#include "geometry/io/files.h"
#include "measure/coverage.h"
#include "report/export.h"
#include "tests/fabricate/exported_folder.h"
#include "tests/support/thorough.h"

namespace papilla::tests::maps_back_slow_test {
namespace {

constexpr int kDrawn = 32;  // eight kinds under four films
// Without all of them: each kind once, each film twice, and one that is not drawn.
const std::vector<int> kSample{0, 9, 18, 27, 4, 13, 22, 31, 32};
const std::vector<std::string> kMaps{"exr", "tiff", "tiff32", "gsf", "npy", "x3p"};

Design drawn_design(int index) {
  Design out;
  const auto of_scene = [&](const Scene& scene) {
    out.finger = scene.finger;
    out.surface = scene.surface;
    out.environment = scene.environment;
    out.drive = scene.drive;
    out.model = scene.model;
  };
  if (index < kDrawn) {
    of_scene(random_scene(index, out.texture));
    return out;
  }
  // Kinds that are not drawn, on a planar film.
  Texture other;
  of_scene(random_scene(index, other));
  out.texture = kinds()[static_cast<std::size_t>(index - kDrawn + 5)].second;
  out.surface.process = FilmProcess::Planar;
  out.surface.dielectric = {FilmDielectric{}};
  out.surface.dielectric[0].thickness = 1.5e-6;
  return out;
}

const char* process_of(const Design& design) {
  if (design.surface.dielectric.size() > 1) return "planar, coated";
  switch (design.surface.process) {
    case FilmProcess::Conformal:
      return "conformal";
    case FilmProcess::Directional:
      return "directional";
    case FilmProcess::Planar:
      return "planar";
  }
  return "";
}

// What the format may lose of a height [m].
double rounding(const std::string& format, double depth) {
  if (format == "npy" || format == "x3p") return 1e-18;
  if (format == "tiff") return 0.5001 * depth / 65535 + 1e-18;
  return 1.2e-7 * depth + 1e-18;  // 32 bits
}

double highest(const Heightmap& h) { return *std::max_element(h.z.begin(), h.z.end()); }

constexpr double kMostOff = 0.05;  // of the modulation: what --verify takes where nothing is said

TEST(MapsBack, AreTheDesignInHeightsAndInFriction) {
  const Workplace place;
  std::printf("%3s %-13s %-14s %8s  %-44s %s\n", "", "kind", "film", "depth nm",
              "largest miss of heights, nm", "modulation of the map less the design's, %");
  int beyond = 0;  // those that are more than 2 % off
  // Heights are read back of all. Their friction is that of the EXR, and without all cases that of
  // one other format of each design in turn.
  const std::vector<std::string> felt{"tiff", "npy", "x3p"};
  std::size_t turn = 0;
  std::vector<int> indices(kDrawn + 3);
  std::iota(indices.begin(), indices.end(), 0);
  for (const int index : is_thorough() ? indices : kSample) {
    Study study;
    study.design = drawn_design(index);
    ExportOptions options;
    options.pixels = 256;
    options.polarity = Polarity::WhiteDeep;
    options.formats = kMaps;
    const std::string folder = (place.path() / std::to_string(index)).string();
    const Export made = export_with_record(study, options, folder);
    for (const FileVerdict& file : verify_folder(folder))
      EXPECT_EQ(file.state, FileState::Sound) << file.path << ": " << file.faults.at(0);
    const double top = highest(made.heightmap),
                 depth = top - *std::min_element(made.heightmap.z.begin(), made.heightmap.z.end());
    const Verification own =
        verify_export(record_of(study, options, made), kMostOff);  // of the EXR
    EXPECT_TRUE(own.faults.empty()) << folder << ": " << own.faults.at(0);
    EXPECT_EQ(own.merit, "mean(modulation)");
    beyond += own.loss > 0.02;
    std::string heights, friction = fmt::format("exr {:.2g}", 100 * (own.file / own.design - 1));
    for (const ExportedFile& file : made.files) {
      const double width = file.format == "npy" ? made.heightmap.grid.lx : 0;
      const Heightmap back = read_heightmap(file.path, width);
      ASSERT_EQ(back.z.size(), made.heightmap.z.size());
      const double its_top = highest(back);
      double miss = 0;
      for (std::size_t i = 0; i < back.z.size(); ++i)
        miss = std::max(miss, std::abs((back.z[i] - its_top) - (made.heightmap.z[i] - top)));
      // Both ends are rounded.
      EXPECT_LE(miss, 2 * rounding(file.format, std::max(depth, std::abs(top))) + 1e-22)
          << file.path;
      heights += fmt::format(" {} {:.1g}", file.format, 1e9 * miss);
      const auto place_of = std::find(felt.begin(), felt.end(), file.format);
      if (place_of == felt.end() || !(is_thorough() || *place_of == felt[turn % felt.size()]))
        continue;
      const Verification map = verify_export(study, file.path, kMostOff, width);
      EXPECT_TRUE(map.faults.empty()) << file.path << ": " << map.faults.at(0);
      friction += fmt::format(" {} {:.2g}", file.format, 100 * (map.file / map.design - 1));
    }
    std::printf("%3d %-13s %-14s %8.1f %s  %s\n", index, texture_name(study.design.texture).c_str(),
                process_of(study.design), 1e9 * depth, heights.c_str(), friction.c_str());
    std::fflush(stdout);
    ++turn;
  }
  EXPECT_LE(beyond, 1);  // particles, whose steep sides are a pixel wide
}

// `papilla export STUDY --verify` of everything that Papilla brings. Each is held against its
// design; what is felt of it, which is most of the time, of some without all cases.
TEST(MapsBack, OfEveryStudyInTheDesignsFolderAreSound) {
  const Workplace place;
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(PAPILLA_DESIGNS_DIR)) {
    const std::string path = entry.path().string();
    if (entry.path().extension() != ".toml" || path.find("/fingers/") != std::string::npos ||
        path.find("/physics/") != std::string::npos)
      continue;
    if (read_study(path).is_study()) files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  EXPECT_GE(files.size(), 8u);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& file = files[i];
    const bool felt = i % static_cast<std::size_t>(cases(6, 1)) == 0;
    const Outcome run = place.run("export '" + file + "' --pixels 512 --polarity white-deep" +
                                  (felt ? " --verify" : "") + " --out '" + std::to_string(i) + "'");
    const std::string last = run.out.substr(run.out.rfind('\n', run.out.size() - 2) + 1);
    std::printf("%s: %d, %s", file.c_str() + std::string(PAPILLA_DESIGNS_DIR).size() + 1,
                run.status, last.c_str());
    std::fflush(stdout);
    EXPECT_EQ(run.status, 0) << file << ": " << run.err;
  }
}

}  // namespace
}  // namespace papilla::tests::maps_back_slow_test
