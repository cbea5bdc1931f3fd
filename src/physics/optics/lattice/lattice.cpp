#include "physics/optics/lattice/lattice.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "base/constants.h"
#include "physics/optics/lattice/operators.h"

namespace papilla::optics {
namespace {

// The wave in its symmetric combinations of orders: electric field x and magnetic field y are of
// one symmetry, electric field y and magnetic field x of the other.
struct Basis {
  std::vector<OrderIndex> orders;
  Eigen::VectorXd kx, ky;         // of each order, over that of vacuum
  Eigen::MatrixXd first, second;  // combinations of E_x and H_y, of E_y and H_x
  Eigen::VectorXd transverse;     // kx^2 + ky^2 of each combination, those of `first` first
  Eigen::Index incident = 0;      // place of the incident wave

  Eigen::Index size() const { return first.cols() + second.cols(); }
};

Eigen::VectorXd squares_of(const Eigen::MatrixXd& combined, const Eigen::VectorXd& of_order) {
  return combined.cwiseAbs2().transpose() * of_order;
}

Basis basis_of(const LatticeStack& stack, const LatticeWave& wave, int beyond) {
  Basis b;
  b.orders = orders_within(stack, wave.wavelength, beyond);
  const auto size = static_cast<Eigen::Index>(b.orders.size());
  b.kx.resize(size), b.ky.resize(size);
  Eigen::Index middle = 0;
  for (Eigen::Index i = 0; i < size; ++i) {
    const OrderIndex& o = b.orders[static_cast<std::size_t>(i)];
    b.kx(i) = wave.sine + o.m * wave.wavelength / stack.cell.lx;
    b.ky(i) = o.n * wave.wavelength / stack.cell.ly;
    if (o.m == 0 && o.n == 0) middle = i;
  }
  // The field of the incident wave is even along both axes, that of the other direction odd.
  const bool p = wave.polarisation == Polarisation::P, normal = wave.sine == 0;
  const Mirror even_x = normal ? Mirror::Even : Mirror::None,
               odd_x = normal ? Mirror::Odd : Mirror::None;
  const Eigen::MatrixXd own = combinations(b.orders, even_x, Mirror::Even),
                        other = combinations(b.orders, odd_x, Mirror::Odd);
  b.first = p ? own : other, b.second = p ? other : own;
  const Eigen::VectorXd k2 = b.kx.cwiseAbs2() + b.ky.cwiseAbs2();
  b.transverse.resize(b.size());
  b.transverse << squares_of(b.first, k2), squares_of(b.second, k2);
  Eigen::Index column = 0;
  own.row(middle).cwiseAbs().maxCoeff(&column);
  b.incident = p ? column : b.first.cols() + column;
  return b;
}

// Of a slice or a half space: modes E = W (a e^{iqz} + b e^{-iqz}), H = V (a e^{iqz} - b e^{-iqz}).
struct Modes {
  ComplexMatrix w, v;
  ComplexVector q;
};

// The root that decays, or runs forward.
Complex forward_root(Complex square_of_q) {
  Complex q = std::sqrt(square_of_q);
  if (q.imag() < 0 || (q.imag() == 0 && q.real() < 0)) q = -q;
  constexpr double kGrazing = 1e-9;  // a wave along the face has no admittance
  return std::abs(q) < kGrazing ? Complex(0, kGrazing) : q;
}

// An operator on orders between combinations of them. Here, as below, products are of plain
// matrices: each of Eigen's expressions of several factors costs the compiler seconds.
ComplexMatrix between(const Eigen::MatrixXd& to, const ComplexMatrix& of_orders,
                      const Eigen::MatrixXd& from) {
  const ComplexMatrix right = of_orders * from;
  return to.transpose() * right;
}

ComplexMatrix diagonal(const Eigen::VectorXd& of_order) {
  return of_order.cast<Complex>().asDiagonal();
}

ComplexMatrix solution(const ComplexMatrix& matrix, const ComplexMatrix& right) {
  return matrix.partialPivLu().solve(right);
}

// Each column times its own factor.
ComplexMatrix with_columns_times(ComplexMatrix matrix, const ComplexVector& factors) {
  for (Eigen::Index i = 0; i < factors.size(); ++i) matrix.col(i) *= factors(i);
  return matrix;
}

// dH/dz = i Q E. Eq. optics.17
ComplexMatrix magnetic_operator(const Basis& b, const SliceOperators& e) {
  const ComplexMatrix crossed = diagonal(b.kx.cwiseProduct(b.ky)) + e.xy;
  const ComplexMatrix along_x = diagonal(b.kx.cwiseAbs2()) - e.yy,
                      along_y = e.xx - diagonal(b.ky.cwiseAbs2());
  const Eigen::Index n1 = b.first.cols(), n2 = b.second.cols();
  ComplexMatrix q(b.size(), b.size());
  // Rows: H_x (second), H_y (first); columns: E_x (first), E_y (second).
  q.topLeftCorner(n2, n1) = -between(b.second, crossed, b.first);
  q.topRightCorner(n2, n2) = between(b.second, along_x, b.second);
  q.bottomLeftCorner(n1, n1) = between(b.first, along_y, b.first);
  q.bottomRightCorner(n1, n2) = between(b.first, crossed, b.second);
  return q;
}

// dE/dz = i P H. Eq. optics.17
ComplexMatrix electric_operator(const Basis& b, const SliceOperators& e) {
  // 1 / permittivity between the derivatives along two axes.
  const auto weighted = [&](const Eigen::VectorXd& left, const Eigen::VectorXd& right) {
    return ComplexMatrix(
        e.inverse_zz.cwiseProduct(ComplexMatrix((left * right.transpose()).cast<Complex>())));
  };
  const auto size = static_cast<Eigen::Index>(b.orders.size());
  const ComplexMatrix one = ComplexMatrix::Identity(size, size);
  const Eigen::Index n1 = b.first.cols(), n2 = b.second.cols();
  ComplexMatrix p(b.size(), b.size());
  // Rows: E_x, E_y; columns: H_x (second), H_y (first).
  p.topLeftCorner(n1, n2) = between(b.first, weighted(b.kx, b.ky), b.second);
  p.topRightCorner(n1, n1) = between(b.first, one - weighted(b.kx, b.kx), b.first);
  p.bottomLeftCorner(n2, n2) = between(b.second, weighted(b.ky, b.ky) - one, b.second);
  p.bottomRightCorner(n2, n1) = -between(b.second, weighted(b.ky, b.kx), b.first);
  return p;
}

SliceOperators flat_operators(const Basis& b, Complex permittivity) {
  const auto size = static_cast<Eigen::Index>(b.orders.size());
  const ComplexMatrix one = ComplexMatrix::Identity(size, size);
  return {permittivity * one, ComplexMatrix::Zero(size, size), permittivity * one,
          one / permittivity};
}

Modes flat_modes(const Basis& b, Complex permittivity) {
  Modes out;
  out.w = ComplexMatrix::Identity(b.size(), b.size());
  out.q.resize(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i)
    out.q(i) = forward_root(permittivity - b.transverse(i));
  out.v = with_columns_times(magnetic_operator(b, flat_operators(b, permittivity)),
                             out.q.cwiseInverse());
  return out;
}

Modes lattice_modes(const Basis& b, const SliceOperators& e) {
  const ComplexMatrix q = magnetic_operator(b, e), both = electric_operator(b, e) * q;
  Modes out;
  ComplexVector squares;
  // Without absorption everything is real, and four times cheaper.
  if (both.imag().cwiseAbs().maxCoeff() <= 1e-13 * both.cwiseAbs().maxCoeff()) {
    const Eigen::EigenSolver<Eigen::MatrixXd> solved(both.real());
    squares = solved.eigenvalues(), out.w = solved.eigenvectors();
  } else {
    const Eigen::ComplexEigenSolver<ComplexMatrix> solved(both);
    squares = solved.eigenvalues(), out.w = solved.eigenvectors();
  }
  out.q.resize(squares.size());
  for (Eigen::Index i = 0; i < squares.size(); ++i) out.q(i) = forward_root(squares(i));
  out.v = with_columns_times(q * out.w, out.q.cwiseInverse());
  return out;
}

Modes modes_of(const Basis& b, const LatticeCell& cell, const LatticeSlice& slice) {
  if (slice.flat()) return flat_modes(b, slice.inside);
  return lattice_modes(b, slice_operators(cell, slice, b.orders));
}

// Powers of the orders that propagate: each combination's is shared by its orders.
std::vector<LatticeOrder> powers(const Basis& b, const Modes& space, const ComplexVector& e,
                                 double incident, double permittivity) {
  const ComplexVector h = space.v * e;
  const Eigen::Index n1 = b.first.cols(), n2 = b.second.cols();
  Eigen::VectorXd of_order = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(b.orders.size()));
  for (Eigen::Index i = 0; i < n1; ++i)
    of_order += (std::conj(e(i)) * h(n2 + i)).real() * b.first.col(i).cwiseAbs2();
  for (Eigen::Index i = 0; i < n2; ++i)
    of_order -= (std::conj(e(n1 + i)) * h(i)).real() * b.second.col(i).cwiseAbs2();
  std::vector<LatticeOrder> out;
  for (Eigen::Index i = 0; i < of_order.size(); ++i) {
    if (b.kx(i) * b.kx(i) + b.ky(i) * b.ky(i) >= permittivity) continue;
    const OrderIndex& o = b.orders[static_cast<std::size_t>(i)];
    out.push_back({o.m, o.n, of_order(i) / incident, b.kx(i), b.ky(i)});
  }
  return out;
}

double power_of(const std::vector<LatticeOrder>& orders) {
  double sum = 0;
  for (const LatticeOrder& o : orders) sum += o.power;
  return sum;
}
double middle_of(const std::vector<LatticeOrder>& orders) {
  for (const LatticeOrder& o : orders) {
    if (o.m == 0 && o.n == 0) return o.power;
  }
  return 0;
}

}  // namespace

