// The potential on columns of nodes: conjugate gradients with one multigrid cycle each, and the
// pull that follows from its energy.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/watch.h"
#include "numerics/reductions.h"
#include "physics/electrostatics/column_operator.h"
#include "physics/electrostatics/field_columns.h"
#include "physics/electrostatics/water_bodies.h"

namespace papilla::electrostatics {
namespace {

// The potential of a column at a height within one of its cells, by its two nodes.
struct Interpolation {
  int cell;
  double upper;  // weight of the node above
  double lower() const { return 1 - upper; }
};
Interpolation interpolate(const FieldColumns& c, std::size_t column, int cell, double z) {
  return {cell, (z - c.z(column, cell)) * c.inverse_height(column, cell)};
}

// The neighbour of a column across its eastern or northern face.
struct Neighbour {
  std::size_t column;
  int ix, iy;
  double face;  // its width over the distance of the columns
  bool east;
};

template <class Visit>
void for_each_face(const Grid& g, Visit&& visit) {
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const std::size_t i = g.index(ix, iy);
      const int e = ix + 1 < g.nx ? ix + 1 : 0, n = iy + 1 < g.ny ? iy + 1 : 0;
      if (g.nx > 1) visit(i, ix, iy, Neighbour{g.index(e, iy), e, iy, g.dy() / g.dx(), true});
      if (g.ny > 1) visit(i, ix, iy, Neighbour{g.index(ix, n), ix, n, g.dx() / g.dy(), false});
    }
  }
}

int dielectric_cells(const PotentialProblem& p, const PotentialOptions& options) {
  if (options.dielectric_cells > 0) return options.dielectric_cells;
  double thickest = 0;
  for (std::size_t i = 0; i < p.surface.size(); ++i)
    thickest = std::max(thickest, p.surface[i] - p.electrode[i]);
  const double pixels = thickest / std::min(p.grid.dx(), p.grid.dy());
  return static_cast<int>(std::lround(std::clamp(2 + 0.5 * pixels, 4.0, 8.0)));
}

class PotentialSolver {
 public:
  PotentialSolver(const PotentialProblem& problem, const PotentialOptions& options)
      : problem_(problem),
        options_(options),
        columns_(problem, dielectric_cells(problem, options), options.air_cells),
        water_(problem.grid, problem.bridged, problem.water_skin_layer <= 0),
        unknowns_(columns_.nodes() - 2) {
    for (int iy = 0; iy < problem.grid.ny; ++iy) {
      for (int ix = 0; ix < problem.grid.nx; ++ix) first_.push_back(node(ix, iy, 1));
    }
  }

  PotentialSolution run(PotentialSolution out) {
    ColumnMultigrid multigrid(assembled());
    start();
    iterate(multigrid, out);
    measure(out);
    return out;
  }

