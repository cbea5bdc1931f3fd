// EXR, TIFF and PNG through OpenImageIO: the module papilla_images.so (geometry/io/codec.h).
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <vector>

#include "geometry/io/codec.h"

namespace papilla::geometry {
namespace {

OIIO::TypeDesc type_of(Sample sample) {
  switch (sample) {
    case Sample::U8:
      return OIIO::TypeDesc::UINT8;
    case Sample::U16:
      return OIIO::TypeDesc::UINT16;
    default:
      return OIIO::TypeDesc::FLOAT;
  }
}

Sample sample_of(const OIIO::TypeDesc& type) {
  if (type == OIIO::TypeDesc::UINT8) return Sample::U8;
  if (type == OIIO::TypeDesc::UINT16) return Sample::U16;
  return type == OIIO::TypeDesc::FLOAT ? Sample::F32 : Sample::Other;
}

class Out : public ImageOut {
 public:
  Out(std::unique_ptr<OIIO::ImageOutput> file, Sample sample)
      : file_(std::move(file)), type_(type_of(sample)) {}

  std::string write(int begin, int end, const void* rows) override {
    return file_->write_scanlines(begin, end, 0, type_, rows) ? "" : file_->geterror();
  }
  // close() alone may say true for a truncated file.
  std::string close() override {
    const bool closed = file_->close();
    const std::string error = file_->geterror();
    return error.empty() && !closed ? "incomplete" : error;
  }

 private:
  std::unique_ptr<OIIO::ImageOutput> file_;
  OIIO::TypeDesc type_;
};

class In : public ImageIn {
 public:
  In(std::unique_ptr<OIIO::ImageInput> file, const OIIO::ImageSpec& spec)
      : file_(std::move(file)), own_(spec) {
    spec_ = {spec.width, spec.height, spec.depth, {}, sample_of(spec.format)};
    spec_.whole = !spec.format.is_floating_point();
    for (int c = 0; c < spec.nchannels; ++c) {
      const auto i = static_cast<std::size_t>(c);
      spec_.channels.push_back(i < spec.channelnames.size() ? spec.channelnames[i] : "");
    }
  }

  const ImageSpec& spec() const override { return spec_; }
  std::optional<double> number(const std::string& attribute) const override {
    const OIIO::ParamValue* p = own_.find_attribute(attribute, OIIO::TypeDesc::DOUBLE);
    return p ? std::optional(*static_cast<const double*>(p->data())) : std::nullopt;
  }
  std::optional<float> single(const std::string& attribute) const override {
    const OIIO::ParamValue* p = own_.find_attribute(attribute, OIIO::TypeDesc::FLOAT);
    return p ? std::optional(*static_cast<const float*>(p->data())) : std::nullopt;
  }
  std::optional<int> whole(const std::string& attribute) const override {
    const OIIO::ParamValue* p = own_.find_attribute(attribute, OIIO::TypeDesc::INT);
    return p ? std::optional(*static_cast<const int*>(p->data())) : std::nullopt;
  }
  std::string text(const std::string& attribute) const override {
    return own_.get_string_attribute(attribute);
  }
  std::string read_rows(int begin, int end, Sample sample, void* rows) override {
    if (own_.tile_width > 0) return rows_of_tiles(begin, end, sample, static_cast<char*>(rows));
    return file_->read_scanlines(0, 0, own_.y + begin, own_.y + end, 0, 0, own_.nchannels,
                                 type_of(sample), rows)
               ? ""
               : file_->geterror();
  }

 private:
  // From the rows of tiles that hold them; the last one is kept, as rows are asked for in order.
  std::string rows_of_tiles(int begin, int end, Sample sample, char* rows) {
    const OIIO::TypeDesc type = type_of(sample);
    const std::size_t row = static_cast<std::size_t>(own_.width) *
                            static_cast<std::size_t>(own_.nchannels) * type.size();
    for (int y = begin; y < end;) {
      const int first = y - y % own_.tile_height;
      const int last = std::min(first + own_.tile_height, own_.height);
      if (first != band_first_ || sample != band_sample_) {
        band_.resize(row * static_cast<std::size_t>(last - first));
        band_first_ = -1;
        if (!file_->read_tiles(0, 0, own_.x, own_.x + own_.width, own_.y + first, own_.y + last, 0,
                               1, 0, own_.nchannels, type, band_.data()))
          return file_->geterror();
        band_first_ = first;
        band_sample_ = sample;
      }
      const int stop = std::min(last, end);
      std::copy_n(band_.data() + row * static_cast<std::size_t>(y - first),
                  row * static_cast<std::size_t>(stop - y),
                  rows + row * static_cast<std::size_t>(y - begin));
      y = stop;
    }
    return "";
  }

  std::unique_ptr<OIIO::ImageInput> file_;
  OIIO::ImageSpec own_;
  ImageSpec spec_;
  std::vector<char> band_;  // a row of tiles
  int band_first_ = -1;     // its first row
  Sample band_sample_ = Sample::Other;
};

class Codec : public ImageCodec {
 public:
  std::unique_ptr<ImageOut> create(const std::string& path, const ImageSpec& spec,
                                   std::string& error) const override {
    OIIO::ImageSpec own(spec.width, spec.height, static_cast<int>(spec.channels.size()),
                        type_of(spec.sample));
    if (!spec.channels.front().empty()) own.channelnames = spec.channels;
    // A PNG has one compression only and takes no word for it.
    if (!spec.compressed) own.attribute("compression", "none");
    if (spec.compressed && path.ends_with(".exr")) own.attribute("compression", "zip");
    for (const auto& [name, value] : spec.attributes) {
      if (const auto* number = std::get_if<double>(&value)) {
        own.attribute(name, OIIO::TypeDesc::DOUBLE, number);
      } else if (const auto* text = std::get_if<std::string>(&value)) {
        own.attribute(name, *text);
      } else if (const auto* single = std::get_if<float>(&value)) {
        own.attribute(name, *single);
      } else {
        own.attribute(name, std::get<int>(value));
      }
    }
    auto file = OIIO::ImageOutput::create(path);
    if (!file) {
      error = OIIO::geterror();
    } else if (!file->open(path, own)) {
      error = file->geterror();
    } else {
      return std::make_unique<Out>(std::move(file), spec.sample);
    }
    return nullptr;
  }

  std::unique_ptr<ImageIn> open(const std::string& path, const std::string& reader,
                                std::string& error) const override {
    auto file = OIIO::ImageInput::create(reader.empty() ? path : reader);
    OIIO::ImageSpec spec;
    if (!file) {
      error = OIIO::geterror();
    } else if (!file->open(path, spec)) {
      error = file->geterror();
    } else {
      return std::make_unique<In>(std::move(file), spec);
    }
    return nullptr;
  }
};

}  // namespace
}  // namespace papilla::geometry

extern "C" const papilla::geometry::ImageCodec* papilla_images(int version) {
  static const papilla::geometry::Codec codec;
  return version == papilla::geometry::kCodecInterface ? &codec : nullptr;
}
