#include "geometry/io/mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace papilla::geometry {
namespace {

// Lower envelope of parabolas over one periodic line: d[i] = min_j f[j] + (step (i - j))^2, j over
// three copies of the line; set() gets i, d[i] and j - i.
class Envelope {
 public:
  explicit Envelope(int n) : n_(n), f_(3 * size(n)), at_(3 * size(n)), edge_(3 * size(n) + 1) {}

  template <typename Get, typename Set>
  void run(double step, const Get& get, const Set& set) {
    const int m = 3 * n_;
    for (int i = 0; i < m; ++i) f_[size(i)] = get(i % n_);
    int k = -1;
    for (int q = 0; q < m; ++q) {
      if (f_[size(q)] == kInfinity) continue;
      double s = -kInfinity;
      while (k >= 0) {
        const int p = at_[size(k)];
        s = ((f_[size(q)] - f_[size(p)]) / (step * step) + 1.0 * q * q - 1.0 * p * p) /
            (2.0 * (q - p));
        if (s > edge_[size(k)]) break;
        --k;
      }
      if (k < 0) s = -kInfinity;
      ++k;
      at_[size(k)] = q;
      edge_[size(k)] = s;
      edge_[size(k + 1)] = kInfinity;
    }
    if (k < 0) {
      for (int i = 0; i < n_; ++i) set(i, kInfinity, 0);
      return;
    }
    int j = 0;
    for (int i = 0; i < n_; ++i) {
      const int q = i + n_;
      while (edge_[size(j + 1)] < q) ++j;
      const int p = at_[size(j)];
      set(i, f_[size(p)] + square(step * (q - p)), p - q);
    }
  }

 private:
  static std::size_t size(int i) { return static_cast<std::size_t>(i); }
  int n_;
  std::vector<double> f_;
  std::vector<int> at_;
  std::vector<double> edge_;
};

struct Nearest {
  std::vector<double> distance;  // [m]
  std::vector<int> dx, dy;       // [pixels] to the nearest pixel that is not set
};

Nearest nearest_outside(const Grid& grid, const std::vector<std::uint8_t>& set) {
  Nearest out{std::vector<double>(set.size()), std::vector<int>(set.size()),
              std::vector<int>(set.size())};
  std::vector<double>& d = out.distance;
  for (std::size_t i = 0; i < set.size(); ++i) d[i] = set[i] ? kInfinity : 0;
  Envelope columns(grid.ny), rows(grid.nx);
  std::vector<double> line(static_cast<std::size_t>(std::max(grid.nx, grid.ny)));
  std::vector<int> shift(line.size());
  for (int ix = 0; ix < grid.nx; ++ix) {
    columns.run(
        grid.dy(), [&](int iy) { return d[grid.index(ix, iy)]; },
        [&](int iy, double v, int to) {
          line[static_cast<std::size_t>(iy)] = v;
          out.dy[grid.index(ix, iy)] = to;
        });
    for (int iy = 0; iy < grid.ny; ++iy) d[grid.index(ix, iy)] = line[static_cast<std::size_t>(iy)];
  }
  for (int iy = 0; iy < grid.ny; ++iy) {
    rows.run(
        grid.dx(), [&](int ix) { return d[grid.index(ix, iy)]; },
        [&](int ix, double v, int to) {
          line[static_cast<std::size_t>(ix)] = v;
          out.dx[grid.index(ix, iy)] = to;
          shift[static_cast<std::size_t>(ix)] = out.dy[grid.index(wrap(ix + to, grid.nx), iy)];
        });
    for (int ix = 0; ix < grid.nx; ++ix) {
      d[grid.index(ix, iy)] = std::sqrt(line[static_cast<std::size_t>(ix)]);
      out.dy[grid.index(ix, iy)] = shift[static_cast<std::size_t>(ix)];
    }
  }
  return out;
}

// Narrowest distance between opposite borders: neighbouring pixels whose nearest outside lies in
// directions more than 150 deg apart stand on either side of a middle line. Finds short necks,
// which a disc of the opening reaches from beside.
double narrowest_neck(const Grid& grid, const std::vector<std::uint8_t>& set, const Nearest& n) {
  const double pixel = std::max(grid.dx(), grid.dy()), cosine = std::cos(150 * kPi / 180);
  double best = kInfinity;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const std::size_t i = grid.index(ix, iy);
      if (!set[i] || n.distance[i] < 1.2 * pixel) continue;
      for (const auto& [sx, sy] : {std::pair{1, 0}, {0, 1}}) {
        const std::size_t j = grid.index(wrap(ix + sx, grid.nx), wrap(iy + sy, grid.ny));
        if (!set[j] || n.distance[j] < 1.2 * pixel) continue;
        const double ax = n.dx[i] * grid.dx(), ay = n.dy[i] * grid.dy();
        const double bx = n.dx[j] * grid.dx(), by = n.dy[j] * grid.dy();
        if (ax * bx + ay * by > cosine * n.distance[i] * n.distance[j]) continue;
        best = std::min(best, n.distance[i] + n.distance[j] + (sx ? grid.dx() : grid.dy()));
      }
    }
  }
  return best - pixel;  // between the borders, not the centres of the pixels outside
}

