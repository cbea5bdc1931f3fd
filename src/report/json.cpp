#include "report/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace papilla::report {

nlohmann::ordered_json json_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return value;
}

nlohmann::ordered_json json_number(const std::optional<double>& value) {
  if (!value) return nullptr;
  return json_number(*value);
}

}  // namespace papilla::report
