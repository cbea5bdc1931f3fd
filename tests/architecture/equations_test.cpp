// Every equation that the code names is written down, and every equation written down is used.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "tests/architecture/source_tree.h"

namespace papilla::tests::equations_test {
namespace {

// A comment that is broken over lines in one line.
std::string joined(const std::string& text) {
  constexpr const char* kSpaces = " \t\r\n";
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); out += '\n') {
    const std::size_t first = line.find_first_not_of(kSpaces);
    if (first == std::string::npos || line.compare(first, 2, "//") != 0) {
      out += line;
      continue;
    }
    out.erase(out.find_last_not_of(kSpaces) + 1);
    const std::size_t said = line.find_first_not_of(kSpaces, first + 2);
    out += ' ';
    if (said != std::string::npos) out.append(line, said);
  }
  return out;
}

// "Eq. contact.3", "Eq. metrics.1-5", "Eq. field.1, field.2": all ids, with a file that names each.
// A mention may be broken over lines of comment.
std::map<std::string, std::string> equations_in_code() {
  const std::regex mention("Eqs?\\. ((?:[a-z_]+\\.[0-9]+(?:-[0-9]+)?(?:, | and )?)+)");
  const std::regex id("([a-z_]+)\\.([0-9]+)(?:-([0-9]+))?");
  std::map<std::string, std::string> out;
  for (const std::string& file : source_files({"src", "geometry", "optim"}, {".h", ".cpp"})) {
    const std::string text = joined(read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file));
    for (std::size_t at = text.find("Eq"); at != std::string::npos; at = text.find("Eq", at + 2)) {
      std::smatch found;
      if (!std::regex_search(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), found,
                             mention, std::regex_constants::match_continuous))
        continue;
      const std::string ids = found[1];
      for (std::sregex_iterator one(ids.begin(), ids.end(), id), end; one != end; ++one) {
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
