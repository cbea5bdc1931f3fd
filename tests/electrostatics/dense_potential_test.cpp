// The potential of the full field against the same energy as a dense quadratic form, and its pull
// against the numerical derivative of that energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "base/random.h"
#include "physics/electrostatics/field_columns.h"

namespace papilla::tests::dense_potential_test {
namespace {

// Rough bodies of few columns with all that a column can have: film, droplets, bridges, a layer.
PotentialProblem small_bodies(const Grid& grid) {
  PotentialProblem p;
  p.grid = grid;
  RandomStream random(12, "small bodies", static_cast<std::uint64_t>(grid.nx));
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double z = 150e-9 * random.uniform(), film = 60e-9 + 90e-9 * random.uniform();
    p.electrode.push_back(z - film);
    p.surface.push_back(z);
    p.skin.push_back(z + 40e-9 + 120e-9 * random.uniform());
    p.dielectric.push_back(film / (2 + 3 * random.uniform()));
    p.water_below.push_back(i % 5 == 1 ? 15e-9 : 0);
    p.water_above.push_back(i % 7 == 3 ? 12e-9 : 0);
    p.bridged.push_back(i % 6 == 4);
  }
  p.skin_layer = 25e-9;
  return p;
}

// Weights of the nodes in a difference of potentials, and its conductance over eps0 [m].
struct Term {
  std::vector<std::pair<std::size_t, double>> weight;
  double constant = 0;  // of the electrode's volt
  double conductance = 0;
};

class Dense {
 public:
  explicit Dense(const PotentialProblem& p) : g_(p.grid), c_(p, 4, 4), first_(g_.size() + 1, 0) {
    for (std::size_t i = 0; i < g_.size(); ++i)
      first_[i + 1] = first_[i] + static_cast<std::size_t>(c_.top(i) - 1);
    for (std::size_t i = 0; i < g_.size(); ++i) {
      for (int k = 0; k < c_.top(i); ++k) {
        Term t;
        put(t, i, k, 1);
        put(t, i, k + 1, -1);
        t.conductance = g_.pixel_area() / c_.resistance(i, k);
        terms_.push_back(t);
      }
    }
    each_exchange([&](std::size_t i, std::size_t j, const Exchange& e) {
      Term t;
      put_side(t, e, i, e.here, 1);
      put_side(t, e, j, e.there, -1);
      t.conductance = e.conductance;
      terms_.push_back(t);
    });
    solve();
  }

  double capacitance() const { return energy_of(phi_); }
  // Of the columns by themselves, over their own capacitance: in energy norm, squared.
  double excess_of_columns() const {
    std::vector<double> alone(phi_.size());
    double own = 0;
    for (std::size_t i = 0; i < g_.size(); ++i) {
      double total = 0, below = 0;
      for (int k = 0; k < c_.top(i); ++k) total += c_.resistance(i, k);
      own += g_.pixel_area() / total;
      for (int k = 1; k < c_.top(i); ++k) {
        below += c_.resistance(i, k - 1);
        alone[first_[i] + static_cast<std::size_t>(k - 1)] = 1 - below / total;
      }
    }
    return (energy_of(alone) - capacitance()) / own;
  }

  // -d(energy)/d(skin over a column), per area: potentials at the nodes held, nodes rising by their
  // share, and with the skin the way to it.
  double squared_field(std::size_t column) const {
    const double by = 1e-12;
    return (energy_risen(column, -by) - energy_risen(column, by)) / (2 * by) / g_.pixel_area();
  }

  double phi(std::size_t i, int k) const {
    return c_.fixed(i, k) ? c_.body_potential(k)
                          : phi_[first_[i] + static_cast<std::size_t>(k - 1)];
  }
  const FieldColumns& columns() const { return c_; }

