// Corrupted files of exports of all kinds: each is named, and no other.
#include "base/random.h"
#include "geometry/io/drawing.h"
#include "geometry/io/layout.h"
#include "tests/fabricate/exported_folder.h"
#include "tests/support/thorough.h"

namespace papilla::tests::verify_slow_test {
namespace {

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
      options.polarity =
          *options.polarity == Polarity::WhiteHigh ? Polarity::WhiteDeep : Polarity::WhiteHigh;
      write_again(file, h, made.texture, options);
      return true;
    }
    case Corruption::Polygon: {
      if (!is_layout(file.format)) return false;
      Layout layout = file.format == "gds" ? read_gds(file.path) : read_oasis(file.path);
      std::vector<LayoutPolygon>& polygons = layout.cells.front().polygons;
      const auto some =
          static_cast<std::size_t>(random.uniform() * static_cast<double>(polygons.size()));
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
  write_again(file, h, made.texture, folder.options());
  return true;
}

TEST(Verify, NamesEachCorruptedFileAndNoOther) {
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
  for (int made = 0; made < cases(60, 200);) {
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

// Holes of the files are wider than those of the design, by what the process takes.
TEST(Verify, HoldsAFileThatUndoesAProcessAgainstTheDesignWithItUndone) {
  const Workplace place;
  Study study;
  study.design.environment.relative_humidity = {0.35};
  study.design.texture = Texture{HoleArray{.period = 6e-6, .diameter = 3e-6}};
  const auto against = [&](double shrink) {
    ExportOptions options;
    options.formats = {"gsf"};
    options.pixels = 128;
    options.bias.shrink = shrink;
    const Export made = export_design(study.design, options, (place.path() / "out").string());
    const Verification found = verify_export(record_of(study, options, made), 0.2);
    EXPECT_TRUE(found.faults.empty()) << found.faults.front();
    return found.against;
  };
  EXPECT_EQ(against(0), "the design");
  EXPECT_EQ(against(100e-9), "the design with the process undone");
}

}  // namespace
}  // namespace papilla::tests::verify_slow_test
