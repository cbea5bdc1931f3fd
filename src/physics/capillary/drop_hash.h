// Which drops' discs overlap a disc: drops by the cell of their centre.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "geometry/grid.h"
#include "physics/capillary/drop.h"

namespace papilla::capillary {

// Knows drops by their index in a list that the caller keeps; a drop is taken out before it changes
// and put back after. A search costs the drops of the cells around, about one.
class DropHash {
 public:
  explicit DropHash(const Grid& grid) : lx_(grid.lx), ly_(grid.ly) {}

  void build(const std::vector<Drop>& drops);
  void link(int i, const Drop& drop);
  void unlink(int i, const Drop& drop);

  // Adds to `members` every drop from `from` on, not among them, that the disc of `d` overlaps.
  void collect_overlaps(const Drop& d, std::vector<int>& members, int from = 0) const;

 private:
  struct Cell {
    int column, row;
  };
  Cell cell_of(const Drop& d) const;
  int& head(Cell cell) { return head_[cell.row * cells_x_ + cell.column]; }

  double lx_, ly_;
  struct Linked {
    Disc disc;
    int next;  // of the same cell; -1: none
  };

  // Drops up to small_radius_ lie in cells, linked one to the next; the others are one list.
  int cells_x_ = 1, cells_y_ = 1;
  double per_cell_x_ = 0, per_cell_y_ = 0;  // cells by length [1/m]
  double small_radius_ = 0;
  double largest_ = 0;  // radius that has been in a cell since they were built
  std::vector<int> head_, large_;
  std::vector<int> in_row_;  // drops in the cells of a row
  std::vector<Linked> linked_;
  mutable std::vector<int> seen_;  // the search that met a drop last
  mutable int search_ = 0;
};

}  // namespace papilla::capillary
