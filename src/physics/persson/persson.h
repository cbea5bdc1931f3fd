// Persson's mean-field theory of rough contact with electroadhesion: a randomly rough elastic layer
// bonded on a softer half-space, pressed on a rigid flat. Statistical: contact area, gap
// distribution and electrostatic pull follow from the roughness spectrum alone, in milliseconds.
// It must never be used for a designed texture (hole arrays: area wrong by 2-1000 times), only for
// random roughness. Equations persson.N: docs/theory/persson.md.
#pragma once

#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/constants.h"
#include "base/rooms.h"

namespace papilla::persson {

// Isotropic two-dimensional roughness spectrum C(q) [m^4], <h^2> = 2 pi int q C dq: straight in
// log-log between knots, nothing outside. Knots ascend; at least two.
struct PowerSpectrum {
  std::vector<double> wave_number;  // [1/m]
  std::vector<double> density;      // [m^4], > 0

  double at(double q) const;
  // 2 pi int q^(order+1) C dq between two wave numbers, exact per piece: order 0 = mean square
  // height [m^2], 2 = mean square slope.
  double moment(int order, double low, double high) const;
  double rms() const;    // [m]
  double slope() const;  // rms slope [-]
  double lowest() const { return wave_number.front(); }
  double highest() const { return wave_number.back(); }

  PowerSpectrum scaled(double factor) const;  // C times factor
  PowerSpectrum between(double low, double high) const;

  bool operator==(const PowerSpectrum&) const = default;
};

// Flat from q_low to the roll-off, then ~ q^-2(1+H) to the cut-off, with the given rms. Wave
// numbers ascend. Eq. persson.1
PowerSpectrum self_affine_spectrum(double rms, double q_low, double q_roll_off, double q_cutoff,
                                   double hurst);
// Dry skin of the wrist: rms 22 um, slope 0.91, H = 0.86, 800 1/m .. 6e3 1/m .. 1e8 1/m. A fit to
// four printed numbers (the curve itself is not published). Far too rough for fingertip ridges.
PowerSpectrum wrist_spectrum();

// Young's moduli [Pa]; thickness 0: the bulk alone, infinite: the layer alone.
struct MeanFieldSolid {
  double layer_modulus = 40e6, layer_poisson = 0.5, layer_thickness = 200e-6;
  double bulk_modulus = 10e3, bulk_poisson = 0.5;

  bool operator==(const MeanFieldSolid&) const = default;
};
// E*(q) [Pa] of the layered half-space: u_z(q) = 2 p(q) / (E* q). Closed form for any Poisson
// ratio, checked to 6e-8 against the full elasticity problem. Eq. persson.2
double effective_modulus(const MeanFieldSolid& solid, double q);

struct MeanFieldOptions {
  // Contact area at small load = kappa p / (slope E*): 2 agrees with simulation within 10 %; the
  // pure theory has sqrt(8/pi) = 1.596 (kPurePersson).
  double kappa = 2;
  double energy_factor = 0.45;  // gamma: elastic energy of partial contact; 1 = full contact's
  int intervals = 450;          // in ln q: pull to 1e-4, area to 1e-8
  // Share of the area at smaller gaps [m] is spread over the rest in every electrostatic mean; 0
  // keeps every gap (a gap below an atom counts like contact). The pull is 2 % lower with 0.01 nm.
  double smallest_gap = 0;
};
inline constexpr double kPurePersson = 1.5957691216057308;  // sqrt(8/pi)

// All gaps of the interface at one pressure: bands of magnification, each with the share of area
// that lost contact there, its mean gap and its spread. Eq. persson.8
struct GapDistribution {
  double pressure = 0;      // [Pa]
  double contact = 0;       // A/A0: share of the area at gap 0
  double mean_gap = 0;      // over the whole area [m]
  double smallest_gap = 0;  // MeanFieldOptions
  // One per band, magnification ascending: shares sum to 1 - contact; gaps are |N(offset, width)|.
  std::vector<double> share, offset, width, wave_number /*upper end of the band, 1/m*/;

  double density(double u) const;     // P(u) [1/m] at u > 0, without the contact
  double cumulative(double u) const;  // share of the area with gap <= u, contact included
  // Mean over the area of 1/|u + h0|^2 [1/m^2] (Eq. persson.9), contact included, or only the part
  // that lost contact below wave number q (no contact): the far field of patches.
  double inverse_square(std::complex<double> h0) const;
  double far_inverse_square(std::complex<double> h0, double q) const;
  // Mean of 1/(u + h0) [1/m], contact included: capacitance per area over eps0, under layers that
  // conduct admittance per area over -i w eps0.
  double inverse(double h0) const;
  std::complex<double> inverse(std::complex<double> h0) const;
  // The gaps that far_inverse_square takes, as gaps [m] with their shares of the area: of each band
  // the nodes of its rule, for what varies over `scale` [m] > 0 near gap 0. Every gap is kept.
  void visit_far(double scale, double q,
                 const std::function<void(double gap, double share)>& visit) const;
  std::size_t far_bands(double q) const;  // how many bands those are
};

class MeanField {
 public:
  // Cost 1 ms. The spectrum must have at least two knots; kappa > 0.
  MeanField(PowerSpectrum spectrum, MeanFieldSolid solid, MeanFieldOptions options = {});

  const PowerSpectrum& spectrum() const { return spectrum_; }
  const MeanFieldSolid& solid() const { return solid_; }
  const MeanFieldOptions& options() const { return options_; }