double Diffracted::reflection() const { return power_of(reflected); }
double Diffracted::transmission() const { return power_of(transmitted); }
double Diffracted::straight() const { return middle_of(transmitted); }
double Diffracted::mirrored() const { return middle_of(reflected); }

Diffracted diffract(const LatticeStack& stack, const LatticeWave& wave, int beyond) {
  const Basis b = basis_of(stack, wave, beyond);
  const double k = 2 * kPi / wave.wavelength;
  const Modes before = flat_modes(b, square(stack.from)), after = flat_modes(b, square(stack.to));
  // Fields over the amplitudes that leave a boundary, from the last one up. Eq. optics.19
  ComplexMatrix e = after.w, h = after.v;
  std::vector<ComplexMatrix> passages;
  for (std::size_t s = stack.slices.size(); s-- > 0;) {
    const LatticeSlice& slice = stack.slices[s];
    const Modes m = modes_of(b, stack.cell, slice);
    const ComplexMatrix electric = solution(m.w, e), magnetic = solution(m.v, h);
    const ComplexVector decay = (Complex(0, k * slice.thickness) * m.q).array().exp();
    const ComplexMatrix down = 0.5 * (electric + magnetic), up = 0.5 * (electric - magnetic);
    passages.push_back(solution(down, ComplexMatrix(decay.asDiagonal())));
    ComplexMatrix returned = up * passages.back();
    for (Eigen::Index i = 0; i < decay.size(); ++i) returned.row(i) *= decay(i);
    const ComplexMatrix one = ComplexMatrix::Identity(b.size(), b.size()), with = one + returned,
                        without = one - returned;
    e = m.w * with;
    h = m.v * without;
  }
  ComplexVector in = ComplexVector::Zero(b.size());
  in(b.incident) = 1;
  const ComplexVector sent = before.v * in;
  const double incident = b.incident < b.first.cols() ? sent(b.second.cols() + b.incident).real()
                                                      : -sent(b.incident - b.first.cols()).real();
  ComplexMatrix admitted = before.v * e;
  admitted += h;
  ComplexVector out = solution(admitted, 2.0 * sent);
  const ComplexVector back = e * out - in;
  for (auto p = passages.rbegin(); p != passages.rend(); ++p) out = ComplexVector(*p * out);
  return {powers(b, before, back, incident, square(stack.from)),
          powers(b, after, out, incident, square(stack.to)), static_cast<int>(b.size())};
}

}  // namespace papilla::optics
