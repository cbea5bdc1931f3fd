// A wafer of 6 x 6 fields as KLayout sees it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "base/files.h"
#include "fabricate/wafer_files.h"
#include "tests/fabricate/wafer_list.h"

namespace papilla::tests::wafer_klayout_slow_test {
namespace {

TEST(KlayoutWafer, HasItsLabelsSizesHierarchyAndTheSamePolygonsInBothFiles) {
  const Workplace place;
  if (place.shell("command -v klayout").status != 0)
    GTEST_SKIP() << "needs klayout (scripts/setup --test)";
  const std::string list = write_wafer_list(place, "[wafer]\ncolumns = 6\nrows = 6\nrepeats = 6\n");
  const WaferPlan plan = plan_wafer((place.path() / list).string());
  const WaferDrawing drawing = draw_wafer(plan);
  const std::string folder = (place.path() / "wafer").string();
  write_wafer(plan, drawing, {}, folder);

  // The first field that holds H2 says so; "B3 H2" has five letters of six squares.
  std::string id;
  for (const WaferField& f : plan.fields) {
    if (plan.treatments[f.treatment].name == "H2" && f.id == "B3") id = f.id;
  }
  if (id.empty()) id = plan.fields.front().id;
  const Outcome run = place.shell(
      "QT_QPA_PLATFORM=offscreen klayout -b -rd folder=wafer -rd designs=H1,H2,H3 -rd field_id=" +
      id + " -rd columns=30 -r " PAPILLA_SOURCE_DIR "/tests/fabricate/klayout_wafer.py");
  ASSERT_EQ(run.status, 0) << run.err << run.out;
  std::istringstream in(run.out);
  std::map<std::string, std::string> facts;
  for (std::string name, value; in >> name >> value;) facts[name] = value;
  const auto number = [&](const std::string& name) { return std::stod(facts.at(name)); };

  EXPECT_EQ(number("cells_that_differ"), 0);
  EXPECT_EQ(number("cells_only_in_oasis"), 0);
  EXPECT_EQ(number("xor_of_cells"), 0);
  EXPECT_EQ(number("flat_xor"), 0);
  EXPECT_GT(number("flat_seen"), 1e9);  // [nm^2]: there is something in the windows

  EXPECT_EQ(number("top_cells"), 1);
  EXPECT_EQ(number("fields"), 36);
  EXPECT_LE(number("hierarchy"), 5);  // wafer, field, pad, block of rows, feature
  EXPECT_EQ(facts.at("name_1"), "LEVEL_1_DEEP");
  EXPECT_EQ(facts.at("name_2"), "LEVEL_2_DEEP");

  const double widths[]{1, 2, 3, 5, 10};
  for (int k = 0; k < 5; ++k) EXPECT_DOUBLE_EQ(number("bar_" + std::to_string(k)), widths[k]);
  EXPECT_DOUBLE_EQ(number("ruler"), 1000);
  // By the area, whose corners are rounded to the nanometre.
  EXPECT_NEAR(number("diameter_H1"), 3, 1e-3);
  EXPECT_NEAR(number("diameter_H2"), 4, 1e-3);
  EXPECT_NEAR(number("diameter_H3"), 2, 1e-3);
  EXPECT_DOUBLE_EQ(number("pitch"), 6);
  EXPECT_EQ(number("copies"), 2000 * 2000);
  EXPECT_NEAR(number("letter_height"), 350, 1e-6);

  // 36 pads of 4 million features each.
  EXPECT_LT(read_bytes(folder + "/wafer.gds").size(), 60000u);
  EXPECT_LT(read_bytes(folder + "/wafer.oas").size(), 30000u);
}

TEST(KlayoutWafer, WritesWordsThatAPersonReads) {
  const Workplace place;
  if (place.shell("command -v klayout").status != 0)
    GTEST_SKIP() << "needs klayout (scripts/setup --test)";
  place.write("h.toml", array_design("hole_array", "depth = \"350 nm\"\n"));
  place.write("list.toml",
              "schema_version = 1\n[wafer]\nrepeats = 1\nflats = 0\nreferences = 0\ncolumns = 1\n"
              "rows = 1\n[[design]]\nname = \"RX-45\"\nfile = \"h.toml\"\n");
  const Outcome made = place.run("wafer list.toml --out wafer --no-expected");
  ASSERT_EQ(made.status, 0) << made.err;
  const Outcome run = place.shell(
      "QT_QPA_PLATFORM=offscreen klayout -b -rd folder=wafer -rd designs=RX_45 -rd field_id=A1 -rd "
      "columns=47 -r " PAPILLA_SOURCE_DIR "/tests/fabricate/klayout_wafer.py");
  ASSERT_EQ(run.status, 0) << run.err << run.out;
  std::string seen;
  std::istringstream in(run.out);
  for (std::string name, value; in >> name >> value;) {
    if (name.starts_with("word_")) seen += value + '\n';
  }
  EXPECT_EQ(seen,
            ".###....#.........####..#...#..........#..#####\n"
            "#...#..##.........#...#.#...#.........##..#....\n"
            "#...#...#.........#...#..#.#.........#.#..####.\n"
            "#####...#.........####....#...#####.#..#......#\n"
            "#...#...#.........#.#....#.#........#####.....#\n"
            "#...#...#.........#..#..#...#..........#..#...#\n"
            "#...#..###........#...#.#...#..........#...###.\n");
}

}  // namespace
}  // namespace papilla::tests::wafer_klayout_slow_test
