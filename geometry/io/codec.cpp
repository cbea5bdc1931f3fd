#include "geometry/io/codec.h"

#include <stdexcept>

#include "base/memory.h"
#include "base/module.h"
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
    return static_cast<const ImageCodec*>(
        load_module("images", kCodecInterface, "read or write images"));
  }();
  return *codec;
}

}  // namespace papilla::geometry
