// The dense solver step by step: on lists and on whole fields it does what its equations say,
// worked out here over all pixels without either.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "geometry/roughness.h"
#include "physics/contact/dense_fields.h"
#include "physics/contact/dense_listed.h"
#include "physics/contact/dense_stencil.h"
#include "physics/contact/dense_whole.h"
#include "physics/contact/solvers.h"

namespace papilla::tests::dense_steps_test {
namespace {

using namespace papilla::contact;

const LayeredSolid kSolid{3e6, 0.4, 3e-7, 1e6, 0.45};
constexpr Grid kGrid{24, 20, 2.4e-6, 2.4e-6};  // oblong pixels

std::vector<double> heights() { return random_surface({1e-8, 1.2e-6, 0.8, 3e-7}, kGrid, 1, 5).z; }

RealArray moved_by(const ContactKernel& kernel, const std::vector<double>& p) {
  RealArray u(p.begin(), p.end());
  SpectrumArray scratch(kernel.scratch_size());
  kernel.displace(u, u, scratch);
  return u;
}

// The same with plain loops over all pixels.
struct Reference {
  const StandardProblem& problem;
  std::vector<double> p, gap, step, change;
  std::vector<bool> free;
  double shift = 0, load, work = 0, low = 0;
  bool clipped = false;

  Reference(const StandardProblem& of, const std::vector<double>& start)
      : problem(of), p(start), step(p.size(), 0.0), change(p.size(), 0.0), load(of.load) {
    const RealArray u = moved_by(of.kernel, p);
    for (std::size_t i = 0; i < p.size(); ++i) gap.push_back(u[i] - of.height[i]);
    arrive();
  }
  void arrive() {
    double sum = 0, lowest_free = kInfinity, highest_held = -kInfinity;
    int inside = 0;
    work = 0, low = kInfinity;
    for (std::size_t i = 0; i < p.size(); ++i) {
      work += p[i] * gap[i];
      low = std::min(low, gap[i]);
      if (p[i] > 0 && p[i] < problem.cap) sum += gap[i], ++inside;
      if (p[i] == 0) lowest_free = std::min(lowest_free, gap[i]);
      if (p[i] == problem.cap) highest_held = std::max(highest_held, gap[i]);
    }
    if (problem.approach) {
      shift = problem.level, load = 0;
      for (const double v : p) load += v;
    } else {
      shift = inside > 0 ? sum / inside : 0.5 * (lowest_free + highest_held);
    }
    free.assign(p.size(), false);
    for (std::size_t i = 0; i < p.size(); ++i)
      free[i] = p[i] > 0 ? p[i] < problem.cap || gap[i] > shift : gap[i] < shift;
  }
  std::vector<double> residual() const {
    std::vector<double> r(p.size(), 0.0);
    for (std::size_t i = 0; i < p.size(); ++i)
      if (free[i]) r[i] = gap[i] - shift;
    return r;
  }
  // Along the direction z of the free pixels, ones: what the level shifts each by.
  void move(const std::vector<double>& z, const std::vector<double>& ones, double alpha,
            bool conjugate) {
    double cross = 0, own = 0, sum = 0, weight = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (!free[i]) continue;
      cross += z[i] * change[i];
      own += step[i] * change[i];
    }
    const double share = conjugate && own > 0 ? std::min(0.0, -cross / own) : 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (!free[i]) continue;
      sum += z[i] + share * step[i];
      weight += ones[i];
    }
    const double tilt = problem.approach ? 0 : sum / weight;
    std::vector<double> raw(p.size(), 0.0);
    double held = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (free[i])
        raw[i] = p[i] - alpha * (z[i] + share * step[i] - tilt * ones[i]);
      else
        held += p[i];
    }
    double level = 0;
    if (!problem.approach) {  // by halves
      double below = -1e9, above = 1e9;
      for (int k = 0; k < 200; ++k) {
        level = 0.5 * (below + above);
        double carried = held;
        for (std::size_t i = 0; i < p.size(); ++i)
          if (free[i]) carried += std::clamp(raw[i] - level * ones[i], 0.0, problem.cap);
        (carried > load ? below : above) = level;
      }
    }
    clipped = false;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double v = free[i] ? std::clamp(raw[i] - level * ones[i], 0.0, problem.cap) : p[i];
      clipped = clipped || (v == 0 && p[i] > 0) || (v == problem.cap && p[i] < problem.cap);
      step[i] = v - p[i];
      p[i] = v;
    }
    const RealArray u = moved_by(problem.kernel, step);
    change.assign(u.begin(), u.end());
  }
  StepSlopes slopes() const {
    StepSlopes s{0, 0};
    for (std::size_t i = 0; i < p.size(); ++i) {
      s.slope += (gap[i] - shift) * step[i];
      s.curvature += change[i] * step[i];
    }
    return s;
  }
  double room() const {
    double longest = kInfinity;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double from = p[i] - step[i];
      if (step[i] < 0) longest = std::min(longest, from / -step[i]);
      if (step[i] > 0) longest = std::min(longest, (problem.cap - from) / step[i]);
    }
    return longest;
  }
  void advance(double t) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (t != 1) p[i] = std::clamp(p[i] - (1 - t) * step[i], 0.0, problem.cap);
      gap[i] += t * change[i];
    }
    arrive();
  }
};

