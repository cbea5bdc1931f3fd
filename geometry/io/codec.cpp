#include "geometry/io/codec.h"

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "geometry/io/files.h"

namespace papilla {
namespace {

namespace fs = std::filesystem;

// Beside the program as it is built, above the programs of the tests, under lib as it is installed.
// By path, as the search path of a program is not asked where a sanitizer stands between.
std::string module_path() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {".", "..", "../lib/papilla"}) {
    if (place == std::string("..") && folder.filename() != "tests") continue;
    const fs::path path = folder / place / "papilla_images.so";
    if (fs::exists(path, error)) return path.lexically_normal().string();
  }
  return "papilla_images.so";  // wherever the system looks
}

}  // namespace

void require_images() { image_codec(); }

const ImageCodec& image_codec() {
  static const ImageCodec* codec = [] {
    // Never unloaded: its threads and statics live as long as the program.
    void* module = dlopen(module_path().c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* entry = module ? dlsym(module, "papilla_image_codec") : nullptr;
    if (!entry) {
      throw std::runtime_error(std::string("cannot read or write images: ") + dlerror() +
                               "; build or install Papilla anew: the module belongs to it");
    }
    const ImageCodec* loaded = reinterpret_cast<const ImageCodec* (*)(int)>(entry)(kCodecInterface);
    if (!loaded) {
      throw std::runtime_error("cannot read or write images: " + module_path() +
                               " is of another version; build or install Papilla anew");
    }
    return loaded;
  }();
  return *codec;
}

}  // namespace papilla