// Width of the narrowest place of what is set.
double narrowest(const Grid& grid, const std::vector<std::uint8_t>& set) {
  const double pixel = std::max(grid.dx(), grid.dy());
  const Nearest nearest = nearest_outside(grid, set);
  const std::vector<double>& inner = nearest.distance;
  const double widest = *std::max_element(inner.begin(), inner.end());
  if (widest == 0 || widest == kInfinity) return kInfinity;
  const double neck = narrowest_neck(grid, set, nearest);
  // Whether opening with a disc of radius r loses a place that is nearly as wide as the disc: a
  // corner of 60 deg loses at most half the radius.
  const auto loses = [&](double r) {
    std::vector<std::uint8_t> far(set.size());  // from the eroded set
    for (std::size_t i = 0; i < set.size(); ++i) far[i] = inner[i] < r;
    const std::vector<double> reach = distance_inside(grid, far);
    for (std::size_t i = 0; i < set.size(); ++i) {
      if (set[i] && reach[i] > r + 0.5 * pixel && inner[i] > 0.75 * r) return true;
    }
    return false;
  };
  double low = 0.5 * pixel, high = 0;
  for (double r = 1.2 * pixel; high == 0; r *= 1.08) {
    // The middle line is sure of what is wider than some pixels.
    if (low > 3 * pixel && neck < kInfinity) return neck;
    // A round hole goes as a whole; its centre is up to 0.7 pixels from that of a pixel.
    if (r > widest) return std::min(neck, 2 * widest + (widest < 1.5 * pixel ? -0.5 : 0.7) * pixel);
    if (loses(r)) {
      high = r;
    } else {
      low = r;
    }
  }
  for (int i = 0; i < 6; ++i) {
    const double r = 0.5 * (low + high);
    (loses(r) ? high : low) = r;
  }
  return std::min(neck, low + high - 0.25 * pixel);
}

struct Corner {
  double x, y, h;
};

// Twice the area [nm^2], above 0 where the points go round against the clock. Of points that
// rounding has put on one line it is 0, and a mask shop refuses such a polygon.
std::int64_t doubled_area(const Polygon& p) {
  std::int64_t out = 0;
  for (std::size_t i = 2; i < p.x.size(); ++i) {  // from the first point: small numbers
    const auto from = [](std::int32_t to, std::int32_t first) { return std::int64_t{to} - first; };
    out += from(p.x[i - 1], p.x[0]) * from(p.y[i], p.y[0]) -
           from(p.x[i], p.x[0]) * from(p.y[i - 1], p.y[0]);
  }
  return out;
}

