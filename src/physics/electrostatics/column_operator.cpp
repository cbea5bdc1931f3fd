#include "physics/electrostatics/column_operator.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace papilla::electrostatics {
namespace {

constexpr float kDamping = 0.8F;    // of the relaxation
constexpr int kCoarsestSweeps = 4;  // on the coarsest level
constexpr int kCoarsest = 4;        // columns a side

}  // namespace

ColumnOperator::ColumnOperator(int nx, int ny, int n)
    : nx_(nx),
      ny_(ny),
      n_(n),
      body_(size(), 0),
      own_(size() * n, 0),
      east_(own_.size(), 0),
      north_(own_.size(), 0) {}

std::vector<std::uint8_t> ColumnOperator::used(const std::vector<float>& blocks) const {
  std::vector<std::uint8_t> out(static_cast<std::size_t>(ny_) * n_ * n_);
  for (std::size_t row = 0; row < out.size(); ++row) {
    const float* c = blocks.data() + row * nx_;
    out[row] = std::any_of(c, c + nx_, [](float v) { return v != 0; });
  }
  return out;
}

// Sums of all conductances of an unknown.
std::vector<float> ColumnOperator::diagonal() const {
  std::vector<double> sum = body_;
  for (int iy = 0; iy < ny_; ++iy) {
    const int north = iy + 1 < ny_ ? iy + 1 : 0;
    for (int a = 0; a < n_; ++a) {
      for (int b = 0; b < n_; ++b) {
        const std::size_t o = block(iy, a, b);
        double *at = &sum[index(0, iy, a)], *beside = &sum[index(0, iy, b)],
               *above = &sum[index(0, north, b)];
        for (int i = 0; i < nx_; ++i) {
          at[i] += own_[o + i] + east_[o + i] + north_[o + i];
          beside[i + 1 < nx_ ? i + 1 : 0] += east_[o + i];
          above[i] += north_[o + i];
        }
      }
    }
  }
  std::vector<float> out(sum.size());
  // Unknowns inside a body stand alone.
  for (std::size_t o = 0; o < sum.size(); ++o) out[o] = sum[o] > 0 ? static_cast<float>(sum[o]) : 1;
  return out;
}

void ColumnOperator::factor() {
  used_own_ = used(own_);
  used_east_ = used(east_);
  used_north_ = used(north_);
  const std::vector<float> diagonal = this->diagonal();
  lower_.assign(own_.size(), 0);
  for (int iy = 0; iy < ny_; ++iy) {
    for (int a = 0; a < n_; ++a) {
      for (int b = 0; b <= a; ++b) {
        float* l = &lower_[block(iy, a, b)];
        const float* c = b < a ? &own_[block(iy, a, b)] : &diagonal[index(0, iy, a)];
        const float sign = b < a ? -1 : 1;
        for (int i = 0; i < nx_; ++i) l[i] = sign * c[i];
        for (int k = 0; k < b; ++k) {
          const float *p = &lower_[block(iy, a, k)], *q = &lower_[block(iy, b, k)];
          for (int i = 0; i < nx_; ++i) l[i] -= p[i] * q[i];
        }
        if (b < a) {
          const float* d = &lower_[block(iy, b, b)];
          for (int i = 0; i < nx_; ++i) l[i] *= d[i];
        } else {
          // A column whose conductances differ beyond single precision keeps a positive pivot.
          for (int i = 0; i < nx_; ++i) l[i] = 1 / std::sqrt(std::max(l[i], 1e-6F * c[i]));
        }
      }
    }
  }
}

template <class T>
void ColumnOperator::apply(const std::vector<T>& in, std::vector<T>& out) const {
  for (std::size_t o = 0; o < out.size(); ++o) out[o] = static_cast<T>(body_[o]) * in[o];
  for (int iy = 0; iy < ny_; ++iy) {
    const int north = iy + 1 < ny_ ? iy + 1 : 0;
    for (int a = 0; a < n_; ++a) {
      const T* x = &in[index(0, iy, a)];
      T* y = &out[index(0, iy, a)];
      for (int b = 0; b < n_; ++b) {
        const std::size_t o = block(iy, a, b);
        const T* z = &in[index(0, iy, b)];
        if (used_own_[flag(iy, a, b)]) {
          const float* c = &own_[o];
          for (int i = 0; i < nx_; ++i) y[i] += c[i] * (x[i] - z[i]);
        }
        if (used_east_[flag(iy, a, b)]) {
          const float* c = &east_[o];
          T* t = &out[index(0, iy, b)];
          for (int i = 0; i + 1 < nx_; ++i) y[i] += c[i] * (x[i] - z[i + 1]);
          for (int i = 0; i + 1 < nx_; ++i) t[i + 1] -= c[i] * (x[i] - z[i + 1]);
          const T across = c[nx_ - 1] * (x[nx_ - 1] - z[0]);
          y[nx_ - 1] += across;
          t[0] -= across;
        }
        if (used_north_[flag(iy, a, b)]) {
          const float* c = &north_[o];
          const T* w = &in[index(0, north, b)];
          T* t = &out[index(0, north, b)];
          for (int i = 0; i < nx_; ++i) {
            const T across = c[i] * (x[i] - w[i]);
            y[i] += across;
            t[i] -= across;
          }
        }
      }
    }
  }
}
template void ColumnOperator::apply(const std::vector<float>&, std::vector<float>&) const;
template void ColumnOperator::apply(const std::vector<double>&, std::vector<double>&) const;