double scale_of(const std::vector<double>& v) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::abs(x));
  return most;
}
template <class A, class B>
void expect_near(const A& a, const B& b, double scale, const char* what) {
  ASSERT_EQ(a.size(), b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  EXPECT_LT(most, 1e-9 * scale) << what;
}

// What both kinds of pixels say of the state that they arrived at.
void expect_state(const DenseFields& f, const Reference& r, std::size_t free_count) {
  const double most = scale_of(r.p), high = scale_of(r.gap);
  expect_near(f.p, r.p, most, "pressure");
  expect_near(f.gap, r.gap, high, "gap");
  EXPECT_NEAR(f.shift, r.shift, 1e-9 * high);
  EXPECT_NEAR(f.low, r.low, 1e-9 * high);
  EXPECT_NEAR(f.work, r.work, 1e-9 * most * high * 480);
  EXPECT_NEAR(f.load, r.load, 1e-9 * r.load);
  EXPECT_EQ(free_count, static_cast<std::size_t>(std::count(r.free.begin(), r.free.end(), true)));
}

struct Case {
  double load;  // mean [Pa]
  double cap;
  bool approach;
};

// Steps of every kind: conjugate or not, whole or cut, as they are and by the plain gradient.
struct Step {
  double alpha, t;
  bool conjugate, plain;
};
constexpr Step kSteps[] = {
    {0.6, 1, false, false}, {0.5, 0.7, true, false}, {0.6, 1, true, false}, {0.4, 0.5, true, false},
    {0.3, 1, false, true},  {0.5, 0.9, true, false}, {0.6, 1, true, false}};

StandardProblem problem_of(const ContactKernel& kernel, const std::vector<double>& height,
                           const Case& c) {
  StandardProblem problem{kernel, height, {}, 1e-8, c.load * 480, c.cap};
  problem.approach = c.approach;
  problem.level = -6e-9;
  return problem;
}

std::vector<double> first_pressure(const std::vector<double>& height, const Case& c) {
  std::vector<double> p;
  for (const double h : height) p.push_back(h > -2e-9 ? 1 + h / 1e-8 : 0);
  double sum = 0;
  for (const double v : p) sum += v;
  for (double& v : p) v *= c.load * 480 / sum;
  return p;
}

TEST(DenseSteps, OnListsAreTheEquationsOverAllPixels) {
  const ContactKernel kernel(kGrid, kSolid);
  const std::vector<double> height = heights();
  int clipped = 0, held = 0;
  for (const Case& c :
       {Case{2e3, kInfinity, false}, Case{1.5e4, kInfinity, false}, Case{1e4, 2.2e4, false},
        Case{1e4, kInfinity, true}, Case{1e4, 2.2e4, true}}) {
    const StandardProblem problem = problem_of(kernel, height, c);
    StandardState state;
    state.p = first_pressure(height, c);
    DenseFields fields(problem, state);
    if (std::isfinite(c.cap)) fields.scale_to_load();
    Reference reference(problem, state.p);
    fields.start({});
    ListedPixels listed(fields);
    listed.begin();
    expect_state(fields, reference, listed.free_count());
    StencilPreconditioner stencil(kernel);
    for (const Step& s : kSteps) {
      const std::vector<double> r = reference.residual();
      std::vector<double> z(480, 0.0), ones(480, 0.0);
      const double stiff = 1 / kernel.self_compliance(),
                   count = static_cast<double>(listed.free_count());
      if (s.plain) {
        double sum = 0;
        for (const double v : r) sum += stiff * v;
        for (std::size_t i = 0; i < 480; ++i) {
          z[i] = stiff * r[i] - (c.approach ? 0 : sum / count);
          ones[i] = stiff;
        }
        listed.precondition_plainly();
      } else if (8 * listed.free_count() > 480) {  // by the whole plane
        RealArray u(r.begin(), r.end());
        SpectrumArray scratch(kernel.scratch_size());
        kernel.press(u, scratch);
        double sum = 0;
        for (std::size_t i = 0; i < 480; ++i) sum += reference.free[i] ? u[i] : 0;
        for (std::size_t i = 0; i < 480; ++i) {
          z[i] = u[i] - (c.approach ? 0 : sum / count);
          ones[i] = stiff;
        }
        const double before = state.pairs;
        listed.precondition();
        EXPECT_EQ(state.pairs, before + 1);
      } else {
        std::vector<double> direction, weights;
        stencil.apply(listed.free(), listed.residual(), !c.approach, direction, weights);
        for (std::size_t k = 0; k < direction.size(); ++k) {
          z[static_cast<std::size_t>(listed.free()[k])] = direction[k];
          ones[static_cast<std::size_t>(listed.free()[k])] = weights[k];
        }
        const double before = state.pairs;
        listed.precondition();
        EXPECT_EQ(state.pairs, before);
      }
      for (std::size_t k = 0; k < listed.free_count(); ++k)
        ASSERT_NEAR(listed.residual()[k], r[static_cast<std::size_t>(listed.free()[k])],
                    1e-9 * scale_of(reference.gap));
      reference.move(z, ones, s.alpha, s.conjugate);
      EXPECT_EQ(listed.move(s.alpha, s.conjugate), reference.clipped);
      const double before = state.pairs;
      fields.displace_step();
      EXPECT_EQ(state.pairs, before + 1);
      expect_near(fields.p, reference.p, scale_of(reference.p), "moved");
      expect_near(fields.step, reference.step, scale_of(reference.p), "step");
      expect_near(fields.change, reference.change, scale_of(reference.gap), "change");
      const StepSlopes own = listed.slopes(), exact = reference.slopes();
      EXPECT_NEAR(own.slope, exact.slope, 1e-8 * std::abs(exact.slope));
      EXPECT_NEAR(own.curvature, exact.curvature, 1e-8 * exact.curvature);
      EXPECT_NEAR(listed.room(), reference.room(), 1e-8 * reference.room());
      clipped += reference.clipped;
      reference.advance(s.t);
      listed.advance(s.t);
      expect_state(fields, reference, listed.free_count());
      for (const int i : listed.free()) EXPECT_TRUE(reference.free[static_cast<std::size_t>(i)]);
      for (std::size_t i = 0; i < 480; ++i) held += !reference.free[i] && reference.p[i] > 0;
    }
  }
  EXPECT_GT(clipped, 5);
  EXPECT_GT(held, 5);
}

TEST(DenseSteps, OnWholeFieldsAreTheEquationsOverAllPixels) {
  const ContactKernel kernel(kGrid, kSolid);
  const std::vector<double> height = heights();
  int held = 0;
  for (const Case& c : {Case{1.5e4, kInfinity, false}, Case{2e4, 3.5e4, false},
                        Case{2e4, kInfinity, true}, Case{1e4, 2.2e4, true}}) {
    const StandardProblem problem = problem_of(kernel, height, c);
    StandardState state;
    state.p = first_pressure(height, c);
    DenseFields fields(problem, state);
    if (std::isfinite(c.cap)) fields.scale_to_load();
    Reference reference(problem, state.p);
    fields.start({});
    ListedPixels listed(fields);
    listed.begin();
    WholePixels whole(fields);
    whole.take_over(listed);
    expect_state(fields, reference, whole.free_count());
    for (const Step& s : kSteps) {
      const std::vector<double> r = reference.residual();
      expect_near(fields.field, r, scale_of(reference.gap), "residual");
      const double stiff = 1 / kernel.self_compliance(),
                   count = static_cast<double>(whole.free_count());
      RealArray u(r.begin(), r.end());
      if (s.plain) {
        for (double& v : u) v *= stiff;
        whole.precondition_plainly();
      } else {
        SpectrumArray scratch(kernel.scratch_size());
        kernel.press(u, scratch);
        whole.precondition();
      }
      double sum = 0;
      for (std::size_t i = 0; i < 480; ++i) sum += reference.free[i] ? u[i] : 0;
      std::vector<double> z;
      for (const double v : u) z.push_back(v - (c.approach ? 0 : sum / count));
      reference.move(z, std::vector<double>(480, 1.0), s.alpha, s.conjugate);
      EXPECT_EQ(whole.move(s.alpha, s.conjugate), reference.clipped);
      fields.displace_step();
      expect_near(fields.p, reference.p, scale_of(reference.p), "moved");
      expect_near(fields.step, reference.step, scale_of(reference.p), "step");
      const StepSlopes own = whole.slopes(), exact = reference.slopes();
      EXPECT_NEAR(own.slope, exact.slope, 1e-8 * std::abs(exact.slope));
      EXPECT_NEAR(own.curvature, exact.curvature, 1e-8 * exact.curvature);
      EXPECT_NEAR(whole.room(), reference.room(), 1e-8 * reference.room());
      reference.advance(s.t);
      whole.advance(s.t);
      expect_state(fields, reference, whole.free_count());
      for (std::size_t i = 0; i < 480; ++i) {
        EXPECT_EQ(whole.is_free(i), reference.free[i]) << i;
        held += !reference.free[i] && reference.p[i] > 0;
      }
    }
    // Back on lists it goes on where it was.
    listed.take_over(whole);
    EXPECT_EQ(listed.free_count(), whole.free_count());
    const std::vector<double> r = reference.residual();
    for (std::size_t k = 0; k < listed.free_count(); ++k) {
      const auto i = static_cast<std::size_t>(listed.free()[k]);
      EXPECT_TRUE(reference.free[i]);
      EXPECT_NEAR(listed.residual()[k], r[i], 1e-9 * scale_of(reference.gap));
    }
    std::vector<double> z, ones(480, 1 / kernel.self_compliance());
    double sum = 0;
    for (const double v : r) sum += v * ones[0];
    for (const double v : r)
      z.push_back(v * ones[0] - (c.approach ? 0 : sum / static_cast<double>(listed.free_count())));
    reference.move(z, ones, 0.5, true);
    listed.precondition_plainly();
    EXPECT_EQ(listed.move(0.5, true), reference.clipped);
    fields.displace_step();
    expect_near(fields.step, reference.step, scale_of(reference.p), "step on lists");
    reference.advance(0.8);
    listed.advance(0.8);
    expect_state(fields, reference, listed.free_count());
  }
  EXPECT_GT(held, 5);
}

// The sum that a stencil is, pixel by pixel over the periodic plane, also where it is as wide as
// it.
TEST(StencilPreconditioner, IsTheStencilOfTheFreePixelsLessHalfItsSum) {
  for (const Grid& grid : {kGrid, Grid{7, 30, 7e-7, 3e-6}, Grid{9, 9, 9e-7, 9e-7}}) {
    const ContactKernel kernel(grid, kSolid);
    StencilPreconditioner stencil(kernel);
    const int n = static_cast<int>(grid.size());
    std::vector<int> free;
    std::vector<double> residual, field(grid.size(), 0.0), inside(grid.size(), 0.0);
    for (int i = 0; i < n; ++i) {
      if ((i * i) % 7 > 2 && i != n - 1) continue;  // corners and borders among them
      free.push_back(i);
      residual.push_back(1e-9 * (1 + i % 5) * (i % 2 == 0 ? 1 : -1));
      field[static_cast<std::size_t>(i)] = residual.back();
      inside[static_cast<std::size_t>(i)] = 1;
    }
    const double center = kernel.stencil().weight(0, 0), least = 1e-3 * center;
    std::vector<double> expected, weights;
    double sum = 0, weight = 0;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const int ix = free[k] % grid.nx, iy = free[k] / grid.nx;
      double value = 0, one = 0;
      for (int dy = -4; dy <= 4; ++dy) {
        for (int dx = -4; dx <= 4; ++dx) {
          const std::size_t at = grid.index(wrap(ix + dx, grid.nx), wrap(iy + dy, grid.ny));
          value += kernel.stencil().weight(dx, dy) * field[at];
          one += kernel.stencil().weight(dx, dy) * inside[at];
        }
      }
      const double half = std::max(0.5 * one, least);
      expected.push_back(value - half * residual[k]);
      weights.push_back(half);
      sum += expected.back();
      weight += half;
    }
    for (const bool balanced : {false, true, false}) {  // nothing is left behind by a call
      std::vector<double> direction, ones;
      stencil.apply(free, residual, balanced, direction, ones);
      ASSERT_EQ(direction.size(), free.size());
      ASSERT_EQ(ones.size(), free.size());
      for (std::size_t k = 0; k < free.size(); ++k) {
        EXPECT_NEAR(ones[k], weights[k], 2e-6 * center) << grid.nx << " " << k;
        EXPECT_NEAR(direction[k], expected[k] - (balanced ? sum / weight * weights[k] : 0),
                    2e-14 * center)
            << grid.nx << " " << k;
      }
    }
    // One pixel alone: half of its own stiffness, and no less than a thousandth where all is free.
    std::vector<double> direction, ones;
    stencil.apply({3}, {2e-9}, false, direction, ones);
    EXPECT_NEAR(ones[0], 0.5 * center, 1e-6 * center);
    EXPECT_NEAR(direction[0], 0.5 * center * 2e-9, 1e-15 * center);
  }
  const ContactKernel kernel({9, 9, 9e-7, 9e-7}, kSolid);  // the stencil is the plane: no edge
  StencilPreconditioner stencil(kernel);
  std::vector<int> all;
  for (int i = 0; i < 81; ++i) all.push_back(i);
  std::vector<double> direction, ones;
  stencil.apply(all, std::vector<double>(81, 1e-9), false, direction, ones);
  for (const double one : ones)
    EXPECT_NEAR(one, 1e-3 * kernel.stencil().weight(0, 0), 1e-8 * kernel.stencil().weight(0, 0));
}

