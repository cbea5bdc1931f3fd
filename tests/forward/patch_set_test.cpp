// What a set of solved patches answers with: points, those without each skin, and measured errors.
#include "forward/patch_set.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "forward/forward.h"
#include "numerics/statistics.h"

namespace papilla::tests::patch_set_test {
namespace {

struct Solved {
  Scene scene;
  Fidelity fidelity = fidelity_level("search");
  PatchSet set;

  Solved() {
    scene.drive.amplitude = 100;
    scene.environment.relative_humidity = {0.35, 0.65};
    scene.environment.weights = {0.25, 0.75};
    fidelity.grid = 32;
    fidelity.skins = 3;
    fidelity.threads = 1;
    set = solve_patches(scene, Texture{}, fidelity);
  }
};

TEST(PatchSet, WithoutASkinIsTheAnswerOfTheOthers) {
  Solved s;
  s.set.solved.clear();  // the load law of all
  const Response all = respond(s.scene, s.fidelity, s.set);
  EXPECT_TRUE(all.driven);
  EXPECT_EQ(all.fidelity.skins, 3);
  ASSERT_EQ(all.without.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    PatchSet others = s.set;
    for (auto& skins : others.results) skins.erase(skins.begin() + static_cast<std::ptrdiff_t>(k));
    const Response rest = respond(s.scene, s.fidelity, others);
    EXPECT_EQ(rest.fidelity.skins, 2);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(all.without[k][i].weight, i == 0 ? 0.25 : 0.75);
      EXPECT_EQ(all.without[k][i].relative_humidity, i == 0 ? 0.35 : 0.65);
      for (const PointQuantity& q : kPointQuantities) {
        const double value = (rest.points[i].*q.value).value;
        EXPECT_NEAR((all.without[k][i].*q.value).value, value, 1e-12 * std::abs(value)) << k;
      }
    }
  }
}

TEST(PatchSet, WithoutASampleTheLoadLawIsThatOfTheOtherSamples) {
  Solved s;
  s.scene.model.coupling = Coupling::Equilibrium;
  s.fidelity.equilibrium_skins = 3;
  const Response all = respond(s.scene, s.fidelity, solve_patches(s.scene, Texture{}, s.fidelity));
  Fidelity last = s.fidelity;
  last.first_skin = 1;
  last.skins = last.equilibrium_skins = 2;
  const Response rest = respond(s.scene, last, solve_patches(s.scene, Texture{}, last));
  for (std::size_t i = 0; i < 2; ++i) {
    for (const PointQuantity& q : kPointQuantities) {
      const double value = (rest.points[i].*q.value).value;
      EXPECT_NEAR((all.without[0][i].*q.value).value, value, 1e-9 * std::abs(value)) << i;
    }
  }
}

// The jackknife holds what other skins scatter by, the load law's own scatter with it.
TEST(PatchSet, SkinsScatterByTheStatedErrorWhereTheLoadLawIsOfFew) {
  Solved s;
  s.scene.model.coupling = Coupling::Equilibrium;
  s.scene.drive.amplitude = 200;
  s.scene.environment.relative_humidity = {0.35};
  s.scene.environment.weights = {1};
  constexpr int kSets = 160;
  for (const auto& [skins, sampled] : {std::pair(4, 4), {6, 2}}) {
    s.fidelity.skins = skins;
    s.fidelity.equilibrium_skins = sampled;
    std::vector<double> found;
    double stated = 0, by_common_law = 0;
    for (int k = 0; k < kSets; ++k) {
      s.fidelity.first_skin = k * skins;
      PatchSet set = solve_patches(s.scene, Texture{}, s.fidelity);
      const auto variance = [&] {
        return square(respond(s.scene, s.fidelity, set).points[0].modulation.parts.sampling);
      };
      found.push_back(respond(s.scene, s.fidelity, set).points[0].modulation.value);
      stated += variance() / kSets;
      set.solved.clear();
      by_common_law += variance() / kSets;
    }
    const double scatter = square(mean_estimate(found).se) * kSets;
    // 159 degrees of freedom: the scatter is known to 11 % (one standard error). By the law of all
    // skins the stated variance is 2.8 and .6 times that.
    EXPECT_NEAR(stated / scatter, 1, 0.33) << sampled;
    EXPECT_GT(std::abs(std::log(by_common_law / scatter)), std::abs(std::log(stated / scatter)))
        << sampled;
  }
}

TEST(PatchSet, ABatchGoesOnAndCountsItsCostsFromItsFirstSkin) {
  Solved s;
  Fidelity next = s.fidelity;
  next.first_skin = 3;
  next.skins = 2;
  const PatchSet batch = solve_patches(s.scene, Texture{}, next);
  Fidelity five = s.fidelity;
  five.skins = 5;
  const PatchSet whole = solve_patches(s.scene, Texture{}, five);
  const double before = s.set.seconds;
  s.set.add(batch);
  EXPECT_DOUBLE_EQ(s.set.seconds, before + batch.seconds);
  EXPECT_EQ(s.set.skins(), 5);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 5; ++k)
      EXPECT_DOUBLE_EQ(s.set.results[i][k].area_dry, whole.results[i][k].area_dry) << k;
  }
  EXPECT_EQ(s.set.costs(3).contact_solves, batch.costs().contact_solves);
  EXPECT_DOUBLE_EQ(s.set.costs(3).fft_pairs, batch.costs().fft_pairs);
  EXPECT_EQ(s.set.costs(5).contact_solves, 0);
}

