#include "base/units.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "base/constants.h"
#include "base/error.h"

namespace papilla::base {
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
    Base{"m", kLength, true},   Base{"N", kForce, true},        Base{"Pa", kPressure, true},
    Base{"V", kVoltage, true},  Base{"s", kTime, true},         Base{"Hz", kFrequency, true},
    Base{"A", kCurrent, true},  Base{"ohm", kResistance, true}, Base{"F", kCapacitance, true},
    Base{"J", kEnergy, true},   Base{"g", kMass, true},         Base{"rad", kAngle, true},
    Base{"deg", kAngle, false}, Base{"min", kTime, false},      Base{"h", kTime, false},
    Base{"%", Unit{}, false},
};
struct Prefix {
  const char* symbol;
  double factor;
};
constexpr std::array kPrefixes{Prefix{"", 1},          Prefix{"f", 1e-15}, Prefix{"p", 1e-12},
                               Prefix{"n", 1e-9},      Prefix{"u", 1e-6},  Prefix{"µ", 1e-6},
                               Prefix{"\u03bc", 1e-6}, Prefix{"m", 1e-3},  Prefix{"c", 1e-2},
                               Prefix{"k", 1e3},       Prefix{"M", 1e6},   Prefix{"G", 1e9},
                               Prefix{"T", 1e12}};

