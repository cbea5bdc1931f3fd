// That a file is read again before the old one goes: by the bytes that the process has read.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/random.h"
#include "geometry/io/files.h"
#include "geometry/io/layout.h"
#include "tests/temporary.h"

namespace papilla::tests::read_back_test {
namespace {

// Of all its files so far.
std::uint64_t bytes_read() {
  std::ifstream io("/proc/self/io");
  std::string name;
  std::uint64_t bytes = 0;
  io >> name >> bytes;
  EXPECT_EQ(name, "rchar:");
  return bytes;
}

// Twenty strips of noise, which hardly gets smaller: a sixteenth of it would be three of them.
TEST(ReadBack, OfAnImageOfAFewPixelsIsWhole) {
  const Grid grid{64, 2560, 1e-6, 40e-6};
  RandomStream random(1, "noise that is read back", 0);
  Heightmap noise{grid, std::vector<double>(grid.size())};
  for (double& z : noise.z) z = 1e-7 * random.uniform();
  const std::string exr = temporary("noise.exr"), png = temporary("noise.png");
  write_exr(exr, noise, {});  // what images need is loaded
  for (const bool grey : {false, true}) {
    const std::uint64_t before = bytes_read();
    grey ? write_png16(png, noise) : write_exr(exr, noise, {});
    const std::uint64_t size = std::filesystem::file_size(grey ? png : exr);
    ASSERT_GT(size, (grey ? 1 : 2) * grid.size());  // of 2 and 4 bytes a pixel
    EXPECT_GE(bytes_read() - before, size) << grey;
  }
}

}  // namespace
}  // namespace papilla::tests::read_back_test
