// local_bench: searches of one objective on the least squares problems of More and Wild (2009), as
// sums of squares, with noise, and as sums of absolute values; data profiles as CSV on standard
// output. local_bench constrained: problem 71 of Hock and Schittkowski. local_bench polish: whether
// a local search of NLopt at the end of the Gaussian process finds more than the process itself.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/random.h"
#include "optim/search.h"

using namespace papilla::tests;

namespace {

using Residuals = std::function<std::vector<double>(const Point&)>;

struct Problem {
  std::string name;
  Point start;
  double low, high;  // of every variable
  Residuals residuals;
};

double sq(double v) { return v * v; }

std::vector<Problem> problems() {
  std::vector<Problem> out;
  out.push_back({"rosenbrock", {-1.2, 1}, -3, 4, [](const Point& x) {
                   return std::vector<double>{10 * (x[1] - sq(x[0])), 1 - x[0]};
                 }});
  out.push_back({"freudenstein-roth", {0.5, -2}, -15, 16, [](const Point& x) {
                   const double y = x[1];
                   return std::vector<double>{-13 + x[0] + ((5 - y) * y - 2) * y,
                                              -29 + x[0] + ((1 + y) * y - 14) * y};
                 }});
  out.push_back({"jennrich-sampson", {0.3, 0.4}, -0.5, 1, [](const Point& x) {
                   std::vector<double> f;
                   for (int i = 1; i <= 10; ++i)
                     f.push_back(2 + 2 * i - std::exp(i * x[0]) - std::exp(i * x[1]));
                   return f;
                 }});
  out.push_back({"helical valley", {-1, 0, 0}, -4, 5, [](const Point& x) {
                   const double turn = std::atan2(x[1], x[0]) / (2 * M_PI);
                   return std::vector<double>{10 * (x[2] - 10 * turn),
                                              10 * (std::hypot(x[0], x[1]) - 1), x[2]};
                 }});
  out.push_back({"bard", {1, 1, 1}, -2, 5, [](const Point& x) {
                   const double y[] = {0.14, 0.18, 0.22, 0.25, 0.29, 0.32, 0.35, 0.39,
                                       0.37, 0.58, 0.73, 0.96, 1.34, 2.10, 4.39};
                   std::vector<double> f;
                   for (int i = 1; i <= 15; ++i) {
                     const double v = 16 - i, w = std::min(i, 16 - i);
                     const double d = v * x[1] + w * x[2];
                     f.push_back(y[i - 1] - x[0] - i / (std::abs(d) > 1e-6 ? d : 1e-6));
                   }
                   return f;
                 }});
  out.push_back({"box", {0, 10, 20}, -5, 25, [](const Point& x) {
                   std::vector<double> f;
                   for (int i = 1; i <= 10; ++i) {
                     const double t = 0.1 * i;
                     f.push_back(std::exp(-t * x[0]) - std::exp(-t * x[1]) -
                                 x[2] * (std::exp(-t) - std::exp(-10 * t)));
                   }
                   return f;
                 }});
  out.push_back({"powell singular", {3, -1, 0, 1}, -4, 5, [](const Point& x) {
                   return std::vector<double>{x[0] + 10 * x[1], std::sqrt(5.0) * (x[2] - x[3]),
                                              sq(x[1] - 2 * x[2]),
                                              std::sqrt(10.0) * sq(x[0] - x[3])};
                 }});
  out.push_back(
      {"kowalik-osborne", {0.25, 0.39, 0.415, 0.39}, 0, 1, [](const Point& x) {
         const double y[] = {0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627,
                             0.0456, 0.0342, 0.0323, 0.0235, 0.0246};
         const double u[] = {4, 2, 1, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625};
         std::vector<double> f;
         for (int i = 0; i < 11; ++i)
           f.push_back(y[i] - x[0] * (sq(u[i]) + u[i] * x[1]) / (sq(u[i]) + u[i] * x[2] + x[3]));
         return f;
       }});
  out.push_back({"brown-dennis", {25, 5, -5, -1}, -30, 30, [](const Point& x) {
                   std::vector<double> f;
                   for (int i = 1; i <= 20; ++i) {
                     const double t = 0.2 * i;
                     f.push_back(sq(x[0] + t * x[1] - std::exp(t)) +
                                 sq(x[2] + std::sin(t) * x[3] - std::cos(t)));
                   }
                   return f;
                 }});
  out.push_back({"cube", {0.5, 0.5, 0.5, 0.5, 0.5}, -1.5, 2, [](const Point& x) {
                   std::vector<double> f{x[0] - 1};
                   for (std::size_t i = 1; i < x.size(); ++i)
                     f.push_back(10 * (x[i] - std::pow(x[i - 1], 3)));
                   return f;
                 }});
  out.push_back({"watson", Point(6, 0.5), -2, 3, [](const Point& x) {
                   std::vector<double> f;
                   for (int i = 1; i <= 29; ++i) {
                     const double t = i / 29.0;
                     double slope = 0, value = 0;
                     for (std::size_t j = 0; j < x.size(); ++j) {
                       value += x[j] * std::pow(t, static_cast<double>(j));
                       if (j > 0)
                         slope += static_cast<double>(j) * x[j] *
                                  std::pow(t, static_cast<double>(j) - 1);
                     }
                     f.push_back(slope - sq(value) - 1);
                   }
                   f.push_back(x[0]);
                   f.push_back(x[1] - sq(x[0]) - 1);
                   return f;
                 }});
  Point spread(6);
  for (std::size_t j = 0; j < spread.size(); ++j) spread[j] = static_cast<double>(j + 1) / 7;
  out.push_back({"chebyquad", spread, 0, 1, [](const Point& x) {
                   std::vector<double> f;
                   for (std::size_t i = 1; i <= x.size(); ++i) {
                     double sum = 0;
                     for (double v : x)
                       sum += std::cos(static_cast<double>(i) *
                                       std::acos(std::clamp(2 * v - 1, -1.0, 1.0)));
                     const double order = static_cast<double>(i);
                     f.push_back(sum / static_cast<double>(x.size()) +
                                 (i % 2 == 0 ? 1 / (sq(order) - 1) : 0));
                   }
                   return f;
                 }});
  out.push_back({"brown almost linear", Point(7, 0.5), -1, 2.5, [](const Point& x) {
                   double sum = -8, product = 1;
                   for (double v : x) {
                     sum += v;
                     product *= v;
                   }
                   std::vector<double> f;
                   for (std::size_t i = 0; i + 1 < x.size(); ++i) f.push_back(x[i] + sum);
                   f.push_back(product - 1);
                   return f;
                 }});
  out.push_back({"bdqrtic", Point(8, 1), -2, 3, [](const Point& x) {
                   std::vector<double> f;
                   for (std::size_t i = 0; i + 4 < x.size(); ++i) {
                     f.push_back(-4 * x[i] + 3);
                     f.push_back(sq(x[i]) + 2 * sq(x[i + 1]) + 3 * sq(x[i + 2]) + 4 * sq(x[i + 3]) +
                                 5 * sq(x.back()));
                   }
                   return f;
                 }});
  return out;
}

enum class Kind { Smooth, Noisy, Absolute };
const std::vector<std::pair<Kind, std::string>> kKinds{
    {Kind::Smooth, "smooth"}, {Kind::Noisy, "noise 0.1 %"}, {Kind::Absolute, "nonsmooth"}};

double value(const Problem& p, Kind kind, const Point& x) {
  double sum = 0;
  for (double f : p.residuals(x)) sum += kind == Kind::Absolute ? std::abs(f) : f * f;
  return std::isfinite(sum) ? std::min(sum, 1e30) : 1e30;
}

// Least true value after each evaluation; the one that the search believes the best is taken.
std::vector<double> trace(const Problem& p, Kind kind, const std::string& method, int budget) {
  SearchProblem s;
  s.space.dimensions.assign(p.start.size(), {p.low, p.high, {}});
  s.evaluations = budget;
  s.starts = {s.space.unit(p.start)};
  const auto searcher = make_searcher(choose_method(method, s), s);
  std::vector<double> out;
  double believed = std::numeric_limits<double>::infinity(), truth = believed;
  RandomStream noise(3, "noise");
  while (static_cast<int>(out.size()) < budget) {
    std::vector<Evaluation> batch;
    for (const Point& u : searcher->ask()) {
      if (static_cast<int>(out.size()) >= budget) break;
      const double f = value(p, kind, s.space.value(u));
      const double seen = kind == Kind::Noisy ? f * (1 + 1e-3 * noise.uniform(-1.0, 1.0)) : f;
      if (seen < believed) {
        believed = seen;
        truth = f;
      }
      out.push_back(truth);
      batch.push_back({u, {true, {}, {seen}, {}, {}}});
    }
    if (batch.empty()) break;
    searcher->tell(batch);
  }
  out.resize(static_cast<std::size_t>(budget), truth);
  return out;
}

// Share of the problems on which f(x0) - f >= (1 - tau) (f(x0) - least of all methods), after a
// number of simplex gradients (n + 1 evaluations each).
void profiles(const std::string& set, std::size_t largest, const std::vector<std::string>& methods,
              const std::vector<int>& gradients) {
  std::vector<Problem> chosen;
  for (const Problem& p : problems()) {
    if (p.start.size() <= largest) chosen.push_back(p);
  }
  for (const auto& [kind, name] : kKinds) {
    std::vector<std::map<std::string, std::vector<double>>> traces;
    for (const Problem& p : chosen) {
      const int n = static_cast<int>(p.start.size());
      auto& of = traces.emplace_back();
      for (const std::string& m : methods) of[m] = trace(p, kind, m, gradients.back() * (n + 1));
    }
    for (double tau : {1e-1, 1e-3}) {
      for (int count : gradients) {
        fmt::print("{},{},{},{:g},{}", set, chosen.size(), name, tau, count);
        for (const std::string& m : methods) {
          int solved = 0;
          for (std::size_t i = 0; i < chosen.size(); ++i) {
            const double first = value(chosen[i], kind, chosen[i].start);
            double least = first;
            for (const auto& [other, t] : traces[i]) least = std::min(least, t.back());
            const auto at = static_cast<std::size_t>(count) * (chosen[i].start.size() + 1) - 1;
            solved += first - traces[i][m][at] >= (1 - tau) * (first - least);
          }
          fmt::print(",{:.2f}", solved / static_cast<double>(chosen.size()));
        }
        fmt::print("\n");
      }
    }
    std::fflush(stdout);
  }
}

// min x1 x4 (x1 + x2 + x3) + x3, x1 x2 x3 x4 >= 25, x1^2 + ... + x4^2 = 40, 1 <= x <= 5; the
// equality gives x4. Least value 17.0140173.
void constrained() {
  fmt::print("problem,method,evaluations,least feasible value / 17.0140173\n");
  for (const auto& [method, budget] :
       {std::pair("bobyqa", 1000), std::pair("sbplx", 1000), std::pair("cmaes", 1000),
        std::pair("direct", 1000), std::pair("bayesian", 60)}) {
    SearchProblem s;
    s.space.dimensions.assign(3, {1, 5, {}});
    s.constraints = 2;
    s.evaluations = budget;
    s.starts = {s.space.unit({1, 5, 3})};
    const auto searcher = make_searcher(choose_method(method, s), s);
    double least = std::numeric_limits<double>::infinity();
    int count = 0;
    while (count < budget) {
      std::vector<Evaluation> batch;
      for (const Point& u : searcher->ask()) {
        const Point x = s.space.value(u);
        const double left = 40 - sq(x[0]) - sq(x[1]) - sq(x[2]);
        const double last = std::sqrt(std::clamp(left, 1.0, 25.0));
        const double f = x[0] * last * (x[0] + x[1] + x[2]) + x[2];
        const double product = 1 - x[0] * x[1] * x[2] * last / 25;
        const double range = std::max(1 - left, left - 25) / 25;
        batch.push_back({u, {true, {}, {f}, {product, range}, {}}});
        if (batch.back().outcome.feasible()) least = std::min(least, f);
        ++count;
      }
      if (batch.empty()) break;
      searcher->tell(batch);
    }
    fmt::print("HS71,{},{},{:.5f}\n", method, count, least / 17.0140173);
    std::fflush(stdout);
  }
}

// Smooth functions of a few hills, as studies have them, minimised over the unit cube; each about 1
// from its start to its least value.
struct Landscape {
  std::string name;
  std::size_t variables;
  double least, scale;
  std::function<double(const Point&)> value;
};

double hartmann(const Point& u, const std::vector<Point>& a, const std::vector<Point>& p) {
  const double c[] = {1, 1.2, 3, 3.2};
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    double inside = 0;
    for (std::size_t k = 0; k < u.size(); ++k) inside += a[i][k] * sq(u[k] - p[i][k]);
    sum -= c[i] * std::exp(-inside);
  }
  return sum;
}

