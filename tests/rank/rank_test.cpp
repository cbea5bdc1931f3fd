#include "rank/rank.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "base/error.h"
#include "design/study.h"
#include "geometry/io/files.h"
#include "geometry/texture.h"
#include "numerics/statistics.h"
#include "report/ranking.h"
#include "tests/rank/samples.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::rank_test {
namespace {

TEST(Rank, OrdersTheSamplesAsThePaperDoes) {
  // M11: a3h600 is stronger than a4h600 and than a3h900; flat is the strongest of all.
  const std::vector<Design> designs{sample("a4h600"), sample("flat"), sample("a3h600")};
  const Ranking r = ranking_of(designs, by("modulation:high"));
  const auto& c = r.states.front().candidates;
  ASSERT_EQ(c.size(), 3u);
  EXPECT_EQ(c[0].index, 1u);
  EXPECT_EQ(c[1].index, 2u);
  EXPECT_EQ(c[2].index, 0u);
  for (const RankedCandidate& x : c) {
    EXPECT_FALSE(x.tied_with_next);
    EXPECT_LE(x.skins, 2 * RankOptions{}.batch);  // decided soon: nobody needs more
  }
  EXPECT_GT(c[0].p_best, 0.98);
  EXPECT_GT(c[0].ahead_of_next.low, 0);
  int skins = 0;
  for (const RankedCandidate& x : c) skins += x.skins;
  EXPECT_EQ(r.states.front().skins, skins);
  EXPECT_EQ(r.skins, r.states.front().skins);
}

TEST(Rank, CallsEqualDesignsATie) {
  const std::vector<Design> designs{quick_sample("flat"), quick_sample("flat"),
                                    quick_sample("a4h600")};
  const Ranking r = ranking_of(designs, by("modulation:high"));
  const auto& c = r.states.front().candidates;
  EXPECT_TRUE(c[0].tied_with_next);
  EXPECT_EQ(c[0].rank, 1);
  EXPECT_EQ(c[1].rank, 1);
  EXPECT_EQ(c[2].rank, 3);
  for (const RankedCandidate& x : c)  // more would not tell the twins apart
    EXPECT_EQ(x.skins, RankOptions{}.batch);
  EXPECT_EQ(c[0].ahead_of_next.value, 0);
  EXPECT_NEAR(c[0].p_best, 0.5, 0.01);  // equal designs share the win
  EXPECT_NEAR(c[1].p_best, 0.5, 0.01);
}

TEST(Rank, PairingNarrowsTheIntervalOfADifference) {
  const std::vector<Design> designs{sample("flat"), sample("a3h350")};
  const Ranking r = ranking_of(designs, by("friction:low"));
  const auto& c = r.states.front().candidates;
  const auto width = [](const Interval& i) { return i.high - i.low; };
  EXPECT_LT(width(c[0].ahead_of_next), 0.7 * std::hypot(width(c[0].score), width(c[1].score)));
}

// Friction is proportional to the shear strength, so the share is common and cancels in ratios.
TEST(Rank, WhatTheFingerLeavesOpenMovesBothOfADifference) {
  std::vector<Design> designs{sample("flat"), sample("a3h350")};
  for (Design& d : designs) {
    d.finger.water.hysteresis = 0;
    d.finger.belief.clear();  // the covariance takes its place
    d.finger.uncertainty = {{"macro.shear_strength", 0.3, {}}};
  }
  RankOptions options = by("friction:low");
  options.max_skins = 6;
  const Ranking without = ranking_of(designs, options);
  options.parameters = true;
  const Ranking with = ranking_of(designs, options);
  const auto& a = without.states.front().candidates;
  const auto& b = with.states.front().candidates;
  EXPECT_EQ(with.directions, 1);
  EXPECT_FALSE(a[0].score.parameters);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a[i].index, b[i].index);
    EXPECT_NEAR(*b[i].metrics[0].parameters / b[i].metrics[0].value, std::sinh(0.3), 0.03);
    EXPECT_NEAR(b[i].score.high - b[i].score.low, 2 * 1.96 * std::sinh(0.3), 0.1);
  }
  const Interval &open = b[0].ahead_of_next, &own = a[0].ahead_of_next;
  // As far as few skins know the difference.
  EXPECT_LT(*open.parameters,
            1.2 * std::sinh(0.3) * std::max(std::abs(own.low), std::abs(own.high)));
  EXPECT_NEAR(square(open.high - open.low) - square(own.high - own.low),
              square(2 * normal_quantile(0.975) * *open.parameters), 1e-12);
  EXPECT_LE(std::abs(b[0].p_ahead - 0.5), std::abs(a[0].p_ahead - 0.5));
}

