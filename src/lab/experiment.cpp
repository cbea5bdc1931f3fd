#include "lab/experiment.h"

#include <fmt/format.h>

#include "base/text.h"

namespace papilla::lab {

std::string text(const Conditions& at) {
  std::string out = fmt::format("{} % RH, {} N", significant(100 * at.relative_humidity, 3),
                                significant(at.load, 3));
  if (at.driven()) {
    out += fmt::format(", {} V", significant(at.voltage, 4));
    if (at.frequency > 0) out += fmt::format(" at {} Hz", significant(at.frequency, 4));
  }
  return out + ", " + finger_state_names()[static_cast<std::size_t>(at.state)];
}

std::vector<std::string> design_names(const std::vector<LabDesign>& designs) {
  std::vector<std::string> out;
  for (const LabDesign& d : designs) out.push_back(d.name);
  return out;
}

}  // namespace papilla::lab
