#include "physics/contact/facts.h"

#include <fmt/format.h>

#include <algorithm>

#include "fields/price.h"

namespace papilla::contact {

std::string contact_method(double tolerance) {
  return fmt::format("layered half-space, certified to {:g}", tolerance);
}

double contact_seconds(const Grid& grid, double tolerance) {
  return std::max(3.0, 3.3 * digits(tolerance) - 5) * fft_pair_seconds(grid);
}

double contact_error(double certificate) {
  constexpr double kSolverError = 5;  // Eq. accuracy.1
  return kSolverError * certificate;
}

}  // namespace papilla::contact
