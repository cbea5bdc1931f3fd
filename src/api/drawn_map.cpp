#include "api/drawn_map.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "api/inside.h"
#include "geometry/io/files.h"

namespace papilla::api {
namespace {

namespace fs = std::filesystem;

std::string new_file() {
  static std::atomic<int> count = 0;
  return (fs::temp_directory_path() / fmt::format("papilla-{}-{}.npy", ::getpid(), ++count))
      .string();
}

void require_square(const Heights& h) {
  const auto refuse = [](const std::string& message) { throw wrong("heights", message); };
  if (h.nx != h.ny || std::abs(h.dx - h.dy) > 1e-9 * h.dx)
    refuse(
        fmt::format("expected square pixels on a square, got {} x {} pixels of {:.4g} x {:.4g} "
                    "um",
                    h.nx, h.ny, 1e6 * h.dx, 1e6 * h.dy));
  if (h.nx < 8) refuse(fmt::format("expected 8 x 8 pixels at least, got {0} x {0}", h.nx));
  if (!std::all_of(h.z.begin(), h.z.end(), [](double z) { return std::isfinite(z); }))
    refuse("expected finite heights");
}

}  // namespace

DrawnMap::DrawnMap(Heights heights)
    : heights_(std::move(heights)), file_(new_file()), maker_(::getpid()) {
  const Heightmap map = heightmap_of(heights_);
  require_square(heights_);
  write_npy(file_, map);
}

DrawnMap::~DrawnMap() {
  if (::getpid() != maker_) return;  // a fork of it, whose parent still reads the file
  std::error_code ignored;           // a folder that someone else has emptied
  fs::remove(file_, ignored);
}

}  // namespace papilla::api
