#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/rooms.h"

namespace papilla::tests {

// The problems that work is refused for; none where it is not refused. Other exceptions pass.
std::vector<Problem> problems_of(const std::function<void()>& work);
// "key: message" of each, a line each.
std::string keyed_refusal_of(const std::function<void()>& work);
// What the refusal says as a whole; "" where there is none.
std::string refusal_of(const std::function<void()>& work);

}  // namespace papilla::tests