std::optional<Unit> simple_unit(std::string_view name) {
  for (const Base& base : kBases) {
    for (const Prefix& prefix : kPrefixes) {
      if (*prefix.symbol && !base.prefixes) continue;
      if (const std::string_view before = prefix.symbol;
          name.starts_with(before) && name.substr(before.size()) == base.symbol) {
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
  Unit unit{std::pow(base->to_si, exponent), base->metre * exponent,  base->kilogram * exponent,
            base->second * exponent,         base->ampere * exponent, base->radian * exponent};
  return unit;
}

}  // namespace

std::vector<std::string> unit_names(const Unit& like) {
  std::vector<std::string> out;
  for (const Base& base : kBases) {
    for (const Prefix& prefix : kPrefixes) {
      if (!base.unit.same_dimension(like) || (*prefix.symbol && !base.prefixes)) continue;
      out.push_back(std::string(prefix.symbol) + base.symbol);
    }
  }
  return out;
}

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

namespace {

struct Dimension {
  Unit unit;  // of factor 1
  const char *name, *si;
};
const std::vector<Dimension>& dimensions() {
  static const std::vector<Dimension> list{
      {Unit{}, "a plain number or a percentage", ""},
      {kLength, "a length", "m"},
      {Unit{1, 2, 0, 0, 0, 0}, "an area", "m2"},
      {Unit{1, 3, 0, 0, 0, 0}, "a volume", "m3"},
      {Unit{1, -1, 0, 0, 0, 0}, "an inverse length", "1/m"},
      {kForce, "a force", "N"},
      {kPressure, "a pressure", "Pa"},
      {kVoltage, "a voltage", "V"},
      {kTime, "a time", "s"},
      {kFrequency, "a frequency", "Hz"},
      {kCurrent, "a current", "A"},
      {kResistance, "a resistance", "ohm"},
      {kCapacitance, "a capacitance", "F"},
      {kEnergy, "an energy", "J"},
      {kAngle, "an angle", "rad"},
      {Unit{1, 0, 1, -2, 0, 0}, "a surface tension", "N/m"},
      {Unit{1, 3, 1, -3, -2, 0}, "a resistivity", "ohm m"},
      {Unit{1, 1, 1, -3, -1, 0}, "an electric field", "V/m"},
      {Unit{1, -3, 0, 0, 0, 0}, "a number per volume", "1/m3"},
  };
  return list;
}

const Dimension* find_dimension(const Unit& unit) {
  for (const Dimension& known : dimensions()) {
    if (known.unit.same_dimension(unit)) return &known;
  }
  return nullptr;
}

}  // namespace

std::string dimension_name(const Unit& unit) {
  const Dimension* known = find_dimension(unit);
  return known ? known->name : "another kind of quantity";
}

std::string si_name(const Unit& unit) {
  if (const Dimension* known = find_dimension(unit)) return known->si;
  std::string out;
  for (const auto& [symbol, power] : {std::pair{"m", unit.metre},
                                      {"kg", unit.kilogram},
                                      {"s", unit.second},
                                      {"A", unit.ampere},
                                      {"rad", unit.radian}}) {
    if (power != 0) out += fmt::format("{}{}{}", out.empty() ? "" : " ", symbol, power);
  }
  return out;
}

namespace {

// The exponent when a unit is a power of ten times SI ("um": -6): such values convert exactly.
std::optional<int> decade(const Unit& unit) {
  const double exponent = std::round(std::log10(unit.to_si));
  if (std::abs(unit.to_si / std::pow(10.0, exponent) - 1) > 1e-13) return std::nullopt;
  return static_cast<int>(exponent);
}

// Decimal digits and exponent: value = 0.d1d2d3... x 10^exponent.
struct Decimal {
  std::string_view sign;  // "-" or ""
  std::string digits;
  int exponent = 0;
};

Decimal shortest_decimal(double value) {
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::scientific)
                       .ptr;
  const std::string text(buffer.data(), end);
  Decimal out;
  const std::size_t e = text.find('e');
  for (char c : text.substr(0, e)) {
    if (c == '-') out.sign = "-";
    if (c >= '0' && c <= '9') out.digits += c;
  }
  out.exponent = std::atoi(text.c_str() + e + 1) + 1;
  return out;
}

std::string decimal_text(const Decimal& d) {
  const int n = static_cast<int>(d.digits.size());
  if (d.digits == "0") return fmt::format("{}0", d.sign);
  if (d.exponent > 15 || d.exponent < -4 || d.exponent - n > 6) {
    return fmt::format("{}{}{}{}e{}", d.sign, d.digits.substr(0, 1), n > 1 ? "." : "",
                       d.digits.substr(1), d.exponent - 1);
  }
  if (d.exponent <= 0) return fmt::format("{}0.{:0>{}}", d.sign, d.digits, n - d.exponent);
  if (d.exponent >= n) return fmt::format("{}{:0<{}}", d.sign, d.digits, d.exponent);
  return fmt::format("{}{}.{}", d.sign, d.digits.substr(0, d.exponent),
                     d.digits.substr(d.exponent));
}

// The written number in SI: shifting its decimal point first rounds once, so "350 nm" is 350e-9.
double to_si(std::string_view number, double value, const Unit& unit) {
  const auto power = decade(unit);
  if (!power) return value * unit.to_si;
  const std::size_t e = number.find_first_of("eE");
  int exponent = *power;
  if (e != std::string_view::npos) exponent += std::atoi(std::string(number.substr(e + 1)).c_str());
  return std::strtod(fmt::format("{}e{}", number.substr(0, e), exponent).c_str(), nullptr);
}

}  // namespace

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
  const std::string_view number = text.substr(0, static_cast<std::size_t>(end - text.data()));
  const double si = to_si(number, value, *unit);
  if (!std::isfinite(si)) return std::nullopt;
  return Quantity{value, std::string(unit_text), si};
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

BareNumber bare_number(double value, const std::string& unit) {
  // Without the last bits of the factor: 0.07 is 7 %.
  const auto scaled = [value](double by) {
    return format_number(std::strtod(fmt::format("{:.12g}", value * by).c_str(), nullptr));
  };
  // 0.05 may be a share of one or of a hundred: both are shown, and what each means.
  if (unit == "%" && value > 0 && value <= 1)
    return {true, fmt::format(
                      "needs a unit: \"{} %\" if {} is a share of 1, \"{} %\" if it is in percent",
                      scaled(100), format_number(value), format_number(value))};
  // 5000 in a key of kHz may be in Hz, 3e-6 in one of um in m: both are shown, too.
  const std::string whole = unit.substr(1);
  const double factor = find_unit(unit)->to_si;
  const auto base = find_unit(whole);
  const bool other = !whole.empty() && base && base->to_si == 1 &&
                     base->same_dimension(*find_unit(unit)) &&
                     (factor > 1 ? value >= factor : value > 0 && value <= 1e3 * factor);
  if (!other)
    return {false, fmt::format("needs a unit, e.g. \"{} {}\"", format_number(value), unit)};
  return {true, fmt::format("needs a unit: \"{} {}\" if {} is in {}, \"{} {}\" if it is in {}",
                            scaled(1 / factor), unit, format_number(value), whole,
                            format_number(value), unit, unit)};
}

std::string format_number(double value) {
  return std::isfinite(value) ? decimal_text(shortest_decimal(value)) : fmt::format("{}", value);
}

std::string format_quantity(double si, std::string_view unit) {
  if (unit.empty()) return format_number(si);
  const auto known = find_unit(unit);
  if (!known || !std::isfinite(si)) return fmt::format("{} {}", format_number(si), unit);
  if (const auto power = decade(*known)) {
    Decimal d = shortest_decimal(si);
    d.exponent -= *power;
    return fmt::format("{} {}", decimal_text(d), unit);
  }
  // Degrees, minutes: the shortest text that comes back to the same double.
  const double value = si / known->to_si;
  for (int digits = 6; digits <= 17; ++digits) {
    const double candidate = std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
    if (candidate * known->to_si == si) {
      return fmt::format("{} {}", format_number(candidate), unit);
    }
  }
  for (const double next : {std::nextafter(value, -INFINITY), std::nextafter(value, INFINITY)}) {
    if (next * known->to_si == si) return fmt::format("{} {}", format_number(next), unit);
  }
  if (known->same_dimension(kAngle)) return format_number(si) + " rad";
  return fmt::format("{} {}", format_number(value), unit);
}

}  // namespace papilla::base
