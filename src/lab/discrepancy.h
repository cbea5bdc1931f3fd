// What no member explains, and where: a common shift of some of the readings, each place against
// the chance that there is none. Eq. lab.10
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/evidence.h"

namespace papilla::lab {

// Some of the readings, for people: "of front/02", "at 75 % RH", "under voltage".
struct Somewhere {
  std::string name;
  std::vector<std::size_t> readings;
};

struct Discrepancy {
  std::string where;
  double probability = 0;           // that the model is wrong there, and nowhere else
  double shift = 0, deviation = 0;  // of the logarithm of friction there, if so
  // The same as shares of the friction: 0.5 is half more.
  double change() const;
  double change_deviation() const;
};

struct Discrepancies {
  double none = 1;                 // probability that the members explain all readings
  double misfit = 0;               // chi squared per reading at the weights after them
  std::vector<Discrepancy> found;  // most probable first
};

// size: standard deviation of a shift, where there is one, before the readings.
Discrepancies discrepancies(const Ensemble& ensemble, const Evidence& evidence,
                            const std::vector<Somewhere>& places, double size);

}  // namespace papilla::lab
