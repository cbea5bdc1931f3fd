// A whole ranking against its equations, computed here from the samples of each candidate: scores,
// intervals, orders, relations, probabilities, and who met how many skins.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "rank/candidate.h"
#include "scene/uncertainty.h"
#include "tests/rank/samples.h"
#include "tests/support/refusal.h"

namespace papilla::tests::race_test {
namespace {

using Samples = std::vector<std::vector<double>>;  // [candidate][skin]

// The candidates on as many skins as a ranking gave each, and what follows for one criterion or for
// a weighted sum of them.
class Told {
 public:
  Told(const std::vector<Regions>& designs, const RankOptions& options, const StateRanking& result)
      : options_(options) {
    for (const Regions& d : designs) candidates_.emplace_back(d, result.state, options);
    for (const RankedCandidate& r : result.candidates) {
      while (candidates_[r.index].skins() < r.skins) candidates_[r.index].extend();
      if (options.parameters) candidates_[r.index].step();
    }
  }

  Samples samples(std::size_t criterion) const {
    Samples out;
    for (const Candidate& x : candidates_) out.push_back(x.samples(criterion));
    return out;
  }

  // Eq. ranking.1: of each criterion its share of the weights over the mean of what the candidates
  // have, in size, of a force with a sign with its model part; + where high is better.
  Scores scores(const std::vector<double>& weights) const {
    double sum = 0;
    for (const double w : weights) sum += w;
    Scores out;
    for (const Candidate& x : candidates_) {
      std::vector<double> s(static_cast<std::size_t>(x.skins()), 0.0);
      StepSamples steps;
      for (std::size_t c = 0; c < weights.size(); ++c) {
        double typical = 0;
        const bool signed_force =
            options_.criteria[c].text().find("capillary") != std::string::npos;
        for (const Candidate& of : candidates_) {
          double mean = 0;
          for (const double v : of.samples(c)) mean += v / static_cast<double>(of.skins());
          const double open = signed_force && options_.parameters ? step_error(of.steps(c)) : 0.0;
          typical += std::sqrt(mean * mean + open * open) / static_cast<double>(candidates_.size());
        }
        if (typical == 0) typical = 1;
        const double unit = weights[c] / sum / typical * (options_.criteria[c].high ? 1 : -1);
        for (std::size_t k = 0; k < s.size(); ++k) s[k] += unit * x.samples(c)[k];
        if (!options_.parameters) continue;
        if (steps.empty())
          for (const auto& direction : x.steps(c)) steps.emplace_back(direction.size(), 0.0);
        for (std::size_t k = 0; k < steps.size(); ++k)
          for (std::size_t i = 0; i < steps[k].size(); ++i) steps[k][i] += unit * x.steps(c)[k][i];
      }
      out.skins.push_back(s);
      if (options_.parameters) out.steps.push_back(steps);
    }
    return out;
  }

  Scores of_criterion(std::size_t criterion) const {
    std::vector<double> weights(options_.criteria.size(), 0.0);
    weights[criterion] = 1;
    return scores(weights);
  }

  StepSamples steps(std::size_t candidate, std::size_t criterion) const {
    return options_.parameters ? candidates_[candidate].steps(criterion) : StepSamples{};
  }

