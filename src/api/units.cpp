#include "papilla/units.h"

#include <optional>

#include "api/inside.h"
#include "base/units.h"

namespace papilla::api {
namespace {

Unit known_unit(const std::string& name) {
  const std::optional<Unit> unit = find_unit(name);
  if (!unit) throw wrong("unit", "no unit \"" + name + "\" is known");
  return *unit;
}

}  // namespace

double in_si(const std::string& text, const std::string& unit) {
  return across([&] { return parse_si(text, unit); });
}

std::string quantity_text(double si, const std::string& unit) {
  return across([&] {
    known_unit(unit);
    return format_quantity(si, unit);
  });
}

std::string si_unit(const std::string& unit) {
  return across([&] { return si_name(known_unit(unit)); });
}

}  // namespace papilla::api
