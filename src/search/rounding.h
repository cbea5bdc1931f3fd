// A design as a fab draws it: its numbers on a grid.
#pragma once

#include <optional>
#include <queue>
#include <set>
#include <vector>

#include "base/rooms.h"
#include "search/problem.h"

namespace papilla::search {

// A number of a design on a fab's grid [m]: what a mask draws (periods and widths of textures) to
// multiples of it; other lengths too, or to multiples of a tenth, a hundredth ... of it where it is
// more than a fiftieth of the length; angles to degrees; the rest to three digits. Within low and
// high where the grid has such a value.
double on_grid(const Variable& variable, double value, double grid);
// Not where the range of the variable has no value of the grid.
bool lies_on_grid(const Variable& variable, double value, double grid);

// Lengths below this [m] that no mask draws are on a finer grid than the fab's own.
double finer_grid_below(double grid);

// A design on the grid.
struct GridDesign {
  std::vector<double> value;  // SI, in every digit as a file would write them
  Point unit;
};

// The designs of the grid round another one, nearest first: the distance is the root of the sum of
// squares over the numbers, each in steps of its grid. Choices stay as they are, and so do numbers
// of a texture that is not there; flat: all numbers of the texture.
class GridDesigns {
 public:
  GridDesigns(const StudyProblem& problem, const Point& around, bool flat);

  std::optional<GridDesign> next();  // nothing: there are no more within some steps

 private:
  struct Step {
    double value, squared;  // SI; of the distance in steps
  };
  struct Places {
    double squared;
    std::vector<std::size_t> of;                 // of each number, in its steps
    bool operator<(const Places& other) const {  // the nearest is on top of a queue
      return squared != other.squared ? squared > other.squared : of > other.of;
    }
  };
  void add(std::vector<std::size_t> places);

  const DesignSpace& space_;
  std::vector<double> value_;
  std::vector<std::vector<Step>> steps_;  // of each variable, nearest first
  std::priority_queue<Places> open_;
  std::set<std::vector<std::size_t>> known_;
};

}  // namespace papilla::search