// A pressure of any mean as one share of it that carries the load, no pixel beyond the cap.
TEST(DenseFields, StartsFromThePressureScaledToTheLoad) {
  const Grid grid{4, 2, 4e-7, 2e-7};
  const ContactKernel kernel(grid, kSolid);
  const std::vector<double> height{1, 9, 9, 9, 4, 5, 3, 2};
  const auto scaled = [&](std::vector<double> p, double load, double cap) {
    StandardState state;
    state.p = std::move(p);
    const StandardProblem problem{kernel, height, {}, 1, load, cap};
    DenseFields(problem, state).scale_to_load();
    return state.p;
  };
  const std::vector<double> p{0, 1, 2, 5, 0, 0, 0, 0};
  const auto expect = [](const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(a[i], b[i], 1e-12) << i;
  };
  expect(scaled(p, 16, kInfinity), {0, 2, 4, 10, 0, 0, 0, 0});
  expect(scaled(p, 16, 11), {0, 2, 4, 10, 0, 0, 0, 0});
  expect(scaled(p, 13, 7), {0, 2, 4, 7, 0, 0, 0, 0});  // 6 on two as 1 to 2
  expect(scaled(p, 15, 7), {0, 8.0 / 3, 16.0 / 3, 7, 0, 0, 0, 0});
  expect(scaled(p, 18, 7), {0, 4, 7, 7, 0, 0, 0, 0});
  expect(scaled(p, 20, 7), {0, 6, 7, 7, 0, 0, 0, 0});
  // Where all that carried is at the cap the rest goes to the highest of the others.
  expect(scaled(p, 26, 7), {0, 7, 7, 7, 0, 5, 0, 0});
  expect(scaled(p, 34, 7), {0, 7, 7, 7, 6.5, 6.5, 0, 0});
  // What is at the cap stays there when the load changes, and what a rounding left below it joins.
  const std::vector<double> flows{0, 7, 7 * (1 - 1e-14), 5, 0, 0, 0, 0};
  expect(scaled(flows, 18, 7), {0, 7, 7, 4, 0, 0, 0, 0});
  for (const double load : {18.0, 19.0, 20.0}) {
    const std::vector<double> started = scaled(flows, load, 7);
    EXPECT_EQ(started[1], 7) << load;
    EXPECT_EQ(started[2], 7) << load;
  }
  expect(scaled(flows, 9.5, 7), {0, 3.5, 3.5, 2.5, 0, 0, 0, 0});
  expect(scaled(std::vector<double>(8, 0.0), 16, kInfinity), std::vector<double>(8, 2.0));
  expect(scaled(std::vector<double>(8, 0.0), 16, 3), std::vector<double>(8, 2.0));
}

