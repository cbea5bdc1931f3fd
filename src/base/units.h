// Units at the borders: inside Papilla everything is SI double; files say "3 um".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/rooms.h"

namespace papilla::base {

// A unit is a factor to SI and the exponents of (m, kg, s, A, rad); equal exponents = same
// dimension.
struct Unit {
  double to_si = 1;
  int metre = 0, kilogram = 0, second = 0, ampere = 0, radian = 0;

  bool same_dimension(const Unit& other) const {
    return metre == other.metre && kilogram == other.kilogram && second == other.second &&
           ampere == other.ampere && radian == other.radian;
  }
};

// "um", "MPa", "uN", "ohm m", "um3", "mN/m", "1/m", "%", "" ...; nothing if unknown.
std::optional<Unit> find_unit(std::string_view name);
// Names of one factor, with every prefix, of the same dimension: "um", "nm", ... ; of a share "%".
std::vector<std::string> unit_names(const Unit& like);

// "a length", "a voltage", ...: for messages.
std::string dimension_name(const Unit& unit);
// Of its dimension in SI: "nm" -> "m", "deg" -> "rad", "%" -> ""; "m4", "kg1 s-3" of what has none.
std::string si_name(const Unit& unit);

struct Quantity {
  double value = 0;  // as written, not yet SI
  std::string unit;
  double si = 0;
};

// "350 nm" -> quantity; nothing when it is not "number unit" with a known unit. "15 %" -> si 0.15.
std::optional<Quantity> parse_quantity(std::string_view text);

// As above, but must have the dimension of `unit`; throws InputError with a message that says how
// to write it right. For command-line options and code.
double parse_si(std::string_view text, std::string_view unit);

// A number without a unit, of a key that has one (never ""): whether it may be meant otherwise than
// in that unit (0.15 of "%" as a share of 1, 6e-7 of "nm" in m), and how to write it ("needs a unit
// ...").
struct BareNumber {
  bool ambiguous = false;
  std::string advice;
};
BareNumber bare_number(double value, const std::string& unit);

// 3e-6 with "um" -> "3 um"; shortest text that reads back to the same double where possible.
std::string format_quantity(double si, std::string_view unit);
// Shortest decimal text that reads back exactly.
std::string format_number(double value);

}  // namespace papilla::base
