// Integrals of a gap over discs, fast: prefix sums along x make one chord cost the same for any
// length. The gap is bilinear between pixel centres and periodic.
#pragma once

#include <array>
#include <vector>

#include "base/arrays.h"
#include "base/rooms.h"
#include "fields/gap.h"

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
  // Nodes of a circle or chords of a disc, four at a time; their counts are multiples of it.
  using Four = double __attribute__((vector_size(32)));
  using Two = double __attribute__((vector_size(16)));
  using Index = int __attribute__((vector_size(16)));

  struct Nodes;
  struct Disc {  // in pixels
    double u, v, ru, rv;
    int periods = 0;  // by how many at most it reaches beyond the patch
  };

  Disc disc(double x, double y, double radius) const;

  static Index floor_of(const Four& u);
  static Index wrapped(Index& i, int n, int periods);
  struct Neighbours {
    Four here, next;
  };
  struct Pair {
    double in, out;
  };
  struct Rows {
    Index low;   // first nodes of the lower ones
    Four share;  // of the rows after them
  };
  static Neighbours neighbours(const double* values, const Index& at);
  Four row_integrals(const Index& at, int later, const Four& f) const;
  template <bool kWraps>
  Rows rows(const Four& v, int periods) const;
  template <bool kWraps>
  double chords(const Nodes& n, const Disc& d) const;  // over radius and pixel
  template <bool kWraps>
  Four gaps(const Four& u, const Four& v, int periods) const;  // [m]; places in pixels
  template <bool kWraps>
  Pair circles(const Nodes& n, const Disc& in, const Disc& out) const;  // [m]
  double bilinear(double u, double v) const;                            // [m]; places in pixels

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