// Eqs. contact.4 and contact.10 on eight pixels by hand.
TEST(DenseFields, CertificateIsWhatTheLoadCouldStillGain) {
  const Grid grid{4, 2, 4e-7, 2e-7};
  const ContactKernel kernel(grid, kSolid);
  const std::vector<double> height(8, 0.0);
  const auto certificate = [&](const StandardProblem& problem, double shift) {
    StandardState state;
    state.p.assign(8, 0.0);
    DenseFields f(problem, state);
    f.gap = {5, 3, 1, 2, 4, 6, 8, 7};
    f.low = 1, f.work = 40, f.shift = shift;
    return f.certificate();
  };
  StandardProblem problem{kernel, height, {}, 0.5, 10};
  EXPECT_DOUBLE_EQ(certificate(problem, 2), (40 - 1 * 10) / (10 * 0.5));
  problem.cap = 4;  // the lowest carry 4, 4 and 2
  EXPECT_DOUBLE_EQ(certificate(problem, 2), (40 - (4 * 1 + 4 * 2 + 2 * 3)) / (10 * 0.5));
  problem.cap = 5;  // the third nothing
  EXPECT_DOUBLE_EQ(certificate(problem, 2), (40 - (5 * 1 + 5 * 2)) / (10 * 0.5));
  problem.cap = 10.0 / 8;  // all of them, at 45
  EXPECT_EQ(certificate(problem, 2), 0);
  problem.cap = kInfinity;
  problem.approach = true;  // 40 - 10 shift, less twice what the lowest could gain, if it can
  EXPECT_DOUBLE_EQ(certificate(problem, 2), (40 - 20 + 2 * 10) / (10 * 0.5));
  EXPECT_DOUBLE_EQ(certificate(problem, 0.5), (40 - 5) / (10 * 0.5));
  EXPECT_EQ(certificate(problem, 5), (40 - 50 + 2 * 40) / (10 * 0.5));
  problem.cap = 4;  // 4 on each of the lowest gain less, so that no more is taken off
  EXPECT_DOUBLE_EQ(certificate(problem, 2), (40 - 20 + 4 * 1) / (10 * 0.5));
  EXPECT_DOUBLE_EQ(certificate(problem, 4), (40 - 40 + 4 * (3 + 2 + 1)) / (10 * 0.5));
  EXPECT_DOUBLE_EQ(certificate(problem, 0.5), (40 - 5) / (10 * 0.5));
  problem.cap = 30;  // 30 on the lowest gain more than twice the load
  EXPECT_DOUBLE_EQ(certificate(problem, 2), (40 - 20 + 2 * 10) / (10 * 0.5));
  problem.cap = kInfinity;
  problem.load = 0;
  EXPECT_EQ(certificate(problem, 2), kInfinity);  // what is below the level has yet to touch
  EXPECT_EQ(certificate(problem, 1), 0);
}