TEST(Rank, FingersOfUnknownOrOtherUncertaintyAreRefused) {
  std::vector<Design> designs{sample("flat"), sample("a3h350")};
  RankOptions options = by("modulation:high");
  options.parameters = true;
  designs[1].finger.uncertainty = {{"skin.rms", 0.1, {}}};
  EXPECT_THROW(ranking_of(designs, options), InputError);
  for (Design& d : designs) d.finger.uncertainty.clear();
  EXPECT_THROW(ranking_of(designs, options), InputError);
}

// How many notes of a ranking have these words.
std::ptrdiff_t notes_with(const std::string& words, const std::vector<Design>& designs,
                          const RankOptions& options) {
  const std::vector<std::string> notes = ranking_of(designs, options).notes;
  return std::count_if(notes.begin(), notes.end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

TEST(Rank, ASurfaceThatSaysItsShearStrengthOfTheStateDoesNotRubAsGlassDoes) {
  std::vector<Design> designs{sample("flat"), sample("a3h350")};
  for (Design& d : designs) d.surface.shear_strength_natural = 5e6;
  RankOptions options = by("friction:low");
  options.max_skins = 4;
  EXPECT_EQ(notes_with("shear_strength", designs, options), 1);
  options.states = {FingerState::Natural};
  EXPECT_EQ(notes_with("shear_strength", designs, options), 0);
}

TEST(Rank, NotesWhatTheModelSaysAgainstItsNumbers) {
  std::vector<Design> designs{small_sample("flat"), small_sample("a3h350")};
  RankOptions options = by("modulation:high");
  options.max_skins = 4;
  EXPECT_EQ(notes_with("35 % RH", designs, options), 0);
  for (Design& d : designs) d.drive.amplitude = 5000;
  EXPECT_EQ(notes_with(", finger clean: 35 % RH: breakdown: ", designs, options), 2);
}

// Of a map that is larger than the patch several places are pressed; one that is asked for, and a
// surface that gives way to nothing, are said to be that.
TEST(Rank, PressesMapsAtSeveralPlacesAndSaysWhatIsLeftOut) {
  const std::string file = temporary("slanted.npy");
  Heightmap heights{{160, 160, 16e-6, 16e-6}, {}};
  for (int i = 0; i < 160 * 160; ++i)  // its borders do not meet
    heights.z.push_back(50e-9 * std::cos(0.3 * (i % 160)) + 1e-9 * (i / 160));
  write_npy(file, heights);
  Design scan = sample("flat");
  Measured3d map_of;
  map_of.file = file;
  map_of.width = 16e-6;
  map_of.patch = 4e-6;
  scan.texture = Texture{map_of};
  Measured3d& map = std::get<Measured3d>(scan.texture.kind);
  RankOptions options = by("friction:low");
  options.max_skins = 2, options.batch = 2;
  const auto said = [&](const std::vector<Regions>& candidates, const char* words) {
    const std::vector<std::string> notes = ranking_of(candidates, options).notes;
    return std::count_if(notes.begin(), notes.end(), [&](const std::string& note) {
      return note.find(words) != std::string::npos;
    });
  };
  EXPECT_EQ(said({{scan}, {scan}}, "press 4 places of a map"), 1);
  EXPECT_EQ(said({{scan}, {scan}}, "one place of a map"), 0);
  EXPECT_EQ(said({{scan}, {scan}}, "are rigid"), 1);
  // As four designs that are joined.
  const auto friction = [&](const std::vector<Regions>& candidates) {
    return ranking_of(candidates, options).states[0].candidates[0].metrics[0];
  };
  Regions joined;
  for (const double y : {-4e-6, 4e-6}) {
    for (const double x : {-4e-6, 4e-6}) {
      map.at_x = x, map.at_y = y;
      joined.push_back(scan);
    }
  }
  EXPECT_EQ(said({{scan}, {scan}}, "one place of a map"), 1);
  const Interval of_four = friction({joined, joined});
  map.at_x = map.at_y = 0;
  EXPECT_EQ(friction({{scan}, {scan}}).value, of_four.value);
  EXPECT_EQ(friction({{scan}, {scan}}).high, of_four.high);
  map.patch = 12e-6;
  scan.surface.modulus = 7e6;
  EXPECT_EQ(said({{scan}, {scan}}, "scans:"), 0);
}

// As a part of a stack it has other keys, and no places are tried by themselves.
TEST(Rank, NamesTheKeysOfAMapThatIsAPartOfAStack) {
  const std::string file = temporary("slanted_part.npy");
  Heightmap heights{{160, 160, 16e-6, 16e-6}, {}};
  for (int i = 0; i < 160 * 160; ++i)
    heights.z.push_back(50e-9 * std::cos(0.3 * (i % 160)) + 1e-9 * (i / 160));
  write_npy(file, heights);
  Measured3d map;
  map.file = file, map.width = 16e-6, map.patch = 4e-6;
  Stack stack;
  stack.parts = {Texture{Flat{}}, Texture{map}};
  Design scan = small_sample("flat");
  scan.texture = Texture{stack};
  RankOptions options = by("friction:low");
  options.max_skins = 2, options.batch = 2;
  const auto notes = [&](const std::vector<Regions>& candidates) {
    std::string out;
    for (const std::string& note : ranking_of(candidates, options).notes) out += note + "\n";
    return out;
  };
  const std::string one = notes({{scan}, {scan}}), two = notes({{scan, scan}, {scan, scan}});
  EXPECT_NE(one.find("join designs with another texture.parts.1.at_x and at_y by +"),
            std::string::npos)
      << one;
  EXPECT_NE(two.find("press 2 places of a map in turn (texture.parts.1.patch wide)"),
            std::string::npos)
      << two;
  for (const std::string& said : {one, two}) {
    EXPECT_EQ(said.find("texture.patch"), std::string::npos) << said;
    EXPECT_EQ(said.find("texture.at_x"), std::string::npos) << said;
  }
}

// A steel ball in place of the finger.
Design under_a_ball(Design d) {
  d.drive.amplitude = 0;
  Pin& pin = d.counterface.pin;
  d.counterface.type = CounterfaceType::Pin;
  pin.name = "steel ball";
  pin.load = 0.1;
  pin.modulus = 200e9;
  pin.radius = 1e-3;
  pin.coefficient = 0.2;
  pin.roughness.rms = 20e-9;
  return d;
}

// A pin brings the law of its own pair and has no states.
TEST(Rank, OfAPinSaysItsNameAndTakesOneState) {
  const Design flat = under_a_ball(sample("flat")), holes = under_a_ball(sample("a3h600"));
  RankOptions options = by("friction:low");
  const Ranking r = ranking_of({flat, holes}, options);
  EXPECT_EQ(r.states.front().touching, "steel ball");
  ASSERT_EQ(r.notes.size(), 1u);
  EXPECT_NE(r.notes[0].find("nothing is fitted of \"steel ball\""), std::string::npos)
      << r.notes[0];
  EXPECT_EQ(r.notes[0].find("reference.toml"), std::string::npos) << r.notes[0];
  options.states = {FingerState::Clean, FingerState::Natural};
  EXPECT_THROW(ranking_of(std::vector{flat, holes}, options), InputError);
  // Whichever candidate it is.
  options.any_conditions = true;
  EXPECT_NE(refusal_of([&] {
              ranking_of(std::vector{sample("flat"), flat}, options);
            }).find("\"steel ball\" stands in place of the finger and has no states"),
            std::string::npos);
}

// Skin that is not clean shears at three quarters; steel does not.
TEST(Rank, TheStateOfAFingerThatIsNotThereMovesNoPin) {
  std::vector<Design> designs;
  for (const char* name : {"flat", "a4h600"}) {
    designs.push_back(under_a_ball(small_sample(name)));
    designs.back().counterface.pin.coefficient = 0;
    designs.back().counterface.pin.shear_strength = 20e6;
  }
  RankOptions options = by("friction:low");
  options.batch = options.max_skins = 2;
  const Ranking clean = ranking_of(designs, options);
  options.states = {FingerState::Natural};
  const Ranking natural = ranking_of(designs, options);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(natural.states[0].candidates[i].metrics[0].value,
              clean.states[0].candidates[i].metrics[0].value);
}

// What is fitted of the finger is not known of what stands in its place.
TEST(Rank, AsksNothingOfTheBeliefOfAFingerThatIsNotThere) {
  std::vector<Design> designs(2, under_a_ball(small_sample("flat")));
  designs[1].surface.contact_angle += 0.01;
  for (Design& d : designs) d.finger.belief = "nowhere/belief.toml";
  EXPECT_EQ(parameters_unknown({{designs[0]}, {designs[1]}}),
            "nothing is fitted of \"steel ball\"");
  EXPECT_NE(parameters_unknown({{small_sample("flat")}, {designs[1]}}), "");
  RankOptions options = by("friction:low");
  options.batch = options.max_skins = 2;
  EXPECT_EQ(ranking_of(designs, options).states[0].candidates.size(), 2u);
  options.parameters = true;
  EXPECT_EQ(refusal_of([&] { ranking_of(designs, options); }),
            "nothing is fitted of \"steel ball\"");
}

TEST(Rank, RefusesAStateThatIsNamedTwice) {
  RankOptions options = by("friction:low");
  options.states = {FingerState::Natural, FingerState::Clean, FingerState::Natural};
  EXPECT_EQ(refusal_of([&] {
              ranking_of(std::vector{small_sample("flat"), small_sample("a3h600")}, options);
            }),
            "the finger's state \"natural\" is named twice");
}

TEST(Rank, ANaturalFingerHasMoreWaterAndLessShear) {
  Finger f;
  f.state = FingerState::Natural;
  const Finger natural = f.applied();
  EXPECT_DOUBLE_EQ(natural.water.volume[2], 8 * f.water.volume[2]);
  EXPECT_DOUBLE_EQ(natural.macro.shear_strength, 0.75 * f.macro.shear_strength);
  EXPECT_LT(natural.water.contact_angle, f.water.contact_angle);
  EXPECT_EQ(natural.applied(), natural);  // nothing more to apply
}

TEST(Rank, EightCandidatesTakeTwoThirdsOfEqualSamplingAtMost) {
  // The films of designs/coatings by what packaging asks: neighbours in the order take the skins.
  std::vector<Design> designs;
  for (const char* name : {"hdpe_large_1", "hdpe_small_1", "sparse", "crowded", "hard", "fine",
                           "shallow", "wettable"}) {
    designs.push_back(in_one_pass(read_design(find_design(fmt::format("coatings/{}.toml", name)))));
  }
  RankOptions options = by("friction:low,adhesion:low,compliance:high");
  options.weights = {1, 1, 1};
  options.max_skins = 48;
  const StateRanking r = ranking_of(designs, options).states.front();
  EXPECT_LT(r.skins, 2 * r.equal_skins / 3);
  for (const RankedCandidate& c : r.candidates) {
    if (&c != &r.candidates.back() && !c.tied_with_next) {
      EXPECT_GT(c.p_ahead, 0.97);
    }
  }
}

TEST(Rank, RegionsAreOneCandidate) {
  Design large = read_design(find_design("coatings/hdpe_large_1.toml"));
  Design small = read_design(find_design("coatings/hdpe_small_1.toml"));
  std::vector<Regions> films(2);
  for (int region = 1; region <= 3; ++region) {
    for (Design* d : {&large, &small}) {
      std::get<ParticleFilm>(d->texture.kind).seed = region;
      d->accuracy.level = AccuracyLevel::Draft;
      films[d == &large ? 0 : 1].push_back(*d);
    }
  }
  RankOptions options = by("friction:low,adhesion:low");
  options.weights = {1, 1};
  options.batch = 6;
  const StateRanking r = ranking_of(films, options).states.front();
  EXPECT_EQ(r.candidates.front().index, 1u);  // the smaller, stiffer particles rub less
  EXPECT_GT(r.candidates.front().p_ahead, 0.99);
  for (const RankedCandidate& c : r.candidates)
    EXPECT_GE(c.metrics[1].low, -1e-12);  // no repulsion
}

TEST(Rank, OtherConditionsAreRefusedByTheirKeys) {
  std::vector<Design> designs{sample("flat"), sample("a4h600")};
  designs[1].surface.contact_angle = 1.5;  // a finish is a candidate
  designs[1].finger.load = 0.3;
  designs[1].environment.relative_humidity = {0.55};
  designs[1].drive.amplitude = 150;
  RankOptions options = by("friction:low");
  options.max_skins = 6;
  std::string message;
  try {
    ranking_of(designs, options);
  } catch (const InputError& e) {
    message = e.what();
  }
  EXPECT_NE(message.find("finger.load"), std::string::npos) << message;
  EXPECT_NE(message.find("--set 'finger.load=0.2 N'"), std::string::npos) << message;
  EXPECT_NE(message.find("environment.relative_humidity"), std::string::npos);
  EXPECT_EQ(message.find("drive"), std::string::npos);  // friction without voltage is another's
  EXPECT_EQ(message.find("contact_angle"), std::string::npos);

  options.any_conditions = true;
  const Ranking all_the_same = ranking_of(designs, options);
  EXPECT_EQ(all_the_same.conditions.size(), 2u);
  const std::vector<std::string> names{"flat", "a4h600"};
  EXPECT_NE(ranking_table(names, options, all_the_same).find("warning: "), std::string::npos);
  const auto json = nlohmann::json::parse(ranking_json(names, options, all_the_same));
  EXPECT_EQ(json["conditions_differ"][0]["key"], "finger.load");

  options = by("modulation:high");
  designs[1].finger = designs[0].finger;
  designs[1].finger.name = "the same, named otherwise";
  designs[1].environment = designs[0].environment;
  EXPECT_EQ(condition_differences({{designs[0]}, {designs[1]}}, options).at(0).key,
            "drive.amplitude");
  designs[1].drive = designs[0].drive;
  designs[1].accuracy.level = AccuracyLevel::Design;  // its grid has another error
  EXPECT_EQ(condition_differences({{designs[0]}, {designs[1]}}, options).at(0).key,
            "accuracy.level");
  EXPECT_TRUE(condition_differences({{designs[0]}, {designs[1]}}, by("haze:low")).empty());
  EXPECT_FALSE(condition_differences({designs}, options).empty());  // regions of one candidate
}

TEST(Rank, SaysWhatIsOpenOnceAndThatTheValuesShareTheirSkins) {
  const Design flat = quick_sample("flat");
  Design dry = flat;
  dry.surface.contact_angle += 0.1;
  const std::vector<Regions> designs{{flat, dry}, {dry, flat}};  // ahead on every other skin
  RankOptions options = by("friction:low");
  std::vector<std::string> notes;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  const Ranking r = ranking_of(designs, options);
  EXPECT_EQ(r.states.front().candidates.front().skins, 24);  // four batches
  EXPECT_EQ(notes.size(), 1u);
  EXPECT_NE(ranking_table({"a", "b"}, options, r).find("trust the order"), std::string::npos);
}

TEST(Rank, RefusesWhatHasNoMeaning) {
  EXPECT_THROW(parse_criteria("frictoin:low"), InputError);
  EXPECT_THROW(parse_criteria("friction:down"), InputError);
  EXPECT_THROW(parse_criteria("compliance"), InputError);  // no better direction of its own
  EXPECT_THROW(parse_criteria("friction:low,"), InputError);
  EXPECT_THROW(parse_criteria("mean(felt(modulation, 0.2)):high"), InputError);
  EXPECT_THROW(parse_criteria("felt(modulation, 0.2):high"), InputError);
  EXPECT_FALSE(parse_criteria("variation(modulation)").front().high);
  Design undriven = sample("flat");
  undriven.drive.amplitude = 0;
  EXPECT_THROW(ranking_of({undriven, undriven}, by("modulation:high")), InputError);
}

// Flat glass has the most modulation and the least friction of no drive the most: a trade-off that
// an equal-weight score settled with certainty.
TEST(Rank, SeveralCriteriaWithoutWeightsHaveNoSingleOrder) {
  const std::vector<Design> designs{quick_sample("flat"), quick_sample("a4h600"),
                                    quick_sample("flat")};
  const RankOptions options = by("modulation:high,friction:low");
  const Ranking ranking = ranking_of(designs, options);
  const StateRanking& state = ranking.states.front();
  const auto of = [&](std::size_t index) {
    return *std::find_if(state.candidates.begin(), state.candidates.end(),
                         [&](const RankedCandidate& c) { return c.index == index; });
  };
  const bool trade = of(0).over[1] == Relation::TradeOff;
  EXPECT_TRUE(trade || of(0).over[1] == Relation::Better);
  EXPECT_EQ(of(0).over[2], Relation::Equal);
  EXPECT_EQ(of(1).over[0], trade ? Relation::TradeOff : Relation::Worse);
  for (std::size_t c = 0; c < 2; ++c) {
    double sum = 0;
    for (const RankedCandidate& r : state.candidates) sum += r.p_best_by[c];
    EXPECT_NEAR(sum, 1, 1e-9);
  }
  EXPECT_NEAR(of(0).p_best_by[0], 0.5, 0.01);  // twins share the win
  const std::string table = ranking_table({"one", "two", "twin"}, options, ranking);
  EXPECT_EQ(table.find("ahead of the next"), std::string::npos) << table;
  EXPECT_NE(table.find("no weights (--weights), so no single order"), std::string::npos) << table;
  EXPECT_NE(table.find("the order is known in every criterion; the same on all skins, so that more "
                       "would not tell them apart: one and twin in"),
            std::string::npos)
      << table;
  const auto json = nlohmann::json::parse(ranking_json({"one", "two", "twin"}, options, ranking));
  EXPECT_FALSE(json["candidates"][0].contains("p_best"));
  EXPECT_FALSE(json["scored"]);
}

TEST(Rank, AnOrderThatIsKnownSaysSo) {
  const std::vector<Design> designs{quick_sample("flat"), quick_sample("a4h600")};
  const RankOptions options = by("modulation:high");
  const Ranking ranking = ranking_of(designs, options);
  EXPECT_TRUE(ranking.states.front().open.empty());
  EXPECT_NE(
      ranking_table({"flat", "a4h600"}, options, ranking).find("the order is known; 12 patches"),
      std::string::npos);
  const std::string csv = ranking_csv({"flat", "a4h600"}, options, ranking);
  EXPECT_TRUE(csv.starts_with("finger,rank,design,title,mean(modulation),mean(modulation) low,"))
      << csv;
  EXPECT_NE(csv.find("\nclean,1,flat,"), std::string::npos) << csv;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
}

// A weight says how much a criterion counts: all on one is that one alone.
TEST(Rank, WeightsMakeTheScore) {
  const std::vector<Design> designs{quick_sample("flat"), quick_sample("a4h600")};
  RankOptions options = by("modulation:high,friction:low");
  options.max_skins = 6;
  options.weights = {1e9, 1};
  const Ranking mostly = ranking_of(designs, options);
  const Ranking alone = [&] {
    RankOptions one = by("modulation:high");
    one.max_skins = 6;
    return ranking_of(designs, one);
  }();
  EXPECT_NEAR(mostly.states[0].candidates[0].ahead_of_next.value,
              alone.states[0].candidates[0].ahead_of_next.value, 1e-6);
  options.weights = {1};
  EXPECT_THROW(ranking_of(designs, options), InputError);
  options.weights = {1, 0};
  EXPECT_THROW(ranking_of(designs, options), InputError);
}

TEST(Rank, JsonIsComplete) {
  const std::vector<Design> designs{quick_sample("flat"), quick_sample("a4h600")};
  RankOptions options = by("modulation:high,friction:low");
  options.weights = {2, 1};
  const auto json = nlohmann::json::parse(
      ranking_json({"flat", "a4h600"}, options, ranking_of(designs, options)));
  EXPECT_EQ(json["schema"], 1);
  for (const auto& c : json["candidates"]) {
    EXPECT_TRUE(c["score"]["low"].is_number());
    EXPECT_TRUE(c["p_best"].is_number());
    EXPECT_TRUE(c["metrics"]["mean(friction)"]["value"].is_number());
  }
}

}  // namespace
}  // namespace papilla::tests::rank_test
