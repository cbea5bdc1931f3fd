// EXR, TIFF and PNG read back, a strip of rows at a time.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/units.h"
#include "geometry/io/codec.h"
#include "geometry/io/files.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/raw.h"

namespace papilla::geometry {
namespace {

constexpr int kStripRows = 64;

[[noreturn]] void broken(const RegularFile& file, std::string why) {
  for (std::size_t at; (at = why.find(file.name())) != std::string::npos;)
    why.replace(at, file.name().size(), file.path());  // a library knows that name alone
  throw InputError("cannot read " + file.path() + ": " + why);
}

// OpenEXR makes room for what a header claims before it reads it: no attribute may be longer than
// the file. Throws InputError; what else is wrong with the file is for the library to say.
void check_exr_header(const RegularFile& image, bool any_size) {
  std::ifstream file = image.stream();
  const auto bytes = static_cast<std::int64_t>(image.bytes());
  std::array<unsigned char, 8> start{};
  file.read(reinterpret_cast<char*>(start.data()), start.size());
  if (!file || start[0] != 0x76 || start[1] != 0x2f || start[2] != 0x31 || start[3] != 0x01)
    broken(image, "no OpenEXR file");
  if (start[5] & 0x18) broken(image, "an OpenEXR file of several or deep parts");
  const auto word = [&] {
    std::array<unsigned char, 4> b{};
    file.read(reinterpret_cast<char*>(b.data()), b.size());
    return static_cast<std::int32_t>(b[0] | b[1] << 8 | b[2] << 16 |
                                     static_cast<unsigned>(b[3]) << 24);
  };
  const auto text = [&] {
    std::string out;
    for (int c; out.size() < 256 && (c = file.get()) > 0;) out += static_cast<char>(c);
    return out;
  };
  for (std::string name = text(); file && !name.empty(); name = text()) {
    const std::string type = text();
    const std::int32_t length = word();
    const std::int64_t at = file.tellg();
    if (!file || length < 0 || length > bytes - at) broken(image, "the header is cut off");
    if (!any_size && name == "dataWindow" && type == "box2i" && length == 16) {
      std::array<double, 4> box{};
      for (double& v : box) v = word();
      check_size(image.path(), box[2] - box[0] + 1, box[3] - box[1] + 1);
    }
    file.seekg(at + length);
  }
  if (!file) broken(image, "the header is cut off");
}

// The image behind a file, with the reader of its ending alone: others would be tried on a broken
// file.
std::unique_ptr<ImageIn> open_image(const RegularFile& file, bool any_size) {
  const std::string ending = lower_ending(file.path());
  if (ending == ".exr") check_exr_header(file, any_size);
  std::string why;
  auto in = image_codec().open(file.name(),
                               ending == ".exr"   ? "openexr"
                               : ending == ".png" ? "png"
                                                  : "tiff",
                               why);
  if (!in) broken(file, why);
  const ImageSpec& spec = in->spec();
  if (!any_size) check_size(file.path(), spec.width, spec.height);
  if (spec.depth != 1 || spec.channels.empty() || spec.channels.size() > 64)
    broken(file, "not a plane image of at most 64 channels");
  // Deflate packs 1032 to 1 at best: a header that claims much more is not worth its memory. Pixels
  // of one bit are read as of eight.
  const auto pixel_count = static_cast<double>(spec.width) * spec.height;
  const double most_per_byte = spec.sample == Sample::U8 ? 8 * 1032 : 2000;
  if (pixel_count > most_per_byte * static_cast<double>(file.bytes()))
    broken(file, "the data are cut off");
  return in;
}

// Sides by the tags that other programs take for the size [m].
void read_tags(const ImageIn& in, std::optional<double>& x, std::optional<double>& y) {
  const std::string unit = in.text("ResolutionUnit");
  const double metres = unit == "cm"                     ? 1e-2
                        : unit.starts_with("in")         ? 25.4e-3
                        : unit == "m" || unit == "meter" ? 1
                                                         : 0;
  const auto rx = in.single("XResolution"), ry = in.single("YResolution");
  if (metres > 0 && rx && ry && *rx > 0 && *ry > 0) {
    x = in.spec().width * metres / static_cast<double>(*rx);
    y = in.spec().height * metres / static_cast<double>(*ry);
  }
}

// The JSON in a description: all of it, or a line among those of other programs; empty: none.
std::string own_line(const std::string& description) {
  if (description.starts_with('{')) return description;
  for (const std::string& line : split(description, '\n')) {
    if (line.starts_with(kOwnLine)) return line.substr(kOwnLine.size());
  }
  return {};
}

// Names and values in the lines of a description before that.
std::map<std::string, std::string> imagej_lines(const std::string& description) {
  std::map<std::string, std::string> out;
  for (const std::string& line : split(description, '\n')) {
    if (line.starts_with(kOwnLine)) break;
    if (const std::size_t equals = line.find('='); equals != std::string::npos)
      out[line.substr(0, equals)] = line.substr(equals + 1);
  }
  return out;
}

class ImageRows : public HeightRows {
 public:
  ImageRows(const std::string& path, bool any_size)
      : file_(path), in_(open_image(file_, any_size)), spec_(in_->spec()) {
    const auto named = std::find(spec_.channels.rbegin(), spec_.channels.rend(), "Y");
    if (named != spec_.channels.rend())
      channel_ = static_cast<std::size_t>(spec_.channels.rend() - named) - 1;
    header_.nx = spec_.width;
    header_.ny = spec_.height;
    read_gwyddion_keys();
    const std::string description = in_->text("ImageDescription");
    header_.imagej = imagej_lines(description);
    const bool described = read_description(own_line(description));
    if (spec_.whole) {
      // The codec gives black as 0 and white as 1. Signed and wider numbers have no black and white
      // that any writer states: they are levels of an instrument.
      const bool grey = spec_.sample == Sample::U16 || spec_.sample == Sample::U8;
      if (!grey || (!described && !read_gwyddion_heights()))
        broken(file_,
               "an integer image without its height scale; multiply its levels by the height of "
               "one, and save a float image in um, a .gsf, or a .npy in m");
      header_.black = base_, header_.white = base_ + scale_;
      header_.step = std::abs(scale_) / (spec_.sample == Sample::U16 ? 65535 : 255);
    }
    read_tags(*in_, header_.tag_x, header_.tag_y);
    header_.photometric = in_->whole("tiff:PhotometricInterpretation");
    constexpr int kWhiteIsZero = 0;  // which the library turns round for some widths of numbers
    if (header_.photometric == kWhiteIsZero) {
      broken(file_,
             "its grey is inverted, 0 is white (PhotometricInterpretation 0, due 1): what is high "
             "and what is deep are not sure; save it with 0 as black");
    }
    header_.made = in_->text("Software").starts_with("papilla ");
  }

