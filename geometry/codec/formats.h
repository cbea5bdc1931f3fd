// Image files by our own readers and writers: the module papilla_images.so of permissive builds, as
// OpenImageIO's package stands on libraries under the GPL (docs/how_to/packages.md). PNG and TIFF
// need zlib alone, EXR is OpenEXR's. What goes wrong inside is a std::exception; the bases below
// turn it into the texts of geometry/io/codec.h.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geometry/io/codec.h"

namespace papilla::geometry {

class FormatOut : public ImageOut {
 public:
  std::string write(int begin, int end, const void* rows) final;
  std::string close() final;

 protected:
  // From the top and without gaps; every begin is a multiple of kRowsTogether.
  virtual void put(int begin, int end, const std::uint8_t* rows) = 0;
  virtual void finish() = 0;
};

class FormatIn : public ImageIn {
 public:
  const ImageSpec& spec() const final { return spec_; }
  std::optional<double> number(const std::string& attribute) const final;
  std::optional<float> single(const std::string& attribute) const final;
  std::string text(const std::string& attribute) const final;
  std::string read_rows(int begin, int end, Sample sample, void* rows) final;

 protected:
  // As the file has them, or F32 where that is Sample::Other.
  virtual void get(int begin, int end, std::uint8_t* rows) = 0;

  ImageSpec spec_;
  std::map<std::string, double> numbers_;
  std::map<std::string, float> singles_;
  std::map<std::string, std::string> texts_;
};

inline constexpr int kRowsTogether = 16;

std::unique_ptr<ImageOut> create_exr(const std::string& path, const ImageSpec& spec);
std::unique_ptr<ImageOut> create_png(const std::string& path, const ImageSpec& spec);
std::unique_ptr<ImageOut> create_tiff(const std::string& path, const ImageSpec& spec);
std::unique_ptr<ImageIn> open_exr(const std::string& path);
std::unique_ptr<ImageIn> open_png(const std::string& path);
std::unique_ptr<ImageIn> open_tiff(const std::string& path);

// --- For the formats ---

int bytes_of(Sample sample);              // 4 of Sample::Other
std::size_t row_bytes(const ImageSpec&);  // of all channels
// Its value, "" or null where the spec has none of the kind.
std::string text_of(const ImageSpec& spec, const std::string& name);
const float* single_of(const ImageSpec& spec, const std::string& name);

// Each sample of `size` bytes turned round.
void swap_bytes(std::uint8_t* samples, std::size_t count, int size);
// zlib's form. Throws std::runtime_error where `packed` is not `size` bytes.
std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> plain);
std::vector<std::uint8_t> inflated(std::span<const std::uint8_t> packed, std::size_t size);

}  // namespace papilla::geometry
