// What a kind of texture says about itself. Nothing here has a default: a kind that forgets a fact
// does not compile. Optics, layouts, exports and searches ask for facts and know no kind.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/rooms.h"
#include "config/fields.h"
#include "geometry/heightmap.h"
#include "geometry/scan.h"

namespace papilla::geometry {

struct Texture;

// A member without a default: a struct that has one cannot be made without saying it.
template <class T>
struct Stated : T {
  template <class... Args>
  requires(sizeof...(Args) > 0 && std::constructible_from<T, Args...>)
      Stated(Args&&... args)  // NOLINT(google-explicit-constructor)
      : T(std::forward<Args>(args)...) {}
};
template <class T>
requires std::is_scalar_v<T>
struct Stated<T> {
  Stated(T said) : value(said) {}       // NOLINT(google-explicit-constructor)
  operator T() const { return value; }  // NOLINT(google-explicit-constructor)
  T value;
};

// The nominal planes that all heights lie between [m].
struct Planes {
  double low, high;
};

// Those of the lowest and the highest pixel of a map.
inline Planes planes_of(const Heightmap& h) {
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  return {*low, *high};
}

// present: the surface is not flat. planes: none where heights are known by their statistics or by
// a file alone.
struct Relief {
  bool present;
  std::optional<Planes> planes;

  // Highest minus lowest plane [m].
  std::optional<double> height() const {
    return planes ? std::optional(planes->high - planes->low) : std::nullopt;
  }
  static Relief between(double low, double high) { return {high > low, Planes{low, high}}; }
};

enum class Lattice { Square, Hexagonal };

// Distance of neighbours x, and height y of the rectangle that repeats [m].
struct UnitCell {
  double x, y;

  bool operator==(const UnitCell&) const = default;
};
// Whether so many whole parts make a length, to a millionth of a part.
inline bool divides(double part, double length) {
  const double times = length / part;
  return times > 0.5 && std::abs(times - std::round(times)) <= 1e-6;
}

// Side of the square that is simulated where nothing repeats [m].
struct FreePatch {
  double least;                 // a shorter one does not hold the texture
  std::optional<double> exact;  // the only one that there is
  bool repeats;                 // the exact one is a period: more of them are the same surface

  double side(double wanted) const { return exact ? *exact : std::max(wanted, least); }
};

// Infinite where a texture has no such feature.
struct FabricationMargins {
  double min_hole;      // smallest opening [m]
  double min_wall;      // smallest land or wall [m]
  double aspect_ratio;  // depth / smallest hole or wall

  double smallest() const { return std::min(min_hole, min_wall); }
  static FabricationMargins none() {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    return {kNone, kNone, 0};
  }
};

// Height [m] between an outline of a feature, this wide [m], and the next one inside it; over what
// is around the features.
struct Terrace {
  double width, height;
};

// Equal features on a lattice as seen from above: what a layout repeats, and what the closed forms
// of optics take.
struct FeatureArray {
  enum class Shape { Disc, Line };
  Shape shape;
  bool deep;  // the features lie below the land (holes, grooves), or they stand on a floor
  Lattice lattice;
  double period, width;    // distance of neighbours; diameter or width of a feature [m]
  std::string_view drawn;  // "holes": what the shapes are
  // Walls and rims in steps, from the outermost outline in.
  std::vector<Terrace> terraces{};
};
struct Contours {};  // the level sets of its heights
struct NoOutline {
  std::string reason;  // "the surface is flat, there are no outlines to write"
};
using Outline = std::variant<FeatureArray, Contours, NoOutline>;

inline const std::vector<ScanSource> kNoScans{};

// One scale of Gaussian heights: their autocorrelation is exp(-r^2/length^2). Eq. geometry.10
struct RoughScale {
  double rms, correlation_length;  // [m], over an endless surface

  bool operator==(const RoughScale&) const = default;
};
inline const std::vector<RoughScale> kNoRoughness{};

struct TextureFacts {
  Stated<Relief> relief;
  Stated<std::optional<UnitCell>> cell;  // none: aperiodic or flat
  Stated<FreePatch> free_patch;
  Stated<FabricationMargins> margins;
  Stated<std::optional<double>> open_share;  // projected share below half the depth
  Stated<std::optional<double>> rim_radius;  // least radius of convex rims [m]; none: no rims
  // Angle of its steepest slope from the land [rad]; none where heights are known by their
  // statistics or by a file alone.
  Stated<std::optional<double>> steepest;
  Stated<Outline> outline;                // of what is deep, at any depth of it
  Stated<std::vector<ScanSource>> scans;  // the measured maps that it is made of
  Stated<std::vector<RoughScale>> rough;  // all of its heights, where they are Gaussian; else none
  Stated<bool> directional;  // made along one direction: grooves, crests; of a scan not judged
  Stated<bool> quick_look;   // optics take a millisecond, whatever the numbers of this kind are

  double period() const { return cell ? cell->x : 0; }  // [m]; 0: aperiodic or flat
};

// Which member plays which part; null where a kind has none. The first six carry over to other
// kinds: a hole's depth is a pillar's height.
struct Roles {
  Stated<Lattice*> lattice;
  Stated<double*> period, width, depth, wall_angle, edge_radius;
  Stated<double*> relief;               // of which 0 means flat
  Stated<std::vector<Texture>*> parts;  // the textures that this one is made of

  static Roles none() {
    return {.lattice = nullptr,
            .period = nullptr,
            .width = nullptr,
            .depth = nullptr,
            .wall_angle = nullptr,
            .edge_radius = nullptr,
            .relief = nullptr,
            .parts = nullptr};
  }
};

// What a single key cannot say: (key, message) of every contradiction between keys.
using TextureProblems = std::vector<std::pair<std::string, std::string>>;

// All that a kind of texture is. kNumbersAlone: its numbers say all of it, no file and no parts, so
// kinds of it can compete in a search.
template <class K>
concept TextureKind = std::default_initializable<K> && std::equality_comparable<K> &&
    requires(FieldVisitor& v, K& kind, const K& fixed, const Grid& grid) {
  { K::kName } -> std::convertible_to<std::string_view>;
  { K::kNumbersAlone } -> std::convertible_to<bool>;
  fields(v, kind);
  { heights(fixed, grid) } -> std::same_as<Heightmap>;
  { problems(fixed) } -> std::same_as<TextureProblems>;
  { facts(fixed) } -> std::same_as<TextureFacts>;
  { roles(kind) } -> std::same_as<Roles>;
};

}  // namespace papilla::geometry
