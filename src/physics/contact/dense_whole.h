// The dense solver's steps where much of the surface touches: whole fields instead of lists, as few
// passes over them as their sums allow.
#pragma once

#include <vector>

#include "physics/contact/dense_fields.h"

namespace papilla {

class ListedPixels;

// What each function does: as in ListedPixels. The fields' `field` is the free pixels' residual,
// then the direction.
class WholePixels {
 public:
  explicit WholePixels(DenseFields& fields) : f_(fields) {}

  void take_over(const ListedPixels& from);

  void precondition() { f_.press_field(); }
  void precondition_plainly();
  bool move(double alpha, bool conjugate);
  StepSlopes slopes() const;
  double room() const;
  void advance(double t);

  std::size_t free_count() const { return free_count_; }
  bool is_free(std::size_t pixel) const { return is_free_[pixel] != 0; }

 private:
  DenseFields& f_;
  std::vector<char> is_free_;
  std::size_t free_count_ = 0;
};

}  // namespace papilla
