#include "base/units.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "base/constants.h"
#include "base/error.h"

namespace papilla {
namespace {

struct NamedUnit {
  const char* name;
  Unit unit;
};

constexpr Unit kLength{1, 1, 0, 0, 0, 0};
constexpr Unit kForce{1, 1, 1, -2, 0, 0};
constexpr Unit kPressure{1, -1, 1, -2, 0, 0};
constexpr Unit kVoltage{1, 2, 1, -3, -1, 0};
constexpr Unit kTime{1, 0, 0, 1, 0, 0};
constexpr Unit kFrequency{1, 0, 0, -1, 0, 0};
constexpr Unit kCurrent{1, 0, 0, 0, 1, 0};
constexpr Unit kResistance{1, 2, 1, -3, -2, 0};
constexpr Unit kCapacitance{1, -2, -1, 4, 2, 0};
constexpr Unit kEnergy{1, 2, 1, -2, 0, 0};
constexpr Unit kMass{1, 0, 1, 0, 0, 0};
constexpr Unit kAngle{1, 0, 0, 0, 0, 1};

struct Base {
  const char* symbol;
  Unit unit;
  bool prefixes;
};
constexpr std::array kBases{
    Base{"m", kLength, true},       Base{"N", kForce, true},        Base{"Pa", kPressure, true},
    Base{"V", kVoltage, true},      Base{"s", kTime, true},         Base{"Hz", kFrequency, true},
    Base{"A", kCurrent, true},      Base{"ohm", kResistance, true}, Base{"F", kCapacitance, true},
    Base{"J", kEnergy, true},       Base{"g", kMass, true},         Base{"rad", kAngle, true},
    Base{"deg", kAngle, false},     Base{"min", kTime, false},      Base{"h", kTime, false},
    Base{"%", Unit{}, false},
};
struct Prefix {
  const char* symbol;
  double factor;
};
constexpr std::array kPrefixes{Prefix{"", 1},    Prefix{"f", 1e-15}, Prefix{"p", 1e-12}, Prefix{"n", 1e-9},
                               Prefix{"u", 1e-6}, Prefix{"µ", 1e-6},  Prefix{"m", 1e-3},  Prefix{"c", 1e-2},
                               Prefix{"k", 1e3},  Prefix{"M", 1e6},   Prefix{"G", 1e9},   Prefix{"T", 1e12}};

std::optional<Unit> simple_unit(std::string_view name) {
  for (const Base& base : kBases) {
    for (const Prefix& prefix : kPrefixes) {
      if (*prefix.symbol && !base.prefixes) continue;
      if (name == std::string(prefix.symbol) + base.symbol) {
        Unit unit = base.unit;
        unit.to_si = prefix.factor;
        const std::string_view symbol = base.symbol;
        if (symbol == "g") unit.to_si *= 1e-3;
        if (symbol == "deg") unit.to_si = kPi / 180;
        if (symbol == "min") unit.to_si = 60;
        if (symbol == "h") unit.to_si = 3600;
        if (symbol == "%") unit.to_si = 0.01;
        return unit;
      }
    }
  }
  return std::nullopt;
}

// name with an exponent: "um", "um2", "um^3", "mm²".
std::optional<Unit> factor_unit(std::string_view name) {
  if (name == "1") return Unit{};
  int exponent = 1;
  for (auto [suffix, power] : {std::pair{"²", 2}, {"³", 3}}) {
    if (name.ends_with(suffix)) {
      name.remove_suffix(std::string_view(suffix).size());
      exponent = power;
    }
  }
  if (exponent == 1 && name.size() > 1 && name.back() >= '2' && name.back() <= '4') {
    exponent = name.back() - '0';
    name.remove_suffix(1);
    if (name.ends_with('^')) name.remove_suffix(1);
  }
  auto base = simple_unit(name);
  if (!base) return std::nullopt;
  Unit unit{std::pow(base->to_si, exponent), base->metre * exponent, base->kilogram * exponent,
            base->second * exponent, base->ampere * exponent, base->radian * exponent};
  return unit;
}

}  // namespace

std::optional<Unit> find_unit(std::string_view name) {
  if (name.empty()) return Unit{};
  // factors separated by spaces or '*', one '/' at most: "ohm m", "mN/m", "1/um3"
  Unit result;
  int sign = 1;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= name.size(); ++i) {
    const char c = i < name.size() ? name[i] : '\0';
    if (c != ' ' && c != '*' && c != '/' && c != '\0') continue;
    if (i == start) return std::nullopt;
    auto factor = factor_unit(name.substr(start, i - start));
    if (!factor) return std::nullopt;
    result.to_si *= std::pow(factor->to_si, sign);
    result.metre += sign * factor->metre;
    result.kilogram += sign * factor->kilogram;
    result.second += sign * factor->second;
    result.ampere += sign * factor->ampere;
    result.radian += sign * factor->radian;
    if (c == '/') {
      if (sign < 0) return std::nullopt;
      sign = -1;
    }
    start = i + 1;
  }
  return result;
}

