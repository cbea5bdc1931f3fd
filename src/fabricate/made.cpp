#include "fabricate/made.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "geometry/profile.h"
#include "numerics/fft.h"

namespace papilla::fabricate {
namespace {

using Complex = std::complex<double>;
constexpr double kHalfLight = 0.5;  // where the resist opens

// Samples of a field that repeats: (i, j) stands at (i dx, j dy).
struct Field {
  Grid grid;
  std::vector<double> value;

  double operator()(int i, int j) const {
    return value[grid.index(wrap(i, grid.nx), wrap(j, grid.ny))];
  }
  double at(double x, double y) const {  // [m], bilinear
    const double u = x / grid.dx(), v = y / grid.dy();
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    const double s = u - i, t = v - j;
    return (1 - t) * ((1 - s) * (*this)(i, j) + s * (*this)(i + 1, j)) +
           t * ((1 - s) * (*this)(i, j + 1) + s * (*this)(i + 1, j + 1));
  }
};

// Fourier integrals of a polygon's inside over e^(-ik.r), by its edges; counter-clockwise is
// positive. Eq. fabrication.7
class PolygonModes {
 public:
  PolygonModes(const Polygon& p, const Grid& cell) {
    for (std::size_t i = 0, n = p.x.size(); i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      edges_.push_back(
          {1e-9 * p.x[i], 1e-9 * p.y[i], 1e-9 * (p.x[j] - p.x[i]), 1e-9 * (p.y[j] - p.y[i])});
      area_ += 0.5 * (edges_.back().x * 1e-9 * p.y[j] - 1e-9 * p.x[j] * edges_.back().y);
    }
    along_x_ = phases(cell.nx / 2 + 1, 2 * kPi / cell.lx, [](const Edge& e) { return e.x; });
    along_y_ = phases(cell.ny / 2 + 1, 2 * kPi / cell.ly, [](const Edge& e) { return e.y; });
    step_x_ = 2 * kPi / cell.lx, step_y_ = 2 * kPi / cell.ly;
  }
  Complex operator()(int i, int j) const {
    if (i == 0 && j == 0) return area_;
    const double kx = step_x_ * i, ky = step_y_ * j;
    const std::size_t n = edges_.size();
    Complex sum = 0, here = phase(0, i, j);
    for (std::size_t e = 0; e < n; ++e) {
      const Complex next = phase((e + 1) % n, i, j);
      const double dx = edges_[e].dx, dy = edges_[e].dy, turn = kx * dx + ky * dy;
      constexpr double kSmall = 1e-5;  // of the mean phase in place of the difference of both ends
      const Complex mean =
          std::abs(turn) < kSmall ? 0.5 * (here + next) : Complex{0, -1 / turn} * (here - next);
      sum += (kx * dy - ky * dx) * mean;
      here = next;
    }
    return Complex{0, 1} / (kx * kx + ky * ky) * sum;
  }

 private:
  struct Edge {
    double x, y, dx, dy;  // [m]
  };
  // e^(-i k x) of every corner, wave number by wave number.
  template <class Place>
  std::vector<Complex> phases(int count, double step, const Place& place) const {
    std::vector<Complex> out;
    for (int i = 0; i < count; ++i) {
      for (const Edge& e : edges_) out.push_back(std::polar(1.0, -step * i * place(e)));
    }
    return out;
  }
  Complex phase(std::size_t corner, int i, int j) const {
    const std::size_t n = edges_.size();
    const Complex x = along_x_[static_cast<std::size_t>(i) * n + corner],
                  y = along_y_[static_cast<std::size_t>(std::abs(j)) * n + corner];
    const Complex v = j < 0 ? std::conj(y) : y;
    return {x.real() * v.real() - x.imag() * v.imag(), x.real() * v.imag() + x.imag() * v.real()};
  }

