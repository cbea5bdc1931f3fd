// A few pixels that may touch, solved as one small dense problem with an exact active set.
#pragma once

#include <utility>
#include <vector>

#include "base/rooms.h"
#include "numerics/dense.h"
#include "physics/contact/contact.h"

namespace papilla::contact {

class ActiveSet {
 public:
  explicit ActiveSet(const ContactKernel& kernel) : kernel_(kernel) {}

  // The pixels watched and whether each is taken to touch at first; sorted on return, a pixel
  // listed twice touches if either does. initial_gap: of a pixel, without any pressure [m].
  template <class Gap>
  void watch(std::vector<std::pair<int, bool>>& members, const Gap& initial_gap) {
    sort(members);
    gap_.clear();
    for (int i : pixel_) gap_.push_back(initial_gap(i));
  }

  // Pressures and rigid shift under that sum of pressures: from one factorisation and two
  // right-hand sides; pulling pixels leave, those that penetrate by more than slack [m] join,
  // until nothing changes. False: more than limit touch, or cycling. Cost: a Cholesky
  // factorisation a pass.
  bool balance(double load, double slack, std::size_t limit);

  std::size_t size() const { return pixel_.size(); }
  int pixel(std::size_t k) const { return pixel_[k]; }
  std::size_t find(int pixel) const;  // its position, or size()
  bool touches(std::size_t k) const { return touching_[k]; }
  double pressure(std::size_t k) const { return pressure_[k]; }
  double shift() const { return shift_; }
  const std::vector<std::size_t>& touching() const { return set_; }
  double gap(std::size_t k) const;  // [m]

 private:
  void sort(std::vector<std::pair<int, bool>>& members);
  double influence(int x, int y, std::size_t k) const;  // at (x, y) from the pixel at position k

  const ContactKernel& kernel_;
  double shift_ = 0;
  std::vector<int> pixel_, x_, y_;
  std::vector<char> touching_;
  std::vector<double> gap_, pressure_;
  std::vector<std::size_t> set_;  // touching ones, as positions
  Cholesky cholesky_;
  std::vector<double> matrix_, a_, b_;  // influences, one touching pixel after another
};

}  // namespace papilla::contact
