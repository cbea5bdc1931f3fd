// The pixels of a picture that was written, as OpenImageIO reads it.
#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::tests {

using Colour = std::array<int, 3>;

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top

  Colour at(int x, int row) const {
    const std::size_t k = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(x));
    return {rgb.at(k), rgb.at(k + 1), rgb.at(k + 2)};
  }
};

inline Pixels pixels_of(const std::string& path) {
  const auto file = OIIO::ImageInput::open(path);
  if (!file || file->spec().nchannels != 3) {
    ADD_FAILURE() << path << " is no picture in colours " << OIIO::geterror();
    return {};
  }
  Pixels out{file->spec().width, file->spec().height, {}};
  out.rgb.resize(3 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  EXPECT_TRUE(file->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, out.rgb.data()));
  return out;
}

}  // namespace papilla::tests
