// Small decisions of a search, each at its border: risks, scatter, grids of the fab, limits,
// findings, picked files, records.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "search/codec.h"
#include "search/decision.h"
#include "search/differing.h"
#include "search/findings.h"
#include "search/pick.h"
#include "search/problem.h"
#include "search/protocol.h"
#include "search/risk.h"
#include "search/rounding.h"
#include "search/sensitivity.h"
#include "tests/support/refusal.h"
#include "tests/support/without_belief.h"
#include "tests/temporary.h"

namespace papilla::tests::small_decisions_test {
namespace {

// So many numbers, uniform and independent.
ScatterLaw uniform(std::size_t numbers) {
  return {std::vector<Scatter>(numbers, Scatter{"texture.depth", 1}), {}};
}

Study holes() {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
  study.population.clear();
  return study;
}

TEST(SmallDecisions, ARiskIsReadWithItsNumber) {
  const auto read = [](const std::string& text) {
    const Risk r = parse_risk(text);
    return std::pair(r.kind, r.parameter);
  };
  using Kind = Risk::Kind;
  EXPECT_EQ(read(""), std::pair(Kind::Mean, 0.0));
  EXPECT_EQ(read(" me an "), std::pair(Kind::Mean, 0.0));
  EXPECT_EQ(read("worst"), std::pair(Kind::Worst, 0.0));
  EXPECT_EQ(read("mean - std"), std::pair(Kind::MeanStd, 1.0));
  EXPECT_EQ(read("mean-2.5std"), std::pair(Kind::MeanStd, 2.5));
  EXPECT_EQ(read("mean - 0 std"), std::pair(Kind::MeanStd, 0.0));
  EXPECT_EQ(read("cvar 100 %"), std::pair(Kind::Cvar, 1.0));
  EXPECT_DOUBLE_EQ(read("cvar 0.5 %").second, 0.005);
  for (const char* wrong : {"mean + std", "mean - -1 std", "cvar 101 %", "cvar -1 %", "cvar 20",
                            "cvar %", "mean - inf std", "best", "mean - 2", "20 %"})
    EXPECT_THROW(parse_risk(wrong), InputError) << wrong;
}

// Weights 1, 2, 3, 0 of 4, 1, 2, 9.
TEST(SmallDecisions, ARiskWeighsItsValues) {
  const std::vector<double> values{4, 1, 2, 9}, weights{1, 2, 3, 0};
  const auto of = [&](const char* risk, bool higher) {
    return apply_risk(parse_risk(risk), higher, values, weights);
  };
  const double mean = (4 + 2 + 6) / 6.0, variance = (4 * 1 + 1 * 2 + 0 * 3) / 6.0;
  for (const bool higher : {true, false}) {
    EXPECT_NEAR(of("mean", higher), mean, 1e-12);
    EXPECT_NEAR(of("mean - 3 std", higher), mean + (higher ? -3 : 3) * std::sqrt(variance), 1e-12);
    EXPECT_NEAR(of("cvar 100 %", higher), mean, 1e-12);
  }
  EXPECT_EQ(of("worst", true), 1);
  EXPECT_EQ(of("worst", false), 4);  // nine has no weight
  // The worst half: 1 by 2 sixths and 2 by one; above, 4 by one sixth and 2 by two.
  EXPECT_NEAR(of("cvar 50 %", true), (2 * 1 + 1 * 2) / 3.0, 1e-12);
  EXPECT_NEAR(of("cvar 50 %", false), (1 * 4 + 2 * 2) / 3.0, 1e-12);
}

// f = c + a u + b u^2 over u in [-1, 1]: its least lies at an end, or at -a / 2b inside.
TEST(SmallDecisions, TheWorstOfAScatterLiesInsideOrAtAnEnd) {
  const auto worst = [](double a, double b, bool higher) {
    const std::vector<double> all =
        scattered_values(parse_risk("worst"), higher, 5, {5 - a + b}, {5 + a + b}, uniform(1));
    EXPECT_EQ(all.size(), 1u);
    return all[0];
  };
  EXPECT_NEAR(worst(0.4, 1, true), 5 - 0.04, 1e-12);  // at -0.2
  EXPECT_NEAR(worst(0.4, 1, false), 5 + 1.4, 1e-12);
  EXPECT_NEAR(worst(-0.4, -1, false), 5 + 0.04, 1e-12);  // at -0.2
  EXPECT_NEAR(worst(0.4, -1, false), 5 + 0.04, 1e-12);   // at 0.2
  // The parabola's end lies beyond: at 1.5 and -1.5, at 5 and -5.
  for (const double sign : {1.0, -1.0}) {
    EXPECT_NEAR(worst(sign * 0.3, 0.1, true), 5 - 0.2, 1e-12);
    EXPECT_NEAR(worst(sign * 0.3, -0.1, false), 5 + 0.2, 1e-12);
    EXPECT_NEAR(worst(sign * 0.3, 0.03, true), 5 - 0.27, 1e-12);
    EXPECT_NEAR(worst(sign * 0.3, 0, true), 5 - 0.3, 1e-12);
  }
  EXPECT_NEAR(worst(0, 0.5, true), 5, 1e-12);
  EXPECT_NEAR(worst(0, -0.5, true), 4.5, 1e-12);
  // Mean and variance of two numbers: b / 3 and a^2 / 3 + 4 b^2 / 45 each.
  const std::vector<double> moments =
      scattered_values(parse_risk("mean - std"), true, 5, {5 - 0.3 + 0.6, 5 + 0.2 - 0.3},
                       {5 + 0.3 + 0.6, 5 - 0.2 - 0.3}, uniform(2));
  ASSERT_EQ(moments.size(), 2u);
  EXPECT_NEAR((moments[0] + moments[1]) / 2, 5.1, 1e-12);
  EXPECT_NEAR((moments[1] - moments[0]) / 2, std::sqrt((0.09 + 0.04) / 3 + 4 * (0.36 + 0.09) / 45),
              1e-12);
  EXPECT_EQ(scattered_values(parse_risk("mean"), true, 5, {5.3}, {5.9}, uniform(1)).size(), 1u);
  EXPECT_NEAR(scattered_values(parse_risk("mean"), true, 5, {5.3}, {5.9}, uniform(1))[0], 5.2,
              1e-12);
}

// A step is at most a fiftieth of a length; of other numbers it keeps three digits.
TEST(SmallDecisions, AGridIsAtMostAFiftiethOfTheLength) {
  const Variable length{"texture.depth", "nm", 0, 1e-4, {}};
  const auto nm = [&](double value, double grid = 10) {
    return 1e9 * on_grid(length, 1e-9 * value, 1e-9 * grid);
  };
  EXPECT_NEAR(nm(503), 500, 1e-9);
  EXPECT_NEAR(nm(507), 510, 1e-9);
  EXPECT_NEAR(nm(499.4), 499, 1e-9);  // 10 is more than a fiftieth of it
  EXPECT_NEAR(nm(49.46), 49.5, 1e-9);
  EXPECT_NEAR(nm(4.946), 4.95, 1e-9);
  EXPECT_NEAR(nm(4.946, 0.1), 4.95, 1e-9);
  EXPECT_NEAR(nm(6.06, 0.1), 6.1, 1e-9);
  const Variable plain{"surface.refractive_index", "", 1, 3, {}};
  EXPECT_DOUBLE_EQ(on_grid(plain, 1.45678, 1e-8), 1.46);
  EXPECT_DOUBLE_EQ(on_grid(plain, 1.0049, 1e-8), 1);
  const Variable force{"finger.load", "N", 0, 10, {}};
  EXPECT_DOUBLE_EQ(on_grid(force, 0.034567, 1e-8), 0.0346);
  EXPECT_DOUBLE_EQ(on_grid(force, 0.99951, 1e-8), 1);
  EXPECT_DOUBLE_EQ(on_grid(force, 7.00499, 1e-8), 7);
  const double degree = kPi / 180;
  const Variable angle{"surface.contact_angle", "deg", 0, kPi, {}};
  EXPECT_NEAR(on_grid(angle, 5.4 * degree, 1e-8), 5 * degree, 1e-12);
  EXPECT_NEAR(on_grid(angle, 150.6 * degree, 1e-8), 151 * degree, 1e-12);
  // Choices, kinds and levels are what they are.
  const Variable choice{"texture.depth", "nm", 1e-7, 2e-7, {1.004e-7, 2e-7}};
  EXPECT_EQ(on_grid(choice, 1.004e-7, 1e-8), 1.004e-7);
  EXPECT_EQ(on_grid({"texture.type", "", 0, 5, {}}, 1.2345, 1e-8), 1.2345);
  EXPECT_EQ(on_grid({"texture.levels", "", 0, 5, {}}, 1.2345, 1e-8), 1.2345);
}

// A mask has no places between those of its grid, however short what it draws is: what no mask
// draws goes in finer steps.
TEST(SmallDecisions, WhatAMaskDrawsStaysOnTheGrid) {
  const auto um = [](const char* path, double value, double low, double high, double grid) {
    const Variable v{path, "um", 1e-6 * low, 1e-6 * high, {}};
    return 1e6 * on_grid(v, 1e-6 * value, 1e-6 * grid);
  };
  EXPECT_NEAR(um("texture.period", 5.04, 4, 6, 0.5), 5, 1e-9);
  EXPECT_NEAR(um("texture.diameter", 3.15, 1.2, 5, 0.5), 3, 1e-9);
  EXPECT_NEAR(um("texture.width", 0.123, 0.05, 1, 0.01), 0.12, 1e-9);
  EXPECT_NEAR(um("texture.parts.1.period", 0.348, 0.1, 1, 0.01), 0.35, 1e-9);
  EXPECT_NEAR(um("texture.diameter", 1.3, 1.2, 5, 3), 3, 1e-9);  // nothing nearer is in range
  EXPECT_NEAR(um("texture.depth", 0.1676, 0.03, 0.2, 0.5), 0.1675, 1e-9);
  EXPECT_NEAR(um("surface.dielectric.0.thickness", 1.008, 0.1, 2, 0.5), 1.01, 1e-9);
  const Variable narrow{"texture.period", "um", 4.6e-6, 5.4e-6, {}};
  EXPECT_FALSE(lies_on_grid(narrow, 5e-6, 3e-6));
  EXPECT_TRUE(lies_on_grid(narrow, 5e-6, 0.5e-6));
}

TEST(SmallDecisions, AGridStaysWithinItsIntervalAndOutOfItsHoles) {
  const auto nm = [](double value, double low, double high, std::vector<Excluded> holes = {}) {
    const Variable v{"texture.depth", "nm", low / 1e9, high / 1e9, {}, std::move(holes)};
    return 1e9 * on_grid(v, value / 1e9, 10e-9);
  };
  EXPECT_NEAR(nm(997, 500, 998), 990, 1e-9);      // 1000 is out
  EXPECT_NEAR(nm(1003, 1002, 2000), 1010, 1e-9);  // so is it here
  EXPECT_NEAR(nm(1003, 1002, 1008), 1003, 1e-9);  // and there is nothing else
  EXPECT_NEAR(nm(1000, 1000, 2000), 1000, 1e-9);
  EXPECT_NEAR(nm(2000, 1000, 2000), 2000, 1e-9);
  // Rounded into a hole: out at the end where the value lies; beside it as anywhere.
  const std::vector<Excluded> hole{{605.1 / 1e9, 694 / 1e9}};
  EXPECT_NEAR(nm(605.1, 500, 900, hole), 600, 1e-9);
  EXPECT_NEAR(nm(694, 500, 900, hole), 700, 1e-9);
  EXPECT_NEAR(nm(604, 500, 900, hole), 600, 1e-9);
  EXPECT_NEAR(nm(698, 500, 900, hole), 700, 1e-9);
  // The end of a hole may be a value of the grid itself.
  EXPECT_NEAR(nm(703, 500, 705, {{600 / 1e9, 702 / 1e9}}), 600, 1e-9);
}

// Round a design its grid is walked from the nearest place outwards: floor and ceil of all numbers
// together before a second step of any.
TEST(SmallDecisions, AGridIsWalkedFromTheNearestPlaceOutwards) {
  Study study = holes();
  study.search.rounding = 10e-9;
  const StudyProblem problem(study);
  const double degree = kPi / 180;
  GridDesigns designs(problem, problem.space().unit({6.004e-6, 3.002e-6, 350.3e-9, 63.2 * degree}),
                      false);
  const auto first = designs.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->value[0], 6e-6);
  EXPECT_EQ(first->value[1], 3e-6);
  EXPECT_EQ(first->value[2], 350e-9);  // on 1 nm
  EXPECT_NEAR(first->value[3], 63 * degree, 1e-12);
  const auto second = designs.next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->value[0], 6.01e-6);  // 0.6 steps instead of 0.4
  std::set<std::vector<double>> seen{first->value, second->value};
  for (int k = 2; k < 400; ++k) {
    const auto next = designs.next();
    ASSERT_TRUE(next);
    EXPECT_TRUE(seen.insert(next->value).second);
  }
  // Round 499.6 nm, on 1 nm, nothing is on 1 nm from 500 nm on.
  GridDesigns border(problem, problem.space().unit({6.004e-6, 3.002e-6, 499.6e-9, 63.2 * degree}),
                     false);
  std::set<double> depths;
  for (int k = 0; k < 400; ++k) depths.insert(std::round(1e9 * border.next().value().value[2]));
  EXPECT_EQ(depths, (std::set<double>{497, 498, 499, 500}));
  // Of a flat surface the finish alone moves.
  Point flat = problem.space().unit({6.004e-6, 3.002e-6, 350.3e-9, 63.2 * degree});
  GridDesigns finishes(problem, flat, true);
  const auto smooth = finishes.next();
  ASSERT_TRUE(smooth);
  EXPECT_NEAR(smooth->value[0], 6.004e-6, 1e-15);
  EXPECT_NEAR(smooth->value[3], 63 * degree, 1e-12);
}

