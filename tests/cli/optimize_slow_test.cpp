// papilla optimize as a program: kills, signals, two runs in a folder, any number of workers.
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/support/thorough.h"

namespace papilla::tests::optimize_slow_test {
namespace {

const std::string kStudy = PAPILLA_TEST_DATA "/study/tiny.toml";
const std::string kOptimize = "'" PAPILLA_PROGRAM "' --quiet optimize '" + kStudy + "'";
const std::string kLaunch =
    "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe ";

// Until the run in the background has recorded something; a minute at most.
const std::string kUntilJournal =
    "for i in $(seq 600); do [ -s run/journal ] && break; sleep 0.1; done; ";

// A run from its beginning to its end by one worker.
std::filesystem::path whole_run() {
  static const Workplace place;
  static const Outcome run = place.shell(kOptimize + " --jobs 1 --out whole");
  EXPECT_EQ(run.status, 0) << run.err;
  return place.path() / "whole";
}

void expect_as_the_whole(const std::filesystem::path& folder) {
  for (const char* file :
       {"journal", "pareto.csv", "history.csv", "summary.md", "best/metrics.json"}) {
    const std::string text = file_text(whole_run() / file);
    EXPECT_FALSE(text.empty()) << file;
    EXPECT_EQ(text, file_text(folder / file)) << folder << "/" << file;
  }
}

bool has_mpi(const Workplace& place) {
  return place
             .shell("command -v mpirun && test -e \"$(dirname '" PAPILLA_PROGRAM
                    "')\"/papilla_mpi.so")
             .status == 0;
}

TEST(Optimize, KillsAtRandomMomentsChangeNothing) {
  Workplace place;
  const Outcome run =
      place.shell("'" PAPILLA_SOURCE_DIR "/tests/kill_test' '" PAPILLA_PROGRAM "' " +
                  std::to_string(cases(2, 5)) + " '" + kStudy + "'");
  EXPECT_EQ(run.status, 0) << run.out << run.err;
}

TEST(Optimize, AnyNumberOfWorkersOrRanksGivesTheSameBytes) {
  Workplace place;
  const Outcome run = place.shell(kOptimize + " --jobs 3 --out jobs");
  ASSERT_EQ(run.status, 0) << run.err;
  expect_as_the_whole(place.path() / "jobs");
  if (!has_mpi(place)) GTEST_SKIP() << "no MPI here";
  for (const int ranks : {3, 1}) {
    const Outcome launched = place.shell(kLaunch + "-n " + std::to_string(ranks) + " " + kOptimize +
                                         " --out ranks" + std::to_string(ranks));
    ASSERT_EQ(launched.status, 0) << launched.err;
    expect_as_the_whole(place.path() / ("ranks" + std::to_string(ranks)));
    if (!is_thorough()) break;
  }
}

TEST(Optimize, TheLossOfARankIsResumed) {
  Workplace place;
  if (!has_mpi(place)) GTEST_SKIP() << "no MPI here";
  const Outcome lost = place.shell(
      "export PAPILLA_DESIGNS='" PAPILLA_SOURCE_DIR "/designs'; cp '" PAPILLA_PROGRAM
      "' papilla_here; cp \"$(dirname '" PAPILLA_PROGRAM
      "')\"/papilla_*.so .; cp -d \"$(dirname '" PAPILLA_PROGRAM "')\"/libpapilla.so* .; " +
      kLaunch + "-n 3 ./papilla_here --quiet optimize '" + kStudy + "' --out run & launcher=$!; " +
      kUntilJournal +
      "sleep 0.5; "
      "for process in /proc/[0-9]*; do"
      "  [ \"$(readlink $process/exe)\" = \"$PWD/papilla_here\" ] &&"
      "  grep -qz '^OMPI_COMM_WORLD_RANK=2$' $process/environ && kill -9 ${process#/proc/};"
      "done; wait $launcher");
  EXPECT_NE(lost.status, 0);
  const Outcome again = place.shell(kLaunch + "-n 2 " + kOptimize + " --out run --resume");
  ASSERT_EQ(again.status, 0) << again.err;
  expect_as_the_whole(place.path() / "run");
}

TEST(Optimize, ASecondRunInAFolderIsRefusedWhileTheFirstLives) {
  Workplace place;
  const Outcome second = place.shell(
      kOptimize + " --out run > first.txt 2>&1 & first=$!; " + kUntilJournal + kOptimize +
      " --out run --resume; status=$?; kill -INT $first; wait $first; exit $status");
  EXPECT_EQ(second.status, 2) << second.out;
  EXPECT_NE(second.err.find("another run is working in this folder"), std::string::npos)
      << second.err;
}

TEST(Optimize, AnInterruptEndsTidilyAndIsResumed) {
  Workplace place;
  const Outcome ended = place.shell(kOptimize + " --out run & run=$!; " + kUntilJournal +
                                    "sleep 0.4; "
                                    "kill -INT $run; wait $run");
  EXPECT_EQ(ended.status, 130) << ended.err;
  const std::string summary = file_text(place.path() / "run/summary.md");
  EXPECT_NE(summary.find("continue with --resume"), std::string::npos) << summary;
  ASSERT_EQ(place.shell(kOptimize + " --out run --resume").status, 0);
  expect_as_the_whole(place.path() / "run");
}

}  // namespace
}  // namespace papilla::tests::optimize_slow_test
