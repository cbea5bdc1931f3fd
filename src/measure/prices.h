// The price that is announced (`measured_seconds`) against what an evaluation takes, on designs
// drawn from all that is legal.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"

namespace papilla::measure {

struct PriceRow {
  int design = 0;
  std::string texture, status;  // what the answer says beside its numbers
  bool sound = true;
  double announced = 0, taken = 0;  // [s] of one core
  std::string numbers;              // that were drawn: "texture.period=3.2e-06 ..."
  double ratio() const { return taken / announced; }
};

struct PriceOptions {
  int designs = 300, first = 0;
  std::function<void(const PriceRow&)> done;  // after each; may be empty
};

// A legal design at draft: of every kind of texture whose numbers say all of it in turn, with about
// a third of its numbers drawn from their whole range, by ratio where that spans decades. What
// contradicts itself is drawn again.
Design legal_design(int index);

// One thread; processor time, so that other load on the machine counts little.
std::vector<PriceRow> prices_of(const PriceOptions& options);

}  // namespace papilla::measure
