// Designs over the members of a belief: by hand, and against truths drawn from it.
#include "search/prospects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "numerics/statistics.h"

namespace papilla::tests::prospects_test {
namespace {

using Matrix = std::vector<std::vector<double>>;

// Without limits.
MemberWorth worth_of(std::vector<double> weights, Matrix worth) {
  MemberWorth out{std::move(weights), std::move(worth), {}};
  out.kept.resize(out.worth.size());
  return out;
}

TEST(Prospects, AreWeightsOfTheMembersAndWhatIsLostAgainstTheirBest) {
  const MemberWorth d = worth_of({0.5, 0.3, 0.2}, {{5, 1, 1}, {4, 4, 1}, {0, 3, 3}});
  const std::vector<Prospect> p = prospects(d, {});
  EXPECT_NEAR(p[0].p_best, 0.5, 1e-12);
  EXPECT_NEAR(p[1].p_best, 0.3, 1e-12);
  EXPECT_NEAR(p[2].p_best, 0.2, 1e-12);
  EXPECT_NEAR(p[0].regret, 0.3 * 3 + 0.2 * 2, 1e-12);
  EXPECT_NEAR(p[1].regret, 0.5 * 1 + 0.2 * 2, 1e-12);
  EXPECT_NEAR(p[2].regret, 0.5 * 5 + 0.3 * 1, 1e-12);
  // The likeliest best is not the one of least regret.
  EXPECT_EQ(chosen(p, 0.9), 1u);
  EXPECT_NEAR(best_worth(d), 0.5 * 5 + 0.3 * 4 + 0.2 * 3, 1e-12);
}

TEST(Prospects, CountRatiosOfWeightsAndShareTies) {
  const std::vector<Prospect> p = prospects(worth_of({3, 1}, {{1, 1}, {1, 0}}), {});
  EXPECT_NEAR(p[0].p_best, 0.375 + 0.25, 1e-12);
  EXPECT_NEAR(p[1].p_best, 0.375, 1e-12);
  EXPECT_NEAR(p[1].regret, 0.25, 1e-12);
}

// Nine shares of 1/9 sum to a last digit above 1.
TEST(Prospects, AreAtMostCertain) {
  const std::vector<double> ones(9, 1), noughts(9, 0);
  EXPECT_LE(prospects(worth_of(ones, {ones, noughts}), {})[0].p_best, 1);
}

// What is common to all designs at a member changes nothing.
TEST(Prospects, CancelWhatMovesAllDesignsAlike) {
  const MemberWorth d = worth_of({0.6, 0.4}, {{1, 2}, {3, 0}});
  MemberWorth moved = d;
  for (auto& design : moved.worth) design[0] += 100, design[1] -= 40;
  const std::vector<Prospect> p = prospects(d, {}), q = prospects(moved, {});
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(p[i].p_best, q[i].p_best, 1e-12);
    EXPECT_NEAR(p[i].regret, q[i].regret, 1e-12);
  }
}

// Two designs whose difference four skins know to a standard error: Student's distribution.
TEST(Prospects, AreOfWhatSkinsLeaveOpenToo) {
  constexpr std::size_t kMembers = 200;  // with 128 draws each
  MemberWorth d =
      worth_of(std::vector<double>(kMembers, 1),
               Matrix{std::vector<double>(kMembers, 1.1), std::vector<double>(kMembers, 1)});
  const auto both = [&](const std::vector<double>& first, const std::vector<double>& second) {
    d.by_skin = {std::vector(kMembers, first), std::vector(kMembers, second)};
    return prospects(d, {});
  };
  // What skins move both by is no doubt.
  EXPECT_NEAR(both({0.3, -0.1, 0.2, 0}, {0.3, -0.1, 0.2, 0})[0].p_best, 1, 1e-9);
  const std::vector<Prospect> p = both({0.1, 0.1, 0, 0}, {0, 0, 0, -0.1});
  const double error = std::sqrt(3) * 0.1;
  EXPECT_NEAR(p[0].p_best, student_t_cdf(0.1 / error, 3), 0.015);
  // Of either what is lost by the other, on average: they differ by the lead.
  EXPECT_NEAR(p[1].regret - p[0].regret, 0.1, 0.01);
  EXPECT_GT(p[0].regret, 0.02);
  EXPECT_EQ(chosen(p, 0.9), 0u);
  EXPECT_NEAR(best_worth(d), 1.1 + p[0].regret, 0.01);
  // A second call says the same to the last bit.
  EXPECT_EQ(prospects(d, {})[0].p_best, p[0].p_best);
}

// Two designs that many skins part by one standard error, at both members alike: E max(d, 0) is
// lost by the better one today, nothing once it is known; at two members that differ, what these
// part stays.
TEST(Prospects, SayWhatSkinsWithoutEndWouldLeave) {
  constexpr std::size_t kSkins = 400, kMembers = 40;  // one after the other the first, the second
  const double each = 1 / std::sqrt(static_cast<double>(kSkins));
  const auto designs = [&](double first, double second) {
    std::vector<double> leads;
    for (std::size_t m = 0; m < kMembers; ++m) leads.push_back(m % 2 == 0 ? first : second);
    MemberWorth d =
        worth_of(std::vector<double>(kMembers, 1), {leads, std::vector<double>(kMembers, 0)});
    d.by_skin = {std::vector(kMembers, std::vector<double>(kSkins, each)),
                 std::vector(kMembers, std::vector<double>(kSkins, 0))};
    return d;
  };
  const MemberWorth alike = designs(1, 1);
  const SettledSkins settled = settled_skins(alike, {}, 0);
  EXPECT_NEAR(prospects(alike, {})[0].p_best, normal_cdf(1), 0.02);
  const double lost = std::exp(-0.5) / std::sqrt(2 * kPi) - normal_cdf(-1);  // E max(-d, 0)
  EXPECT_NEAR(prospects(alike, {})[0].regret, lost, 0.02);
  EXPECT_NEAR(settled.p_best, 1, 1e-9);
  EXPECT_NEAR(settled.regret, 0, 1e-9);
  // Far apart at either member: skins are no part of the doubt.
  const MemberWorth apart = designs(200, -190);
  EXPECT_NEAR(settled_skins(apart, {}, 0).p_best, 0.5, 1e-9);
  EXPECT_NEAR(settled_skins(apart, {}, 0).regret, 95, 0.1);
  // Without skins it is what is said today.
  MemberWorth known = apart;
  known.by_skin.clear();
  EXPECT_EQ(settled_skins(known, {}, 0).regret, prospects(known, {})[0].regret);
}

// One error a design, by what members scale the worth; of two that are off alike one for both.
TEST(Prospects, FieldsThatFewSkinsTellMoveDesignsApart) {
  MemberWorth d = worth_of({1, 1}, {{2, 4}, {2, 2}, {2, 2}});
  d.by_skin = {{{0.5}, {0.5}}, {{0.5}, {0.5}}, {{}, {}}};
  const std::vector<WorthBySkin> confirmed(3, {2, {}});
  add_field_moves(confirmed, {0.1, 0.2, 0.2}, {{1, 0, 0.6}, {0, 1, 0.8}, {0.6, 0.8, 1}}, true, d);
  const auto expect_near = [&](std::size_t i, std::size_t m, const std::vector<double>& moves) {
    ASSERT_EQ(d.by_error[i][m].size(), moves.size());
    for (std::size_t s = 0; s < moves.size(); ++s)
      EXPECT_NEAR(d.by_error[i][m][s], moves[s], 1e-12) << i << m << s;
  };
  expect_near(0, 0, {0.1, 0, 0});
  expect_near(0, 1, {0.2, 0, 0});  // worth twice as much there
  expect_near(1, 0, {0, 0.2, 0});
  expect_near(2, 0, {0.12, 0.16, 0});  // no error of its own is left
  EXPECT_EQ(d.by_skin[0], (Matrix{{0.5}, {0.5}}));
  // Skins first, then the errors, on average over the members.
  EXPECT_NEAR(d.mean_moves(0)[0], 0.5, 1e-12);
  EXPECT_NEAR(d.mean_moves(0)[1], 0.15, 1e-12);
  // Two of equal worth: each is the best half of the time; without any error both always are.
  MemberWorth pair = worth_of({1}, {{1}, {1.01}});
  pair.by_skin = {{{}}, {{}}};
  EXPECT_EQ(prospects(pair, {})[1].p_best, 1);
  add_field_moves({{1, {}}, {1.01, {}}}, {0.1, 0.1}, {{1, 0}, {0, 1}}, false, pair);
  EXPECT_NEAR(prospects(pair, {})[1].p_best, 0.53, 0.1);
  MemberWorth none = worth_of({1}, {{1}, {2}});
  none.by_skin = {{{0.1}}, {{0.1}}};
  add_field_moves({{1, {}}, {2, {}}}, {0, 0}, {{1, 0}, {0, 1}}, false, none);
  EXPECT_TRUE(none.by_error.empty());  // no field, no error of it
}

// A member moves three designs by 2, 3 and 4, the first skin of it by the same differences.
TEST(Prospects, MovesAreShrunkByWhatSkinsScatterThemBy) {
  const std::vector<WorthBySkin> own = {{1, {0, 0.1}}, {2, {0, 0.1}}, {3, {0, 0.1}}};
  const auto shrunk = [&](double scatter) {
    MemberWorth d = worth_of({1}, {{3}, {5}, {7}});
    d.by_skin = {{{-scatter, 0.1}}, {{0, 0.1}}, {{scatter, 0.1}}};
    shrink_moves(own, false, d);
    return d;
  };
  EXPECT_EQ(shrunk(0).worth, (Matrix{{3}, {5}, {7}}));
  // Nothing but scatter, two degrees of freedom: the mean of k over 1 - k is 1/3, its variance
  // 1/18.
  const MemberWorth some = shrunk(1e4);
  const double kept = 1.0 / 3;
  EXPECT_NEAR(some.worth[0][0], 1 + 3 - kept, 1e-4);
  EXPECT_NEAR(some.worth[1][0], 2 + 3, 1e-12);
  EXPECT_NEAR(some.by_skin[2][0][0], 1e4 * std::sqrt(kept), 1);
  EXPECT_NEAR(some.by_skin[0][0][1], 0.1, 1e-12);  // of the design, not of the move
  EXPECT_NEAR(some.by_error[2][0][0], std::sqrt(1.0 / 18), 1e-4);
  // Little scatter changes little.
  EXPECT_NEAR(shrunk(0.01).worth[0][0], 3, 3e-3);
  EXPECT_GT(shrunk(0.01).worth[0][0], 3);
  EXPECT_NEAR(shrunk(1e-9).worth[0][0], 3, 1e-12);
}

// All patches flood: a tenth of every worth is left, and that is not shrunk.
// Levels that differ by what all designs share and, design by design, by what the member has too
// (rough) or has not (rough as the finger is, smooth at the member): the first is taken off, the
// second where skins move both levels' difference and the member together.
TEST(Prospects, LevelsAreCombinedAsSkinsMoveThemTogether) {
  const std::vector<double> fine = {1, 2, 3}, rough = {0.3, -0.2, -0.1};
  const auto combined = [&](double shared) {
    std::vector<WorthBySkin> confirmed, few;
    MemberWorth d = worth_of({1}, {{}, {}, {}});
    for (std::size_t i = 0; i < 3; ++i) {
      confirmed.push_back({fine[i], {0, 0}});
      few.push_back({fine[i] + 5 + rough[i], {rough[i], -rough[i]}});
      d.worth[i] = {fine[i] + 5 + 7 + shared * rough[i]};
      d.by_skin.push_back({{shared * rough[i], -shared * rough[i]}});
    }
    combine_levels(confirmed, few, false, d);
    return d;
  };
  for (const double shared : {0.0, 0.5, 1.0}) {
    const MemberWorth d = combined(shared);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(d.worth[i][0], fine[i] + 7, 1e-12);
      EXPECT_NEAR(d.by_skin[i][0][0], 0, 1e-12);
    }
  }
  // Never more than the levels differ, nor the other way.
  EXPECT_NEAR(combined(3).worth[0][0], fine[0] + 7 + 2 * rough[0], 1e-12);
  EXPECT_NEAR(combined(-1).worth[0][0], fine[0] + 7 - rough[0], 1e-12);
  // In proportion: the level doubles all, the member triples them.
  MemberWorth d = worth_of({1}, {{6}, {12}});
  d.by_skin = {{{}}, {{}}};
  combine_levels({{1}, {2}}, {{2}, {4}}, true, d);
  EXPECT_EQ(d.worth, (Matrix{{3}, {6}}));
}

