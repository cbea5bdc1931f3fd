#include "geometry/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "base/error.h"
#include "geometry/measured.h"
#include "geometry/particles.h"
#include "geometry/profile.h"
#include "geometry/roughness.h"

namespace papilla {
namespace {

const std::vector<std::string> kKinds{"flat",         "hole_array",    "pillar_array", "grating",
                                      "random_rough", "particle_film", "measured",     "stack"};

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

void walls(FieldVisitor& v, double& wall_angle, double& edge_radius) {
  v.number({"wall_angle", "deg", 1, 90, "angle of the wall from the land", Source::Estimate,
            "reactive ion etch"},
           wall_angle);
  v.number({"edge_radius", "nm", 0, 1e5, "radius of the convex rim", Source::Choice, "0: sharp"},
           edge_radius);
}
void lattice_field(FieldVisitor& v, Lattice& lattice) {
  v.choice({"lattice", "arrangement"}, {"square", "hexagonal"}, lattice);
}

// Distance to the nearest lattice point [m].
double lattice_distance(Lattice lattice, double period, double x, double y) {
  const auto nearest = [](double u, double p) { return u - p * std::round(u / p); };
  if (lattice == Lattice::Square)
    return std::hypot(nearest(x - 0.5 * period, period), nearest(y - 0.5 * period, period));
  const double row = std::sqrt(3.0) * period;
  const double a = std::hypot(nearest(x - 0.25 * period, period), nearest(y - 0.25 * row, row));
  const double b = std::hypot(nearest(x - 0.75 * period, period), nearest(y - 0.75 * row, row));
  return std::min(a, b);
}

// Section of round features averaged over each pixel: drop(distance to the nearest axis, width).
// Pixels at an edge are split, so that the average is over the square and not over its inscribed
// box.
template <class Drop>
Heightmap round_features(Lattice lattice, double period, double radius, double reach,
                         const Grid& grid, const Drop& drop) {
  Heightmap out{grid, std::vector<double>(grid.size())};
  const double pixel = std::sqrt(grid.pixel_area());
  constexpr int kSplit = 4;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const double x = grid.x(ix), y = grid.y(iy);
      const double r = lattice_distance(lattice, period, x, y);
      if (std::abs(r - radius) > reach + pixel) {
        out(ix, iy) = drop(r, pixel);
        continue;
      }
      double sum = 0;
      for (int k = 0; k < kSplit * kSplit; ++k) {
        const double dx = ((k % kSplit + 0.5) / kSplit - 0.5) * grid.dx();
        const double dy = ((k / kSplit + 0.5) / kSplit - 0.5) * grid.dy();
        sum += drop(lattice_distance(lattice, period, x + dx, y + dy), pixel / kSplit);
      }
      out(ix, iy) = sum / (kSplit * kSplit);
    }
  }
  return out;
}

// Lateral extent of a wall and its rim [m].
double wall_reach(double depth, double wall_angle, double edge_radius) {
  return depth / std::tan(wall_angle) + 2 * edge_radius;
}

Heightmap hole_heights(const HoleArray& t, const Grid& grid) {
  const WallProfile profile(t.depth, t.wall_angle, t.edge_radius);
  return round_features(
      t.lattice, t.period, 0.5 * t.diameter, wall_reach(t.depth, t.wall_angle, t.edge_radius), grid,
      [&](double r, double pixel) { return -profile.mean_drop(0.5 * t.diameter - r, pixel); });
}

Heightmap pillar_heights(const PillarArray& t, const Grid& grid) {
  const WallProfile profile(t.height, t.wall_angle, t.edge_radius);
  return round_features(t.lattice, t.period, 0.5 * t.diameter,
                        wall_reach(t.height, t.wall_angle, t.edge_radius), grid,
                        [&](double r, double pixel) {
                          return t.height - profile.mean_drop(r - 0.5 * t.diameter, pixel);
                        });
}

