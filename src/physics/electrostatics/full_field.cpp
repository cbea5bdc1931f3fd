#include "physics/electrostatics/full_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/check.h"
#include "base/constants.h"
#include "physics/electrostatics/breakdown.h"
#include "physics/electrostatics/electrode.h"

namespace papilla {
namespace {

constexpr double kWallSlope = 3;         // steeper jumps between pixels are walls between them
constexpr double kLeastDistance = 0.05;  // of a body from a node, in node distances
constexpr float kDamping = 0.8F;

// The media over one pixel.
struct Column {
  double electrode = 0, surface = 0, low = 0, high = 0, skin = 0;  // heights [m], ascending
  double permittivity = 1, layer = 0;
  bool bridged = false;

  static double overlap(double z, double a, double b) { return std::clamp(z, a, b) - a; }
  // Integral of 1/eps from the electrode to z [m].
  double resistance(double z) const {
    return overlap(z, electrode, surface) / permittivity +
           (overlap(z, surface, low) + overlap(z, high, skin)) / kWaterPermittivity +
           overlap(z, low, high);
  }
  // Integral of eps from the electrode to z [m].
  double permeance(double z) const {
    return overlap(z, electrode, surface) * permittivity +
           (overlap(z, surface, low) + overlap(z, high, skin)) * kWaterPermittivity +
           overlap(z, low, high);
  }
  double total() const { return resistance(skin) + layer; }
};

std::vector<Column> columns_of(const PotentialProblem& p) {
  std::vector<Column> columns(p.grid.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Column& c = columns[i];
    c.electrode = p.electrode[i];
    c.surface = std::max(p.surface[i], c.electrode);
    c.bridged = !p.bridged.empty() && p.bridged[i];
    c.skin = c.bridged ? c.surface : std::max(p.skin[i], c.surface);
    c.layer = c.bridged ? 0 : p.skin_layer;
    c.low = c.surface;
    if (!p.water_below.empty()) c.low = std::min(c.surface + p.water_below[i], c.skin);
    c.high = c.skin;
    if (!p.water_above.empty()) c.high = std::max(c.skin - p.water_above[i], c.low);
    c.permittivity = p.permittivity;
  }
  return columns;
}

// Heights of n nodes: dense where most of the flux passes, at most four a pixel width, smooth.
std::vector<double> node_heights(const std::vector<Column>& columns, double pixel, int n) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Column& c : columns) {
    low = std::min(low, c.electrode);
    high = std::max(high, c.skin);
  }
  constexpr int kBins = 512;
  const double bin = (high - low) / kBins;
  std::vector<double> change(kBins + 1, 0.0), density(kBins);
  const auto spread = [&](double a, double b, double weight) {
    const int i = std::clamp(static_cast<int>((a - low) / bin), 0, kBins - 1);
    const int j = std::clamp(static_cast<int>((b - low) / bin) + 1, i + 1, kBins);
    change[i] += weight / (j - i);
    change[j] -= weight / (j - i);
  };
  for (const Column& c : columns) {
    const double flux = 1 / std::max(c.total(), 1e-12);
    spread(c.electrode, c.surface, flux);
    spread(c.surface, c.skin, flux);
  }
  double sum = 0, running = 0;
  for (int i = 0; i < kBins; ++i) {
    running += change[i];
    density[i] = std::max(running, 0.0);
    sum += density[i];
  }
  const int half = std::clamp(static_cast<int>(2 * pixel / bin), kBins / 32, kBins / 4);
  std::vector<double> smooth(kBins);
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < kBins; ++i) {
      double s = 0;
      for (int k = -half; k <= half; ++k) {
        int j = i + k;  // mirrored at the ends
        if (j < 0) j = -1 - j;
        if (j >= kBins) j = 2 * kBins - 1 - j;
        s += density[j];
      }
      smooth[i] = s / (2 * half + 1);
    }
    density.swap(smooth);
  }
  const double most = 4 * bin / (pixel * n);  // share of the nodes in a bin
  for (double& d : density) d = 0.4 / kBins + 0.6 * d / sum;
  for (int pass = 0; pass < 4; ++pass) {
    double total = 0;
    for (double& d : density) total += d = std::min(d, std::max(most, 1.0 / kBins));
    for (double& d : density) d /= total;
  }
  std::vector<double> z(n);
  double below = 0;
  int i = 0;
  for (int k = 0; k < n; ++k) {
    const double target = (k + 0.5) / n;
    while (i < kBins - 1 && below + density[i] < target) below += density[i++];
    z[k] = low + bin * (i + std::clamp((target - below) / density[i], 0.0, 1.0));
  }
  return z;
}

