#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>

#include "tests/architecture/source_tree.h"

namespace papilla::tests::format_test {
namespace {

TEST(Sources, AreFormattedByClangFormat) {
  if (std::system("clang-format --version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no clang-format here";
  }
  std::string command = "cd '" PAPILLA_SOURCE_DIR "' && clang-format --dry-run -Werror";
  for (const std::string& file :
       source_files({"src", "geometry", "optim", "include", "python/bindings", "bench", "tests"},
                    {".h", ".cpp"})) {
    command += " '" + file + "'";
  }
  EXPECT_EQ(std::system((command + " 2>&1 | grep -E 'error|warning' | head -n 20 | grep . && "
                                   "exit 1 || exit 0")
                            .c_str()),
            0);
}

// As a word of its own: the pictures in notebooks are long words of any letters.
bool has_word(const std::string& text, const std::string& word) {
  const auto part = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0);
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if (!(at > 0 && part(at - 1)) && !part(at + word.size())) return true;
  }
  return false;
}

TEST(Sources, HaveNoUnfinishedMarks) {
  for (const std::string& file : source_files(
           {"src", "geometry", "optim", "include", "python", "bench", "tests", "designs", "docs"},
           {".h", ".cpp", ".md", ".toml", ".py", ".pyi", ".ipynb"})) {
    if (file == "tests/architecture/format_test.cpp") continue;
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (const char* mark : {"TODO", "FIXME", "XXX", "HACK"}) {
      EXPECT_FALSE(has_word(text, mark)) << file << " has a " << mark;
    }
  }
}

// Two tests at a time that write one name read each other's file, now and then.
TEST(Sources, OfTestsWriteBelowAFolderOfTheirOwn) {
  for (const std::string& file : source_files({"bench", "tests"}, {".h", ".cpp"})) {
    if (file == "tests/architecture/format_test.cpp" || file == "tests/temporary.h") continue;
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (const char* shared : {"TempDir()", "temp_directory_path", "\"/tmp"})
      EXPECT_EQ(text.find(shared), std::string::npos) << file << " writes to " << shared;
  }
}

}  // namespace
}  // namespace papilla::tests::format_test
