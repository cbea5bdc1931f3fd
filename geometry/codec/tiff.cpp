// TIFF 6.0 and, from 4 GB on, BigTIFF: one plane of strips, 8 or 16 bits or floats, as they are or
// deflated.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

#include "geometry/codec/formats.h"

namespace papilla::geometry {
namespace {

using Bytes = std::vector<std::uint8_t>;
static_assert(std::endian::native == std::endian::little, "files are written as memory is");

enum Tag : std::uint16_t {
  kWidth = 256,
  kHeight = 257,
  kBits = 258,
  kCompression = 259,
  kPhotometric = 262,
  kDescription = 270,
  kStripOffsets = 273,
  kChannels = 277,
  kRowsPerStrip = 278,
  kStripBytes = 279,
  kXResolution = 282,
  kYResolution = 283,
  kPlanar = 284,
  kResolutionUnit = 296,
  kSoftware = 305,
  kDateTime = 306,
  kPredictor = 317,
  kSampleFormat = 339,
};
enum Type : std::uint16_t { kText = 2, kShort = 3, kLong = 4, kRational = 5, kLong8 = 16 };
const std::set<Tag> kRead{kWidth,       kHeight,       kBits,           kCompression,
                          kPhotometric, kDescription,  kChannels,       kPlanar,
                          kXResolution, kYResolution,  kRowsPerStrip,   kPredictor,
                          kStripBytes,  kStripOffsets, kResolutionUnit, kSampleFormat};
constexpr std::uint64_t kPlain = 1, kDeflate = 8, kDeflateOfOld = 32946;
constexpr std::uint64_t kWholeNumbers = 1, kFloats = 3;

template <typename T>
void add(Bytes& out, T value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof(T));
}

// value = numerator / denominator to nine digits.
std::uint64_t rational(double value) {
  const double denominator = std::floor(std::clamp(4e9 / value, 1.0, 4e9));
  const auto numerator = static_cast<std::uint64_t>(std::min(std::round(value * denominator), 4e9));
  return numerator | static_cast<std::uint64_t>(denominator) << 32;
}

class TiffOut : public FormatOut {
 public:
  TiffOut(const std::string& path, const ImageSpec& spec)
      : spec_(spec),
        file_(path, std::ios::binary),
        big_(static_cast<double>(row_bytes(spec)) * spec.height > 4e9) {
    Bytes head{'I', 'I'};
    add<std::uint16_t>(head, big_ ? 43 : 42);
    if (big_) add<std::uint32_t>(head, 8);  // bytes of a place
    place_of_tags_ = head.size();
    head.resize(big_ ? 16 : 8);  // where the tags are is known at the end
    append(head.data(), head.size());
  }

 private:
  void put(int begin, int end, const std::uint8_t* rows) override {
    const std::size_t row = row_bytes(spec_);
    for (int y = begin; y < end; y += kRowsTogether) {
      const auto count = static_cast<std::size_t>(std::min(kRowsTogether, end - y)) * row;
      offsets_.push_back(written_);
      if (spec_.compressed) {
        const Bytes packed = deflated({rows, count});
        append(packed.data(), packed.size());
      } else {
        append(rows, count);
      }
      sizes_.push_back(written_ - offsets_.back());
      rows += count;
    }
  }

  void finish() override {
    write_tags();
    file_.close();
    if (!file_) throw std::runtime_error("the disk does not take it");
  }

