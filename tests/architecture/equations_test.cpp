// Every equation that the code names is written down, and every equation written down is used.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "tests/architecture/source_tree.h"

namespace papilla::tests::equations_test {
namespace {

// "Eq. contact.3", "Eq. metrics.1-5", "Eq. field.1, field.2": all ids, with a file that names each.
// A mention may be broken over lines of comment.
std::map<std::string, std::string> equations_in_code() {
  const std::regex mention("Eqs?\\. ((?:[a-z_]+\\.[0-9]+(?:-[0-9]+)?(?:, | and )?)+)");
  const std::regex id("([a-z_]+)\\.([0-9]+)(?:-([0-9]+))?");
  const std::regex line_break("\\s*\n\\s*//\\s*");
  std::map<std::string, std::string> out;
  for (const std::string& file : source_files({"src", "geometry", "optim"}, {".h", ".cpp"})) {
    const std::string text = std::regex_replace(
        read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file), line_break, " ");
    for (std::sregex_iterator it(text.begin(), text.end(), mention), end; it != end; ++it) {
      const std::string ids = (*it)[1];
      for (std::sregex_iterator one(ids.begin(), ids.end(), id); one != end; ++one) {
        const int first = std::stoi((*one)[2]);
        const int last = (*one)[3].matched ? std::stoi((*one)[3]) : first;
        for (int n = first; n <= last; ++n) out[(*one)[1].str() + "." + std::to_string(n)] = file;
      }
    }
  }
  return out;
}

// Any "contact.3" of a family that the code uses, in docs/theory.
std::map<std::string, std::string> equations_in_theory(const std::set<std::string>& families) {
  const std::regex id("([a-z_]+)\\.([0-9]+)\\b");
  std::map<std::string, std::string> out;
  for (const std::string& file : source_files({"docs/theory"}, {".md"})) {
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (std::sregex_iterator it(text.begin(), text.end(), id), end; it != end; ++it) {
      if (families.count((*it)[1])) out[it->str()] = file;
    }
  }
  return out;
}

TEST(Equations, OfTheCodeAreWrittenDownAndBack) {
  const auto code = equations_in_code();
  std::set<std::string> families;
  for (const auto& [id, file] : code) families.insert(id.substr(0, id.find('.')));
  const auto theory = equations_in_theory(families);
  for (const auto& [id, file] : code) {
    EXPECT_TRUE(theory.count(id)) << file << " names Eq. " << id << ", docs/theory does not";
  }
  for (const auto& [id, file] : theory) {
    EXPECT_TRUE(code.count(id)) << file << " writes down " << id << ", no code names Eq. " << id;
  }
}

}  // namespace
}  // namespace papilla::tests::equations_test
