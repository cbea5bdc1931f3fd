#include "physics/contact/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/constants.h"

namespace papilla::contact {

double Westergaard::full_pressure() const { return kPi * modulus * amplitude / period; }

double Westergaard::area(double p) const {
  return 2 / kPi * std::asin(std::sqrt(std::clamp(p / full_pressure(), 0.0, 1.0)));
}

double Westergaard::peak_pressure(double p) const { return pressure(p, 0); }

double Westergaard::pressure(double p, double x) const {
  const double psi = kPi * x / period;
  if (p >= full_pressure()) return p + full_pressure() * std::cos(2 * psi);
  if (p <= 0) return 0;
  const double edge = p / full_pressure();  // sin^2 of the contact's half angle
  const double inside = edge - square(std::sin(psi));
  return inside > 0 ? 2 * p * std::cos(psi) / edge * std::sqrt(inside) : 0;
}

double EggBox::full_pressure() const { return std::sqrt(2.0) * kPi * modulus * amplitude / period; }

namespace {

// Linear between the rows (x, y) of a table, x increasing, x within it.
template <std::size_t N>
double between(const double (&table)[N][2], double x) {
  const auto* right =
      std::upper_bound(table + 1, table + N - 1, x,
                       [](double value, const double(&row)[2]) { return value < row[0]; });
  const auto* left = right - 1;
  const double t = (x - (*left)[0]) / ((*right)[0] - (*left)[0]);
  return (*left)[1] + t * ((*right)[1] - (*left)[1]);
}

}  // namespace

double EggBox::area(double p) const {
  // p/p* and share in contact.
  static constexpr double kTable[][2] = {
      {.005, .02258}, {.01, .03632}, {.02, .05871}, {.05, .11287}, {.1, .19059}, {.15, .26557},
      {.2, .34566},   {.3, .51401},  {.4, .62003},  {.5, .70433},  {.6, .77601}, {.7, .83974},
      {.8, .89754},   {.9, .95074},  {.95, .97575}, {.99, .99526}, {1, 1}};
  const double share = p / full_pressure();
  if (share <= 0) return 0;
  if (share >= 1) return 1;
  if (share <=
      kTable[0][0]) {  // Hertz on two peaks per period; their interaction grows with the load
    const auto hertz = [](double s) { return kPi * std::pow(3 * s / (8 * kPi), 2.0 / 3); };
    const double excess = kTable[0][1] / hertz(kTable[0][0]) - 1;
    return hertz(share) * (1 + excess * share / kTable[0][0]);
  }
  return between(kTable, share);
}

double EggBox::peak_pressure(double p) const {
  // (p/p*)^(1/3), in which Hertz is a line through 0, and the pressure at the crests over p*.
  static const double kTable[][2] = {{0, 0},
                                     {std::cbrt(.005), .335},
                                     {std::cbrt(.01), .421},
                                     {std::cbrt(.05), .709},
                                     {std::cbrt(.1), .884},
                                     {std::cbrt(.2), 1.096},
                                     {std::cbrt(.5), 1.479},
                                     {std::cbrt(.8), 1.798},
                                     {1, 2}};
  const double share = p / full_pressure();
  if (share <= 0) return 0;
  if (share >= 1) return p + full_pressure();
  return full_pressure() * between(kTable, std::cbrt(share));
}

double Hertz::contact_radius(double force) const {
  return std::cbrt(3 * force * radius / (4 * modulus));
}
double Hertz::approach(double force) const { return square(contact_radius(force)) / radius; }
double Hertz::peak_pressure(double force) const {
  return 3 * force / (2 * kPi * square(contact_radius(force)));
}

// F = pi E* a^2 tan(beta) / 2, delta = pi a tan(beta) / 2
double Cone::contact_radius(double force) const {
  return std::sqrt(2 * force / (kPi * modulus * slope));
}
double Cone::approach(double force) const { return 0.5 * kPi * slope * contact_radius(force); }

double AdhesiveSphere::jkr_force(double a) const {
  return 4 * modulus * cube(a) / (3 * radius) - std::sqrt(8 * kPi * work * modulus * cube(a));
}
double AdhesiveSphere::jkr_approach(double a) const {
  return square(a) / radius - std::sqrt(2 * kPi * work * a / modulus);
}
double AdhesiveSphere::jkr_pull_off() const { return -1.5 * kPi * work * radius; }
double AdhesiveSphere::dmt_force(double a) const {
  return 4 * modulus * cube(a) / (3 * radius) - 2 * kPi * work * radius;
}
double AdhesiveSphere::dmt_pull_off() const { return -2 * kPi * work * radius; }
double AdhesiveSphere::tabor(double range) const {
  return std::cbrt(radius * square(work) / (square(modulus) * cube(range)));
}

}  // namespace papilla::contact
