// Readers of files against changed inputs: whatever the bytes, they return or throw InputError.
// Deterministic. PAPILLA_FUZZ_INPUTS sets the number of inputs a target (default 10,000 for what is
// read from memory, 2,000 from disk, 100 for images).
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
#include "config/node.h"
#include "geometry/io/files.h"
#include "geometry/texture.h"
#include "optim/journal.h"
#include "study/design.h"

namespace papilla {
namespace {

class Folder {
 public:
  Folder() {
    std::string name =
        std::filesystem::temp_directory_path() / ("papilla-fuzz-" + std::string(6, 'X'));
    folder_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(folder_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

std::size_t below(RandomStream& random, std::size_t n) {
  return std::min(n - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(n)));
}

// One to four changes: bits, interesting bytes, deletions, repetitions, tokens, a cut.
std::string mutated(std::string bytes, RandomStream& random) {
  static const std::vector<std::string> tokens{
      "nan",  "-1",    "1e400", "99999999999", "0",   "[",   "]",  "{",    "}",    "\"",
      "\"\"", "\n",    "=",     ".",           "'",   "-0",  "\\", "inf",  "um",   " %",
      "base", "\xff",  "(",     ")",           ",",   "\r",  "#",  "1e-9", "true", "\\u0000",
      "<f8",  "shape", "XRes",  "type",        "0x1", "0x.", "-"};
  const std::size_t changes = 1 + below(random, 4);
  for (std::size_t k = 0; k < changes; ++k) {
    if (bytes.empty()) bytes = tokens[below(random, tokens.size())];
    // Headers matter most: half of the changes fall into the first 512 bytes.
    const std::size_t range =
        below(random, 2) == 0 ? std::min<std::size_t>(bytes.size(), 512) : bytes.size();
    const std::size_t at = below(random, range);
    const std::size_t length = 1 + below(random, std::min<std::size_t>(32, bytes.size() - at));
    switch (below(random, 7)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(random, 8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(random, 256));
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 4:
        bytes.insert(at, tokens[below(random, tokens.size())]);
        break;
      case 5:
        bytes.replace(at, length, tokens[below(random, tokens.size())]);
        break;
      default:
        bytes.resize(at);
    }
  }
  return bytes;
}

std::size_t inputs(std::size_t otherwise) {
  const char* wanted = std::getenv("PAPILLA_FUZZ_INPUTS");
  return wanted ? std::strtoull(wanted, nullptr, 10) : otherwise;
}

// Runs `target` on every seed and on `count` changed ones.
void fuzz(const char* name, const std::vector<std::string>& seeds, std::size_t count,
          const std::function<void(const std::string&)>& target) {
  for (const std::string& seed : seeds) ASSERT_NO_THROW(target(seed)) << name;
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(1, name, i);
    const std::string bytes = mutated(seeds[i % seeds.size()], random);
    try {
      target(bytes);
      ++accepted;
    } catch (const InputError& e) {
      ASSERT_FALSE(e.problems().empty()) << name << " input " << i;
    } catch (const std::exception& e) {
      FAIL() << name << " input " << i << ": " << e.what();
    }
  }
  std::cout << name << ": " << count << " inputs, " << accepted << " accepted\n";
}

std::string design_text(const std::string& name) {
  return read_bytes(std::string(PAPILLA_SOURCE_DIR "/designs/") + name);
}

TEST(Fuzz, Toml) {
  fuzz("toml",
       {design_text("electroadhesive_glass/study.toml"), design_text("fingers/reference.toml")},
       inputs(10000), [](const std::string& bytes) { parse_toml(bytes, "fuzz.toml"); });
}

TEST(Fuzz, Studies) {
  const Folder place;
  const std::string path = place.path("study.toml");
  fuzz("study",
       {read_bytes(PAPILLA_TEST_DATA "/study/tiny.toml"),
        design_text("electroadhesive_glass/study.toml")},
       inputs(2000), [&](const std::string& bytes) {
         std::ofstream(path, std::ios::binary) << bytes;
         read_study(path);
       });
}

TEST(Fuzz, Heightmaps) {
  const Folder place;
  const Texture texture{HoleArray{}};
  const Heightmap h = generate(texture, patch_grid(texture, 16));
  const auto path = [&](const std::string& name) { return place.path(name); };
  write_npy(path("good.npy"), h);
  write_gsf(path("good.gsf"), h, {});
  write_exr(path("good.exr"), h, {});
  write_tiff16(path("good.tif"), h, Polarity::WhiteHigh, {});
  for (const char* ending : {"npy", "gsf", "exr", "tif"}) {
    const std::string bad = path(std::string("bad.") + ending);
    fuzz(ending, {read_bytes(path(std::string("good.") + ending))},
         inputs(ending[0] == 'e' || ending[0] == 't' ? 100 : 2000), [&](const std::string& bytes) {
           std::ofstream(bad, std::ios::binary) << bytes;
           const Heightmap back = read_heightmap(bad, 12e-6);
           ASSERT_EQ(back.z.size(), back.grid.size());
           ASSERT_TRUE(std::isfinite(back.grid.area()) && back.grid.area() > 0);
           for (double z : back.z) ASSERT_TRUE(std::isfinite(z));
         });
  }
}

TEST(Fuzz, JournalLines) {
  Evaluation e{{1.0 / 7, 0.1}, {true, "", {1.0 / 3, 2}, {-0.5}, {7}}};
  std::string good = journal_line(e);
  e.outcome = {false, "crashed", {}, {}, {}};
  std::string failed = journal_line(e);
  good.pop_back();
  failed.pop_back();
  fuzz("journal", {good, failed}, inputs(10000), [&](const std::string& bytes) {
    Evaluation back;
    // The checksum: no changed record is taken for a sound one.
    if (parse_journal_line(bytes, back)) {
      ASSERT_EQ(journal_line(back), bytes + "\n");
    }
  });
}

}  // namespace
}  // namespace papilla
