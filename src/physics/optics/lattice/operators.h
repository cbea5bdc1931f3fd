// The matrices of a slice: Fourier coefficients by orders, and the symmetric combinations of orders
// that a wave can excite.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/rooms.h"
#include "physics/optics/lattice/lattice.h"

namespace papilla::optics {

using ComplexMatrix = Eigen::MatrixXcd;
using ComplexVector = Eigen::VectorXcd;

struct OrderIndex {
  int m, n;
};

// Orders within a circle of spatial frequencies, closed under mirrors. None along a direction in
// which no slice varies.
std::vector<OrderIndex> orders_within(const LatticeStack& stack, double wavelength, int beyond);

// Combinations of orders of one kind of mirror symmetry: columns of a real matrix with orthonormal
// columns.
enum class Mirror { Even, Odd, None };
Eigen::MatrixXd combinations(const std::vector<OrderIndex>& orders, Mirror x, Mirror y);

// Toeplitz matrices of a slice, between all orders. Eq. optics.18
struct SliceOperators {
  ComplexMatrix xx, xy, yy;  // of the tangential displacement over the field
  ComplexMatrix inverse_zz;  // of the normal field over the displacement
};
SliceOperators slice_operators(const LatticeCell& cell, const LatticeSlice& slice,
                               const std::vector<OrderIndex>& orders);

}  // namespace papilla::optics
