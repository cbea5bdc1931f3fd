// Exports of every kind of texture and of all files that it allows, small enough to be judged
// often.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "fabricate/formats.h"
#include "fabricate/verify.h"
#include "report/export.h"
#include "tests/cli/program.h"

namespace papilla::tests {

namespace fs = std::filesystem;

inline std::vector<std::pair<std::string, Texture>> kinds() {
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.depth = 200e-9;
  HoleArray hexagons = holes;
  hexagons.lattice = Lattice::Hexagonal;
  PillarArray pillars;
  pillars.period = 5e-6, pillars.diameter = 2e-6, pillars.height = 150e-9;
  Grating grooves;
  grooves.period = 4e-6, grooves.width = 1.5e-6, grooves.depth = 120e-9;
  RandomRough rough;
  rough.rms = 30e-9;
  ParticleFilm film;
  Stack stack;
  stack.parts = {Texture{holes}, Texture{rough}};
  Measured3d measured;
  measured.file = PAPILLA_DESIGNS_DIR "/measured_surface/scan.gsf";
  return {
      {"holes", Texture{holes}},     {"hexagons", Texture{hexagons}}, {"pillars", Texture{pillars}},
      {"grooves", Texture{grooves}}, {"rough", Texture{rough}},       {"film", Texture{film}},
      {"stack", Texture{stack}},     {"measured", Texture{measured}}, {"flat", Texture{}}};
}

inline ExportOptions options_for(const Texture& texture, Polarity polarity) {
  ExportOptions options;
  options.pixels = 64;
  options.polarity = polarity;
  options.dose_curve = DoseCurve{{0, 2e-6}, {0, 255}};
  options.levels = array_of(facts(texture)) ? 1 : 3;
  for (const ExportFormat& format : export_format_table()) {
    ExportOptions one = options;
    one.formats = {format.name};
    try {
      chosen_formats(texture, one);
      options.formats.push_back(format.name);
    } catch (const InputError&) {  // rough surfaces have no mask
    }
  }
  return options;
}

// An export of every file that a texture allows, of a size that is quick to judge.
class Folder {
 public:
  Folder(const fs::path& path, const Texture& texture, Polarity polarity)
      : path_(path.string()), options_(options_for(texture, polarity)) {
    study_.design.texture = texture;
    made_ = export_with_record(study_, options_, path_);
    for (const ExportedFile& file : made_.files) bytes_[file.path] = read_bytes(file.path);
  }

  const std::string& path() const { return path_; }
  const Export& made() const { return made_; }
  const ExportOptions& options() const { return options_; }
  const std::string& bytes(const std::string& file) const { return bytes_.at(file); }
  void restore() const {
    for (const auto& [path, bytes] : bytes_) {
      if (!fs::exists(path) || read_bytes(path) != bytes) write_bytes(path, bytes);
    }
  }
  // Names of the files that verify does not find sound.
  std::set<std::string> named() const {
    std::set<std::string> out;
    for (const FileVerdict& file : verify_folder(path_)) {
      if (file.state != FileState::Sound) out.insert(file.path);
      EXPECT_EQ(file.state == FileState::Sound, file.faults.empty()) << file.path;
    }
    return out;
  }

 private:
  std::string path_;
  ExportOptions options_;
  Study study_;
  Export made_;
  std::map<std::string, std::string> bytes_;
};

// The file written again from other heights, an other layout or other options.
inline void write_again(const ExportedFile& file, const Heightmap& heights, const Texture& texture,
                        const ExportOptions& options) {
  const FileInfo info;
  const std::function<void(double)> quiet;
  Export out;
  find_export_format(file.format).write({heights, texture, options, info, quiet}, file.path, out);
}

}  // namespace papilla::tests
