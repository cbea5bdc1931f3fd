// Files of an export held against their design: what was changed is named, what is sound is not.
#include "fabricate/verify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
#include "fabricate/formats.h"
#include "geometry/io/drawing.h"
#include "geometry/io/layout.h"
#include "report/export.h"
#include "tests/cli/program.h"

namespace papilla::tests {
namespace {

namespace fs = std::filesystem;

std::vector<std::pair<std::string, Texture>> kinds() {
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
  return {{"holes", Texture{holes}},   {"hexagons", Texture{hexagons}},
          {"pillars", Texture{pillars}}, {"grooves", Texture{grooves}},
          {"rough", Texture{rough}},   {"film", Texture{film}},
          {"stack", Texture{stack}},   {"measured", Texture{measured}},
          {"flat", Texture{}}};
}

ExportOptions options_for(const Texture& texture, Polarity polarity) {
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
void write_again(const Folder& folder, const ExportedFile& file, const Heightmap& heights,
                 const Texture& texture, const ExportOptions& options) {
  const FileInfo info;
  const std::function<void(double)> quiet;
  Export out;
  find_export_format(file.format).write({heights, texture, options, info, quiet}, file.path, out);
  (void)folder;
}

bool is_layout(const std::string& format) { return format == "gds" || format == "oasis"; }
bool is_picture(const std::string& format) { return format == "png" || format == "dose"; }
bool shows_depth(const std::string& format) {
  return !is_layout(format) && !is_picture(format) && format != "mask";
}

enum class Corruption { Depth, Width, Polarity, Polygon, Truncated, Swapped, Pixel, Missing };
constexpr int kCorruptions = 8;

// Whether it did something to the file.
bool corrupt(Corruption corruption, const Folder& folder, const Folder& other,
             const ExportedFile& file, RandomStream& random) {
  const Export& made = folder.made();
  Heightmap h = made.heightmap;
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const bool flat = *low == *high;
  switch (corruption) {
    case Corruption::Depth:
      if (!shows_depth(file.format) || flat) return false;
      for (double& z : h.z) z *= 1.01;
      break;
    case Corruption::Width:
      if (file.format == "npy" || is_picture(file.format)) return false;  // say no size
      if (is_layout(file.format)) return false;
      h.grid.lx *= 1.01;
      break;
    case Corruption::Polarity: {
      if (!find_export_format(file.format).needs_polarity || flat) return false;
      ExportOptions options = folder.options();
      options.polarity = *options.polarity == Polarity::WhiteHigh ? Polarity::WhiteDeep
                                                                  : Polarity::WhiteHigh;
      write_again(folder, file, h, made.texture, options);
      return true;
    }
    case Corruption::Polygon: {
      if (!is_layout(file.format)) return false;
      Layout layout = file.format == "gds" ? read_gds(file.path) : read_oasis(file.path);
      std::vector<LayoutPolygon>& polygons = layout.cells.front().polygons;
      const auto some = static_cast<std::size_t>(random.uniform() * static_cast<double>(polygons.size()));
      if (random.uniform() < 0.5) {
        polygons.erase(polygons.begin() + static_cast<std::ptrdiff_t>(some));
      } else {
        for (auto& x : polygons[some].outline.x) x += 5;
      }
      file.format == "gds" ? write_gds(file.path, layout) : write_oasis(file.path, layout);
      return true;
    }
    case Corruption::Truncated: {
      const std::string& bytes = folder.bytes(file.path);
      const auto kept = static_cast<std::size_t>((0.02 + 0.97 * random.uniform()) *
                                                 static_cast<double>(bytes.size()));
      write_bytes(file.path, bytes.substr(0, kept));
      return true;
    }
    case Corruption::Swapped: {
      const std::string theirs = other.path() + "/" + find_export_format(file.format).file;
      if (!fs::exists(theirs) || read_bytes(theirs) == folder.bytes(file.path)) return false;
      write_bytes(file.path, read_bytes(theirs));
      return true;
    }
    case Corruption::Pixel:
      if (!shows_depth(file.format) || flat) return false;
      h.z[h.z.size() / 3] = 0.5 * (*low + *high) + 0.3 * (*high - *low) * (random.uniform() - 0.5);
      if (std::abs(h.z[h.z.size() / 3] - made.heightmap.z[h.z.size() / 3]) < 0.01 * (*high - *low))
        return false;
      break;
    case Corruption::Missing:
      fs::remove(file.path);
      return true;
  }
  write_again(folder, file, h, made.texture, folder.options());
  return true;
}

TEST(Verify, NamesEachOf200CorruptedFilesAndNoOther) {
  const Workplace place;
  std::vector<Folder> folders, others;
  for (const auto& [name, texture] : kinds()) {
    folders.emplace_back(place.path() / name, texture, Polarity::WhiteDeep);
    EXPECT_EQ(folders.back().named(), std::set<std::string>{}) << name << " is sound";
  }
  for (std::size_t i = 0; i < folders.size(); ++i)  // files of the neighbour
    others.push_back(folders[(i + 1) % folders.size()]);
  RandomStream random(24, "corruption", 0);
  const auto draw = [&](std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
  };
  std::map<Corruption, int> done;
  for (int made = 0; made < 200;) {
    const std::size_t kind = draw(folders.size());
    const Folder& folder = folders[kind];
    const ExportedFile& file = folder.made().files[draw(folder.made().files.size())];
    const auto corruption = static_cast<Corruption>(draw(kCorruptions));
    if (!corrupt(corruption, folder, others[kind], file, random)) continue;
    EXPECT_EQ(folder.named(), std::set<std::string>{file.path})
        << "corruption " << static_cast<int>(corruption);
    folder.restore();
    ++made;
    ++done[corruption];
  }
  EXPECT_EQ(done.size(), static_cast<std::size_t>(kCorruptions));
  for (const Folder& folder : folders) EXPECT_EQ(folder.named(), std::set<std::string>{});
}

// What a fault says: a number a maker can act on.
std::string faults_of(const Folder& folder, const std::string& name) {
  std::string out;
  for (const FileVerdict& file : verify_folder(folder.path(), name)) {
    for (const std::string& fault : file.faults) out += fault + "\n";
  }
  return out;
}

TEST(Verify, SaysWhatIsWrongAndByHowMuch) {
  const Workplace place;
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.depth = 100e-9;
  const Folder folder(place.path() / "f", Texture{holes}, Polarity::WhiteDeep);
  const auto again = [&](const HoleArray& made, const char* format) {
    const Heightmap h = generate(Texture{made}, folder.made().heightmap.grid);
    write_again(folder, {format, folder.path() + "/" + find_export_format(format).file}, h,
                Texture{made}, folder.options());
  };
  HoleArray deep = holes;
  deep.depth = 200e-9;  // twice as deep moves the friction by less than the 5 % allowed
  again(deep, "exr");
  EXPECT_NE(faults_of(folder, "heightmap.exr")
                .find("its depth is 200 nm, the design's 100 nm: 1e+02 % more"),
            std::string::npos)
      << faults_of(folder, "heightmap.exr");
  HoleArray wide = holes;
  wide.diameter = 3.3e-6;
  again(wide, "mask");
  EXPECT_NE(faults_of(folder, "mask.tif").find("its critical dimension (by the area of the holes)"),
            std::string::npos)
      << faults_of(folder, "mask.tif");
  again(wide, "gds");
  EXPECT_NE(faults_of(folder, "texture.gds")
                .find("its critical dimension (width of the holes) is 3.3 um, the design's 3 um: 10 "
                      "% more"),
            std::string::npos)
      << faults_of(folder, "texture.gds");
  const std::set<std::string> named = folder.named();
  EXPECT_EQ(named.size(), 3u);
}

// A row of hexagons off its place is seen in a layout whose polygons are all right.
TEST(Verify, KnowsThePlaceOfEveryRow) {
  const Workplace place;
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.lattice = Lattice::Hexagonal;
  const Folder folder(place.path() / "f", Texture{holes}, Polarity::WhiteDeep);
  const std::string path = folder.path() + "/texture.gds";
  Layout layout = read_gds(path);
  const auto block = std::find_if(layout.cells.begin(), layout.cells.end(),
                                  [](const LayoutCell& c) { return c.name == "BLOCK"; });
  ASSERT_NE(block, layout.cells.end());
  block->references.at(1).x += 20;
  write_gds(path, layout);
  EXPECT_NE(faults_of(folder, "texture.gds").find("its holes are up to 20"), std::string::npos)
      << faults_of(folder, "texture.gds");
  block->references.pop_back();
  write_gds(path, layout);
  EXPECT_NE(faults_of(folder, "texture.gds").find("polygons, the design's"), std::string::npos)
      << faults_of(folder, "texture.gds");
}

TEST(Verify, RefusesAFolderWithoutARecord) {
  const Workplace place;
  EXPECT_THROW(verify_folder(place.path().string()), InputError);
  write_bytes((place.path() / kRecordName).string(), "{\"schema\": 1}");
  EXPECT_THROW(verify_folder(place.path().string()), InputError);
  write_bytes((place.path() / kRecordName).string(), "{\"made_from\": {\"design\": 3}}");
  EXPECT_THROW(verify_folder(place.path().string()), InputError);
}

}  // namespace
}  // namespace papilla::tests