  // Sorted by their numbers, as the format wants.
  void write_tags() {
    const std::size_t channels = spec_.channels.size();
    const auto bits = static_cast<std::uint64_t>(8 * bytes_of(spec_.sample));
    number(kWidth, kLong, {static_cast<std::uint64_t>(spec_.width)});
    number(kHeight, kLong, {static_cast<std::uint64_t>(spec_.height)});
    number(kBits, kShort, std::vector(channels, bits));
    number(kCompression, kShort, {spec_.compressed ? kDeflate : kPlain});
    number(kPhotometric, kShort, {channels < 3 ? 1u : 2u});  // 0 is black; red, green and blue
    words(kDescription, "ImageDescription");
    const Type place = big_ ? kLong8 : kLong;
    number(kStripOffsets, place, offsets_);
    number(kChannels, kShort, {channels});
    number(kRowsPerStrip, kLong, {kRowsTogether});
    number(kStripBytes, place, sizes_);
    const float *x = single_of(spec_, "XResolution"), *y = single_of(spec_, "YResolution");
    if (x && y) {
      number(kXResolution, kRational, {rational(static_cast<double>(*x))});
      number(kYResolution, kRational, {rational(static_cast<double>(*y))});
    }
    number(kPlanar, kShort, {1});
    if (text_of(spec_, "ResolutionUnit") == "cm") number(kResolutionUnit, kShort, {3});
    words(kSoftware, "Software");
    words(kDateTime, "DateTime");
    number(kSampleFormat, kShort,
           std::vector(channels, spec_.sample == Sample::F32 ? kFloats : kWholeNumbers));

    align();
    const std::uint64_t at = written_;
    Bytes out;
    big_ ? add<std::uint64_t>(out, count_) : add(out, static_cast<std::uint16_t>(count_));
    out.insert(out.end(), entries_.begin(), entries_.end());
    out.resize(out.size() + (big_ ? 8 : 4));  // no other image follows
    append(out.data(), out.size());
    file_.seekp(static_cast<std::streamoff>(place_of_tags_));
    file_.write(reinterpret_cast<const char*>(&at), big_ ? 8 : 4);
  }

  void number(Tag tag, Type type, const std::vector<std::uint64_t>& values) {
    Bytes body;
    for (const std::uint64_t v : values) {
      if (type == kShort) {
        add(body, static_cast<std::uint16_t>(v));
      } else if (type == kLong) {
        add(body, static_cast<std::uint32_t>(v));
      } else {
        add(body, v);
      }
    }
    entry(tag, type, values.size(), std::move(body));
  }
  void words(Tag tag, const std::string& attribute) {
    const std::string text = text_of(spec_, attribute);
    if (!text.empty())
      entry(tag, kText, text.size() + 1, Bytes(text.c_str(), text.c_str() + text.size() + 1));
  }

  // A value that has no room in its entry lies before the tags.
  void entry(Tag tag, Type type, std::uint64_t count, Bytes body) {
    const std::size_t room = big_ ? 8 : 4;
    if (body.size() > room) {
      align();
      const std::uint64_t at = written_;
      append(body.data(), body.size());
      body.assign(reinterpret_cast<const std::uint8_t*>(&at),
                  reinterpret_cast<const std::uint8_t*>(&at) + room);
    }
    body.resize(room);
    add(entries_, static_cast<std::uint16_t>(tag));
    add(entries_, static_cast<std::uint16_t>(type));
    big_ ? add(entries_, count) : add(entries_, static_cast<std::uint32_t>(count));
    entries_.insert(entries_.end(), body.begin(), body.end());
    ++count_;
  }

  void align() {  // values and tags begin at even places
    if (written_ % 2 == 1) append(Bytes{0}.data(), 1);
  }

  void append(const std::uint8_t* bytes, std::size_t size) {
    file_.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    if (!file_) throw std::runtime_error("the disk does not take it");
    written_ += size;
  }

  ImageSpec spec_;
  std::ofstream file_;
  bool big_;
  std::size_t place_of_tags_ = 0;
  std::uint64_t written_ = 0, count_ = 0;
  std::vector<std::uint64_t> offsets_, sizes_;
  Bytes entries_;
};

class TiffIn : public FormatIn {
 public:
  explicit TiffIn(const std::string& path) : file_(path, std::ios::binary) {
    file_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(file_.tellg());
    const Bytes head = bytes_at(0, 8);
    foreign_ = head[0] == 'M';
    const std::uint64_t version = value(&head[2], 2);
    if (head[0] != head[1] || (head[0] != 'I' && head[0] != 'M') || version < 42 || version > 43)
      throw std::runtime_error("no TIFF file");
    big_ = version == 43;
    read_tags(big_ ? value(bytes_at(8, 8).data(), 8) : value(&head[4], 4));
    read_layout();
    for (const auto& [tag, name] :
         {std::pair{kXResolution, "XResolution"}, {kYResolution, "YResolution"}}) {
      if (tags_.contains(tag)) singles_[name] = static_cast<float>(tags_[tag].ratio);
    }
    const std::uint64_t unit = number(kResolutionUnit, 2);
    texts_["ResolutionUnit"] = unit == 3 ? "cm" : unit == 2 ? "in" : "none";
    texts_["ImageDescription"] = tags_[kDescription].text;
  }

 private:
  struct Value {
    std::vector<std::uint64_t> numbers;
    std::string text;
    double ratio = 0;
  };

