// PNG (ISO 15948) of grey or colours with 8 or 16 bits, not interlaced. Texts are tEXt chunks under
// their own names, which is where Gwyddion looks for its keys.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "geometry/codec/formats.h"

namespace papilla::geometry {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kChunk = 1 << 16;  // of packed rows

std::uint32_t word_at(const std::uint8_t* b) {
  return std::uint32_t{b[0]} << 24 | std::uint32_t{b[1]} << 16 | std::uint32_t{b[2]} << 8 | b[3];
}
void add_word(Bytes& out, std::uint32_t word) {
  for (int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(word >> shift));
}
void add_text(Bytes& out, const std::string& text) {
  out.insert(out.end(), text.begin(), text.end());
}

// What filter 1 to 4 expects of a byte, by those to its left, above and above left.
std::uint8_t expected(int filter, int left, int above, int corner) {
  switch (filter) {
    case 1:
      return static_cast<std::uint8_t>(left);
    case 2:
      return static_cast<std::uint8_t>(above);
    case 3:
      return static_cast<std::uint8_t>((left + above) / 2);
    case 4: {
      const int guess = left + above - corner, to_left = std::abs(guess - left),
                to_above = std::abs(guess - above), to_corner = std::abs(guess - corner);
      const int best = to_left <= to_above && to_left <= to_corner ? left
                       : to_above <= to_corner                     ? above
                                                                   : corner;
      return static_cast<std::uint8_t>(best);
    }
    default:
      return 0;
  }
}

// A row and its filter; pixel: bytes of one.
void filter_row(int filter, std::size_t pixel, const Bytes& row, const Bytes& above, Bytes& out) {
  out[0] = static_cast<std::uint8_t>(filter);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const bool first = i < pixel;
    out[i + 1] =
        static_cast<std::uint8_t>(row[i] - expected(filter, first ? 0 : row[i - pixel], above[i],
                                                    first ? 0 : above[i - pixel]));
  }
}
void restore_row(int filter, std::size_t pixel, const std::uint8_t* filtered, const Bytes& above,
                 Bytes& row) {
  if (filter > 4) throw std::runtime_error("a row of an unknown filter");
  for (std::size_t i = 0; i < row.size(); ++i) {
    const bool first = i < pixel;
    row[i] =
        static_cast<std::uint8_t>(filtered[i] + expected(filter, first ? 0 : row[i - pixel],
                                                         above[i], first ? 0 : above[i - pixel]));
  }
}

class PngOut : public FormatOut {
 public:
  PngOut(const std::string& path, const ImageSpec& spec)
      : spec_(spec), file_(path, std::ios::binary), above_(row_bytes(spec)) {
    constexpr std::array kKinds{0, 4, 2, 6};  // grey, with alpha, colours, with alpha
    if (spec.sample == Sample::F32 || spec.channels.size() > kKinds.size())
      throw std::runtime_error("a PNG holds 8 or 16 bits of at most four channels");
    file_.write(reinterpret_cast<const char*>(kSignature.data()), kSignature.size());
    Bytes head;
    add_word(head, static_cast<std::uint32_t>(spec.width));
    add_word(head, static_cast<std::uint32_t>(spec.height));
    head.push_back(static_cast<std::uint8_t>(8 * bytes_of(spec.sample)));
    head.push_back(static_cast<std::uint8_t>(kKinds[spec.channels.size() - 1]));
    head.insert(head.end(), 3, 0);
    chunk("IHDR", head);
    write_resolution();
    for (const auto& [name, value] : spec.attributes) {
      const auto* text = std::get_if<std::string>(&value);
      if (!text || name == "ResolutionUnit") continue;
      Bytes body;
      add_text(body, name == "ImageDescription" ? "Description" : name);
      body.push_back(0);
      add_text(body, *text);
      chunk("tEXt", body);
    }
    if (deflateInit(&packer_, Z_DEFAULT_COMPRESSION) != Z_OK)
      throw std::runtime_error("zlib does not start");
    make_room();
  }
  ~PngOut() override { deflateEnd(&packer_); }

 private:
  void write_resolution() {
    const float *x = single_of(spec_, "XResolution"), *y = single_of(spec_, "YResolution");
    if (!x || !y || text_of(spec_, "ResolutionUnit") != "cm") return;
    Bytes body;
    for (const float* pixels : {x, y})
      add_word(body, static_cast<std::uint32_t>(std::lround(100 * static_cast<double>(*pixels))));
    body.push_back(1);  // a metre
    chunk("pHYs", body);
  }

