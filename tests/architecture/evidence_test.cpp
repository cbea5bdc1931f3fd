// results/evidence.toml against the files: what is committed as evidence says how it was made.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <set>

#include "config/node.h"
#include "tests/architecture/source_tree.h"

namespace papilla::tests::evidence_test {
namespace {

namespace fs = std::filesystem;

const fs::path kTop = PAPILLA_SOURCE_DIR;

Node table() {
  return parse_toml(read_source(kTop / "results/evidence.toml"), "results/evidence.toml");
}

// Files below results/ that git knows; empty where the tree is no checkout.
std::set<std::string> committed() {
  std::set<std::string> out;
  const std::string command =
      "git -C '" + kTop.string() + "' ls-files --full-name results 2>/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  char line[1024];
  while (pipe && std::fgets(line, sizeof line, pipe)) {
    out.insert(std::string(line, std::string_view(line).find('\n')));
  }
  if (pipe) pclose(pipe);
  return out;
}

// Each file of the table -> the section that names it.
std::map<std::string, std::string> listed() {
  std::map<std::string, std::string> out;
  for (const Node& entry : table().children) {
    const Node* files = entry.find("files");
    if (!files) continue;
    for (const Node& file : files->children) {
      EXPECT_TRUE(out.emplace(file.text, entry.key).second) << file.text << " is named twice";
    }
  }
  return out;
}

TEST(Evidence, EveryCommittedResultIsInTheTable) {
  std::set<std::string> files = committed();
  if (files.empty()) GTEST_SKIP() << "not a checkout";
  files.erase("results/evidence.toml");
  const std::map<std::string, std::string> known = listed();
  for (const std::string& file : files) {
    EXPECT_TRUE(known.count(file)) << file << ": no command and no state in results/evidence.toml";
  }
}

TEST(Evidence, EveryFileOfTheTableExists) {
  const std::map<std::string, std::string> known = listed();
  EXPECT_GT(known.size(), 40u);
  for (const auto& [file, entry] : known) EXPECT_TRUE(fs::exists(kTop / file)) << entry << file;
}

TEST(Evidence, EveryEntrySaysHowFromWhatAndWhenItWasMade) {
  const Node all = table();
  const Node* parts = all.find("parts");
  ASSERT_NE(parts, nullptr);
  for (const Node& part : parts->children) {
    for (const Node& path : part.children) EXPECT_TRUE(fs::exists(kTop / path.text)) << path.text;
  }
  for (const Node& entry : all.children) {
    if (entry.key == "parts") continue;
    EXPECT_NE(entry.find("command") != nullptr, entry.find("by_hand") != nullptr) << entry.key;
    EXPECT_NE(entry.find("made"), nullptr) << entry.key;
    const Node* rests = entry.find("rests_on");
    const Node* state = entry.find("state");
    ASSERT_NE(rests, nullptr) << entry.key;
    ASSERT_NE(state, nullptr) << entry.key;
    for (const Node& part : rests->children) {
      EXPECT_TRUE(parts->find(part.text) || fs::exists(kTop / part.text)) << part.text;
      EXPECT_NE(state->find(part.text), nullptr) << entry.key << ": " << part.text;
    }
    EXPECT_EQ(state->children.size(), rests->children.size()) << entry.key;
  }
}

}  // namespace
}  // namespace papilla::tests::evidence_test
