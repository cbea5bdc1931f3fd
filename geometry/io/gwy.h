// Gwyddion's own files, and its converter for those of other instruments (internal to geometry/io).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "base/rooms.h"
#include "geometry/io/height_rows.h"

namespace papilla::geometry {

// What the converter made of the file `path`: it fills what the instrument did not measure and
// marks it, and that is no number.
std::unique_ptr<HeightRows> converted_gwy_rows(const std::string& path, std::string bytes,
                                               const std::string& channel);
// Maps in a file of Gwyddion's.
std::size_t count_of_gwy_maps(const std::string& path, std::string_view bytes);

// Any other file by Gwyddion, where it is installed: in a child of its own with the numbers of the
// C locale, at most 60 s and 4 GB, whose result is read by our own reader. The channels of its
// result are counted again after a second conversion. Throws InputError, also where Gwyddion is not
// there.
std::unique_ptr<HeightRows> open_by_gwyddion(const std::string& path, const std::string& channel);

}  // namespace papilla::geometry