TEST(Prospects, MovesInProportionAreAlike) {
  const std::vector<WorthBySkin> own = {{0.1, {0.01, 0}}, {0.3, {0.03, 0}}};
  MemberWorth d = worth_of({1}, {{0.01}, {0.03}});
  d.by_skin = {{{0.001, 0.005}}, {{0.003, -0.005}}};
  shrink_moves(own, true, d);
  EXPECT_NEAR(d.worth[0][0], 0.01, 1e-15);
  EXPECT_NEAR(d.worth[1][0], 0.03, 1e-15);
  EXPECT_NEAR(d.by_skin[0][0][0], 0.001, 1e-15);
  // One degree of freedom and no move but the skins': the mean of k over sqrt(1 - k).
  EXPECT_NEAR(d.by_skin[0][0][1], 0.005 * std::sqrt(0.4), 1e-5);
}

TEST(Prospects, ALimitIsKeptWithTheWeightOfItsMembers) {
  MemberWorth d = worth_of({0.5, 0.3, 0.2}, {{5, 5, 5}, {1, 1, 2}});
  d.kept = {{{true, true, false}, {true, false, true}},  // [design][limit][member]
            {{true, true, true}, {true, true, true}}};
  const std::vector<Prospect> p = prospects(d, {});
  EXPECT_NEAR(p[0].p_limit[0], 0.8, 1e-12);
  EXPECT_NEAR(p[0].p_limit[1], 0.7, 1e-12);
  EXPECT_NEAR(p[0].p_limits, 0.5, 1e-12);  // both together
  EXPECT_NEAR(p[1].p_limits, 1, 1e-12);
  // What breaks a limit is no best, and to have more there is no gain.
  EXPECT_NEAR(p[0].p_best, 0.5, 1e-12);
  EXPECT_NEAR(p[1].p_best, 0.5, 1e-12);
  EXPECT_NEAR(p[0].regret, 0, 1e-12);
  EXPECT_NEAR(p[1].regret, 0.5 * 4, 1e-12);
  EXPECT_EQ(chosen(p, 0.9), 1u);
  EXPECT_EQ(chosen(p, 0.5), 0u);
}