void ColumnOperator::relax(std::vector<float>& rhs, std::vector<float>& x, bool add) const {
  for (int iy = 0; iy < ny_; ++iy) {
    const auto subtract = [&](int a, int b, std::size_t factor) {
      float* y = &rhs[index(0, iy, a)];
      const float *l = &lower_[factor], *z = &rhs[index(0, iy, b)];
      for (int i = 0; i < nx_; ++i) y[i] -= l[i] * z[i];
    };
    const auto divide = [&](int a) {
      float* y = &rhs[index(0, iy, a)];
      const float* d = &lower_[block(iy, a, a)];
      for (int i = 0; i < nx_; ++i) y[i] *= d[i];
    };
    for (int a = 0; a < n_; ++a) {
      for (int b = 0; b < a; ++b) subtract(a, b, block(iy, a, b));
      divide(a);
    }
    for (int a = n_ - 1; a >= 0; --a) {
      for (int b = a + 1; b < n_; ++b) subtract(a, b, block(iy, b, a));
      divide(a);
    }
  }
  if (add) {
    for (std::size_t o = 0; o < x.size(); ++o) x[o] += kDamping * rhs[o];
  } else {
    for (std::size_t o = 0; o < x.size(); ++o) x[o] = kDamping * rhs[o];
  }
}

// The sums of the conductances; those inside one of the new columns become its own.
ColumnOperator ColumnOperator::coarser() const {
  ColumnOperator c((nx_ + 1) / 2, (ny_ + 1) / 2, n_);
  for (int iy = 0; iy < ny_; ++iy) {
    const bool crosses_y = (iy % 2 == 1 || iy + 1 == ny_) && c.ny_ > 1;
    for (int a = 0; a < n_; ++a) {
      for (int i = 0; i < nx_; ++i) c.body_[c.index(i / 2, iy / 2, a)] += body_[index(i, iy, a)];
      for (int b = 0; b < n_; ++b) {
        const std::size_t o = block(iy, a, b);
        const std::size_t to = c.block(iy / 2, a, b), mirrored = c.block(iy / 2, b, a);
        for (int i = 0; i < nx_; ++i) {
          const int I = i / 2;
          const bool crosses_x = (i % 2 == 1 || i + 1 == nx_) && c.nx_ > 1;
          c.own_[to + I] += own_[o + i];
          (crosses_x ? c.east_ : c.own_)[to + I] += east_[o + i];
          if (!crosses_x) c.own_[mirrored + I] += east_[o + i];
          (crosses_y ? c.north_ : c.own_)[to + I] += north_[o + i];
          if (!crosses_y) c.own_[mirrored + I] += north_[o + i];
        }
      }
      // Between equal unknowns of one new column nothing flows.
      for (int i = 0; i < c.nx_; ++i) c.own_[c.block(iy / 2, a, a) + i] = 0;
    }
  }
  c.factor();
  return c;
}

ColumnMultigrid::ColumnMultigrid(ColumnOperator fine) {
  fine.factor();
  add_level(std::move(fine));
  while (levels_.back().a.nx() > kCoarsest || levels_.back().a.ny() > kCoarsest)
    add_level(levels_.back().a.coarser());
}

void ColumnMultigrid::add_level(ColumnOperator a) {
  const std::vector<float> zero(a.size(), 0);
  levels_.push_back({std::move(a), zero, zero, zero});
}

void ColumnMultigrid::residual(Level& l) {
  l.a.apply(l.x, l.r);
  for (std::size_t o = 0; o < l.r.size(); ++o) l.r[o] = l.b[o] - l.r[o];
}

void ColumnMultigrid::cycle(std::size_t level) {
  Level& fine = levels_[level];
  fine.r = fine.b;
  fine.a.relax(fine.r, fine.x, false);
  if (level + 1 == levels_.size()) {
    for (int sweep = 0; sweep < kCoarsestSweeps; ++sweep) {
      residual(fine);
      fine.a.relax(fine.r, fine.x, true);
    }
    return;
  }
  Level& coarse = levels_[level + 1];
  residual(fine);
  std::fill(coarse.b.begin(), coarse.b.end(), 0.0F);
  const ColumnOperator &f = fine.a, &c = coarse.a;
  const auto each_row = [&](auto&& visit) {
    for (int iy = 0; iy < f.ny(); ++iy) {
      for (int a = 0; a < f.n(); ++a) visit(f.index(0, iy, a), c.index(0, iy / 2, a));
    }
  };
  each_row([&](std::size_t from, std::size_t to) {
    for (int i = 0; i < f.nx(); ++i) coarse.b[to + i / 2] += fine.r[from + i];
  });
  cycle(level + 1);
  each_row([&](std::size_t to, std::size_t from) {
    for (int i = 0; i < f.nx(); ++i) fine.x[to + i] += coarse.x[from + i / 2];
  });
  residual(fine);
  fine.a.relax(fine.r, fine.x, true);
}

}  // namespace papilla::electrostatics
