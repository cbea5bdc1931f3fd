// X3P (ISO 25178-72): a stored zip of main.xml, the heights as doubles and their MD5 sums.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/file_writer.h"
#include "base/files.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "geometry/io/raw.h"
#include "geometry/io/sums.h"

namespace papilla::geometry {
namespace {

// A file of the zip as pieces: called with a function that takes them, in order.
using Pieces = std::function<void(const std::function<void(const void*, std::size_t)>&)>;

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

// The number between two tags of the XML, after `from`.
double tagged(const std::string& path, const std::string& xml, const std::string& tag,
              std::size_t from = 0) {
  const std::string open = "<" + tag + ">";
  const std::size_t at = xml.find(open, from);
  double value = 0;
  const char* end = xml.data() + xml.size();
  if (at == std::string::npos ||
      std::from_chars(xml.data() + at + open.size(), end, value).ec != std::errc{})
    throw InputError("cannot read " + path + ": no number " + tag + " in main.xml");
  return value;
}

class X3pRows : public HeightRows {
 public:
  explicit X3pRows(const std::string& path) : path_(path), file_(open_regular(path)) {
    const std::uint64_t length = enter("main.xml");
    if (length > (1 << 20)) fail("a main.xml of more than 1 MB");
    xml_.resize(length);
    get(xml_.data(), length);
    const double nx = tagged(path, xml_, "SizeX"), ny = tagged(path, xml_, "SizeY");
    check_size(path, nx, ny);
    header_.nx = static_cast<int>(nx);
    header_.ny = static_cast<int>(ny);
    header_.lx = nx * tagged(path, xml_, "Increment", xml_.find("<CX>"));
    header_.ly = ny * tagged(path, xml_, "Increment", xml_.find("<CY>"));
    if (xml_.find("<CZ><AxisType>A</AxisType><DataType>D</DataType>") == std::string::npos)
      fail("its heights are no doubles");
    scale_ = tagged(path, xml_, "Increment", xml_.find("<CZ>"));
    const auto pixels = static_cast<std::uint64_t>(header_.nx) * static_cast<unsigned>(header_.ny);
    if (enter("bindata/data.bin") != sizeof(double) * pixels)
      fail("as many heights as pixels are due");
  }

  void next(double* heights) override {
    const std::size_t bytes = static_cast<std::size_t>(header_.nx) * sizeof(double);
    get(heights, bytes);
    sum_.add(heights, bytes);
    for (int ix = 0; ix < header_.nx; ++ix) heights[ix] *= scale_;
    if (++row_ == header_.ny) check_sums();
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError("cannot read " + path_ + ": " + why);
  }
  void get(void* to, std::size_t bytes) {
    if (!file_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes)))
      fail("the data are cut off");
  }
  // Into the next file of the zip, which must have this name; its length.
  std::uint64_t enter(const std::string& name) {
    std::array<unsigned char, 30> head{};
    get(head.data(), head.size());
    const auto number = [&](std::size_t at, std::size_t bytes) {
      std::uint64_t out = 0;
      for (std::size_t i = bytes; i-- > 0;) out = out << 8 | head[at + i];
      return out;
    };
    if (number(0, 4) != 0x04034b50) fail("no zip with " + name + " where it is due");
    if (number(8, 2) != 0) fail("a compressed zip, which no X3P of ours is");
    std::string found(number(26, 2), '\0'), extra(number(28, 2), '\0');
    get(found.data(), found.size());
    get(extra.data(), extra.size());
    if (found != name) fail("a zip without " + name + " where it is due");
    return number(18, 4);
  }
  void check_sums() {
    if (xml_.find("<MD5ChecksumPointData>" + sum_.finish() + "<") == std::string::npos)
      fail("the sum of its heights is another");
    std::string sum(enter("md5checksum.hex"), '\0');
    if (sum.size() > 256) fail("a sum of more than 256 letters");
    get(sum.data(), sum.size());
    if (!sum.starts_with(md5(piece(xml_)))) fail("the sum of main.xml is another");
    std::string directory(4, '\0');
    get(directory.data(), directory.size());
    if (directory != "PK\x01\x02") fail("the data are cut off");
    const std::string rest{std::istreambuf_iterator<char>(file_), {}};
    constexpr std::size_t kEndOfZip = 22;
    if (rest.size() < kEndOfZip || rest.substr(rest.size() - kEndOfZip, 4) != "PK\x05\x06")
      fail("the data are cut off");
  }

  std::string path_, xml_;
  std::ifstream file_;
  double scale_ = 1;
  int row_ = 0;
  Md5 sum_;
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

std::unique_ptr<HeightRows> open_x3p_rows(const std::string& path) {
  return std::make_unique<X3pRows>(path);
}

}  // namespace papilla::geometry
