#include "numerics/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace papilla::numerics {

bool Cholesky::factorise(std::vector<double>& lower, std::size_t n) {
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::Map<Eigen::MatrixXd> matrix(lower.data(), size, size);
  triangle_ = lower.data();
  n_ = n;
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(matrix);
  return in_place.info() == Eigen::Success;
}

void Cholesky::solve(std::vector<double>& x) const {
  const auto size = static_cast<Eigen::Index>(n_);
  const Eigen::Map<const Eigen::MatrixXd> matrix(triangle_, size, size);
  Eigen::Map<Eigen::VectorXd> vector(x.data(), size);
  const auto triangle = matrix.triangularView<Eigen::Lower>();
  triangle.solveInPlace(vector);
  triangle.transpose().solveInPlace(vector);
}

template <std::size_t N>
double solve(const std::array<std::array<double, N>, N>& a, std::array<double, N>& b) {
  constexpr int n = static_cast<int>(N);
  using Matrix = Eigen::Matrix<double, n, n, Eigen::RowMajor>;
  const Eigen::PartialPivLU<Matrix> parts(Eigen::Map<const Matrix>(a.front().data()));
  const double determinant = parts.determinant();
  if (determinant == 0) return 0;
  Eigen::Map<Eigen::Matrix<double, n, 1>> x(b.data());
  x = parts.solve(x).eval();
  return determinant;
}
template double solve<2>(const std::array<std::array<double, 2>, 2>&, std::array<double, 2>&);
template double solve<3>(const std::array<std::array<double, 3>, 3>&, std::array<double, 3>&);
template double solve<4>(const std::array<std::array<double, 4>, 4>&, std::array<double, 4>&);

}  // namespace papilla::numerics