  std::vector<Edge> edges_;
  std::vector<Complex> along_x_, along_y_;
  double area_ = 0, step_x_ = 0, step_y_ = 0;
};

// Where features stand in the cell that repeats [m].
std::vector<std::pair<double, double>> places(const FeatureArray& array, const Grid& cell) {
  if (array.lattice == Lattice::Hexagonal && array.shape == FeatureArray::Shape::Disc)
    return {{0.25 * cell.lx, 0.25 * cell.ly}, {0.75 * cell.lx, 0.75 * cell.ly}};
  return {{0.5 * cell.lx, 0.5 * cell.ly}};
}

// The light that a mask lets through, blurred; at least by a pixel and a half, which moves an edge
// of radius R by deviation^2 / (2R): 0.2 nm of 1.5 um in a period of 6 um.
Field exposure(const FeatureArray& mask, const std::vector<Polygon>& polygons, double blur) {
  const bool line = mask.shape == FeatureArray::Shape::Line;
  constexpr int kFewest = 128, kMost = 512;
  constexpr double kPixelsOfBlur = 1.5;
  const double wanted = blur > 0 ? kPixelsOfBlur * mask.period / blur : kMost;
  Grid cell{2 * static_cast<int>(0.5 * std::clamp(wanted, double{kFewest}, double{kMost})), 0,
            mask.period, mask.period};
  if (mask.lattice == Lattice::Hexagonal && !line) cell.ly = std::sqrt(3.0) * mask.period;
  cell.ny = 2 * static_cast<int>(std::ceil(0.5 * cell.nx * cell.ly / cell.lx));
  const double deviation = std::max(blur, kPixelsOfBlur * cell.dx());
  const auto fft = Fft2d::shared(cell.nx, cell.ny);
  std::vector<PolygonModes> shapes;
  for (const Polygon& p : polygons) shapes.emplace_back(p, cell);
  SpectrumArray modes(fft->spectrum_size());
  for (int j = 0; j < cell.ny; ++j) {
    for (int i = 0; i < fft->half(); ++i) {
      const double kx = 2 * kPi * i / cell.lx, ky = 2 * kPi * signed_mode(j, cell.ny) / cell.ly;
      const double passed = std::exp(-0.5 * square(deviation) * (kx * kx + ky * ky));
      constexpr double kNothing = 1e-12;
      Complex& mode = modes[static_cast<std::size_t>(j) * static_cast<std::size_t>(fft->half()) +
                            static_cast<std::size_t>(i)];
      mode = 0;
      if (passed < kNothing) continue;
      Complex one = 0;
      for (const PolygonModes& shape : shapes) one += shape(i, signed_mode(j, cell.ny));
      for (const auto& [x, y] : places(mask, cell)) mode += one * std::polar(1.0, -kx * x - ky * y);
      mode *= passed / cell.area();
    }
  }
  RealArray light(fft->real_size());
  fft->inverse(modes.data(), light.data());
  return {cell, std::vector<double>(light.begin(), light.end())};
}

struct Segment {
  double ax, ay, bx, by;  // [m]
};

double distance_to(const Segment& s, double x, double y) {
  const double dx = s.bx - s.ax, dy = s.by - s.ay, length = dx * dx + dy * dy;
  const double t =
      length > 0 ? std::clamp(((x - s.ax) * dx + (y - s.ay) * dy) / length, 0.0, 1.0) : 0;
  return std::hypot(x - s.ax - t * dx, y - s.ay - t * dy);
}

// The edge of the resist: pieces of the contour through the triangles of the pixels.
std::vector<Segment> resist_edge(const Field& light) {
  std::vector<Segment> out;
  const Grid& g = light.grid;
  struct Lit {
    double x, y, light;
  };
  const auto add = [&](const Lit& a, const Lit& b, const Lit& c) {
    const Lit corners[]{a, b, c};
    double ends[4];
    int n = 0;
    for (int k = 0; k < 3; ++k) {
      const Lit &p = corners[k], &q = corners[(k + 1) % 3];
      if ((p.light > kHalfLight) == (q.light > kHalfLight)) continue;
      const double s = (kHalfLight - p.light) / (q.light - p.light);
      ends[n++] = p.x + s * (q.x - p.x);
      ends[n++] = p.y + s * (q.y - p.y);
    }
    if (n == 4) out.push_back({ends[0], ends[1], ends[2], ends[3]});
  };
  for (int j = 0; j < g.ny; ++j) {
    for (int i = 0; i < g.nx; ++i) {
      const auto corner = [&](int di, int dj) {
        return Lit{(i + di) * g.dx(), (j + dj) * g.dy(), light(i + di, j + dj)};
      };
      add(corner(0, 0), corner(1, 0), corner(1, 1));
      add(corner(0, 0), corner(1, 1), corner(0, 1));
    }
  }
  return out;
}

// Segments and their images by squares as wide as the distance that is asked for, so that the
// nearest lies in one of nine.
class NearestEdge {
 public:
  NearestEdge(const std::vector<Segment>& edge, const Grid& cell, double reach)
      : reach_(reach),
        columns_(static_cast<int>(std::ceil(cell.lx / reach)) + 2),
        rows_(static_cast<int>(std::ceil(cell.ly / reach)) + 2),
        squares_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    for (const Segment& s : edge) {
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          const double x = i * cell.lx, y = j * cell.ly;
          put({s.ax + x, s.ay + y, s.bx + x, s.by + y});
        }
      }
    }
  }
  // No more than the reach.
  double distance(double x, double y) const {
    double best = reach_;
    const auto [column, row] = square_of(x, y);
    for (int j = std::max(0, row - 1); j <= std::min(rows_ - 1, row + 1); ++j) {
      for (int i = std::max(0, column - 1); i <= std::min(columns_ - 1, column + 1); ++i) {
        for (const Segment& s : squares_[index(i, j)]) best = std::min(best, distance_to(s, x, y));
      }
    }
    return best;
  }

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(i);
  }
  std::pair<int, int> square_of(double x, double y) const {
    return {static_cast<int>(std::floor(x / reach_)) + 1,
            static_cast<int>(std::floor(y / reach_)) + 1};
  }
  void put(const Segment& s) {
    const auto [i, j] = square_of(0.5 * (s.ax + s.bx), 0.5 * (s.ay + s.by));
    if (i >= 0 && j >= 0 && i < columns_ && j < rows_) squares_[index(i, j)].push_back(s);
  }

  double reach_;
  int columns_, rows_;
  std::vector<std::vector<Segment>> squares_;
};

