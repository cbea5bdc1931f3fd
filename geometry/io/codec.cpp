#include "geometry/io/codec.h"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

#include "base/installation.h"
#include "base/memory.h"
#include "geometry/io/files.h"

namespace papilla::geometry {
void require_images() { image_codec(); }

const ImageCodec& image_codec() {
  static const ImageCodec* codec = [] {
    // Its hundred libraries do not survive it if they find too little; VmPeak grows by 460 MB.
    constexpr std::size_t kAddressSpace = 480u << 20;
    if (!has_address_space(kAddressSpace)) {
      throw std::runtime_error(
          "cannot read or write images: the image library takes 480 MB of addresses, which are not "
          "free (ulimit -v)");
    }
    // Never unloaded: its threads and statics live as long as the program.
    const std::string path = find_module("papilla_images.so").string();
    void* module = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* entry = module ? dlsym(module, "papilla_image_codec") : nullptr;
    if (!entry) {
      throw std::runtime_error(std::string("cannot read or write images: ") + dlerror() +
                               "; build or install Papilla anew: the module belongs to it");
    }
    const ImageCodec* loaded = reinterpret_cast<const ImageCodec* (*)(int)>(entry)(kCodecInterface);
    if (!loaded) {
      throw std::runtime_error("cannot read or write images: " + path +
                               " is of another version; build or install Papilla anew");
    }
    return loaded;
  }();
  return *codec;
}

}  // namespace papilla::geometry
