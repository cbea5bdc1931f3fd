// A state is a value and its text is for people: no code asks what a message says.
#include <gtest/gtest.h>

#include <regex>

#include "tests/architecture/source_tree.h"

namespace papilla::tests::states_test {
namespace {

// A status, trouble, ... whose words decide: searched in, or compared with a text.
const std::regex& words_that_decide() {
  const std::string message =
      "\\b\\w*(status|trouble|troubles|regime|reason|warning)_?(\\(\\))?\\)?";
  static const std::regex pattern(
      message + "(\\.|->)(starts_with|ends_with|contains|find|rfind|substr|compare)\\b|" + message +
      "\\s*[=!]=\\s*\"|\"\\s*[=!]=\\s*[\\w.>-]*(status|trouble|troubles|regime|reason|warning)\\b");
  return pattern;
}

// Where the words decide there. Each alternative of the pattern needs a word of both lists.
std::vector<std::string> decided_in(const std::string& text) {
  std::vector<std::string> out;
  for (const std::string& s : statements_with(
           text,
           {{"status", "trouble", "regime", "reason", "warning"},
            {"starts_with", "ends_with", "contains", "find", "substr", "compare", "==", "!="}})) {
    for (std::sregex_iterator it(s.begin(), s.end(), words_that_decide()), end; it != end; ++it)
      out.push_back(it->str());
  }
  return out;
}

TEST(States, NoCodeBranchesOnTheWordsOfAMessage) {
  for (const std::string& file : source_files({"src", "optim", "geometry"}, {".h", ".cpp"})) {
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (const std::string& asked : decided_in(text))
      ADD_FAILURE() << file << " asks for the words of a message: " << asked;
  }
}

TEST(States, TheRuleSeesWhatItShould) {
  for (const char* wrong :
       {"if (point.status == \"ok\")", "p.status.starts_with(\"pull-in\")",
        "trouble.find(\": pull-in\")", "look->regime != \"refused\"", "\"refused\" == o.regime",
        "outcome.reason.find('x')", "text(point.status).starts_with(\"pull-in\")"}) {
    EXPECT_FALSE(decided_in(wrong).empty()) << wrong;
  }
  for (const char* right :
       {"point.status == ModelStatus{}", "status.trouble == Trouble::Flooded", "reason.empty()",
        "out.reason = \"no water left\"", "{\"status\", text(p.status)}"}) {
    EXPECT_TRUE(decided_in(right).empty()) << right;
  }
}

}  // namespace
}  // namespace papilla::tests::states_test