// Of twelve members the designs keep their limits at 3, 10 and 9: seven members tell the first from
// the surest (4.1 standard errors), one does not tell the last from it (1.04).
TEST(Prospects, WhereNoneIsSureEnoughTheBestOfTheSurestIsChosen) {
  constexpr std::size_t kMembers = 12;
  const auto all = [](double worth) { return std::vector<double>(kMembers, worth); };
  MemberWorth d = worth_of(all(1), {all(5), all(1), all(2)});
  d.kept.clear();
  for (const std::size_t kept : {3, 10, 9}) {
    std::vector<bool>& limit = d.kept.emplace_back().emplace_back(kMembers, false);
    for (std::size_t m = 0; m < kept; ++m) limit[m] = true;
  }
  const std::vector<Prospect> p = prospects(d, {});
  EXPECT_NEAR(p[0].less_sure, 7 / std::sqrt(7 * 25 / 144.0 + 5 * 49 / 144.0), 1e-9);
  EXPECT_EQ(p[1].less_sure, 0);
  EXPECT_NEAR(p[2].less_sure, 1 / std::sqrt(121 / 144.0 + 11 / 144.0), 1e-9);
  EXPECT_EQ(chosen(p, 0.9), 2u);
  EXPECT_EQ(chosen(p, 0.8), 1u);  // 10 of 12
  // What skins leave open of the worth makes no more members of them.
  d.by_skin.assign(3, {kMembers, {0.1, -0.1}});
  EXPECT_NEAR(prospects(d, {})[2].less_sure, p[2].less_sure, 1e-9);
  // Nor do draws of members, of their own worth each.
  MemberWorth drawn = worth_of({}, {{}, {}, {}});
  drawn.kept.assign(3, std::vector<std::vector<bool>>(1));
  for (std::size_t m = 0; m < kMembers; ++m) {
    for (int draw = 0; draw < 8; ++draw) {
      drawn.weights.push_back(0.125);
      drawn.draw_of.push_back(m);
      for (std::size_t i = 0; i < 3; ++i) {
        drawn.worth[i].push_back(d.worth[i][m] + 0.01 * draw);
        drawn.kept[i][0].push_back(d.kept[i][0][m]);
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(prospects(drawn, {})[i].less_sure, p[i].less_sure, 1e-9);
}

TEST(Prospects, ADesignWithoutAnAnswerIsTheLeastOfTheOthersThere) {
  const double none = std::nan("");
  const std::vector<Prospect> p = prospects(worth_of({0.5, 0.5}, {{3, none}, {1, 2}, {2, 1}}), {});
  EXPECT_NEAR(p[0].regret, 0.5 * (2 - 1), 1e-12);
  EXPECT_NEAR(p[0].p_limits, 0.5, 1e-12);
}

// Probabilities, regrets and worths are of the others; a limit that needs no answer is kept there.
TEST(Prospects, AreOverTheMembersThatTellDesignsApart) {
  const double none = std::nan("");
  MemberWorth d = worth_of({0.2, 0.5, 0.3}, {{3, none, 1}, {1, none, 2}});
  d.kept = {{{true, true, true}, {true, false, true}}, {{true, true, true}, {true, false, true}}};
  EXPECT_NEAR(known_share(d), 0.5, 1e-12);
  const std::vector<Prospect> p = prospects(d, {});
  EXPECT_NEAR(p[0].p_best, 0.4, 1e-12);
  EXPECT_NEAR(p[1].p_best, 0.6, 1e-12);
  EXPECT_NEAR(p[0].regret, 0.6 * (2 - 1), 1e-12);
  EXPECT_NEAR(p[1].regret, 0.4 * (3 - 1), 1e-12);
  EXPECT_NEAR(best_worth(d), 0.4 * 3 + 0.6 * 2, 1e-12);
  EXPECT_NEAR(p[0].p_limit[0], 1, 1e-12);
  EXPECT_NEAR(p[0].p_limit[1], 0.5, 1e-12);
  EXPECT_NEAR(p[0].p_limits, 0.5, 1e-12);
  EXPECT_NEAR(prospects(d, parse_belief_risk("mean"))[1].merit, 0.4 * 1 + 0.6 * 2, 1e-12);
  // Members without any answer overturn nothing.
  const std::vector<Reversal> found = by_group(d, {}, 0.4, {{"silent", {1}}, {"last", {1, 2}}});
  EXPECT_EQ(found[0].best, chosen(p, 0.4));
  EXPECT_EQ(found[0].known, 0);
  EXPECT_NEAR(found[1].weight, 0.8, 1e-12);
  EXPECT_NEAR(found[1].known, 0.3, 1e-12);
  EXPECT_NEAR(prospects(worth_of({1}, {{none}, {none}}), {})[0].p_limits, 1, 1e-12);
}

TEST(Prospects, TheRiskDecidesWhatIsChosen) {
  const MemberWorth d = worth_of({0.9, 0.1}, {{4, 0}, {3, 3}});
  EXPECT_EQ(chosen(prospects(d, parse_belief_risk("regret")), 0.9), 0u);
  EXPECT_EQ(chosen(prospects(d, parse_belief_risk("mean")), 0.9), 0u);
  EXPECT_EQ(chosen(prospects(d, parse_belief_risk("worst 10 %")), 0.9), 1u);
  EXPECT_EQ(chosen(prospects(d, parse_belief_risk("worst")), 0.9), 1u);
  EXPECT_EQ(prospects(d, parse_belief_risk("worst 10 %"))[0].merit, 0);
  for (const char* wrong : {"best", "worst 0 %", "worst 120 %", "regrets"})
    EXPECT_THROW(parse_belief_risk(wrong), InputError) << wrong;
}

// The first design is better at both members; what its four skins leave open of it is luck, of
// which the worst of many draws is the design's that scatters most.
TEST(Prospects, ARiskIsOverMembersAndNotOverTheLuckOfSkins) {
  MemberWorth d = worth_of({0.5, 0.5}, {{0.9, 0.6}, {0.8, 0.5}});
  d.by_skin = {{{0.3, -0.1, 0.2, 0}, {0.3, -0.1, 0.2, 0}}, {{0, 0, 0, 0}, {0, 0, 0, 0}}};
  const auto of_first = [&](const char* risk) {
    const std::vector<Prospect> p = prospects(d, parse_belief_risk(risk));
    EXPECT_EQ(chosen(p, 0.9), 0u) << risk;
    return p[0].merit;
  };
  EXPECT_NEAR(of_first("worst"), 0.6, 1e-12);
  EXPECT_NEAR(of_first("worst 10 %"), 0.6, 1e-12);
  EXPECT_NEAR(of_first("mean - 1 std"), 0.75 - 0.15, 1e-12);
  EXPECT_NEAR(of_first("mean"), 0.75, 1e-12);
  EXPECT_NEAR(of_first("worst"), prospects(d, parse_belief_risk("worst"))[1].merit + 0.1, 1e-12);
}

// They stand for what the readings leave open between its members (Eq. lab.5).
TEST(Prospects, DrawsOfALabAreItsBeliefToARisk) {
  MemberWorth d = worth_of({0.25, 0.25, 0.5}, {{0.4, 0.8, 0.5}, {0.45, 0.45, 0.45}});
  d.draw_of = {0, 0, 1};
  const std::vector<Prospect> p = prospects(d, parse_belief_risk("worst"));
  EXPECT_NEAR(p[0].merit, 0.4, 1e-12);
  EXPECT_NEAR(p[1].merit, 0.45, 1e-12);
}

TEST(Prospects, AGroupOfMembersMayChooseAnother) {
  const MemberWorth d = worth_of({0.4, 0.4, 0.2}, {{3, 3, 1}, {1, 2, 4}});
  const std::vector<Reversal> found = by_group(d, {}, 0.9, {{"fit", {0, 1}}, {"emission", {2}}});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].best, 0u);
  EXPECT_NEAR(found[0].weight, 0.8, 1e-12);
  EXPECT_EQ(found[0].loss, 0);
  EXPECT_EQ(found[1].best, 1u);
  EXPECT_NEAR(found[1].weight, 0.2, 1e-12);
  EXPECT_NEAR(found[1].loss, 3, 1e-12);
}

TEST(Prospects, TheParameterThatTurnsTheChoiceIsTheOneThatCostsMost) {
  // The first number orders the designs, the second has nothing to do with them.
  const MemberWorth d = worth_of({0.25, 0.25, 0.25, 0.25}, {{4, 4, 1, 1}, {1, 2, 3, 3}});
  const std::vector<MemberNumber> numbers{{"skin.rms", {1, 2, 3, 4}}, {"skin.hurst", {1, 3, 2, 4}}};
  const auto found = by_half(d, {}, 0.9, numbers);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->path, "skin.rms");
  EXPECT_NEAR(found->edge, 2.5, 1e-12);
  EXPECT_EQ(found->low.best, 0u);
  EXPECT_EQ(found->high.best, 1u);
  EXPECT_NEAR(found->low.weight, 0.5, 1e-12);
  EXPECT_NEAR(found->high.loss, 2, 1e-12);
  EXPECT_FALSE(by_half(d, {}, 0.9, {{"same", {1, 1, 1, 1}}}));
  EXPECT_FALSE(by_half(worth_of({1, 1}, {{2, 2}, {1, 1}}), {}, 0.9, {{"skin.rms", {1, 2}}}));
}

