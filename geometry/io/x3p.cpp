// X3P (ISO 25178-72): a stored zip of main.xml, the heights as doubles and their MD5 sums.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/files.h"
#include "geometry/io/layout.h"

namespace papilla {
namespace {

std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
  return out;
}

std::uint32_t crc32(const std::string& bytes) {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  std::uint32_t c = 0xffffffffu;
  for (const char b : bytes) c = table[(c ^ static_cast<unsigned char>(b)) & 0xff] ^ (c >> 8);
  return c ^ 0xffffffffu;
}

// RFC 1321; the format asks for it.
std::string md5(std::string bytes) {
  static constexpr std::array<int, 16> kTurns{7, 12, 17, 22, 5, 9,  14, 20,
                                              4, 11, 16, 23, 6, 10, 15, 21};
  const std::uint64_t bits = 8 * bytes.size();
  bytes += '\x80';
  while (bytes.size() % 64 != 56) bytes += '\0';
  bytes += little(bits, 8);
  std::array<std::uint32_t, 4> sum{0x67452301u, 0xefcdab89u, 0x98badcfeu, 0x10325476u};
  std::array<std::uint32_t, 64> sines{};
  for (std::size_t i = 0; i < 64; ++i) {
    sines[i] = static_cast<std::uint32_t>(
        std::floor(4294967296.0 * std::abs(std::sin(static_cast<double>(i + 1)))));
  }
  for (std::size_t at = 0; at < bytes.size(); at += 64) {
    std::array<std::uint32_t, 16> word{};
    std::memcpy(word.data(), bytes.data() + at, 64);
    auto [a, b, c, d] = sum;
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
      const std::uint32_t x = a + f + sines[i] + word[g];
      const int turn = kTurns[4 * (i / 16) + i % 4];
      a = d, d = c, c = b;
      b += (x << turn) | (x >> (32 - turn));
    }
    sum[0] += a, sum[1] += b, sum[2] += c, sum[3] += d;
  }
  std::string out;
  for (const std::uint32_t v : sum) {
    for (const char b : little(v, 4)) out += fmt::format("{:02x}", static_cast<unsigned char>(b));
  }
  return out;
}

class Zip {
 public:
  void add(const std::string& name, const std::string& bytes) {
    // Version 2.0, no compression, 1 January 2000.
    const std::string common = little(20, 2) + little(0, 2) + little(0, 2) + little(0, 2) +
                               little(0x2821, 2) + little(crc32(bytes), 4) +
                               little(bytes.size(), 4) + little(bytes.size(), 4) +
                               little(name.size(), 2) + little(0, 2);
    directory_ += "PK\x01\x02" + little(20, 2) + common + little(0, 2) + little(0, 2) +
                  little(0, 2) + little(0, 4) + little(bytes_.size(), 4) + name;
    bytes_ += "PK\x03\x04" + common + name + bytes;
    ++files_;
  }
  std::string finish() const {
    return bytes_ + directory_ + "PK\x05\x06" + little(0, 4) + little(files_, 2) +
           little(files_, 2) + little(directory_.size(), 4) + little(bytes_.size(), 4) +
           little(0, 2);
  }

 private:
  std::string bytes_, directory_;
  std::uint64_t files_ = 0;
};

}  // namespace

void write_x3p(const std::string& path, const Heightmap& h) {
  // Top row first, as Gwyddion shows it.
  std::string data;
  data.reserve(h.z.size() * sizeof(double));
  for (int iy = h.grid.ny - 1; iy >= 0; --iy) {
    data.append(reinterpret_cast<const char*>(&h.z[h.grid.index(0, iy)]),
                static_cast<std::size_t>(h.grid.nx) * sizeof(double));
  }
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
  Zip zip;
  zip.add("main.xml", xml);
  zip.add("bindata/data.bin", data);
  zip.add("md5checksum.hex", md5(xml) + " *main.xml\n");
  write_bytes(path, zip.finish());
}

}  // namespace papilla
