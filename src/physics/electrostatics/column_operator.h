// A linear operator on columns of unknowns, each coupled to its four neighbours, and the multigrid
// that inverts it nearly: the algebra of the full field, inside this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/rooms.h"

namespace papilla::electrostatics {

// Symmetric, n unknowns a column, periodic. Conductances to bodies and between unknowns; a row of
// ix is contiguous, so that every loop runs over columns.
class ColumnOperator {
 public:
  ColumnOperator(int nx, int ny, int n);

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  int n() const { return n_; }
  std::size_t size() const { return static_cast<std::size_t>(nx_) * ny_ * n_; }
  std::size_t index(int ix, int iy, int a) const {
    return (static_cast<std::size_t>(iy) * n_ + a) * nx_ + ix;
  }

  // Assembly: conductances to a body; between a and b of one column; between a of a column and b of
  // its neighbour in x or in y.
  void add_body(int ix, int iy, int a, double c) { body_[index(ix, iy, a)] += c; }
  void add_own(int ix, int iy, int a, int b, double c) {
    own_[block(iy, a, b) + ix] += static_cast<float>(c);
    own_[block(iy, b, a) + ix] += static_cast<float>(c);
  }
  void add_east(int ix, int iy, int a, int b, double c) {
    east_[block(iy, a, b) + ix] += static_cast<float>(c);
  }
  void add_north(int ix, int iy, int a, int b, double c) {
    north_[block(iy, a, b) + ix] += static_cast<float>(c);
  }
  // Ends assembly.
  void factor();

  // out = A in, by differences, so that constants stay exact.
  template <class T>
  void apply(const std::vector<T>& in, std::vector<T>& out) const;
  // x = or += damping * (the columns' own blocks)^-1 rhs; rhs is overwritten.
  void relax(std::vector<float>& rhs, std::vector<float>& x, bool add) const;
  // Two by two columns become one.
  ColumnOperator coarser() const;

 private:
  std::size_t block(int iy, int a, int b) const {
    return ((static_cast<std::size_t>(iy) * n_ + a) * n_ + b) * nx_;
  }
  std::size_t flag(int iy, int a, int b) const {
    return (static_cast<std::size_t>(iy) * n_ + a) * n_ + b;
  }
  std::vector<std::uint8_t> used(const std::vector<float>& blocks) const;
  std::vector<float> diagonal() const;

  int nx_, ny_, n_;
  std::vector<double> body_;
  std::vector<float> own_, east_, north_;  // conductances, off the diagonal
  std::vector<float> lower_;               // Cholesky factors of the own blocks, inverse diagonal
  std::vector<std::uint8_t> used_own_, used_east_, used_north_;  // rows that are not all zero
};

// A V-cycle over levels of two by two columns each.
class ColumnMultigrid {
 public:
  explicit ColumnMultigrid(ColumnOperator fine);
  const ColumnOperator& fine() const { return levels_.front().a; }
  std::vector<float>& b() { return levels_.front().b; }
  const std::vector<float>& x() const { return levels_.front().x; }
  void cycle() { cycle(0); }  // x from b

 private:
  struct Level {
    ColumnOperator a;
    std::vector<float> b, x, r;
  };
  void add_level(ColumnOperator a);
  void cycle(std::size_t level);
  static void residual(Level& level);

  std::vector<Level> levels_;
};

}  // namespace papilla::electrostatics
