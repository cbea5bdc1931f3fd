// A measured heightmap as a texture.
#pragma once

#include <optional>

#include "base/rooms.h"
#include "geometry/facts.h"

namespace papilla::geometry {

struct Measured3d {
  static constexpr std::string_view kName = "measured";
  static constexpr bool kNumbersAlone = false;

  std::string file;           // as read_map takes it: "scan.gwy", "scan.gwy::Height"
  double width = 0;           // lateral size where the file does not say [m]
  bool fill = false;          // heights that are no numbers get those around them
  bool as_is = false;         // neither levelled nor mended
  bool level = false;         // also where it is made or periodic
  double top = 0;             // of its highest place over the untouched land, z = 0 [m]
  double patch = 12e-6;       // side of the square that is simulated
  double at_x = 0, at_y = 0;  // its middle, from the middle of the map [m]
  // What repeats within the map, where the program that wrote it knows: no key of a design says it.
  std::optional<UnitCell> cell{};

  bool operator==(const Measured3d&) const = default;
};

void fields(FieldVisitor& v, Measured3d& t);
Heightmap heights(const Measured3d& t, const Grid& grid);
TextureProblems problems(const Measured3d& t);
TextureFacts facts(const Measured3d& t);
Roles roles(Measured3d& t);

}  // namespace papilla::geometry
