// A study of a finger with a pen beside it: what is of which, and what is refused.
#include <gtest/gtest.h>

#include "config/reader.h"
#include "forward/forward.h"
#include "search/levels.h"
#include "search/problem.h"
#include "search/task.h"
#include "tests/search/small_study.h"
#include "tests/support/refusal.h"

namespace papilla::tests::pen_test {
namespace {

Pin polymer() {
  Pin pin{.name = "pen"};
  pin.load = 1;
  pin.modulus = 3e9;
  pin.radius = 0.7e-3;
  pin.shear_strength = 20e6;
  pin.conducting = false;
  pin.roughness = {.rms = 0.1e-6, .longest = 12e-6, .roll_off = 4e-6, .cutoff = 0.3e-6};
  return pin;
}

Study with_pen() {
  Study study = small_study();
  study.design.counterface.pen = polymer();
  study.objective.maximise = {parse_metric("mean(modulation)")};
  study.objective.minimise = {parse_metric("mean(pen.friction)")};
  study.objective.targets.clear();
  study.constraints = {read_constraint("worst(pen.friction)", 0.5)};
  return study;
}

Fidelity few(const StudyProblem& problem) {
  Fidelity f = stage_fidelity(problem, Stage::Search, 0);
  f.skins = 2;
  return f;
}

TEST(PenStudy, ThePenHasNumbersOfItsOwn) {
  const Study study = with_pen();
  const StudyProblem problem(study);
  ASSERT_TRUE(problem.goals().pen);
  const Fidelity fidelity = few(problem);
  const TaskAnswer answer = evaluate_task(problem, study.design, 0, {fidelity});
  ASSERT_TRUE(answer.status.ok()) << answer.status.text;
  const Design pen = under_pen(study.design);
  const Response alone = evaluate_for(problem.goals(), scene_of(pen), pen.texture, fidelity);
  const Response finger =
      evaluate_for(problem.goals(), scene_of(study.design), study.design.texture, fidelity);
  ASSERT_EQ(answer.objectives.size(), 2u);
  EXPECT_EQ(answer.objectives[0].value, summarise(Summary::Mean, kModulation, finger)->value);
  EXPECT_EQ(answer.objectives[1].value, summarise(Summary::Mean, kFriction, alone)->value);
  EXPECT_EQ(answer.limited.at(0), summarise(Summary::Worst, kFriction, alone)->value);
  EXPECT_NE(answer.objectives[1].value, summarise(Summary::Mean, kFriction, finger)->value);
  // A film that the pen breaks down is broken under the finger, too.
  Response broken = alone;
  broken.points.back().oxide_margin = 0.5;
  const TaskAnswer refused = answer_of(problem.goals(), study.design, "nominal", {finger, broken});
  EXPECT_EQ(refused.status.kind, TaskStatus::Kind::NoEquilibrium);
  EXPECT_TRUE(refused.status.text.starts_with("nominal, pen, ")) << refused.status.text;
}

// A limit on the pen is none on the finger.
TEST(PenStudy, ItsExpressionsReadBackAsWritten) {
  const MetricExpression e = parse_metric("worst(pen.friction)");
  EXPECT_TRUE(e.pen);
  EXPECT_EQ(metric_text(e), "worst(pen.friction)");
  EXPECT_EQ(parse_metric(metric_text(e)), e);
  EXPECT_EQ(metric_text(parse_metric("pen.friction")), "mean(pen.friction)");
  EXPECT_FALSE(e == parse_metric("worst(friction)"));
  EXPECT_NE(refusal_of([] { parse_own_metric("pen.friction"); }).find("one counterface"),
            std::string::npos);
}

TEST(PenStudy, WhatCannotBeAskedOfItIsRefused) {
  const auto refused = [](const std::string& metric, bool described = true) {
    Study study = with_pen();
    if (!described) study.design.counterface = {};
    study.objective.minimise = {parse_metric(metric)};
    return refusal_of([&] { StudyProblem problem(study); });
  };
  EXPECT_NE(refused("mean(pen.friction)", false).find("[counterface.pen]"), std::string::npos);
  EXPECT_NE(refused("mean(pen.modulation)").find("does not conduct"), std::string::npos);
  EXPECT_NE(refused("pen.haze").find("not asked of a pen"), std::string::npos);
}

TEST(PenStudy, APinStandsInPlaceOfFingers) {
  Study study = with_pen();
  study.design.counterface.type = CounterfaceType::Pen;
  study.population = {Finger{}};
  EXPECT_NE(refusal_of([&] { study_tasks(study); }).find("population"), std::string::npos);
  study.population.clear();
  EXPECT_EQ(study_tasks(study).front().name, "pen");
}

}  // namespace
}  // namespace papilla::tests::pen_test