 private:
  // Assembly of the energy's quadratic form, over eps0 dx.
  ColumnOperator assembled() {
    const Grid& g = problem_.grid;
    ColumnOperator a(g.nx, g.ny, unknowns_);
    drive_.assign(a.size(), 0);
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        const std::size_t i = g.index(ix, iy);
        for (int k = 0; k < columns_.top(i); ++k) {
          join(a, {i, ix, iy, k}, {i, ix, iy, k + 1}, g.dy() / columns_.resistance(i, k));
        }
      }
    }
    for_each_face(g, [&](std::size_t i, int ix, int iy, const Neighbour& n) {
      columns_.exchanges(i, n.column, n.face,
                         [&](const Exchange& e) { add_exchange(a, e, i, ix, iy, n); });
      tie_water(a, i, ix, iy, n);
    });
    return a;
  }

  // Water leads: nothing flows between potentials that it can have, but the multigrid, which does
  // not know them, comes nearer to them.
  void tie_water(ColumnOperator& m, std::size_t i, int ix, int iy, const Neighbour& n) {
    constexpr double kFirm = 30;  // over what leads to the body
    if (water_.grounded() || !columns_.bridged(i) || !columns_.bridged(n.column)) return;
    const int k = columns_.cells_below_surface();
    join(m, {i, ix, iy, k}, {n.column, n.ix, n.iy, k},
         kFirm * problem_.grid.dy() / problem_.water_skin_layer);
  }

  struct Node {
    std::size_t column;
    int ix, iy, k;
  };
  // Adds c/2 (phi_a - phi_b)^2.
  void join(ColumnOperator& m, const Node& a, const Node& b, double c) {
    const bool fixed_a = columns_.fixed(a.column, a.k), fixed_b = columns_.fixed(b.column, b.k);
    if (fixed_a && fixed_b) return;
    if (fixed_a || fixed_b) {
      const Node &free = fixed_a ? b : a, &body = fixed_a ? a : b;
      m.add_body(free.ix, free.iy, free.k - 1, c);
      drive_[m.index(free.ix, free.iy, free.k - 1)] += c * columns_.body_potential(body.k);
    } else if (a.column == b.column) {
      m.add_own(a.ix, a.iy, a.k - 1, b.k - 1, c);
    } else if (a.iy == b.iy) {
      m.add_east(a.ix, a.iy, a.k - 1, b.k - 1, c);
    } else {
      m.add_north(a.ix, a.iy, a.k - 1, b.k - 1, c);
    }
  }

  bool free(std::size_t column, int cell) const {  // both nodes of it
    return cell > 0 && cell + 1 < columns_.top(column);
  }

  // The square of a difference between interpolated potentials as conductances between nodes.
  void add_exchange(ColumnOperator& m, const Exchange& e, std::size_t i, int ix, int iy,
                    const Neighbour& n) {
    const double c = e.conductance / problem_.grid.dx();
    if (e.body == Body::None && free(i, e.here) && free(n.column, e.there)) {
      add_between_free(m, e, c, i, ix, iy, n);
    } else {
      add_between(m, e, c, i, ix, iy, n);
    }
  }

  // Most exchanges: four nodes, none of them at a body.
  void add_between_free(ColumnOperator& m, const Exchange& e, double c, std::size_t i, int ix,
                        int iy, const Neighbour& n) const {
    const Interpolation a = interpolate(columns_, i, e.here, e.middle);
    const Interpolation b = interpolate(columns_, n.column, e.there, e.middle);
    const int p = e.here - 1, q = e.there - 1;  // unknowns of the lower nodes
    m.add_own(ix, iy, p, p + 1, -c * a.lower() * a.upper);
    m.add_own(n.ix, n.iy, q, q + 1, -c * b.lower() * b.upper);
    const auto across = [&](int above_a, int above_b, double weight) {
      n.east ? m.add_east(ix, iy, p + above_a, q + above_b, c * weight)
             : m.add_north(ix, iy, p + above_a, q + above_b, c * weight);
    };
    across(0, 0, a.lower() * b.lower());
    across(0, 1, a.lower() * b.upper);
    across(1, 0, a.upper * b.lower());
    across(1, 1, a.upper * b.upper);
  }

  void add_between(ColumnOperator& m, const Exchange& e, double c, std::size_t i, int ix, int iy,
                   const Neighbour& n) {
    std::array<Node, 4> nodes;
    std::array<double, 4> weight{};
    int count = 0;
    const auto put = [&](std::size_t column, int x, int y, int cell, double sign) {
      const Interpolation at = interpolate(columns_, column, cell, e.middle);
      nodes[count] = {column, x, y, cell};
      weight[count++] = sign * at.lower();
      nodes[count] = {column, x, y, cell + 1};
      weight[count++] = sign * at.upper;
    };
    const auto put_body = [&](std::size_t column, int x, int y, double sign) {
      nodes[count] = {column, x, y, body_node(e, column)};
      weight[count++] = sign;
    };
    e.here >= 0 ? put(i, ix, iy, e.here, 1) : put_body(i, ix, iy, 1);
    e.there >= 0 ? put(n.column, n.ix, n.iy, e.there, -1) : put_body(n.column, n.ix, n.iy, -1);
    // The weights sum to zero: (sum w phi)^2 = - sum over pairs of w_p w_q (phi_p - phi_q)^2.
    for (int p = 0; p < count; ++p) {
      for (int q = p + 1; q < count; ++q) {
        const double conductance = -c * weight[p] * weight[q];
        if (conductance != 0) join(m, nodes[p], nodes[q], conductance);
      }
    }
  }

  // The node that a column shows to its neighbour where that meets its body.
  int body_node(const Exchange& e, std::size_t column) const {
    if (e.body == Body::Electrode) return 0;
    return columns_.bridged(column) ? columns_.cells_below_surface() : columns_.nodes() - 1;
  }

  // Potentials that the water can have, nearest to these at the nodes.
  void level(std::vector<double>& values) const {
    if (!water_.grounded()) water_.level(values, [&](std::size_t i) { return water_node(i); });
  }
  std::size_t water_node(std::size_t column) const {
    return first_[column] +
           static_cast<std::size_t>(columns_.cells_below_surface() - 1) * problem_.grid.nx;
  }

  // Every column by itself.
  void start() {
    const Grid& g = problem_.grid;
    phi_.assign(drive_.size(), 0);
    energy_ = 0;
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        const std::size_t i = g.index(ix, iy);
        double total = 0, below = 0;
        for (int k = 0; k < columns_.top(i); ++k) total += columns_.resistance(i, k);
        energy_ += g.dy() / total;
        for (int k = 1; k < columns_.top(i); ++k) {
          below += columns_.resistance(i, k - 1);
          phi_[node(ix, iy, k)] = 1 - below / total;
        }
      }
    }
    level(phi_);
  }

  void iterate(ColumnMultigrid& multigrid, PotentialSolution& out) {
    const std::size_t n = phi_.size();
    std::vector<double> r(n), q(n), s(n, 0.0), z(n);
    multigrid.fine().apply(phi_, q);
    for (std::size_t o = 0; o < n; ++o) r[o] = drive_[o] - q[o];
    double old = 0;
    for (out.iterations = 0;; ++out.iterations) {
      level(r);
      for (std::size_t o = 0; o < n; ++o) multigrid.b()[o] = static_cast<float>(r[o]);
      multigrid.cycle();
      std::copy(multigrid.x().begin(), multigrid.x().end(), z.begin());
      level(z);
      double rz = 0;
      for (std::size_t o = 0; o < n; ++o) rz += r[o] * z[o];
      out.residual = std::sqrt(std::max(rz, 0.0) / energy_);
      if (finished(out)) return;
      const double beta = out.iterations > 0 ? rz / old : 0;
      for (std::size_t o = 0; o < n; ++o) s[o] = z[o] + beta * s[o];
      multigrid.fine().apply(s, q);
      const double alpha = rz / dot(s, q);
      for (std::size_t o = 0; o < n; ++o) {
        phi_[o] += alpha * s[o];
        r[o] -= alpha * q[o];
      }
      old = rz;
    }
  }

  // Whether the iteration ends here, for better or worse.
  bool finished(PotentialSolution& out) const {
    Watch::look();
    if (!std::isfinite(out.residual)) {
      out.ok = false;
      out.reason = "the potential is not finite";
      return true;
    }
    if (out.residual <= options_.tolerance) return true;
    if (out.iterations < options_.max_iterations) return false;
    out.ok = false;
    out.reason = fmt::format("the potential has not converged: residual {:.1e} after {} cycles",
                             out.residual, out.iterations);
    return true;
  }

  // Eq. electrostatics.14: the charge, and what it loses as the skin over each column rises. Nodes
  // rise with the skin, each by its share; the potentials at the nodes are stationary.
  void measure(PotentialSolution& out) const {
    const Grid& g = problem_.grid;
    std::vector<double> loss(g.size(), 0.0);  // -dC/dz of the skin over a column, over eps0 [m]
    for (std::size_t i = 0; i < g.size(); ++i) {
      for (int k = 0; k < columns_.top(i); ++k) {
        const double difference = phi(i, k) - phi(i, k + 1), r = columns_.resistance(i, k);
        const double energy = g.dx() * g.dy() * square(difference) / r;
        out.capacitance += energy;
        if (k >= columns_.cells_below_surface())
          loss[i] += energy / r * (columns_.rise(i, k + 1) - columns_.rise(i, k)) /
                     columns_.permittivity(i, k);
      }
    }
    for_each_face(g, [&](std::size_t i, int, int, const Neighbour& n) {
      columns_.exchanges(i, n.column, n.face,
                         [&](const Exchange& e) { add_loss(e, i, n.column, loss, out); });
    });
    for (std::size_t i = 0; i < g.size(); ++i) {
      out.surface_potential[i] = phi(i, columns_.cells_below_surface());
      if (columns_.bridged(i)) continue;
      out.square_field[i] = loss[i] / (g.dx() * g.dy());
      if (problem_.skin[i] > problem_.surface[i])
        out.peak_air = std::max(out.peak_air, std::sqrt(std::max(out.square_field[i], 0.0)));
    }
  }

  // At a fixed height the potential of a column falls with its gradient times the rise of its
  // nodes; where the neighbour is the skin, the way to it changes too.
  void add_loss(const Exchange& e, std::size_t i, std::size_t j, std::vector<double>& loss,
                PotentialSolution& out) const {
    const auto value = [&](std::size_t column, int cell) {
      if (cell < 0) return phi(column, body_node(e, column));
      const Interpolation at = interpolate(columns_, column, cell, e.middle);
      return at.lower() * phi(column, cell) + at.upper * phi(column, cell + 1);
    };
    const double difference = value(i, e.here) - value(j, e.there);
    out.capacitance += e.conductance * square(difference);
    const auto falls = [&](std::size_t column, int cell, double sign) {
      if (cell < columns_.cells_below_surface() || columns_.bridged(column)) return;
      const Interpolation at = interpolate(columns_, column, cell, e.middle);
      const double rise =
          at.lower() * columns_.rise(column, cell) + at.upper * columns_.rise(column, cell + 1);
      const double gradient =
          (phi(column, cell + 1) - phi(column, cell)) * columns_.inverse_height(column, cell);
      loss[column] += sign * 2 * e.conductance * difference * gradient * rise;
    };
    falls(i, e.here, 1);
    falls(j, e.there, -1);
    const std::size_t own = e.here >= 0 ? i : j, other = e.here >= 0 ? j : i;
    if (e.per_rise > 0) {
      const int cell = e.here >= 0 ? e.here : e.there;
      const Interpolation at = interpolate(columns_, own, cell, e.end);
      const double top = at.lower() * phi(own, cell) + at.upper * phi(own, cell + 1);
      loss[own] -= e.per_rise * square(top - phi(other, body_node(e, other)));
    }
    if (e.body != Body::Skin) return;
    const double energy = e.conductance * square(difference) / e.jump;
    loss[own] += energy * (1 - e.share) / e.share;
    loss[other] += energy;
  }

  std::size_t node(int ix, int iy, int k) const {
    return (static_cast<std::size_t>(iy) * unknowns_ + (k - 1)) * problem_.grid.nx + ix;
  }
  double phi(std::size_t column, int k) const {
    if (columns_.fixed(column, k)) return columns_.body_potential(k);
    return phi_[first_[column] + static_cast<std::size_t>(k - 1) * problem_.grid.nx];
  }

  const PotentialProblem& problem_;
  const PotentialOptions& options_;
  FieldColumns columns_;
  WaterBodies water_;
  int unknowns_;                    // of a column
  std::vector<std::size_t> first_;  // node of each column
  std::vector<double> drive_;       // of the electrode's volt
  std::vector<double> phi_;         // at the nodes between the bodies
  double energy_ = 0;  // of the columns by themselves, over eps0 dx: the residual's scale
};

PotentialSolution failed(PotentialSolution out, std::string reason) {
  out.ok = false;
  out.reason = std::move(reason);
  return out;
}

}  // namespace

PotentialSolution solve_potential(const PotentialProblem& problem,
                                  const PotentialOptions& options) {
  const std::size_t n = problem.grid.size();
  PAPILLA_CHECK(problem.electrode.size() == n && problem.surface.size() == n &&
                    problem.skin.size() == n && options.dielectric_cells >= 0 &&
                    options.air_cells >= 3,
                "heights on one grid, and room for droplets in the air");
  PotentialSolution out;
  out.square_field.assign(n, 0);
  out.surface_potential.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double total = problem.skin[i] - problem.electrode[i] + problem.skin_layer;
    if (!std::isfinite(total) || !std::isfinite(problem.surface[i]))
      return failed(std::move(out), "a height is not finite");
    const bool bridged = !problem.bridged.empty() && problem.bridged[i];
    if ((bridged ? problem.surface[i] - problem.electrode[i] : total) <= 0)
      return failed(std::move(out), "no dielectric anywhere: contact would short the drive");
  }
  return PotentialSolver(problem, options).run(std::move(out));
}

}  // namespace papilla::electrostatics
