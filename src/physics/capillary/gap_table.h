// Integrals of a gap over discs, fast: prefix sums along x make one chord cost the same for any
// length. The gap is bilinear between pixel centres and periodic.
#pragma once

#include <array>
#include <vector>

#include "base/rooms.h"
#include "fields/gap.h"
#include "numerics/arrays.h"
#include "numerics/vector.h"

namespace papilla::capillary {

class GapTable {
 public:
  // Gaps below `floor` [m] count as `floor`, so that a bridge in a contact stays finite. around
  // [m]: how far lowest_around looks; 0: it is not asked.
  GapTable(const Gap& gap, double floor, double around = 0);

  struct Rim {
    double gap;    // mean on the circle [m]
    double slope;  // of that mean along the radius [-], over 14 % of it
  };
  // How finely a disc of one size is sampled; the same rule for every disc of about that radius.
  struct Rule {
    int chords, rim_points;  // indices of the node tables

    bool operator==(const Rule&) const = default;
  };

  double at(double x, double y) const;  // [m]
  // At eight places `step` from one, in kDirections [m].
  std::array<double, 8> around(double x, double y, double step) const;
  // No gap within `around` of a place inside the period is smaller [m]; a bound, not the smallest.
  double lowest_around(double x, double y) const;
  Rule rule(double radius) const;
  double disc_volume(double x, double y, double radius, const Rule& rule) const;  // [m^3]
  Rim rim(double x, double y, double radius, const Rule& rule) const;

  const Grid& grid() const { return grid_; }
  double floor() const { return floor_; }

 private:
  struct Nodes;
  struct Disc {  // in pixels
    double u, v, ru, rv;
    int periods = 0;  // by how many at most it reaches beyond the patch
  };
  Disc disc(double x, double y, double radius) const;

  // Of one place or of several (T: numerics/vector.h), all of them in pixels.
  template <class T>
  struct Cells {
    IndexOf<T> node;   // first of each
    T share;           // of the place beyond it
    IndexOf<T> turns;  // periods that it was away
  };
  template <bool kWraps, class T>
  Cells<T> cells(const T& place, int n, int periods) const;
  template <class T>
  T row_integrals(const IndexOf<T>& at, int later, const T& share) const;
  template <bool kWraps, class T>
  T chord(const T& from, const T& to, const T& v, int periods) const;  // over pixel
  template <bool kWraps, class T>
  T gaps(const T& u, const T& v, int periods) const;  // [m]

  Grid grid_;
  double floor_;
  double inverse_dx_, inverse_dy_;
  int stride_;
  // Rows of nx + 1, the first column repeated, as is the first row.
  UnsetArray<double> value_;   // the gap [m]
  UnsetArray<double> prefix_;  // its integral from pixel centre 0 to here, in pixels

  void find_lowest(double around);
  // Smallest gap of a block of pixels and the eight around it; blocks are wider than `around`.
  int block_x_ = 1, block_y_ = 1, blocks_x_ = 0, blocks_y_ = 0;  // pixels of one, and how many
  std::vector<double> lowest_;
};

}  // namespace papilla::capillary
