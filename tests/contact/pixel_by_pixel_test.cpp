// Each loop of the contact solvers over several pixels at once gives what it gives pixel by pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "geometry/roughness.h"
#include "physics/contact/candidates.h"
#include "physics/contact/dense_fields.h"
#include "physics/contact/dense_listed.h"
#include "physics/contact/dense_stencil.h"
#include "physics/contact/dense_whole.h"
#include "physics/contact/solvers.h"
#include "tests/numerics/both_ways.h"

namespace papilla::tests::pixel_by_pixel_test {
namespace {

using namespace papilla::contact;

constexpr double kRounding = 1e-12;
constexpr double kCap = 2.2e4;  // [Pa]

const LayeredSolid kSolid{3e6, 0.4, 3e-7, 1e6, 0.45};
// 21 pixels a row: a loop ends within a vector.
constexpr Grid kGrid{21, 19, 2.1e-6, 1.9e-6};

const ContactKernel& kernel() {
  static const ContactKernel one(kGrid, kSolid);
  return one;
}
const std::vector<double>& heights() {
  static const std::vector<double> z = random_surface({1e-8, 1.2e-6, 0.8, 3e-7}, kGrid, 1, 5).z;
  return z;
}
std::vector<double> tractions() {
  std::vector<double> t(kGrid.size());
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = 1e3 * std::sin(0.3 * static_cast<double>(i));
  return t;
}

// A state between steps, with pixels at both bounds.
struct Stepping {
  explicit Stepping(bool approach = false)
      : problem{kernel(), heights(), {}, 1e-8, 1e4 * static_cast<double>(kGrid.size()), kCap} {
    problem.approach = approach;
    problem.level = -6e-9;
    for (const double h : heights()) state.p.push_back(h > -2e-9 ? 1 + h / 1e-8 : 0);
    fields.scale_to_load();
    fields.start({});
    listed.begin();
  }
  // What any step of the solver may change.
  std::vector<std::vector<double>> all() const {
    const auto copy = [](const auto& a) { return std::vector<double>(a.begin(), a.end()); };
    std::vector<double> free;
    for (const int i : listed.free()) free.push_back(i);
    return {copy(fields.p),
            copy(fields.gap),
            copy(fields.step),
            copy(fields.change),
            copy(fields.field),
            listed.residual(),
            free,
            {fields.shift},
            {fields.low},
            {fields.work},
            {fields.load},
            {static_cast<double>(whole.free_count())}};
  }