TEST(DenseFields, WhatIsHeldAtTheCapIsOffTheLoad) {
  const Grid grid{4, 2, 4e-7, 2e-7};
  const ContactKernel kernel(grid, kSolid);
  const std::vector<double> height(8, 0.0);
  StandardState state;
  state.p.assign(8, 0.0);
  StandardProblem problem{kernel, height, {}, 0.5, 10, 3};
  EXPECT_DOUBLE_EQ(DenseFields(problem, state).load_beside(2), 4);
  EXPECT_DOUBLE_EQ(DenseFields(problem, state).load_beside(0), 10);
  problem.cap = kInfinity;
  EXPECT_DOUBLE_EQ(DenseFields(problem, state).load_beside(0), 10);
}

// All at the cap: the level lies half way to the lowest of the others, or at the highest.
TEST(DenseFields, TheLevelLiesBetweenTheCappedAndTheFree) {
  const Grid grid{4, 2, 4e-7, 2e-7};
  const ContactKernel kernel(grid, kSolid);
  const std::vector<double> height(8, 0.0);
  StandardState state;
  state.p = {0, 3, 3, 0, 0, 3, 0, 0};
  const StandardProblem problem{kernel, height, {}, 0.5, 9, 3};
  DenseFields f(problem, state);
  f.gap = {9, 1, 2, 8, 7, 3, 6, 9};
  f.change.assign(8, 0.0);
  f.change[5] = 1, f.change[6] = -2;
  f.set_shift(0, 0, 1);
  EXPECT_DOUBLE_EQ(f.shift, 0.5 * (4 + 4));
  f.set_shift(0, 0, 0.5);
  EXPECT_DOUBLE_EQ(f.shift, 0.5 * (3.5 + 5));
  f.set_shift(12, 4, 1);
  EXPECT_DOUBLE_EQ(f.shift, 3);
  state.p.assign(8, 3);
  f.set_shift(0, 0, 0);
  EXPECT_DOUBLE_EQ(f.shift, 9);
}

