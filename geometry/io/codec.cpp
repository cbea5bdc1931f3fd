#include "geometry/io/codec.h"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace papilla {

const ImageCodec& image_codec() {
  static const ImageCodec* codec = [] {
    // Found by the program's own search path (RUNPATH): the build folder, or lib/papilla beside
    // bin. Never unloaded: its threads and statics live as long as the program.
    void* module = dlopen("papilla_images.so", RTLD_LAZY | RTLD_LOCAL);
    void* entry = module ? dlsym(module, "papilla_image_codec") : nullptr;
    if (!entry) {
      throw std::runtime_error(std::string("cannot read or write images: ") + dlerror() +
                               "; build or install Papilla anew: the module belongs to it");
    }
    return reinterpret_cast<const ImageCodec* (*)()>(entry)();
  }();
  return *codec;
}

}  // namespace papilla