std::vector<Landscape> landscapes() {
  const std::vector<Point> a3{{3, 10, 30}, {0.1, 10, 35}, {3, 10, 30}, {0.1, 10, 35}};
  const std::vector<Point> p3{{0.3689, 0.1170, 0.2673},
                              {0.4699, 0.4387, 0.7470},
                              {0.1091, 0.8732, 0.5547},
                              {0.0382, 0.5743, 0.8828}};
  const std::vector<Point> a6{{10, 3, 17, 3.5, 1.7, 8},
                              {0.05, 10, 17, 0.1, 8, 14},
                              {3, 3.5, 1.7, 10, 17, 8},
                              {17, 8, 0.05, 10, 0.1, 14}};
  const std::vector<Point> p6{{0.1312, 0.1696, 0.5569, 0.0124, 0.8283, 0.5886},
                              {0.2329, 0.4135, 0.8307, 0.3736, 0.1004, 0.9991},
                              {0.2348, 0.1451, 0.3522, 0.2883, 0.3047, 0.6650},
                              {0.4047, 0.8828, 0.8732, 0.5743, 0.1091, 0.0381}};
  std::vector<Landscape> out;
  out.push_back({"branin", 2, 0.397887, 50, [](const Point& u) {
                   const double x = 15 * u[0] - 5, y = 15 * u[1];
                   return sq(y - 5.1 / (4 * M_PI * M_PI) * x * x + 5 / M_PI * x - 6) +
                          10 * (1 - 1 / (8 * M_PI)) * std::cos(x) + 10;
                 }});
  out.push_back(
      {"hartmann 3", 3, -3.86278, 3.8, [=](const Point& u) { return hartmann(u, a3, p3); }});
  out.push_back(
      {"hartmann 6", 6, -3.32237, 3.3, [=](const Point& u) { return hartmann(u, a6, p6); }});
  // A ridge that lies across the coordinates, its best place on a bound: voltage against film.
  out.push_back({"ridge 4", 4, 0, 1, [](const Point& u) {
                   const double across = u[0] - 0.8 * u[1], along = 1 - u[1];
                   return 2 * sq(across - 0.1) + 0.5 * along + sq(u[2] - 0.7) +
                          0.3 * sq(u[3] - 0.4);
                 }});
  return out;
}

