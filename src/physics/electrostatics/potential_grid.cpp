#include "physics/electrostatics/potential_grid.h"

#include <cmath>
#include <utility>

namespace papilla::electrostatics {
namespace {

constexpr double kWallSlope = 3;         // steeper jumps between pixels are walls between them
constexpr double kLeastDistance = 0.05;  // of a body from a node, in node distances

constexpr int kBins = 512;  // of the height, for the density of nodes

struct HeightRange {
  double low = HUGE_VAL, high = -HUGE_VAL;  // [m]
  double bin() const { return (high - low) / kBins; }
};

// Where the flux passes: every column's, as if alone, over its dielectric and its gap.
std::vector<double> flux_density(const std::vector<FieldColumn>& columns,
                                 const HeightRange& range) {
  std::vector<double> change(kBins + 1, 0.0), density(kBins);
  const double low = range.low, bin = range.bin();
  const auto spread = [&](double a, double b, double weight) {
    const int i = std::clamp(static_cast<int>((a - low) / bin), 0, kBins - 1);
    const int j = std::clamp(static_cast<int>((b - low) / bin) + 1, i + 1, kBins);
    change[i] += weight / (j - i);
    change[j] -= weight / (j - i);
  };
  for (const FieldColumn& c : columns) {
    const double flux = 1 / std::max(c.total(), 1e-12);
    spread(c.electrode, c.surface, flux);
    spread(c.surface, c.skin, flux);
  }
  double running = 0;
  for (int i = 0; i < kBins; ++i) {
    running += change[i];
    density[i] = std::max(running, 0.0);
  }
  return density;
}

// Running means over `half` bins either side, twice; mirrored at the ends.
void smooth(std::vector<double>& density, int half) {
  std::vector<double> smoothed(kBins);
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < kBins; ++i) {
      double s = 0;
      for (int k = -half; k <= half; ++k) {
        int j = i + k;
        if (j < 0) j = -1 - j;
        if (j >= kBins) j = 2 * kBins - 1 - j;
        s += density[j];
      }
      smoothed[i] = s / (2 * half + 1);
    }
    density.swap(smoothed);
  }
}

// Heights of n nodes: dense where most of the flux passes, at most four per pixel width, smooth.
std::vector<double> node_heights(const std::vector<FieldColumn>& columns, double pixel, int n) {
  HeightRange range;
  for (const FieldColumn& c : columns) {
    range.low = std::min(range.low, c.electrode);
    range.high = std::max(range.high, c.skin);
  }
  const double bin = range.bin();
  std::vector<double> density = flux_density(columns, range);
  double sum = 0;
  for (double d : density) sum += d;
  smooth(density, std::clamp(static_cast<int>(2 * pixel / bin), kBins / 32, kBins / 4));
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
    z[k] = range.low + bin * (i + std::clamp((target - below) / density[i], 0.0, 1.0));
  }
  return z;
}

}  // namespace

std::vector<FieldColumn> columns_of(const PotentialProblem& p) {
  std::vector<FieldColumn> columns(p.grid.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    FieldColumn& c = columns[i];
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

PotentialGrid::PotentialGrid(const PotentialProblem& problem, std::vector<FieldColumn> columns,
                             int levels)
    : grid_(problem.grid), levels_(levels), columns_(std::move(columns)) {
  z_ = node_heights(columns_, std::min(grid_.dx(), grid_.dy()), levels);
  assemble();
}

double PotentialGrid::cell_low(int k) const {
  return k > 0 ? 0.5 * (z_[k - 1] + z_[k]) : 1.5 * z_[0] - 0.5 * z_[1];
}
double PotentialGrid::cell_high(int k) const {
  const int n = levels_;
  return k + 1 < n ? 0.5 * (z_[k] + z_[k + 1]) : 1.5 * z_[n - 1] - 0.5 * z_[n - 2];
}

void PotentialGrid::assemble() {
  const Grid& g = grid_;
  const int nz = levels_;
  fine_.nx = g.nx;
  fine_.ny = g.ny;
  fine_.nz = nz;
  fine_.allocate();
  electrode_.assign(fine_.size(), 0);
  first_.resize(g.size());
  last_.resize(g.size());
  permittivity_.assign(fine_.size(), 0);
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      fill_column(ix, iy);
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

// Nodes outside the bodies, conductances along the column and cell averages of the permittivity.
void PotentialGrid::fill_column(int ix, int iy) {
  const Grid& g = grid_;
  const int nz = levels_;
  const double area = g.dy();  // every conductance is over eps0 dx
  const std::size_t i = g.index(ix, iy);
  const FieldColumn& c = columns_[i];
  // Nodes keep a little off the bodies.
  int a = static_cast<int>(std::upper_bound(z_.begin(), z_.end(), c.electrode) - z_.begin());
  int b = static_cast<int>(std::lower_bound(z_.begin(), z_.end(), c.skin) - z_.begin()) - 1;
  const auto step = [&](int k) { return kLeastDistance * (cell_high(k) - cell_low(k)); };
  if (a < nz && z_[a] - c.electrode < step(a)) ++a;
  if (b >= 0 && c.skin - z_[b] < step(b)) --b;
  first_[i] = a;
  last_[i] = b;
  if (a > b) return;
  double below = 0;
  for (int k = a; k <= b; ++k) {
    const std::size_t o = node(ix, iy, k);
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
  fine_.body[node(ix, iy, b)] += static_cast<float>(area / (c.total() - below));
}

// Conductances across the face (width over eps0 dx) between two columns `step` apart.
void PotentialGrid::join(int ax, int ay, int bx, int by, std::vector<float>& link, double step,
                         double width) {
  const std::size_t a = grid_.index(ax, ay), b = grid_.index(bx, by);
  if (a == b) return;
  const int from = std::max(first_[a], first_[b]), to = std::min(last_[a], last_[b]);
  for (int k = from; k <= to; ++k) {
    const std::size_t o = node(ax, ay, k);
    const float ea = permittivity_[o], eb = permittivity_[node(bx, by, k)];
    // over dx: face height * face width / (step * dx)
    link[o] =
        static_cast<float>((cell_high(k) - cell_low(k)) * width / step) * (2 * ea * eb / (ea + eb));
  }
  reach(a, ax, ay, b, step, width);
  reach(b, bx, by, a, step, width);
}

// From nodes of a to the bodies in column b.
void PotentialGrid::reach(std::size_t a, int ax, int ay, std::size_t b, double step, double width) {
  const FieldColumn &ca = columns_[a], &cb = columns_[b];
  const double middle = 0.5 * (cb.electrode + cb.skin);
  for (int k = first_[a]; k <= last_[a]; ++k) {
    if (k >= first_[b] && k <= last_[b]) {
      k = last_[b];
      continue;
    }
    const std::size_t o = node(ax, ay, k);
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

}  // namespace papilla::electrostatics
