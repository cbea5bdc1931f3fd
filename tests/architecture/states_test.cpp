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

TEST(States, NoCodeBranchesOnTheWordsOfAMessage) {
  for (const std::string& file : source_files({"src", "optim", "geometry"}, {".h", ".cpp"})) {
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (std::sregex_iterator it(text.begin(), text.end(), words_that_decide()), end; it != end;
         ++it) {
      ADD_FAILURE() << file << " asks for the words of a message: " << it->str();
    }
  }
}

TEST(States, TheRuleSeesWhatItShould) {
  for (const char* wrong :
       {"if (point.status == \"ok\")", "p.status.starts_with(\"pull-in\")",
        "trouble.find(\": pull-in\")", "look->regime != \"refused\"", "\"refused\" == o.regime",
        "outcome.reason.find('x')", "text(point.status).starts_with(\"pull-in\")"}) {
    EXPECT_TRUE(std::regex_search(std::string(wrong), words_that_decide())) << wrong;
  }
  for (const char* right :
       {"point.status == ModelStatus{}", "status.trouble == Trouble::Flooded", "reason.empty()",
        "out.reason = \"no water left\"", "{\"status\", text(p.status)}"}) {
    EXPECT_FALSE(std::regex_search(std::string(right), words_that_decide())) << right;
  }
}

}  // namespace
}  // namespace papilla::tests::states_test