  void next(double* heights) override {
    const std::size_t width = static_cast<std::size_t>(spec_.width) * spec_.channels.size();
    const int in_strip = row_ % kStripRows;
    if (in_strip == 0) {
      const int end = std::min(row_ + kStripRows, spec_.height);
      strip_.resize(static_cast<std::size_t>(end - row_) * width);
      const std::string why = in_->read_rows(row_, end, Sample::F32, strip_.data());
      if (!why.empty()) broken(file_, why);
    }
    ++row_;
    const float* row = &strip_[static_cast<std::size_t>(in_strip) * width + channel_];
    for (int ix = 0; ix < spec_.width; ++ix, row += spec_.channels.size())
      heights[ix] = base_ + scale_ * static_cast<double>(*row);
  }

 private:
  double unit(const char* name, double otherwise) const {
    const auto known = find_unit(in_->text(name));
    const double u = known && known->same_dimension(*find_unit("m")) ? known->to_si : 0;
    return u > 0 ? u : otherwise;
  }
  void read_gwyddion_keys() {
    const auto x = in_->number("Gwy::XReal");
    if (!x) return;
    const double xy = unit("Gwy::XYUnit", 1);
    header_.lx = *x * xy;
    if (const auto y = in_->number("Gwy::YReal")) header_.ly = *y * xy;
    scale_ = unit("Gwy::ZUnit", 1e-6);
  }
  // Of a PNG the keys are texts.
  bool read_gwyddion_heights() {
    const auto number = [&](const char* name, double& value) {
      const std::string text = in_->text(name);
      const char* end = text.data() + text.size();
      const auto [stop, error] = std::from_chars(text.data(), end, value);
      return error == std::errc{} && stop == end;
    };
    double x = 0, y = 0, low = 0, high = 0;
    if (!number("Gwy::XReal", x) || !number("Gwy::YReal", y) || !number("Gwy::ZMin", low) ||
        !number("Gwy::ZMax", high))
      return false;
    header_.lx = x * unit("Gwy::XYUnit", 1);
    header_.ly = y * unit("Gwy::XYUnit", 1);
    base_ = low * unit("Gwy::ZUnit", 1);
    scale_ = (high - low) * unit("Gwy::ZUnit", 1);
    header_.polarity = scale_ >= 0 ? Polarity::WhiteHigh : Polarity::WhiteDeep;
    return true;
  }
  // Of whole numbers: whether it says the heights of black and white.
  bool read_description(const std::string& text) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    const auto number = [&](const char* key, double& value) {
      const auto it = json.find(key);
      if (it == json.end() || !it->is_number()) return false;
      value = *it;
      return true;
    };
    double x = 0, y = 0, black = 0, white = 0;
    if (number("size_x_m", x) && number("size_y_m", y)) {
      header_.lx = x;
      header_.ly = y;
    }
    if (const auto it = json.find("polarity"); it != json.end() && it->is_string()) {
      if (*it == "white-is-high") header_.polarity = Polarity::WhiteHigh;
      if (*it == "white-is-deep") header_.polarity = Polarity::WhiteDeep;
    }
    if (!spec_.whole || !number("black_m", black) || !number("white_m", white)) return false;
    base_ = black;
    scale_ = white - black;
    return true;
  }

  RegularFile file_;
  std::unique_ptr<ImageIn> in_;
  ImageSpec spec_;
  std::size_t channel_ = 0;
  double scale_ = 1e-6, base_ = 0;  // float images hold micrometres
  int row_ = 0;
  std::vector<float> strip_;
};

class CodecPicture : public PictureRows {
 public:
  explicit CodecPicture(const std::string& path) : file_(path), in_(open_image(file_, true)) {
    width = in_->spec().width;
    height = in_->spec().height;
    channels = static_cast<int>(in_->spec().channels.size());
    read_tags(*in_, tag_x, tag_y);
  }
  void next(std::uint8_t* row) override {
    if (const std::string why = in_->read_rows(row_, row_ + 1, Sample::U8, row); !why.empty())
      broken(file_, why);
    ++row_;
  }

 private:
  RegularFile file_;
  std::unique_ptr<ImageIn> in_;
  int row_ = 0;
};

}  // namespace

std::unique_ptr<HeightRows> open_image_rows(const std::string& path, bool any_size) {
  return std::make_unique<ImageRows>(path, any_size);
}

std::unique_ptr<PictureRows> open_picture_rows(const std::string& path) {
  return std::make_unique<CodecPicture>(path);
}

}  // namespace papilla::geometry
