// Frictionless contact of a layered elastic half-space with a rough surface on a periodic grid.
//
// Unknown: contact pressure p >= 0 (and <= hardness). It minimises 1/2 pSp + p.g0 at a given mean,
// so that the gap v = S p + g0 - shift is zero under pressure and positive elsewhere (Eq.
// contact.2). Attractive tractions shift the initial gap and the mean load (Eq. contact.3): every
// state is one standard problem. The result carries a Frank-Wolfe certificate (Eq. contact.4)
// computed on the returned pressure, a bound on the distance to the minimum energy.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "geometry/grid.h"
#include "numerics/convolution.h"
#include "numerics/fft.h"
#include "numerics/window.h"

namespace papilla::contact {

// A layer bonded on a half-space. Young's moduli [Pa], Poisson ratios in [0, 0.5], thickness [m]
// from 0 (half-space of the bulk alone) to infinity (of the layer alone). A compliant counter-body
// (soft particles) adds its own compliance, Eq. contact.9: that of a layer as thick as it, bonded
// on what does not give; a half-space where the contact spot is small against it.
struct LayeredSolid {
  double layer_modulus = 1, layer_poisson = 0.5, layer_thickness = 0;
  double bulk_modulus = 1, bulk_poisson = 0.5;
  double counter_modulus = 0, counter_poisson = 0.4;  // modulus 0: rigid
  double counter_thickness = kInfinity;               // [m]

  bool operator==(const LayeredSolid&) const = default;
};

// Normal surface compliance C(q) [m/Pa] at wave number q > 0 [1/m]: u_hat = C p_hat. Eqs.
// contact.1, contact.9
double compliance(const LayeredSolid& solid, double q);

// The compliance on one grid; immutable, shared by all solves.
class ContactKernel {
 public:
  ContactKernel(const Grid& grid, const LayeredSolid& solid);

  const Grid& grid() const { return grid_; }
  const LayeredSolid& solid() const { return solid_; }
  const Fft2d& fft() const { return *fft_; }
  const std::vector<double>& symbol() const { return symbol_; }  // C(q)/n on the half spectrum
  // Truncated inverse kernel, the preconditioner between contact pixels at most kReach apart.
  static constexpr int kReach = 4;
  const Window<kReach>& stencil() const { return stencil_; }
  // Displacement at (dx, dy) pixels, 0 <= dx < nx, from a pixel under unit pressure [m/Pa].
  double influence(int dx, int dy) const { return influence_[grid_.index(dx, dy)]; }
  double self_compliance() const { return influence_[0]; }
  // The strongest influence on any pixel more than near(nx), near(ny) pixels away.
  double influence_beyond() const { return influence_beyond_; }
  static int near(int count) { return count > 16 ? 8 : (count - 1) / 2; }
  const ContactKernel* coarse() const { return coarse_.get(); }  // half the pixels, or null
  double contact_modulus() const;                                // E* of the two surfaces [Pa]

  // u = S p: one forward and one inverse transform. scratch: of scratch_size().
  void displace(const RealArray& p, RealArray& u, SpectrumArray& scratch) const;
  // In place, the pressure of zero mean that displaces the whole plane by u (its mean apart).
  void press(RealArray& u, SpectrumArray& scratch) const;
  std::size_t scratch_size() const;

 private:
  Grid grid_;
  LayeredSolid solid_;
  std::shared_ptr<const Fft2d> fft_;
  std::shared_ptr<const Convolution> convolution_;  // null where the grid does not suit it
  std::vector<double> symbol_, inverse_symbol_;     // the latter 1/(C(q) n)
  RealArray arranged_, inverse_arranged_;           // for the convolution
  Window<kReach> stencil_;
  RealArray influence_;
  double influence_beyond_ = 0;
  std::shared_ptr<const ContactKernel> coarse_;
};

// The kernel of a grid and a solid, made or found among those used lately: the process keeps up to
// 64 kernels and, the newest apart, 2^24 pixels of them (about 0.6 GB). Thread safe; a kernel never
// changes, so where it comes from shows in time alone. Cost: 4-6 transforms and a compliance for
// each wave number, or a look-up.
std::shared_ptr<const ContactKernel> make_contact_kernel(const Grid& grid,
                                                         const LayeredSolid& solid);

// Sparse: a candidate set of pixels, for light contact; falls back to Dense where too many touch.
// Auto expects the contact and chooses.
enum class ContactMethod { Auto, Sparse, Dense };

struct ContactOptions {
  double tolerance = 1e-5;  // on the certificate
  double hardness = 0;      // cap on the pressure [Pa]; 0: none
  int max_iterations = 1000;
  ContactMethod method = ContactMethod::Auto;
};

enum class ContactStatus { NotRun, Converged, Stagnated, IterationLimit, NoLoad, Invalid };

struct ContactSolution {
  ContactStatus status = ContactStatus::NotRun;
  std::string reason;
  std::vector<double> pressure;  // [Pa]
  std::vector<double> gap;       // [m] >= 0, zero under pressure
  double shift = 0;              // rigid approach [m]
  double certificate = 0;        // normalised bound on the energy error, Eq. contact.4
  int iterations = 0;
  double fft_pairs = 0;       // forward + inverse transforms, in units of the finest grid
  double elastic_energy = 0;  // [J] of the solid under pressure and tractions
  ContactMethod method = ContactMethod::Auto;  // that solved it

  bool converged() const {
    return status == ContactStatus::Converged || status == ContactStatus::NoLoad;
  }
};

// height: rigid counter-body plus skin topography [m], grid.size() values, high touches first.
// mean_pressure: external load over the patch area [Pa]. traction: attractive pressure per pixel
// [Pa], or empty. start: a nearby solution. Cost: 1-3 transform pairs (sparse), 5-25 (dense).
// Status NoLoad: nothing presses (the patch hangs free or lifts off); Invalid: NaN input, or a mean
// load beyond the hardness.
ContactSolution solve_contact(const ContactKernel& kernel, std::span<const double> height,
                              double mean_pressure, std::span<const double> traction,
                              const ContactOptions& options,
                              const ContactSolution* start = nullptr);

// The same with the rigid approach given [m], from 0 at first touch to full contact at mean(height)
// below the highest point (the mean displacement of a half-space belongs to the approach, so more
// does not exist: Invalid). The load is the result: mean of the pressure.
ContactSolution solve_approach(const ContactKernel& kernel, std::span<const double> height,
                               double approach, const ContactOptions& options,
                               const ContactSolution* start = nullptr);

// Contact area as fractions of the patch, by three estimators (Eq. contact.5-7).
struct ContactArea {
  double raw = 0;        // pixels under pressure
  double perimeter = 0;  // raw minus 0.106 of the perimeter: a check of the next
  double near_edge = 0;  // sub-pixel edge from the square-root law of the pressure: the area
  double se = 0;         // standard error of near_edge by the grid, Eq. contact.8
};

// hardness: of the solution; at it the edge of a contact follows no square-root law.
ContactArea measure_area(const ContactKernel& kernel, const ContactSolution& solution,
                         double hardness = 0);

}  // namespace papilla::contact
