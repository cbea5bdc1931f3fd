// The tutorial works as written: its files are made, its commands run.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/thorough.h"

namespace papilla::tests::tutorial_slow_test {
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

// The grid's part of F_off in percent, mean over the humidities.
double grid_part(const Workplace& place, const std::string& level) {
  const Outcome run = place.run("evaluate first.toml --json --set accuracy.level=" + level);
  EXPECT_EQ(run.status, 0) << run.err;
  const auto points = nlohmann::json::parse(run.out).at("points");
  double sum = 0;
  for (const auto& p : points) {
    const auto& friction = p.at("F_off");
    sum += friction.at("parts").at("grid").get<double>() / friction.at("value").get<double>();
  }
  return 100 * sum / static_cast<double>(points.size());
}

// Numbers in its sentences are those of the program.
TEST(Tutorial, ItsNumbersAreWhatTheProgramSays) {
  const Workplace place;
  const std::string page = file_text(PAPILLA_SOURCE_DIR "/docs/tutorial.md");
  for (const Block& block : blocks_of(page)) {
    if (block.head == "toml first.toml") place.write("first.toml", block.text);
  }
  std::smatch said;
  ASSERT_TRUE(std::regex_search(
      page, said,
      std::regex("the grid leaves\\s+(\\d+) % of `F_off` at `draft`, (\\d+) % at `design`")));
  EXPECT_NEAR(std::stod(said[1]), grid_part(place, "draft"), 1);
  if (is_thorough()) {
    EXPECT_NEAR(std::stod(said[2]), grid_part(place, "design"), 1);
  }
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
}  // namespace papilla::tests::tutorial_slow_test
