// What nearly every file of the library includes, compiled once (cmake/modules.cmake). Files
// include what they use all the same: preset dev builds without this. Not nlohmann/json.hpp:
// whatever is compiled after it takes the compiler a second more, and few files read or write JSON.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>
