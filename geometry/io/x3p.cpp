// X3P (ISO 25178-72): a zip of main.xml, the heights as doubles and their MD5 sums. Ours is not
// compressed and holds no time: the same heights are the same bytes.
#include <fmt/format.h>
#include <zip.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "base/digest.h"
#include "base/error.h"
#include "base/file_writer.h"
#include "base/files.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "geometry/io/raw.h"

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
    uLong sum = 0;
    std::uint64_t length = 0;
    pieces([&](const void* bytes, std::size_t size) {
      sum = crc32_z(sum, static_cast<const Bytef*>(bytes), size);
      length += size;
    });
    // Version 2.0, no compression, 1 January 2000.
    const std::string common = little(20, 2) + little(0, 2) + little(0, 2) + little(0, 2) +
                               little(0x2821, 2) + little(sum, 4) + little(length, 4) +
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

// What a file of another program may be: compressed or not, its entries in any order, the heights
// wherever main.xml says.
class X3pRows : public HeightRows {
 public:
  explicit X3pRows(const std::string& path) : file_(path), archive_(opened()) {
    const std::string xml = text("main.xml", 1 << 20);
    pugi::xml_document document;
    if (!document.load_buffer(xml.data(), xml.size())) fail("its main.xml is no XML");
    const pugi::xml_node root = document.document_element();
    const pugi::xml_node axes = root.child("Record1").child("Axes");
    const pugi::xml_node matrix = root.child("Record3").child("MatrixDimension");
    const pugi::xml_node link = root.child("Record3").child("DataLink");
    const double nx = number(matrix, "SizeX"), ny = number(matrix, "SizeY");
    check_size(path, nx, ny);
    header_.nx = static_cast<int>(nx);
    header_.ny = static_cast<int>(ny);
    // An axis that runs against its indices: the rows or columns stand in the other order.
    const double dx = number(axes.child("CX"), "Increment"),
                 dy = number(axes.child("CY"), "Increment");
    header_.lx = nx * std::abs(dx);
    header_.ly = ny * std::abs(dy);
    header_.top_first = !(dy < 0);
    from_right_ = dx < 0;
    const pugi::xml_node z = axes.child("CZ");
    if (z.child_value("AxisType") != std::string("A")) fail("its heights are steps, not heights");
    set_type(z.child_value("DataType"));
    // ISO 25178-72: of an absolute axis only whole numbers need one.
    scale_ = *z.child_value("Increment") == '\0' ? 1 : number(z, "Increment");
    if (const char* layers = matrix.child_value("SizeZ");
        *layers != '\0' && number(matrix, "SizeZ") != 1)
      fail("several layers of heights");
    header_.made =
        std::string_view(root.child("Record2").child_value("Creator")).starts_with("papilla ");
    heights_sum_ = lower(link.child_value("MD5ChecksumPointData"));
    check_xml_sum(xml, root.child("Record4").child_value("ChecksumFile"));
    open_heights(link.child_value("PointDataLink"));
    read_valid(link.child_value("ValidPointsLink"));
  }

  void next(double* heights) override {
    stored_.resize(static_cast<std::size_t>(header_.nx) * item_);
    if (read(heights_.get(), stored_.data(), stored_.size()) != stored_.size())
      fail("the data are cut off");
    sum_.add(stored_.data(), stored_.size());
    for (int ix = 0; ix < header_.nx; ++ix)
      heights[ix] = is_valid(ix) ? scale_ * height(ix) : std::nan("");
    if (from_right_) std::reverse(heights, heights + header_.nx);
    if (++row_ < header_.ny) return;
    if (sum_.finish() != heights_sum_) fail("the sum of its heights is another");
    char more = 0;
    if (read(heights_.get(), &more, 1) != 0) fail("more heights than pixels");
  }

