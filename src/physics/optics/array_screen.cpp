// The screen of an array: 1 around its features, and inside each outline what the terrace there
// has more than the one around it. Eq. optics.9
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>

#include "base/constants.h"
#include "physics/optics/apertures.h"
#include "physics/optics/order_screen.h"
#include "physics/optics/sparkle.h"

namespace papilla::optics {
namespace {

// The cell that repeats: of lines a strip as narrow as no order along it asks.
Grid cell_of(const FeatureArray& a) {
  if (a.shape == FeatureArray::Shape::Line) return {1, 1, a.period, 1e-3 * a.period};
  return {1, 1, a.period, a.lattice == Lattice::Square ? a.period : std::sqrt(3.0) * a.period};
}

class ArrayScreen : public OrderScreen {
 public:
  explicit ArrayScreen(const FeatureArray& array) : OrderScreen(cell_of(array)), array_(array) {}

  double step() const override {
    double low = 0, high = 0;  // the surroundings
    for (const Terrace& t : array_.terraces)
      low = std::min(low, t.height), high = std::max(high, t.height);
    return high - low;
  }

  double sparkle(double step, const Panel& panel) const override {
    constexpr int kPixels = 128;
    return map_sparkle(terraced(kPixels), step, panel);
  }

 protected:
  OrderPowers orders(const AmplitudeOf& amplitude, int mx, int my) const override {
    std::vector<Complex> rises;
    Complex around = amplitude(0);
    double total = std::norm(around);
    const Complex land = around;
    for (const Terrace& t : array_.terraces) {
      const Complex here = amplitude(t.height);
      total += share(t.width, 0, 0) * (std::norm(here) - std::norm(around));
      rises.push_back(here - around);
      around = here;
    }
    // Orders of either sign are alike: the outlines are symmetric.
    std::vector<double> quarter;
    for (int m = 0; m <= mx; ++m) {
      for (int n = 0; n <= my; ++n) {
        Complex f = m == 0 && n == 0 ? land : Complex(0);
        const std::vector<double>& of_terraces = shares(m, n);
        for (std::size_t j = 0; j < rises.size(); ++j) f += of_terraces[j] * rises[j];
        quarter.push_back(std::norm(f));
      }
    }
    OrderPowers out{mx, my, {}, total};
    for (int m = -mx; m <= mx; ++m) {
      for (int n = -my; n <= my; ++n)
        out.power.push_back(
            quarter[static_cast<std::size_t>(std::abs(m) * (my + 1) + std::abs(n))]);
    }
    return out;
  }
  int most_x() const override { return kMostOrders; }
  int most_y() const override { return kMostOrders; }

 private:
  static constexpr int kMostOrders = 1 << 12;

  // Fourier coefficient of the inside of an outline, its phase left out.
  double share(double width, int m, int n) const {
    const double w = std::max(width, 0.0);
    if (array_.shape == FeatureArray::Shape::Line)
      return n == 0 ? w / array_.period * sinc(kPi * std::abs(m) * w / array_.period) : 0;
    const bool hexagonal = array_.lattice == Lattice::Hexagonal;
    if (hexagonal && (m + n) % 2 != 0) return 0;  // two features in the cell, half of it apart
    const double q = kPi * w * std::hypot(m / cell().lx, n / cell().ly);
    return (hexagonal ? 2 : 1) * 0.25 * kPi * w * w / cell().area() * airy(q);
  }

  // Of each terrace: every wavelength and angle asks for the same.
  const std::vector<double>& shares(int m, int n) const {
    const auto [place, missing] = shares_.try_emplace({m, n});
    if (missing) {
      for (const Terrace& t : array_.terraces) place->second.push_back(share(t.width, m, n));
    }
    return place->second;
  }

  // Its heights, pixel by pixel.
  Heightmap terraced(int pixels) const {
    const bool line = array_.shape == FeatureArray::Shape::Line;
    Grid grid = cell();
    grid.nx = pixels;
    grid.ny = line ? 1 : 2 * static_cast<int>(0.5 * pixels * grid.ly / grid.lx);
    Heightmap out{grid, std::vector<double>(grid.size(), 0.0)};
    const bool hexagonal = array_.lattice == Lattice::Hexagonal;
    const auto from = [](double x, double period) { return x - period * std::rint(x / period); };
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        const double x = grid.x(ix), y = line ? 0 : grid.y(iy);
        double r = std::hypot(from(x, grid.lx), line ? 0 : from(y, grid.ly));
        if (!line && hexagonal)
          r = std::min(
              r, std::hypot(from(x - 0.5 * grid.lx, grid.lx), from(y - 0.5 * grid.ly, grid.ly)));
        for (const Terrace& t : array_.terraces) {
          if (2 * r > t.width) break;
          out(ix, iy) = t.height;
        }
      }
    }
    return out;
  }

  const FeatureArray& array_;
  mutable std::map<std::pair<int, int>, std::vector<double>> shares_;
};

}  // namespace

std::unique_ptr<Screen> array_screen_of(const FeatureArray& array) {
  return std::make_unique<ArrayScreen>(array);
}

}  // namespace papilla::optics
