// docs/measured/hard_cases.md names tests that exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>

#include "base/files.h"

namespace papilla::tests::map_test {
namespace {

std::set<std::string> test_names() {
  std::set<std::string> names;
  const std::regex test("TEST(?:_F|_P)?\\((\\w+),\\s*(\\w+)\\)");
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(PAPILLA_SOURCE_DIR "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = read_bytes(entry.path().string());
    for (std::sregex_iterator it(text.begin(), text.end(), test), end; it != end; ++it)
      names.insert((*it)[1].str() + "." + (*it)[2].str());
  }
  return names;
}

TEST(HardCaseMap, NamesTestsThatExist) {
  const std::set<std::string> names = test_names();
  const std::string page = read_bytes(PAPILLA_SOURCE_DIR "/docs/measured/hard_cases.md");
  const std::regex mention("`([A-Z]\\w+)\\.(\\w*)(\\*|\\.\\.\\.|)`");
  int mentions = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), mention), end; it != end; ++it) {
    const std::string name = (*it)[1].str() + "." + (*it)[2].str();
    const bool prefix = (*it)[3].length() > 0;
    const auto found = names.lower_bound(name);
    EXPECT_TRUE(found != names.end() &&
                (prefix ? found->compare(0, name.size(), name) == 0 : *found == name))
        << name << " is named in docs/measured/hard_cases.md, no test has that name";
    ++mentions;
  }
  EXPECT_GE(mentions, 30);
}

}  // namespace
}  // namespace papilla::tests::map_test