 private:
  void each_exchange(
      const std::function<void(std::size_t, std::size_t, const Exchange&)>& visit) const {
    for (int iy = 0; iy < g_.ny; ++iy) {
      for (int ix = 0; ix < g_.nx; ++ix) {
        const std::size_t i = g_.index(ix, iy), east = g_.index((ix + 1) % g_.nx, iy),
                          north = g_.index(ix, (iy + 1) % g_.ny);
        c_.exchanges(i, east, g_.dy() / g_.dx(), [&](const Exchange& e) { visit(i, east, e); });
        c_.exchanges(i, north, g_.dx() / g_.dy(), [&](const Exchange& e) { visit(i, north, e); });
      }
    }
  }
  void put(Term& t, std::size_t i, int k, double weight) const {
    if (c_.fixed(i, k)) {
      t.constant += weight * c_.body_potential(k);
    } else {
      t.weight.emplace_back(first_[i] + static_cast<std::size_t>(k - 1), weight);
    }
  }
  void put_side(Term& t, const Exchange& e, std::size_t i, int cell, double sign) const {
    if (cell < 0) {
      t.constant += e.body == Body::Electrode ? sign : 0;
      return;
    }
    const double upper = (e.middle - c_.z(i, cell)) / (c_.z(i, cell + 1) - c_.z(i, cell));
    put(t, i, cell, sign * (1 - upper));
    put(t, i, cell + 1, sign * upper);
  }
  double energy_of(const std::vector<double>& phi) const {
    double sum = 0;
    for (const Term& t : terms_) {
      double difference = t.constant;
      for (const auto& [o, w] : t.weight) difference += w * phi[o];
      sum += t.conductance * square(difference);
    }
    return sum;
  }
  void solve() {
    const std::size_t n = first_.back();
    std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0));
    for (const Term& t : terms_) {
      for (const auto& [p, v] : t.weight) {
        for (const auto& [q, w] : t.weight) a[p][q] += t.conductance * v * w;
        a[p][n] -= t.conductance * v * t.constant;
      }
    }
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t i = k + 1; i < n; ++i) {
        const double f = a[i][k] / a[k][k];
        if (f == 0) continue;
        for (std::size_t j = k; j <= n; ++j) a[i][j] -= f * a[k][j];
      }
    }
    phi_.assign(n, 0);
    for (std::size_t k = n; k-- > 0;) {
      double left = a[k][n];
      for (std::size_t j = k + 1; j < n; ++j) left -= a[k][j] * phi_[j];
      phi_[k] = left / a[k][k];
    }
  }
  // At a fixed height, of a column whose nodes have moved up by their rise times `by`.
  double risen_value(const Exchange& e, std::size_t i, int cell, double by) const {
    if (cell < 0) return e.body == Body::Electrode ? 1 : 0;
    const double low = c_.z(i, cell) + by * c_.rise(i, cell),
                 high = c_.z(i, cell + 1) + by * c_.rise(i, cell + 1);
    return phi(i, cell) + (phi(i, cell + 1) - phi(i, cell)) * (e.middle - low) / (high - low);
  }
  double energy_risen(std::size_t column, double by) const {
    double sum = 0;
    for (int k = 0; k < c_.top(column); ++k) {
      const double taller = by * (c_.rise(column, k + 1) - c_.rise(column, k));
      sum += g_.pixel_area() * square(phi(column, k) - phi(column, k + 1)) /
             (c_.resistance(column, k) + taller / c_.permittivity(column, k));
    }
    each_exchange([&](std::size_t i, std::size_t j, const Exchange& e) {
      if (i != column && j != column) return;
      const double up_i = i == column && !c_.bridged(i) ? by : 0,
                   up_j = j == column && !c_.bridged(j) ? by : 0;
      double conductance = e.conductance;
      if (e.body == Body::Skin) {
        // From this column's skin at 0 down to the other's at -jump, at the height -share jump.
        const double own = e.here >= 0 ? up_i : up_j, other = e.here >= 0 ? up_j : up_i;
        const double share = (own + e.share * e.jump) / (own + e.jump - other);
        conductance *= e.share / share;
      }
      sum +=
          conductance * square(risen_value(e, i, e.here, up_i) - risen_value(e, j, e.there, up_j));
    });
    return sum;
  }

  Grid g_;
  FieldColumns c_;
  std::vector<std::size_t> first_;  // unknown of each column
  std::vector<Term> terms_;
  std::vector<double> phi_;
};

constexpr Grid kGrids[] = {{5, 4, 5e-7, 6e-7}, {3, 7, 6e-7, 7e-7}};

TEST(DensePotential, TheCapacitanceIsTheLeastEnergy) {
  for (const Grid& grid : kGrids) {
    for (const bool wet : {false, true}) {
      PotentialProblem p = small_bodies(grid);
      if (!wet) p.bridged.clear(), p.water_above.clear(), p.water_below.clear();
      const PotentialSolution s = solve_potential(
          p, {.dielectric_cells = 4, .air_cells = 4, .tolerance = 1e-9, .max_iterations = 200});
      ASSERT_TRUE(s.ok) << s.reason;
      EXPECT_NEAR(s.capacitance / Dense(p).capacitance(), 1, 1e-6) << grid.nx << wet;
    }
  }
}

TEST(DensePotential, ThePullIsWhatTheEnergyLosesAsNodesRise) {
  for (const Grid& grid : kGrids) {
    const PotentialProblem p = small_bodies(grid);
    const PotentialSolution s = solve_potential(
        p, {.dielectric_cells = 4, .air_cells = 4, .tolerance = 1e-9, .max_iterations = 200});
    ASSERT_TRUE(s.ok) << s.reason;
    const Dense dense(p);
    double largest = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const double expected = p.bridged[i] ? 0 : dense.squared_field(i);
      EXPECT_NEAR(s.square_field[i], expected, 2e-4 * s.peak_air * s.peak_air) << i;
      largest = std::max(largest, s.square_field[i]);
    }
    EXPECT_NEAR(s.peak_air, std::sqrt(largest), 1e-12 * s.peak_air);
  }
}

TEST(DensePotential, ThePotentialOnTheDielectricIsThatOfItsUppermostNode) {
  for (const Grid& grid : kGrids) {
    const PotentialProblem p = small_bodies(grid);
    const PotentialSolution s = solve_potential(
        p, {.dielectric_cells = 4, .air_cells = 4, .tolerance = 1e-9, .max_iterations = 200});
    const Dense dense(p);
    for (std::size_t i = 0; i < grid.size(); ++i)
      EXPECT_NEAR(s.surface_potential[i], dense.phi(i, 4), 1e-4) << i;
  }
}

// What is stated before the first step is how far the columns by themselves are off, as well as one
// cycle of multigrid knows it.
TEST(DensePotential, TheResidualIsTheErrorInEnergyNorm) {
  for (const Grid& grid : kGrids) {
    const PotentialProblem p = small_bodies(grid);
    const PotentialSolution s = solve_potential(
        p, {.dielectric_cells = 4, .air_cells = 4, .tolerance = 1e-9, .max_iterations = 0});
    EXPECT_FALSE(s.ok);
    EXPECT_EQ(s.iterations, 0);
    EXPECT_NEAR(square(s.residual) / Dense(p).excess_of_columns(), 1, 0.1);
  }
}

}  // namespace
}  // namespace papilla::tests::dense_potential_test
