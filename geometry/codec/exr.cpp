// EXR by OpenEXR: one plane of rows; half floats and whole numbers are read as floats.
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "geometry/codec/formats.h"

namespace papilla::geometry {
namespace {

// Rows from `begin` on, in memory at `rows`, as numbers of the file's own rows.
Imf::FrameBuffer frame(const ImageSpec& spec, const Imath::Box2i& window, int begin, void* rows) {
  Imf::FrameBuffer out;
  const std::size_t pixel = sizeof(float) * spec.channels.size();
  for (std::size_t c = 0; c < spec.channels.size(); ++c) {
    out.insert(spec.channels[c],
               Imf::Slice::Make(Imf::FLOAT, static_cast<char*>(rows) + c * sizeof(float),
                                Imath::V2i(window.min.x, window.min.y + begin), spec.width,
                                spec.height - begin, pixel, row_bytes(spec)));
  }
  return out;
}

Imf::Header header_of(const ImageSpec& spec) {
  if (spec.sample != Sample::F32) throw std::runtime_error("an EXR is written of floats alone");
  Imf::Header out(spec.width, spec.height);
  out.compression() = spec.compressed ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
  for (const std::string& name : spec.channels)
    out.channels().insert(name, Imf::Channel(Imf::FLOAT));
  for (const auto& [name, value] : spec.attributes) {
    const char* key = name == "DateTime" ? "capDate" : name.c_str();
    if (const auto* number = std::get_if<double>(&value)) {
      out.insert(key, Imf::DoubleAttribute(*number));
    } else if (const auto* text = std::get_if<std::string>(&value)) {
      out.insert(key, Imf::StringAttribute(*text));
    } else if (const auto* single = std::get_if<float>(&value)) {
      out.insert(key, Imf::FloatAttribute(*single));
    } else {
      out.insert(key, Imf::IntAttribute(std::get<int>(value)));
    }
  }
  return out;
}

class ExrOut : public FormatOut {
 public:
  ExrOut(const std::string& path, const ImageSpec& spec)
      : spec_(spec), file_(std::make_unique<Imf::OutputFile>(path.c_str(), header_of(spec))) {}

 private:
  void put(int begin, int end, const std::uint8_t* rows) override {
    // The library does not write to what it writes from.
    file_->setFrameBuffer(
        frame(spec_, file_->header().dataWindow(), begin, const_cast<std::uint8_t*>(rows)));
    file_->writePixels(end - begin);
  }
  void finish() override { file_.reset(); }

  ImageSpec spec_;
  std::unique_ptr<Imf::OutputFile> file_;
};

class ExrIn : public FormatIn {
 public:
  explicit ExrIn(const std::string& path) : file_(path.c_str()) {
    const Imf::Header& header = file_.header();
    const Imath::Box2i window = header.dataWindow();
    const auto side = [](int low, int high) {
      const std::int64_t length = std::int64_t{high} - low + 1;
      if (length < 1 || length > std::numeric_limits<int>::max())
        throw std::runtime_error("a side of no or too many pixels");
      return static_cast<int>(length);
    };
    spec_.width = side(window.min.x, window.max.x);
    spec_.height = side(window.min.y, window.max.y);
    spec_.channels.clear();
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
        throw std::runtime_error("a channel of fewer pixels than the others");
      spec_.channels.emplace_back(c.name());
      if (c.channel().type != Imf::FLOAT) spec_.sample = Sample::Other;
    }
    // By their names, but colours in the order in which everybody says them.
    const auto place = [](const std::string& name) {
      const std::size_t at = std::string("RGBA").find(name);
      return name.size() == 1 ? at : std::string::npos;
    };
    std::stable_sort(
        spec_.channels.begin(), spec_.channels.end(),
        [&](const std::string& a, const std::string& b) { return place(a) < place(b); });
    for (auto a = header.begin(); a != header.end(); ++a) {
      if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&a.attribute()))
        numbers_[a.name()] = number->value();
      if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&a.attribute()))
        singles_[a.name()] = single->value();
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()))
        texts_[a.name() == std::string("comments") ? "ImageDescription" : a.name()] = text->value();
    }
  }

 private:
  void get(int begin, int end, std::uint8_t* rows) override {
    const Imath::Box2i& window = file_.header().dataWindow();
    file_.setFrameBuffer(frame(spec_, window, begin, rows));
    file_.readPixels(window.min.y + begin, window.min.y + end - 1);
  }

  Imf::InputFile file_;
};

}  // namespace

std::unique_ptr<ImageOut> create_exr(const std::string& path, const ImageSpec& spec) {
  return std::make_unique<ExrOut>(path, spec);
}

std::unique_ptr<ImageIn> open_exr(const std::string& path) { return std::make_unique<ExrIn>(path); }

}  // namespace papilla::geometry