  void put(int begin, int end, const std::uint8_t* rows) override {
    Bytes row(above_.size()), filtered(row.size() + 1), best;
    const auto samples = row.size() / static_cast<std::size_t>(bytes_of(spec_.sample));
    for (int y = begin; y < end; ++y, rows += row.size()) {
      std::copy_n(rows, row.size(), row.begin());
      swap_bytes(row.data(), samples, bytes_of(spec_.sample));
      // The filter whose differences are least, as every writer chooses.
      long least = std::numeric_limits<long>::max();
      for (int filter = 0; filter <= 4; ++filter) {
        filter_row(filter, row.size() / static_cast<std::size_t>(spec_.width), row, above_,
                   filtered);
        long sum = 0;
        for (const std::uint8_t b : filtered) sum += std::abs(static_cast<std::int8_t>(b));
        if (sum < least) {
          least = sum;
          best = filtered;
        }
      }
      pack(best, Z_NO_FLUSH);
      above_ = row;
    }
  }

  void finish() override {
    pack({}, Z_FINISH);
    chunk("IEND", {});
    file_.close();
    if (!file_) throw std::runtime_error("the disk does not take it");
  }

  void pack(const Bytes& bytes, int flush) {
    packer_.next_in = const_cast<std::uint8_t*>(bytes.data());
    packer_.avail_in = static_cast<uInt>(bytes.size());
    for (bool done = false; !done;) {
      const int state = deflate(&packer_, flush);
      done = flush == Z_FINISH ? state == Z_STREAM_END : packer_.avail_out > 0;
      if (packer_.avail_out > 0 && flush != Z_FINISH) continue;  // there is room for more
      packed_.resize(packed_.size() - packer_.avail_out);
      chunk("IDAT", packed_);
      make_room();
    }
  }

  void make_room() {
    packed_.resize(kChunk);
    packer_.next_out = packed_.data();
    packer_.avail_out = static_cast<uInt>(packed_.size());
  }

  void chunk(const std::string& kind, const Bytes& body) {
    Bytes out;
    add_word(out, static_cast<std::uint32_t>(body.size()));
    add_text(out, kind);
    out.insert(out.end(), body.begin(), body.end());
    add_word(out, static_cast<std::uint32_t>(
                      crc32(0, out.data() + 4, static_cast<uInt>(out.size() - 4))));
    file_.write(reinterpret_cast<const char*>(out.data()), std::ssize(out));
    if (!file_) throw std::runtime_error("the disk does not take it");
  }

  ImageSpec spec_;
  std::ofstream file_;
  Bytes above_, packed_;
  z_stream packer_{};
};

class PngIn : public FormatIn {
 public:
  explicit PngIn(const std::string& path) : file_(path, std::ios::binary) {
    std::array<std::uint8_t, 8> start{};
    file_.read(reinterpret_cast<char*>(start.data()), start.size());
    if (!file_ || start != kSignature) throw std::runtime_error("no PNG file");
    read_head(body_of("IHDR"));
    while (next_chunk() != "IDAT") {
      if (kind_ == "IEND") throw std::runtime_error("a PNG file without an image");
      if (kind_ == "tEXt") read_text();
      if (kind_ == "pHYs" && body_.size() == 9 && body_[8] == 1) {
        singles_["XResolution"] = static_cast<float>(word_at(body_.data())) / 100;
        singles_["YResolution"] = static_cast<float>(word_at(body_.data() + 4)) / 100;
        texts_["ResolutionUnit"] = "cm";
      }
    }
    image_ = static_cast<std::int64_t>(file_.tellg()) - std::ssize(body_) - 12;
    if (inflateInit(&unpacker_) != Z_OK) throw std::runtime_error("zlib does not start");
    restart();
  }
  ~PngIn() override { inflateEnd(&unpacker_); }

