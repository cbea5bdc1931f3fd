// EXR of many pixels by the exporter (written, read back, compared, on the disk) against
// OpenImageIO's own write of the same floats with the same compression: ninja -C build
// export_bench; build/tests/export_bench [PIXELS [RUNS]].
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "geometry/io/files.h"
#include "geometry/texture.h"

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

int main(int argc, char** argv) {
  const int pixels = argc > 1 ? std::atoi(argv[1]) : 8192;
  const int runs = argc > 2 ? std::atoi(argv[2]) : 3;
  papilla::HoleArray holes;
  holes.wall_angle = 1.2;
  const papilla::Texture texture{holes};
  const papilla::Heightmap h =
      papilla::generate(texture, papilla::patch_grid(texture, pixels, 240e-6));
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "papilla-export-bench";
  std::filesystem::create_directories(folder);
  double ours = 1e300, theirs = 1e300;
  for (int run = 0; run < runs; ++run) {
    auto begin = std::chrono::steady_clock::now();
    papilla::write_exr((folder / "ours.exr").string(), h, {});
    ours = std::min(ours, seconds_since(begin));

    std::vector<float> floats(h.z.size());
    for (std::size_t i = 0; i < floats.size(); ++i) floats[i] = static_cast<float>(1e6 * h.z[i]);
    begin = std::chrono::steady_clock::now();
    OIIO::ImageSpec spec(h.grid.nx, h.grid.ny, 1, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    const auto out = OIIO::ImageOutput::create("a.exr");
    if (!out || !out->open((folder / "theirs.exr").string(), spec) ||
        !out->write_image(OIIO::TypeDesc::FLOAT, floats.data()) || !out->close()) {
      std::fprintf(stderr, "OpenImageIO: %s\n", OIIO::geterror().c_str());
      return 1;
    }
    theirs = std::min(theirs, seconds_since(begin));
  }
  std::printf("%d x %d: exporter %.2f s, OpenImageIO's write %.2f s, ratio %.2f\n", h.grid.nx,
              h.grid.ny, ours, theirs, ours / theirs);
  std::filesystem::remove_all(folder);
  return 0;
}
