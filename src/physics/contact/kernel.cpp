#include <algorithm>
#include <cmath>

#include "base/cache.h"
#include "base/check.h"
#include "base/constants.h"
#include "physics/contact/contact.h"

namespace papilla::contact {

namespace {

// A layer on a half-space. Eq. contact.1
double layered_compliance(const LayeredSolid& s, double q) {
  const double bulk = 2 * (1 - square(s.bulk_poisson)) / (s.bulk_modulus * q);
  const double layer = 2 * (1 - square(s.layer_poisson)) / (s.layer_modulus * q);
  const double x = q * s.layer_thickness;
  if (x <= 0) return bulk;
  if (x > 40) return layer;
  // Eq. contact.1 (Burmister 1945; O'Sullivan and King 1988)
  const double g1 = s.layer_modulus / (2 * (1 + s.layer_poisson));
  const double mu = g1 / (s.bulk_modulus / (2 * (1 + s.bulk_poisson)));
  const double n1 = s.layer_poisson, n2 = s.bulk_poisson;
  const double lam = 1 - 4 * (1 - n1) / (1 + mu * (3 - 4 * n2));
  const double kap = (mu - 1) / (mu + 3 - 4 * n1);
  const double t = std::exp(-2 * x);
  // The denominator 1 - (lam + kap + 4 kap x^2) t + lam kap t^2, written so that thin stiff layers
  // do not cancel: with t = 1 + m, m = expm1(-2x),
  // (1-lam)(1-kap) - m (lam + kap - 2 lam kap) + lam kap m^2 - 4 kap x^2 t.
  const double m = std::expm1(-2 * x);
  const double denominator = (1 - lam) * (1 - kap) - m * (lam + kap - 2 * lam * kap) +
                             lam * kap * m * m - 4 * kap * x * x * t;
  const double numerator = 1 + 4 * x * kap * t - lam * kap * t * t;
  return (1 - n1) / (g1 * q) * numerator / denominator;
}

// Eq. contact.9
double counter_compliance(const LayeredSolid& s, double q) {
  if (s.counter_modulus <= 0 || s.counter_thickness <= 0) return 0;
  constexpr double kRigid = 1e9;  // what it stands on, over its own modulus
  return layered_compliance({s.counter_modulus, s.counter_poisson, s.counter_thickness,
                             kRigid * s.counter_modulus, s.counter_poisson},
                            q);
}

}  // namespace

double compliance(const LayeredSolid& s, double q) {
  PAPILLA_CHECK(q > 0, "wave number");
  return layered_compliance(s, q) + counter_compliance(s, q);
}

double ContactKernel::contact_modulus() const {
  double softness = solid_.layer_thickness > 0
                        ? (1 - square(solid_.layer_poisson)) / solid_.layer_modulus
                        : (1 - square(solid_.bulk_poisson)) / solid_.bulk_modulus;
  if (solid_.counter_modulus > 0 && solid_.counter_thickness > 0) {
    softness += (1 - square(solid_.counter_poisson)) / solid_.counter_modulus;
  }
  return 1 / softness;
}

ContactKernel::ContactKernel(const Grid& grid, const LayeredSolid& solid)
    : grid_(grid), solid_(solid), fft_(Fft2d::shared(grid.nx, grid.ny)) {
  const auto n = static_cast<double>(grid.size());
  symbol_.assign(fft_->spectrum_size(), 0);
  inverse_symbol_.assign(fft_->spectrum_size(), 0);
  for (int ky = 0; ky < grid.ny; ++ky) {
    const double qy = 2 * kPi * signed_mode(ky, grid.ny) / grid.ly;
    for (int kx = 0; kx < fft_->half(); ++kx) {
      if (kx == 0 && ky == 0) continue;  // the mean displacement belongs to the rigid shift
      const double qx = 2 * kPi * kx / grid.lx;
      const double c = compliance(solid, std::hypot(qx, qy));
      const std::size_t i = static_cast<std::size_t>(ky) * fft_->half() + kx;
      symbol_[i] = c / n;
      inverse_symbol_[i] = 1 / (c * n);
    }
  }
  if (Convolution::suits(grid.nx, grid.ny)) {
    convolution_ = Convolution::shared(grid.nx, grid.ny);
    arranged_ = convolution_->arrange(symbol_);
    inverse_arranged_ = convolution_->arrange(inverse_symbol_);
  }
  RealArray table(grid.size());
  SpectrumArray stiffness(inverse_symbol_.begin(), inverse_symbol_.end());
  fft_->inverse(stiffness.data(), table.data());
  const auto first = [](int count) {
    return -std::min(kReach, (count - 1) / 2);
  };  // each pixel once
  const auto last = [](int count) { return std::min(kReach, count / 2); };
  for (int dy = first(grid.ny); dy <= last(grid.ny); ++dy) {
    for (int dx = first(grid.nx); dx <= last(grid.nx); ++dx) {
      stencil_.weight(dx, dy) =
          static_cast<float>(table[grid.index(wrap(dx, grid.nx), wrap(dy, grid.ny))]);
    }
  }
  table.assign(grid.size(), 0.0);
  table[0] = 1;
  SpectrumArray scratch(scratch_size());
  influence_.resize(grid.size());
  displace(table, influence_, scratch);
  for (int dy = 0; dy < grid.ny; ++dy) {
    for (int dx = 0; dx < grid.nx; ++dx) {
      if (std::min(dx, grid.nx - dx) <= near(grid.nx) &&
          std::min(dy, grid.ny - dy) <= near(grid.ny))
        continue;
      influence_beyond_ = std::max(influence_beyond_, std::abs(influence(dx, dy)));
    }
  }
  if (grid.nx % 2 == 0 && grid.ny % 2 == 0 && std::min(grid.nx, grid.ny) >= 64) {
    coarse_ = make_contact_kernel({grid.nx / 2, grid.ny / 2, grid.lx, grid.ly}, solid);
  }
}

std::size_t ContactKernel::scratch_size() const {
  return convolution_ ? convolution_->scratch_size() : fft_->spectrum_size();
}

void ContactKernel::displace(const RealArray& p, RealArray& u, SpectrumArray& scratch) const {
  if (convolution_) {
    convolution_->apply(p.data(), arranged_, scratch.data(), u.data());
    return;
  }
  fft_->forward(p.data(), scratch.data());
  for (std::size_t i = 0; i < symbol_.size(); ++i) scratch[i] *= symbol_[i];
  fft_->inverse(scratch.data(), u.data());
}

void ContactKernel::press(RealArray& u, SpectrumArray& scratch) const {
  if (convolution_) {
    convolution_->apply(u.data(), inverse_arranged_, scratch.data(), u.data());
    return;
  }
  fft_->forward(u.data(), scratch.data());
  for (std::size_t i = 0; i < symbol_.size(); ++i) scratch[i] *= inverse_symbol_[i];
  fft_->inverse(scratch.data(), u.data());
}

namespace {

struct KernelKey {
  Grid grid;
  LayeredSolid solid;

  bool operator==(const KernelKey&) const = default;
};

// What make_contact_kernel states: a search solves thousands of states on a few grids.
constexpr std::size_t kMostKernels = 64;
constexpr double kMostPixels = 1 << 24;

}  // namespace

std::shared_ptr<const ContactKernel> make_contact_kernel(const Grid& grid, const LayeredSolid& s) {
  static Cache<KernelKey, ContactKernel> kernels(kMostKernels, kMostPixels);
  return kernels.get({grid, s}, static_cast<double>(grid.size()),
                     [&] { return std::make_shared<const ContactKernel>(grid, s); });
}

}  // namespace papilla::contact