// One grid: conductances between nodes and to bodies. Row (iy, k) is contiguous in ix.
struct Level {
  int nx = 0, ny = 0, nz = 0;
  std::vector<float> cx, cy, cz, body;   // to ix+1, iy+1, k+1, to electrode and skin
  std::vector<float> diagonal, inverse;  // inverse: of the line elimination's pivots
  std::vector<float> b, x, r;

  std::size_t row(int iy, int k) const {
    return (static_cast<std::size_t>(iy) * nz + k) * static_cast<std::size_t>(nx);
  }
  std::size_t size() const { return static_cast<std::size_t>(nx) * ny * nz; }

  void allocate(bool with_body) {
    for (auto* v : {&cx, &cy, &cz}) v->assign(size(), 0);
    if (with_body) body.assign(size(), 0);
  }

  void factor() {
    diagonal.resize(size());
    inverse.resize(size());
    for (auto* v : {&b, &x, &r}) v->assign(size(), 0);
    for (int iy = 0; iy < ny; ++iy) {
      const int before = iy > 0 ? iy - 1 : ny - 1;
      for (int k = 0; k < nz; ++k) {
        const std::size_t here = row(iy, k), south = row(before, k);
        const std::size_t below = k > 0 ? row(iy, k - 1) : here;
        for (int i = 0; i < nx; ++i) {
          float d = body[here + i] + cx[here + i] + cx[here + (i > 0 ? i - 1 : nx - 1)] +
                    cy[here + i] + cy[south + i] + cz[here + i];
          if (k > 0) d += cz[below + i];
          if (d <= 0) d = 1;  // inside a body
          diagonal[here + i] = d;
          float pivot = d;
          if (k > 0) pivot -= cz[below + i] * cz[below + i] * inverse[below + i];
          inverse[here + i] = 1 / pivot;
        }
      }
    }
  }

  // x = or += damping * T^-1 rhs, T the lines along z; rhs is overwritten.
  void relax(std::vector<float>& rhs, bool add) {
    for (int iy = 0; iy < ny; ++iy) {
      for (int k = 1; k < nz; ++k) {
        float* here = rhs.data() + row(iy, k);
        const float* below = rhs.data() + row(iy, k - 1);
        const float* c = cz.data() + row(iy, k - 1);
        const float* w = inverse.data() + row(iy, k - 1);
        for (int i = 0; i < nx; ++i) here[i] += c[i] * w[i] * below[i];
      }
      for (int k = nz - 1; k >= 0; --k) {
        float* here = rhs.data() + row(iy, k);
        const float* w = inverse.data() + row(iy, k);
        float* out = x.data() + row(iy, k);
        if (k == nz - 1) {
          for (int i = 0; i < nx; ++i) here[i] *= w[i];
        } else {
          const float* above = here + nx;
          const float* c = cz.data() + row(iy, k);
          for (int i = 0; i < nx; ++i) here[i] = (here[i] + c[i] * above[i]) * w[i];
        }
        if (add) {
          for (int i = 0; i < nx; ++i) out[i] += kDamping * here[i];
        } else {
          for (int i = 0; i < nx; ++i) out[i] = kDamping * here[i];
        }
      }
    }
  }