  // M(q) [Pa^2]: twice the variance of the full-contact stress from roughness up to q, divided by
  // (kappa / 1.596)^2. Eq. persson.3
  double stress_measure(double q) const;
  double stress_measure() const { return measure_.back(); }
  // A/A0 at a nominal pressure [Pa], at full magnification or with the roughness up to q. Eq.
  // persson.4
  double area(double pressure) const;
  double area(double pressure, double q) const;
  // P(s, q) [1/Pa] of the pressure s > 0 at magnification q (its integral is area(p, q)).
  // Eq. persson.5
  double pressure_density(double s, double pressure, double q) const;
  // Elastic energy per area [J/m^2]. Eq. persson.6
  double elastic_energy(double pressure) const;
  // Mean gap [m] and gap distribution at a pressure > 0. Cost 0.2 and 1 ms. Eq. persson.7,
  // persson.8
  double mean_gap(double pressure) const;
  // up_to: the last wave number whose bands are wanted [1/m]; half of them cost three quarters.
  GapDistribution gaps(double pressure, double up_to = kInfinity) const;

 private:
  double gap_from(std::size_t node,
                  double pressure_here) const;  // mean gap seen at a magnification

  PowerSpectrum spectrum_;
  MeanFieldSolid solid_;
  MeanFieldOptions options_;
  std::vector<double> q_;                                 // nodes
  std::vector<double> measure_;                           // M at nodes
  std::vector<double> variance_;                          // roughness above each node [m^2]
  std::vector<double> measure_mid_;                       // M at two Gauss points per interval
  std::vector<double> weight_;                            // sqrt(pi) q^2 C E* dq there
  std::shared_ptr<const std::vector<double>> gap_table_;  // F of Eq. persson.7
};

// The spectrum after plastic flattening at hardness yield [Pa] under a pressure > 0 below it: its
// elastic contact area equals elastic plus yielded area. Fewer than two knots where next to nothing
// stays elastic at any scale. Eq. persson.10
PowerSpectrum plastic_smoothing(const PowerSpectrum& spectrum, const MeanFieldSolid& solid,
                                double yield, double pressure, double kappa = 2);
// Shares of the nominal area in elastic and in yielded contact when the stress measure is M.
struct ContactShares {
  double elastic = 0, plastic = 0;
};
ContactShares plastic_shares(double pressure, double stress_measure, double yield);

enum class PullStatus { Solved, Collapsed };  // Collapsed: no equilibrium below 1 GPa

// Interface under voltage: pressure = external + pull(pressure). Eq. persson.9. Collapsed, the
// numbers are of the last pressure that was tried, where more pulls than is carried: no state.
struct PullState {
  PullStatus status = PullStatus::Solved;
  double pressure = 0, pull = 0;  // total and time mean of the electrostatic part [Pa]
  double area = 0;                // A/A0
  double mean_gap = 0;            // [m]
};

// v_rms of the voltage across the interface (sine: V0/sqrt(2), DC: V); h0 = sum of d/eps of all
// dielectrics in series, complex where they conduct [m]. Below finite_size_pressure the gaps (not
// the area) stay what they are there: a finite body touches at its highest asperity. The branch
// that starts at zero voltage is returned. Cost about 8 gap distributions.
PullState solve_pull(const MeanField& field, double external_pressure, double v_rms,
                     std::complex<double> h0, double finite_size_pressure = 0);

// F = tau A_real [N] of a nominal area under a normal force [N]. Eq. persson.11
struct FrictionPoint {
  double normal_force, friction, coefficient;  // coefficient NaN-free: 0 at zero load
  PullState pull;
};
FrictionPoint friction_at(const MeanField& field, double normal_force, double nominal_area,
                          double shear_strength, double v_rms, std::complex<double> h0,
                          double finite_size_pressure = 0);

// Stratum corneum at a frequency: permittivity and resistivity straight in log-log between anchors.
struct SkinDielectric {
  std::vector<double> frequency = {1, 30, 1000};  // of the permittivity [Hz]
  std::vector<double> permittivity = {1e4, 5e3, 1e3};
  std::vector<double> resistivity_frequency = {30, 1000};  // [Hz]
  std::vector<double> resistivity = {6e4, 2e4};            // [ohm m]

  double permittivity_at(double f) const;
  double resistivity_at(double f) const;
  // eps + i / (w eps0 rho), fields ~ e^-iwt. Eq. persson.12
  std::complex<double> complex_permittivity(double f) const;
};
// Of a gap of air that conducts: 1 + i/(w eps0 rho), by which the d/eps of layers in series with it
// is multiplied. resistivity [ohm m]; 0: it insulates. Eq. persson.12
std::complex<double> gap_permittivity(double f, double resistivity);
// Complex h0 [m] = d1/eps1 + d2/eps2(w), times the permittivity of the gap.
std::complex<double> series_thickness(double dielectric_equivalent, double skin_thickness,
                                      const SkinDielectric& skin, double f,
                                      double gap_resistivity = 0 /*0: insulating*/);

// A voltage step on dielectric d1/eps1, gap u and a leaky layer (thickness, permittivity,
// resistivity). Eq. persson.13
struct StepResponse {
  double dielectric_equivalent;  // d1/eps1 [m]
  double layer_thickness, layer_permittivity, layer_resistivity;

  double relaxation_time(double u) const;
  double field(double voltage, double u, double t) const;  // in the gap [V/m], t >= 0
  double pull(const GapDistribution& gaps, double voltage, double t) const;  // eps0/2 <E^2> [Pa]
};

// Distribution of the electrostatic stress over the area that does not touch. Eq. persson.14
struct StressPoint {
  double gap, stress, density /*1/Pa*/, per_decade /*stress x contribution: ln10 s^2 P*/;
};
std::vector<StressPoint> stress_distribution(const GapDistribution& gaps, double v_rms,
                                             std::complex<double> h0,
                                             std::span<const double> at_gaps);

}  // namespace papilla::persson