Evaluation tried(const StudyProblem& problem, double period_um, double depth_nm, bool ok = true) {
  Evaluation e;
  e.unit = problem.space().unit({period_um * 1e-6, 3e-6, depth_nm * 1e-9, 1});
  e.outcome.ok = ok;
  return e;
}

// Two designs are enough, one is not; a variable that could not move is none.
TEST(SmallDecisions, AVariableOfOneValueIsNamedFromTwoDesignsOn) {
  Study study = holes();
  const auto named = [&](const std::vector<std::pair<double, bool>>& depths) {
    const StudyProblem problem(study);
    std::vector<Evaluation> history;
    for (const auto& [depth, ok] : depths) history.push_back(tried(problem, 4, depth, ok));
    std::vector<std::size_t> out;
    for (const OneValue& one : one_value_variables(problem, history)) out.push_back(one.variable);
    return out;
  };
  using Places = std::vector<std::size_t>;
  EXPECT_EQ(named({{100, true}}), Places{});
  EXPECT_EQ(named({{100, true}, {200, false}}), Places{});
  EXPECT_EQ(named({{100, true}, {200, true}}), (Places{0, 1, 3}));
  EXPECT_EQ(named({{100, true}, {100, true}, {200, true}}), (Places{0, 1, 3}));
  study.variables[3].low = study.variables[3].high = 1;
  study.variables[0].choices = {4e-6};
  study.variables[1].choices = {3e-6, 3.5e-6};
  EXPECT_EQ(named({{100, true}, {200, true}}), Places{1});
}