// The middle of what is deep [m]: the lowest place, also where walls meet above the depth.
std::pair<double, double> lowest_place(const FeatureArray& array, const Grid& cell) {
  if (array.deep) return places(array, cell).front();
  // Between three pillars of a hexagonal lattice, between four of a square one, between two ridges.
  const bool hexagons =
      array.lattice == Lattice::Hexagonal && array.shape == FeatureArray::Shape::Disc;
  return hexagons ? std::pair{0.75 * cell.lx, 5.0 / 12 * cell.ly} : std::pair{0.0, 0.0};
}

// One cell of the master.
struct Etched {
  double deep_share = 0;  // of its area, below half the depth that is etched
  double depth = 0;       // of its lowest place [m]
};

Etched etched(const MaskedArray& array, const Field& light, const Process& process) {
  const WallProfile profile(array.etch, array.etched.wall_angle, array.etched.edge_radius);
  const double opening = process.resist_bias + process.undercut * array.etch;
  constexpr int kPixels = 192;
  const double pixel = array.mask.period / kPixels;
  const double reach = std::abs(opening) + array.etched.reach() + 4 * pixel;
  const std::vector<Segment> edge = resist_edge(light);
  if (edge.empty()) throw InputError("the resist does not open at the edges of its features");
  const NearestEdge nearest(edge, light.grid, reach);
  const auto inside = [&](double x, double y) {
    const double from = nearest.distance(x, y);
    return opening + (light.at(x, y) > kHalfLight ? from : -from);
  };
  Etched out;
  const Grid grid{kPixels, 2 * static_cast<int>(std::lround(0.5 * light.grid.ly / pixel)),
                  light.grid.lx, light.grid.ly};
  const double half_way = profile.inside(0.5 * array.etch);
  double deep = 0;  // pixels
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const double from = inside(grid.x(ix), grid.y(iy)) - half_way;
      deep += std::clamp(from / pixel + 0.5, 0.0, 1.0);
    }
  }
  out.deep_share = deep / static_cast<double>(grid.size());
  const auto [x, y] = lowest_place(array.mask, light.grid);
  out.depth = profile.drop(inside(x, y));
  return out;
}

