// What surfaces of Gaussian heights have in common.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"

namespace papilla::geometry {

// what: the kind for people, "etched glass"; rough: its scales, where they are known in closed
// form.
TextureFacts gaussian_facts(double rms, const std::string& what, std::vector<RoughScale> rough,
                            bool quick_look);
Roles gaussian_roles(double& rms);

}  // namespace papilla::geometry