Heightmap grating_heights(const Grating& t, const Grid& grid) {
  Heightmap out{grid, std::vector<double>(grid.size())};
  const WallProfile profile(t.depth, t.wall_angle, t.edge_radius);
  for (int ix = 0; ix < grid.nx; ++ix) {
    const double x = grid.x(ix) - 0.5 * t.period;
    const double r = std::abs(x - t.period * std::round(x / t.period));
    const double z = -profile.mean_drop(0.5 * t.width - r, grid.dx());
    for (int iy = 0; iy < grid.ny; ++iy) out(ix, iy) = z;
  }
  return out;
}

Heightmap stack_heights(const Stack& stack, const Grid& grid) {
  Heightmap out{grid,
                std::vector<double>(grid.size(), stack.combine == Combine::Sum ? 0 : -kInfinity)};
  for (const Texture& part : stack.parts) {
    const Heightmap layer = generate(part, grid);
    for (std::size_t i = 0; i < out.z.size(); ++i) {
      out.z[i] =
          stack.combine == Combine::Sum ? out.z[i] + layer.z[i] : std::max(out.z[i], layer.z[i]);
    }
  }
  if (stack.parts.empty()) std::fill(out.z.begin(), out.z.end(), 0.0);
  return out;
}

// Neighbour distance of an array (the same for both lattices) and its unit cell; none without
// relief.
struct Cell {
  double x, y;
};
Cell unit_cell(const Texture& texture) {
  const auto array = [](double relief, double period, Lattice lattice) {
    if (relief <= 0) return Cell{0, 0};
    return Cell{period, lattice == Lattice::Square ? period : std::sqrt(3.0) * period};
  };
  return std::visit(
      Overloaded{[&](const HoleArray& t) { return array(t.depth, t.period, t.lattice); },
                 [&](const PillarArray& t) { return array(t.height, t.period, t.lattice); },
                 [&](const Grating& t) { return array(t.depth, t.period, Lattice::Square); },
                 [](const Stack& t) {
                   Cell cell{0, 0};
                   for (const Texture& part : t.parts) {
                     const Cell c = unit_cell(part);
                     if (c.x > cell.x) cell = c;
                   }
                   return cell;
                 },
                 [](const auto&) {
                   return Cell{0, 0};
                 }},
      texture.kind);
}

// The next even count that FFTs are fast for (factors of 2 to 7, one of 11 or 13) and that halves
// to such counts again where it is large, so that nested grids exist.
int even_count(double least) {
  const int step = least > 64 ? 16 : least > 16 ? 4 : 2;
  const auto fast = [](int n) {
    for (int p : {2, 3, 5, 7}) {
      while (n % p == 0) n /= p;
    }
    return n == 1 || n == 11 || n == 13;
  };
  int n = std::max(2, step * static_cast<int>(std::ceil(least / step - 1e-9)));
  while (!fast(n)) n += step;
  return n;
}

double free_patch(const Texture& texture, double target) {
  if (const auto* film = std::get_if<ParticleFilm>(&texture.kind))
    return std::max(target, 8 * film->radius);
  if (const auto* map = std::get_if<Measured3d>(&texture.kind)) return map->patch;
  return target;
}

void array_problems(double period, double diameter, double depth, double wall_angle,
                    const char* width_key, std::vector<std::pair<std::string, std::string>>& out) {
  if (diameter >= period) {
    out.emplace_back(
        width_key,
        fmt::format("{:.4g} um is not smaller than the period {:.4g} um; features would overlap",
                    1e6 * diameter, 1e6 * period));
  }
  if (depth > 0 && depth / std::tan(wall_angle) > 0.5 * diameter) {
    out.emplace_back(
        "wall_angle",
        fmt::format("walls of {:.4g} deg meet before the depth of {:.4g} nm is reached; "
                    "make them steeper or the feature shallower",
                    wall_angle * 180 / kPi, 1e9 * depth));
  }
}

}  // namespace

