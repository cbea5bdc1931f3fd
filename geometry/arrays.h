// What textures of equal features on a lattice share: keys, section of a wall, facts.
#pragma once

#include <functional>

#include "base/rooms.h"
#include "geometry/facts.h"

namespace papilla::geometry {

// Section of every edge: height of the step [m], angle of the wall from the land [rad], radius of
// its convex rim [m].
struct WallSection {
  double depth, wall_angle, edge_radius;

  double run() const;    // lateral extent of the wall [m]
  double reach() const;  // of the wall and its rim [m]
  // Angle from the land [rad]: that of the wall, or where the floor cuts a rim as large.
  double steepest() const;
};

inline constexpr double kSteepWall = 1.5358897417550099;  // 88 deg from the land

void wall_fields(FieldVisitor& v, double& wall_angle, double& edge_radius);
void lattice_field(FieldVisitor& v, Lattice& lattice);

// height(distance to the nearest axis, width) averaged over each pixel of round features.
Heightmap round_features(const FeatureArray& array, const WallSection& wall, const Grid& grid,
                         const std::function<double(double, double)>& height);

// Width [m] half-way down the section: the feature as wide there as straight walls of its own angle
// make it, whatever their rims, as long as these end above. Eq. geometry.1
double width_at_half_depth(const FeatureArray& array, const WallSection& wall);

double feature_share(const FeatureArray& array);  // of the area, inside the features
TextureFacts array_facts(FeatureArray array, const WallSection& wall);

// Features that overlap, walls that meet before the depth is reached (those of a hole, the feet of
// neighbouring pillars; `width` is from edge to edge at the land or at the top, `depth_key` the key
// of the depth), and rims that leave nothing of the narrowest land between two edges.
TextureProblems array_problems(double period, double width, const char* width_key);
void add_wall_problem(const WallSection& wall, double width, const char* depth_key,
                      TextureProblems& out);
void add_rim_problem(const WallSection& wall, double land, TextureProblems& out);

}  // namespace papilla::geometry