  // r = b - A x
  void residual() {
    for (int iy = 0; iy < ny; ++iy) {
      const int south = iy > 0 ? iy - 1 : ny - 1, north = iy + 1 < ny ? iy + 1 : 0;
      for (int k = 0; k < nz; ++k) {
        const std::size_t o = row(iy, k), s = row(south, k), n = row(north, k);
        const float *xo = x.data() + o, *xs = x.data() + s, *xn = x.data() + n;
        const float *ex = cx.data() + o, *en = cy.data() + o, *es = cy.data() + s;
        const float *dg = diagonal.data() + o, *bo = b.data() + o;
        float* ro = r.data() + o;
        for (int i = 0; i < nx; ++i) {
          ro[i] = bo[i] - dg[i] * xo[i] + en[i] * xn[i] + es[i] * xs[i];
        }
        for (int i = 0; i + 1 < nx; ++i) ro[i] += ex[i] * xo[i + 1];
        for (int i = 1; i < nx; ++i) ro[i] += ex[i - 1] * xo[i - 1];
        ro[nx - 1] += ex[nx - 1] * xo[0];
        ro[0] += ex[nx - 1] * xo[nx - 1];
        if (k > 0) {
          const float *c = cz.data() + o - nx, *xb = xo - nx;
          for (int i = 0; i < nx; ++i) ro[i] += c[i] * xb[i];
        }
        if (k + 1 < nz) {
          const float *c = cz.data() + o, *xa = xo + nx;
          for (int i = 0; i < nx; ++i) ro[i] += c[i] * xa[i];
        }
      }
    }
  }
};

// Two by two columns become one. Faces are twice as wide, nodes twice as far.
Level coarsen(const Level& f) {
  Level c;
  c.nx = (f.nx + 1) / 2;
  c.ny = (f.ny + 1) / 2;
  c.nz = f.nz;
  c.allocate(true);
  for (int iy = 0; iy < f.ny; ++iy) {
    const bool north = iy % 2 == 1 || iy + 1 == f.ny;
    for (int k = 0; k < f.nz; ++k) {
      const std::size_t from = f.row(iy, k), to = c.row(iy / 2, k);
      for (int i = 0; i < f.nx; ++i) {
        c.cz[to + i / 2] += f.cz[from + i];
        c.body[to + i / 2] += f.body[from + i];
        if (north && c.ny > 1) c.cy[to + i / 2] += 0.5F * f.cy[from + i];
        if ((i % 2 == 1 || i + 1 == f.nx) && c.nx > 1) {
          c.cx[to + i / 2] += 0.5F * f.cx[from + i];
        }
      }
    }
  }
  c.factor();
  return c;
}

class Multigrid {
 public:
  explicit Multigrid(Level fine) {
    fine.factor();
    levels_.push_back(std::move(fine));
    while (levels_.back().nx > 4 || levels_.back().ny > 4)
      levels_.push_back(coarsen(levels_.back()));
  }
  Level& fine() { return levels_.front(); }
  void cycle() { cycle(0); }  // fine().x from fine().b

 private:
  void cycle(std::size_t l) {
    Level& f = levels_[l];
    f.r = f.b;
    f.relax(f.r, false);
    if (l + 1 == levels_.size()) {
      for (int sweep = 0; sweep < 6; ++sweep) {
        f.residual();
        f.relax(f.r, true);
      }
      return;
    }
    Level& c = levels_[l + 1];
    f.residual();
    std::fill(c.b.begin(), c.b.end(), 0.0F);
    for (int iy = 0; iy < f.ny; ++iy) {
      for (int k = 0; k < f.nz; ++k) {
        const float* from = f.r.data() + f.row(iy, k);
        float* to = c.b.data() + c.row(iy / 2, k);
        for (int i = 0; i + 1 < f.nx; i += 2) to[i / 2] += from[i] + from[i + 1];
        if (f.nx % 2) to[f.nx / 2] += from[f.nx - 1];
      }
    }
    cycle(l + 1);
    for (int iy = 0; iy < f.ny; ++iy) {
      for (int k = 0; k < f.nz; ++k) {
        float* to = f.x.data() + f.row(iy, k);
        const float* from = c.x.data() + c.row(iy / 2, k);
        for (int i = 0; i + 1 < f.nx; i += 2) {
          to[i] += from[i / 2];
          to[i + 1] += from[i / 2];
        }
        if (f.nx % 2) to[f.nx - 1] += from[f.nx / 2];
      }
    }
    f.residual();
    f.relax(f.r, true);
  }