void fields(FieldVisitor& v, Flat&) { (void)v; }
void fields(FieldVisitor& v, HoleArray& t) {
  lattice_field(v, t.lattice);
  v.number({"period", "um", 0.01, 1e3, "distance of neighbours", Source::Paper, "M3: 6 um"},
           t.period);
  v.number(
      {"diameter", "um", 0.001, 1e3, "hole diameter at the land", Source::Paper, "M3: 3 or 4 um"},
      t.diameter);
  v.number({"depth", "nm", 0, 1e5, "hole depth; 0: flat", Source::Paper, "M3: 350, 600, 900 nm"},
           t.depth);
  walls(v, t.wall_angle, t.edge_radius);
}
void fields(FieldVisitor& v, PillarArray& t) {
  lattice_field(v, t.lattice);
  v.number({"period", "um", 0.01, 1e3, "distance of neighbours"}, t.period);
  v.number({"diameter", "um", 0.001, 1e3, "pillar diameter at the top"}, t.diameter);
  v.number({"height", "nm", 0, 1e5, "pillar height; 0: flat"}, t.height);
  walls(v, t.wall_angle, t.edge_radius);
}
void fields(FieldVisitor& v, Grating& t) {
  v.number({"period", "um", 0.01, 1e3, "distance of neighbouring grooves"}, t.period);
  v.number({"width", "um", 0.001, 1e3, "groove width at the land"}, t.width);
  v.number({"depth", "nm", 0, 1e5, "groove depth; 0: flat"}, t.depth);
  walls(v, t.wall_angle, t.edge_radius);
}
void fields(FieldVisitor& v, RandomRough& t) {
  v.number({"rms", "nm", 0, 1e5, "rms height over 12 um"}, t.rms);
  v.number({"roll_off", "um", 0.01, 1e3, "roll-off wavelength"}, t.roll_off);
  v.number({"hurst", "", 0.01, 1, "Hurst exponent"}, t.hurst);
  v.number({"cutoff", "nm", 1, 1e5, "shortest wavelength"}, t.cutoff);
  v.integer({"seed", "which random surface"}, 0, 1000000000, t.seed);
}
void fields(FieldVisitor& v, ParticleFilm& t) {
  v.number({"radius", "um", 0.01, 100, "mean particle radius", Source::Paper, "M3: 1.5 and 3 um"},
           t.radius);
  v.number({"radius_spread", "%", 0, 50, "standard deviation of the radius over its mean",
            Source::Estimate, "none published"},
           t.radius_spread);
  v.number({"coverage", "%", 0, 80, "projected share covered by particles", Source::Estimate,
            "none published"},
           t.coverage);
  v.number({"embedding", "%", 0, 95, "share of the diameter below the film", Source::Estimate,
            "none published"},
           t.embedding);
  v.number({"clustering", "", 0, 1, "share of particles placed against another one"}, t.clustering);
  v.integer({"seed", "which random arrangement"}, 0, 1000000000, t.seed);
}
void fields(FieldVisitor& v, Measured3d& t) {
  v.path(
      {"file", "heightmap to import (.npy .gsf .exr .tif)", Source::Choice, "", Presence::Required},
      t.file);
  v.number({"width", "um", 0, 1e6, "lateral size of the map where the file does not say"}, t.width);
  v.number({"patch", "um", 0.1, 1e4, "side of the simulated square, cut from the middle"}, t.patch);
}
void fields(FieldVisitor& v, Stack& t) {
  v.choice({"combine", "how the parts make one surface"}, {"sum", "maximum"}, t.combine);
  v.list({"parts", "textures to combine"}, t.parts);
}

void fields(FieldVisitor& v, Texture& texture) {
  int index = static_cast<int>(texture.kind.index());
  const int before = index;
  v.choice({"type", "kind of texture"}, kKinds, index);
  if (index != before) {
    switch (index) {
      case 0:
        texture.kind = Flat{};
        break;
      case 1:
        texture.kind = HoleArray{};
        break;
      case 2:
        texture.kind = PillarArray{};
        break;
      case 3:
        texture.kind = Grating{};
        break;
      case 4:
        texture.kind = RandomRough{};
        break;
      case 5:
        texture.kind = ParticleFilm{};
        break;
      case 6:
        texture.kind = Measured3d{};
        break;
      case 7:
        texture.kind = Stack{};
        break;
      default:
        PAPILLA_CHECK(false, "texture kind");
    }
  }
  std::visit([&](auto& kind) { fields(v, kind); }, texture.kind);
}

const std::vector<std::string>& texture_kinds() { return kKinds; }

std::string texture_name(const Texture& texture) { return kKinds[texture.kind.index()]; }

