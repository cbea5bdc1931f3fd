// The operator on columns and its multigrid against dense matrices of the same conductances.
#include "physics/electrostatics/column_operator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/random.h"

namespace papilla::tests::column_operator_test {
namespace {

using Matrix = std::vector<std::vector<double>>;

std::vector<double> product(const Matrix& a, const std::vector<double>& x) {
  std::vector<double> out;
  for (const std::vector<double>& row : a)
    out.push_back(std::inner_product(row.begin(), row.end(), x.begin(), 0.0));
  return out;
}

std::vector<double> solved(Matrix a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k + 1; i < n; ++i) {
      const double f = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

// Random conductances, and the matrix that they make.
struct Network {
  ColumnOperator op;
  Matrix matrix;

  Network(int nx, int ny, int n)
      : op(nx, ny, n), matrix(op.size(), std::vector<double>(op.size(), 0)) {
    RandomStream random(5, "columns", static_cast<std::uint64_t>(100 * nx + 10 * ny + n));
    const auto join = [&](std::size_t a, std::size_t b, double c) {
      matrix[a][a] += c, matrix[b][b] += c;
      matrix[a][b] -= c, matrix[b][a] -= c;
    };
    for (int iy = 0; iy < ny; ++iy) {
      for (int ix = 0; ix < nx; ++ix) {
        for (int a = 0; a < n; ++a) {
          const std::size_t i = op.index(ix, iy, a);
          const double body = 0.1 + random.uniform();
          op.add_body(ix, iy, a, body);
          matrix[i][i] += body;
          for (int b = a + 1; b < n; ++b) {
            const double own = 1 + random.uniform();
            op.add_own(ix, iy, a, b, own);
            join(i, op.index(ix, iy, b), own);
          }
          for (int b = 0; b < n; ++b) {
            if (nx > 1) {
              const double east = random.uniform();
              op.add_east(ix, iy, a, b, east);
              join(i, op.index((ix + 1) % nx, iy, b), east);
            }
            if (ny > 1) {
              const double north = random.uniform();
              op.add_north(ix, iy, a, b, north);
              join(i, op.index(ix, (iy + 1) % ny, b), north);
            }
          }
        }
      }
    }
    op.factor();
  }
};

std::vector<double> numbers(std::size_t n, std::uint64_t seed) {
  RandomStream random(6, "numbers", seed);
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(random.normal());
  return out;
}

std::vector<float> rounded(const std::vector<double>& v) { return {v.begin(), v.end()}; }

void expect_near(const std::vector<float>& is, const std::vector<double>& expected, double error) {
  ASSERT_EQ(is.size(), expected.size());
  double largest = 0;
  for (const double e : expected) largest = std::max(largest, std::abs(e));
  for (std::size_t i = 0; i < expected.size(); ++i)
    ASSERT_NEAR(is[i], expected[i], error * largest) << i;
}

// Two columns a side are neighbours across both of their faces.
constexpr int kSides[][2] = {{5, 3}, {4, 4}, {2, 6}, {7, 1}, {1, 3}, {3, 2}};

TEST(ColumnOperator, IsTheMatrixOfItsConductances) {
  for (const auto& [nx, ny] : kSides) {
    const Network net(nx, ny, 3);
    const std::vector<double> in = numbers(net.op.size(), 1);
    const std::vector<double> expected = product(net.matrix, in);
    std::vector<double> out(in.size(), 7);
    net.op.apply(in, out);
    for (std::size_t i = 0; i < in.size(); ++i)
      ASSERT_NEAR(out[i], expected[i], 1e-5) << nx << ' ' << ny << ' ' << i;
    std::vector<float> single(in.size(), 7);
    net.op.apply(rounded(in), single);
    expect_near(single, expected, 1e-5);
  }
}

// The columns by themselves: the blocks of unknowns of one column on the matrix's diagonal.
std::vector<double> by_columns(const Network& net, const std::vector<double>& rhs) {
  const ColumnOperator& op = net.op;
  std::vector<double> out(rhs.size());
  for (int iy = 0; iy < op.ny(); ++iy) {
    for (int ix = 0; ix < op.nx(); ++ix) {
      Matrix own(static_cast<std::size_t>(op.n()));
      std::vector<double> b;
      for (int a = 0; a < op.n(); ++a) {
        for (int c = 0; c < op.n(); ++c)
          own[static_cast<std::size_t>(a)].push_back(
              net.matrix[op.index(ix, iy, a)][op.index(ix, iy, c)]);
        b.push_back(rhs[op.index(ix, iy, a)]);
      }
      const std::vector<double> x = solved(own, b);
      for (int a = 0; a < op.n(); ++a) out[op.index(ix, iy, a)] = x[static_cast<std::size_t>(a)];
    }
  }
  return out;
}

// Damped by 0.8, on nothing or on what is there. (Of one column a side, its neighbour is itself.)
TEST(ColumnOperator, RelaxesByTheExactSolutionOfItsColumns) {
  for (const auto& [nx, ny] : {std::pair{5, 3}, {4, 4}, {3, 5}}) {
    const Network net(nx, ny, 3);
    const std::vector<double> rhs = numbers(net.op.size(), 2), before = numbers(net.op.size(), 3);
    std::vector<double> expected = by_columns(net, rhs);
    for (double& x : expected) x *= 0.8;
    std::vector<float> r = rounded(rhs), x = rounded(before);
    net.op.relax(r, x, false);
    expect_near(x, expected, 1e-5);
    for (std::size_t i = 0; i < expected.size(); ++i) expected[i] += before[i];
    r = rounded(rhs), x = rounded(before);
    net.op.relax(r, x, true);
    expect_near(x, expected, 1e-5);
  }
}

TEST(ColumnOperator, AnUnknownInsideABodyStandsAlone) {
  ColumnOperator op(2, 2, 2);
  op.add_body(1, 0, 1, 4);
  op.factor();
  std::vector<float> rhs(op.size(), 1), x(op.size(), 0);
  op.relax(rhs, x, false);
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_FLOAT_EQ(x[i], i == op.index(1, 0, 1) ? 0.2F : 0.8F) << i;
}

// Two unknowns joined by 1e8 and to a body by next to nothing: 1e8 and -1e8 cancel, and a millionth
// of the diagonal stands for what is left, 100. L = ((1e4, 0), (-1e4, 10)).
TEST(ColumnOperator, APivotThatCancelsIsAMillionthOfItsDiagonal) {
  ColumnOperator op(1, 1, 2);
  op.add_own(0, 0, 0, 1, 1e8);
  op.add_body(0, 0, 0, 1e-3);
  op.factor();
  std::vector<float> rhs{1, 0}, x{0, 0};
  op.relax(rhs, x, false);
  EXPECT_NEAR(x[0], 0.8 * 0.01, 1e-6);
  EXPECT_NEAR(x[1], 0.8 * 0.01, 1e-6);
}

// Which column of the coarse level an unknown belongs to.
std::size_t parent(const ColumnOperator& fine, const ColumnOperator& coarse, std::size_t i) {
  const auto nx = static_cast<std::size_t>(fine.nx()), n = static_cast<std::size_t>(fine.n());
  return coarse.index(static_cast<int>(i % nx) / 2, static_cast<int>(i / nx / n) / 2,
                      static_cast<int>(i / nx % n));
}

// P^T A P of the potentials that are constant on two by two columns.
Matrix galerkin(const Matrix& a, const ColumnOperator& fine, const ColumnOperator& coarse) {
  Matrix out(coarse.size(), std::vector<double>(coarse.size(), 0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j)
      out[parent(fine, coarse, i)][parent(fine, coarse, j)] += a[i][j];
  }
  return out;
}

TEST(ColumnOperator, OfTwoByTwoColumnsIsThatOfPotentialsConstantOnThem) {
  for (const auto& [nx, ny] : kSides) {
    const Network net(nx, ny, 3);
    const ColumnOperator coarse = net.op.coarser();
    ASSERT_EQ(coarse.nx(), (nx + 1) / 2);
    ASSERT_EQ(coarse.ny(), (ny + 1) / 2);
    ASSERT_EQ(coarse.n(), 3);
    const Matrix matrix = galerkin(net.matrix, net.op, coarse);
    const std::vector<double> in = numbers(coarse.size(), 4);
    std::vector<float> out(in.size());
    coarse.apply(rounded(in), out);
    expect_near(out, product(matrix, in), 1e-5);
  }
}

// One level down a network of its own: the same matrices, dense.
struct DenseLevel {
  Network net;
  explicit DenseLevel(const Network& n) : net(n) {}
  std::vector<double> relaxed(const std::vector<double>& r) const {
    std::vector<double> out = by_columns(net, r);
    for (double& x : out) x *= 0.8;
    return out;
  }
  void correct(const std::vector<double>& b, std::vector<double>& x) const {
    const std::vector<double> ax = product(net.matrix, x);
    std::vector<double> r(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) r[i] = b[i] - ax[i];
    const std::vector<double> more = relaxed(r);
    for (std::size_t i = 0; i < b.size(); ++i) x[i] += more[i];
  }
};

// A sweep before and one after the coarse correction; five sweeps in all where no side has more
// than four columns.
std::vector<double> dense_cycle(const Network& net, const std::vector<double>& b) {
  const DenseLevel level(net);
  std::vector<double> x = level.relaxed(b);
  if (net.op.nx() <= 4 && net.op.ny() <= 4) {
    for (int sweep = 0; sweep < 4; ++sweep) level.correct(b, x);
    return x;
  }
  Network coarse = net;
  coarse.op = net.op.coarser();
  coarse.matrix = galerkin(net.matrix, net.op, coarse.op);
  std::vector<double> rest(coarse.op.size(), 0);
  const std::vector<double> ax = product(net.matrix, x);
  for (std::size_t i = 0; i < b.size(); ++i) rest[parent(net.op, coarse.op, i)] += b[i] - ax[i];
  const std::vector<double> below = dense_cycle(coarse, rest);
  for (std::size_t i = 0; i < b.size(); ++i) x[i] += below[parent(net.op, coarse.op, i)];
  level.correct(b, x);
  return x;
}

TEST(ColumnMultigrid, ACycleIsThatOfDenseMatrices) {
  for (const auto& [nx, ny] : {std::pair{4, 3}, {5, 4}, {4, 6}, {9, 5}, {12, 8}}) {
    const Network net(nx, ny, 2);
    ColumnMultigrid multigrid(net.op);
    // A second cycle knows nothing of the first.
    for (const std::uint64_t seed : {7, 8}) {
      const std::vector<double> b = numbers(net.op.size(), seed);
      multigrid.b() = rounded(b);
      multigrid.cycle();
      expect_near(multigrid.x(), dense_cycle(net, b), 2e-5);
      EXPECT_EQ(multigrid.b(), rounded(b));
    }
  }
}

// As conjugate gradients ask for: a.M b = b.M a, and a.M a > 0.
TEST(ColumnMultigrid, IsSymmetricAndPositive) {
  const Network net(11, 7, 3);
  ColumnMultigrid multigrid(net.op);
  const auto cycled = [&](const std::vector<double>& b) {
    multigrid.b() = rounded(b);
    multigrid.cycle();
    return std::vector<double>(multigrid.x().begin(), multigrid.x().end());
  };
  const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  const std::vector<double> a = numbers(net.op.size(), 9), b = numbers(net.op.size(), 10);
  const std::vector<double> ma = cycled(a), mb = cycled(b);
  const double scale = std::sqrt(dot(a, ma) * dot(b, mb));
  EXPECT_GT(dot(a, ma), 0);
  EXPECT_NEAR(dot(a, mb), dot(b, ma), 1e-5 * scale);
}

}  // namespace
}  // namespace papilla::tests::column_operator_test