// The part of a triangle where the height is below the level.
void below(const std::array<Corner, 3>& t, double level, std::vector<Polygon>& out) {
  Polygon polygon;
  const auto add = [&](double x, double y) {
    const auto ix = static_cast<std::int32_t>(std::lround(1e9 * x)),
               iy = static_cast<std::int32_t>(std::lround(1e9 * y));
    if (!polygon.x.empty() && polygon.x.back() == ix && polygon.y.back() == iy) return;
    polygon.x.push_back(ix);
    polygon.y.push_back(iy);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner &a = t[i], &b = t[(i + 1) % 3];
    if (a.h < level) add(a.x, a.y);
    if ((a.h < level) != (b.h < level)) {
      // From the same end for both neighbours: the same rounded point.
      const bool swap = std::pair{a.x, a.y} > std::pair{b.x, b.y};
      const Corner &p = swap ? b : a, &q = swap ? a : b;
      const double s = (level - p.h) / (q.h - p.h);
      add(p.x + s * (q.x - p.x), p.y + s * (q.y - p.y));
    }
  }
  if (polygon.x.size() > 1 && polygon.x.front() == polygon.x.back() &&
      polygon.y.front() == polygon.y.back()) {
    polygon.x.pop_back();
    polygon.y.pop_back();
  }
  if (doubled_area(polygon) != 0) out.push_back(std::move(polygon));
}

}  // namespace

std::vector<double> distance_inside(const Grid& grid, const std::vector<std::uint8_t>& set) {
  return nearest_outside(grid, set).distance;
}

PixelMargins measure_margins(const Heightmap& h) {
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  PixelMargins out{kInfinity, kInfinity, std::max(h.grid.dx(), h.grid.dy())};
  if (*high <= *low) return out;
  const double middle = 0.5 * (*low + *high);
  std::vector<std::uint8_t> deep(h.z.size()), wall(h.z.size());
  for (std::size_t i = 0; i < h.z.size(); ++i) {
    deep[i] = h.z[i] < middle;
    wall[i] = !deep[i];
  }
  out.min_hole = narrowest(h.grid, deep);
  out.min_wall = narrowest(h.grid, wall);
  return out;
}

std::vector<Polygon> polygons_below(const Heightmap& h, double level) {
  std::vector<Polygon> out;
  const Grid& g = h.grid;
  // Samples at pixel centres, and the border's value on the border itself.
  const auto corner = [&](int i, int j) {
    const int ix = std::clamp(i, 0, g.nx - 1), iy = std::clamp(j, 0, g.ny - 1);
    return Corner{i < 0       ? 0
                  : i >= g.nx ? g.lx
                              : g.x(ix),
                  j < 0       ? 0
                  : j >= g.ny ? g.ly
                              : g.y(iy),
                  h(ix, iy)};
  };
  const auto rectangle = [&](int from, int to, int j) {
    const Corner a = corner(from, j), b = corner(to, j + 1);
    const auto nm = [](double v) { return static_cast<std::int32_t>(std::lround(1e9 * v)); };
    out.push_back({{nm(a.x), nm(b.x), nm(b.x), nm(a.x)}, {nm(a.y), nm(a.y), nm(b.y), nm(b.y)}});
  };
  for (int j = -1; j < g.ny; ++j) {
    int run = -2;  // first cell of the run of full cells; -2: none
    for (int i = -1; i <= g.nx; ++i) {
      bool full = false, part = false;
      if (i < g.nx) {
        int deep = 0;
        for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
          deep += corner(i + a, j + b).h < level;
        full = deep == 4;
        part = deep > 0 && deep < 4;
      }
      if (full && run == -2) run = i;
      if (!full && run != -2) {
        rectangle(run, i, j);
        run = -2;
      }
      if (!part) continue;
      const Corner a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                   d = corner(i, j + 1);
      below({a, b, c}, level, out);
      below({a, c, d}, level, out);
    }
  }
  return out;
}

}  // namespace papilla::geometry