// Within a millionth of the interval a design lies on its bound.
TEST(SmallDecisions, ABoundIsReachedWithinAMillionth) {
  const Study study = holes();
  const StudyProblem problem(study);
  const Point inside = problem.space().unit({6e-6, 3e-6, 300e-9, 1.1});
  const auto found = [&](std::size_t k, double unit) {
    Point p = inside;
    p[k] = unit;
    return variables_at_bound(problem, p, {});
  };
  EXPECT_TRUE(found(0, 0.5).empty());
  EXPECT_TRUE(found(0, 2e-6).empty());
  EXPECT_TRUE(found(0, 1 - 2e-6).empty());
  ASSERT_EQ(found(0, 0.5e-6).size(), 1u);
  EXPECT_FALSE(found(0, 0.5e-6)[0].upper);
  EXPECT_EQ(found(0, 0)[0].bound, study.variables[0].low);
  ASSERT_EQ(found(0, 1 - 0.5e-6).size(), 1u);
  EXPECT_TRUE(found(0, 1)[0].upper);
  EXPECT_EQ(found(0, 1)[0].bound, study.variables[0].high);
  EXPECT_EQ(found(0, 1)[0].step, 0);  // nothing is told of what was not moved
  EXPECT_TRUE(found(0, 1)[0].change.empty());
  // A depth of 0 is no texture: its measures lie nowhere, the finish does.
  Point flat = inside;
  flat[0] = 1, flat[2] = 0, flat[3] = 1;
  const auto finish = variables_at_bound(problem, flat, {});
  ASSERT_EQ(finish.size(), 1u);
  EXPECT_EQ(finish[0].variable, 3u);
}

