// Test wafers: what stands where, what is drawn, what is to be measured.
#include "report/wafer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "fabricate/wafer_files.h"
#include "fabricate/wafer_marks.h"
#include "geometry/io/glyphs.h"
#include "tests/fabricate/wafer_list.h"
#include "tests/support/refusal.h"

namespace papilla::tests::wafer_test {
namespace {

class Wafer {
 public:
  explicit Wafer(const std::string& sections) {
    write_wafer_list(place, sections);
    plan = plan_wafer(path("list.toml"));
    drawing = draw_wafer(plan);
  }
  std::string path(const std::string& name) const { return (place.path() / name).string(); }
  std::string write() const {
    write_wafer(plan, drawing, {}, path("out"));
    return path("out");
  }

  Workplace place;
  WaferPlan plan;
  WaferDrawing drawing;
};

TEST(Wafer, HoldsEveryDesignOnceInEachBlockAndItsControls) {
  const Wafer wafer(
      "[wafer]\nrepeats = 3\nflats = 2\nreferences = 1\nreference = \"H2\"\n"
      "columns = 7\nrows = 3\n");
  std::map<int, std::multiset<std::string>> blocks;
  std::set<std::string> ids;
  for (const WaferField& f : wafer.plan.fields) {
    blocks[f.block].insert(wafer.plan.treatments[f.treatment].name);
    ids.insert(f.id);
    EXPECT_EQ(f.kind == FieldKind::Flat, wafer.plan.treatments[f.treatment].name == "FLAT");
  }
  ASSERT_EQ(blocks.size(), 3u);
  const std::multiset<std::string> whole{"FLAT", "FLAT", "H1", "H2", "H2", "H3", "P1"};
  for (const auto& [block, names] : blocks) EXPECT_EQ(names, whole) << block;
  EXPECT_EQ(ids.size(), 21u);
  EXPECT_EQ(wafer.plan.fields.front().id, "A1");
  EXPECT_EQ(wafer.plan.fields.back().id, "C7");
}

// Twelve fields of sixteen: what is left is no kind of one block.
TEST(Wafer, SharesThePlacesLeftAmongBlocksInBothKinds) {
  const Wafer wafer(
      "[wafer]\nrepeats = 2\nflats = 1\nreferences = 1\nreference = \"H2\"\n"
      "columns = 4\nrows = 4\n");
  std::map<std::pair<int, FieldKind>, int> fields;
  for (const WaferField& f : wafer.plan.fields) ++fields[{f.block, f.kind}];
  for (const int block : {1, 2}) {
    EXPECT_EQ((fields[{block, FieldKind::Flat}]), 2) << block;
    EXPECT_EQ((fields[{block, FieldKind::Reference}]), 2) << block;
  }
}

// Mask programs merge cells of one name.
TEST(Wafer, NamesTheCellsOfEveryDesignApart) {
  const Wafer wafer(
      "[[design]]\nname = \"H1-A\"\nfile = \"h1.toml\"\n"
      "[[design]]\nname = \"H1.A\"\nfile = \"h2.toml\"\n"
      "[[design]]\nname = \"P1.CELL\"\nfile = \"p1.toml\"\n");
  std::set<std::string> names;
  for (const LayoutCell& cell : wafer.drawing.layout.cells)
    EXPECT_TRUE(names.insert(cell.name).second) << cell.name;
  EXPECT_EQ(names.count("DESIGN_H1_A") + names.count("DESIGN_H1_A_2"), 2u);
}

TEST(Wafer, HasTheDesignOfARunThatIsBuiltByItsSheet) {
  const Workplace place;
  const auto holes = [&](const std::string& file, const char* depth) {
    std::filesystem::create_directories((place.path() / file).parent_path());
    place.write(file, array_design("hole_array",
                                   "period = \"6 um\"\ndiameter = \"3 um\"\nwall_angle = \"85 "
                                   "deg\"\ndepth = \"" +
                                       std::string(depth) + "\"\n"));
  };
  holes("run/front/01/design.toml", "351.3 nm");
  holes("run/front/02/design.toml", "502.7 nm");
  holes("run/best/design.toml", "502.7 nm");
  holes("run/best/build.toml", "500 nm");
  const WaferPlan plan = plan_wafer((place.path() / "run").string());
  std::vector<double> depths;
  for (const Treatment& t : plan.treatments) {
    if (const auto* array = std::get_if<HoleArray>(&t.design.texture.kind))
      depths.push_back(std::round(1e10 * array->depth));
  }
  EXPECT_EQ(depths, (std::vector<double>{3513, 5000}));
}

// A run says that a surface is flat by holes without depth: no shape of no size is put on a wafer.
TEST(Wafer, HasNoShapeOfADesignWithoutRelief) {
  const Workplace place;
  std::filesystem::create_directories(place.path() / "run/best");
  for (const char* file : {"run/best/design.toml", "run/best/build.toml"})
    place.write(file, array_design("hole_array",
                                   "period = \"6 um\"\ndiameter = \"3 um\"\ndepth = \"0 nm\"\n"));
  const WaferPlan plan = plan_wafer((place.path() / "run").string());
  ASSERT_EQ(plan.treatments.size(), 2u);
  EXPECT_EQ(plan.treatments[0].name, "D01");
  EXPECT_EQ(plan.treatments[0].design.texture, Texture{});
  EXPECT_EQ(plan.notes, std::vector<std::string>{
                            "D01 has no texture: its fields are flat, as those of FLAT are"});
  const WaferDrawing drawing = draw_wafer(plan);
  ASSERT_EQ(drawing.levels.size(), 1u);
  EXPECT_TRUE(drawing.levels[0].designs.empty());
  ASSERT_EQ(drawing.layout.layers.size(), 1u);
  EXPECT_EQ(drawing.layout.layers[0].label,
            "tone: polygons are deep, what is around them is high; labels and marks");
  for (const LayoutCell& cell : drawing.layout.cells)
    EXPECT_FALSE(cell.name.starts_with("DESIGN_")) << cell.name;
  const std::string said = report::wafer_text(plan, drawing, {}, {});
  EXPECT_NE(said.find("mask 1: labels and marks alone\n"), std::string::npos) << said;
  EXPECT_EQ(said.find("hole_array"), std::string::npos) << said;
}

TEST(Wafer, IsTheSameForASeedAndAnotherForAnother) {
  const auto order = [](int seed) {
    const Wafer wafer("[wafer]\nseed = " + std::to_string(seed) + "\n");
    std::string out;
    for (const WaferField& f : wafer.plan.fields) out += std::to_string(f.treatment);
    return out;
  };
  EXPECT_EQ(order(1), order(1));
  EXPECT_NE(order(1), order(2));
}

// A gradient of one unit from border to border: treatments' means of the arrangement hold less of
// it than those of fields that stand in the order of their designs.
TEST(Wafer, GradientsMoveTheMeansOfDesignsLittle) {
  const Wafer wafer("[wafer]\nrepeats = 6\ncolumns = 6\nrows = 6\n");
  const auto spread = [&](const auto& gradient) {
    std::map<std::size_t, std::pair<double, int>> sums;
    for (const WaferField& f : wafer.plan.fields) {
      auto& [sum, n] = sums[f.treatment];
      sum += gradient(f), ++n;
    }
    double low = kInfinity, high = -kInfinity;
    for (const auto& [treatment, s] : sums) {
      const double mean = s.first / s.second;
      low = std::min(low, mean), high = std::max(high, mean);
    }
    return high - low;
  };
  const double side = 5 * wafer.plan.pitch_x;
  EXPECT_LT(spread([&](const WaferField& f) { return f.x / side; }), 0.2);
  EXPECT_LT(spread([&](const WaferField& f) { return f.y / side; }), 0.2);
  EXPECT_LT(spread([&](const WaferField& f) { return std::hypot(f.x, f.y) / side; }), 0.2);
}

TEST(Wafer, FieldsOfARoundOneLieWithinItsEdge) {
  const Wafer wafer("[wafer]\ndiameter = \"125 mm\"\nedge = \"4 mm\"\n");
  EXPECT_GT(wafer.plan.fields.size(), 16u);
  for (const WaferField& f : wafer.plan.fields)
    EXPECT_LE(std::hypot(std::abs(f.x) + 6e-3, std::abs(f.y) + 6e-3), 58.5e-3) << f.id;
}

// Pads of 1 mm, labels as wide as they may be: "A1 FLAT" is the widest.
TEST(Wafer, LabelsOfSmallPadsEndBeforeTheSizesBetweenThem) {
  const std::string small = "[wafer]\npad_width = \"1 mm\"\npad_height = \"1 mm\"\nlabel = ";
  const Wafer wafer(small + "\"333 um\"\n");
  std::map<std::string, const LayoutCell*> cells;
  for (const LayoutCell& cell : wafer.drawing.layout.cells) cells[cell.name] = &cell;
  std::int32_t left = 0, right = 0, low = 0;
  for (const LayoutPolygon& p : cells.at("SIZES")->polygons) {
    for (const std::int32_t x : p.outline.x) left = std::min(left, x), right = std::max(right, x);
    for (const std::int32_t y : p.outline.y) low = std::min(low, y);
  }
  EXPECT_EQ(low, -kSizesHigh);
  EXPECT_EQ(left, -kSizesReach);
  EXPECT_EQ(right, kSizesReach);
  // They stand at the crossing of streets half a pitch from a field; a label ends as far before its
  // own, the letters five squares wide.
  const std::vector<LayoutReference>& on_top = cells.at("WAFER")->references;
  const auto sizes = std::find_if(on_top.begin(), on_top.end(),
                                  [](const LayoutReference& r) { return r.cell == "SIZES"; });
  ASSERT_NE(sizes, on_top.end());
  constexpr std::int32_t kCrossing = 2000000;  // [nm]
  std::int32_t end = -kCrossing;
  bool beside = false;
  for (const LayoutReference& field : on_top) {
    if (!field.cell.starts_with("FIELD_")) continue;
    beside = beside || field.x + kCrossing == sizes->x;
    for (const LayoutReference& letter : cells.at(field.cell)->references) {
      if (letter.cell.starts_with("GLYPH_"))
        end = std::max(end, letter.x + kGlyphColumns * 333000 / kGlyphRows);
    }
  }
  EXPECT_TRUE(beside);
  EXPECT_LE(end, kCrossing + left);
  EXPECT_GT(end, kCrossing + left - 60000);  // but for the blank behind a letter
  const auto refused = [&](const char* label) {
    return refusal_of([&] { Wafer(small + "\"" + label + "\"\n"); });
  };
  EXPECT_NE(refused("334 um").find("FLAT\" is 2004 um wide, more than the 1999 um below its pad "
                                   "that leave room for the marks"),
            std::string::npos)
      << refused("334 um");
  EXPECT_NE(refused("410 um"), "");
}

// Of a die of one field, 1.35 mm from corner to corner: crosses of two masks reach 0.4 mm inwards
// from each, those of three 0.7 mm.
TEST(Wafer, RefusesSmallDiesWhoseCrossesWouldStandOnEachOther) {
  const auto refused = [](int masks, int rows) {
    const Workplace place;
    const std::string list = fmt::format(
        "schema_version = 1\n[wafer]\npad_width = \"0.15 mm\"\npad_height = \"0.15 mm\"\ngap = "
        "\"1.2 "
        "mm\"\nlabel = \"20 um\"\nrepeats = {}\nflats = 0\nreferences = 0\ncolumns = 1\nrows = {}\n"
        "levels = {}\n",
        rows, rows, masks);
    place.write("d.toml", array_design("waves", "period = \"10 um\"\n"));
    place.write("list.toml", list + "[[design]]\nfile = \"d.toml\"\n");
    return refusal_of([&] { draw_wafer(plan_wafer((place.path() / "list.toml").string())); });
  };
  EXPECT_EQ(refused(2, 1), "");
  EXPECT_NE(
      refused(3, 1).find("3 masks, whose alignment crosses reach 0.7 mm inwards from each "
                         "corner: on 1 x 1 fields, 1.35 mm from one to the next, they stand on "
                         "each other"),
      std::string::npos)
      << refused(3, 1);
  // Of two rows the bars stand half-way between the corners of one side.
  EXPECT_EQ(refused(4, 2), "");
  EXPECT_NE(refused(5, 2).find("5 masks"), std::string::npos) << refused(5, 2);
  EXPECT_EQ(refused(5, 4), "");
}

// Two periods of 400 um are the whole number of them nearest to these pads.
TEST(Wafer, RefusesTexturesThatReachTheCornersOfTheirPad) {
  const auto refused = [](const char* pad) {
    const Workplace place;
    place.write("d.toml",
                array_design("hole_array",
                             "period = \"400 um\"\ndiameter = \"200 um\"\ndepth = \"10 um\"\n",
                             "[model]\nwater = \"threshold\"\n"));
    place.write("list.toml", std::string("schema_version = 1\n[wafer]\npad_width = \"") + pad +
                                 "\"\npad_height = \"" + pad +
                                 "\"\nlabel = \"20 um\"\n[[design]]\nname = \"H\"\nfile = "
                                 "\"d.toml\"\n");
    return refusal_of([&] { draw_wafer(plan_wafer((place.path() / "list.toml").string())); });
  };
  EXPECT_EQ(refused("800 um"), "");
  EXPECT_EQ(refused("720 um"), "");  // 40 um beyond it, before the corners
  EXPECT_NE(refused("640 um").find("H: its whole periods reach 80 um beyond the pad, onto the "
                                   "corners that begin 50 um beside it"),
            std::string::npos)
      << refused("640 um");
}

TEST(Wafer, HasAMaskForEachDepthOfWhichAllPolygonsAreDeep) {
  const Wafer wafer("");
  ASSERT_EQ(wafer.drawing.levels.size(), 2u);
  EXPECT_NEAR(wafer.drawing.levels[0].etch, 600e-9, 1e-15);
  EXPECT_EQ(wafer.drawing.levels[0].designs, std::vector<std::string>{"H3"});
  EXPECT_NEAR(wafer.drawing.levels[1].etch, 350e-9, 1e-15);
  EXPECT_EQ(wafer.drawing.levels[1].designs, (std::vector<std::string>{"H1", "H2", "P1"}));
  // Of pillars the area around them: the hexagon of the lattice less the disc.
  for (const LayoutCell& cell : wafer.drawing.layout.cells) {
    if (cell.name != "DESIGN_P1_CELL") continue;
    double area = 0;
    for (const LayoutPolygon& p : cell.polygons) {
      EXPECT_EQ(p.layer, 2);
      for (std::size_t i = 0; i < p.outline.x.size(); ++i) {
        const std::size_t j = (i + 1) % p.outline.x.size();
        area += 0.5e-6 *
                (1.0 * p.outline.x[i] * p.outline.y[j] - 1.0 * p.outline.x[j] * p.outline.y[i]);
      }
    }
    const double hexagon = 0.5 * std::sqrt(3.0) * 25, disc = kPi / 4 * 2.5 * 2.5;
    EXPECT_NEAR(area, hexagon - disc, 0.002 * hexagon);  // [um^2]; it overlaps by nanometres
  }
}

TEST(Wafer, AStudyGivesItsDesignAndTheEndsOfItsTexture) {
  const WaferPlan plan = plan_wafer(PAPILLA_DESIGNS_DIR "/m3_glass/conformal.toml");
  std::set<double> depths;
  bool flat = false;
  for (const Treatment& t : plan.treatments) {
    if (const auto* holes = std::get_if<HoleArray>(&t.design.texture.kind))
      depths.insert(holes->depth);
    else
      flat = flat || t.name != "FLAT";
    EXPECT_EQ(t.design.surface, plan.treatments[0].design.surface) << t.name;
  }
  // As written, and both ends: 0, which is flat, to 1 um.
  EXPECT_TRUE(flat);
  EXPECT_EQ(depths.size(), 2u);
  EXPECT_NEAR(*depths.begin(), 350e-9, 1e-15);
  EXPECT_NEAR(*depths.rbegin(), 1e-6, 1e-15);
}

TEST(Wafer, AStackOfArraysTakesAMaskForEachOfThem) {
  const Workplace place;
  place.write("two.toml",
              "schema_version = 1\n[texture]\ntype = \"stack\"\n[[texture.parts]]\ntype = "
              "\"hole_array\"\nperiod = \"12 um\"\ndiameter = \"6 um\"\ndepth = \"300 nm\"\n"
              "[[texture.parts]]\ntype = \"hole_array\"\nperiod = \"3 um\"\ndiameter = \"1 um\"\n"
              "depth = \"100 nm\"\n[finger]\nbase = \"fingers/reference.toml\"\n");
  place.write("list.toml", "schema_version = 1\n[[design]]\nname = \"T\"\nfile = \"two.toml\"\n");
  const WaferDrawing drawing = draw_wafer(plan_wafer((place.path() / "list.toml").string()));
  ASSERT_EQ(drawing.levels.size(), 2u);
  EXPECT_NEAR(drawing.levels[0].etch, 300e-9, 1e-15);
  EXPECT_NEAR(drawing.levels[1].etch, 100e-9, 1e-15);
}

// Over a pad that holds no whole number of the longer period, and in a master whose periods are on
// no whole nanometre: of both masks the arrays begin at one corner and end at one.
TEST(Wafer, TheMasksOfAStackAreInRegisterOverAllOfThePad) {
  for (const char* sections : {"[wafer]\npad_width = \"10 mm\"\npad_height = \"10 mm\"\n",
                               "[process]\nshrinkage = \"0.42 %\"\n"}) {
    for (const char* lattice : {"square", "hexagonal"}) {
      const Workplace place;
      const auto part = [&](const char* measures) {
        return std::string("[[texture.parts]]\ntype = \"hole_array\"\nlattice = \"") + lattice +
               "\"\n" + measures;
      };
      place.write("two.toml",
                  "schema_version = 1\n[texture]\ntype = \"stack\"\n" +
                      part("period = \"6 um\"\ndiameter = \"3 um\"\ndepth = \"350 nm\"\n") +
                      part("period = \"2 um\"\ndiameter = \"1 um\"\ndepth = \"100 nm\"\n") +
                      "[finger]\nbase = \"fingers/reference.toml\"\n");
      place.write("list.toml", std::string("schema_version = 1\n") + sections +
                                   "[[design]]\nname = \"T\"\nfile = \"two.toml\"\n");
      const WaferDrawing drawing = draw_wafer(plan_wafer((place.path() / "list.toml").string()));
      std::vector<LayoutReference> first;
      std::vector<double> ends;  // of all rows [nm]
      for (const LayoutCell& cell : drawing.layout.cells) {
        if (cell.name != "DESIGN_T_1" && cell.name != "DESIGN_T_2") continue;
        first.push_back(cell.references.front());
        const LayoutReference& last = cell.references.back();
        ends.push_back(last.y + static_cast<double>(last.rows * last.step_y));
      }
      ASSERT_EQ(first.size(), 2u);
      const auto& [coarse, fine] = std::tie(first[0], first[1]);
      EXPECT_EQ(coarse.x, fine.x) << sections << lattice;
      EXPECT_EQ(coarse.y, fine.y) << sections << lattice;
      EXPECT_EQ(3 * coarse.columns, fine.columns) << sections << lattice;
      EXPECT_EQ(coarse.step_x, 3 * fine.step_x) << sections << lattice;
      if (std::string(lattice) == "square") {
        EXPECT_EQ(coarse.step_y, 3 * fine.step_y) << sections;
        EXPECT_EQ(ends[0], ends[1]) << sections;
      }
    }
  }
}

TEST(Wafer, TheManifestHasALineForEachFieldAndCondition) {
  const Wafer wafer(
      "[wafer]\nrepeats = 1\n[conditions]\nload = [\"0.2 N\", \"0.5 N\"]\nhumidity = "
      "[\"15 %\", \"55 %\"]\nvoltage = [\"0 V\", \"150 V\"]\nfrequency = [\"1 kHz\", "
      "\"5 kHz\"]\nstates = \"clean, natural\"\n");
  const std::string folder = wafer.write();
  std::vector<std::string> lines = split(read_bytes(folder + "/manifest.csv"), '\n');
  lines.pop_back();
  const std::vector<std::string> head = split(lines.front(), ',');
  // Undriven once, driven at two frequencies.
  EXPECT_EQ(lines.size() - 1, wafer.plan.fields.size() * 2 * 2 * 2 * (1 + 2));
  for (std::size_t i = 1; i < lines.size(); ++i) {
    std::map<std::string, std::string> row;
    const std::vector<std::string> cells = split(lines[i], ',');
    ASSERT_EQ(cells.size(), head.size());
    for (std::size_t k = 0; k < head.size(); ++k) row[head[k]] = cells[k];
    for (const char* due : {"field", "row", "column", "design", "repeat", "load_N",
                            "humidity_percent", "voltage_V", "frequency_Hz", "state"})
      EXPECT_TRUE(row.count(due)) << due;
    EXPECT_TRUE(std::filesystem::exists(folder + "/" + row["design"]));
    EXPECT_TRUE(row["humidity_percent"] == "15" || row["humidity_percent"] == "55");
    EXPECT_EQ(row["voltage_V"] == "0", row["frequency_Hz"] == "0");
  }
}

// A plan of one design of this, under these conditions.
WaferPlan plan_of(const Workplace& place, const std::string& design,
                  const std::string& conditions) {
  place.write("h1.toml", array_design("hole_array", "depth = \"350 nm\"\n") + design);
  place.write("list.toml", "schema_version = 1\n[wafer]\nrepeats = 1\n[conditions]\n" + conditions +
                               "[[design]]\nname = \"H1\"\nfile = \"h1.toml\"\n");
  return plan_wafer((place.path() / "list.toml").string());
}

// Of a coefficient the friction is that times the load, whatever finger the design has.
TEST(Wafer, ExpectsOfAPinWhatItsOwnLoadMakes) {
  const std::string pin =
      "[counterface]\ntype = \"pin\"\nname = \"tip\"\nload = \"1 N\"\nmodulus = \"3 GPa\"\n"
      "radius = \"5 mm\"\ncoefficient = 0.2\nconducting = false\n";
  const Workplace place;
  const WaferPlan own = plan_of(place, pin, "humidity = [\"50 %\"]\n");
  const std::vector<WaferCondition> at =
      conditions_of(own.list.conditions, own.treatments.front().design);
  ASSERT_EQ(at.size(), 1u);
  EXPECT_EQ(at[0].load, 1);
  EXPECT_FALSE(at[0].state);
  const WaferPlan plan = plan_of(
      place, pin, "load = [\"0.2 N\", \"2 N\"]\nvoltage = [\"0 V\"]\nhumidity = [\"50 %\"]\n");
  EXPECT_NO_THROW(check_conditions(plan));
  const Expectations expected = expect(plan, false);
  EXPECT_NEAR(expected.at(0).at(0).friction_off, 0.04, 1e-6);
  EXPECT_NEAR(expected.at(0).at(1).friction_off, 0.4, 1e-5);
  const std::string stated =
      refusal_of([&] { check_conditions(plan_of(place, pin, "states = \"clean, natural\"\n")); });
  EXPECT_NE(stated.find("\"tip\" stands in place of the finger"), std::string::npos) << stated;
}

TEST(Wafer, StatesWhatBeliefLeavesOpenOfWhatItExpects) {
  const Workplace place;
  place.write("few_members.toml", file_text(PAPILLA_TEST_DATA "/study/few_members.toml"));
  WaferPlan plan = plan_of(place, "", "voltage = [\"200 V\"]\nhumidity = [\"55 %\"]\n");
  for (Treatment& t : plan.treatments)
    t.design.finger.belief = (place.path() / "few_members.toml").string();
  const Expected whole = expect(plan, true).at(0).at(0), own = expect(plan, false).at(0).at(0);
  EXPECT_EQ(whole.friction_off, own.friction_off);
  EXPECT_EQ(whole.modulation, own.modulation);
  EXPECT_GT(whole.friction_error, 1.1 * own.friction_error);
  EXPECT_GT(whole.modulation_error, 1.1 * own.modulation_error);
}

TEST(Wafer, RefusesConditionsThatTheModelRefuses) {
  const Workplace place;
  const std::string driven = "load = [\"0.2 N\"]\nvoltage = [\"0 V\", \"700 V\"]\n";
  const auto refused = [&](const std::string& design) {
    return refusal_of([&] { check_conditions(plan_of(place, design, driven)); });
  };
  const std::string bare = refused("[surface]\ndielectric = []\n"),
                    weak = refused("[drive]\nsource_compliance = \"300 V\"\n");
  EXPECT_EQ(refused(""), "");
  EXPECT_NE(bare.find("surface.dielectric: H1 at 0.2 N, 700 V"), std::string::npos) << bare;
  EXPECT_NE(bare.find("a driven surface needs a dielectric"), std::string::npos) << bare;
  EXPECT_NE(weak.find("700 V is above source_compliance, 300 V"), std::string::npos) << weak;
  EXPECT_EQ(weak.find("at 0.2 N, 0 V"), std::string::npos) << weak;
}

// A line for each design and voltage at which a film does not hold.
TEST(Wafer, SaysAtWhichVoltagesAFilmBreaksDown) {
  const Workplace place;
  const WaferPlan plan =
      plan_of(place, "", "voltage = [\"0 V\", \"700 V\"]\nhumidity = [\"15 %\", \"75 %\"]\n");
  Expected sound, broken, worse;
  broken.oxide_margin = 0.98, worse.oxide_margin = 0.95;
  EXPECT_EQ(breakdown_lines(plan, {{sound, sound, broken, worse}, {sound, sound, sound, sound}}),
            (std::vector<std::string>{
                "H1 at 700 V: the dielectric breaks down: the field in a layer is 1.05 times its "
                "strength, at most 665 V hold; no modulation is expected"}));
  const WaferPlan kilovolts = plan_of(place, "", "voltage = [\"2 kV\"]\nhumidity = [\"15 %\"]\n");
  EXPECT_NE(breakdown_lines(kilovolts, {{worse}, {sound}}).front().find("at most 1900 V hold"),
            std::string::npos);
  // What is solved at two humidities holds, but not what a bridge would put on the film.
  Expected bridged;
  bridged.oxide_margin = 1.1, bridged.bridged_margin = 0.8;
  EXPECT_EQ(breakdown_lines(plan, {{sound, sound, sound, bridged}, {sound, sound, sound, sound}}),
            (std::vector<std::string>{
                "H1 at 700 V: the dielectric is at risk: under a bridge or a contact on its "
                "thinnest place the field is 1.25 times its strength, at most 560 V hold"}));
}

TEST(Wafer, CountsTheDesignsOfAListAndOfAStudyTogether) {
  const Workplace place;
  const std::string holes =
      array_design("hole_array", "period = \"6 um\"\ndiameter = \"3 um\"\ndepth = \"350 nm\"\n");
  place.write("h.toml", holes);
  place.write("study.toml", holes +
                                "[design_space]\n\"texture.depth\" = [\"200 nm\", \"500 nm\"]\n"
                                "[objective]\nminimise = \"mean(friction)\"\n");
  place.write("list.toml",
              "schema_version = 1\ndesigns_of = \"study.toml\"\n[[design]]\nfile = \"h.toml\"\n"
              "[[design]]\nname = \"D03\"\nfile = \"h.toml\"\n");
  const WaferPlan plan = plan_wafer((place.path() / "list.toml").string());
  std::vector<std::string> names;
  for (const Treatment& t : plan.treatments) names.push_back(t.name);
  EXPECT_EQ(names, (std::vector<std::string>{"D01", "D03", "D02", "D04", "D05", "FLAT"}));
  ASSERT_GE(plan.notes.size(), 2u);
  EXPECT_TRUE(plan.notes[0].starts_with("D04: texture.depth = 200 nm")) << plan.notes[0];
  EXPECT_TRUE(plan.notes[1].starts_with("D05: texture.depth = 500 nm")) << plan.notes[1];
}

TEST(WaferVerify, NamesADesignThatIsOfNoField) {
  const Wafer wafer("");
  const std::string folder = wafer.write();
  std::filesystem::copy(folder + "/designs/P1.toml", folder + "/designs/P2.toml");
  const FileVerdict last = verify_wafer(folder).files.back();
  EXPECT_EQ(last.path, folder + "/designs/P2.toml");
  EXPECT_EQ(last.state, FileState::Differs);
}

TEST(Wafer, IsMadeAgainFromItsRecordToTheLastByte) {
  const Wafer wafer("[process]\nresist_bias = \"20 nm\"\n");
  const std::string folder = wafer.write();
  const WaferPlan again = plan_wafer(folder + "/wafer.toml");
  write_wafer(again, draw_wafer(again), {}, wafer.path("again"));
  for (const char* file : {"wafer.gds", "wafer.oas", "manifest.csv", "wafer.toml"})
    EXPECT_EQ(read_bytes(folder + "/" + file), read_bytes(wafer.path("again/") + file)) << file;
}

// So many droplets on a patch are not settled in reasonable time, which no mask needs: the wafer is
// drawn, and verified, without what is expected of it.
TEST(Wafer, IsDrawnOfADesignThatIsTooWetToSimulate) {
  const Workplace place;
  const std::string wet =
      array_design("hole_array", "period = \"6 um\"\ndiameter = \"3 um\"\ndepth = \"100 nm\"\n") +
      "[finger.water]\ndrops_per_um3 = 100000\n";
  place.write("d.toml", wet);
  place.write("list.toml", "schema_version = 1\n[[design]]\nname = \"W\"\nfile = \"d.toml\"\n");
  const std::string list = (place.path() / "list.toml").string(),
                    folder = (place.path() / "wafer").string();
  EXPECT_NE(refusal_of([&] { plan_wafer(list); }).find("settled in reasonable time"),
            std::string::npos);
  const WaferPlan plan = plan_wafer(list, {}, DesignUse::Drawn);
  EXPECT_NE(refusal_of([&] { check_conditions(plan); }).find("settled in reasonable time"),
            std::string::npos);
  EXPECT_NO_THROW(check_conditions(plan, DesignUse::Drawn));
  write_wafer(plan, draw_wafer(plan), {}, folder);
  for (const FileVerdict& file : verify_wafer(folder).files)
    EXPECT_EQ(file.state, FileState::Sound) << file.path;
}

// 33333 columns and rows, of which GDSII holds 32767 in a record.
TEST(WaferVerify, FindsPadsOfMoreColumnsThanARecordHoldsSound) {
  const Workplace place;
  place.write("d.toml",
              array_design("hole_array",
                           "period = \"360 nm\"\ndiameter = \"180 nm\"\ndepth = \"100 nm\"\n"));
  place.write("list.toml",
              "schema_version = 1\n[wafer]\npad_width = \"12 mm\"\npad_height = \"12 mm\"\n"
              "repeats = 1\n[[design]]\nname = \"S\"\nfile = \"d.toml\"\n");
  const WaferPlan plan = plan_wafer((place.path() / "list.toml").string());
  const std::string folder = (place.path() / "out").string();
  write_wafer(plan, draw_wafer(plan), {}, folder);
  for (const FileVerdict& file : verify_wafer(folder).files)
    EXPECT_EQ(file.faults, std::vector<std::string>{}) << file.path;
}

TEST(WaferVerify, NamesWhatWasChangedInEachFile) {
  const Wafer wafer("");
  const std::string folder = wafer.write();
  const auto state_of = [&](const std::string& file) {
    for (const FileVerdict& v : verify_wafer(folder).files) {
      if (v.path == folder + "/" + file) return v.state;
    }
    return FileState::Missing;
  };
  const std::vector<std::string> files{"wafer.gds", "wafer.oas", "manifest.csv", "designs/P1.toml"};
  for (const std::string& file : files) EXPECT_EQ(state_of(file), FileState::Sound) << file;
  // A hole 4 nm wider.
  Layout layout = wafer.drawing.layout;
  layout.cells.front().polygons.front().outline.x.front() += 4;
  write_gds(folder + "/wafer.gds", layout);
  const FileVerdict gds = verify_wafer(folder).files.front();
  EXPECT_EQ(gds.state, FileState::Differs);
  EXPECT_EQ(gds.faults.front(), "cell DESIGN_H1_CELL: its corners are up to 4 nm off");
  // Two fields exchanged.
  layout = wafer.drawing.layout;
  std::swap(layout.cells.back().references[0].cell, layout.cells.back().references[1].cell);
  write_oasis(folder + "/wafer.oas", layout);
  EXPECT_EQ(state_of("wafer.oas"), FileState::Differs);
  // Another load in one line.
  std::string manifest = read_bytes(folder + "/manifest.csv");
  manifest.replace(manifest.find(",0.2,"), 5, ",0.3,");
  write_bytes(folder + "/manifest.csv", manifest);
  EXPECT_EQ(state_of("manifest.csv"), FileState::Differs);
  std::filesystem::remove(folder + "/wafer.oas");
  EXPECT_EQ(state_of("wafer.oas"), FileState::Missing);
}

TEST(Wafer, RefusesWhatHasNoMaskWithTheWayOut) {
  const auto refused = [](const std::string& design, const std::string& sections) {
    const Workplace place;
    place.write("d.toml", design);
    place.write("list.toml", "schema_version = 1\n" + sections + "[[design]]\nfile = \"d.toml\"\n");
    return refusal_of([&] { draw_wafer(plan_wafer((place.path() / "list.toml").string())); });
  };
  const auto says = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const std::string holes = array_design("hole_array", "depth = \"350 nm\"\n");
  says(refused(array_design("random_rough", ""), ""), "no outline");
  says(refused(array_design("waves", ""), ""), "wafer.levels = 3");
  EXPECT_EQ(refused(array_design("waves", ""), "[wafer]\nlevels = 3\n"), "");
  says(refused(holes, "[process]\nundercut = \"200 %\"\nresist_bias = \"2000 nm\"\n"),
       "no mask makes it");
  says(refused(holes, "[wafer]\nlabel = \"2 mm\"\n"), "wafer.label");
  says(refused(holes, "[wafer]\npad_width = \"500 um\"\n"), "wider pads");
  says(refused(holes, "[wafer]\nreference = \"X\"\n"), "wafer.reference: no design \"X\"");
  says(refused(holes, "[wafer]\ncolumns = 1\nrows = 2\n"), "fewer repeats");
  says(refused(holes, "[wafer]\nrepeat = 2\n"), "repeats");
  says(refused(holes, "[conditions]\nload = [\"-1 N\"]\n"), "load");
}

// 15 % and .15 are one humidity however they are written; falling ones are a list as good as
// another.
TEST(Wafer, RefusesAConditionThatStandsTwice) {
  const auto refused = [](const std::string& conditions) {
    const Workplace place;
    write_wafer_list(place, "[conditions]\n" + conditions + "\n");
    return keyed_refusal_of([&] { plan_wafer((place.path() / "list.toml").string()); });
  };
  EXPECT_EQ(refused("humidity = [\"15 %\", \"75 %\", \"15.0 %\"]"),
            "conditions.humidity: 15 % stands twice: name it once\n");
  EXPECT_EQ(refused("load = [\"0.2 N\", \"200 mN\"]"),
            "conditions.load: 0.2 N stands twice: name it once\n");
  EXPECT_EQ(refused("voltage = [\"0 V\", \"0 V\"]\nstates = \"clean, clean\""),
            "conditions.voltage: 0 V stands twice: name it once\n"
            "conditions.states: clean stands twice: name it once\n");
  EXPECT_EQ(refused("frequency = [\"5 kHz\", \"5000 Hz\"]"),
            "conditions.frequency: 5000 Hz stands twice: name it once\n");
  EXPECT_EQ(refused("humidity = [\"75 %\", \"15 %\"]"), "");
}

}  // namespace
}  // namespace papilla::tests::wafer_test