std::string dimension_name(const Unit& unit) {
  static const std::array<std::pair<Unit, const char*>, 19> names{{
      {Unit{}, "a plain number or a percentage"},
      {kLength, "a length"},
      {Unit{1, 2, 0, 0, 0, 0}, "an area"},
      {Unit{1, 3, 0, 0, 0, 0}, "a volume"},
      {Unit{1, -1, 0, 0, 0, 0}, "an inverse length"},
      {kForce, "a force"},
      {kPressure, "a pressure"},
      {kVoltage, "a voltage"},
      {kTime, "a time"},
      {kFrequency, "a frequency"},
      {kCurrent, "a current"},
      {kResistance, "a resistance"},
      {kCapacitance, "a capacitance"},
      {kEnergy, "an energy"},
      {kAngle, "an angle"},
      {Unit{1, 0, 1, -2, 0, 0}, "a surface tension"},
      {Unit{1, 3, 1, -3, -2, 0}, "a resistivity"},
      {Unit{1, 1, 1, -3, -1, 0}, "an electric field"},
      {Unit{1, -3, 0, 0, 0, 0}, "a number per volume"},
  }};
  for (const auto& [known, name] : names) {
    if (known.same_dimension(unit)) return name;
  }
  return "another kind of quantity";
}

std::optional<Quantity> parse_quantity(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  std::string_view unit_text(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (!unit_text.empty() && unit_text.front() == ' ') unit_text.remove_prefix(1);
  const auto unit = find_unit(unit_text);
  if (!unit) return std::nullopt;
  return Quantity{value, std::string(unit_text), value * unit->to_si};
}

double parse_si(std::string_view text, std::string_view unit) {
  const auto expected = find_unit(unit);
  const auto quantity = parse_quantity(text);
  const std::string example = fmt::format("write it like \"1 {}\"", unit);
  if (!quantity) {
    throw InputError(fmt::format("\"{}\" is not a number with a known unit; {}", text, example));
  }
  if (!find_unit(quantity->unit)->same_dimension(*expected)) {
    throw InputError(fmt::format("\"{}\" is {}, expected {}; {}", text,
                                 dimension_name(*find_unit(quantity->unit)),
                                 dimension_name(*expected), example));
  }
  return quantity->si;
}

std::string format_number(double value) { return fmt::format("{}", value); }

std::string format_quantity(double si, std::string_view unit) {
  const auto known = find_unit(unit);
  double value = si / (known ? known->to_si : 1);
  // Undo the rounding of the division: 3e-6 / 1e-6 should print as 3.
  const double rounded = std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr);
  if (std::abs(rounded - value) <= 4e-16 * std::abs(value) || rounded * (known ? known->to_si : 1) == si) {
    value = rounded;
  }
  return unit.empty() ? format_number(value) : fmt::format("{} {}", format_number(value), unit);
}

}  // namespace papilla
