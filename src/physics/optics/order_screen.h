// A periodic face: its light leaves in orders.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "base/rooms.h"
#include "physics/optics/screen.h"

namespace papilla::optics {

// Powers of the orders |m| <= mx, |n| <= my of a cell.
struct OrderPowers {
  int mx = 0, my = 0;
  std::vector<double> power;
  double total = 0;  // of all orders, those beyond mx and my too

  double at(int m, int n) const {
    return power[static_cast<std::size_t>((m + mx) * (2 * my + 1) + n + my)];
  }
};

using AmplitudeOf = std::function<Complex(double height)>;

class OrderScreen : public Screen {
 public:
  explicit OrderScreen(const Grid& cell) : cell_(cell) {}

  Sent through(const Column& column, double wavelength, double sine, double cone) const override;
  using Screen::received;
  std::vector<double> received(const Column& column, double wavelength,
                               const std::vector<Receptor>& receptors) const override;
  double mirrored(const Column& column, double wavelength) const override;
  double received_twice(const Column& column, double wavelength,
                        const Receptor& receptor) const override;

 protected:
  // Orders that differ from the undeviated one by sines up to reach_x, reach_y at this wavelength.
  virtual OrderPowers orders(const AmplitudeOf& amplitude, int mx, int my) const = 0;
  // The most that the cell can tell.
  virtual int most_x() const = 0;
  virtual int most_y() const = 0;

  const Grid& cell() const { return cell_; }

 private:
  enum class Passage { Through, Back };
  // Of light that passes or comes back; reach: as of a sine.
  OrderPowers within(const Column& column, Passage passage, double wavelength, double reach) const;
  double taken(const OrderPowers& powers, double wavelength, const Receptor& receptor) const;

  Grid cell_;
  // Of amplitudes of size 1 by their phase a metre: polarisations and receptors share them.
  mutable std::vector<std::pair<double, OrderPowers>> unit_;
};

}  // namespace papilla::optics
