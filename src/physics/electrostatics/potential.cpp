// The potential on a grid of nodes: conjugate gradients with one multigrid cycle each, and the
// fields that follow from it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/check.h"
#include "physics/electrostatics/multigrid.h"
#include "physics/electrostatics/potential_grid.h"

namespace papilla {
namespace {

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
  std::size_t i = 0;
  for (; i + 4 <= a.size(); i += 4) {
    s0 += a[i] * b[i];
    s1 += a[i + 1] * b[i + 1];
    s2 += a[i + 2] * b[i + 2];
    s3 += a[i + 3] * b[i + 3];
  }
  for (; i < a.size(); ++i) s0 += a[i] * b[i];
  return s0 + s1 + s2 + s3;
}

PotentialSolution failed(PotentialSolution out, std::string reason) {
  out.ok = false;
  out.reason = std::move(reason);
  return out;
}

class PotentialSolver {
 public:
  PotentialSolver(const PotentialProblem& problem, const PotentialOptions& options,
                  std::vector<FieldColumn> columns)
      : problem_(problem), options_(options), grid_(problem, std::move(columns), options.levels) {}

  PotentialSolution run(PotentialSolution out) {
    start();
    iterate(out);
    measure(out);
    return out;
  }

 private:
  // Every column by itself.
  void start() {
    const Grid& g = problem_.grid;
    phi_.assign(grid_.electrode().size(), 0);
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        const std::size_t i = g.index(ix, iy);
        const FieldColumn& c = grid_.columns()[i];
        const double total = c.total();
        for (int k = grid_.first(i); k <= grid_.last(i); ++k) {
          phi_[grid_.node(ix, iy, k)] = 1 - c.resistance(grid_.z(k)) / total;
        }
      }
    }
  }

  void iterate(PotentialSolution& out) {
    const std::size_t n = phi_.size();
    Multigrid multigrid(grid_.take_conductances());
    FieldLevel& f = multigrid.fine();
    std::vector<double> r(n), q(n), s(n, 0.0);
    f.apply(phi_, q);
    for (std::size_t o = 0; o < n; ++o) r[o] = grid_.electrode()[o] - q[o];
    double old = 0;
    for (out.iterations = 0;; ++out.iterations) {
      for (std::size_t o = 0; o < n; ++o) f.b[o] = static_cast<float>(r[o]);
      multigrid.cycle();
      double rz = 0;
      for (std::size_t o = 0; o < n; ++o) rz += r[o] * f.x[o];
      charge(out);
      out.residual = std::sqrt(std::max(rz, 0.0) / out.capacitance * problem_.grid.dx());
      if (finished(out)) return;
      const double beta = out.iterations > 0 ? rz / old : 0;
      for (std::size_t o = 0; o < n; ++o) s[o] = f.x[o] + beta * s[o];
      f.apply(s, q);
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

  // Charge of the electrode over eps0 [m].
  void charge(PotentialSolution& out) const {
    double sum = 0;
    for (std::size_t o = 0; o < phi_.size(); ++o) sum += grid_.electrode()[o] * (1 - phi_[o]);
    for (std::size_t i = 0; i < grid_.columns().size(); ++i) {
      if (grid_.first(i) > grid_.last(i)) sum += problem_.grid.dy() / grid_.columns()[i].total();
    }
    out.capacitance = sum * problem_.grid.dx();
  }

  void measure(PotentialSolution& out) const {
    const Grid& g = problem_.grid;
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        const std::size_t i = g.index(ix, iy);
        const FieldColumn& c = grid_.columns()[i];
        const bool closed = grid_.first(i) > grid_.last(i);
        const double flux = closed ? 1 / c.total() : flux_at_skin(ix, iy);
        if (closed) out.peak_dielectric = std::max(out.peak_dielectric, flux / c.permittivity);
        out.flux[i] = flux;
        inner_fields(ix, iy, out);
        if (c.bridged) continue;
        out.field[i] = flux * std::sqrt(1 + square_slope(ix, iy));
        if (c.skin > c.surface) out.peak_air = std::max(out.peak_air, out.field[i]);
      }
    }
  }

  // D/eps0 at the skin of a column with nodes.
  double flux_at_skin(int ix, int iy) const {
    const std::size_t i = problem_.grid.index(ix, iy);
    const FieldColumn& c = grid_.columns()[i];
    const int b = grid_.last(i);
    // In air the gradient at the skin by a parabola through it and two nodes.
    const int near =
        c.skin - grid_.z(b) < 0.3 * (grid_.cell_high(b) - grid_.cell_low(b)) ? b - 1 : b;
    if (!c.bridged && c.high == c.skin && near - 1 >= grid_.first(i) &&
        grid_.z(near - 1) >= c.low) {
      const double d1 = c.skin - grid_.z(near), d2 = c.skin - grid_.z(near - 1);
      const double w1 = d2 / (d1 * (d2 - d1)), w2 = d1 / (d2 * (d2 - d1));
      return (w1 * phi(ix, iy, near) - w2 * phi(ix, iy, near - 1)) / (1 + c.layer * (w1 - w2));
    }
    return phi(ix, iy, b) / (c.total() - c.resistance(grid_.z(b)));
  }

  double phi(int ix, int iy, int k) const { return phi_[grid_.node(ix, iy, k)]; }

  // Squared slope of the skin; pixels beside water count by their own side.
  double square_slope(int ix, int iy) const {
    const Grid& g = problem_.grid;
    const auto z = [&](int x, int y) {
      return problem_.skin[g.index(wrap(x, g.nx), wrap(y, g.ny))];
    };
    const double sx = (z(ix + 1, iy) - z(ix - 1, iy)) / (2 * g.dx());
    const double sy = (z(ix, iy + 1) - z(ix, iy - 1)) / (2 * g.dy());
    return square(sx) + square(sy);
  }

  // Largest fields at the nodes of a column.
  void inner_fields(int ix, int iy, PotentialSolution& out) const {
    const Grid& g = problem_.grid;
    const std::size_t i = g.index(ix, iy);
    const FieldColumn& c = grid_.columns()[i];
    const int ex = wrap(ix + 1, g.nx), wx = wrap(ix - 1, g.nx);
    const int ny = wrap(iy + 1, g.ny), sy = wrap(iy - 1, g.ny);
    for (int k = grid_.first(i); k < grid_.last(i); ++k) {
      const double flux = (phi(ix, iy, k) - phi(ix, iy, k + 1)) /
                          (c.resistance(grid_.z(k + 1)) - c.resistance(grid_.z(k)));
      double across = 0;
      for (auto [e, w, step] : {std::tuple{std::pair{ex, iy}, std::pair{wx, iy}, g.dx()},
                                std::tuple{std::pair{ix, ny}, std::pair{ix, sy}, g.dy()}}) {
        if (inside(e.first, e.second, k) && inside(w.first, w.second, k)) {
          across += square((phi(e.first, e.second, k) - phi(w.first, w.second, k)) / (2 * step));
        }
      }
      if (grid_.z(k + 1) <= c.surface) {
        const double e = std::hypot(flux / c.permittivity, std::sqrt(across));
        out.peak_dielectric = std::max(out.peak_dielectric, e);
      } else if (grid_.z(k) >= c.low && grid_.z(k + 1) <= c.high) {
        out.peak_air = std::max(out.peak_air, std::hypot(flux, std::sqrt(across)));
      }
    }
  }
  bool inside(int ix, int iy, int k) const {
    const std::size_t i = problem_.grid.index(ix, iy);
    return k >= grid_.first(i) && k <= grid_.last(i);
  }

  const PotentialProblem& problem_;
  const PotentialOptions& options_;
  PotentialGrid grid_;
  std::vector<double> phi_;  // at the nodes
};

}  // namespace

PotentialSolution solve_potential(const PotentialProblem& problem,
                                  const PotentialOptions& options) {
  const std::size_t n = problem.grid.size();
  PAPILLA_CHECK(problem.electrode.size() == n && problem.surface.size() == n &&
                    problem.skin.size() == n && options.levels >= 3,
                "heights on one grid");
  PotentialSolution out;
  out.flux.assign(n, 0);
  out.field.assign(n, 0);
  std::vector<FieldColumn> columns = columns_of(problem);
  for (const FieldColumn& c : columns) {
    if (!std::isfinite(c.total())) return failed(std::move(out), "a height is not finite");
    if (c.total() <= 0) {
      return failed(std::move(out), "no dielectric anywhere: contact would short the drive");
    }
  }
  return PotentialSolver(problem, options, std::move(columns)).run(std::move(out));
}

}  // namespace papilla
