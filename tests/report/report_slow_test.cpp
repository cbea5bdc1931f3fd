// The page of a small run: what it holds, and how a browser takes it.
#include <gtest/gtest.h>

#include "base/sha256.h"
#include "tests/cli/program.h"

namespace papilla {
namespace {

// A run that one test of this program makes and all of them read.
const Workplace& finished_run() {
  static const Workplace place;
  static const Outcome run =
      place.run("-q optimize " PAPILLA_SOURCE_DIR
                "/designs/electroadhesive_glass/study.toml --set 'search.evaluations=4' --set "
                "'accuracy.level=draft' --set 'environment.relative_humidity=[\"35 %\", \"75 %\"]' "
                "--out run");
  EXPECT_EQ(run.status, 0) << run.err;
  return place;
}

TEST(Sha256, HasThePublishedDigests) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Report, IsWrittenByOptimizeAndTheSameByTheCommand) {
  const Workplace& place = finished_run();
  const std::string page = file_text(place.path() / "run/report.html");
  const Outcome again = place.run("report run --out again.html");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out, "again.html\n");
  EXPECT_TRUE(page == file_text(place.path() / "again.html")) << "the pages differ";
  EXPECT_GT(page.size(), 1000000u);  // the two libraries are inside
  for (const char* mark : {"{{title}}", "{{style}}", "{{chart}}", "{{three}}", "{{data}}"})
    EXPECT_EQ(page.find(mark), std::string::npos) << mark;
  EXPECT_NE(page.find(sha256(file_text(place.path() / "run/best/heightmap.exr"))),
            std::string::npos);
  EXPECT_EQ(page.find("timing.json"), std::string::npos);  // nothing that depends on the clock
}

TEST(Report, RefusesAFolderThatIsNoRun) {
  const Workplace place;
  const Outcome run = place.run("report .");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("not the folder of a finished"), std::string::npos) << run.err;
  EXPECT_EQ(place.entries(), 0);
}

TEST(Report, IsDrawnByABrowserWithoutErrorOrNetwork) {
  const Workplace& place = finished_run();
  if (place.shell("command -v chromium && command -v chromedriver && command -v python3").status)
    GTEST_SKIP() << "needs chromium, chromium-driver and python3 (scripts/setup --test)";
  const Outcome run =
      place.shell("python3 " PAPILLA_SOURCE_DIR "/tests/report/browser.py run/report.html");
  EXPECT_EQ(run.status, 0) << run.err;
}

}  // namespace
}  // namespace papilla