  StandardProblem problem;
  StandardState state;
  DenseFields fields{problem, state};
  ListedPixels listed{fields};
  WholePixels whole{fields};
};

// Step after step of either kind of pixels, each compared; as many are free as take the plane for
// their preconditioner, since the stencil computes in single precision.
template <class Pixels>
void walk(Stepping& s, Pixels& pixels, std::vector<std::vector<double>>& seen) {
  const auto note = [&] {
    for (const std::vector<double>& values : s.all()) seen.push_back(values);
  };
  for (const bool plain : {false, false, true}) {
    plain ? pixels.precondition_plainly() : pixels.precondition();
    note();
    seen.push_back({pixels.move(0.5, seen.size() > 20) ? 1.0 : 0.0});
    note();
    s.fields.displace_step();
    const StepSlopes slopes = pixels.slopes();
    seen.push_back({slopes.slope, 0});
    seen.push_back({slopes.curvature, 0});
    seen.push_back({pixels.room()});
    pixels.advance(plain ? 1 : 0.8);
    note();
    seen.push_back({s.fields.certificate()});
  }
}

void expect_all_alike(
    const std::pair<std::vector<std::vector<double>>, std::vector<std::vector<double>>>& both) {
  ASSERT_EQ(both.first.size(), both.second.size());
  for (std::size_t k = 0; k < both.first.size(); ++k)
    expect_alike(both.first[k], both.second[k], kRounding, "values of a step");
}

TEST(PixelByPixel, ListedStepsAreTheSame) {
  for (const bool approach : {false, true}) {
    expect_all_alike(both_ways([&] {
      std::vector<std::vector<double>> seen;
      Stepping s(approach);
      walk(s, s.listed, seen);
      return seen;
    }));
  }
}

TEST(PixelByPixel, WholeStepsAreTheSame) {
  for (const bool approach : {false, true}) {
    expect_all_alike(both_ways([&] {
      std::vector<std::vector<double>> seen;
      Stepping s(approach);
      s.whole.take_over(s.listed);
      walk(s, s.whole, seen);
      s.listed.take_over(s.whole);
      for (const std::vector<double>& values : s.all()) seen.push_back(values);
      return seen;
    }));
  }
}

TEST(PixelByPixel, TheLevelOfALoadIsTheSame) {
  std::vector<double> raw, ones;
  for (std::size_t i = 0; i < 45; ++i) {
    raw.push_back(std::cos(static_cast<double>(i * i)));
    ones.push_back(1 + 0.1 * std::sin(static_cast<double>(i)));
  }
  for (const std::vector<double>& weights : {ones, std::vector<double>{}}) {
    const auto [together, apart] = both_ways([&] { return load_level(raw, weights, 0.7, 9, 9); });
    EXPECT_NEAR(together, apart, kRounding);
  }
}

TEST(PixelByPixel, TheStencilIsTheSame) {
  std::vector<int> free;
  std::vector<double> residual;
  for (int i = 0; i < static_cast<int>(kGrid.size()); i += 3) {
    free.push_back(i);
    residual.push_back(1e-9 * (i % 7 - 3));
  }
  const auto [together, apart] = both_ways([&] {
    StencilPreconditioner stencil(kernel());
    std::vector<double> direction, ones;
    stencil.apply(free, residual, true, direction, ones);
    direction.insert(direction.end(), ones.begin(), ones.end());
    return direction;
  });
  expect_alike(together, apart, 1e-6, "direction");  // in single precision
}

TEST(PixelByPixel, WatchedPixelsAreTheSame) {
  const StandardProblem problem{
      kernel(), heights(), {}, 1e-8, 2e2 * static_cast<double>(kGrid.size())};
  std::vector<double> g0;
  for (const double h : heights()) g0.push_back(-h);
  ContactSolution start = solve_contact(kernel(), heights(), 2e2, {}, {});
  const auto [together, apart] = both_ways([&] {
    return std::pair(watch_lowest(problem, g0, {200, true}),
                     watch_near(problem, start, {200, true}));
  });
  ASSERT_TRUE(together.first && together.second);
  EXPECT_EQ(together, apart);
}

TEST(PixelByPixel, SolutionsAndAreasAreTheSame) {
  const std::vector<double> t = tractions();
  for (const ContactMethod method : {ContactMethod::Sparse, ContactMethod::Dense}) {
    for (const std::vector<double>& traction : {t, std::vector<double>{}}) {
      const auto [together, apart] = both_ways([&] {
        ContactOptions options;
        options.method = method;
        options.tolerance = 1e-10;
        return solve_contact(kernel(), heights(), 2e3, traction, options);
      });
      EXPECT_EQ(together.method, apart.method);
      EXPECT_EQ(together.iterations, apart.iterations);
      EXPECT_EQ(together.status, apart.status);
      expect_alike(together.pressure, apart.pressure, 1e-10, "pressure");
      expect_alike(together.gap, apart.gap, 1e-10, "gap");
      EXPECT_NEAR(together.elastic_energy, apart.elastic_energy, 1e-10 * together.elastic_energy);
      const auto [area, area_apart] =
          both_ways([&, &solution = together] { return measure_area(kernel(), solution); });
      EXPECT_EQ(area.raw, area_apart.raw);
      EXPECT_EQ(area.near_edge, area_apart.near_edge);
    }
  }
}

}  // namespace
}  // namespace papilla::tests::pixel_by_pixel_test
