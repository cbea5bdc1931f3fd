// NSGA-II and CMA-ES of our own; full builds have evolution_pagmo.cpp in its place.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.h"
#include "optim/algorithms/searchers.h"
#include "optim/pareto.h"

namespace papilla::optim {
namespace {

struct Individual {
  Point unit;
  std::vector<double> fitness;  // minimised, the penalty folded in
  std::size_t front = 0;        // 0: not dominated
  double crowding = 0;
};
using Population = std::vector<Individual>;

// Points as they are evaluated, with their finite fitness.
class Judge {
 public:
  Judge(const SearchProblem& problem, const BlockingObjective& objective)
      : problem_(problem), objective_(objective) {}

  Population operator()(std::vector<Point> points) {
    for (Point& u : points) u = problem_.space.snapped(u);
    const std::vector<Outcome> outcomes = objective_(points);
    Population out;
    for (std::size_t i = 0; i < points.size(); ++i)
      out.push_back({points[i], penalty_.finite(outcomes[i], problem_.objectives)});
    return out;
  }

 private:
  const SearchProblem& problem_;
  const BlockingObjective& objective_;
  Penalty penalty_;
};

// --- NSGA-II (Deb et al. 2002) ---

void sort_into_fronts(Population& all) {
  std::vector<std::size_t> left(all.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  for (std::size_t front = 0; !left.empty(); ++front) {
    std::vector<std::size_t> beaten;
    for (const std::size_t i : left) {
      const bool worse = std::any_of(left.begin(), left.end(), [&](std::size_t j) {
        return dominates(all[j].fitness, all[i].fitness);
      });
      if (worse) beaten.push_back(i);
      all[i].front = front;
    }
    left = beaten;
  }
}

// The distance of its neighbours in its front, over all objectives; infinite at the ends.
void measure_crowding(Population& all, std::size_t objectives) {
  for (Individual& i : all) i.crowding = 0;
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t k = 0; k < objectives; ++k) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return all[a].front != all[b].front ? all[a].front < all[b].front
                                          : all[a].fitness[k] < all[b].fitness[k];
    });
    for (std::size_t begin = 0, end = 1; begin < order.size(); begin = end++) {
      while (end < order.size() && all[order[end]].front == all[order[begin]].front) ++end;
      const double span = all[order[end - 1]].fitness[k] - all[order[begin]].fitness[k];
      all[order[begin]].crowding = all[order[end - 1]].crowding =
          std::numeric_limits<double>::infinity();
      for (std::size_t i = begin + 1; i + 1 < end && span > 0; ++i)
        all[order[i]].crowding +=
            (all[order[i + 1]].fitness[k] - all[order[i - 1]].fitness[k]) / span;
    }
  }
}

bool fitter(const Individual& a, const Individual& b) {
  return a.front != b.front ? a.front < b.front : a.crowding > b.crowding;
}

const Individual& winner(const Population& all, RandomStream& random) {
  const int n = static_cast<int>(all.size());
  const Individual &a = all[static_cast<std::size_t>(random.below(n))],
                   &b = all[static_cast<std::size_t>(random.below(n))];
  return fitter(b, a) ? b : a;
}

// Simulated binary crossover of one coordinate of both, within the unit interval.
void cross(double& a, double& b, RandomStream& random) {
  const double low = std::min(a, b), high = std::max(a, b), gap = high - low;
  if (gap < 1e-14) return;
  const double u = random.uniform();
  const auto child = [&](double room, double sign) {
    const double beta = 1 + 2 * room / gap;
    const double alpha = 2 - std::pow(beta, -(kCrossoverIndex + 1));
    const double q = u <= 1 / alpha ? std::pow(u * alpha, 1 / (kCrossoverIndex + 1))
                                    : std::pow(1 / (2 - u * alpha), 1 / (kCrossoverIndex + 1));
    return std::clamp(0.5 * (low + high + sign * q * gap), 0.0, 1.0);
  };
  a = child(low, -1);
  b = child(1 - high, 1);
  if (random.uniform() < 0.5) std::swap(a, b);
}

// Polynomial mutation of one coordinate.
void mutate(double& x, RandomStream& random) {
  const double u = random.uniform(), power = 1 / (kMutationIndex + 1);
  const double step =
      u < 0.5 ? std::pow(2 * u + (1 - 2 * u) * std::pow(1 - x, kMutationIndex + 1), power) - 1
              : 1 - std::pow(2 * (1 - u) + (2 * u - 1) * std::pow(x, kMutationIndex + 1), power);
  x = std::clamp(x + step, 0.0, 1.0);
}

std::vector<Point> children_of(const Population& all, RandomStream& random) {
  std::vector<Point> out;
  while (out.size() < all.size()) {
    Point a = winner(all, random).unit, b = winner(all, random).unit;
    const bool crossed = random.uniform() < kCrossover;
    for (std::size_t k = 0; k < a.size(); ++k) {
      if (crossed && random.uniform() < 0.5) cross(a[k], b[k], random);
    }
    for (Point* child : {&a, &b}) {
      for (double& x : *child) {
        if (random.uniform() < 1.0 / static_cast<double>(a.size())) mutate(x, random);
      }
      if (out.size() < all.size()) out.push_back(*child);
    }
  }
  return out;
}

// --- CMA-ES (Hansen and Ostermeier 2001; rank-mu after Hansen 2016) ---

