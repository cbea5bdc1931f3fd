// The page of a small run: what it holds, and how a browser takes it.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>

#include "base/digest.h"
#include "tests/cli/program.h"

namespace papilla::tests::report_slow_test {
namespace {

constexpr const char* kStudy = R"(schema_version = 1
base = "electroadhesive_glass/study.toml"
[environment]
relative_humidity = ["15 %", "55 %"]
[accuracy]
level = "draft"
grid = 32
[population]
fingers = ["reference.toml", "moist.toml"]
[search]
evaluations = 6
seed = 7
)";

// A run that all tests of the suite read.
const Workplace& finished_run() {
  static const Workplace place;
  static const Outcome run = [] {
    for (const std::string finger : {"reference", "moist"})
      place.write(finger + ".toml", "schema_version = 1\nbase = \"fingers/" + finger +
                                        ".toml\"\nbelief = \"few_members.toml\"\n");
    place.write("few_members.toml", file_text(PAPILLA_TEST_DATA "/study/few_members.toml"));
    place.write("study.toml", kStudy);
    return place.run("-q optimize study.toml --out run");
  }();
  EXPECT_EQ(run.status, 0) << run.err;
  return place;
}

TEST(ReportOfOneRun, IsWrittenByOptimizeAndTheSameByTheCommand) {
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

TEST(ReportOfOneRun, HoldsTheTablesOfTheSummaryForABrowserWithoutScripts) {
  const std::string page = file_text(finished_run().path() / "run/report.html");
  const std::size_t begin = page.find("<noscript>"), end = page.find("</noscript>");
  ASSERT_NE(end, std::string::npos);
  const std::string plain = page.substr(begin, end - begin);
  for (const char* text : {"<td>front/01</td>", "<h2>What the best design is sensitive to</h2>",
                           "<td>texture.depth</td>", "<th>worst modulation</th>"})
    EXPECT_NE(plain.find(text), std::string::npos) << text;
  EXPECT_EQ(plain.find("**"), std::string::npos);
  EXPECT_EQ(plain.find("|"), std::string::npos);
}

TEST(ReportOfOneRun, ExportsStayInItsFolder) {
  const Workplace& place = finished_run();
  const std::string how = " --format mask --polarity white-deep --pixels 64";
  for (const auto& [source, to] :
       {std::pair("run", "run/export/best"), std::pair("run --pick 1", "run/export/front/01"),
        std::pair("run/front/01", "run/front/01/export")}) {
    const Outcome run = place.run(std::string("export ") + source + how);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with(std::string(to) + "/mask.tif\n" + to + "/export.json\n"))
        << run.out;
  }
  for (const char* folder : {"run/export", "run/front/01/export"})  // as the other tests found it
    std::filesystem::remove_all(place.path() / folder);
}

TEST(ReportOfOneRun, VerifyJudgesTheBestDesignAndTheFront) {
  const Workplace& place = finished_run();
  const Outcome sound = place.run("verify run --geometry");
  EXPECT_EQ(sound.status, 0) << sound.err;
  for (const char* name : {"run/best/build.toml", "run/best/heightmap.exr", "run/best/preview.png",
                           "run/front/01/heightmap.gsf"})
    EXPECT_NE(sound.out.find(name), std::string::npos) << sound.out;
  const auto file = place.path() / "run/best/build.toml";
  const std::string design = file_text(file);
  place.write("run/best/build.toml", design + "\n[view]\nfill_index = 1.1\n");
  const Outcome two = place.run("verify run --geometry");
  EXPECT_EQ(two.status, 2);  // [view] stands there twice
  std::string other = design;
  const std::string key = "\ncontact_angle = ";  // of a flat surface too
  ASSERT_NE(other.find(key), std::string::npos) << other;
  other.replace(other.find(key), key.size(), key + "\"31 deg\" # ");
  place.write("run/best/build.toml", other);
  const Outcome changed = place.run("verify run --geometry");
  EXPECT_EQ(changed.status, 1);
  EXPECT_NE(changed.err.find("run/best/build.toml: is another design"), std::string::npos)
      << changed.err;
  EXPECT_EQ(changed.err.find("heightmap"), std::string::npos) << changed.err;
  place.write("run/best/build.toml", design);
  EXPECT_EQ(place.run("verify run/best --geometry").status, 0);
}

TEST(Report, RefusesAFolderThatIsNoRun) {
  const Workplace place;
  const Outcome run = place.run("report .");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("not the folder of a finished"), std::string::npos) << run.err;
  EXPECT_EQ(place.entries(), 0);
}

