// What people and programs get on standard output: JSON from every command, colours on terminals
// only.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/text.h"
#include "tests/cli/program.h"

namespace papilla::tests::terminal_slow_test {
namespace {

TEST(AlignedTables, AreAsWideAsTheirCells) {
  EXPECT_EQ(aligned_table({{"rank", "design", "±"}, {"1", "a", "12.5"}}, 2),
            "rank  design     ±\n1     a       12.5\n");
  EXPECT_EQ(aligned_markdown("# T\n\n| a | long |\n|---|---|\n| 1 ± 2 | b |\nend\n"),
            "# T\n\n| a     | long |\n| ----- | ---- |\n| 1 ± 2 | b    |\nend\n");
  EXPECT_EQ(text_width("±▁µ"), 3u);
}

TEST(Json, IsGivenByEveryCommandWithResults) {
  const Workplace place;
  for (const char* command :
       {"optimize",     "evaluate",       "rank",        "export",        "verify",
        "surface",      "report",         "calibrate",   "accuracy",      "bench",
        "explain",      "reproduce",      "predict",     "describe",      "solve contact",
        "solve bridge", "solve droplets", "solve field", "solve persson", "solve drive",
        "solve haze"}) {
    const Outcome run = place.run(std::string(command) + " --help");
    EXPECT_EQ(run.status, 0) << command;
    EXPECT_NE(run.out.find("--json"), std::string::npos) << command;
  }
}

TEST(Json, OfExportReportAndDescribeIsOneObject) {
  const Workplace place;
  const Outcome exported = place.run("export " PAPILLA_DESIGNS_DIR
                                     "/m3_samples/a3h350.toml --format gsf --pixels 64 "
                                     "--out files --json");
  ASSERT_EQ(exported.status, 0) << exported.err;
  const auto files = nlohmann::json::parse(exported.out);
  EXPECT_EQ(files.at("schema"), 1);
  EXPECT_EQ(files.at("folder"), "files");
  EXPECT_EQ(files.at("files").at(0).at("file"), "heightmap.gsf");

  place.write("run/pareto.csv",
              "design,a,a se,b,b se,on front\nfront/01,1,0.1,2,0.1,yes\n,3,0.1,1,0.1,no\n");
  const Outcome picture = place.run("report run --svg front.svg --json");
  ASSERT_EQ(picture.status, 0) << picture.err;
  const auto report = nlohmann::json::parse(picture.out);
  EXPECT_EQ(report.at("file"), "front.svg");
  EXPECT_EQ(report.at("bytes"), std::filesystem::file_size(place.path() / "front.svg"));
  EXPECT_NE(file_text(place.path() / "front.svg").find("front, confirmed"), std::string::npos);

  const Outcome keys = place.run("describe surface --json");
  ASSERT_EQ(keys.status, 0) << keys.err;
  const auto surface = nlohmann::json::parse(keys.out).at("sections").at(0);
  EXPECT_EQ(surface.at("section"), "surface");
  EXPECT_EQ(surface.at("tables").at(0).at("keys").at(0).at("key"), "surface.contact_angle");
}

// A line of 80 columns would wrap, and a bar that wraps scrolls.
TEST(Progress, FitsATerminalOfEightyColumns) {
  const Workplace place;
  if (place.shell("command -v script").status) GTEST_SKIP() << "needs script (bsdutils)";
  const Outcome run = place.shell("script -qec '" PAPILLA_PROGRAM " optimize " PAPILLA_TEST_DATA
                                  "/study/tiny.toml --out run' /dev/null");
  EXPECT_EQ(run.status, 0) << run.out;
  std::size_t bars = 0;
  for (std::size_t at = run.out.find("\033[K"); at != std::string::npos;
       at = run.out.find("\033[K", at + 1)) {
    const std::size_t end = run.out.find_first_of("\r\n", at);
    const std::string line = run.out.substr(at + 3, end == std::string::npos ? end : end - at - 3);
    EXPECT_LE(text_width(line), 79u) << line;
    ++bars;
  }
  EXPECT_GE(bars, 3u);
}

// Who presses Ctrl-C at a terminal is told that it was heard; a program that sends it is not.
TEST(CtrlC, IsAcknowledgedAtATerminal) {
  const Workplace place;
  if (place.shell("command -v script").status) GTEST_SKIP() << "needs script (bsdutils)";
  const std::string heard =
                        "ending when what is being worked on is done; Ctrl-C again ends at once",
                    begin = "timeout --foreground --preserve-status -s INT 1 " PAPILLA_PROGRAM
                            " optimize " PAPILLA_TEST_DATA "/study/tiny.toml --evaluations 100000";
  const Outcome sitting = place.shell("script -qec '" + begin + " --out a' /dev/null");
  EXPECT_NE(sitting.out.find(heard), std::string::npos) << sitting.out;
  EXPECT_NE(sitting.out.find("interrupted; continue with: "), std::string::npos) << sitting.out;
  EXPECT_EQ(sitting.status, 130);
  const Outcome alone = place.shell(begin + " --out b");
  EXPECT_EQ(alone.err.find(heard), std::string::npos) << alone.err;
  EXPECT_NE(alone.err.find("interrupted; continue with: "), std::string::npos) << alone.err;
  EXPECT_EQ(alone.status, 130);
}

TEST(Colours, AreForTerminalsAndStopAtNoColor) {
  const Workplace place;
  const std::string explain = "explain " PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml";
  EXPECT_EQ(place.run(explain).out.find('\033'), std::string::npos);
  if (place.shell("command -v script").status) GTEST_SKIP() << "needs script (bsdutils)";
  const auto on_terminal = [&](const std::string& setting) {
    const Outcome run = place.shell("env -u NO_COLOR " + setting +
                                    " script -qec '" PAPILLA_PROGRAM " " + explain + "' /dev/null");
    EXPECT_EQ(run.status, 0) << run.err;
    return run.out;
  };
  EXPECT_NE(on_terminal("").find("\033[1m"), std::string::npos);
  EXPECT_EQ(on_terminal("NO_COLOR=1").find('\033'), std::string::npos);
}

// What has been judged is told, though the tables of the figures came to no end.
TEST(Reproduce, TellsItsClaimsWhenItsFiguresAreInterrupted) {
  const Workplace place;
  const Outcome run =
      place.shell("'" PAPILLA_PROGRAM
                  "' reproduce --claim M15 --figures --out mine 2> notes & run=$!; "
                  "while kill -0 $run && ! grep -q figures: notes; do sleep 0.1; done; "
                  "kill -INT $run; wait $run; status=$?; cat notes; exit $status");
  EXPECT_EQ(run.status, 130) << run.out;
  EXPECT_NE(run.out.find("M15"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("1 claims: "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("interrupted; the claims are judged"), std::string::npos) << run.out;
  EXPECT_TRUE(std::filesystem::exists(place.path() / "mine/claims.csv"));
  EXPECT_FALSE(std::filesystem::exists(place.path() / "mine/figures.csv"));
}

}  // namespace
}  // namespace papilla::tests::terminal_slow_test
