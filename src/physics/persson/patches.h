// Patches of a rough solid do not share one pressure: Persson's distribution at the patch's wave
// number, as a few representative pressures for a solver of single patches. Equations:
// docs/theory/persson.md.
#pragma once

#include <vector>

#include "base/rooms.h"

namespace papilla::persson {

struct NominalPressure {
  double pressure = 0, share = 1;  // [Pa] > 0; of the area
};

// Gauss rule of P(s, q_patch), Eq. persson.5, over s > 0: sum of share times value(pressure) is the
// mean over the whole nominal area of what patches in contact give. Exact for values polynomial in
// s up to degree 2 n - 1. Eq. persson.15
class PatchPressures {
 public:
  // stress_measure: M at the patch's wave number [Pa^2], > 0; pressure: nominal [Pa], > 0; 1 to 64
  // nodes. Cost microseconds.
  PatchPressures(double stress_measure, double pressure, int nodes);
  // The same of an area whose parts have nominal pressures of their own: P is their mean.
  PatchPressures(double stress_measure, std::vector<NominalPressure> parts, int nodes);

  const std::vector<double>& pressure() const { return pressure_; }  // [Pa], ascending
  const std::vector<double>& share() const { return share_; }  // of the area; sum = share touching
  // Shares of the same pressures when the nominal pressure changes to p > 0: weighted by the ratio
  // of the densities, scaled to carry p exactly.
  std::vector<double> share_at(double p) const;
  // The same when the parts, whose shares of the area stay, press by p[i] > 0 [Pa].
  std::vector<double> share_at(const std::vector<double>& p) const;

 private:
  double measure_;
  std::vector<NominalPressure> parts_;
  std::vector<double> pressure_, share_;
};

}  // namespace papilla::persson
