// What the pages hold of designs, fields and files, as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"
#include "design/design.h"

namespace papilla::report {

constexpr int kPicturePixels = 128;  // across one picture, at most

// Values as bytes between low and high, averaged down to kPicturePixels.
nlohmann::ordered_json picture_json(const Grid& grid, const std::vector<double>& values);

// The folder of one design of a run: its numbers, its file, its heights; with_flat: also the plan
// and the surface without texture.
nlohmann::ordered_json design_json(const Folder& folder, bool with_flat);

// {"heights", "section", "measures"}: what the pictures of a texture are made of.
nlohmann::ordered_json shape_json(const Texture& texture);

// Gap, pressure, pull and water of one patch at a humidity. Cost: that patch.
nlohmann::ordered_json maps_json(const Design& design, const Fidelity& fidelity,
                                 double relative_humidity);
// The same at each humidity, at the design's own accuracy.
nlohmann::ordered_json field_json(const Design& design);

// Name, size and digest of every lasting file of a folder (sums.h).
nlohmann::ordered_json file_list(const Folder& folder);

}  // namespace papilla::report