std::vector<std::pair<std::string, std::string>> problems(const Texture& texture) {
  std::vector<std::pair<std::string, std::string>> out;
  std::visit(
      Overloaded{
          [&](const HoleArray& t) {
            array_problems(t.period, t.diameter, t.depth, t.wall_angle, "diameter", out);
          },
          [&](const PillarArray& t) {
            array_problems(t.period, t.diameter, 0, t.wall_angle, "diameter", out);
          },
          [&](const Grating& t) {
            array_problems(t.period, t.width, t.depth, t.wall_angle, "width", out);
          },
          [&](const RandomRough& t) {
            if (t.cutoff >= t.roll_off)
              out.emplace_back("cutoff", "must be shorter than the roll-off wavelength");
          },
          [&](const ParticleFilm& t) {
            // Random sequential placement of discs jams at 0.547 (Feder 1980).
            if (t.coverage > 0.52) {
              out.emplace_back("coverage",
                               "random non-overlapping particles jam near 55 %; use at most 52 %");
            }
          },
          [&](const Stack& t) {
            if (t.parts.empty()) out.emplace_back("parts", "a stack needs at least one part");
            const double largest = unit_cell(texture).x;
            for (std::size_t i = 0; i < t.parts.size(); ++i) {
              for (auto& [key, message] : problems(t.parts[i])) {
                out.emplace_back(fmt::format("parts.{}.{}", i, key), message);
              }
              const double period = texture_period(t.parts[i]);
              if (period > 0 && std::abs(largest / period - std::round(largest / period)) > 1e-6) {
                out.emplace_back(fmt::format("parts.{}.period", i),
                                 "does not divide the largest period of the stack");
              }
            }
          },
          [](const auto&) {}},
      texture.kind);
  return out;
}

Grid patch_grid(const Texture& texture, int pixels, double target) {
  const Cell cell = unit_cell(texture);
  double lx, ly;
  if (cell.x > 0) {
    lx = cell.x * std::max(2.0, std::round(target / cell.x));
    ly = cell.y * std::max(1.0, std::round(lx / cell.y));
  } else {
    lx = ly = free_patch(texture, target);
  }
  const int nx = std::max(2, pixels + pixels % 2);
  int ny = static_cast<int>(std::lround(nx * ly / lx));
  // Even, and kept divisible as nx is, so that nested grids exist.
  const int multiple = nx % 16 == 0 ? 16 : 2;
  ny = std::max(multiple, (ny + multiple / 2) / multiple * multiple);
  return {nx, ny, lx, ly};
}

Grid simulated_patch(const Texture& texture, int pixels, int most) {
  const Cell cell = unit_cell(texture);
  double lx, ly;
  if (cell.x > 0) {
    // A patch twice too long counts as much as one of half or twice the area.
    double least = kInfinity;
    lx = cell.x;
    ly = cell.y;
    const int periods = std::max(1, static_cast<int>(std::ceil(2 * kWindow / cell.x)));
    for (int i = 1; i <= periods; ++i) {
      for (int j = 1; j <= periods; ++j) {
        const double x = i * cell.x, y = j * cell.y;
        const double unlike =
            std::abs(std::log(x * y / (kWindow * kWindow))) + 0.5 * std::abs(std::log(x / y));
        if (unlike < least - 1e-9) {
          least = unlike;
          lx = x;
          ly = y;
        }
      }
    }
  } else {
    lx = ly = free_patch(texture, kWindow);
  }
  const double pixel = std::max(kWindow / pixels, std::max(lx, ly) / most);
  return {even_count(lx / pixel), even_count(ly / pixel), lx, ly};
}

Heightmap generate(const Texture& texture, const Grid& grid) {
  return std::visit(Overloaded{[&](const Flat&) {
                                 return Heightmap{grid, std::vector<double>(grid.size(), 0)};
                               },
                               [&](const HoleArray& t) { return hole_heights(t, grid); },
                               [&](const PillarArray& t) { return pillar_heights(t, grid); },
                               [&](const Grating& t) { return grating_heights(t, grid); },
                               [&](const RandomRough& t) {
                                 return random_surface({t.rms, t.roll_off, t.hurst, t.cutoff}, grid,
                                                       static_cast<std::uint64_t>(t.seed), 0);
                               },
                               [&](const ParticleFilm& t) { return particle_heights(t, grid); },
                               [&](const Measured3d& t) { return measured_heights(t, grid); },
                               [&](const Stack& t) { return stack_heights(t, grid); }},
                    texture.kind);
}

