// Multigrid on columns of nodes: the preconditioner of the full field, inside this folder.
#pragma once

#include <cstddef>
#include <vector>

namespace papilla {

// One grid: conductances between nodes and to bodies [m, over eps0 dx]. Row (iy, k) is contiguous
// in ix; periodic in x and y.
struct FieldLevel {
  int nx = 0, ny = 0, nz = 0;
  std::vector<float> cx, cy, cz, body;   // to ix+1, iy+1, k+1, to electrode and skin
  std::vector<float> diagonal, inverse;  // inverse: of the line elimination's pivots
  std::vector<float> b, x, r;

  std::size_t row(int iy, int k) const {
    return (static_cast<std::size_t>(iy) * nz + k) * static_cast<std::size_t>(nx);
  }
  std::size_t size() const { return static_cast<std::size_t>(nx) * ny * nz; }

  void allocate();
  void factor();
  // x = or += damping * T^-1 rhs, T the lines along z; rhs is overwritten.
  void relax(std::vector<float>& rhs, bool add);
  void residual();  // r = b - A x
  // out = A v in double precision; links as differences, so that constants stay exact.
  void apply(const std::vector<double>& v, std::vector<double>& out) const;
};

// A V-cycle over levels of two by two columns each; lines along z are solved exactly.
class Multigrid {
 public:
  explicit Multigrid(FieldLevel fine);
  FieldLevel& fine() { return levels_.front(); }
  void cycle() { cycle(0); }  // fine().x from fine().b

 private:
  void cycle(std::size_t level);

  std::vector<FieldLevel> levels_;
};

}  // namespace papilla
