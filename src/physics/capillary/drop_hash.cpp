#include "physics/capillary/drop_hash.h"

#include <algorithm>
#include <cmath>

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
  linked_.resize(drops.size());
  for (int i = 0; i < static_cast<int>(drops.size()); ++i) {
    if (drops[i].film < 1) link(i, drops[i]);  // film is no disc that others meet
  }
}

int DropHash::cell_of(const Drop& d) const {
  return std::min(static_cast<int>(d.y * per_cell_y_), cells_y_ - 1) * cells_x_ +
         std::min(static_cast<int>(d.x * per_cell_x_), cells_x_ - 1);
}

void DropHash::link(int i, const Drop& drop) {
  linked_[i] = {disc_of(drop), -1};
  if (drop.radius > small_radius_) {
    large_.push_back(i);
    return;
  }
  largest_ = std::max(largest_, drop.radius);
  int& head = head_[cell_of(drop)];
  linked_[i].next = head;
  head = i;
}

void DropHash::unlink(int i, const Drop& drop) {
  if (drop.radius > small_radius_) {
    large_.erase(std::find(large_.begin(), large_.end(), i));
    return;
  }
  int* at = &head_[cell_of(drop)];
  while (*at != i) at = &linked_[*at].next;
  *at = linked_[i].next;
}

void DropHash::collect_overlaps(const Drop& d, std::vector<int>& members, int from) const {
  const auto consider = [&](int j) {
    if (j < from) return;
    const Disc& other = linked_[j].disc;
    const double ex = image_distance(other.x - d.x, lx_);
    const double ey = image_distance(other.y - d.y, ly_);
    if (square(ex) + square(ey) >= square(d.radius + other.radius)) return;
    if (std::find(members.begin(), members.end(), j) == members.end()) members.push_back(j);
  };
  for (int j : large_) consider(j);
  const double reach = d.radius + largest_;
  const int x0 = static_cast<int>(std::floor((d.x - reach) * per_cell_x_));
  const int x1 =
      std::min(static_cast<int>(std::floor((d.x + reach) * per_cell_x_)), x0 + cells_x_ - 1);
  const int y0 = static_cast<int>(std::floor((d.y - reach) * per_cell_y_));
  const int y1 =
      std::min(static_cast<int>(std::floor((d.y + reach) * per_cell_y_)), y0 + cells_y_ - 1);
  const int first = wrap(x0, cells_x_);
  for (int cy = y0, row = wrap(y0, cells_y_); cy <= y1; ++cy) {
    for (int cx = x0, column = first; cx <= x1; ++cx) {
      for (int j = head_[row * cells_x_ + column]; j >= 0; j = linked_[j].next) consider(j);
      if (++column == cells_x_) column = 0;
    }
    if (++row == cells_y_) row = 0;
  }
}

}  // namespace papilla::capillary
