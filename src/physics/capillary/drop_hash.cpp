#include "physics/capillary/drop_hash.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace papilla::capillary {

void DropHash::build(const std::vector<Drop>& drops) {
  // Cells hold about two drops. What counts as small is a compromise: every search goes through the
  // list of the others, and through all cells that a small one may reach it from.
  double typical = 0;
  for (const Drop& d : drops) typical += d.radius / static_cast<double>(drops.size());
  small_radius_ = 3 * typical;
  largest_ = 0;
  const double cell = 1.5 * std::sqrt(lx_ * ly_ / static_cast<double>(drops.size() + 1));
  cells_x_ = std::max(1, static_cast<int>(lx_ / cell));
  cells_y_ = std::max(1, static_cast<int>(ly_ / cell));
  per_cell_x_ = cells_x_ / lx_;
  per_cell_y_ = cells_y_ / ly_;
  head_.assign(static_cast<std::size_t>(cells_x_) * cells_y_, -1);
  in_row_.assign(static_cast<std::size_t>(cells_y_), 0);
  linked_.resize(drops.size());
  seen_.assign(drops.size(), 0);
  search_ = 0;
  for (int i = 0; i < static_cast<int>(drops.size()); ++i) {
    if (drops[i].film < 1) link(i, drops[i]);  // film is no disc that others meet
  }
}

DropHash::Cell DropHash::cell_of(const Drop& d) const {
  return {std::min(static_cast<int>(d.x * per_cell_x_), cells_x_ - 1),
          std::min(static_cast<int>(d.y * per_cell_y_), cells_y_ - 1)};
}

void DropHash::link(int i, const Drop& drop) {
  linked_[i] = {disc_of(drop), -1};
  if (drop.radius > small_radius_) {
    large_.push_back(i);
    return;
  }
  largest_ = std::max(largest_, drop.radius);
  const Cell cell = cell_of(drop);
  ++in_row_[cell.row];
  linked_[i].next = std::exchange(head(cell), i);
}

void DropHash::unlink(int i, const Drop& drop) {
  if (drop.radius > small_radius_) {
    large_.erase(std::find(large_.begin(), large_.end(), i));
    return;
  }
  const Cell cell = cell_of(drop);
  --in_row_[cell.row];
  int* at = &head(cell);
  while (*at != i) at = &linked_[*at].next;
  *at = linked_[i].next;
}

void DropHash::collect_overlaps(const Drop& d, std::vector<int>& members, int from) const {
  ++search_;
  for (int j : members) seen_[j] = search_;
  const auto consider = [&](int j) {
    if (j < from || seen_[j] == search_) return;
    const Disc& other = linked_[j].disc;
    const double ex = image_distance(other.x - d.x, lx_);
    const double ey = image_distance(other.y - d.y, ly_);
    if (square(ex) + square(ey) >= square(d.radius + other.radius)) return;
    seen_[j] = search_;
    members.push_back(j);
  };
  for (int j : large_) consider(j);
  const double reach = d.radius + largest_;
  const int y0 = static_cast<int>(std::floor((d.y - reach) * per_cell_y_));
  const int last = static_cast<int>(std::floor((d.y + reach) * per_cell_y_));
  const int y1 = std::min(last, y0 + cells_y_ - 1);
  const bool around = last > y1;  // some row is met from both sides
  for (int cy = y0, row = wrap(y0, cells_y_); cy <= y1; ++cy) {
    if (in_row_[row] > 0) {
      // Of the row what lies within reach, of its nearest image.
      const double away =
          around ? 0 : std::max({0.0, cy / per_cell_y_ - d.y, d.y - (cy + 1) / per_cell_y_});
      const double chord = std::sqrt(std::max(0.0, square(reach) - square(away)));
      const int x0 = static_cast<int>(std::floor((d.x - chord) * per_cell_x_));
      const int x1 =
          std::min(static_cast<int>(std::floor((d.x + chord) * per_cell_x_)), x0 + cells_x_ - 1);
      for (int cx = x0, column = wrap(x0, cells_x_); cx <= x1; ++cx) {
        for (int j = head_[row * cells_x_ + column]; j >= 0; j = linked_[j].next) consider(j);
        if (++column == cells_x_) column = 0;
      }
    }
    if (++row == cells_y_) row = 0;
  }
}

}  // namespace papilla::capillary