// The angle ends at 180 deg, 5 beyond its bound of 175: a step of 10 is told for half of it.
TEST(SmallDecisions, AStepBeyondABoundEndsWithTheModel) {
  Study study = holes();
  const double degree = kPi / 180;
  const auto highest = [&] {
    Design copy = study.design;
    for (const NumberField& field : number_fields(copy)) {
      if (field.path == "surface.contact_angle") return field.high;
    }
    return 0.0;
  }();
  ASSERT_GT(highest, 100);
  study.variables[3].high = (highest - 5) * degree;
  VariableSensitivity s;
  s.variable = 3, s.step = 10 * degree, s.change = {0.4, -0.2};
  const auto at = [&] {
    const StudyProblem problem(study);
    Point p = problem.space().unit({6e-6, 3e-6, 300e-9, 1.1});
    p[3] = 1;
    return variables_at_bound(problem, p, {s}).at(0);
  };
  EXPECT_FALSE(at().last);
  EXPECT_NEAR(at().step, 5 * degree, 1e-9);
  EXPECT_NEAR(at().change[0], 0.2, 1e-9);
  EXPECT_NEAR(at().change[1], -0.1, 1e-9);
  study.variables[3].high = highest * degree;
  EXPECT_TRUE(at().last);
  EXPECT_EQ(at().step, 0);
  EXPECT_EQ(at().change, (std::vector<double>{0, 0}));
  study.variables[3].high = (highest - 30) * degree;
  EXPECT_NEAR(at().step, 10 * degree, 1e-12);
  EXPECT_NEAR(at().change[0], 0.4, 1e-12);
}

