// Water that leads: every bridge, or film that hangs together, has one potential.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "base/rooms.h"
#include "geometry/grid.h"

namespace papilla::electrostatics {

// The wet pixels of a periodic grid, body by body: pixels that share an edge are of one. grounded:
// at the potential of what lies behind the skin, as if no layer of the skin lay between.
class WaterBodies {
 public:
  WaterBodies(const Grid& grid, const std::vector<std::uint8_t>& wet, bool grounded);

  bool grounded() const { return grounded_; }
  const std::vector<std::size_t>& pixels() const { return pixels_; }
  std::size_t count() const { return end_.size(); }

  // Visits each body with its pixels.
  template <class Visit>
  void each(Visit&& visit) const {
    const std::size_t* begin = pixels_.data();
    for (const std::size_t end : end_) {
      visit(begin, pixels_.data() + end);
      begin = pixels_.data() + end;
    }
  }

  // Potentials that the water can have, nearest to these: the mean over each body, zero where it is
  // grounded. at(pixel): where the value of a wet pixel stands.
  template <class Values, class At>
  void level(Values& values, At&& at) const {
    using Number = std::remove_reference_t<decltype(values[0])>;
    each([&](const std::size_t* begin, const std::size_t* end) {
      double sum = 0;
      if (!grounded_) {
        for (const std::size_t* p = begin; p != end; ++p) sum += values[at(*p)];
      }
      const auto mean = static_cast<Number>(sum / static_cast<double>(end - begin));
      for (const std::size_t* p = begin; p != end; ++p) values[at(*p)] = mean;
    });
  }

 private:
  std::vector<std::size_t> pixels_, end_;  // of all bodies one after another; where each ends
  bool grounded_;
};

}  // namespace papilla::electrostatics
