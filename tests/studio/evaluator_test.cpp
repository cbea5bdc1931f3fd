// The evaluator by itself: what it tells of a wish, step by step, and what of pinned designs.
#include "studio/evaluator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "config/describe.h"
#include "estimate/difference.h"
#include "estimate/evaluation.h"
#include "forward/forward.h"
#include "geometry/io/files.h"
#include "metrics/metrics.h"
#include "tests/temporary.h"

namespace papilla::tests::evaluator_test {
namespace {

// What was told, in its order.
class Told {
 public:
  Listener listener() {
    Listener out;
    out.answer = [this](const Answer& a) { add([&] { answers.push_back(a); }); };
    out.shape = [this](std::uint64_t revision, const Design&) {
      add([&] { shapes.push_back(revision); });
    };
    out.look = [this](std::uint64_t revision, const Design&) {
      add([&] { looks.push_back(revision); });
    };
    out.refining = [this](std::uint64_t, const std::string& what, double share) {
      add([&] { refined.push_back(what + (share == 1 ? "done" : "")); });
    };
    out.slopes = [this](std::uint64_t, const std::vector<Slope>& known) {
      add([&] { slopes = known; });
    };
    out.failed = [this](std::uint64_t, const std::string& why) {
      add([&] { failures.push_back(why); });
    };
    return out;
  }
  void wait(const std::function<bool()>& until) {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(news_.wait_for(lock, std::chrono::minutes(10),
                               [&] { return until() || !failures.empty(); }));
  }

  // Also after a failure.
  bool holds(const std::function<bool()>& what) {
    const std::lock_guard lock(mutex_);
    return what();
  }

  std::vector<Answer> answers;
  std::vector<std::uint64_t> shapes, looks;
  std::vector<std::string> refined, failures;
  std::vector<Slope> slopes;