// A lower side alone: a step is a length, and what it loses goes down.
TEST(SmallDecisions, ASlopeOfOneSideHasAStepAboveZero) {
  const Study study = holes();
  const StudyProblem problem(study);
  const Point centre = problem.space().unit({6e-6, 3e-6, 400e-9, 1.1});
  Point lower = centre;
  lower[2] -= 0.05;
  Score here, there;
  here.ok = there.ok = true;
  here.values = {0.5, 0.2}, there.values = {0.45, 0.21};
  here.oxide_margin = there.oxide_margin = 10;
  const auto found = sensitivity(problem, {centre}, {{2, -1, lower}}, here, {there});
  ASSERT_EQ(found.size(), 1u);
  const double range = study.variables[2].high - study.variables[2].low;
  EXPECT_NEAR(found[0].step, 0.05 * range, 1e-9 * range);
  EXPECT_NEAR(found[0].change[0], 0.05, 1e-12);  // per step up
  EXPECT_NEAR(found[0].change[1], -0.01, 1e-12);
  EXPECT_NEAR(found[0].down.most, 0.5 * found[0].step, 1e-9 * range);  // a twentieth of 0.5: half
  EXPECT_EQ(found[0].down.end, Drift::End::Loss);
  EXPECT_FALSE(found[0].up.judged());
}

