#include "estimate/belief.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/constants.h"
#include "base/error.h"
#include "design/design.h"
#include "estimate/difference.h"
#include "estimate/evaluation.h"
#include "report/response.h"
#include "tests/temporary.h"

namespace papilla::tests::belief_test {
namespace {

std::string write(const std::string& name, const std::string& text) {
  const std::string path = temporary(name);
  std::ofstream(path) << text;
  return path;
}

// Shear strengths of 9 MPa times .8, 1, 1.2 with weights 1, 2, 1: 14 % in the root mean square.
std::string shear_belief() {
  return write("shear.toml", R"(schema_version = 1
[[member]]
weight = 0.25
hypothesis = "weak"
set = { "macro.shear_strength" = "7.2 MPa" }
[[member]]
weight = 0.5
hypothesis = "as fitted"
set = { "macro.shear_strength" = "9 MPa" }
[[member]]
weight = 0.25
hypothesis = "strong"
set = { "macro.shear_strength" = "10.8 MPa" }
)");
}

Design small_design() {
  Design d = read_design(find_design("m3_samples/flat.toml"));
  d.finger.water.hysteresis = 0;  // friction is proportional to the shear strength
  d.environment.relative_humidity = {0.35, 0.65};
  d.environment.weights.clear();
  return d;
}

Fidelity small_fidelity(int threads = 2) {
  Fidelity f = fidelity_level("draft");
  f.grid = 32;
  f.skins = 3;
  f.control_skins = f.field_skins = 0;
  f.threads = threads;
  return f;
}

Response small_response(const Design& d, int threads = 2) {
  Response r = evaluate(scene_of(d), d.texture, small_fidelity(threads));
  add_belief(r, scene_of(d), d.texture, small_fidelity(threads));
  return r;
}

EvaluationOptions asked(bool model, bool parameters) {
  EvaluationOptions out;
  out.model = model;
  out.parameters = parameters;
  out.threads = 2;
  return out;
}

// What is priced is what is run: members by the options that the finger was fitted with, else the
// steps of its fit, else nothing.
TEST(BeliefParts, ArePricedAsTheyAreRun) {
  Design d = small_design();
  d.finger.belief = shear_belief();
  const auto cost = [&] { return model_cost(scene_of(d), small_fidelity()); };
  EXPECT_EQ(cost().members, 3);
  EXPECT_EQ(cost().runs, 4);
  EXPECT_EQ(cost().fidelity, belief_fidelity(small_fidelity()));
  d.model.closure = Closure::Persson;
  d.finger.uncertainty.clear();
  EXPECT_EQ(cost().members, 0);
  EXPECT_EQ(cost().runs, 0);
  d.finger.uncertainty = {{"macro.shear_strength", 0.05, {}}};
  EXPECT_EQ(cost().members, 0);
  EXPECT_EQ(cost().runs, 2);
}

// Of 64 members three are run: sixteen times as much as four of four, or thereabouts.
TEST(BeliefParts, TheirAnnouncedTimeCountsTheMembersThatAreNotRun) {
  const auto belief = [](int members) {
    std::string text = "schema_version = 1\n";
    for (int k = 0; k < members; ++k)
      text += fmt::format(
          "[[member]]\nweight = {}\nset = {{ \"macro.shear_strength\" = \"{} MPa\" }}\n",
          1.0 / members, 8 + 2.0 * k / members);
    return write(fmt::format("members_{}.toml", members), text);
  };
  Design d = small_design();
  const auto seconds = [&](const std::string& file) {
    d.finger.belief = file;
    return measured_belief_seconds(scene_of(d), d.texture, small_fidelity());
  };
  seconds(belief(4));  // tables and transforms of the first run
  const double few = seconds(belief(4)), many = seconds(belief(64));
  EXPECT_GT(few, 0);
  EXPECT_GT(many, 5 * few);
  EXPECT_LT(many, 40 * few);
  EXPECT_EQ(seconds(""), 0);
}

TEST(BeliefParts, OfTheShearStrengthAreItsOwnAndTheModulationsNone) {
  Design d = small_design();
  d.finger.belief = shear_belief();
  const Response r = small_response(d);
  ASSERT_EQ(r.belief.members.size(), 3u);
  EXPECT_NEAR(r.belief.effective(), 1 / (2 * 0.0625 + 0.25), 1e-12);
  for (std::size_t i = 0; i < r.points.size(); ++i) {
    const ResponsePoint& p = r.points[i];
    EXPECT_NEAR(*p.friction_off.parts.model / p.friction_off.value, std::sqrt(0.5) * 0.2, 1e-9);
    EXPECT_LT(*p.modulation.parts.model, 1e-12);
    EXPECT_FALSE(p.friction_off.parts.parameters);
    // Of its runs what is felt takes the response's error of the modulation.
    EXPECT_NEAR(r.belief.own.points[i].felt_error.value(),
                p.modulation.parts.numerical() / (1 + p.modulation.value), 1e-12);
    EXPECT_EQ(r.belief.members[0].run.without.at(0)[i].felt_error,
              r.belief.own.points[i].felt_error);
    const auto over = *belief_values_at(i, kFriction, r);
    EXPECT_NEAR(over.values[0], 0.8 * p.friction_off.value, 1e-9 * p.friction_off.value);
  }
  // Whatever the value and the deviation, which is about the members' own mean, are: the median.
  const BeliefValues friction = *belief_values_at(0, kFriction, r);
  const std::string table = response_table(r),
                    said =
                        fmt::format("; {:.1f} [{:.1f}, {:.1f}]", 1e3 * friction.quantile(0.5),
                                    1e3 * friction.quantile(0.025), 1e3 * friction.quantile(0.975));
  EXPECT_NE(table.find("± model; median [95 %]"), std::string::npos) << table;
  EXPECT_NE(table.find(said), std::string::npos) << said << table;
  EXPECT_NE(response_json(r).find("\"model_median\""), std::string::npos);
  EXPECT_NE(response_json(r).find("\"effective_members\""), std::string::npos);
}

TEST(BeliefParts, AreTheSameForAnyNumberOfThreads) {
  Design d = small_design();
  d.finger.belief = shear_belief();
  EXPECT_EQ(response_json(small_response(d, 1), false), response_json(small_response(d, 2), false));
}

TEST(BeliefParts, OfADifferenceOfIdenticalDesignsAreNone) {
  Design d = small_design();
  d.finger.belief = shear_belief();
  const Response a = small_response(d), b = small_response(d);
  const ResponseDifference same = difference_of({Summary::Mean, kFriction}, a, b);
  ASSERT_TRUE(same.model);
  EXPECT_EQ(same.model->deviation, 0);
  EXPECT_EQ(same.model->above, 0.5);
  // A surface of twice the contact angle rubs otherwise; belief scales both frictions alike.
  Design other = d;
  other.surface.contact_angle *= 2;
  const Response c = small_response(other);
  const ResponseDifference apart = difference_of({Summary::Mean, kFriction}, a, c);
  EXPECT_NEAR(apart.model->deviation, std::sqrt(0.5) * 0.2 * std::abs(apart.value),
              1e-9 * std::abs(apart.value));
}

TEST(BeliefParts, AreInThePlaceOfTheCovariancesWhereBothAreKnown) {
  Design d = small_design();
  d.finger.belief.clear();  // of the shipped finger
  d.finger.uncertainty = {{"macro.shear_strength", 0.05, {}}};
  d.accuracy.level = AccuracyLevel::Draft;
  d.accuracy.grid = 32;
  const Response by_fit = evaluate_design(d, asked(true, true));
  EXPECT_TRUE(by_fit.points[0].friction_off.parts.parameters);
  EXPECT_FALSE(by_fit.points[0].friction_off.parts.model);
  EXPECT_NE(response_table(by_fit).find("names no belief"), std::string::npos);
  d.finger.belief = shear_belief();
  const Response by_belief = evaluate_design(d, asked(true, true));
  EXPECT_FALSE(by_belief.points[0].friction_off.parts.parameters);
  EXPECT_TRUE(by_belief.points[0].friction_off.parts.model);
  const Response without = evaluate_design(d, asked(false, false));
  EXPECT_FALSE(without.points[0].friction_off.parts.model);
  EXPECT_TRUE(without.belief.absent.empty());
  EXPECT_EQ(without.points[0].friction_off.se(), by_belief.points[0].friction_off.se());
}

TEST(BeliefParts, OfOtherModelOptionsAreNotStated) {
  Design d = small_design();
  d.finger.belief = shear_belief();
  d.model.air_limit = AirLimit::Emission;
  const Response r = small_response(d);
  EXPECT_TRUE(r.belief.members.empty());
  EXPECT_FALSE(r.points[0].friction_off.parts.model);
  EXPECT_NE(r.belief.absent.find("other model options"), std::string::npos);
}

// A choice of the model is a member too: the pull under a cap where air breaks down.
TEST(BeliefParts, HoldChoicesOfTheModel) {
  Design d = small_design();
  d.finger.belief = write("cap.toml", R"(schema_version = 1
[[member]]
weight = 0.5
hypothesis = "no cap"
[[member]]
weight = 0.5
hypothesis = "cap"
set = { "model.air_limit" = "emission" }
)");
  const Response r = small_response(d);
  Design capped = d;
  capped.model.air_limit = AirLimit::Emission;
  const Fidelity few = belief_fidelity(small_fidelity());
  const auto pull = [&](const Design& of) {
    return respond(scene_of(of), few, solve_patches(scene_of(of), of.texture, few))
        .points[0]
        .electrostatic_force.value;
  };
  const auto over = *belief_values_at(0, QuantityMetric{&PointQuantities::electrostatic_force}, r);
  EXPECT_NEAR(over.values[1] / over.values[0], pull(capped) / pull(d), 1e-9);
  EXPECT_LT(over.values[1], 0.9 * over.values[0]);
}

}  // namespace
}  // namespace papilla::tests::belief_test
