#include "geometry/plane.h"

namespace papilla::geometry {

Plane plane_of(const Heightmap& h, double x0, double y0, double lx, double ly,
               const std::vector<std::uint8_t>* counts) {
  double n = 0, x = 0, y = 0, z = 0, xx = 0, yy = 0, xz = 0, yz = 0, xy = 0;
  const auto each = [&](const auto& use) {
    for (int iy = 0; iy < h.grid.ny; ++iy) {
      if (h.grid.y(iy) < y0 || h.grid.y(iy) > y0 + ly) continue;
      for (int ix = 0; ix < h.grid.nx; ++ix) {
        if (counts && !(*counts)[h.grid.index(ix, iy)]) continue;
        if (h.grid.x(ix) >= x0 && h.grid.x(ix) <= x0 + lx)
          use(h.grid.x(ix), h.grid.y(iy), h(ix, iy));
      }
    }
  };
  each([&](double px, double py, double pz) { n += 1, x += px, y += py, z += pz; });
  if (n == 0) return {};
  x /= n, y /= n, z /= n;
  each([&](double px, double py, double pz) {
    xx += (px - x) * (px - x), yy += (py - y) * (py - y);
    xz += (px - x) * (pz - z), yz += (py - y) * (pz - z);
    xy += (px - x) * (py - y);
  });
  double b = xx > 0 ? xz / xx : 0, c = yy > 0 ? yz / yy : 0;
  // Of a whole rectangle x and y are independent.
  if (const double det = xx * yy - xy * xy; counts && det > 0)
    b = (xz * yy - yz * xy) / det, c = (yz * xx - xz * xy) / det;
  return {z - b * x - c * y, b, c};
}

}  // namespace papilla::geometry
