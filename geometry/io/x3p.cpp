// X3P (ISO 25178-72): a stored zip of main.xml, the heights as doubles and their MD5 sums.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>

#include "base/error.h"
#include "base/file_writer.h"
#include "geometry/io/layout.h"

namespace papilla::geometry {
namespace {

std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
  return out;
}

// A file of the zip as pieces: called with a function that takes them, in order.
using Pieces = std::function<void(const std::function<void(const void*, std::size_t)>&)>;

class Crc32 {
 public:
  Crc32() {
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t c = i;
      for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      table_[i] = c;
    }
  }
  void add(const void* bytes, std::size_t size) {
    const auto* b = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < size; ++i) sum_ = table_[(sum_ ^ b[i]) & 0xff] ^ (sum_ >> 8);
  }
  std::uint32_t sum() const { return sum_ ^ 0xffffffffu; }

 private:
  std::array<std::uint32_t, 256> table_{};
  std::uint32_t sum_ = 0xffffffffu;
};

// RFC 1321; the format asks for it.
class Md5 {
 public:
  Md5() {
    for (std::size_t i = 0; i < 64; ++i) {
      sines_[i] = static_cast<std::uint32_t>(
          std::floor(4294967296.0 * std::abs(std::sin(static_cast<double>(i + 1)))));
    }
  }
  void add(const void* bytes, std::size_t size) {
    const char* at = static_cast<const char*>(bytes);
    size_ += size;
    while (size > 0) {
      const std::size_t n = std::min(size, block_.size() - held_);
      std::memcpy(block_.data() + held_, at, n);
      held_ += n, at += n, size -= n;
      if (held_ == block_.size()) turn();
    }
  }
  std::string finish() {
    const std::string bits = little(8 * size_, 8);
    add("\x80", 1);
    while (held_ != 56) add("", 1);
    add(bits.data(), bits.size());
    std::string out;
    for (const std::uint32_t v : sum_) {
      for (const char b : little(v, 4)) out += fmt::format("{:02x}", static_cast<unsigned char>(b));
    }
    return out;
  }

 private:
  void turn() {
    static constexpr std::array<int, 16> kTurns{7, 12, 17, 22, 5, 9,  14, 20,
                                                4, 11, 16, 23, 6, 10, 15, 21};
    held_ = 0;
    std::array<std::uint32_t, 16> word{};
    std::memcpy(word.data(), block_.data(), 64);
    auto [a, b, c, d] = sum_;
    for (std::uint32_t i = 0; i < 64; ++i) {
      std::uint32_t f = 0, g = 0;
      if (i < 16) {
        f = (b & c) | (~b & d), g = i;
      } else if (i < 32) {
        f = (d & b) | (~d & c), g = (5 * i + 1) % 16;
      } else if (i < 48) {
        f = b ^ c ^ d, g = (3 * i + 5) % 16;
      } else {
        f = c ^ (b | ~d), g = 7 * i % 16;
      }
      const std::uint32_t x = a + f + sines_[i] + word[g];
      const int turns = kTurns[4 * (i / 16) + i % 4];
      a = d, d = c, c = b;
      b += (x << turns) | (x >> (32 - turns));
    }
    sum_[0] += a, sum_[1] += b, sum_[2] += c, sum_[3] += d;
  }

  std::array<std::uint32_t, 64> sines_{};
  std::array<std::uint32_t, 4> sum_{0x67452301u, 0xefcdab89u, 0x98badcfeu, 0x10325476u};
  std::array<char, 64> block_{};
  std::size_t held_ = 0;
  std::uint64_t size_ = 0;
};

Pieces piece(const std::string& bytes) {
  return [&bytes](const auto& take) { take(bytes.data(), bytes.size()); };
}

std::string md5(const Pieces& pieces) {
  Md5 sum;
  pieces([&](const void* bytes, std::size_t size) { sum.add(bytes, size); });
  return sum.finish();
}

class Zip {
 public:
  explicit Zip(FileWriter& out) : out_(out) {}

  // The pieces are asked for twice: their sum stands before them.
  void add(const std::string& name, const Pieces& pieces) {
    Crc32 sum;
    std::uint64_t length = 0;
    pieces([&](const void* bytes, std::size_t size) { sum.add(bytes, size), length += size; });
    // Version 2.0, no compression, 1 January 2000.
    const std::string common = little(20, 2) + little(0, 2) + little(0, 2) + little(0, 2) +
                               little(0x2821, 2) + little(sum.sum(), 4) + little(length, 4) +
                               little(length, 4) + little(name.size(), 2) + little(0, 2);
    directory_ += "PK\x01\x02" + little(20, 2) + common + little(0, 2) + little(0, 2) +
                  little(0, 2) + little(0, 4) + little(size_, 4) + name;
    const std::string head = "PK\x03\x04" + common + name;
    out_.append(head);
    pieces([&](const void* bytes, std::size_t size) { out_.append(bytes, size); });
    size_ += head.size() + length;
    ++files_;
  }
  void finish() {
    out_.append(directory_ + "PK\x05\x06" + little(0, 4) + little(files_, 2) + little(files_, 2) +
                little(directory_.size(), 4) + little(size_, 4) + little(0, 2));
  }

 private:
  FileWriter& out_;
  std::string directory_;
  std::uint64_t size_ = 0, files_ = 0;
};

}  // namespace

void write_x3p(const std::string& path, const Heightmap& h) {
  if (h.z.size() * sizeof(double) > 0xf0000000u)
    throw InputError("cannot write " + path + ": an X3P of more than 4 GB; export fewer pixels");
  // Top row first, as Gwyddion shows it.
  const Pieces data = [&](const auto& take) {
    for (int iy = h.grid.ny - 1; iy >= 0; --iy)
      take(&h.z[h.grid.index(0, iy)], static_cast<std::size_t>(h.grid.nx) * sizeof(double));
  };
  const auto axis = [](const char* name, const char* kind, double step) {
    return fmt::format(
        "<{0}><AxisType>{1}</AxisType><DataType>D</DataType><Increment>{2:.17g}</Increment>"
        "<Offset>0</Offset></{0}>",
        name, kind, step);
  };
  const std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\">"
      "<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>" +
      axis("CX", "I", h.grid.dx()) + axis("CY", "I", h.grid.dy()) + axis("CZ", "A", 1) +
      "</Axes></Record1><Record2><Date>2000-01-01T00:00:00</Date><Creator>papilla " PAPILLA_VERSION
      "</Creator><Instrument><Manufacturer>none</Manufacturer><Model>design</Model><Serial>none"
      "</Serial><Version>" PAPILLA_VERSION
      "</Version></Instrument><CalibrationDate>2000-01-01T00:00:00</CalibrationDate>"
      "<ProbingSystem><Type>Software</Type><Identification>none</Identification></ProbingSystem>"
      "</Record2><Record3><MatrixDimension>" +
      fmt::format("<SizeX>{}</SizeX><SizeY>{}</SizeY><SizeZ>1</SizeZ>", h.grid.nx, h.grid.ny) +
      "</MatrixDimension><DataLink><PointDataLink>bindata/data.bin</PointDataLink>"
      "<MD5ChecksumPointData>" +
      md5(data) +
      "</MD5ChecksumPointData></DataLink></Record3>"
      "<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>\n";
  const std::string sum = md5(piece(xml)) + " *main.xml\n";
  FileWriter out(path);
  Zip zip(out);
  zip.add("main.xml", piece(xml));
  zip.add("bindata/data.bin", data);
  zip.add("md5checksum.hex", piece(sum));
  zip.finish();
  out.commit();
}

}  // namespace papilla::geometry