FabricationMargins fabrication_margins(const Texture& texture) {
  const auto array = [](double hole, double wall, double depth) {
    return FabricationMargins{hole, wall, depth / std::min(hole, wall)};
  };
  return std::visit(
      Overloaded{[&](const HoleArray& t) {
                   if (t.depth <= 0) return FabricationMargins{kInfinity, kInfinity, 0};
                   return array(t.diameter - 2 * t.depth / std::tan(t.wall_angle),
                                t.period - t.diameter, t.depth);
                 },
                 [&](const PillarArray& t) {
                   if (t.height <= 0) return FabricationMargins{kInfinity, kInfinity, 0};
                   return array(t.period - t.diameter - 2 * t.height / std::tan(t.wall_angle),
                                t.diameter, t.height);
                 },
                 [&](const Grating& t) {
                   if (t.depth <= 0) return FabricationMargins{kInfinity, kInfinity, 0};
                   return array(t.width - 2 * t.depth / std::tan(t.wall_angle), t.period - t.width,
                                t.depth);
                 },
                 [&](const Stack& t) {
                   FabricationMargins worst{kInfinity, kInfinity, 0};
                   for (const Texture& part : t.parts) {
                     const FabricationMargins m = fabrication_margins(part);
                     worst.min_hole = std::min(worst.min_hole, m.min_hole);
                     worst.min_wall = std::min(worst.min_wall, m.min_wall);
                     worst.aspect_ratio = std::max(worst.aspect_ratio, m.aspect_ratio);
                   }
                   return worst;
                 },
                 [](const auto&) {
                   return FabricationMargins{kInfinity, kInfinity, 0};
                 }},
      texture.kind);
}

double open_fraction(const Texture& texture) {
  const auto disc = [](Lattice lattice, double diameter, double period) {
    const double cell =
        lattice == Lattice::Square ? period * period : 0.5 * std::sqrt(3.0) * period * period;
    return kPi / 4 * diameter * diameter / cell;
  };
  return std::visit(
      Overloaded{[&](const HoleArray& t) {
                   return t.depth > 0 ? disc(t.lattice, t.diameter, t.period) : 0.0;
                 },
                 [&](const PillarArray& t) {
                   return t.height > 0 ? 1 - disc(t.lattice, t.diameter, t.period) : 0.0;
                 },
                 [](const Grating& t) { return t.depth > 0 ? t.width / t.period : 0.0; },
                 [](const auto&) { return 0.0; }},
      texture.kind);
}

double texture_depth(const Texture& texture) {
  return std::visit(
      Overloaded{[](const HoleArray& t) { return t.depth; },
                 [](const PillarArray& t) { return t.height; },
                 [](const Grating& t) { return t.depth; },
                 [](const ParticleFilm& t) { return 2 * t.radius * (1 - t.embedding); },
                 [](const Stack& t) {
                   double sum = 0;
                   for (const Texture& part : t.parts) {
                     const double d = texture_depth(part);
                     sum = t.combine == Combine::Sum ? sum + d : std::max(sum, d);
                   }
                   return sum;
                 },
                 [](const auto&) { return 0.0; }},
      texture.kind);
}

double texture_period(const Texture& texture) { return unit_cell(texture).x; }

double rim_radius(const Texture& texture) {
  return std::visit(
      Overloaded{[](const HoleArray& t) { return t.depth > 0 ? t.edge_radius : kInfinity; },
                 [](const PillarArray& t) { return t.height > 0 ? t.edge_radius : kInfinity; },
                 [](const Grating& t) { return t.depth > 0 ? t.edge_radius : kInfinity; },
                 [](const Stack& t) {
                   double least = kInfinity;
                   for (const Texture& part : t.parts) least = std::min(least, rim_radius(part));
                   return least;
                 },
                 [](const auto&) { return kInfinity; }},
      texture.kind);
}

}  // namespace papilla
