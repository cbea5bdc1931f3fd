// What the pages say of the tree is there.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "tests/architecture/source_tree.h"

namespace papilla::tests::pages_test {
namespace {

TEST(Pages, NameFilesThatExist) {
  namespace fs = std::filesystem;
  const fs::path top = PAPILLA_SOURCE_DIR;
  const std::regex path(
      "`((?:src|geometry|optim|include|python|tests|cmake|scripts)/[A-Za-z0-9_./]+)`");
  std::vector<std::string> pages = source_files({"docs", "designs"}, {".md"});
  for (const char* page : {"README.md", "CONTRIBUTING.md"}) pages.push_back(page);
  int seen = 0;
  for (const std::string& page : pages) {
    const std::string text = read_source(top / page);
    for (std::sregex_iterator it(text.begin(), text.end(), path), end; it != end; ++it) {
      const std::string name = (*it)[1];
      // A page may name a header and its source by their common stem.
      EXPECT_TRUE(fs::exists(top / name) || fs::exists(top / (name + ".h")) ||
                  fs::exists(top / (name + ".cpp")))
          << page << ": " << name;
      ++seen;
    }
  }
  EXPECT_GT(seen, 40);
}

}  // namespace
}  // namespace papilla::tests::pages_test
