// EXR of many pixels by the exporter (checked, written, read back, compared, on the disk) against
// OpenImageIO's own write of the same pixels with the same compression, in pairs whose order
// alternates: ninja -C build/release export_bench; build/release/bench/export_bench [PIXELS
// [PAIRS]].
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/io/files.h"
#include "geometry/texture.h"
#include "tests/temporary.h"

namespace {

struct Cost {
  double wall = 0, processor = 0;  // s
};

template <typename Work>
Cost cost_of(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
          static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC};
}

[[noreturn]] void stop(const std::string& why) {
  std::fprintf(stderr, "OpenImageIO: %s\n", why.c_str());
  std::exit(1);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const int pixels = argc > 1 ? std::atoi(argv[1]) : 8192;
  const int pairs = argc > 2 ? std::atoi(argv[2]) : 7;
  papilla::tests::HoleArray holes;
  holes.wall_angle = 1.2;
  const papilla::tests::Texture texture{holes};
  const papilla::tests::Heightmap h =
      papilla::tests::generate(texture, papilla::tests::patch_grid(texture, pixels, 240e-6));
  const std::filesystem::path folder = papilla::tests::temporary("");
  const std::string ours = folder / "ours.exr", theirs = folder / "theirs.exr";

  papilla::tests::write_exr(ours, h, {});
  std::vector<float> floats(h.z.size());
  const auto in = OIIO::ImageInput::open(ours);
  if (!in || !in->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, floats.data()))
    stop(OIIO::geterror());
  const auto write_theirs = [&] {
    OIIO::ImageSpec spec(h.grid.nx, h.grid.ny, 1, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", in->spec().get_string_attribute("compression"));
    const auto out = OIIO::ImageOutput::create("a.exr");
    if (!out || !out->open(theirs, spec) ||
        !out->write_image(OIIO::TypeDesc::FLOAT, floats.data()) || !out->close()) {
      stop(OIIO::geterror());
    }
  };
  std::vector<double> walls, processors;
  for (int pair = 0; pair < pairs; ++pair) {
    Cost a, b;
    if (pair % 2 == 0) a = cost_of([&] { papilla::tests::write_exr(ours, h, {}); });
    b = cost_of(write_theirs);
    if (pair % 2 == 1) a = cost_of([&] { papilla::tests::write_exr(ours, h, {}); });
    std::printf("exporter %.2f s (processor %.2f s), OpenImageIO's write %.2f s (%.2f s)\n", a.wall,
                a.processor, b.wall, b.processor);
    walls.push_back(a.wall / b.wall);
    processors.push_back(a.processor / b.processor);
  }
  const auto [low, high] = std::minmax_element(walls.begin(), walls.end());
  std::printf("%d x %d, %d pairs: ratio %.2f (%.2f to %.2f), of processor time %.2f; %.1f MB\n",
              h.grid.nx, h.grid.ny, pairs, median(walls), *low, *high, median(processors),
              1e-6 * static_cast<double>(std::filesystem::file_size(ours)));
  std::filesystem::remove_all(folder);
  return 0;
}