std::vector<Evaluation> searched(const Landscape& f, const SearchProblem& s,
                                 const std::string& method, double noise, RandomStream& random) {
  const auto searcher = make_searcher(choose_method(method, s), s);
  std::vector<Evaluation> all;
  while (static_cast<int>(all.size()) < s.evaluations) {
    std::vector<Evaluation> batch;
    for (const Point& u : searcher->ask()) {
      if (static_cast<int>(all.size()) >= s.evaluations) break;
      const double seen = f.value(s.space.value(u)) + noise * f.scale * random.normal();
      batch.push_back({u, {true, {}, {seen}, {}, {}}});
      all.push_back({s.space.value(u), batch.back().outcome});
    }
    if (batch.empty()) break;
    searcher->tell(batch);
  }
  return all;
}

// What is lost of the way from the start to the least value, of the design that the evaluations
// speak for.
double regret(const Landscape& f, const std::vector<Evaluation>& all) {
  SearchProblem s;
  s.space.dimensions.assign(f.variables, {});
  const std::vector<std::size_t> best = promising(s, all, 1);
  return (f.value(all.at(best.at(0)).unit) - f.least) / f.scale;
}

void polish() {
  constexpr int kBudget = 60, kSeeds = 5;
  constexpr double kShare = 0.3, kReach = 0.15;  // of the budget; of each variable, either way
  fmt::print("landscape,noise,method,regret median,worst\n");
  for (const Landscape& f : landscapes()) {
    for (const double noise : {0.0, 0.01, 0.05}) {
      for (const std::string method :
           {"bayesian", "bayesian + bobyqa", "bayesian + sbplx", "bobyqa", "cmaes"}) {
        std::vector<double> found;
        for (int seed = 1; seed <= kSeeds; ++seed) {
          SearchProblem s;
          s.space.dimensions.assign(f.variables, {});
          s.seed = static_cast<std::uint64_t>(seed);
          s.evaluations = kBudget;
          Point start(f.variables);
          RandomStream random(s.seed, "polish");
          for (double& u : start) u = random.uniform();
          s.starts = {start};
          const std::size_t plus = method.find(" + ");
          if (plus != std::string::npos) s.evaluations = static_cast<int>((1 - kShare) * kBudget);
          std::vector<Evaluation> all = searched(f, s, method.substr(0, plus), noise, random);
          if (plus != std::string::npos) {  // around the design that these speak for
            const Point centre = all[promising(s, all, 1).at(0)].unit;
            SearchProblem near = s;
            for (std::size_t k = 0; k < f.variables; ++k)
              near.space.dimensions[k] = {
                  std::max(0.0, centre[k] - kReach), std::min(1.0, centre[k] + kReach), {}};
            near.starts = {near.space.unit(centre)};
            near.evaluations = kBudget - s.evaluations;
            for (const Evaluation& e : searched(f, near, method.substr(plus + 3), noise, random))
              all.push_back(e);
          }
          found.push_back(regret(f, all));
        }
        std::sort(found.begin(), found.end());
        fmt::print("{},{:g},{},{:.4f},{:.4f}\n", f.name, noise, method, found[kSeeds / 2],
                   found.back());
        std::fflush(stdout);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "constrained") {
    constrained();
    return 0;
  }
  if (argc > 1 && std::string(argv[1]) == "polish") {
    polish();
    return 0;
  }
  fmt::print("set,problems,kind,tau,simplex gradients,bobyqa,sbplx,cmaes,direct,bayesian\n");
  profiles("up to 8 variables", 8, {"bobyqa", "sbplx", "cmaes", "direct"}, {5, 10, 25, 50, 100});
  profiles("up to 3 variables", 3, {"bobyqa", "sbplx", "cmaes", "direct", "bayesian"}, {5, 10});
}