 private:
  const RankOptions& options_;
  std::vector<Candidate> candidates_;
};

void expect_near(const Interval& a, const Interval& b, const std::string& what) {
  const double slack = 1e-9 * (std::abs(b.value) + (b.high - b.low)) + 1e-15;
  EXPECT_NEAR(a.value, b.value, slack) << what;
  EXPECT_NEAR(a.low, b.low, slack) << what;
  EXPECT_NEAR(a.high, b.high, slack) << what;
  ASSERT_EQ(a.parameters.has_value(), b.parameters.has_value()) << what;
  if (a.parameters) {
    EXPECT_NEAR(*a.parameters, *b.parameters, slack) << what;
  }
}

// What every ranking has, with a score or without one.
void expect_candidates(const Told& told, const RankOptions& options, const StateRanking& state) {
  const std::size_t n = state.candidates.size();
  int skins = 0, most = 0;
  for (const RankedCandidate& r : state.candidates) {
    skins += r.skins;
    most = std::max(most, r.skins);
    ASSERT_EQ(r.metrics.size(), options.criteria.size());
    ASSERT_EQ(r.p_best_by.size(), options.criteria.size());
    ASSERT_EQ(r.over.size(), n);
    for (std::size_t c = 0; c < options.criteria.size(); ++c) {
      const Samples samples = told.samples(c);
      expect_near(
          r.metrics[c],
          interval_of(samples[r.index], told.steps(r.index, c)).moved(unmet(samples, r.index)),
          options.criteria[c].text());
      // A stream of draws of its own for each state and each criterion.
      const std::uint64_t stream = static_cast<std::uint64_t>(state.state) + 16 * c;
      EXPECT_NEAR(r.p_best_by[c], told.of_criterion(c).probabilities(stream)[r.index], 1e-9);
    }
    for (std::size_t j = 0; j < n; ++j) {
      int ahead = 0, behind = 0;
      for (std::size_t c = 0; c < options.criteria.size() && j != r.index; ++c) {
        const Interval d = told.of_criterion(c).difference(r.index, j);
        ahead += d.low > 0;
        behind += d.high < 0;
      }
      bool equal = j != r.index;
      for (std::size_t c = 0; c < options.criteria.size() && equal; ++c)
        equal = told.of_criterion(c).equal(r.index, j);
      const Relation relation = ahead > 0 && behind > 0 ? Relation::TradeOff
                                : ahead > 0             ? Relation::Better
                                : behind > 0            ? Relation::Worse
                                : equal                 ? Relation::Equal
                                                        : Relation::Open;
      EXPECT_EQ(r.over[j], relation) << r.index << " over " << j;
    }
  }
  EXPECT_EQ(state.skins, skins);
  EXPECT_EQ(state.equal_skins, most * static_cast<int>(n));
}

// The neighbours of orders that are not decided; none of them may take another batch, but for one
// that has more skins than the other.
void expect_open(const std::vector<Scores>& boards, const RankOptions& options,
                 const StateRanking& state) {
  std::vector<std::string> expected, said;
  for (std::size_t k = 0; k < boards.size(); ++k) {
    const std::vector<std::size_t> order = boards[k].order();
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      if (boards[k].decided(order[i], order[i + 1]) || boards[k].equal(order[i], order[i + 1]))
        continue;
      expected.push_back(fmt::format("{} {} {}", order[i], order[i + 1], k));
      const std::size_t fewer =
          std::min(boards[k].skins[order[i]].size(), boards[k].skins[order[i + 1]].size());
      EXPECT_GT(static_cast<int>(fewer) + options.batch, options.max_skins);
    }
  }
  for (const CandidatePair& p : state.open)
    said.push_back(fmt::format("{} {} {}", p.first, p.second, p.criterion));
  EXPECT_EQ(said, expected);
}

void expect_scored(const std::vector<Regions>& designs, const RankOptions& options,
                   const StateRanking& state) {
  const Told told(designs, options, state);
  expect_candidates(told, options, state);
  std::vector<double> weights = options.weights;
  if (weights.empty()) weights = {1};
  const Scores scores = told.scores(weights);
  expect_open({scores}, options, state);
  const std::vector<std::size_t> order = scores.order();
  const std::vector<double> p = scores.probabilities(static_cast<std::uint64_t>(state.state));
  ASSERT_EQ(state.candidates.size(), order.size());
  for (std::size_t place = 0; place < order.size(); ++place) {
    const RankedCandidate& r = state.candidates[place];
    const std::size_t i = order[place];
    ASSERT_EQ(r.index, i);
    int rank = 1;
    for (std::size_t ahead = 0; ahead < place; ++ahead) rank += scores.decided(order[ahead], i);
    EXPECT_EQ(r.rank, rank);
    EXPECT_NEAR(r.p_best, p[i], 1e-9);
    expect_near(r.score,
                interval_of(scores.skins[i], scores.steps.empty() ? StepSamples{} : scores.steps[i])
                    .moved(unmet(scores.skins, i)),
                "score");
    const bool last = place + 1 == order.size();
    expect_near(r.behind_best, place == 0 ? Interval{} : scores.difference(i, order[0]), "behind");
    expect_near(r.ahead_of_next, last ? Interval{} : scores.difference(i, order[place + 1]),
                "ahead");
    EXPECT_NEAR(r.p_ahead, last ? 0 : scores.probability_ahead(i, order[place + 1]), 1e-9);
    EXPECT_EQ(r.tied_with_next, !last && !scores.decided(i, order[place + 1]));
  }
}

void expect_unscored(const std::vector<Regions>& designs, const RankOptions& options,
                     const StateRanking& state) {
  const Told told(designs, options, state);
  expect_candidates(told, options, state);
  std::vector<Scores> boards;
  for (std::size_t c = 0; c < options.criteria.size(); ++c) boards.push_back(told.of_criterion(c));
  expect_open(boards, options, state);
  // 1 and how many are better; of one rank in the order of the first criterion.
  const std::vector<std::size_t> order = boards[0].order();
  const auto place = [&](std::size_t i) { return std::find(order.begin(), order.end(), i); };
  for (const RankedCandidate& r : state.candidates) {
    int better = 0;
    for (const Relation relation : r.over) better += relation == Relation::Worse;
    EXPECT_EQ(r.rank, 1 + better);
  }
  for (std::size_t k = 1; k < state.candidates.size(); ++k) {
    const RankedCandidate &a = state.candidates[k - 1], &b = state.candidates[k];
    EXPECT_TRUE(a.rank < b.rank || (a.rank == b.rank && place(a.index) < place(b.index)));
  }
}

// Flat glass, holes, the same holes on glass that is wetted a little less, and shallow holes.
std::vector<Regions> four() {
  std::vector<Regions> out;
  for (const char* name : {"a4h600", "flat", "a4h600", "a4h350"})
    out.push_back({small_sample(name)});
  out[2][0].surface.contact_angle += 0.01;
  return out;
}

RankOptions quick(const std::string& criteria) {
  RankOptions options = by(criteria);
  options.batch = 3;
  options.max_skins = 11;  // three batches, and no fourth
  options.threads = 1;
  return options;
}

TEST(Race, OfOneCriterionIsWhatTheEquationsSay) {
  for (const char* criterion : {"modulation:high", "friction:low", "capillary_force:low"}) {
    const RankOptions options = quick(criterion);
    const Ranking r = ranking_of(four(), options);
    ASSERT_EQ(r.states.size(), 1u);
    expect_scored(four(), options, r.states[0]);
  }
}

TEST(Race, OfWeightedCriteriaIsWhatTheEquationsSay) {
  RankOptions options = quick("modulation:high,friction:low,capillary_force:low");
  options.weights = {2, 0.5, 1};
  options.states = {FingerState::Natural, FingerState::Clean};
  const Ranking r = ranking_of(four(), options);
  ASSERT_EQ(r.states.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(r.states[k].state, options.states[k]);
    expect_scored(four(), options, r.states[k]);
  }
  EXPECT_EQ(r.skins, r.states[0].skins + r.states[1].skins);
  EXPECT_EQ(r.directions, 0);
  EXPECT_TRUE(r.conditions.empty());
}

TEST(Race, WithoutWeightsIsWhatTheEquationsSay) {
  for (const char* criteria : {"modulation:high,friction:low", "friction:low,modulation:high",
                               "friction:low,capillary_force:low,modulation:low"}) {
    const RankOptions options = quick(criteria);
    const Ranking r = ranking_of(four(), options);
    expect_unscored(four(), options, r.states.at(0));
  }
}

TEST(Race, WithTheFingersParametersIsWhatTheEquationsSay) {
  std::vector<Regions> designs = four();
  designs.pop_back();
  for (Regions& d : designs)
    d[0].finger.uncertainty = {{"macro.shear_strength", 0.1, {}}, {"skin.rms", 0.05, {0.4}}};
  RankOptions options = quick("modulation:high,friction:low,capillary_force:low");
  options.parameters = true;
  options.max_skins = 6;
  std::vector<std::string> notes;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  const Ranking trade = ranking_of(designs, options);
  EXPECT_EQ(notes.front(), "clean: parameters of the finger");
  EXPECT_EQ(trade.directions, 2);
  EXPECT_EQ(trade.step_skins, 8);  // differences need no more
  EXPECT_EQ(trade.step_grid, 32);
  options.note = {};
  const StateRanking& state = trade.states.at(0);
  const Told told(designs, options, state);
  expect_candidates(told, options, state);
  options.weights = {1, 3, 2};
  expect_scored(designs, options, ranking_of(designs, options).states.at(0));
}

// Water that is pushed off where glass repels it: the sizes of both count, not their sum.
TEST(Race, OfForcesOfBothSignsTheirSizesAreTypical) {
  std::vector<Regions> designs{{small_sample("flat")}, {small_sample("flat")}};
  for (Regions& d : designs) d[0].environment.relative_humidity = {0.75};
  designs[1][0].surface.contact_angle = 2.9;
  RankOptions options = quick("capillary_force:low");
  options.max_skins = 3;
  const StateRanking r = ranking_of(designs, options).states.at(0);
  ASSERT_EQ(r.candidates[0].index, 1u);
  ASSERT_LT(r.candidates[0].metrics[0].value, 0);
  ASSERT_GT(r.candidates[1].metrics[0].value, 0);
  expect_scored(designs, options, r);
  // Values over their mean size: (a - b) / ((a - b) / 2).
  EXPECT_NEAR(r.candidates[0].ahead_of_next.value, 2, 1e-9);
}

// A force that nobody has is worth nothing to anybody.
TEST(Race, ACriterionOfZerosLeavesTheOthers) {
  std::vector<Regions> designs{{small_sample("a4h600")}, {small_sample("flat")}};
  for (Regions& d : designs) d[0].finger.water.hysteresis = 0;
  RankOptions options = quick("retention_force:low,modulation:high");
  options.max_skins = 3;
  options.weights = {1, 1};
  const StateRanking both = ranking_of(designs, options).states.at(0);
  expect_scored(designs, options, both);
  EXPECT_EQ(both.candidates[0].metrics[0].value, 0);
  RankOptions one = quick("modulation:high");
  one.max_skins = 3;
  const StateRanking alone = ranking_of(designs, one).states.at(0);
  EXPECT_NEAR(both.candidates[0].ahead_of_next.value, 0.5 * alone.candidates[0].ahead_of_next.value,
              1e-9);
  EXPECT_EQ(both.candidates[0].index, alone.candidates[0].index);
}

// Two films of the same two regions, of which each skin meets another: their difference has another
// sign from skin to skin, so that they stay open to the last batch, and all that is said of it is
// said once.
TEST(Race, ABatchGoesToBothOfAnOpenPairThatHaveAsMany) {
  const Design flat = small_sample("flat");
  Design thicker = flat;
  thicker.surface.dielectric[0].thickness *= 1.02;
  const Regions one{flat, thicker}, other{thicker, flat}, holes{small_sample("a4h600")};
  RankOptions options = quick("modulation:high");
  std::vector<std::string> notes;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  const auto skins = [&](const std::vector<Regions>& designs, int most) {
    notes.clear();
    options.max_skins = most;
    std::vector<int> out(designs.size());
    const Ranking r = ranking_of(designs, options);
    for (const RankedCandidate& c : r.states.at(0).candidates) out[c.index] = c.skins;
    return out;
  };
  using Ints = std::vector<int>;
  const std::vector<Regions> twins{one, holes, other};
  EXPECT_EQ(skins(twins, 12), (Ints{12, 3, 12}));
  EXPECT_EQ(notes, (std::vector<std::string>{"clean: 2 of 3 candidates still open"}));
  EXPECT_EQ(skins(twins, 11), (Ints{9, 3, 9}));
  EXPECT_EQ(skins(twins, 6), (Ints{6, 3, 6}));
  EXPECT_EQ(skins(twins, 5), (Ints{3, 3, 3}));
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(skins(twins, 1), (Ints{3, 3, 3}));  // a batch everyone gets
  // Of two that are equal both meet what the third asks for.
  EXPECT_EQ(skins({one, other, one}, 6), (Ints{6, 6, 6}));
  EXPECT_EQ(notes, (std::vector<std::string>{"clean: 3 of 3 candidates still open"}));
  options.states = {FingerState::Wet};
  skins({one, other}, 6);
  EXPECT_EQ(notes, (std::vector<std::string>{"wet: 2 of 2 candidates still open"}));
}

// More skins would say nothing of them, felt or seen.
TEST(Race, EqualDesignsGetNoMoreSkins) {
  Design flat = small_sample("flat"), clear = flat;
  clear.surface.refractive_index += 0.1;  // no finger feels it
  RankOptions options = quick("friction:low");
  const StateRanking felt = ranking_of(std::vector{flat, clear}, options).states.at(0);
  EXPECT_EQ(felt.skins, 6);
  EXPECT_TRUE(felt.open.empty());
  ASSERT_EQ(felt.equal.size(), 1u);
  EXPECT_EQ(felt.candidates[0].over[1 - felt.candidates[0].index], Relation::Equal);
  EXPECT_TRUE(felt.candidates[0].tied_with_next);
  EXPECT_EQ(felt.candidates[1].rank, 1);
  // No eye sees how water wets. Of a surface that is not random one look is all there is.
  Design dry = flat;
  dry.surface.contact_angle += 0.1;
  options = quick("haze:low");
  const StateRanking seen = ranking_of(std::vector{flat, dry}, options).states.at(0);
  EXPECT_EQ(seen.touching, "seen, not felt");
  EXPECT_EQ(seen.skins, 2);
  EXPECT_EQ(seen.equal_skins, 2);
  EXPECT_EQ(seen.candidates[0].skins, 1);
  EXPECT_TRUE(seen.open.empty());
  EXPECT_EQ(seen.equal.size(), 1u);
}

// A look of few wavelengths, and one of holes that are wide and shallow.
TEST(Race, SaysHowFarALookCanBeTrusted) {
  Design fine = small_sample("a4h600"), wide = fine;
  HoleArray holes{.lattice = Lattice::Square, .period = 3e-6, .diameter = 1e-6, .depth = 20e-9};
  fine.texture = Texture{holes};
  holes.period = 30e-6, holes.diameter = 15e-6;
  wide.texture = Texture{holes};
  RankOptions options = quick("haze:low");
  options.names = {"fine", "wide"};
  const Ranking r = ranking_of(std::vector{fine, wide}, options);
  ASSERT_EQ(r.notes.size(), 1u);
  EXPECT_EQ(r.notes[0].rfind("look of fine: features of ", 0), 0u) << r.notes[0];
  EXPECT_EQ(r.notes[0].find("look of wide"), std::string::npos);
}

TEST(Race, EachRefusalSaysWhatIsWrong) {
  Design a = small_sample("flat"), b = small_sample("a4h600");
  a.finger.uncertainty.clear();
  b.finger.uncertainty.clear();
  a.title = "mine";
  b.title = "other";
  RankOptions options = quick("modulation:high,friction:low");
  const auto refusal = [&]() -> std::string {
    return refusal_of([&] { ranking_of({a, b}, options); });
  };
  options.weights = {1};
  EXPECT_EQ(refusal(), "1 weights for 2 criteria: one for each is needed");
  options.weights = {1, 2, 3};
  EXPECT_EQ(refusal(), "3 weights for 2 criteria: one for each is needed");
  for (const double wrong : {0.0, -1.0}) {
    options.weights = {1, wrong};
    EXPECT_EQ(refusal(), "a weight is more than 0; leave a criterion of weight 0 out");
  }
  options.weights.clear();
  options.parameters = true;
  const std::string unknown = refusal();
  EXPECT_EQ(unknown, unknown_parameters(a.finger));
  a.finger.uncertainty = {{"skin.rms", 0.1, {}}};
  EXPECT_EQ(refusal(),
            "\"mine\" and \"other\" are of fingers with other [[uncertainty]]: what their "
            "parameters do to a difference is not known");
  b.finger.uncertainty = a.finger.uncertainty;
  EXPECT_EQ(parameters_unknown({{a}, {b}}), "");
  b.finger.uncertainty[0].deviation = 0.2;
  EXPECT_NE(parameters_unknown({{a, b}}), "");  // regions of one
  EXPECT_NE(parameters_unknown({{a}, {a, b}}), "");
}

}  // namespace
}  // namespace papilla::tests::race_test