// Eq. contact.19 by hand, in units of a pixel's own yield: one pixel a tenth below the cap and far
// below the level flows as one at the cap does.
TEST(DenseFields, TheLevelReturnedIsThatOfElasticPixelsAlone) {
  const Grid grid{4, 2, 4e-7, 2e-7};
  const ContactKernel kernel(grid, kSolid);
  const std::vector<double> height(8, 0.0);
  StandardState state;
  state.p = {2.9, 3, 1, 2, 0, 0, 0, 0};
  const double yield = kernel.self_compliance();
  const auto returned = [&](double cap) {
    const StandardProblem problem{kernel, height, {}, 0.5, 8.9, cap};
    DenseFields f(problem, state);
    for (const double v : {-5.0, -8.0, 4.1, 3.9, 9.0, 8.0, 9.0, 7.0}) f.gap.push_back(yield * v);
    f.shift = yield;
    f.settle_shift();
    return f.shift;
  };
  // 3 + 3 + (1 - 4.1 + level) + (2 - 3.9 + level) = 8.9
  EXPECT_NEAR(returned(3), 3.95 * yield, 1e-9 * yield);
  EXPECT_EQ(returned(kInfinity), yield);  // the mean over all that is pressed stays
}

}  // namespace
}  // namespace papilla::tests::dense_steps_test
