#include "geometry/codec/formats.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace papilla::geometry {
namespace {

template <typename Work>
std::string trouble_of(const Work& work) {
  try {
    work();
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

// Integers are shares of their largest.
template <typename From, typename To>
To converted(From value) {
  const double share = std::is_integral_v<From>
                           ? static_cast<double>(value) / std::numeric_limits<From>::max()
                           : static_cast<double>(value);
  if constexpr (std::is_integral_v<To>) {
    const double kept = share > 0 ? std::min(share, 1.0) : 0;  // not a number: 0
    return static_cast<To>(std::lround(std::numeric_limits<To>::max() * kept));
  } else {
    return static_cast<To>(share);
  }
}

template <typename From, typename To>
void convert(const std::vector<std::uint8_t>& from, void* to) {
  auto* out = static_cast<To*>(to);
  for (std::size_t i = 0; i < from.size() / sizeof(From); ++i) {
    From value;
    std::memcpy(&value, &from[i * sizeof(From)], sizeof(From));
    out[i] = converted<From, To>(value);
  }
}

template <typename From>
void convert(const std::vector<std::uint8_t>& from, Sample sample, void* to) {
  if (sample == Sample::U8) return convert<From, std::uint8_t>(from, to);
  if (sample == Sample::U16) return convert<From, std::uint16_t>(from, to);
  convert<From, float>(from, to);
}

class Codec : public ImageCodec {
 public:
  std::unique_ptr<ImageOut> create(const std::string& path, const ImageSpec& spec,
                                   std::string& error) const override {
    std::unique_ptr<ImageOut> out;
    error = trouble_of([&] {
      const auto make = path.ends_with(".exr")   ? create_exr
                        : path.ends_with(".png") ? create_png
                                                 : create_tiff;
      out = make(path, spec);
    });
    return out;
  }

  std::unique_ptr<ImageIn> open(const std::string& path, const std::string& reader,
                                std::string& error) const override {
    std::unique_ptr<ImageIn> in;
    error = trouble_of([&] {
      const auto is = [&](const char* name, const char* ending) {
        return reader.empty() ? path.ends_with(ending) : reader == name;
      };
      const auto open = is("openexr", ".exr") ? open_exr : is("png", ".png") ? open_png : open_tiff;
      in = open(path);
    });
    return in;
  }
};

}  // namespace

std::string FormatOut::write(int begin, int end, const void* rows) {
  return trouble_of([&] { put(begin, end, static_cast<const std::uint8_t*>(rows)); });
}

std::string FormatOut::close() {
  return trouble_of([&] { finish(); });
}

std::optional<double> FormatIn::number(const std::string& attribute) const {
  const auto found = numbers_.find(attribute);
  return found == numbers_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<float> FormatIn::single(const std::string& attribute) const {
  const auto found = singles_.find(attribute);
  return found == singles_.end() ? std::nullopt : std::optional(found->second);
}

std::string FormatIn::text(const std::string& attribute) const {
  const auto found = texts_.find(attribute);
  return found == texts_.end() ? "" : found->second;
}

std::string FormatIn::read_rows(int begin, int end, Sample sample, void* rows) {
  return trouble_of([&] {
    const Sample own = spec_.sample == Sample::Other ? Sample::F32 : spec_.sample;
    if (own == sample) return get(begin, end, static_cast<std::uint8_t*>(rows));
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(end - begin) * row_bytes(spec_));
    get(begin, end, bytes.data());
    if (own == Sample::U8) return convert<std::uint8_t>(bytes, sample, rows);
    if (own == Sample::U16) return convert<std::uint16_t>(bytes, sample, rows);
    convert<float>(bytes, sample, rows);
  });
}

int bytes_of(Sample sample) { return sample == Sample::U8 ? 1 : sample == Sample::U16 ? 2 : 4; }

std::size_t row_bytes(const ImageSpec& spec) {
  return static_cast<std::size_t>(spec.width) * spec.channels.size() *
         static_cast<std::size_t>(bytes_of(spec.sample));
}

std::string text_of(const ImageSpec& spec, const std::string& name) {
  for (const auto& [key, value] : spec.attributes) {
    if (const auto* text = std::get_if<std::string>(&value); text && key == name) return *text;
  }
  return "";
}

const float* single_of(const ImageSpec& spec, const std::string& name) {
  for (const auto& [key, value] : spec.attributes) {
    if (const auto* single = std::get_if<float>(&value); single && key == name) return single;
  }
  return nullptr;
}

void swap_bytes(std::uint8_t* samples, std::size_t count, int size) {
  for (std::size_t i = 0; i < count; ++i, samples += size) std::reverse(samples, samples + size);
}

std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> plain) {
  uLongf size = compressBound(plain.size());
  std::vector<std::uint8_t> out(size);
  if (compress(out.data(), &size, plain.data(), plain.size()) != Z_OK)
    throw std::runtime_error("zlib does not compress");
  out.resize(size);
  return out;
}

std::vector<std::uint8_t> inflated(std::span<const std::uint8_t> packed, std::size_t size) {
  std::vector<std::uint8_t> out(size);
  uLongf found = size;
  if (uncompress(out.data(), &found, packed.data(), packed.size()) != Z_OK || found != size)
    throw std::runtime_error("the compressed data are damaged");
  return out;
}

}  // namespace papilla::geometry

// interface: of the program that asks; null: another one.
extern "C" const papilla::geometry::ImageCodec* papilla_image_codec(int interface) {
  static const papilla::geometry::Codec codec;
  return interface == papilla::geometry::kCodecInterface ? &codec : nullptr;
}
