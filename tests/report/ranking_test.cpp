// A ranking as people and programs read it: made-up numbers, each another.
#include "report/ranking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/text.h"
#include "tests/report/same_json.h"

namespace papilla::tests::ranking_test {
namespace {

struct Ranked {
  RankOptions options;
  Ranking ranking;
  std::vector<std::string> names{"hard", "fine"};

  Ranked() {
    options.criteria = parse_criteria("friction:low,variation(friction),compliance:high");
    options.parameters = true;
    options.weights = {1, 1, 1};
    RankedCandidate first, second;
    first.index = 1, first.rank = 1, first.tied_with_next = true;
    first.score = {0.3, 0.2, 0.4}, first.behind_best = {0, 0, 0};
    first.ahead_of_next = {0.12, 0.04, 0.2, 0.05};
    first.p_ahead = 0.9, first.p_best = 0.8, first.skins = 24;
    first.p_best_by = second.p_best_by = {0.5, 0.5, 0.5};
    first.over = second.over = {Relation::Open, Relation::Open};
    first.metrics = {{0.1, 0.09, 0.11}, {0.25, 0.2, 0.3}, {3e-12, 2e-12, 4e-12}};
    second.index = 0, second.rank = 2;
    second.score = {0.1, 0, 0.2}, second.behind_best = {-0.12, -0.2, -0.04};
    second.p_best = 0.2, second.skins = 18;
    second.metrics = {{0.2, 0.18, 0.22}, {-0.5, -0.6, -0.4}, {1.5e-12, 1e-12, 2e-12}};
    ranking.states = {{FingerState::Natural, "finger natural", {first, second}, {}, 42, 48}};
    ranking.titles = {"Hard coat", "Fine coat"};
    ranking.skins = 42, ranking.seconds = 6.54;
    ranking.directions = 3, ranking.step_skins = 8, ranking.step_grid = 64;
  }
};

// Cells of a line of a table: two blanks and more between them.
std::vector<std::string> cells(std::string line) {
  line.erase(0, line.find_first_not_of(' '));
  const std::regex gap("  +");
  return {std::sregex_token_iterator(line.begin(), line.end(), gap, -1),
          std::sregex_token_iterator()};
}

TEST(RankingReport, ForPeopleHasEachNumberUnderItsHead) {
  const Ranked r;
  const std::string table = ranking_table(r.names, r.options, r.ranking);
  const std::vector<std::string> lines = split(table, '\n');
  using Cells = std::vector<std::string>;
  EXPECT_EQ(lines[0], "finger natural");
  EXPECT_EQ(cells(lines[1]),
            (Cells{"rank", "design", "mean(friction):low mN", "variation(friction):low",
                   "mean(compliance):high um/MPa", "ahead of the next, %", "model part", "p(ahead)",
                   "p(best)", "skins"}));
  EXPECT_EQ(cells(lines[2]), (Cells{"1=", "fine", "100 ± 10", "0.250 ± 0.050", "3.0 ± 1.0",
                                    "12.0 [4.0, 20.0]", "±9.8", "0.900", "0.800", "24"}));
  EXPECT_EQ(cells(lines[3]), (Cells{"2", "hard", "200 ± 20", "-0.50 ± 0.10", "1.50 ± 0.50", "-",
                                    "-", "-", "0.200", "18"}));
  EXPECT_EQ(lines[4],
            "the order is known; 42 patches of skin tried (more where two designs are close; 48 "
            "with as many for every "
            "design)");
  EXPECT_NE(table.find("3 directions of its covariance, the same for all designs; 8 skins, 64 "
                       "pixels"),
            std::string::npos);
  EXPECT_NE(table.find("all designs met the same skins (18 at least): trust the order"),
            std::string::npos);
  EXPECT_NE(table.find("± and [ ] are 95 % intervals over skins and the parameters of the finger; "
                       "= marks a tie with the next. 42 patches of skin in all, 6.5 s"),
            std::string::npos)
      << table;
}

// Of several criteria without weights there is neither a lead in brackets nor a tie.
TEST(RankingReport, ItsLastLinesTellWhatTheTableHas) {
  Ranked r;
  r.ranking.directions = 0, r.ranking.members = 32;
  EXPECT_NE(ranking_table(r.names, r.options, r.ranking)
                .find("± and [ ] are 95 % intervals over skins and belief; = marks a tie"),
            std::string::npos);
  r.options.weights.clear();
  const std::string table = ranking_table(r.names, r.options, r.ranking);
  EXPECT_NE(table.find("± are 95 % intervals over skins and belief. 42 patches"), std::string::npos)
      << table;
  EXPECT_EQ(table.find('='), std::string::npos) << table;
}

// A look takes no finger: neither its belief nor patches of its skin are spoken of.
TEST(RankingReport, OfLooksSpeaksOfNoFinger) {
  Ranked r;
  r.options.criteria = parse_criteria("haze:low");
  r.options.weights.clear();
  r.ranking.directions = 0;
  for (RankedCandidate& c : r.ranking.states[0].candidates) c.metrics = {{0.1, 0.09, 0.11}};
  const std::string table = ranking_table(r.names, r.options, r.ranking);
  using Cells = std::vector<std::string>;
  EXPECT_EQ(cells(split(table, '\n')[1]),
            (Cells{"rank", "design", "mean(haze):low %", "ahead of the next, %", "p(ahead)",
                   "p(best)", "arrangements"}));
  EXPECT_NE(table.find("the order is known; 42 arrangements tried"), std::string::npos) << table;
  EXPECT_NE(table.find("neither the finger nor belief about it is in it"), std::string::npos)
      << table;
  for (const char* words : {"skin", "parameters", "fit of the finger"})
    EXPECT_EQ(table.find(words), std::string::npos) << words << " in " << table;
  const auto json = nlohmann::json::parse(ranking_json(r.names, r.options, r.ranking));
  EXPECT_EQ(json["felt"], false);
  EXPECT_TRUE(json["parameters"].is_null());
}

TEST(RankingReport, ForProgramsIsInSi) {
  const Ranked r;
  const auto json = nlohmann::json::parse(ranking_json(r.names, r.options, r.ranking));
  expect_same(
      json["candidates"][0],
      {{"name", "fine"},
       {"index", 1},
       {"rank", 1},
       {"tied_with_next", true},
       {"score",
        {{"value", 0.3}, {"low", 0.2}, {"high", 0.4}, {"parameters", nullptr}, {"model", nullptr}}},
       {"behind_best",
        {{"value", 0}, {"low", 0}, {"high", 0}, {"parameters", nullptr}, {"model", nullptr}}},
       {"ahead_of_next",
        {{"value", 0.12}, {"low", 0.04}, {"high", 0.2}, {"parameters", 0.05}, {"model", 0.05}}},
       {"p_ahead", 0.9},
       {"p_best", 0.8},
       {"p_best_by",
        {{"mean(friction)", 0.5}, {"variation(friction)", 0.5}, {"mean(compliance)", 0.5}}},
       {"over", {"open", "open"}},
       {"title", "Fine coat"},
       {"metrics",
        {{"mean(friction)",
          {{"value", 0.1},
           {"low", 0.09},
           {"high", 0.11},
           {"parameters", nullptr},
           {"model", nullptr}}},
         {"variation(friction)",
          {{"value", 0.25},
           {"low", 0.2},
           {"high", 0.3},
           {"parameters", nullptr},
           {"model", nullptr}}},
         {"mean(compliance)",
          {{"value", 3e-12},
           {"low", 2e-12},
           {"high", 4e-12},
           {"parameters", nullptr},
           {"model", nullptr}}}}},
       {"skins", 24}},
      "first");
  EXPECT_EQ(json["states"][0]["state"], "natural");
  EXPECT_EQ(json["states"][0]["skins"], 42);
  EXPECT_EQ(json["states"][0]["equal_skins"], 48);
  EXPECT_EQ(json["states"][0]["candidates"], json["candidates"]);
  expect_same(json["parameters"], {{"directions", 3}, {"members", 0}, {"skins", 8}, {"grid", 64}},
              "parameters");
  expect_same(json["criteria"],
              {{{"metric", "mean(friction)"}, {"better", "low"}, {"unit", "N"}},
               {{"metric", "variation(friction)"}, {"better", "low"}, {"unit", ""}},
               {{"metric", "mean(compliance)"}, {"better", "high"}, {"unit", "m/Pa"}}},
              "criteria");
  EXPECT_EQ(json["skins"], 42);
  EXPECT_EQ(json["seconds"], 6.54);
}

// The rim is the best of each criterion, halfway is half as good, whichever direction is better.
TEST(RankingReport, TheRadarHasTheBestOnItsRim) {
  const Ranked r;
  const std::string svg = radar_svg(r.names, r.options, r.ranking.states[0]);
  std::vector<std::vector<std::pair<double, double>>> polygons;
  const std::regex shape("points=\"([^\"]*)\""), pair("([-0-9.]+),([-0-9.]+)");
  for (std::sregex_iterator it(svg.begin(), svg.end(), shape), end; it != end; ++it) {
    const std::string points = (*it)[1];
    polygons.emplace_back();
    for (std::sregex_iterator p(points.begin(), points.end(), pair), none; p != none; ++p)
      polygons.back().emplace_back(std::stod((*p)[1]) - 260, std::stod((*p)[2]) - 260);
  }
  ASSERT_EQ(polygons.size(), 6u);  // four rings, two candidates
  const double share[6][3] = {{0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}, {0.75, 0.75, 0.75},
                              {1, 1, 1},          {1, 1, 1},       {0.5, 0.5, 0.5}};
  for (std::size_t k = 0; k < 6; ++k) {
    ASSERT_EQ(polygons[k].size(), 3u);
    for (std::size_t a = 0; a < 3; ++a) {
      // The first axis points up; 120 degrees between them.
      const double angle = 2 * kPi / 3 * static_cast<double>(a);
      EXPECT_NEAR(polygons[k][a].first, 180 * share[k][a] * std::sin(angle), 0.06) << k << a;
      EXPECT_NEAR(polygons[k][a].second, -180 * share[k][a] * std::cos(angle), 0.06) << k << a;
    }
  }
  EXPECT_NE(svg.find(">1. fine<"), std::string::npos);
  EXPECT_NE(svg.find(">mean(friction):low<"), std::string::npos);
}

TEST(RankingReport, TheRadarTakesNamesAsText) {
  Ranked r;
  r.names = {"hard", "fine & <smooth>"};
  const std::string svg = radar_svg(r.names, r.options, r.ranking.states[0]);
  EXPECT_NE(svg.find(">1. fine &amp; &lt;smooth>"), std::string::npos) << svg;
}

TEST(RankingReport, ALineADesignHasEachNumberUnderItsHead) {
  Ranked r;
  const std::string columns =
      "finger,rank,design,title,mean(friction) [N],mean(friction) low,mean(friction) high,"
      "mean(friction) p(best),variation(friction),variation(friction) low,variation(friction) high,"
      "variation(friction) p(best),mean(compliance) [m/Pa],mean(compliance) low,"
      "mean(compliance) high,mean(compliance) p(best)";
  RankedCandidate& first = r.ranking.states[0].candidates[0];
  first.p_best_by = {0.125, 0.25, 0.75};
  const std::string best =
      "natural,1,fine,Fine coat,0.1,0.09,0.11,0.125,0.25,0.2,0.3,0.25,3e-12,2e-12,4e-12,0.75,";
  const std::string other =
      "natural,2,hard,Hard coat,0.2,0.18,0.22,0.5,-0.5,-0.6,-0.4,0.5,1.5e-12,1e-12,2e-12,0.5,";
  EXPECT_EQ(ranking_csv(r.names, r.options, r.ranking),
            columns + ",score,score low,score high,p(best),p(ahead),skins\n" + best +
                "0.3,0.2,0.4,0.8,0.9,24\n" + other + "0.1,0,0.2,0.2,,18\n");
  r.options.weights.clear();
  r.ranking.states[0].candidates[1].over = {Relation::Open, Relation::Worse};
  EXPECT_EQ(ranking_csv(r.names, r.options, r.ranking),
            columns + ",beaten by,skins\n" + best + ",24\n" + other + "fine,18\n");
}

TEST(RankingReport, WithoutWeightsItSaysWhoIsBeatenByWhom) {
  Ranked r;
  r.options.weights.clear();
  r.options.parameters = false;
  r.ranking.directions = 0;
  StateRanking& state = r.ranking.states[0];
  state.candidates[0].over = {Relation::Better, Relation::Open};
  state.candidates[1].over = {Relation::Open, Relation::Worse};
  state.candidates[0].p_best_by = {0.9995, 0.25, 0.75};
  state.candidates[1].p_best_by = {0.0005, 0.125, 0.625};
  state.open = {{1, 0, 2}};
  state.equal_skins = 42;
  r.ranking.conditions = {{"finger.load", "hard", "0.3 N", "0.2 N", "fine"}};
  const std::string table = ranking_table(r.names, r.options, r.ranking);
  const std::vector<std::string> lines = split(table, '\n');
  using Cells = std::vector<std::string>;
  EXPECT_EQ(cells(lines[1]),
            (Cells{"rank", "design", "mean(friction):low mN", "p(best)", "variation(friction):low",
                   "p(best)", "mean(compliance):high um/MPa", "p(best)", "skins"}));
  EXPECT_EQ(cells(lines[2]), (Cells{"1", "fine", "100 ± 10", ">0.999", "0.250 ± 0.050", "0.250",
                                    "3.0 ± 1.0", "0.750", "24"}));
  EXPECT_EQ(cells(lines[3]), (Cells{"2", "hard", "200 ± 20", "<0.001", "-0.50 ± 0.10", "0.125",
                                    "1.50 ± 0.50", "0.625", "18"}));
  EXPECT_EQ(cells(lines[5]), (Cells{"row against column", "fine", "hard"}));
  EXPECT_EQ(cells(lines[6]), (Cells{"fine", "-", "better"}));
  EXPECT_EQ(cells(lines[7]), (Cells{"hard", "worse", "-"}));
  EXPECT_EQ(lines[9],
            "the budget of 96 skins per design (--max-skins) is spent with the order open: fine "
            "and hard in mean(compliance):high; 42 patches of skin tried");
  RankOptions with = r.options;
  with.parameters = true;  // and both have met fewer
  EXPECT_NE(ranking_table(r.names, with, r.ranking)
                .find("more skins would not settle what is not known of finger and model, which "
                      "leaves open: fine and hard in mean(compliance):high"),
            std::string::npos);
  // Of two pairs each is told what would settle it.
  Ranked other;
  other.options.max_skins = 18;
  StateRanking& two = other.ranking.states[0];
  RankedCandidate third = two.candidates[1];
  third.index = 2, third.skins = 6;
  two.candidates.push_back(third);
  other.names.push_back("soft");
  two.open = {{1, 0, 0}, {0, 2, 0}};
  const std::string both = ranking_table(other.names, other.options, other.ranking);
  EXPECT_NE(both.find("(--max-skins) is spent with the order open: fine and hard\n"),
            std::string::npos)
      << both;
  EXPECT_NE(both.find("which leaves open: hard and soft"), std::string::npos) << both;
  EXPECT_NE(table.find("  finger.load: 0.3 N in hard, 0.2 N in fine\n"), std::string::npos);
  EXPECT_NE(table.find("no weights (--weights)"), std::string::npos);
  EXPECT_NE(table.find("what the fit of the finger leaves open"), std::string::npos);
  EXPECT_EQ(table.find("directions of its covariance"), std::string::npos);
  const auto json = nlohmann::json::parse(ranking_json(r.names, r.options, r.ranking));
  expect_same(
      json["states"][0]["open"],
      nlohmann::json::array({{{"designs", {"fine", "hard"}}, {"by", "mean(compliance):high"}}}),
      "open");
  expect_same(json["conditions_differ"],
              nlohmann::json::array({{{"key", "finger.load"},
                                      {"designs", {"hard", "fine"}},
                                      {"values", {"0.3 N", "0.2 N"}}}}),
              "conditions");
  EXPECT_FALSE(json["candidates"][0].contains("score"));
  EXPECT_EQ(json["candidates"][1]["over"], (std::vector<std::string>{"open", "worse"}));
  EXPECT_EQ(json["scored"], false);
  EXPECT_TRUE(json["parameters"].is_null());
}

TEST(RankingReport, SaysWhichDesignsNothingTellsApart) {
  Ranked r;
  StateRanking& state = r.ranking.states[0];
  state.equal = {{1, 0, 0}};
  const std::string both =
      "the same on all skins, so that more would not tell them apart: fine and hard";
  EXPECT_NE(ranking_table(r.names, r.options, r.ranking).find("the order is known; " + both),
            std::string::npos);
  r.options.weights.clear();
  state.equal = {{1, 0, 2}};
  state.open = {{0, 1, 1}};
  state.candidates[0].over = {Relation::Equal, Relation::Open};
  const std::string table = ranking_table(r.names, r.options, r.ranking);
  EXPECT_NE(table.find("\n" + both + " in mean(compliance):high; 42"), std::string::npos) << table;
  const auto json = nlohmann::json::parse(ranking_json(r.names, r.options, r.ranking));
  EXPECT_EQ(json["candidates"][0]["over"], (std::vector<std::string>{"equal", "open"}));
  expect_same(
      json["states"][0]["equal"],
      nlohmann::json::array({{{"designs", {"fine", "hard"}}, {"by", "mean(compliance):high"}}}),
      "equal");
}

// Of a surface that is not random there is one look.
TEST(RankingReport, OfLooksSaysHowManyThereAre) {
  Ranked r;
  r.options.criteria = parse_criteria("haze:low");
  r.options.weights.clear();
  r.ranking.directions = 0;
  std::vector<RankedCandidate>& all = r.ranking.states[0].candidates;
  for (RankedCandidate& c : all) c.metrics = {{0.1, 0.1, 0.1}}, c.skins = 1;
  EXPECT_NE(ranking_table(r.names, r.options, r.ranking)
                .find("no surface is random: there is one look of each, and no ±"),
            std::string::npos);
  all[1].skins = 18;
  EXPECT_NE(
      ranking_table(r.names, r.options, r.ranking)
          .find("95 % intervals over arrangements of what is random (18 of each at least); of "
                "any other surface there is one, and no ±"),
      std::string::npos);
}

TEST(RankingReport, DesignsAreFilesByTheirNumbers) {
  EXPECT_EQ(ranked_design_file(0, 0), "designs/01.toml");
  EXPECT_EQ(ranked_design_file(11, 1), "designs/12_2.toml");
}

}  // namespace
}  // namespace papilla::tests::ranking_test