  void read_tags(std::uint64_t at) {
    const int of_count = big_ ? 8 : 2, of_entry = big_ ? 20 : 12, of_place = big_ ? 8 : 4;
    const std::uint64_t count = value(bytes_at(at, of_count).data(), of_count);
    if (count > 4096) throw std::runtime_error("a TIFF file of too many tags");
    const Bytes entries =
        bytes_at(at + static_cast<std::uint64_t>(of_count), static_cast<int>(count) * of_entry);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint8_t* entry = entries.data() + i * static_cast<std::uint64_t>(of_entry);
      const auto tag = static_cast<Tag>(value(entry, 2));
      const std::uint64_t type = value(entry + 2, 2), values = value(entry + 4, of_place);
      const int each = type == 1 || type == kText            ? 1
                       : type == kShort                      ? 2
                       : type == kLong                       ? 4
                       : type == kRational || type == kLong8 ? 8
                                                             : 0;
      if (each == 0 || !kRead.contains(tag)) continue;
      if (values > size_) throw std::runtime_error("a tag is cut off");
      const std::uint64_t bytes = values * static_cast<std::uint64_t>(each);
      const std::uint8_t* inside = entry + 4 + of_place;
      Bytes body(inside, inside + of_place);
      if (bytes > body.size()) body = bytes_at(value(inside, of_place), bytes);
      Value& out = tags_[tag] = {};
      for (std::uint64_t k = 0; k < values && type != kText && type != kRational; ++k)
        out.numbers.push_back(value(&body[k * static_cast<std::uint64_t>(each)], each));
      if (type == kText) out.text = std::string(body.begin(), body.begin() + bytes).c_str();
      if (type == kRational && values == 1 && value(&body[4], 4) > 0) {
        out.ratio =
            static_cast<double>(value(&body[0], 4)) / static_cast<double>(value(&body[4], 4));
      }
    }
  }

  void read_layout() {
    const std::uint64_t width = number(kWidth, 0), height = number(kHeight, 0),
                        channels = number(kChannels, 1), bits = number(kBits, 1),
                        format = number(kSampleFormat, kWholeNumbers);
    constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
    if (width < 1 || height < 1 || width > kMost || height > kMost || channels < 1 || channels > 64)
      throw std::runtime_error("a side of no or too many pixels");
    compression_ = number(kCompression, kPlain);
    predictor_ = number(kPredictor, 1);
    const bool whole = format == kWholeNumbers && (bits == 8 || bits == 16);
    inverted_ = whole && number(kPhotometric, 1) == 0;
    const bool packed = compression_ == kDeflate || compression_ == kDeflateOfOld;
    if (!(whole || (format == kFloats && bits == 32)) || !(compression_ == kPlain || packed) ||
        number(kPhotometric, 1) > 2 || !tags_.contains(kStripOffsets) ||
        (number(kPlanar, 1) != 1 && channels > 1) || predictor_ < 1 ||
        predictor_ > (whole ? 2 : 3)) {
      throw std::runtime_error(
          "TIFF is read with 8 or 16 bits or floats, in strips, as it is or deflated; convert it: "
          "tiffcp -s -c none IN.tif OUT.tif");
    }
    spec_ = {.width = static_cast<int>(width), .height = static_cast<int>(height)};
    spec_.channels.assign(channels, "");
    spec_.sample = !whole ? Sample::F32 : bits == 8 ? Sample::U8 : Sample::U16;
    rows_ = static_cast<int>(std::clamp<std::uint64_t>(number(kRowsPerStrip, kMost), 1, height));
    strips_ = (spec_.height - 1) / rows_ + 1;
    if (tags_[kStripOffsets].numbers.size() < static_cast<std::size_t>(strips_) ||
        tags_[kStripBytes].numbers.size() < static_cast<std::size_t>(strips_))
      throw std::runtime_error("strips of the image are missing");
  }

