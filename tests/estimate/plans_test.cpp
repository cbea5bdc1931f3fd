// Accuracy by request: the plan that follows from the parts of a pilot by Eq. accuracy.5 and
// accuracy.6, computed here, is the one that is run.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "estimate/target.h"
#include "forward/plan.h"
#include "geometry/texture.h"
#include "metrics/metrics.h"

namespace papilla::tests::plans_test {
namespace {

Scene dry() {
  Scene scene;
  scene.environment.relative_humidity = {0.35};
  return scene;
}

struct Relative {
  double sampling, grid, method, solver;
};
Relative parts_of(const Response& r, const Metric& metric) {
  const SummaryValue v = *summarise(Summary::Mean, metric, r);
  const double of = std::abs(v.value);
  return {v.parts.sampling / of, v.parts.grid.value_or(0) / of, v.parts.method.value_or(0) / of,
          v.parts.solver.value_or(0) / of};
}
double total(const Relative& p) {
  return std::sqrt(square(p.sampling) + square(p.grid) + square(p.method) + square(p.solver));
}

struct Planned {
  int grid = 0, skins = 0;
  bool areas = false;
  double work = INFINITY;

  std::string text() const {
    return fmt::format("{} pixels, {}, {} skins", grid, areas ? "solved areas" : "load law", skins);
  }
};

// Of 64 to `largest` pixels, by the load law or solved areas: the least work whose errors are
// inside; all but sampling may take six tenths of the square of the target, at the pilot's own plan
// all of it.
Planned plan_of(const Relative& pilot, double target, int largest, int most_skins,
                double share = 0.6) {
  Planned out;
  for (int grid = 64; grid <= largest; grid *= 2) {
    for (const bool areas : {false, true}) {
      const bool own = grid == 64 && !areas;
      const double known =
          square(pilot.grid * 64 / grid) + square(areas ? 0 : pilot.method) + square(pilot.solver);
      if (known >= (own ? 1 : share) * square(target)) continue;
      const int skins = std::max(
          8, static_cast<int>(std::ceil(8 * square(pilot.sampling) / (square(target) - known))));
      if (skins > most_skins) continue;
      const double n = grid * grid;
      const double work = std::max(own ? skins - 8 : skins, 0) * (areas ? 3 : 1) * n * std::log2(n);
      if (work < out.work) out = {grid, skins, areas, work};
    }
  }
  return out;
}

std::string first_words(const std::string& step) {
  return step.substr(0, step.find(" skins: sampling") + 6);
}

// A run that can afford nothing more is its pilot.
TEST(Plans, TheCheapestInsideTheTargetIsRun) {
  for (const bool driven : {false, true}) {
    Scene scene = dry();
    if (driven) scene.drive.amplitude = 150;
    const Metric metric = driven ? kModulation : kFriction;
    const auto run = [&](double target, double seconds) {
      TargetOptions options{.target = target, .largest_grid = 128, .most_skins = 40, .threads = 1};
      options.most_seconds = seconds;
      return evaluate_to_target(scene, Texture{}, options);
    };
    const double reached = run(10, 0).accuracy.reached;
    std::string plans;
    for (const double share : {0.97, 0.8}) {
      const double target = share * reached;
      const Response pilot = run(target, 1e-9), r = run(target, 0);
      ASSERT_EQ(pilot.accuracy.steps.size(), 1u);
      const Relative parts = parts_of(pilot, metric);
      EXPECT_EQ(pilot.accuracy.end, TargetEnd::TimeSpent);
      EXPECT_NEAR(pilot.accuracy.reached, total(parts), 1e-12);
      EXPECT_EQ(pilot.accuracy.quantity, fmt::format("mean({})", metric_text(metric)));
      const Planned plan = plan_of(parts, target, 128, 40);
      ASSERT_LT(plan.work, INFINITY) << share;
      ASSERT_GT(r.accuracy.steps.size(), 1u);
      EXPECT_EQ(r.accuracy.steps[0], pilot.accuracy.steps[0]);
      EXPECT_EQ(first_words(r.accuracy.steps[0]), "pilot: 64 pixels, load law, 8 skins");
      if (plan.grid != 64 || plan.areas) {
        EXPECT_EQ(first_words(r.accuracy.steps[1]), "planned: " + plan.text());
      } else {
        const int more = std::min(8, std::max(plan.skins - 8, 2));
        EXPECT_EQ(first_words(r.accuracy.steps[1]),
                  fmt::format("more skins: 64 pixels, load law, {} skins", 8 + more));
      }
      plans += first_words(r.accuracy.steps[1]) + "; ";
      const Relative last = parts_of(r, metric);
      EXPECT_NEAR(r.accuracy.reached, total(last), 1e-12);
      if (r.accuracy.end == TargetEnd::Reached) {
        EXPECT_LE(r.accuracy.reached, target);
        const std::string& step = r.accuracy.steps.back();
        EXPECT_EQ(step.substr(step.find(" skins: sampling")),
                  fmt::format(" skins: sampling {:.2f} %, grid {:.2f} %, method {:.2f} %, solver "
                              "{:.2f} %",
                              100 * last.sampling, 100 * last.grid, 100 * last.method,
                              100 * last.solver));
      }
    }
    EXPECT_NE(plans.find("planned: "), std::string::npos);
  }
}

// A target that no plan reaches asks for the cheapest within a tenth of the least error that the
// limits leave: of all grids and both estimators with all the skins there may be.
TEST(Plans, OutOfReachTheCheapestNextToTheLeastErrorIsRun) {
  const Scene scene = dry();
  TargetOptions options{.target = 0.002, .largest_grid = 128, .most_skins = 11, .threads = 1};
  options.most_seconds = 1e-9;
  const Relative parts = parts_of(evaluate_to_target(scene, Texture{}, options), kFriction);
  double least = INFINITY;
  for (const double finer : {1.0, 0.5}) {
    for (const double method : {parts.method, 0.0})
      least = std::min(least, square(parts.grid * finer) + square(method) + square(parts.solver) +
                                  8 * square(parts.sampling) / 11);
  }
  const double reachable = 1.1 * std::sqrt(least);
  ASSERT_GT(reachable, options.target);
  const Planned plan = plan_of(parts, reachable, 128, 11, 1);
  ASSERT_LT(plan.work, INFINITY);
  options.most_seconds = 0;
  const Response r = evaluate_to_target(scene, Texture{}, options);
  EXPECT_EQ(r.accuracy.end, TargetEnd::LimitsReached);
  ASSERT_GT(r.accuracy.steps.size(), 1u);
  EXPECT_EQ(first_words(r.accuracy.steps[1]), "planned: " + plan.text());
}

// What was spent on the pilot with its controls and what the plan costs by itself decide whether it
// can be afforded, on any machine alike.
TEST(Plans, ATimeThatIsEnoughForThePlanIsEnough) {
  const Scene scene = dry();
  TargetOptions options{.target = 0, .largest_grid = 128, .most_skins = 40, .threads = 1};
  options.target = 10;
  options.target = 0.8 * evaluate_to_target(scene, Texture{}, options).accuracy.reached;
  options.most_seconds = 1e-9;
  const Relative parts = parts_of(evaluate_to_target(scene, Texture{}, options), kFriction);
  const Planned plan = plan_of(parts, options.target, 128, 40);
  ASSERT_FALSE(plan.grid == 64 && !plan.areas);  // a plan of its own, controls and all
  Fidelity f = pilot_fidelity(options);
  double seconds = make_plan(scene, Texture{}, f).seconds();
  f.grid = plan.grid;
  f.skins = plan.skins;
  f.estimator = plan.areas ? Estimator::Area : Estimator::Load;
  seconds += make_plan(scene, Texture{}, f).seconds();
  options.most_seconds = 1.001 * seconds;
  const std::vector<std::string> enough =
      evaluate_to_target(scene, Texture{}, options).accuracy.steps;
  ASSERT_GT(enough.size(), 1u);
  EXPECT_EQ(first_words(enough[1]), "planned: " + plan.text());
  options.most_seconds = 0.999 * seconds;
  const std::vector<std::string> less =
      evaluate_to_target(scene, Texture{}, options).accuracy.steps;
  EXPECT_TRUE(less.size() == 1 || first_words(less[1]) != "planned: " + plan.text());
}

// Of skins from the sixth on: those that are added follow them.
TEST(Plans, SkinsThatAreAddedFollowTheFirst) {
  Scene scene = dry();
  scene.finger.skin.cutoff = 1.5e-6;  // resolved by the pilot: the scatter is what is left
  TargetOptions options{.target = 10, .largest_grid = 64, .most_skins = 40, .first_skin = 5};
  options.threads = 1;
  // The tolerance of the contact follows the target: the pilot's error at nearly the one to come.
  options.most_seconds = 1e-9;
  for (int k = 0; k < 2; ++k)
    options.target = 0.93 * evaluate_to_target(scene, Texture{}, options).accuracy.reached;
  options.most_seconds = 0;
  const Response r = evaluate_to_target(scene, Texture{}, options);
  ASSERT_GT(r.accuracy.steps.size(), 1u);
  EXPECT_TRUE(r.accuracy.steps[1].starts_with("more skins: 64 pixels, load law"))
      << r.accuracy.steps[1];
  Fidelity f = r.fidelity;
  EXPECT_EQ(f.grid, 64);
  f.first_skin = 5;
  f.control_skins = 0;
  f.skins = static_cast<int>(r.points[0].samples.load_off.size());
  EXPECT_GT(f.skins, 8);
  EXPECT_EQ(r.points[0].samples.load_off, evaluate(scene, Texture{}, f).points[0].samples.load_off);
}

// What a run costs is what its steps cost: of a pilot the patches and their controls.
TEST(Plans, CostsAreThoseOfAllSteps) {
  const TargetOptions options{.target = 10, .largest_grid = 64, .most_skins = 8, .threads = 1};
  const Scene scene = dry();
  const Response pilot = evaluate_to_target(scene, Texture{}, options);
  const Response plain = evaluate(scene, Texture{}, pilot_fidelity(options));
  EXPECT_EQ(pilot.contact_solves, plain.contact_solves);
  EXPECT_EQ(pilot.fft_pairs, plain.fft_pairs);
  EXPECT_EQ(pilot.points, plain.points);
  EXPECT_GT(pilot.seconds, 0);
  EXPECT_EQ(pilot.accuracy.target, 10);
}

}  // namespace
}  // namespace papilla::tests::plans_test
