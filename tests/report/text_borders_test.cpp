// Texts at the borders of what they say: values of nothing, marks that follow each other, halves of
// shares.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files.h"
#include "report/accuracy.h"
#include "report/claims.h"
#include "report/pieces.h"
#include "report/ranking.h"
#include "report/surface.h"
#include "tests/temporary.h"

namespace papilla::tests::text_borders_test {
namespace {

TEST(TextBorders, BarsThatFollowEachOtherAreAllEscaped) {
  const Claim claim{"C", "a||b", "|c|", "d|||", false, {}};
  ClaimResult r;
  r.claim = &claim;
  r.papilla = {Verdict::Fitted, 1, 0, "|", "||", 0.005};
  EXPECT_TRUE(claims_markdown({r}, "f").ends_with(
      "| C | \\|c\\| (a\\|\\|b) | d\\|\\|\\| | \\| | fitted | \\|\\| | 0 % |  |\n"))
      << claims_markdown({r}, "f");
  // A cell with a line's end is quoted as one with a comma is.
  const Claim lines{"L", "a\nb", "\"", ",", false, {}};
  r.claim = &lines;
  EXPECT_TRUE(claims_csv({r}).ends_with("L,\"a\nb\",\"\"\"\",\",\",fitted,1,,|,||,0.005,,,,,,\n"))
      << claims_csv({r});
}

// Of a value of nothing no share is stated; a value of one is one.
TEST(TextBorders, OfNothingNoShareIsStated) {
  AccuracyRow r;
  r.sweep = "seed", r.setting = "a setting", r.fidelity.estimator = Estimator::Load;
  const auto& quantities = accuracy_quantities();
  r.value.assign(quantities.size(), 1);
  r.stated.assign(quantities.size(), 0.25);
  r.error.assign(quantities.size(), 0.5);
  r.value[0] = 0, r.error[0] = 0;
  r.value[1] = -2;                      // 25 of 200 %
  r.error[2] = 1, r.stated[2] = 0.249;  // 0.5 off: just beyond two of them
  r.error[3] = 1;                       // just not
  const std::string folder = temporary("borders");
  std::filesystem::create_directories(folder);
  write_bytes(folder + "/sweeps.csv", accuracy_csv({r}, ""));
  for (const char* name : {"/coverage.csv", "/coverage_tight.csv"})
    write_bytes(folder + name, coverage_csv({}, ""));
  const std::string page = accuracy_page(folder);
  EXPECT_NE(page.find("\n| a setting | +0.00 % (0.0 %) | +50.00 % (12.5 %) | +100.00 % (24.9 %) | "
                      "+100.00 % (25.0 %) | +50.00 % (25.0 %) |"),
            std::string::npos)
      << page;
  EXPECT_NE(page.find("Other skins, offsets and droplets; error against the mean of the seeds. "
                      "Error of the value"),
            std::string::npos);
  // Half of a value of two thirds of the truth: -2 is 1.33 less than its truth by the 50 %.
  EXPECT_NE(
      page.find("\nBeyond two of the standard errors stated: a setting, " + quantities[1].name +
                " (2.7); a setting, " + quantities[2].name + " (2.0).\n"),
      std::string::npos)
      << page;
  EXPECT_NE(accuracy_csv({r}, "").find("\nseed,a setting,256,40,load,"), std::string::npos);
}

TEST(TextBorders, EachSweepHasItsOwnWords) {
  std::vector<AccuracyRow> rows;
  const std::vector<std::pair<const char*, const char*>> words{
      {"grid", "Pixels along the patch; same skins and droplets; error against the finest"},
      {"skins", "Number of skins; error against the most"},
      {"seed", "Other skins, offsets and droplets; error against the mean of the seeds"},
      {"tolerance", "Certificate of the contact solver; error against the tightest"},
      {"field",
       "Residual of the potential that spreads in the dielectric; error against the smallest"},
      {"estimator", "Load law or solved areas; error against the latter"},
      {"model",
       "Options of `[model]`; shift against the file's own (absorbed by the fit of the finger)"},
      {"level", "Levels; error against reference"},
      {"another", ""}};
  for (const auto& [sweep, text] : words) {
    AccuracyRow r;
    r.sweep = sweep, r.setting = "s";
    r.value = r.stated = r.error = std::vector<double>(accuracy_quantities().size(), 0.5);
    rows.push_back(r);
  }
  const std::string folder = temporary("words");
  std::filesystem::create_directories(folder);
  write_bytes(folder + "/sweeps.csv", accuracy_csv(rows, ""));
  for (const char* name : {"/coverage.csv", "/coverage_tight.csv"})
    write_bytes(folder + name, coverage_csv({}, ""));
  const std::string page = accuracy_page(folder);
  for (const auto& [sweep, text] : words) {
    EXPECT_NE(page.find("\n## " + std::string(sweep) + "\n\n" + text + ". Error of the value"),
              std::string::npos)
        << sweep;
  }
}

// Bars of eighths from the least to the most: of a row of nine, of one that stays, of many.
TEST(TextBorders, ASectionIsDrawnInEighths) {
  SurfaceView v;
  v.scan.map = {{9, 1, 9e-6, 1e-6}, {}};
  for (int i = 0; i < 9; ++i) v.scan.map.z.push_back(1e-9 * (5 - i));
  EXPECT_TRUE(surface_text(v).ends_with("\nsection along x at y = 0.5 um, -3 to 5 nm\n█▇▆▅▄▃▂▁ \n"))
      << surface_text(v);
  // The row above the middle of four; 72 columns of 2.5 pixels on a slope.
  v.scan.map = {{180, 4, 18e-6, 8e-6}, std::vector<double>(720, -1e-9)};
  for (int i = 0; i < 180; ++i) v.scan.map(i, 2) = 1e-9 * (i / 20);
  const std::string text = surface_text(v);
  const std::string mark = "\nsection along x at y = 5 um, 0 to 8 nm\n";
  ASSERT_NE(text.find(mark), std::string::npos) << text;
  const std::string bars = text.substr(text.find(mark) + mark.size());
  std::string expected;
  for (const char* bar : {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"}) {
    for (int k = 0; k < 8; ++k) expected += bar;
  }
  EXPECT_EQ(bars, expected + "\n");
}

TEST(TextBorders, WhatIsNearlyCertainIsNotSaidToBe) {
  RankOptions options;
  options.criteria = parse_criteria("friction:low");
  options.weights = {1};
  Ranking ranking;
  ranking.titles = {"a", "b", "c", "d"};
  StateRanking state;
  const double p[] = {0.9991, 0.999, 0.001, 0.0009};
  for (std::size_t i = 0; i < 4; ++i) {
    RankedCandidate c;
    c.index = i, c.rank = static_cast<int>(i) + 1, c.p_ahead = c.p_best = p[i];
    c.p_best_by = {0.5}, c.metrics = {{0.1, 0.09, 0.11}}, c.skins = 20 - static_cast<int>(i);
    c.over.assign(4, Relation::TradeOff);
    state.candidates.push_back(c);
  }
  state.skins = 7, state.equal_skins = 7;
  ranking.states = {state};
  const std::string table = ranking_table({"a", "b", "c", "d"}, options, ranking);
  for (const char* text : {">0.999", "0.999  ", "0.001  ", "<0.001"})
    EXPECT_NE(table.find(text), std::string::npos) << text << table;
  EXPECT_NE(table.find(">0.999"), table.rfind(">0.999"));  // ahead of the next, and of all
  EXPECT_EQ(table.find("<0.001"), table.rfind("<0.001"));  // the last is ahead of none
  EXPECT_NE(table.find("the order is known; 7 patches of skin tried\n"), std::string::npos);
  EXPECT_NE(table.find("all designs met the same skins (17 at least): trust the order"),
            std::string::npos);
  EXPECT_EQ(table.find("by the weighted mean over criteria"), std::string::npos);  // there is one
  EXPECT_NE(table.find("what the fit of the finger leaves open is in no interval"),
            std::string::npos);
  // A folder of it: designs by their numbers, and a picture of three criteria or more.
  const std::string folder = temporary("ranked");
  ranking.conditions.clear();
  std::vector<Regions> regions;
  for (int i = 0; i < 4; ++i) {
    regions.push_back({read_design(PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml")});
    if (i == 1) regions.back().push_back(regions.back().front());
  }
  write_ranking(folder, regions, {"a", "b", "c", "d"}, options, ranking);
  EXPECT_EQ(read_bytes(folder + "/ranking.txt"), table);
  EXPECT_EQ(read_bytes(folder + "/ranking.csv"),
            ranking_csv({"a", "b", "c", "d"}, options, ranking));
  EXPECT_EQ(read_bytes(folder + "/ranking.json"),
            ranking_json({"a", "b", "c", "d"}, options, ranking) + "\n");
  for (const char* name : {"01", "02", "02_2", "03", "04"})
    EXPECT_TRUE(std::filesystem::exists(folder + "/designs/" + name + ".toml")) << name;
  EXPECT_FALSE(std::filesystem::exists(folder + "/radar_natural.svg"));
  options.criteria = parse_criteria("friction:low,adhesion:low,compliance:high");
  options.weights = {1, 1, 1};
  for (RankedCandidate& c : ranking.states[0].candidates) {
    c.metrics.assign(3, c.metrics[0]);
    c.p_best_by.assign(3, 0.5);
  }
  write_ranking(folder, regions, {"a", "b", "c", "d"}, options, ranking);
  EXPECT_EQ(read_bytes(folder + "/radar_" +
                       finger_state_names()[static_cast<std::size_t>(state.state)] + ".svg"),
            radar_svg({"a", "b", "c", "d"}, options, ranking.states[0]));
}

TEST(TextBorders, ABridgeThatRepelsByNothingAttracts) {
  Bridge bridge;
  bridge.status = BridgeStatus::Converged;
  BridgeLimits limits;
  limits.status = BridgeStatus::Converged;
  limits.rupture = 2;
  EXPECT_NE(bridge_text(bridge, limits, 1e-7).find("force             0 nN (attracts)"),
            std::string::npos);
  EXPECT_NE(bridge_text(bridge, limits, 1e-7).find("ruptures at       200 nm\n"),
            std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::text_borders_test
