// Numbers of the JSON that this program writes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "base/rooms.h"

namespace papilla::report {

// null for what JSON cannot say: infinity and NaN; and for what there is not.
nlohmann::ordered_json json_number(double value);
nlohmann::ordered_json json_number(const std::optional<double>& value);

}  // namespace papilla::report