  std::vector<Level> levels_;
};

class PotentialSolver {
 public:
  PotentialSolver(const PotentialProblem& problem, const PotentialOptions& options)
      : p_(problem), options_(options), columns_(columns_of(problem)) {}

  PotentialSolution run() {
    PotentialSolution out;
    out.flux.assign(columns_.size(), 0);
    out.field.assign(columns_.size(), 0);
    for (const Column& c : columns_) {
      if (!std::isfinite(c.total())) return failed(out, "a height is not finite");
      if (c.total() <= 0)
        return failed(out, "no dielectric anywhere: contact would short the drive");
    }
    z_ = node_heights(columns_, std::min(p_.grid.dx(), p_.grid.dy()), options_.levels);
    assemble();
    iterate(out);
    measure(out);
    return out;
  }

 private:
  static PotentialSolution& failed(PotentialSolution& out, const char* reason) {
    out.ok = false;
    out.reason = reason;
    return out;
  }

  double cell_low(int k) const {
    return k > 0 ? 0.5 * (z_[k - 1] + z_[k]) : 1.5 * z_[0] - 0.5 * z_[1];
  }
  double cell_high(int k) const {
    const int n = options_.levels;
    return k + 1 < n ? 0.5 * (z_[k] + z_[k + 1]) : 1.5 * z_[n - 1] - 0.5 * z_[n - 2];
  }