 private:
  void read_head(const Bytes& head) {
    if (head.size() != 13) throw std::runtime_error("a PNG file with a damaged head");
    const std::uint32_t width = word_at(head.data()), height = word_at(head.data() + 4);
    constexpr auto kMost = static_cast<std::uint32_t>(std::numeric_limits<int>::max());
    if (width < 1 || height < 1 || width > kMost || height > kMost)
      throw std::runtime_error("a side of no or too many pixels");
    const int bits = head[8], kind = head[9];
    const std::size_t channels = kind == 0 ? 1 : kind == 4 ? 2 : kind == 2 ? 3 : kind == 6 ? 4 : 0;
    if (channels == 0 || (bits != 8 && bits != 16) || head[12] != 0) {
      throw std::runtime_error(
          "PNG is read with 8 or 16 bits of grey or colours, without a palette and not interlaced; "
          "convert it: convert IN.png -interlace none -define png:color-type=0 OUT.png");
    }
    spec_ = {.width = static_cast<int>(width), .height = static_cast<int>(height)};
    spec_.channels.assign(channels, "");
    spec_.sample = bits == 8 ? Sample::U8 : Sample::U16;
    file_.seekg(0, std::ios::end);  // deflate packs 1032 to 1 at best
    if (row_bytes(spec_) / 1100 > static_cast<std::uint64_t>(file_.tellg()))
      throw std::runtime_error("the image is cut off");
    file_.seekg(kSignature.size() + 12 + std::ssize(head));
  }

  void read_text() {
    const auto end = std::find(body_.begin(), body_.end(), std::uint8_t{0});
    if (end == body_.end()) return;
    const std::string name(body_.begin(), end);
    texts_[name == "Description" ? "ImageDescription" : name].assign(end + 1, body_.end());
  }

  // Rows come one after another: an earlier one is found from the beginning again.
  void get(int begin, int end, std::uint8_t* rows) override {
    if (begin < next_) restart();
    const int size = bytes_of(spec_.sample);
    const std::size_t row = row_bytes(spec_), pixel = row / static_cast<std::size_t>(spec_.width);
    for (; next_ < end; ++next_) {
      Bytes filtered(row + 1), plain(row);
      unpack(filtered);
      restore_row(filtered[0], pixel, filtered.data() + 1, above_, plain);
      above_ = plain;
      if (next_ < begin) continue;
      swap_bytes(plain.data(), row / static_cast<std::size_t>(size), size);
      rows = std::copy(plain.begin(), plain.end(), rows);
    }
  }

  void restart() {
    file_.clear();
    file_.seekg(image_);
    inflateReset(&unpacker_);
    unpacker_.avail_in = 0;
    above_.assign(row_bytes(spec_), 0);
    next_ = 0;
  }

  void unpack(Bytes& out) {
    unpacker_.next_out = out.data();
    unpacker_.avail_out = static_cast<uInt>(out.size());
    while (unpacker_.avail_out > 0) {
      if (unpacker_.avail_in == 0) {
        if (next_chunk() != "IDAT") throw std::runtime_error("the image is cut off");
        unpacker_.next_in = body_.data();
        unpacker_.avail_in = static_cast<uInt>(body_.size());
      }
      const int state = inflate(&unpacker_, Z_NO_FLUSH);
      if (state != Z_OK && (state != Z_STREAM_END || unpacker_.avail_out > 0) &&
          state != Z_BUF_ERROR)
        throw std::runtime_error("the compressed data are damaged");
    }
  }

  const Bytes& body_of(const std::string& kind) {
    if (next_chunk() != kind) throw std::runtime_error("a PNG file without " + kind);
    return body_;
  }

  const std::string& next_chunk() {
    std::array<std::uint8_t, 8> head{};
    file_.read(reinterpret_cast<char*>(head.data()), head.size());
    const std::int64_t at = file_.tellg();
    file_.seekg(0, std::ios::end);
    const std::int64_t left = static_cast<std::int64_t>(file_.tellg()) - at;
    file_.seekg(at);
    const std::int64_t length = word_at(head.data());
    if (!file_ || length + 4 > left) throw std::runtime_error("the file is cut off");
    body_.resize(static_cast<std::size_t>(length) + 4);
    file_.read(reinterpret_cast<char*>(body_.data()), length + 4);
    const auto sum = crc32(crc32(0, head.data() + 4, 4), body_.data(), static_cast<uInt>(length));
    if (!file_ || sum != word_at(body_.data() + length))
      throw std::runtime_error("a part of the file is damaged");
    body_.resize(static_cast<std::size_t>(length));
    return kind_.assign(head.begin() + 4, head.end());
  }

  std::ifstream file_;
  std::int64_t image_ = 0;  // of the first IDAT
  int next_ = 0;
  std::string kind_;
  Bytes body_, above_;
  z_stream unpacker_{};
};

}  // namespace

std::unique_ptr<ImageOut> create_png(const std::string& path, const ImageSpec& spec) {
  return std::make_unique<PngOut>(path, spec);
}

std::unique_ptr<ImageIn> open_png(const std::string& path) { return std::make_unique<PngIn>(path); }

}  // namespace papilla::geometry