TEST(SmallDecisions, MovesStayInTheSpaceAndKeepTheLimitsOfTheShape) {
  const Study study = holes();
  const StudyProblem problem(study);
  const auto moves = [&](const Point& centre) {
    std::string out;
    for (const SensitivityMove& m : sensitivity_moves(problem, {centre})) {
      out += std::to_string(m.variable) + (m.sign < 0 ? "- " : "+ ");
      const double bound = m.sign < 0 ? 0 : 1;
      const double room = std::abs(bound - centre[m.variable]);
      EXPECT_NEAR(m.part, std::min(1.0, room / 0.05), 1e-12);
      EXPECT_NEAR(m.unit[m.variable], centre[m.variable] + 0.05 * m.part * m.sign, 1e-12);
      EXPECT_TRUE(m.unit[m.variable] >= 0 && m.unit[m.variable] <= 1);
    }
    return out;
  };
  Point centre = problem.space().unit({8e-6, 3e-6, 400e-9, 1.1});
  EXPECT_EQ(moves(centre), "0- 0+ 1- 1+ 2- 2+ 3- 3+ ");
  centre[0] = 0.96, centre[3] = 0.04;
  EXPECT_EQ(moves(centre), "0- 0+ 1- 1+ 2- 2+ 3- 3+ ");
  centre[0] = 0.999, centre[3] = 0;  // no room to speak of
  EXPECT_EQ(moves(centre), "0- 1- 1+ 2- 2+ 3+ ");
}

// Without relief the measures of the texture do nothing, whatever values the point has of them.
TEST(SmallDecisions, StepsOfNumbersWithoutEffectHaveNoRow) {
  const Study study = holes();
  const StudyProblem problem(study);
  const Point flat = problem.space().unit({7.3e-6, 3.1e-6, 0, 1.1});
  const std::vector<SensitivityMove> moves = sensitivity_moves(problem, {flat});
  std::set<std::size_t> moved, rows;
  for (const SensitivityMove& m : moves) moved.insert(m.variable);
  EXPECT_EQ(moved, (std::set<std::size_t>{2, 3}));
  Score same;
  same.ok = true;
  same.values = {0.5, 0.2};
  same.oxide_margin = 10;
  for (const VariableSensitivity& s :
       sensitivity(problem, {flat}, moves, same, std::vector<Score>(moves.size(), same)))
    rows.insert(s.variable);
  EXPECT_EQ(rows, moved);
}

// voltage_for alone is of no amplitude of the study's own, where its worst modulation would be.
TEST(Pick, OfAStudyThatFindsItsVoltagesIsTheKnee) {
  Study study = holes();
  study.objective = {};
  study.objective.minimise = {parse_metric("worst(voltage_for(modulation = 0.3))"),
                              parse_metric("mean(friction)")};
  Score score;
  score.ok = true;
  score.values = {150, 0.05}, score.errors = {2, 0.001};
  score.worst = 0.4;
  const StudyProblem found(study);
  EXPECT_TRUE(found.driven());
  EXPECT_EQ(decision_rule(found, "").kind, PickRule::Kind::Knee);
  EXPECT_FALSE(pick_candidate(found, score).worst);
  EXPECT_THROW(decision_rule(found, "worst"), InputError);
  study.objective.minimise = {parse_metric("mean(friction_on)"), parse_metric("mean(friction)")};
  const StudyProblem at_amplitude(study);
  EXPECT_EQ(decision_rule(at_amplitude, "").kind, PickRule::Kind::Worst);
  EXPECT_EQ(unit_of_worth(at_amplitude, decision_rule(at_amplitude, "")).unit, "");
  EXPECT_EQ(unit_of_worth(at_amplitude, decision_rule(at_amplitude, "mean(friction)")).unit, "mN");
  EXPECT_EQ(pick_candidate(at_amplitude, score).worst, 0.4);
}