  void assemble() {
    const Grid& g = p_.grid;
    const int nz = options_.levels;
    fine_.nx = g.nx;
    fine_.ny = g.ny;
    fine_.nz = nz;
    fine_.allocate(true);
    electrode_.assign(fine_.size(), 0);
    first_.resize(g.size());
    last_.resize(g.size());
    permittivity_.assign(fine_.size(), 0);
    const double area = g.dy();  // every conductance is over eps0 dx
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        const std::size_t i = g.index(ix, iy);
        const Column& c = columns_[i];
        // Nodes keep a little off the bodies.
        int a = static_cast<int>(std::upper_bound(z_.begin(), z_.end(), c.electrode) - z_.begin());
        int b = static_cast<int>(std::lower_bound(z_.begin(), z_.end(), c.skin) - z_.begin()) - 1;
        const auto step = [&](int k) { return kLeastDistance * (cell_high(k) - cell_low(k)); };
        if (a < nz && z_[a] - c.electrode < step(a)) ++a;
        if (b >= 0 && c.skin - z_[b] < step(b)) --b;
        first_[i] = a;
        last_[i] = b;
        if (a > b) continue;
        double below = 0;
        for (int k = a; k <= b; ++k) {
          const std::size_t o = fine_.row(iy, k) + ix;
          const double r = c.resistance(z_[k]);
          if (k == a) {
            electrode_[o] = static_cast<float>(area / r);
          } else {
            fine_.cz[o - g.nx] = static_cast<float>(area / (r - below));
          }
          below = r;
          const double lo = std::max(cell_low(k), c.electrode);
          const double hi = std::min(cell_high(k), c.skin);
          permittivity_[o] = static_cast<float>((c.permeance(hi) - c.permeance(lo)) / (hi - lo));
        }
        fine_.body[fine_.row(iy, b) + ix] += static_cast<float>(area / (c.total() - below));
      }
    }
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        join(ix, iy, ix + 1 < g.nx ? ix + 1 : 0, iy, fine_.cx, g.dx(), g.dy() / g.dx());
        join(ix, iy, ix, iy + 1 < g.ny ? iy + 1 : 0, fine_.cy, g.dy(), 1);
      }
    }
    for (std::size_t o = 0; o < fine_.size(); ++o) fine_.body[o] += electrode_[o];
  }

  // Conductances across the face (width over eps0 dx) between two columns `step` apart.
  void join(int ax, int ay, int bx, int by, std::vector<float>& link, double step, double width) {
    const std::size_t a = p_.grid.index(ax, ay), b = p_.grid.index(bx, by);
    if (a == b) return;
    const int from = std::max(first_[a], first_[b]), to = std::min(last_[a], last_[b]);
    for (int k = from; k <= to; ++k) {
      const std::size_t o = fine_.row(ay, k) + ax;
      const float ea = permittivity_[o], eb = permittivity_[fine_.row(by, k) + bx];
      // over dx: face height * face width / (step * dx)
      link[o] = static_cast<float>((cell_high(k) - cell_low(k)) * width / step) *
                (2 * ea * eb / (ea + eb));
    }
    reach(a, ax, ay, b, step, width);
    reach(b, bx, by, a, step, width);
  }

  // From nodes of a to the bodies in column b.
  void reach(std::size_t a, int ax, int ay, std::size_t b, double step, double width) {
    const Column &ca = columns_[a], &cb = columns_[b];
    const double middle = 0.5 * (cb.electrode + cb.skin);
    for (int k = first_[a]; k <= last_[a]; ++k) {
      if (k >= first_[b] && k <= last_[b]) {
        k = last_[b];
        continue;
      }
      const std::size_t o = fine_.row(ay, k) + ax;
      const bool down = z_[k] < middle;
      const double jump = down ? cb.electrode - ca.electrode : ca.skin - cb.skin;
      const double into = down ? z_[k] - ca.electrode : ca.skin - z_[k];
      const bool wall = jump > kWallSlope * step || (!down && cb.bridged);
      double t = wall ? 0.5 : jump > 0 ? into / jump : 1;
      t = std::clamp(t, kLeastDistance, 1.0);
      const double conductance = (cell_high(k) - cell_low(k)) * width /
                                 (t * step / permittivity_[o] + (down ? 0 : cb.layer));
      (down ? electrode_ : fine_.body)[o] += static_cast<float>(conductance);
    }
  }

  // out = A v; links as differences, so that constants stay exact.
  void apply(const std::vector<double>& v, std::vector<double>& out, const Level& f) const {
    const int nx = f.nx, ny = f.ny, nz = f.nz;
    for (int iy = 0; iy < ny; ++iy) {
      const int south = iy > 0 ? iy - 1 : ny - 1, north = iy + 1 < ny ? iy + 1 : 0;
      for (int k = 0; k < nz; ++k) {
        const std::size_t o = f.row(iy, k), s = f.row(south, k), n = f.row(north, k);
        const double *vo = v.data() + o, *vs = v.data() + s, *vn = v.data() + n;
        const float *ex = f.cx.data() + o, *en = f.cy.data() + o, *es = f.cy.data() + s;
        const float* d = f.body.data() + o;
        double* q = out.data() + o;
        for (int i = 0; i < nx; ++i) {
          q[i] = d[i] * vo[i] + en[i] * (vo[i] - vn[i]) + es[i] * (vo[i] - vs[i]);
        }
        for (int i = 0; i + 1 < nx; ++i) q[i] += ex[i] * (vo[i] - vo[i + 1]);
        for (int i = 1; i < nx; ++i) q[i] += ex[i - 1] * (vo[i] - vo[i - 1]);
        q[nx - 1] += ex[nx - 1] * (vo[nx - 1] - vo[0]);
        q[0] += ex[nx - 1] * (vo[0] - vo[nx - 1]);
        if (k > 0) {
          const float* c = f.cz.data() + o - nx;
          for (int i = 0; i < nx; ++i) q[i] += c[i] * (vo[i] - vo[i - nx]);
        }
        if (k + 1 < nz) {
          const float* c = f.cz.data() + o;
          for (int i = 0; i < nx; ++i) q[i] += c[i] * (vo[i] - vo[i + nx]);
        }
      }
    }
  }

  static double dot(const std::vector<double>& a, const std::vector<double>& b) {
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

  void iterate(PotentialSolution& out) {
    const Grid& g = p_.grid;
    const std::size_t n = fine_.size();
    Multigrid multigrid(std::move(fine_));
    Level& f = multigrid.fine();
    phi_.assign(n, 0);
    for (int iy = 0; iy < g.ny; ++iy) {  // start: every column by itself
      for (int ix = 0; ix < g.nx; ++ix) {
        const std::size_t i = g.index(ix, iy);
        const double total = columns_[i].total();
        for (int k = first_[i]; k <= last_[i]; ++k) {
          phi_[f.row(iy, k) + ix] = 1 - columns_[i].resistance(z_[k]) / total;
        }
      }
    }
    std::vector<double> r(n), q(n), s(n, 0.0);
    apply(phi_, q, f);
    for (std::size_t o = 0; o < n; ++o) r[o] = electrode_[o] - q[o];
    double old = 0;
    for (out.iterations = 0;; ++out.iterations) {
      for (std::size_t o = 0; o < n; ++o) f.b[o] = static_cast<float>(r[o]);
      multigrid.cycle();
      double rz = 0;
      for (std::size_t o = 0; o < n; ++o) rz += r[o] * f.x[o];
      charge(out);
      out.residual = std::sqrt(std::max(rz, 0.0) / out.capacitance * g.dx());
      if (!std::isfinite(out.residual)) {
        failed(out, "the potential is not finite");
        break;
      }
      if (out.residual <= options_.tolerance) break;
      if (out.iterations == options_.max_iterations) {
        out.ok = false;
        out.reason = fmt::format("the potential has not converged: residual {:.1e} after {} cycles",
                                 out.residual, out.iterations);
        break;
      }
      const double beta = out.iterations > 0 ? rz / old : 0;
      for (std::size_t o = 0; o < n; ++o) s[o] = f.x[o] + beta * s[o];
      apply(s, q, f);
      const double alpha = rz / dot(s, q);
      for (std::size_t o = 0; o < n; ++o) {
        phi_[o] += alpha * s[o];
        r[o] -= alpha * q[o];
      }
      old = rz;
    }
    fine_ = std::move(f);
  }

  // Charge of the electrode over eps0 [m].
  void charge(PotentialSolution& out) const {
    double sum = 0;
    for (std::size_t o = 0; o < phi_.size(); ++o) sum += electrode_[o] * (1 - phi_[o]);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (first_[i] > last_[i]) sum += p_.grid.dy() / columns_[i].total();
    }
    out.capacitance = sum * p_.grid.dx();
  }

  void measure(PotentialSolution& out) const {
    const Grid& g = p_.grid;
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        const std::size_t i = g.index(ix, iy);
        const Column& c = columns_[i];
        const int b = last_[i];
        double flux;
        if (first_[i] > b) {
          flux = 1 / c.total();
          out.peak_dielectric = std::max(out.peak_dielectric, flux / c.permittivity);
        } else {
          flux = phi(ix, iy, b) / (c.total() - c.resistance(z_[b]));
          // In air the gradient at the skin by a parabola through it and two nodes.
          const int near = c.skin - z_[b] < 0.3 * (cell_high(b) - cell_low(b)) ? b - 1 : b;
          if (!c.bridged && c.high == c.skin && near - 1 >= first_[i] && z_[near - 1] >= c.low) {
            const double d1 = c.skin - z_[near], d2 = c.skin - z_[near - 1];
            const double w1 = d2 / (d1 * (d2 - d1)), w2 = d1 / (d2 * (d2 - d1));
            flux =
                (w1 * phi(ix, iy, near) - w2 * phi(ix, iy, near - 1)) / (1 + c.layer * (w1 - w2));
          }
        }
        out.flux[i] = flux;
        inner_fields(ix, iy, out);
        if (c.bridged) continue;
        out.field[i] = flux * std::sqrt(1 + square_slope(ix, iy));
        if (c.skin > c.surface) out.peak_air = std::max(out.peak_air, out.field[i]);
      }
    }
  }

  double phi(int ix, int iy, int k) const { return phi_[fine_.row(iy, k) + ix]; }

  // Squared slope of the skin; pixels beside water count by their own side.
  double square_slope(int ix, int iy) const {
    const Grid& g = p_.grid;
    const auto z = [&](int x, int y) { return p_.skin[g.index(wrap(x, g.nx), wrap(y, g.ny))]; };
    const double sx = (z(ix + 1, iy) - z(ix - 1, iy)) / (2 * g.dx());
    const double sy = (z(ix, iy + 1) - z(ix, iy - 1)) / (2 * g.dy());
    return square(sx) + square(sy);
  }

  // Largest fields at the nodes of a column.
  void inner_fields(int ix, int iy, PotentialSolution& out) const {
    const Grid& g = p_.grid;
    const std::size_t i = g.index(ix, iy);
    const Column& c = columns_[i];
    const int ex = wrap(ix + 1, g.nx), wx = wrap(ix - 1, g.nx);
    const int ny = wrap(iy + 1, g.ny), sy = wrap(iy - 1, g.ny);
    for (int k = first_[i]; k < last_[i]; ++k) {
      const double flux =
          (phi(ix, iy, k) - phi(ix, iy, k + 1)) / (c.resistance(z_[k + 1]) - c.resistance(z_[k]));
      double across = 0;
      for (auto [e, w, step] : {std::tuple{std::pair{ex, iy}, std::pair{wx, iy}, g.dx()},
                                std::tuple{std::pair{ix, ny}, std::pair{ix, sy}, g.dy()}}) {
        if (inside(e.first, e.second, k) && inside(w.first, w.second, k)) {
          across += square((phi(e.first, e.second, k) - phi(w.first, w.second, k)) / (2 * step));
        }
      }
      if (z_[k + 1] <= c.surface) {
        const double e = std::hypot(flux / c.permittivity, std::sqrt(across));
        out.peak_dielectric = std::max(out.peak_dielectric, e);
      } else if (z_[k] >= c.low && z_[k + 1] <= c.high) {
        out.peak_air = std::max(out.peak_air, std::hypot(flux, std::sqrt(across)));
      }
    }
  }
  bool inside(int ix, int iy, int k) const {
    const std::size_t i = p_.grid.index(ix, iy);
    return k >= first_[i] && k <= last_[i];
  }

  const PotentialProblem& p_;
  const PotentialOptions& options_;
  std::vector<Column> columns_;
  std::vector<double> z_;            // nodes [m]
  std::vector<int> first_, last_;    // nodes outside the bodies, a column
  std::vector<float> permittivity_;  // cell averages
  std::vector<float> electrode_;     // conductances to the electrode
  Level fine_;
  std::vector<double> phi_;
};

