// The media between electrode and skin as nodes and conductances, inside this folder.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "physics/electrostatics/full_field.h"
#include "physics/electrostatics/multigrid.h"

namespace papilla {

// The media over one pixel.
struct FieldColumn {
  double electrode = 0, surface = 0, low = 0, high = 0, skin = 0;  // heights [m], ascending
  double permittivity = 1, layer = 0;
  bool bridged = false;

  static double overlap(double z, double a, double b) { return std::clamp(z, a, b) - a; }
  // Integral of 1/eps from the electrode to z [m].
  double resistance(double z) const {
    return overlap(z, electrode, surface) / permittivity +
           (overlap(z, surface, low) + overlap(z, high, skin)) / kWaterPermittivity +
           overlap(z, low, high);
  }
  // Integral of eps from the electrode to z [m].
  double permeance(double z) const {
    return overlap(z, electrode, surface) * permittivity +
           (overlap(z, surface, low) + overlap(z, high, skin)) * kWaterPermittivity +
           overlap(z, low, high);
  }
  double total() const { return resistance(skin) + layer; }
};

// Nodes at common heights, dense where most of the flux passes, and finite volumes between them.
// Eq. electrostatics.13
class PotentialGrid {
 public:
  // levels: heights with nodes. The columns must be finite, and not all without thickness.
  PotentialGrid(const PotentialProblem& problem, std::vector<FieldColumn> columns, int levels);

  const std::vector<FieldColumn>& columns() const { return columns_; }
  double z(int k) const { return z_[k]; }  // height of a node [m]
  // Nodes of a column outside the bodies: from first to last; none where first > last.
  int first(std::size_t column) const { return first_[column]; }
  int last(std::size_t column) const { return last_[column]; }
  double cell_low(int k) const;  // bounds of a node's cell [m]
  double cell_high(int k) const;
  const std::vector<float>& electrode() const { return electrode_; }  // conductances to it

  std::size_t node(int ix, int iy, int k) const { return fine_.row(iy, k) + ix; }
  FieldLevel take_conductances() { return std::move(fine_); }  // once: they are large

 private:
  void assemble();
  void fill_column(int ix, int iy);
  void join(int ax, int ay, int bx, int by, std::vector<float>& link, double step, double width);
  void reach(std::size_t a, int ax, int ay, std::size_t b, double step, double width);

  Grid grid_;
  int levels_;
  std::vector<FieldColumn> columns_;
  std::vector<double> z_;
  std::vector<int> first_, last_;
  std::vector<float> permittivity_;  // cell averages
  std::vector<float> electrode_;
  FieldLevel fine_;
};

// The media over every pixel.
std::vector<FieldColumn> columns_of(const PotentialProblem& problem);

}  // namespace papilla
