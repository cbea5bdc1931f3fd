// A surface as a closed body of triangles.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/layout.h"

namespace papilla::geometry {
namespace {

struct Vertex {
  float x, y, z;
};

void triangle(std::string& out, const Vertex& a, const Vertex& b, const Vertex& c) {
  const float ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const float vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const float length = std::sqrt(nx * nx + ny * ny + nz * nz);
  if (length > 0) nx /= length, ny /= length, nz /= length;
  const std::array<float, 12> values{nx, ny, nz, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
  out.append(reinterpret_cast<const char*>(values.data()), sizeof(values));
  out.append(2, '\0');
}

}  // namespace

void write_stl(const std::string& path, const Heightmap& h, double base) {
  const Grid& grid = h.grid;
  if (grid.size() > 4000000) {
    throw InputError(
        fmt::format("{} x {} pixels are too many for STL; export fewer", grid.nx, grid.ny));
  }
  const double floor = *std::min_element(h.z.begin(), h.z.end()) - base;
  // The first row and column again at the far sides, so that tiles meet; all half a pixel nearer
  // the origin, so that the block starts there.
  const auto at = [&](int ix, int iy) {
    return Vertex{static_cast<float>(1e6 * ix * grid.dx()),
                  static_cast<float>(1e6 * iy * grid.dy()),
                  static_cast<float>(1e6 * (h(ix % grid.nx, iy % grid.ny) - floor))};
  };
  const auto below = [](Vertex v) {
    v.z = 0;
    return v;
  };
  const int nx = grid.nx + 1, ny = grid.ny + 1;
  const auto faces = static_cast<std::uint32_t>(4L * (nx - 1) * (ny - 1) + 4L * (nx - 1 + ny - 1));
  std::string out(80, '\0');
  out.replace(0, 24, "papilla heightmap in um ");
  out.append(reinterpret_cast<const char*>(&faces), 4);
  out.reserve(84 + 50 * static_cast<std::size_t>(faces));
  for (int iy = 0; iy + 1 < ny; ++iy) {
    for (int ix = 0; ix + 1 < nx; ++ix) {
      const Vertex a = at(ix, iy), b = at(ix + 1, iy), c = at(ix + 1, iy + 1), d = at(ix, iy + 1);
      triangle(out, a, b, c);
      triangle(out, a, c, d);
      triangle(out, below(a), below(c), below(b));
      triangle(out, below(a), below(d), below(c));
    }
  }
  const auto wall = [&](const Vertex& a, const Vertex& b) {  // seen from outside, a left of b
    triangle(out, below(a), below(b), b);
    triangle(out, below(a), b, a);
  };
  for (int ix = 0; ix + 1 < nx; ++ix) {
    wall(at(ix, 0), at(ix + 1, 0));
    wall(at(ix + 1, ny - 1), at(ix, ny - 1));
  }
  for (int iy = 0; iy + 1 < ny; ++iy) {
    wall(at(nx - 1, iy), at(nx - 1, iy + 1));
    wall(at(0, iy + 1), at(0, iy));
  }
  write_bytes(path, out);
}

}  // namespace papilla::geometry