std::string front_folder() {
  const std::filesystem::path root = temporary("picked");
  std::filesystem::remove_all(root);
  const auto design = [&](const char* name, const std::string& numbers, const char* worst) {
    std::filesystem::create_directories(root / name);
    write_bytes(root / name / "metrics.json",
                "{\"objectives\": {" + numbers + "}, \"worst_modulation\": " + worst + "}");
    write_bytes(root / name / "design.toml", "");
  };
  const auto numbers = [](const char* up, const char* down) {
    return std::string("\"up\": {\"value\": ") + up +
           ", \"maximise\": true}, \"down\": {\"value\": " + down + ", \"maximise\": false}";
  };
  design("front/01", numbers("0.5", "0.6"), "0.2");
  design("front/02", numbers("0.46", "0.25"), "0.3");
  design("front/03", numbers("0.4", "0.1"), "0.39");
  return root.string();
}

TEST(Pick, AFolderIsReadAsItsFront) {
  const std::string root = front_folder();
  const auto picked = [&](const char* rule) {
    return picked_design_file(root, rule).substr(root.size());
  };
  EXPECT_EQ(picked("worst"), "/front/03/design.toml");
  EXPECT_EQ(picked("knee"), "/front/02/design.toml");
  EXPECT_EQ(picked("up"), "/front/01/design.toml");
  EXPECT_EQ(picked("down"), "/front/03/design.toml");
  EXPECT_EQ(picked("1"), "/front/01/design.toml");
  // By what belief leaves open "down" tells designs apart by far less than it seems.
  write_bytes(root + "/run.json", "{\"decision\": {\"ranges\": {\"up\": 0.1, \"down\": 9}}}");
  EXPECT_EQ(picked("knee"), "/front/01/design.toml");
  // What the run decided over belief is its choice by that rule; by another the fit has the word.
  write_bytes(root + "/run.json", R"({"pick": "", "decision": {"best": "front/02"}})");
  EXPECT_EQ(picked("worst"), "/front/02/design.toml");
  EXPECT_EQ(picked("down"), "/front/03/design.toml");
  EXPECT_EQ(picked("1"), "/front/01/design.toml");
  write_bytes(root + "/run.json", R"({"pick": "down", "decision": {"best": "front/01"}})");
  EXPECT_EQ(picked("down"), "/front/01/design.toml");
  EXPECT_EQ(picked("worst"), "/front/03/design.toml");
  write_bytes(root + "/run.json", "{\"decision\": {\"absent\": \"no belief\"}}");
  EXPECT_EQ(picked("knee"), "/front/02/design.toml");
  write_bytes(root + "/run.json", "{\"decision\": 1");
  EXPECT_TRUE(refusal_of([&] { picked("knee"); }).starts_with(root + ": run.json is damaged: "));
  std::filesystem::remove(root + "/run.json");
  EXPECT_EQ(refusal_of([&] { picked("4"); }), "--pick 4: the front has the designs 1 to 3");
  EXPECT_EQ(refusal_of([&] { picked("left"); }),
            "--pick: \"left\" is no rule; use \"worst\", \"knee\", \"up\", \"down\" or the number "
            "of a design");
  EXPECT_EQ(refusal_of([&] { picked(""); }),
            root + " has no best/design.toml: not the folder of a finished `papilla optimize`");
  std::filesystem::create_directories(root + "/best");
  write_bytes(root + "/best/design.toml", "");
  EXPECT_EQ(picked(""), "/best/design.toml");
  write_bytes(root + "/front/02/metrics.json", "{\"objectives\": {}}");
  EXPECT_TRUE(refusal_of([&] { picked("1"); }).starts_with(root + ": metrics.json is damaged: "));
  std::filesystem::remove_all(root + "/front/01");
  EXPECT_EQ(refusal_of([&] { picked("1"); }),
            root + " has no front/: not the folder of a finished `papilla optimize`");
}

