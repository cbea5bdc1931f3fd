// The tutorial works as written: its files are made, its commands run.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <vector>

#include "tests/cli/program.h"

namespace papilla::tests {
namespace {

// A fenced block: ```toml NAME is a file, ```sh are commands, ```sh exit=2 ones that fail so, a
// block without a language behind commands is a part of what they print.
struct Block {
  std::string head, text;
};

std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> out;
  bool open = false;
  std::istringstream stream(page);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("```")) {
      if (!open) out.push_back({line.substr(3), ""});
      open = !open;
    } else if (open) {
      out.back().text += line + "\n";
    }
  }
  EXPECT_FALSE(open);
  return out;
}

TEST(Tutorial, EveryBlockWorksAsWritten) {
  const Workplace place;
  int commands = 0;
  Outcome last;
  for (const Block& block : blocks_of(file_text(PAPILLA_SOURCE_DIR "/docs/tutorial.md"))) {
    if (block.head.starts_with("toml ")) {
      place.write(block.head.substr(5), block.text);
    } else if (block.head.starts_with("sh")) {
      const int expected = block.head == "sh exit=2" ? 2 : 0;
      std::istringstream lines(block.text);
      for (std::string line; std::getline(lines, line); ++commands) {
        ASSERT_TRUE(line.starts_with("papilla ")) << line;
        last = place.run(line.substr(8));
        EXPECT_EQ(last.status, expected) << line << "\n" << last.err;
      }
    } else {
      EXPECT_NE((last.out + last.err).find(block.text), std::string::npos)
          << "expected:\n"
          << block.text << "printed:\n"
          << last.out << last.err;
    }
  }
  EXPECT_GE(commands, 9);
}

}  // namespace
}  // namespace papilla::tests