 private:
  void set_type(const std::string& type) {
    if (type == "D") item_ = sizeof(double);
    if (type == "F" || type == "L") item_ = sizeof(float);
    if (type == "I") item_ = sizeof(std::int16_t);
    if (item_ == 0) fail("its heights are of a type that ISO 25178-72 does not state");
    type_ = type[0];
  }
  template <class T>
  double stored(int ix) const {
    T out{};
    std::memcpy(&out, stored_.data() + static_cast<std::size_t>(ix) * sizeof out, sizeof out);
    return static_cast<double>(out);
  }
  double height(int ix) const {
    switch (type_) {
      case 'F':
        return stored<float>(ix);
      case 'L':
        return stored<std::int32_t>(ix);
      case 'I':
        return stored<std::int16_t>(ix);
      default:
        return stored<double>(ix);
    }
  }
  // A bit a point, the lowest first; not there: all are.
  void read_valid(const std::string& name) {
    if (name.empty()) return;
    const std::size_t pixels =
        static_cast<std::size_t>(header_.nx) * static_cast<std::size_t>(header_.ny);
    valid_ = text(name, (pixels + 7) / 8);
    if (valid_.size() != (pixels + 7) / 8) fail("not as many valid points as pixels are due");
  }
  bool is_valid(int ix) const {
    if (valid_.empty()) return true;
    const std::size_t at = static_cast<std::size_t>(row_) * static_cast<std::size_t>(header_.nx) +
                           static_cast<std::size_t>(ix);
    return (static_cast<unsigned char>(valid_[at / 8]) >> (at % 8) & 1) != 0;
  }
  struct Close {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_file_t* file) const { zip_fclose(file); }
  };
  using Archive = std::unique_ptr<zip_t, Close>;
  using File = std::unique_ptr<zip_file_t, Close>;

  static std::string lower(std::string digits) {
    for (char& c : digits) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return digits;
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError("cannot read " + file_.path() + ": " + why);
  }
  Archive opened() const {
    int code = 0;
    Archive archive(zip_open(file_.name().c_str(), ZIP_RDONLY, &code));
    if (archive) return archive;
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    fail("it does not open as a zip: " + why);
  }
  // Length of an entry as the archive declares it.
  std::uint64_t size_of(const std::string& name) const {
    zip_stat_t stat;
    if (zip_stat(archive_.get(), name.c_str(), 0, &stat) != 0 || !(stat.valid & ZIP_STAT_SIZE))
      fail("a zip without " + name);
    return stat.size;
  }
  File file(const std::string& name) const {
    File out(zip_fopen(archive_.get(), name.c_str(), 0));
    if (!out) fail(name + " in it: " + zip_strerror(archive_.get()));
    return out;
  }
  // At most so many bytes: fewer at the end of the entry.
  std::size_t read(zip_file_t* from, void* to, std::size_t bytes) const {
    std::size_t done = 0;
    while (done < bytes) {
      const zip_int64_t n = zip_fread(from, static_cast<char*>(to) + done, bytes - done);
      if (n < 0) fail(std::string("its data are damaged: ") + zip_file_strerror(from));
      if (n == 0) break;
      done += static_cast<std::size_t>(n);
    }
    return done;
  }
  // A whole entry. Whatever it declares, no more than the limit is ever unpacked.
  std::string text(const std::string& name, std::size_t limit) const {
    const std::uint64_t size = size_of(name);
    if (size > limit) fail(fmt::format("{} in it has more than {} bytes", name, limit));
    std::string out(size + 1, '\0');
    const File entry = file(name);
    if (read(entry.get(), out.data(), out.size()) != size)
      fail(name + " in it is not as long as declared");
    out.pop_back();
    return out;
  }
  double number(const pugi::xml_node& parent, const char* name) const {
    std::string_view value = parent.child_value(name);
    value.remove_prefix(std::min(value.find_first_not_of(" \t\r\n+"), value.size()));
    double out = 0;
    if (std::from_chars(value.data(), value.data() + value.size(), out).ec != std::errc{})
      fail(fmt::format("no number {} in main.xml", name));
    return out;
  }
  void check_xml_sum(const std::string& xml, const std::string& name) const {
    Md5 sum;
    sum.add(xml.data(), xml.size());
    constexpr std::size_t kMostLetters = 4096;
    if (!lower(text(name, kMostLetters)).starts_with(sum.finish()))
      fail("the sum of main.xml is another");
  }
  void open_heights(const std::string& name) {
    const auto pixels = static_cast<std::uint64_t>(header_.nx) * static_cast<unsigned>(header_.ny);
    if (size_of(name) != item_ * pixels) fail("not as many heights as pixels are due");
    heights_ = file(name);
  }

  RegularFile file_;
  Archive archive_;
  File heights_;
  std::string heights_sum_;
  std::string stored_, valid_;
  char type_ = 'D';
  std::size_t item_ = 0;
  double scale_ = 1;
  bool from_right_ = false;  // the first column is the last one of the map
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