  void get(int begin, int end, std::uint8_t* rows) override {
    const std::size_t row = row_bytes(spec_);
    for (int y = begin; y < end; ++y, rows += row) {
      const int strip = y / rows_;
      if (compression_ == kPlain) {  // a strip may be the whole file
        const std::uint64_t inside = static_cast<std::uint64_t>(y % rows_) * row;
        if (inside + row > tags_[kStripBytes].numbers[static_cast<std::size_t>(strip)])
          throw std::runtime_error("a strip is cut off");
        Bytes plain =
            bytes_at(tags_[kStripOffsets].numbers[static_cast<std::size_t>(strip)] + inside, row);
        restore(plain.data());
        std::copy(plain.begin(), plain.end(), rows);
        continue;
      }
      if (strip != held_) unpack(strip);
      std::copy_n(strip_.begin() +
                      static_cast<std::ptrdiff_t>(y % rows_) * static_cast<std::ptrdiff_t>(row),
                  row, rows);
    }
  }

  void unpack(int strip) {
    const auto at = static_cast<std::size_t>(strip);
    const int count = std::min(rows_, spec_.height - strip * rows_);
    const std::uint64_t packed = tags_[kStripBytes].numbers[at];
    const std::size_t plain = static_cast<std::size_t>(count) * row_bytes(spec_);
    if (plain / 1100 > packed) throw std::runtime_error("a strip is cut off");
    strip_ = inflated(bytes_at(tags_[kStripOffsets].numbers[at], packed), plain);
    for (int y = 0; y < count; ++y)
      restore(strip_.data() + static_cast<std::size_t>(y) * row_bytes(spec_));
    held_ = strip;
  }

  // A row of the file as numbers of this machine, black 0.
  void restore(std::uint8_t* row) const {
    const int size = bytes_of(spec_.sample);
    const std::size_t channels = spec_.channels.size(),
                      samples = static_cast<std::size_t>(spec_.width) * channels;
    if (predictor_ == 3) {  // differences of bytes, those of the highest place first
      const std::size_t bytes = samples * sizeof(float);
      for (std::size_t i = channels; i < bytes; ++i)
        row[i] = static_cast<std::uint8_t>(row[i] + row[i - channels]);
      const Bytes planes(row, row + bytes);
      for (std::size_t i = 0; i < bytes; ++i) row[i] = planes[(3 - i % 4) * samples + i / 4];
      return;
    }
    if (foreign_) swap_bytes(row, samples, size);
    const auto each = [&]<typename T>(T) {
      for (std::size_t i = 0; i < samples; ++i) {
        T now, before = 0;
        std::memcpy(&now, row + i * sizeof(T), sizeof(T));
        if (predictor_ == 2 && i >= channels) {
          std::memcpy(&before, row + (i - channels) * sizeof(T), sizeof(T));
          now = static_cast<T>(now + before);
        }
        std::memcpy(row + i * sizeof(T), &now, sizeof(T));
      }
      for (std::size_t i = 0; inverted_ && i < samples * sizeof(T); ++i)
        row[i] = static_cast<std::uint8_t>(~row[i]);
    };
    if (size == 1) each(std::uint8_t{});
    if (size == 2) each(std::uint16_t{});
    if (size == 4 && predictor_ == 2) each(std::uint32_t{});
  }

  std::uint64_t number(Tag tag, std::uint64_t otherwise) const {
    const auto found = tags_.find(tag);
    return found == tags_.end() || found->second.numbers.empty() ? otherwise
                                                                 : found->second.numbers.front();
  }

  std::uint64_t value(const std::uint8_t* bytes, int size) const {
    std::uint64_t out = 0;
    for (int i = 0; i < size; ++i) out = out << 8 | bytes[foreign_ ? i : size - 1 - i];
    return out;
  }

  Bytes bytes_at(std::uint64_t at, std::uint64_t count) {
    if (at > size_ || count > size_ - at) throw std::runtime_error("the file is cut off");
    Bytes out(count);
    file_.seekg(static_cast<std::streamoff>(at));
    file_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(count));
    if (!file_) throw std::runtime_error("the file is cut off");
    return out;
  }

  std::ifstream file_;
  std::uint64_t size_ = 0, compression_ = kPlain, predictor_ = 1;
  bool foreign_ = false, big_ = false, inverted_ = false;  // foreign: the high byte is first
  std::map<Tag, Value> tags_;
  int rows_ = 1, strips_ = 0, held_ = -1;
  Bytes strip_;
};

}  // namespace

std::unique_ptr<ImageOut> create_tiff(const std::string& path, const ImageSpec& spec) {
  return std::make_unique<TiffOut>(path, spec);
}

std::unique_ptr<ImageIn> open_tiff(const std::string& path) {
  return std::make_unique<TiffIn>(path);
}

}  // namespace papilla::geometry