// Designs whose worth is a parabola in two numbers of the finger; members and truths are draws of
// the same Gaussian, so what is said of the members must be so often true.
struct Drawn {
  explicit Drawn(RandomStream& random) {
    for (Parabola& p : designs) {
      p.at = random.normal();
      for (double& s : p.slope) s = 0.7 * random.normal();
      p.bend = 0.6 * std::abs(random.normal());
    }
  }
  // At a draw; what the numbers of the fit say is that at its mean, {0, 0}.
  std::vector<double> worth(const std::array<double, 2>& x) const {
    std::vector<double> out;
    for (const Parabola& p : designs)
      out.push_back(p.at + p.slope[0] * x[0] + p.slope[1] * x[1] - p.bend * x[0] * x[0]);
    return out;
  }

  struct Parabola {
    double at = 0, bend = 0;
    std::array<double, 2> slope{};
  };
  std::array<Parabola, 6> designs;
};

std::size_t largest(const std::vector<double>& v) {
  return static_cast<std::size_t>(std::max_element(v.begin(), v.end()) - v.begin());
}

TEST(Prospects, AreTrueAsOftenAsTheySayOfTruthsDrawnFromBelief) {
  constexpr int kProblems = 1500, kMembers = 300, kBins = 5;
  RandomStream random(7, "planted truths");
  const auto draw = [&] { return std::array<double, 2>{random.normal(), random.normal()}; };
  std::array<double, kBins> said{}, spread{}, so{};
  double expected = 0, by_regret = 0, by_fit = 0;
  for (int k = 0; k < kProblems; ++k) {
    const Drawn problem(random);
    MemberWorth d = worth_of(std::vector<double>(kMembers, 1), Matrix(6));
    for (int m = 0; m < kMembers; ++m) {
      const std::vector<double> there = problem.worth(draw());
      for (std::size_t i = 0; i < there.size(); ++i) d.worth[i].push_back(there[i]);
    }
    const std::vector<Prospect> p = prospects(d, {});
    const std::vector<double> truth = problem.worth(draw());
    const std::size_t best = largest(truth);
    for (std::size_t i = 0; i < p.size(); ++i) {
      const int bin = std::min(kBins - 1, static_cast<int>(kBins * p[i].p_best));
      said[bin] += p[i].p_best;
      spread[bin] += p[i].p_best * (1 - p[i].p_best);
      so[bin] += i == best;
    }
    const std::size_t choice = chosen(p, 0.9);
    expected += p[choice].regret;
    by_regret += truth[best] - truth[choice];
    by_fit += truth[best] - truth[largest(problem.worth({0, 0}))];
  }
  for (int bin = 0; bin < kBins; ++bin)
    EXPECT_NEAR(so[bin], said[bin], 3 * std::sqrt(spread[bin])) << "bin " << bin;
  EXPECT_LT(by_regret, by_fit);
  EXPECT_NEAR(by_regret, expected, 0.1 * expected);  // 1500 truths scatter by some per cent
}

