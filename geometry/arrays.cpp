#include "geometry/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/parallel.h"
#include "geometry/profile.h"

namespace papilla::geometry {
namespace {

// Maps of more are of exports, which have all processors to themselves.
constexpr std::size_t kPixelsOfPatches = std::size_t{1} << 20;

// Distance to the nearest lattice point [m].
double lattice_distance(Lattice lattice, double period, double x, double y) {
  // Squared, from the point of a lattice of px by py at (u, v).
  const auto squared = [&](double u, double v, double px, double py) {
    const double dx = x - u, dy = y - v;
    return square(dx - px * std::rint(dx / px)) + square(dy - py * std::rint(dy / py));
  };
  if (lattice == Lattice::Square)
    return std::sqrt(squared(0.5 * period, 0.5 * period, period, period));
  const double row = std::sqrt(3.0) * period;
  return std::sqrt(std::min(squared(0.25 * period, 0.25 * row, period, row),
                            squared(0.75 * period, 0.75 * row, period, row)));
}

FabricationMargins array_margins(const FeatureArray& a, const WallSection& wall) {
  const double gap = a.period - a.width;
  // At its floor; nothing is left of one whose walls meet, which problems() refuses.
  const double hole = std::max(0.0, (a.deep ? a.width : gap) - 2 * wall.run());
  const double land = a.deep ? gap : a.width;
  return {hole, land, wall.depth / std::min(hole, land)};
}

// The outlines in the middle of steps of the section, each 8 nm high at most, which light does not
// tell from a slope. One where the wall is upright.
std::vector<Terrace> terraces_of(const FeatureArray& a, const WallSection& wall) {
  constexpr double kStep = 8e-9, kFewest = 16, kMost = 512;
  const WallProfile profile(wall.depth, wall.wall_angle, wall.edge_radius);
  const double span = profile.end() - profile.start();
  const bool upright = span < 1e-6 * a.width;
  const int steps =
      upright ? 1 : static_cast<int>(std::clamp(std::ceil(wall.depth / kStep), kFewest, kMost));
  std::vector<Terrace> out;
  for (int k = 0; k < steps; ++k) {
    const double outer = profile.start() + span * k / steps,
                 inner = profile.start() + span * (k + 1) / steps, middle = 0.5 * (outer + inner);
    // Holes fall inwards from the land; pillars rise inwards from the floor.
    if (a.deep) {
      out.push_back({a.width - 2 * middle, -profile.drop(inner)});
    } else {
      out.push_back({a.width + 2 * middle, wall.depth - profile.drop(outer)});
    }
  }
  if (!a.deep) std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace

double WallSection::run() const { return depth / std::tan(wall_angle); }
double WallSection::reach() const { return run() + 2 * edge_radius; }
double WallSection::steepest() const {
  return std::min(wall_angle, std::acos(std::max(1 - depth / edge_radius, -1.0)));
}

void wall_fields(FieldVisitor& v, double& wall_angle, double& edge_radius) {
  v.number({"wall_angle", "deg", 1, 90, "angle of the wall from the land", Source::Estimate,
            "reactive ion etch"},
           wall_angle);
  v.number({"edge_radius", "nm", 0, 1e5, "radius of the convex rim", Source::Choice, "0: sharp"},
           edge_radius);
}

void lattice_field(FieldVisitor& v, Lattice& lattice) {
  v.choice({"lattice", "arrangement"}, {"square", "hexagonal"}, lattice);
}

// Pixels at an edge are split, so that the average is over the square and not over its inscribed
// box.
Heightmap round_features(const FeatureArray& array, const WallSection& wall, const Grid& grid,
                         const std::function<double(double, double)>& height) {
  Heightmap out{grid, std::vector<double>(grid.size())};
  const double pixel = std::sqrt(grid.pixel_area());
  const auto distance = [&](double x, double y) {
    return lattice_distance(array.lattice, array.period, x, y);
  };
  constexpr int kSplit = 4;
  const double reach = wall.reach() + pixel;
  const auto fill_row = [&](int iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const double x = grid.x(ix), y = grid.y(iy);
      const double r = distance(x, y);
      if (std::abs(r - 0.5 * array.width) > reach) {
        out(ix, iy) = height(r, pixel);
        continue;
      }
      double sum = 0;
      for (int k = 0; k < kSplit * kSplit; ++k) {
        const double dx = ((k % kSplit + 0.5) / kSplit - 0.5) * grid.dx();
        const double dy = ((k / kSplit + 0.5) / kSplit - 0.5) * grid.dy();
        sum += height(distance(x + dx, y + dy), pixel / kSplit);
      }
      out(ix, iy) = sum / (kSplit * kSplit);
    }
  };
  if (grid.size() > kPixelsOfPatches) {
    parallel_for(grid.ny, fill_row);
  } else {
    for (int iy = 0; iy < grid.ny; ++iy) fill_row(iy);
  }
  return out;
}

double width_at_half_depth(const FeatureArray& a, const WallSection& wall) {
  const WallProfile profile(wall.depth, wall.wall_angle, wall.edge_radius);
  const double inside = wall.depth > 0 ? profile.inside(0.5 * wall.depth) : 0;
  return a.width + (a.deep ? -2 : 2) * inside;
}

double feature_share(const FeatureArray& a) {
  if (a.shape == FeatureArray::Shape::Line) return a.width / a.period;
  const double cell = a.lattice == Lattice::Square ? a.period * a.period
                                                   : 0.5 * std::sqrt(3.0) * a.period * a.period;
  return kPi / 4 * a.width * a.width / cell;
}

TextureFacts array_facts(FeatureArray array, const WallSection& wall) {
  const bool relief = wall.depth > 0;
  if (relief) array.terraces = terraces_of(array, wall);
  const double row =
      array.lattice == Lattice::Square ? array.period : std::sqrt(3.0) * array.period;
  const double share = array.deep ? feature_share(array) : 1 - feature_share(array);
  return {.relief = array.deep ? Relief::between(-wall.depth, 0) : Relief::between(0, wall.depth),
          .cell = relief ? std::optional(UnitCell{array.period, row}) : std::nullopt,
          .free_patch = FreePatch{0, std::nullopt, false},
          .margins = relief ? array_margins(array, wall) : FabricationMargins::none(),
          .open_share = relief ? share : 0.0,
          .rim_radius = relief ? std::optional(wall.edge_radius) : std::nullopt,
          .steepest = relief ? wall.steepest() : 0.0,
          .outline = array,
          .scans = kNoScans,
          .rough = kNoRoughness,
          .directional = relief && array.shape == FeatureArray::Shape::Line,
          .quick_look = true};
}

TextureProblems array_problems(double period, double width, const char* width_key) {
  if (width < period) return {};
  return {{width_key,
           fmt::format("{:.4g} um is not smaller than the period {:.4g} um; features would overlap",
                       1e6 * width, 1e6 * period)}};
}

void add_wall_problem(const WallSection& wall, double width, const char* depth_key,
                      TextureProblems& out) {
  constexpr double kRounding = 1e-9;  // of lengths: walls may touch
  if (wall.depth <= 0 || width <= 0 || wall.run() <= 0.5 * width * (1 + kRounding)) return;
  // Both as far as they may go, rounded to the side that is allowed.
  const double steep = std::ceil(100 * std::atan2(wall.depth, 0.5 * width) * 180 / kPi) / 100,
               shallow = std::floor(1e10 * 0.5 * width * std::tan(wall.wall_angle) + 1e-6) / 10;
  out.emplace_back("wall_angle", fmt::format("walls of {:.4g} deg meet before the {} of {:.4g} nm "
                                             "is reached; make them {:.4g} deg or steeper, or the "
                                             "{} {:.6g} nm or less",
                                             wall.wall_angle * 180 / kPi, depth_key,
                                             1e9 * wall.depth, steep, depth_key, shallow));
}

void add_rim_problem(const WallSection& wall, double land, TextureProblems& out) {
  const double share = 2 * std::tan(0.5 * wall.wall_angle);  // of the land, over the radius
  if (wall.depth <= 0 || land <= 0 || wall.edge_radius * share < land) return;
  out.emplace_back("edge_radius",
                   fmt::format("rims of {:.4g} nm leave nothing of the land of {:.4g} um between "
                               "two edges; less than {:.4g} nm",
                               1e9 * wall.edge_radius, 1e6 * land, 1e9 * land / share));
}

}  // namespace papilla::geometry
