#include "forward/measured.h"

#include <cmath>

#include "base/constants.h"

namespace papilla::forward {

double ErrorParts::total() const {
  double sum = sampling * sampling;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (origin.in_total) sum += square((this->*origin.part).value_or(0));
  }
  return std::sqrt(sum);
}

double ErrorParts::numerical() const {
  ErrorParts own = *this;
  own.parameters.reset();
  return own.total();
}

}  // namespace papilla::forward
