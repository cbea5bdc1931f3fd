// Another project, built against the installed tree: by CMake's package and by pkg-config.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "tests/elf.h"
#include "tests/temporary.h"

namespace papilla {
namespace {

namespace fs = std::filesystem;

// Installed once, then moved: nothing in the tree may name the place where it was put.
class Consumer : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    place_ = tests::temporary("place");
    fs::create_directories(place_);
    ASSERT_EQ(run("DESTDIR=" + place_ +
                  "/stage cmake --install " PAPILLA_BUILD_DIR " --prefix /opt/papilla"),
              0);
    fs::rename(place_ + "/stage/opt/papilla", place_ + "/tree");
  }

  // Nothing of the source tree, by name or by environment.
  static int run(const std::string& command) {
    return std::system(
        ("cd " + place_ + " && env -u PAPILLA_DESIGNS " + command + " > output 2> messages")
            .c_str());
  }
  static std::string text(const std::string& file) {
    std::ifstream stream(place_ + "/" + file);
    std::stringstream all;
    all << stream.rdbuf();
    return all.str();
  }
  static std::string find(const std::string& name) {
    for (const auto& entry : fs::recursive_directory_iterator(place_ + "/tree")) {
      if (entry.path().filename() == name) return entry.path().string();
    }
    return "";
  }

  static inline std::string place_;
  static constexpr const char* kChanges =
      " tree/share/papilla/designs/m3_samples/a3h350.toml accuracy.level=draft";
  static constexpr const char* kSource = PAPILLA_SOURCE_DIR "/tests/consumer";
};

TEST_F(Consumer, InstalledBinariesLookForLibrariesBesideThemselves) {
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(place_ + "/tree")) {
    if (entry.is_symlink() || !entry.is_regular_file() || !tests::is_elf(entry.path())) continue;
    EXPECT_EQ(tests::missing_protection(entry.path()), "") << entry.path();
    // Nor does one name the builder's folder: of debugging information alone, the sources.
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    const bool debugged = bytes.find(".debug_info") != bytes.npos;
    EXPECT_EQ(bytes.find(std::string(PAPILLA_SOURCE_DIR) + (debugged ? "/designs" : "/")),
              bytes.npos)
        << entry.path();
    ++seen;
  }
  EXPECT_GE(seen, 3);
}

TEST_F(Consumer, FindsThePackageAndHasTheBytesOfTheCommand) {
  ASSERT_EQ(
      run(std::string("cmake -S ") + kSource + " -B cmake -DCMAKE_PREFIX_PATH=" + place_ + "/tree"),
      0)
      << text("messages");
  ASSERT_EQ(run("cmake --build cmake"), 0) << text("output");
  // A program with the static library in it lies in no tree: it is told where the designs are.
  const std::string told =
      find("libpapilla.so").empty() ? "PAPILLA_DESIGNS=tree/share/papilla/designs " : "";
  ASSERT_EQ(run(told + "cmake/evaluate" + kChanges), 0) << text("messages");
  const std::string library = text("output");
  ASSERT_EQ(run("tree/bin/papilla evaluate tree/share/papilla/designs/m3_samples/a3h350.toml "
                "--set accuracy.level=draft --out evaluated"),
            0)
      << text("messages");
  EXPECT_GT(library.size(), 1000u);
  EXPECT_TRUE(library == text("evaluated/response.json"));
}

TEST_F(Consumer, BuildsByPkgConfig) {
  const std::string pc = find("papilla.pc");
  if (pc.empty()) GTEST_SKIP() << "of the static library CMake alone knows what is behind it";
  const std::string path = "PKG_CONFIG_PATH=" + fs::path(pc).parent_path().string();
  ASSERT_EQ(
      run("sh -c '" + path + " g++ -std=c++20 " + kSource + "/evaluate.cpp -o by_pkgconfig $(" +
          path + " pkg-config --cflags --libs papilla)'"),
      0)
      << text("messages");
  const std::string folder = fs::path(find("libpapilla.so")).parent_path().string();
  EXPECT_EQ(run("LD_LIBRARY_PATH=" + folder + " ./by_pkgconfig none.toml"), 2 << 8);
  EXPECT_EQ(text("messages"), "none.toml: no such file\n");
}

TEST_F(Consumer, FindsImagesAndDesignsInTheMovedTree) {
  EXPECT_EQ(run("tree/bin/papilla export tree/share/papilla/designs/m3_samples/a3h350.toml "
                "--format exr --pixels 64 --out exported"),
            0)
      << text("messages");
  EXPECT_TRUE(fs::exists(place_ + "/exported/heightmap.exr"));
  std::ofstream(place_ + "/based.toml") << "schema_version = 1\nbase = \"m3_samples/flat.toml\"\n";
  EXPECT_EQ(run("tree/bin/papilla explain based.toml"), 0) << text("messages");
  // Without its designs it has none: those of the source that it was built from are not its own.
  const std::string designs = place_ + "/tree/share/papilla/designs";
  fs::rename(designs, place_ + "/elsewhere");
  EXPECT_NE(run("tree/bin/papilla explain based.toml"), 0);
  fs::rename(place_ + "/elsewhere", designs);
}

}  // namespace
}  // namespace papilla
