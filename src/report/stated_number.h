// A number that a run states, with what is behind it. Texts of the first screen carry it
// until they are written, so that the page, run.json and receipts.json have one list of them.
#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/protocol.h"

namespace papilla::report {

// One standard error in the unit of its number, or why there is none.
struct StatedError {
  std::optional<double> size;
  std::string absent;

  bool operator==(const StatedError&) const = default;
};

struct StatedNumber {
  std::string words;                                        // what the number is of
  double value = std::numeric_limits<double>::quiet_NaN();  // NaN: it is no single number
  std::string unit;                                         // of the value
  StatedError numerical, model;
  std::vector<Stage> rests_on;  // whose answers it is made of, besides those of the search
};

// The text of a number, which carries what is behind it.
std::string stated(const StatedNumber& number, const std::string& text);
// A number of a JSON value, which carries what is behind it as text until as_read() makes it a
// number again.
std::string stated_value(const StatedNumber& number);

// A text in its parts: numbers with what is behind them, and the words between.
struct TextPart {
  std::string text;
  std::optional<StatedNumber> number;
};
std::vector<TextPart> said_parts(const std::string& text);

// As people read it.
std::string as_read(const std::string& text);
nlohmann::ordered_json as_read(const nlohmann::ordered_json& json);

}  // namespace papilla::report
