// The binaries of the build tree: none takes a library from where it is called, and all have the
// protections that cost nothing.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "tests/elf.h"

namespace papilla::tests::binaries_test {
namespace {

namespace fs = std::filesystem;

TEST(LibraryFolders, AreReadOneByOne) {
  const auto folders = [](const char* list) {
    return library_folders(std::string(" 0x1d (RUNPATH)  Library runpath: [") + list + "]\n");
  };
  using List = std::vector<std::string>;
  EXPECT_EQ(folders("/a:$ORIGIN"), (List{"/a", "$ORIGIN"}));
  EXPECT_EQ(folders("/a:"), (List{"/a", ""}));  // as the build tree once had it
  EXPECT_EQ(folders(":"), (List{"", ""}));
  EXPECT_EQ(folders(""), List{""});
  EXPECT_TRUE(library_folders(" 0x1 (NEEDED)  Shared library: [libm.so.6]\n").empty());
}

TEST(Binaries, LookForLibrariesBesideThemselvesAndAreProtected) {
  std::set<std::string> seen;
  for (const auto& entry : fs::recursive_directory_iterator(PAPILLA_BUILD_DIR)) {
    if (!entry.is_regular_file() || entry.is_symlink() || !is_elf(entry.path())) continue;
    if (entry.path().extension() == ".o" ||
        entry.path().string().find("CMakeFiles") != std::string::npos)
      continue;
    EXPECT_EQ(missing_protection(entry.path()), "") << entry.path();
    seen.insert(entry.path().filename().string());
  }
  EXPECT_TRUE(seen.contains("papilla"));
  EXPECT_TRUE(seen.contains("papilla_images.so"));
  EXPECT_GE(seen.size(), 3u);
}

}  // namespace
}  // namespace papilla::tests::binaries_test