// What the law of few skins leaves open is counted with control skins as without, and where skins
// are added by the same law: it is common to those.
TEST(PatchSet, TheScatterOfTheLoadLawIsCountedWhateverElseIsMeasured) {
  Solved s;
  s.scene.model.coupling = Coupling::Equilibrium;
  s.scene.drive.amplitude = 200;
  s.fidelity.skins = 4;
  s.fidelity.equilibrium_skins = 2;
  s.fidelity.control_skins = 0;
  const auto sampling = [](const Response& r) { return r.points[1].modulation.parts.sampling; };
  PatchSet set = solve_patches(s.scene, Texture{}, s.fidelity);
  const double counted = sampling(respond(s.scene, s.fidelity, set));
  Fidelity controlled = s.fidelity;
  controlled.control_skins = 4;
  // Control skins take a per cent off the areas that their grid resolves.
  EXPECT_NEAR(sampling(evaluate(s.scene, Texture{}, controlled)), counted, 0.02 * counted);
  Fidelity more = s.fidelity;
  more.first_skin = 4, more.skins = 28;
  PatchSet both = set;
  both.add(solve_patches(s.scene, Texture{}, more, set.field, set.laws));
  const double of_more = sampling(respond(s.scene, s.fidelity, both));
  both.solved.clear();
  EXPECT_GT(of_more, 1.5 * sampling(respond(s.scene, s.fidelity, both)));
  set.solved.clear();
  EXPECT_GT(std::abs(sampling(respond(s.scene, s.fidelity, set)) / counted - 1), 0.1);
}

// Relative sizes, by humidity and quantity; costs of the controls are costs of the answer.
TEST(PatchSet, MeasuredErrorsAreSharesOfTheNumbersOfTheirHumidity) {
  Solved s;
  const Response plain = respond(s.scene, s.fidelity, s.set);
  MeasuredError grid{&ErrorParts::grid, {}}, method{&ErrorParts::method, {}};
  for (MeasuredError* e : {&grid, &method}) e->size.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t m = 0; m < kPointQuantities.size(); ++m) {
      grid.size[i][m] = 0.01 * static_cast<double>(1 + m + 20 * i);
      method.size[i][m] = 0.5;
    }
  }
  grid.costs.contact_solves = 7;
  grid.costs.fft_pairs = 11;
  grid.seconds = 100;
  method.pull_in = {{}, {Trouble::ClosedPullIn, 0, ""}};
  s.set.errors = {grid, grid, method};
  const Response r = respond(s.scene, s.fidelity, s.set);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t m = 0; m < kPointQuantities.size(); ++m) {
      const Measured& q = r.points[i].*kPointQuantities[m].value;
      EXPECT_NEAR(q.parts.grid.value(), std::sqrt(2.0) * grid.size[i][m] * std::abs(q.value),
                  1e-12 * std::abs(q.value));
      EXPECT_NEAR(q.parts.method.value(), 0.5 * std::abs(q.value), 1e-12 * std::abs(q.value));
    }
  }
  EXPECT_TRUE(r.points[0].status.sound());
  EXPECT_EQ(r.points[1].status.trouble, Trouble::ClosedPullIn);
  EXPECT_EQ(r.contact_solves, plain.contact_solves + 14);
  EXPECT_DOUBLE_EQ(r.fft_pairs, plain.fft_pairs + 22);
  EXPECT_DOUBLE_EQ(r.seconds, plain.seconds + 200);
}

}  // namespace
}  // namespace papilla::tests::patch_set_test