// The width of features by the share of the area that is deep.
double width_by_share(const FeatureArray& array, double deep_share, const Grid& cell) {
  const double share = array.deep ? deep_share : 1 - deep_share;
  if (array.shape == FeatureArray::Shape::Line) return share * cell.lx;
  const auto features = static_cast<double>(places(array, cell).size());
  return std::sqrt(4 / kPi * share * cell.area() / features);
}

}  // namespace

bool MadeArray::as_wanted() const { return left().empty(); }

std::vector<std::string> MadeArray::left() const {
  constexpr double kLength = 2e-9, kShare = 0.01, kAngle = 0.5 * kPi / 180;
  std::vector<std::string> out;
  const auto judge = [&](const char* name, double made, double wanted, double allowed,
                         const char* why = "") {
    if (std::abs(made - wanted) <= allowed) return;
    out.push_back(fmt::format("{} {:.5g} nm, wanted {:.5g} nm ({:+.2g} %){}", name, 1e9 * made,
                              1e9 * wanted, 100 * (made / wanted - 1), why));
  };
  judge("width", width, wanted_width, kLength);
  judge("depth", depth, wanted_depth, kShare * wanted_depth,
        walls_meet ? ": its walls meet above it; steeper walls, or more room between them" : "");
  judge("period", period, wanted_period, kLength);
  if (std::abs(wall_angle - wanted_wall_angle) > kAngle) {
    out.push_back(fmt::format("walls of {:.4g} deg, wanted {:.4g} deg: no mask changes them",
                              wall_angle * 180 / kPi, wanted_wall_angle * 180 / kPi));
  }
  if (std::abs(edge_radius - wanted_edge_radius) > kLength) {
    out.push_back(fmt::format("rims of {:.4g} nm, wanted {:.4g} nm: no mask changes them",
                              1e9 * edge_radius, 1e9 * wanted_edge_radius));
  }
  return out;
}

MadeArray made_of(const MaskedArray& array, const std::vector<Polygon>& polygons,
                  const Process& process) {
  MadeArray out;
  const Field light = exposure(array.mask, polygons, process.blur());
  const Etched master = etched(array, light, process);
  const double along = 1 - process.shrinkage, up = 1 - process.height_shrinkage;
  out.depth = up * master.depth;
  out.walls_meet = master.depth < (1 - 1e-9) * array.etch;  // but for rounding
  out.wanted_depth = array.wall.depth;
  out.period = along * array.mask.period;
  out.wanted_period = array.wanted.period;
  out.wall_angle = std::atan(std::tan(array.etched.wall_angle) * up / along);
  out.wanted_wall_angle = array.wall.wall_angle;
  out.edge_radius = along * array.etched.edge_radius;
  out.wanted_edge_radius = array.wall.edge_radius;
  out.width = along * width_by_share(array.wanted, master.deep_share, light.grid);
  out.wanted_width = width_at_half_depth(array.wanted, array.wall);
  return out;
}

}  // namespace papilla::fabricate