std::vector<double> columns_in_state(const Grid& grid, const Wetting& wetting, DropletState state) {
  Wetting some;
  some.grid = wetting.grid;
  for (const Droplet& d : wetting.droplets) {
    if (d.state == state) some.droplets.push_back(d);
  }
  if (some.droplets.empty()) return {};
  return droplet_columns(grid, some);
}

}  // namespace

PotentialSolution solve_potential(const PotentialProblem& problem,
                                  const PotentialOptions& options) {
  const std::size_t n = problem.grid.size();
  PAPILLA_CHECK(problem.electrode.size() == n && problem.surface.size() == n &&
                    problem.skin.size() == n && options.levels >= 3,
                "heights on one grid");
  return PotentialSolver(problem, options).run();
}

FieldSolution solve_full_field(const Gap& gap, const CoveredSurface* surface,
                               const Wetting& wetting, const FieldProblem& p,
                               const PotentialOptions& options) {
  FieldSolution out;
  const Grid& grid = gap.grid;
  const std::size_t n = grid.size();
  out.traction = {grid, std::vector<double>(n, 0)};
  if (p.v_rms == 0 && p.v_peak == 0) return out;

  PotentialProblem potential;
  potential.grid = grid;
  const bool walls = surface && !surface->behind_walls.empty();
  potential.surface = surface ? surface->height.z : std::vector<double>(n, 0);
  potential.electrode.resize(n);
  potential.skin.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    potential.electrode[i] = potential.surface[i] - p.dielectric_thickness;
    if (walls) potential.electrode[i] -= surface->behind_walls[i];
    potential.skin[i] = potential.surface[i] + gap.value[i];
  }
  if (p.dielectric_thickness > 0) {
    potential.permittivity = p.dielectric_thickness / p.dielectric;
  }
  potential.skin_layer = p.skin_layer.real();
  if (p.screening) potential.bridged = wetting.bridged;
  if (p.droplet_enhancement && !p.zero_under_droplets) {
    potential.water_below = columns_in_state(grid, wetting, DropletState::OnSubstrate);
    potential.water_above = columns_in_state(grid, wetting, DropletState::OnSkin);
    for (std::size_t i = 0; i < n; ++i) {  // as in the local rule a tenth of the gap stays air
      const double below = potential.water_below.empty() ? 0 : potential.water_below[i];
      const double above = potential.water_above.empty() ? 0 : potential.water_above[i];
      if (below + above <= 0.9 * gap.value[i]) continue;
      const double share = 0.9 * gap.value[i] / (below + above);
      if (below > 0) potential.water_below[i] *= share;
      if (above > 0) potential.water_above[i] *= share;
    }
  }
  const PotentialSolution s = solve_potential(potential, options);
  out.residual = s.residual;
  out.iterations = s.iterations;
  out.ok = s.ok;
  out.reason = s.reason;
  if (s.iterations == 0 && !s.ok) return out;

  std::vector<double> hidden;  // preset m3: no pull under any droplet
  if (p.zero_under_droplets && !wetting.droplets.empty()) hidden = droplet_columns(grid, wetting);
  const double scale = 0.5 * kVacuumPermittivity * square(p.v_rms);
  const double cap = p.breakdown_cap ? 0.5 * kVacuumPermittivity * square(kAirStrength) : HUGE_VAL;
  double sum = 0, over_sum = 0;
  std::size_t over = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!wetting.bridged.empty() && wetting.bridged[i]) continue;
    if (!hidden.empty() && hidden[i] > 0) continue;
    double field = s.field[i];
    if (p.skin_layer.imag() != 0) {
      field /= std::hypot(1, s.flux[i] * p.skin_layer.imag());
    }
    const double pressure = std::min(scale * square(field), cap);
    out.traction.value[i] = pressure;
    sum += pressure;
    const double g = gap.value[i];
    if (g > 0 && p.v_peak * field * g > air_breakdown_voltage(g)) {
      ++over;
      over_sum += pressure;
    }
  }
  out.mean_pressure = sum / static_cast<double>(n);
  out.over_limit_area = static_cast<double>(over) / static_cast<double>(n);
  out.over_limit_share = sum > 0 ? over_sum / sum : 0;
  out.peak_air_field = p.v_peak * s.peak_air;
  out.peak_oxide_field = p.v_peak * s.peak_dielectric;
  if (p.edge_radius > 0 && p.edge_radius < 2 * std::min(grid.dx(), grid.dy()) && walls) {
    out.peak_oxide_field =
        std::max(out.peak_oxide_field, p.v_peak / p.dielectric_thickness *
                                           corner_factor(p.dielectric_thickness, p.edge_radius));
  }
  return out;
}

}  // namespace papilla