// Equal designs: the first. Objectives that are all alike say nothing.
TEST(Pick, TheFirstOfEqualsIsTaken) {
  const std::vector<std::string> names{"a", "b"};
  const std::vector<PickCandidate> front{
      {names, {1, 5}, 0.3}, {names, {0, 5}, 0.3}, {names, {0, 5}, 0.1}};
  EXPECT_EQ(pick_design("worst", front), 0u);
  EXPECT_EQ(pick_design("knee", front), 1u);
  EXPECT_EQ(pick_design("a", front), 1u);
  EXPECT_EQ(pick_design("b", front), 0u);
  // Without a drive the knee is the usual rule.
  std::vector<PickCandidate> off = front;
  for (PickCandidate& c : off) c.worst.reset();
  EXPECT_EQ(pick_design("", off), 1u);
  EXPECT_EQ(refusal_of([&] { pick_design("worst", off); }),
            "--pick worst: without a drive, or with amplitudes that voltage_for finds, there is no "
            "modulation to go by; use \"knee\"");
}

// What ends with an empty text, or has empty ones in its middle, comes back.
TEST(Protocol, EmptyTextsComeBack) {
  TaskAnswer a;
  a.objectives = {{1, 2, {}}};
  const auto back = decode_answer(encode(a));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->report, "");
  EXPECT_EQ(back->objectives, a.objectives);
  EXPECT_FALSE(back->look);
  EXPECT_EQ(encoded(std::string()), "0:");
  EXPECT_EQ(decoded<std::string>("0:"), std::string());
  EXPECT_EQ(decoded<std::string>("3:a b"), std::string("a b"));
  for (const char* wrong : {"", "0", "1:", "2:a", "0: ", "1:ab", "-1:", "a:", "0;"})
    EXPECT_FALSE(decoded<std::string>(wrong)) << wrong;
  EXPECT_EQ(encoded(std::vector<int>{3, -4}), "2 3 -4");
  EXPECT_EQ(decoded<std::vector<int>>("2 3 -4"), (std::vector<int>{3, -4}));
  EXPECT_EQ(decoded<std::vector<int>>("0"), std::vector<int>{});
  for (const char* wrong : {"2 3", "1 3 -4", "-1", "1  3", "01 3", "1 3 ", "1 +3", "1 3x"})
    EXPECT_FALSE(decoded<std::vector<int>>(wrong)) << wrong;
  EXPECT_EQ(encoded(0.5), "0x1p-1");
  EXPECT_EQ(decoded<double>("0x1p-1"), 0.5);
  for (const char* wrong : {"0.5", "0x1p-1x", "", "x"})
    EXPECT_FALSE(decoded<double>(wrong)) << wrong;
}

// Keys of tables and of the tables of an array, each with what the other file has.
TEST(DifferingKeys, AreNamedByTheirTables) {
  const std::string there =
      "a = 1  # here\n[b]\nc = \"x\"\n[[d]]\ne = 1\n[[d]]\ne = 2\n[search]\njobs = 1\ntime = 2\n"
      "evaluations = 3\n[f]\ng = 1\n";
  const std::string here =
      "a = 1  # there\n[b]\nc = \"y\"\n[[d]]\ne = 1\n[[d]]\ne = 3\n[search]\njobs = 4\ntime = 5\n"
      "evaluations = 6\n";
  EXPECT_EQ(differing_keys(there, here), "b.c \"x\", \"y\"; d[1].e 2, 3; f.g 1, none");
  EXPECT_EQ(differing_keys(here, there), "b.c \"y\", \"x\"; d[1].e 3, 2; f.g none, 1");
  // With other numbers of these a run goes on: they are no reason why it does not.
  EXPECT_EQ(differing_keys("[search]\nrounding = 1\ntime = 1\n[risk]\nbelief = 1\nlimits = 1\n",
                           "[search]\nrounding = 2\ntime = 2\n[risk]\nbelief = 2\nlimits = 2\n"),
            "");
  EXPECT_EQ(differing_keys(here, here), "");
  EXPECT_EQ(differing_keys("a = 1\nb = 1\nc = 1\nd = 1\n", "a = 2\nb = 2\nc = 2\nd = 2\n"),
            "a 1, 2; b 1, 2; c 1, 2");
}

}  // namespace
}  // namespace papilla::tests::small_decisions_test
