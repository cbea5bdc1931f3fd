#include "physics/electrostatics/multigrid.h"

#include <algorithm>
#include <utility>

namespace papilla {
namespace {

constexpr float kDamping = 0.8F;    // of the line relaxation
constexpr int kCoarsestSweeps = 6;  // on the coarsest level, of at most 4 x 4 columns
constexpr int kCoarsest = 4;

// Two by two columns become one. Faces are twice as wide, nodes twice as far.
FieldLevel coarsen(const FieldLevel& f) {
  FieldLevel c;
  c.nx = (f.nx + 1) / 2;
  c.ny = (f.ny + 1) / 2;
  c.nz = f.nz;
  c.allocate();
  for (int iy = 0; iy < f.ny; ++iy) {
    const bool north = iy % 2 == 1 || iy + 1 == f.ny;
    for (int k = 0; k < f.nz; ++k) {
      const std::size_t from = f.row(iy, k), to = c.row(iy / 2, k);
      for (int i = 0; i < f.nx; ++i) {
        c.cz[to + i / 2] += f.cz[from + i];
        c.body[to + i / 2] += f.body[from + i];
        if (north && c.ny > 1) c.cy[to + i / 2] += 0.5F * f.cy[from + i];
        if ((i % 2 == 1 || i + 1 == f.nx) && c.nx > 1) {
          c.cx[to + i / 2] += 0.5F * f.cx[from + i];
        }
      }
    }
  }
  c.factor();
  return c;
}

// The fine residual as the coarse right-hand side.
void restrict_residual(const FieldLevel& f, FieldLevel& c) {
  std::fill(c.b.begin(), c.b.end(), 0.0F);
  for (int iy = 0; iy < f.ny; ++iy) {
    for (int k = 0; k < f.nz; ++k) {
      const float* from = f.r.data() + f.row(iy, k);
      float* to = c.b.data() + c.row(iy / 2, k);
      for (int i = 0; i + 1 < f.nx; i += 2) to[i / 2] += from[i] + from[i + 1];
      if (f.nx % 2) to[f.nx / 2] += from[f.nx - 1];
    }
  }
}

// The coarse correction to the four columns of each.
void add_correction(const FieldLevel& c, FieldLevel& f) {
  for (int iy = 0; iy < f.ny; ++iy) {
    for (int k = 0; k < f.nz; ++k) {
      float* to = f.x.data() + f.row(iy, k);
      const float* from = c.x.data() + c.row(iy / 2, k);
      for (int i = 0; i + 1 < f.nx; i += 2) {
        to[i] += from[i / 2];
        to[i + 1] += from[i / 2];
      }
      if (f.nx % 2) to[f.nx - 1] += from[f.nx / 2];
    }
  }
}

}  // namespace

void FieldLevel::allocate() {
  for (auto* v : {&cx, &cy, &cz, &body}) v->assign(size(), 0);
}

void FieldLevel::factor() {
  diagonal.resize(size());
  inverse.resize(size());
  for (auto* v : {&b, &x, &r}) v->assign(size(), 0);
  for (int iy = 0; iy < ny; ++iy) {
    const int before = iy > 0 ? iy - 1 : ny - 1;
    for (int k = 0; k < nz; ++k) {
      const std::size_t here = row(iy, k), south = row(before, k);
      const std::size_t below = k > 0 ? row(iy, k - 1) : here;
      for (int i = 0; i < nx; ++i) {
        float d = body[here + i] + cx[here + i] + cx[here + (i > 0 ? i - 1 : nx - 1)] +
                  cy[here + i] + cy[south + i] + cz[here + i];
        if (k > 0) d += cz[below + i];
        if (d <= 0) d = 1;  // inside a body
        diagonal[here + i] = d;
        float pivot = d;
        if (k > 0) pivot -= cz[below + i] * cz[below + i] * inverse[below + i];
        inverse[here + i] = 1 / pivot;
      }
    }
  }
}

void FieldLevel::relax(std::vector<float>& rhs, bool add) {
  for (int iy = 0; iy < ny; ++iy) {
    for (int k = 1; k < nz; ++k) {
      float* here = rhs.data() + row(iy, k);
      const float* below = rhs.data() + row(iy, k - 1);
      const float* c = cz.data() + row(iy, k - 1);
      const float* w = inverse.data() + row(iy, k - 1);
      for (int i = 0; i < nx; ++i) here[i] += c[i] * w[i] * below[i];
    }
    for (int k = nz - 1; k >= 0; --k) {
      float* here = rhs.data() + row(iy, k);
      const float* w = inverse.data() + row(iy, k);
      float* out = x.data() + row(iy, k);
      if (k == nz - 1) {
        for (int i = 0; i < nx; ++i) here[i] *= w[i];
      } else {
        const float* above = here + nx;
        const float* c = cz.data() + row(iy, k);
        for (int i = 0; i < nx; ++i) here[i] = (here[i] + c[i] * above[i]) * w[i];
      }
      if (add) {
        for (int i = 0; i < nx; ++i) out[i] += kDamping * here[i];
      } else {
        for (int i = 0; i < nx; ++i) out[i] = kDamping * here[i];
      }
    }
  }
}

void FieldLevel::residual() {
  for (int iy = 0; iy < ny; ++iy) {
    const int south = iy > 0 ? iy - 1 : ny - 1, north = iy + 1 < ny ? iy + 1 : 0;
    for (int k = 0; k < nz; ++k) {
      const std::size_t o = row(iy, k), s = row(south, k), n = row(north, k);
      const float *xo = x.data() + o, *xs = x.data() + s, *xn = x.data() + n;
      const float *ex = cx.data() + o, *en = cy.data() + o, *es = cy.data() + s;
      const float *dg = diagonal.data() + o, *bo = b.data() + o;
      float* ro = r.data() + o;
      for (int i = 0; i < nx; ++i) {
        ro[i] = bo[i] - dg[i] * xo[i] + en[i] * xn[i] + es[i] * xs[i];
      }
      for (int i = 0; i + 1 < nx; ++i) ro[i] += ex[i] * xo[i + 1];
      for (int i = 1; i < nx; ++i) ro[i] += ex[i - 1] * xo[i - 1];
      ro[nx - 1] += ex[nx - 1] * xo[0];
      ro[0] += ex[nx - 1] * xo[nx - 1];
      if (k > 0) {
        const float *c = cz.data() + o - nx, *xb = xo - nx;
        for (int i = 0; i < nx; ++i) ro[i] += c[i] * xb[i];
      }
      if (k + 1 < nz) {
        const float *c = cz.data() + o, *xa = xo + nx;
        for (int i = 0; i < nx; ++i) ro[i] += c[i] * xa[i];
      }
    }
  }
}

void FieldLevel::apply(const std::vector<double>& v, std::vector<double>& out) const {
  for (int iy = 0; iy < ny; ++iy) {
    const int south = iy > 0 ? iy - 1 : ny - 1, north = iy + 1 < ny ? iy + 1 : 0;
    for (int k = 0; k < nz; ++k) {
      const std::size_t o = row(iy, k), s = row(south, k), n = row(north, k);
      const double *vo = v.data() + o, *vs = v.data() + s, *vn = v.data() + n;
      const float *ex = cx.data() + o, *en = cy.data() + o, *es = cy.data() + s;
      const float* d = body.data() + o;
      double* q = out.data() + o;
      for (int i = 0; i < nx; ++i) {
        q[i] = d[i] * vo[i] + en[i] * (vo[i] - vn[i]) + es[i] * (vo[i] - vs[i]);
      }
      for (int i = 0; i + 1 < nx; ++i) q[i] += ex[i] * (vo[i] - vo[i + 1]);
      for (int i = 1; i < nx; ++i) q[i] += ex[i - 1] * (vo[i] - vo[i - 1]);
      q[nx - 1] += ex[nx - 1] * (vo[nx - 1] - vo[0]);
      q[0] += ex[nx - 1] * (vo[0] - vo[nx - 1]);
      if (k > 0) {
        const float* c = cz.data() + o - nx;
        for (int i = 0; i < nx; ++i) q[i] += c[i] * (vo[i] - vo[i - nx]);
      }
      if (k + 1 < nz) {
        const float* c = cz.data() + o;
        for (int i = 0; i < nx; ++i) q[i] += c[i] * (vo[i] - vo[i + nx]);
      }
    }
  }
}

Multigrid::Multigrid(FieldLevel fine) {
  fine.factor();
  levels_.push_back(std::move(fine));
  while (levels_.back().nx > kCoarsest || levels_.back().ny > kCoarsest) {
    levels_.push_back(coarsen(levels_.back()));
  }
}

void Multigrid::cycle(std::size_t l) {
  FieldLevel& f = levels_[l];
  f.r = f.b;
  f.relax(f.r, false);
  if (l + 1 == levels_.size()) {
    for (int sweep = 0; sweep < kCoarsestSweeps; ++sweep) {
      f.residual();
      f.relax(f.r, true);
    }
    return;
  }
  FieldLevel& c = levels_[l + 1];
  f.residual();
  restrict_residual(f, c);
  cycle(l + 1);
  add_correction(c, f);
  f.residual();
  f.relax(f.r, true);
}

}  // namespace papilla
