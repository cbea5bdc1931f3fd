// The dense solver's steps where few pixels touch: everything but transforms and one pass on lists.
#pragma once

#include <vector>

#include "physics/contact/dense_fields.h"
#include "physics/contact/dense_stencil.h"

namespace papilla {

class WholePixels;

class ListedPixels {
 public:
  explicit ListedPixels(DenseFields& fields) : f_(fields), stencil_(fields.kernel) {}

  void begin();                             // from the fields' pressure and its change of the gap
  void take_over(const WholePixels& from);  // goes on where the other left

  // The direction in which the step goes, from the residual.
  void precondition();
  void precondition_plainly();  // the residual over a pixel's own compliance

  // p along -alpha d, d = direction plus the share of the last step that makes it conjugate to it
  // (Polak-Ribiere+), without load; cut at the bounds. The load is restored by a shift of the rigid
  // level, that is along the preconditioned constant, so that a short step always descends. step =
  // what p changed by. True if a pixel under pressure met a bound. No step where the free pixels
  // cannot carry the load.
  bool move(double alpha, bool conjugate);
  StepSlopes slopes() const;
  double room() const;     // how many times the step taken fits between the bounds
  void advance(double t);  // the state at t of the step

  std::size_t free_count() const { return free_.size(); }
  const std::vector<int>& free() const { return free_; }
  const std::vector<double>& residual() const { return r_; }
  const std::vector<int>& left() const { return left_; }

 private:
  void precondition_by_plane();
  double conjugate_share() const;
  void arrive(double t);
  void sort_pressed(double t);
  void add_joining(double t);

  DenseFields& f_;
  StencilPreconditioner stencil_;
  // free_: pixels between the bounds and those at a bound whose gap has the wrong sign; held_:
  // others at the cap; old_: the free set of the last step, held ones included; left_: of it, no
  // longer free.
  std::vector<int> free_, held_, old_, left_;
  std::vector<double> r_, z_, ones_, raw_;  // of free_: residual, direction, its constant, raw p
};

}  // namespace papilla
