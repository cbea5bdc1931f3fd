// The screen of a heightmap: a transform of its pixels.
#include <algorithm>
#include <cmath>

#include "physics/optics/order_screen.h"
#include "physics/optics/sparkle.h"
#include "physics/optics/transform.h"

namespace papilla::optics {
namespace {

class MapScreen : public OrderScreen {
 public:
  explicit MapScreen(const Heightmap& map) : OrderScreen(map.grid), map_(map) {
    const auto [low, high] = std::minmax_element(map.z.begin(), map.z.end());
    low_ = *low, high_ = *high;
  }

  // A map has two levels where most of it lies within a few per cent of either.
  double step() const override {
    constexpr double kNear = 0.05, kMost = 0.5;
    const double whole = high_ - low_;
    const auto level = [&](double z) { return std::min(z - low_, high_ - z) <= kNear * whole; };
    const auto near = std::count_if(map_.z.begin(), map_.z.end(), level);
    return static_cast<double>(near) > kMost * static_cast<double>(map_.z.size()) ? whole : 0;
  }

  double sparkle(double step, const Panel& panel) const override {
    return map_sparkle(map_, step, panel);
  }

 protected:
  OrderPowers orders(const AmplitudeOf& amplitude, int mx, int my) const override {
    const SpectrumArray t = screen_of(amplitude);
    OrderPowers out{mx, my, {}, 0};
    for (const Complex& c : t) out.total += std::norm(c) / static_cast<double>(t.size());
    if (mx == 0 && my == 0) {  // the mean, without a transform
      Complex sum = 0;
      for (const Complex& c : t) sum += c;
      out.power = {std::norm(sum / static_cast<double>(t.size()))};
      return out;
    }
    const SpectrumArray f = coefficients(map_.grid, t);
    for (int m = -mx; m <= mx; ++m) {
      for (int n = -my; n <= my; ++n)
        out.power.push_back(
            std::norm(f[map_.grid.index(wrap(m, map_.grid.nx), wrap(n, map_.grid.ny))]));
    }
    return out;
  }
  // Orders beyond are those of other pixels.
  int most_x() const override { return (map_.grid.nx - 1) / 2; }
  int most_y() const override { return (map_.grid.ny - 1) / 2; }

 private:
  // Films make an amplitude that takes long: it is tabulated over the heights, finer than any
  // fringe (8 um of relief in steps of 1 nm), and read by straight lines.
  SpectrumArray screen_of(const AmplitudeOf& amplitude) const {
    constexpr double kStep = 1e-9;
    constexpr double kMostSteps = 8192;
    const int steps =
        static_cast<int>(std::clamp(std::ceil((high_ - low_) / kStep), 1.0, kMostSteps));
    SpectrumArray t(map_.z.size());
    if (static_cast<std::size_t>(steps) >= map_.z.size()) {
      for (std::size_t i = 0; i < t.size(); ++i) t[i] = amplitude(map_.z[i]);
      return t;
    }
    const double width = std::max(high_ - low_, 1e-15) / steps;
    std::vector<Complex> table;
    for (int k = 0; k <= steps; ++k) table.push_back(amplitude(low_ + k * width));
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double place = (map_.z[i] - low_) / width;
      const auto k = std::min(static_cast<std::size_t>(place), table.size() - 2);
      const double share = place - static_cast<double>(k);
      t[i] = (1 - share) * table[k] + share * table[k + 1];
    }
    return t;
  }

  Heightmap map_;
  double low_ = 0, high_ = 0;
};

}  // namespace

std::unique_ptr<Screen> map_screen(const Heightmap& map) {
  return std::make_unique<MapScreen>(map);
}

}  // namespace papilla::optics
