// One candidate against patches that are solved here: its samples are those of all its skins at
// once, whatever the batches, and its steps half the differences between moved fingers.
#include "rank/candidate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "estimate/parameters.h"
#include "numerics/statistics.h"
#include "tests/rank/samples.h"
#include "tests/support/refusal.h"

namespace papilla::tests::candidate_test {
namespace {

void expect_near(const std::vector<double>& a, const std::vector<double>& b,
                 const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t k = 0; k < a.size(); ++k)
    EXPECT_NEAR(a[k], b[k], 1e-9 * std::abs(b[k]) + 1e-15) << what << " " << k;
}

double value_of(const Criterion& c, Response response, const std::vector<ResponsePoint>& points) {
  response.points = points;
  response.without.clear();
  return summarise(c.expression.summary, c.expression.metric, response)->value;
}

// Eq. ranking.2, of a criterion of a response.
std::vector<double> pseudo_values(const Criterion& c, const Response& r) {
  const auto n = static_cast<double>(r.without.size());
  std::vector<double> out;
  for (const auto& rest : r.without)
    out.push_back(n * value_of(c, r, r.points) - (n - 1) * value_of(c, r, rest));
  return out;
}

RankOptions in_batches(int batch) {
  RankOptions options = by("friction:low,modulation:high,variation(modulation):low");
  options.batch = batch;
  options.threads = 1;
  return options;
}

TEST(Candidate, ItsSamplesAreThePseudoValuesOfAllSkinsAtOnce) {
  Design d = small_sample("a4h600");
  d.environment.relative_humidity = {0.35, 0.75};
  const Regions regions{d};
  const RankOptions options = in_batches(2);
  for (const FingerState state : {FingerState::Clean, FingerState::Natural}) {
    Candidate candidate(regions, state, options);
    EXPECT_EQ(candidate.skins(), 0);
    for (const int skins : {2, 4}) {
      candidate.extend();
      ASSERT_EQ(candidate.skins(), skins);
      Scene scene = scene_of(d);
      scene.finger.state = state;
      Fidelity f = fidelity_of(d);
      f.skins = skins;
      f.threads = 1;
      const Response r = respond(scene, f, solve_patches(scene, d.texture, f));
      for (std::size_t c = 0; c < 3; ++c)
        expect_near(candidate.samples(c), pseudo_values(options.criteria[c], r),
                    options.criteria[c].text());
    }
  }
}

// Of seven skins three regions take the first two, the next two and the last three; of two more the
// first region none. What is measured once of a region is so by its first skins.
TEST(Candidate, RegionsTakeTheSkinsOfTheSequenceInTurn) {
  Regions regions(3, small_sample("a4h600"));
  std::get<HoleArray>(regions[1].texture.kind).depth = 300e-9;
  std::get<HoleArray>(regions[2].texture.kind).diameter = 3e-6;
  // Regions and skins of each of two steps. No region is left out by a step of fewer skins.
  using Step = std::vector<std::pair<std::size_t, int>>;
  for (const auto& [batch, steps] :
       {std::pair{7, std::vector<Step>{{{0, 3}, {1, 2}, {2, 2}}, {{1, 3}, {2, 2}, {0, 2}}}},
        {4, std::vector<Step>{{{0, 2}, {1, 1}, {2, 1}}, {{1, 2}, {2, 1}, {0, 1}}}},
        {2, std::vector<Step>{{{0, 1}, {1, 1}, {2, 1}}, {{0, 1}, {1, 1}, {2, 1}}}}}) {
    RankOptions options = by("friction:low,modulation:high");
    options.batch = batch;
    Candidate candidate(regions, FingerState::Clean, options);
    PatchSet all;
    std::vector<PatchSet> first(3);
    for (const Step& step : steps) {
      candidate.extend();
      for (const auto& [r, skins] : step) {
        Fidelity f = fidelity_of(regions[r]);
        f.first_skin = all.skins();
        f.skins = skins;
        const PatchSet more = solve_patches(scene_of(regions[r]), regions[r].texture, f,
                                            first[r].field, first[r].laws);
        if (first[r].skins() == 0) first[r] = more;
        all.skins() == 0 ? all = more : (all.add(more), all);
      }
    }
    ASSERT_EQ(all.skins(), 2 * std::max(batch, 3));
    ASSERT_EQ(candidate.skins(), all.skins());
    const Response r = respond(scene_of(regions[0]), fidelity_of(regions[0]), all);
    for (std::size_t c = 0; c < 2; ++c)
      expect_near(candidate.samples(c), pseudo_values(options.criteria[c], r),
                  options.criteria[c].text());
  }
}

// Eq. accuracy.11 of each direction of two correlated numbers: up less down, halved; a sample of
// each of the eight skins of a step.
TEST(Candidate, ItsStepsAreHalfTheDifferencesOfTheMovedFingers) {
  Design d = small_sample("flat");
  d.finger.uncertainty = {{"macro.shear_strength", 0.1, {}}, {"skin.rms", 0.2, {-0.5}}};
  const Regions regions{d};
  RankOptions options = by("friction:low,modulation:high");
  Candidate candidate(regions, FingerState::Natural, options);
  candidate.extend();
  candidate.step();
  Scene scene = scene_of(d);
  scene.finger.state = FingerState::Natural;
  const std::vector<FingerStep> steps = finger_steps(scene.finger);
  const Fidelity few = step_fidelity(fidelity_of(d));
  ASSERT_EQ(few.skins, 8);
  ASSERT_EQ(few.grid, 32);
  for (std::size_t c = 0; c < 2; ++c) {
    const StepSamples& samples = candidate.steps(c);
    ASSERT_EQ(samples.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto run = [&](const Finger& finger) {
        Scene moved = scene;
        moved.finger = finger;
        return respond(moved, few, solve_patches(moved, d.texture, few));
      };
      const Response up = run(steps[k].up), down = run(steps[k].down);
      const auto half = [&](const auto& above, const auto& below) {
        return (value_of(options.criteria[c], up, above) -
                value_of(options.criteria[c], down, below)) /
               2;
      };
      std::vector<double> without;
      for (std::size_t s = 0; s < 8; ++s) without.push_back(half(up.without[s], down.without[s]));
      expect_near(samples[k], jackknife_samples(half(up.points, down.points), without),
                  options.criteria[c].text());
    }
  }
  // Up is more shear strength on a smoother skin: more friction.
  EXPECT_GT(mean_estimate(candidate.steps(0)[0]).value, 0);
}

// No finger presses: one whose skin no file holds is looked at all the same.
TEST(Candidate, IsLookedAtWithoutAFinger) {
  Design d = small_sample("a4h600");
  d.finger.uncertainty = {{"macro.shear_strength", 0.1, {}}, {"skin.rms", 0.2, {-0.5}}};
  const Regions regions{d};
  const RankOptions felt = by("haze:low,friction:low");
  Candidate both(regions, FingerState::Clean, felt);
  both.extend();
  Design no_skin = d;
  no_skin.finger.skin.map = "nowhere.gsf";
  const Regions looked_at{no_skin};
  const RankOptions looks = by("haze:low");
  Candidate alone(looked_at, FingerState::Clean, looks);
  alone.extend();
  EXPECT_EQ(alone.skins(), both.skins());
  EXPECT_EQ(alone.samples(0), both.samples(0));
  alone.extend();
  EXPECT_EQ(alone.samples(0).size(), 2 * both.samples(0).size());
}

TEST(Candidate, SaysWhyACriterionIsNotDefinedForIt) {
  const auto refusal = [](Design d, const std::string& criterion) -> std::string {
    const Regions regions{d};
    const RankOptions options = by(criterion);
    Candidate candidate(regions, FingerState::Clean, options);
    return refusal_of([&] { candidate.extend(); });
  };
  Design d = small_sample("flat");
  d.title = "mine";
  EXPECT_EQ(refusal(d, "modulation:high"), "");
  EXPECT_EQ(refusal(d, "haze:low"), "");
  d.drive.amplitude = 0;
  EXPECT_EQ(refusal(d, "modulation:high"),
            "mean(modulation) is not defined for \"mine\": it is not driven (0 V)");
  EXPECT_EQ(refusal(d, "friction:low"), "");
  d.drive.amplitude = 100;  // driven, and none of its spread over a mean of zero
  d.finger.water.hysteresis = 0;
  EXPECT_EQ(refusal(d, "variation(retention_force):low"),
            "variation(retention_force) is not defined for \"mine\"");
}

}  // namespace
}  // namespace papilla::tests::candidate_test