// The truth is one member; what it moves designs apart by is known from eight skins, as badly as
// it is large, or any share of it as likely.
void expect_true_where_skins_hide_the_moves(bool any_share) {
  constexpr std::size_t kDesigns = 8, kSkins = 8, kMembers = 4, kBins = 4;
  constexpr int kProblems = 2000;
  RandomStream random(11, "hidden moves");
  std::array<double, kBins> said{}, spread{}, so{};
  double error = 0, error_as_measured = 0, expected = 0, regret = 0, regret_as_measured = 0;
  for (int k = 0; k < kProblems; ++k) {
    std::vector<WorthBySkin> own;
    std::vector<double> truth, measured;
    MemberWorth d;
    d.weights.assign(kMembers, 1);  // the same one, for its draws
    const double share = any_share ? random.uniform() : 0.5;
    const double move = std::sqrt(share / (1 - share));
    for (std::size_t i = 0; i < kDesigns; ++i) {
      own.push_back({0.5 * random.normal()});
      truth.push_back(own.back().worth + move * random.normal());
      std::vector<double> samples;
      for (std::size_t s = 0; s < kSkins; ++s)
        samples.push_back(truth.back() + std::sqrt(1.0 * kSkins) * random.normal());
      measured.push_back(mean_estimate(samples).value);
      d.worth.emplace_back(kMembers, measured.back());
      d.by_skin.emplace_back(kMembers, error_moves(samples));
      d.kept.emplace_back();
    }
    shrink_moves(own, false, d);
    const std::vector<Prospect> p = prospects(d, {});
    const std::size_t best = largest(truth), choice = chosen(p, 0.9);
    for (std::size_t i = 0; i < kDesigns; ++i) {
      const std::size_t bin = std::min(kBins - 1, static_cast<std::size_t>(kBins * p[i].p_best));
      said[bin] += p[i].p_best;
      spread[bin] += p[i].p_best * (1 - p[i].p_best);
      so[bin] += i == best;
      error += square(d.worth[i][0] - truth[i]);
      error_as_measured += square(measured[i] - truth[i]);
    }
    // No limits: the choice is the highest worth, by no luck of the draws.
    std::vector<double> worth;
    for (const std::vector<double>& of : d.worth) worth.push_back(of[0]);
    EXPECT_EQ(choice, largest(worth));
    expected += p[choice].regret;
    regret += truth[best] - truth[choice];
    regret_as_measured += truth[best] - truth[largest(measured)];
  }
  // How much of the moves is theirs is known from eight designs: three binomial errors and a tenth.
  for (std::size_t bin = 0; bin < kBins; ++bin)
    EXPECT_NEAR(so[bin], said[bin], 3 * std::sqrt(spread[bin]) + 0.1 * said[bin]) << "bin " << bin;
  EXPECT_LT(error, 0.65 * error_as_measured);
  EXPECT_LT(regret, 0.95 * regret_as_measured);
  EXPECT_NEAR(regret, expected, (any_share ? 0.15 : 0.1) * expected);
}

TEST(Prospects, AreTrueAsOftenAsTheySayWhereSkinsHideTheMoves) {
  expect_true_where_skins_hide_the_moves(false);
}

TEST(Prospects, AreTrueAsOftenAsTheySayWhereSkinsHideAnyShareOfTheMoves) {
  expect_true_where_skins_hide_the_moves(true);
}

}  // namespace
}  // namespace papilla::tests::prospects_test