 private:
  void add(const std::function<void()>& change) {
    const std::lock_guard lock(mutex_);
    change();
    news_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable news_;
};

Design quick_design() {
  Design out = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml");
  out.environment.relative_humidity = {0.35};
  out.accuracy.grid = 32;                                     // of the finest step
  for (double& volume : out.finger.water.volume) volume = 0;  // dry: quicker
  out.accuracy.seed = 3;
  return out;
}

// It is drawn and looked at; no droplet of it is settled.
TEST(Evaluator, TellsWhyADesignHasNoAnswer) {
  Design wet = quick_design();
  wet.finger.water = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml").finger.water;
  wet.finger.water.drops_per_um3 = 1e5;
  wet.environment.relative_humidity = {0.75};
  Told told;
  {
    Evaluator evaluator(told.listener());
    evaluator.wish({1, wet, {}});
    const auto is_told = [&] { return !told.shapes.empty() && !told.refined.empty(); };
    for (int i = 0; i < 600 && !told.holds(is_told); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_TRUE(told.answers.empty());
  EXPECT_EQ(told.shapes, (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(told.looks, (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(told.refined, (std::vector<std::string>{"done"}));
  ASSERT_EQ(told.failures.size(), 1u);
  EXPECT_TRUE(told.failures[0].starts_with("finger.water.drops_per_um3: 1e+05 makes"))
      << told.failures[0];
}

// Two drafts a number, where they are asked for.
TEST(Evaluator, TellsWhatEachNumberDoes) {
  Told told;
  const Design design = quick_design();
  const auto slope_of = [&](const std::string& path) {
    return std::find_if(told.slopes.begin(), told.slopes.end(),
                        [&](const Slope& s) { return s.path == path; });
  };
  Evaluator evaluator(told.listener());
  evaluator.wish({1, design, {}});
  told.wait([&] { return !told.refined.empty() && told.refined.back() == "done"; });
  EXPECT_TRUE(told.slopes.empty());
  evaluator.want_slopes(true);
  told.wait([&] { return slope_of("drive.amplitude") != told.slopes.end(); });
  ASSERT_TRUE(told.failures.empty());
  for (const char* path : {"texture.period", "texture.diameter", "texture.depth",
                           "surface.contact_angle", "surface.dielectric.0.thickness"})
    ASSERT_NE(slope_of(path), told.slopes.end()) << path;
  const Slope& depth = *slope_of("texture.depth");
  EXPECT_NEAR(depth.down, 0.95 * 600e-9, 1e-12);
  EXPECT_NEAR(depth.up, 1.05 * 600e-9, 1e-12);
  Fidelity draft = fidelity_level("draft");
  draft.seed = 3;
  const auto at = [&](double value) {
    Design moved = design;
    set_number(moved, "texture.depth", value);
    return evaluate(scene_of(moved), moved.texture, draft);
  };
  const Response down = at(depth.down), up = at(depth.up);
  ASSERT_EQ(depth.changes.size(), 2u);
  EXPECT_EQ(depth.changes[0].metric, "mean(modulation)");
  EXPECT_NEAR(depth.changes[0].value,
              summarise(Summary::Mean, kModulation, up)->value -
                  summarise(Summary::Mean, kModulation, down)->value,
              1e-12);
  EXPECT_GT(depth.changes[0].error, 0);
  EXPECT_EQ(depth.changes[1].metric, "variation(modulation)");
  // What is known is told again at once.
  told.slopes.clear();
  evaluator.want_slopes(false);
  evaluator.want_slopes(true);
  told.wait([&] { return slope_of("drive.amplitude") != told.slopes.end(); });
}

// First at once, then draft and design; pinned designs after the one at hand at each step.
TEST(Evaluator, RefinesWhatIsAtHandAndThenWhatIsPinned) {
  Told told;
  const Design design = quick_design();
  Design pinned = design;
  set_number(pinned, "texture.depth", 500e-9);
  const auto from = std::chrono::steady_clock::now();
  {
    Evaluator evaluator(told.listener());
    Wish wish{11, design, {{4, pinned}}};
    wish.design.title = "a title says nothing";
    evaluator.wish(wish);
    told.wait([&] { return !told.refined.empty() && told.refined.back() == "done"; });
  }
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  EXPECT_TRUE(told.failures.empty());
  EXPECT_EQ(told.shapes, std::vector<std::uint64_t>{11});
  EXPECT_EQ(told.looks, std::vector<std::uint64_t>{11});
  EXPECT_EQ(told.refined, (std::vector<std::string>{"draft", "pinned design, draft", "design",
                                                    "pinned design, design", "done"}));
  // The answer of each step, and again once the pinned one is known at it.
  ASSERT_EQ(told.answers.size(), 5u);
  const Step steps[] = {Step::First, Step::Draft, Step::Draft, Step::Design, Step::Design};
  const Scene scene = scene_of(design);
  Fidelity draft = fidelity_level("draft"), finest = fidelity_level("design");
  draft.seed = finest.seed = 3;
  finest.grid = 32;
  for (std::size_t i = 0; i < 5; ++i) {
    const Answer& a = told.answers[i];
    EXPECT_EQ(a.revision, 11u);
    EXPECT_EQ(a.step, steps[i]) << i;
    EXPECT_GT(a.seconds, i == 0 ? 0 : told.answers[i - 1].seconds) << i;  // from the wish on
    EXPECT_LE(a.seconds, elapsed) << i;
    EXPECT_EQ(a.pinned.size(), i < 2 ? 0u : 1u) << i;
    EXPECT_EQ(a.comparisons.empty(), i % 2 == 1 || i == 0) << i;
    const Fidelity& f = a.response.fidelity;
    const Fidelity& as = i == 0 ? quick_fidelity(design) : i < 3 ? draft : finest;
    EXPECT_EQ(f.grid, as.grid) << i;
    EXPECT_EQ(f.skins, as.skins) << i;
    EXPECT_EQ(f.seed, 3u) << i;
  }
  // Nothing is refined before the hand has been still for 350 ms.
  EXPECT_GE(told.answers[1].seconds, told.answers[0].seconds + 0.35);
  // Compared at one step: the one at hand less the pinned one, their errors paired.
  const Answer& last = told.answers[4];
  const Response &ours = last.response, &theirs = last.pinned.at(4);
  ASSERT_EQ(last.comparisons.size(), 4u);
  const char* metrics[] = {"mean(modulation)", "worst(modulation)", "variation(modulation)",
                           "mean(friction)"};
  for (std::size_t k = 0; k < 4; ++k) {
    const Comparison& c = last.comparisons[k];
    EXPECT_EQ(c.pin, 4);
    EXPECT_EQ(c.metric, metrics[k]);
    const MetricExpression e = parse_metric(c.metric);
    const double a = summarise(e.summary, e.metric, ours)->value,
                 b = summarise(e.summary, e.metric, theirs)->value;
    EXPECT_NEAR(c.difference, a - b, 1e-12) << c.metric;
    const auto error = difference_error(error_samples(e.summary, e.metric, ours),
                                        error_samples(e.summary, e.metric, theirs));
    ASSERT_EQ(c.error.has_value(), error.has_value());
    EXPECT_NEAR(c.error.value_or(0), error.value_or(0), 1e-12) << c.metric;
    // What belief leaves of the difference stands beside it, in no part of that.
    const auto model = difference_of(e, theirs, ours).model;
    ASSERT_TRUE(model && c.model) << c.metric;
    EXPECT_EQ(*c.model, model->deviation) << c.metric;
  }
}

// Its level, its pixels and skins, members of belief on these; a pinned design at the same,
// whatever its own file asks for.
TEST(Evaluator, EndsAtTheAccuracyOfTheDesignAndItsPins) {
  Told told;
  Design design = quick_design();
  design.accuracy.level =
      read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml", {"accuracy.level=draft"})
          .accuracy.level;
  Design pinned = design;
  pinned.accuracy.seed = 9;
  set_number(pinned, "texture.depth", 500e-9);
  {
    Evaluator evaluator(told.listener());
    evaluator.wish({1, design, {{4, pinned}}});
    told.wait([&] { return !told.refined.empty() && told.refined.back() == "done"; });
  }
  ASSERT_TRUE(told.failures.empty());
  const Response asked = evaluate_design(design), &last = told.answers.back().response;
  EXPECT_EQ(last.points, asked.points);
  EXPECT_EQ(last.fidelity.level, "draft");
  EXPECT_EQ(last.belief.grid, asked.belief.grid);
  EXPECT_EQ(told.answers.back().pinned.at(4).fidelity, last.fidelity);
  // The film's margin under a bridge is there from the first answer on.
  const double margin = told.answers.front().response.points.at(0).bridged_margin;
  EXPECT_EQ(told.answers.front().step, Step::First);
  EXPECT_LT(margin, last.points.at(0).oxide_margin);
  EXPECT_EQ(margin, last.points.at(0).bridged_margin);
}

// A target chooses pixels, skins and estimator design by design: pins take those of the design at
// hand, or nothing would tell the two apart. The pinned one alone would need more of them.
TEST(Evaluator, ComparesPinsAtTheAccuracyThatATargetChose) {
  Told told;
  Design design = quick_design();
  design.finger.belief.clear();
  set_number(design, "texture.depth", 150e-9);
  design.accuracy.target = 0.045;
  Design pinned = design;
  set_number(pinned, "texture.depth", 600e-9);
  {
    Evaluator evaluator(told.listener());
    evaluator.wish({1, design, {{4, pinned}}});
    told.wait([&] { return !told.refined.empty() && told.refined.back() == "done"; });
  }
  ASSERT_TRUE(told.failures.empty());
  const Answer& last = told.answers.back();
  EXPECT_EQ(last.step, Step::Design);
  EXPECT_EQ(last.response.points, evaluate_design(design).points);
  EXPECT_EQ(last.pinned.at(4).fidelity, last.response.fidelity);
  EXPECT_NE(evaluate_design(pinned).fidelity, last.response.fidelity);
  ASSERT_EQ(last.comparisons.size(), 4u);
  EXPECT_TRUE(last.comparisons[0].error);
  EXPECT_TRUE(last.comparisons[3].error);
}

// By the ratio and the load laws of the design that was refined last; a pinned design beside it by
// the same.
TEST(Evaluator, CarriesAnAnswerByTheDesignThatWasRefinedLast) {
  Told told;
  const Design at = quick_design();
  Design pinned = at, away = at;
  set_number(pinned, "texture.depth", 500e-9);
  set_number(away, "texture.depth", 550e-9);
  const auto last_is = [&](std::uint64_t revision, Step step) {
    return !told.answers.empty() && told.answers.back().revision == revision &&
           told.answers.back().step == step;
  };
  Answer refined, first;
  {
    Evaluator evaluator(told.listener());
    evaluator.wish({1, at, {{4, pinned}}});
    told.wait([&] { return !told.refined.empty() && told.refined.back() == "done"; });
    refined = told.answers.back();
    evaluator.wish({2, away, {{4, pinned}}});
    told.wait([&] { return last_is(2, Step::First); });
    first = told.answers.back();
  }
  ASSERT_TRUE(told.failures.empty());
  const Anchor anchor = anchor_of(at, refined.response);
  const Response quick = quick_answer(away, &anchor), theirs = quick_answer(pinned, &anchor),
                 expected = first_answer(quick, away, &anchor);
  EXPECT_EQ(first.response.points, expected.points);
  EXPECT_NE(expected.points[0].modulation, quick.points[0].modulation);
  EXPECT_EQ(first.pinned.at(4).points, refined.pinned.at(4).points);  // the finest that is known
  ASSERT_EQ(first.comparisons.size(), 4u);
  const Comparison& mean = first.comparisons[0];
  EXPECT_NEAR(
      mean.difference,
      summarise(Summary::Mean, kModulation, expected)->value -
          summarise(Summary::Mean, kModulation, first_answer(theirs, pinned, &anchor))->value,
      1e-12);
  EXPECT_FALSE(mean.model);  // a first answer runs no members
  EXPECT_GE(*mean.error, difference_drift(theirs, quick) *
                             std::abs(expected.points[0].modulation.value) * (1 - 1e-12));
}

// The first answer is that of the quick level, carried by nothing yet; the shape is told where it
// is another.
TEST(Evaluator, AnswersEachWishAtOnce) {
  const Design design = quick_design();
  Design other = design, deeper = design;
  set_number(other, "drive.amplitude", 50);
  set_number(deeper, "texture.depth", 300e-9);
  const Response expected = first_answer(
      evaluate(scene_of(design), design.texture, quick_fidelity(design)), design, nullptr);
  Told told;
  {
    Evaluator evaluator(told.listener());
    std::uint64_t revision = 0;
    for (const Design& wanted : {design, other, deeper}) {
      evaluator.wish({++revision, wanted, {}});
      told.wait([&] {
        return !told.answers.empty() && told.answers.back().revision == revision &&
               told.shapes.size() == (revision < 3 ? 1u : 2u);
      });
    }
  }
  EXPECT_EQ(told.shapes, (std::vector<std::uint64_t>{1, 3}));
  ASSERT_GE(told.answers.size(), 3u);
  const Answer& first = told.answers[0];
  EXPECT_EQ(first.revision, 1u);
  EXPECT_EQ(first.step, Step::First);
  for (const auto member : {&PointQuantities::friction_off, &PointQuantities::friction_on,
                            &PointQuantities::modulation}) {
    const double value = (expected.points.at(0).*member).value;
    EXPECT_NEAR((first.response.points.at(0).*member).value, value, 1e-9 * std::abs(value));
  }
}

// A map that is written anew under its name is another surface, though the design says the same.
TEST(Evaluator, AnswersAnewForAMapThatWasWrittenAnew) {
  const std::string file = temporary("anew.npy");
  const auto write = [&](double depth) {
    const Grid grid{64, 64, 20e-6, 20e-6};
    Heightmap map{grid, std::vector<double>(grid.size(), 0)};
    for (int iy = 0; iy < 64; ++iy) {
      for (int ix = 0; ix < 64; ++ix) map(ix, iy) = ix % 16 < 8 ? 0 : -depth;
    }
    write_npy(file, map);
  };
  Measured3d measured;
  measured.file = file, measured.width = 20e-6, measured.patch = 12e-6;
  Design design = quick_design();
  design.texture = Texture{measured};
  write(100e-9);
  const auto before = std::filesystem::last_write_time(file);
  Told told;
  const auto answered = [&](std::uint64_t revision) {
    return std::find_if(told.answers.begin(), told.answers.end(),
                        [&](const Answer& a) { return a.revision == revision; });
  };
  {
    Evaluator evaluator(told.listener());
    evaluator.wish({1, design, {}});
    told.wait([&] { return answered(1) != told.answers.end(); });
    write(600e-9);
    std::filesystem::last_write_time(file, before + std::chrono::seconds(1));
    evaluator.wish({2, design, {}});
    told.wait([&] { return answered(2) != told.answers.end(); });
  }
  ASSERT_TRUE(told.failures.empty());
  EXPECT_EQ(told.shapes, (std::vector<std::uint64_t>{1, 2}));
  const Response expected = first_answer(
      evaluate(scene_of(design), design.texture, quick_fidelity(design)), design, nullptr);
  const double value = expected.points.at(0).friction_off.value;
  EXPECT_EQ(answered(2)->step, Step::First);
  EXPECT_NEAR(answered(2)->response.points.at(0).friction_off.value, value, 1e-9 * value);
  EXPECT_GT(std::abs(answered(1)->response.points.at(0).friction_off.value / value - 1), 1e-3);
}

}  // namespace
}  // namespace papilla::tests::evaluator_test