void expect_drawn(const Workplace& place, const std::string& page) {
  if (place.shell("command -v chromium && command -v chromedriver && command -v python3").status)
    GTEST_SKIP() << "needs chromium, chromium-driver and python3 (scripts/setup --test)";
  const Outcome run = place.shell("python3 " PAPILLA_SOURCE_DIR "/tests/report/browser.py " + page);
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST(ReportOfOneRun, IsDrawnByABrowserWithoutErrorOrNetwork) {
  expect_drawn(finished_run(), "run/report.html");
}

TEST(ReportOfOneRun, IsPrintedAsPdf) {
  const Workplace& place = finished_run();
  const Outcome none = place.shell("PATH=/nowhere " PAPILLA_PROGRAM " report run --out none.pdf");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("apt install chromium"), std::string::npos) << none.err;
  EXPECT_FALSE(std::filesystem::exists(place.path() / "none.pdf"));
  if (place.shell("command -v chromium").status) GTEST_SKIP() << "needs chromium";
  const Outcome run = place.run("report run --out run.pdf");
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string pdf = file_text(place.path() / "run.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF-"));
  EXPECT_NE(pdf.find("%%EOF"), std::string::npos);
  const std::size_t count = pdf.find("/Count ");
  ASSERT_NE(count, std::string::npos);
  EXPECT_GT(std::stoi(pdf.substr(count + 7)), 2);  // pages
}

TEST(Report, OfARankingIsDrawnAndTheSameByTheCommand) {
  const Workplace place;
  const std::string designs = PAPILLA_SOURCE_DIR "/designs/coatings/";
  for (const auto& [by, folder] :
       {std::pair("friction:low,adhesion:low", "two"),
        std::pair("friction:low,adhesion:low,compliance:high --weights 2,1,1", "three")}) {
    const Outcome run =
        place.run("-q rank " + designs + "fine.toml " + designs + "hard.toml " + designs +
                  "sparse.toml --by " + by +
                  " --state clean,natural --set accuracy.level=draft --set accuracy.grid=32 "
                  "--max-skins 12 --out " +
                  folder);
    ASSERT_EQ(run.status, 0) << run.err;
    const std::string page = std::string(folder) + "/report.html";
    expect_drawn(place, page);
    const std::string before = file_text(place.path() / page);
    EXPECT_EQ(place.run("report " + std::string(folder)).status, 0);
    EXPECT_TRUE(before == file_text(place.path() / page)) << "the pages differ";
  }
  const Outcome picked = place.run("report two --pick knee");
  EXPECT_EQ(picked.status, 2) << picked.err;
}

TEST(Report, OfAFitIsDrawnAndTheSameByTheCommand) {
  const Workplace place;
  std::ofstream(place.path() / "measured.csv")
      << "design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_off_sd_N,F_on_N,"
         "F_on_sd_N\n"
         "m3_samples/flat.toml,15 %,200,5000,0.2,0.06,0.004,0.09,0.005\n"
         "m3_samples/flat.toml,75 %,200,5000,0.2,0.13,0.01,,\n";
  std::ofstream(place.path() / "fit.toml") << R"(schema_version = 1
title = "A finger against a table"
finger = "fingers/reference.toml"
data = "measured.csv"
fit = ["M9"]
hold_out = ["M2"]
iterations = 1
[sampling]
level = "draft"
grid = 32
skins = 4
[check]
level = "draft"
grid = 32
skins = 4
first_skin = 70
[parameters]
"macro.load_share" = { low = 0.001, high = 0.05, prior = 0.0063, factor = 2.0 }
"macro.shear_strength" = { low = "3 MPa", high = "20 MPa" }
)";
  const Outcome run = place.run("-q calibrate fit.toml --out fit");
  ASSERT_LE(run.status, 1) << run.err;  // 1: the one step it has does not converge
  expect_drawn(place, "fit/report.html");
  const std::string page = file_text(place.path() / "fit/report.html");
  EXPECT_EQ(place.run("report fit --out again.html").status, 0);
  EXPECT_TRUE(page == file_text(place.path() / "again.html")) << "the pages differ";
}

}  // namespace
}  // namespace papilla::tests::report_slow_test
