#include "papilla/units.h"

#include "api/inside.h"
#include "base/units.h"

namespace papilla::api {

double in_si(const std::string& text, const std::string& unit) {
  return across([&] { return parse_si(text, unit); });
}

std::string quantity_text(double si, const std::string& unit) {
  return across([&] {
    if (!find_unit(unit)) throw wrong("unit", "no unit \"" + unit + "\" is known");
    return format_quantity(si, unit);
  });
}

}  // namespace papilla::api