class Cma {
 public:
  Cma(Eigen::VectorXd mean, double sigma, int samples)
      : n_(static_cast<int>(mean.size())),
        samples_(samples),
        mean_(std::move(mean)),
        sigma_(sigma),
        path_(Eigen::VectorXd::Zero(n_)),
        sigma_path_(Eigen::VectorXd::Zero(n_)),
        covariance_(Eigen::MatrixXd::Identity(n_, n_)) {
    const int parents = samples_ / 2;
    weights_.resize(parents);
    for (int i = 0; i < parents; ++i)
      weights_(i) = std::log(0.5 * (samples_ + 1)) - std::log(i + 1.0);
    weights_ /= weights_.sum();
    mu_ = 1 / weights_.squaredNorm();
    const double n = n_;
    c_sigma_ = (mu_ + 2) / (n + mu_ + 5);
    d_sigma_ = 1 + 2 * std::max(0.0, std::sqrt((mu_ - 1) / (n + 1)) - 1) + c_sigma_;
    c_path_ = (4 + mu_ / n) / (n + 4 + 2 * mu_ / n);
    c_one_ = 2 / ((n + 1.3) * (n + 1.3) + mu_);
    c_mu_ = std::min(1 - c_one_, 2 * (mu_ - 2 + 1 / mu_) / ((n + 2) * (n + 2) + mu_));
    expected_ = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  }

  std::vector<Point> ask(RandomStream& random) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance_);
    basis_ = eigen.eigenvectors();
    lengths_ = eigen.eigenvalues().cwiseMax(1e-20).cwiseSqrt();
    std::vector<Point> out;
    for (int i = 0; i < samples_; ++i) {
      Eigen::VectorXd z(n_);
      for (double& v : z) v = random.normal();
      const Eigen::VectorXd x =
          (mean_ + sigma_ * (basis_ * lengths_.cwiseProduct(z))).cwiseMax(0.0).cwiseMin(1.0);
      out.emplace_back(x.data(), x.data() + n_);
    }
    return out;
  }

  void tell(Population points) {
    std::stable_sort(points.begin(), points.end(), [](const Individual& a, const Individual& b) {
      return a.fitness[0] < b.fitness[0];
    });
    ++generation_;
    Eigen::MatrixXd steps(n_, weights_.size());
    for (int i = 0; i < weights_.size(); ++i) {
      const Point& u = points[static_cast<std::size_t>(i)].unit;
      steps.col(i) = (Eigen::Map<const Eigen::VectorXd>(u.data(), n_) - mean_) / sigma_;
    }
    const Eigen::VectorXd step = steps * weights_;
    mean_ += sigma_ * step;
    sigma_path_ =
        (1 - c_sigma_) * sigma_path_ + std::sqrt(c_sigma_ * (2 - c_sigma_) * mu_) * basis_ *
                                           (basis_.transpose() * step).cwiseQuotient(lengths_);
    const double fade = 1 - std::pow(1 - c_sigma_, 2 * generation_);
    const bool steady = sigma_path_.norm() / std::sqrt(fade) < (1.4 + 2 / (n_ + 1.0)) * expected_;
    path_ = (1 - c_path_) * path_;
    if (steady) path_ += std::sqrt(c_path_ * (2 - c_path_) * mu_) * step;
    const double lost = steady ? 0 : c_path_ * (2 - c_path_);
    covariance_ = (1 - c_one_ - c_mu_ + c_one_ * lost) * covariance_ +
                  c_one_ * path_ * path_.transpose() +
                  c_mu_ * steps * weights_.asDiagonal() * steps.transpose();
    sigma_ *= std::exp(std::min(1.0, c_sigma_ / d_sigma_ * (sigma_path_.norm() / expected_ - 1)));
  }

  bool converged() const { return sigma_ * lengths_.maxCoeff() < 1e-7; }

 private:
  int n_, samples_, generation_ = 0;
  Eigen::VectorXd mean_;
  double sigma_;
  Eigen::VectorXd path_, sigma_path_, weights_, lengths_;
  Eigen::MatrixXd covariance_, basis_;
  double mu_ = 0, c_sigma_ = 0, d_sigma_ = 0, c_path_ = 0, c_one_ = 0, c_mu_ = 0, expected_ = 0;
};

}  // namespace

std::unique_ptr<Searcher> make_nsga2(const SearchProblem& problem) {
  return make_blocking([problem](const BlockingObjective& objective) {
    Judge judge(problem, objective);
    const std::size_t size = nsga2_population(problem);
    Population all = judge(first_points(problem, size));
    for (std::uint64_t generation = 0;; ++generation) {
      RandomStream random(problem.seed, "nsga2", generation);
      sort_into_fronts(all);
      measure_crowding(all, problem.objectives);
      for (Individual& child : judge(children_of(all, random))) all.push_back(std::move(child));
      sort_into_fronts(all);
      measure_crowding(all, problem.objectives);
      std::stable_sort(all.begin(), all.end(), fitter);
      all.resize(size);
    }
  });
}

std::unique_ptr<Searcher> make_cmaes(const SearchProblem& problem) {
  return make_blocking([problem](const BlockingObjective& objective) {
    Judge judge(problem, objective);
    Population known = judge(first_points(problem, kCmaPoints));
    for (std::uint64_t restart = 0; restart < 50; ++restart) {
      RandomStream random(problem.seed, "cmaes", restart);
      const auto best = std::min_element(
          known.begin(), known.end(),
          [](const Individual& a, const Individual& b) { return a.fitness[0] < b.fitness[0]; });
      Cma cma(Eigen::Map<const Eigen::VectorXd>(best->unit.data(),
                                                static_cast<Eigen::Index>(best->unit.size())),
              kCmaStep, static_cast<int>(kCmaPoints));
      do {
        Population generation = judge(cma.ask(random));
        known.insert(known.end(), generation.begin(), generation.end());
        cma.tell(std::move(generation));
      } while (!cma.converged());
    }
  });
}

}  // namespace papilla::optim
