#include "physics/optics/order_screen.h"

#include <algorithm>
#include <cmath>

namespace papilla::optics {
namespace {

// A sine differs by less than its angle.
double reach_of(const Receptor& receptor) {
  return std::max(receptor.reach_x() + std::abs(receptor.offset), receptor.reach_y());
}

}  // namespace

OrderPowers OrderScreen::within(const Column& column, Passage passage, double wavelength,
                                double reach) const {
  const bool back = passage == Passage::Back;
  const int mx = std::min(most_x(), static_cast<int>(reach / wavelength * cell_.lx)),
            my = std::min(most_y(), static_cast<int>(reach / wavelength * cell_.ly));
  const auto amplitude = [&](double h) { return back ? column.back(h) : column.through(h); };
  if (!column.even()) return orders(amplitude, mx, my);
  const double phase = back ? column.phase_back() : column.phase_through();
  const auto serves = [&](const auto& known) {
    return known.first == phase && known.second.mx >= mx && known.second.my >= my;
  };
  auto found = std::find_if(unit_.begin(), unit_.end(), serves);
  if (found == unit_.end()) {
    unit_.emplace_back(phase, orders([&](double h) { return std::polar(1.0, phase * h); }, mx, my));
    found = std::prev(unit_.end());
  }
  const double power = std::norm(amplitude(0));
  OrderPowers out{mx, my, {}, power * found->second.total};
  for (int m = -mx; m <= mx; ++m) {
    for (int n = -my; n <= my; ++n) out.power.push_back(power * found->second.at(m, n));
  }
  return out;
}

Sent OrderScreen::through(const Column& column, double wavelength, double sine, double cone) const {
  // No order within the cone is further from the undeviated one than this sine, from any direction.
  const double reach = 2 * std::sin(0.5 * cone);
  const OrderPowers powers = within(column, Passage::Through, wavelength, reach);
  const auto inside = [&](double sx, double sy) {
    const double sz = std::sqrt(1 - sx * sx - sy * sy);
    double sum = 0;
    for (int m = -powers.mx; m <= powers.mx; ++m) {
      for (int n = -powers.my; n <= powers.my; ++n) {
        const double dx = m * wavelength / cell_.lx, dy = n * wavelength / cell_.ly;
        const double z2 = 1 - square(sx + dx) - square(sy + dy);
        if (z2 <= 0) continue;
        // Length of the difference of two directions, exact for small ones.
        const double dz = std::sqrt(z2) - sz;
        if (dx * dx + dy * dy + dz * dz <= reach * reach) sum += powers.at(m, n);
      }
    }
    return sum;
  };
  const double along_x = inside(sine, 0);
  return {powers.at(0, 0), sine == 0 ? along_x : 0.5 * (along_x + inside(0, sine)), powers.total};
}

// Mean over the planes of incidence x and y.
double OrderScreen::taken(const OrderPowers& powers, double wavelength,
                          const Receptor& receptor) const {
  double sum = 0;
  for (int m = -powers.mx; m <= powers.mx; ++m) {
    for (int n = -powers.my; n <= powers.my; ++n) {
      const double dx = m * wavelength / cell_.lx, dy = n * wavelength / cell_.ly;
      sum += 0.5 * powers.at(m, n) * (receptor.accepts(dx, dy) + receptor.accepts(dy, dx));
    }
  }
  return sum;
}

std::vector<double> OrderScreen::received(const Column& column, double wavelength,
                                          const std::vector<Receptor>& receptors) const {
  double reach = 0;
  for (const Receptor& r : receptors) reach = std::max(reach, reach_of(r));
  const OrderPowers powers = within(column, Passage::Back, wavelength, reach);
  std::vector<double> out;
  for (const Receptor& r : receptors) out.push_back(taken(powers, wavelength, r));
  return out;
}

double OrderScreen::mirrored(const Column& column, double wavelength) const {
  return within(column, Passage::Back, wavelength, 0).at(0, 0);
}

// Light that a face scatters twice is left out: once, on the way in or on the way out.
double OrderScreen::received_twice(const Column& column, double wavelength,
                                   const Receptor& receptor) const {
  const double reach = reach_of(receptor);
  const OrderPowers powers = within(column, Passage::Through, wavelength, reach);
  const double straight = powers.at(0, 0), mirror = receptor.accepts(0, 0);
  return straight * (2 * taken(powers, wavelength, receptor) - straight * mirror);
}

}  // namespace papilla::optics
